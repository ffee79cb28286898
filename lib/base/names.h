/* SPDX-License-Identifier: BSD-3-Clause */
/* Names of objects: a table of hashes with linear probing, at most half full, so that one is found
 * after a look or two however many there are. Names are unique among those of one owner: markers of
 * different bodies may have the same. */
#ifndef SE3DI_BASE_NAMES_H
#define SE3DI_BASE_NAMES_H

#include "base/alloc.h"

#define SE3DI_NO_INDEX UINT32_MAX

typedef struct se3di_names_entry {
    const char *text; /* NULL: free */
    uint32_t owner;
    uint32_t slot;
} se3di_names_entry;

typedef struct se3di_names {
    se3di_names_entry *entries;
    size_t capacity; /* 0 or a power of 2 */
    size_t count;
} se3di_names;

void se3di_names_destroy(se3di_names *names, const se3d_allocator *allocator);
/* Make room for `count` names: adding up to as many cannot fail. */
se3d_status se3di_names_reserve(se3di_names *names, const se3d_allocator *allocator, size_t count);
/* Add a name that is not there; the text stays the caller's and must outlive the entry. */
void se3di_names_add(se3di_names *names, uint32_t owner, const char *text, uint32_t slot);
/* Remove a name, if it is there. */
void se3di_names_remove(se3di_names *names, uint32_t owner, const char *text);
/* The slot of a name, SE3DI_NO_INDEX if there is none. */
uint32_t se3di_names_find(const se3di_names *names, uint32_t owner, const char *text);

#endif
