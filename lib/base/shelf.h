/* SPDX-License-Identifier: BSD-3-Clause */
/* Things that take long to make, follow from what they are asked for alone, and never change: a
 * system and its clones share one shelf of them, so that the second one finds what the first has
 * made. Owners may be at work in several threads; the last one gives back the memory. What is found
 * is what would be made: nobody can tell, but by the time it takes. */
#ifndef SE3DI_BASE_SHELF_H
#define SE3DI_BASE_SHELF_H

#include "base/alloc.h"

#include <stdatomic.h>

typedef struct se3di_shelf se3di_shelf;

/* The first member of a thing. */
typedef struct se3di_shelf_item {
    atomic_int users;
    void (*destroy)(struct se3di_shelf_item *item);
} se3di_shelf_item;

/* An empty shelf with one owner; NULL: no memory. */
se3di_shelf *se3di_shelf_create(const se3d_allocator *allocator);
/* One owner more, one less. NULL is fine here and below: a shelf where nothing is ever found. */
void se3di_shelf_keep(se3di_shelf *shelf);
void se3di_shelf_drop(se3di_shelf *shelf);

/* A thing with one user, which is not on a shelf yet. */
void se3di_shelf_item_init(se3di_shelf_item *item, void (*destroy)(se3di_shelf_item *item));
void se3di_shelf_item_drop(se3di_shelf_item *item);

/* What is on the shelf and is `wanted`, with one user more; NULL: nothing. */
se3di_shelf_item *se3di_shelf_find(se3di_shelf *shelf,
                                   int (*is)(const se3di_shelf_item *item, const void *wanted),
                                   const void *wanted);
/* Put a thing on the shelf, which becomes a user of it. The oldest one makes room. */
void se3di_shelf_put(se3di_shelf *shelf, se3di_shelf_item *item);

#endif
