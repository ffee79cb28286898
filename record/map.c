/* SPDX-License-Identifier: BSD-3-Clause */
#include "map.h"

#include <stdlib.h>
#include <string.h>

void map_free(map *m)
{
    free(m->entries);
    memset(m, 0, sizeof *m);
}

static map_entry *place_of(const map *m, uint64_t key)
{
    uint64_t at = (key ^ (key >> 29)) * 0x9e3779b97f4a7c15u;
    for (at >>= 20;; ++at) {
        map_entry *e = &m->entries[at & (m->capacity - 1)];
        if (!e->is_used || e->key == key) {
            return e;
        }
    }
}

uint64_t *map_find(const map *m, uint64_t key)
{
    map_entry *e = m->capacity > 0 ? place_of(m, key) : NULL;
    return e && e->is_used ? &e->value : NULL;
}

static int grow(map *m)
{
    map larger = {.count = m->count, .capacity = m->capacity > 0 ? 2 * m->capacity : 64};
    larger.entries = calloc(larger.capacity, sizeof *larger.entries);
    if (!larger.entries) {
        return -1;
    }
    for (size_t k = 0; k < m->capacity; ++k) {
        if (m->entries[k].is_used) {
            *place_of(&larger, m->entries[k].key) = m->entries[k];
        }
    }
    free(m->entries);
    *m = larger;
    return 0;
}

int map_set(map *m, uint64_t key, uint64_t value)
{
    if (2 * (m->count + 1) > m->capacity && grow(m) != 0) {
        return -1;
    }
    map_entry *e = place_of(m, key);
    m->count += !e->is_used;
    *e = (map_entry){key, value, 1};
    return 0;
}
