/* SPDX-License-Identifier: BSD-3-Clause */
/* Names that expressions of a file know, and what its numbers are in. */
#ifndef SE3D_IO_SCOPE_H
#define SE3D_IO_SCOPE_H

#include "io/base/pool.h"
#include "io/document/unit.h"
#include "se3d/expression.h"

/* A number or a vector. */
typedef struct se3di_amount {
    size_t rank;               /* 1 or 3 */
    bool hard;                 /* it has a unit: SI. Else it is in the units of the file. */
    se3di_dimension dimension; /* of what is not hard: as far as variables have one */
    double v[3];
    const char *text[3]; /* of a function of variables; NULL: `v` */
} se3di_amount;

typedef struct se3di_named {
    const char *name;
    se3di_amount value;
} se3di_named;

typedef struct se3di_scope {
    se3di_units units;
    se3di_ionames names; /* to indices of `list` */
    se3di_named *list;
    size_t count, capacity;
    se3d_expression_symbol *symbols; /* the numbers without a unit */
    size_t symbol_count, symbol_capacity;
} se3di_scope;

/* Add a name that is not there yet. @return false: out of memory. */
bool se3di_scope_add(se3di_scope *scope, se3di_iopool *pool, const char *name,
                     const se3di_amount *value);
/* Give a name another value. @return false: it is of another kind than before, and stays */
bool se3di_scope_renew(se3di_scope *scope, const char *name, const se3di_amount *value);
const se3di_amount *se3di_scope_find(const se3di_scope *scope, const char *name);

#endif
