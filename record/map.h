/* SPDX-License-Identifier: BSD-3-Clause */
/* A map from numbers to numbers. */
#ifndef SE3D_RECORD_MAP_H
#define SE3D_RECORD_MAP_H

#include <stddef.h>
#include <stdint.h>

typedef struct map_entry {
    uint64_t key, value;
    int is_used;
} map_entry;

typedef struct map {
    map_entry *entries;
    size_t count, capacity; /* a power of two, or 0 */
} map;

void map_free(map *m);
/* The value of a key, NULL: it has none. */
uint64_t *map_find(const map *m, uint64_t key);
/* Give a key a value. @return 0, -1: no memory */
int map_set(map *m, uint64_t key, uint64_t value);

#endif
