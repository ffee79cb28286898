/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of a file. */
#include "io/document/scope.h"

#include <string.h>

bool se3di_scope_add(se3di_scope *scope, se3di_iopool *pool, const char *name,
                     const se3di_amount *value)
{
    se3di_named *list =
        se3di_iopool_grow(pool, scope->list, scope->count, &scope->capacity, sizeof *list);
    se3d_expression_symbol *symbols = se3di_iopool_grow(pool, scope->symbols, scope->symbol_count,
                                                        &scope->symbol_capacity, sizeof *symbols);
    if (!list || !symbols || !se3di_ionames_add(&scope->names, pool, name, scope->count)) {
        return false;
    }
    scope->list = list;
    scope->symbols = symbols;
    list[scope->count++] = (se3di_named){name, *value};
    if (value->rank == 1 && !value->hard) {
        symbols[scope->symbol_count++] = (se3d_expression_symbol){name, value->v[0]};
    }
    return true;
}

bool se3di_scope_renew(se3di_scope *scope, const char *name, const se3di_amount *value)
{
    size_t index = 0;
    if (!se3di_ionames_find(&scope->names, name, &index)) {
        return false;
    }
    se3di_amount *old = &scope->list[index].value;
    if (old->rank != value->rank || old->hard != value->hard ||
        memcmp(&old->dimension, &value->dimension, sizeof old->dimension) != 0) {
        return false;
    }
    *old = *value;
    for (size_t k = 0; k < scope->symbol_count; ++k) {
        if (strcmp(scope->symbols[k].name, name) == 0) {
            scope->symbols[k].value = value->v[0];
        }
    }
    return true;
}

const se3di_amount *se3di_scope_find(const se3di_scope *scope, const char *name)
{
    size_t index = 0;
    return se3di_ionames_find(&scope->names, name, &index) ? &scope->list[index].value : NULL;
}
