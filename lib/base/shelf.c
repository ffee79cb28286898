/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/shelf.h"

#include <stddef.h>

#define PLACES 8

struct se3di_shelf {
    se3d_allocator allocator;
    atomic_int owners;
    atomic_flag used; /* somebody looks or puts */
    int next;         /* place that is filled next */
    se3di_shelf_item *items[PLACES];
};

se3di_shelf *se3di_shelf_create(const se3d_allocator *allocator)
{
    se3di_shelf *shelf = se3di_alloc(allocator, 1, sizeof *shelf);
    if (shelf) {
        shelf->allocator = *allocator;
        atomic_init(&shelf->owners, 1);
        atomic_flag_clear(&shelf->used);
    }
    return shelf;
}

void se3di_shelf_keep(se3di_shelf *shelf)
{
    if (shelf) {
        atomic_fetch_add(&shelf->owners, 1);
    }
}

void se3di_shelf_drop(se3di_shelf *shelf)
{
    if (!shelf || atomic_fetch_sub(&shelf->owners, 1) > 1) {
        return;
    }
    for (int k = 0; k < PLACES; ++k) {
        se3di_shelf_item_drop(shelf->items[k]);
    }
    const se3d_allocator allocator = shelf->allocator;
    se3di_free(&allocator, shelf, 1, sizeof *shelf);
}

void se3di_shelf_item_init(se3di_shelf_item *item, void (*destroy)(se3di_shelf_item *item))
{
    atomic_init(&item->users, 1);
    item->destroy = destroy;
}

void se3di_shelf_item_drop(se3di_shelf_item *item)
{
    if (item && atomic_fetch_sub(&item->users, 1) == 1) {
        item->destroy(item);
    }
}

/* Whoever comes while another thread is at the shelf goes without: nobody waits. */
static int enter(se3di_shelf *shelf)
{
    return shelf && !atomic_flag_test_and_set_explicit(&shelf->used, memory_order_acquire);
}

static void leave(se3di_shelf *shelf)
{
    atomic_flag_clear_explicit(&shelf->used, memory_order_release);
}

se3di_shelf_item *se3di_shelf_find(se3di_shelf *shelf,
                                   int (*is)(const se3di_shelf_item *item, const void *wanted),
                                   const void *wanted)
{
    se3di_shelf_item *found = NULL;
    if (!enter(shelf)) {
        return NULL;
    }
    for (int k = 0; k < PLACES && !found; ++k) {
        se3di_shelf_item *item = shelf->items[k];
        found = item && is(item, wanted) ? item : NULL;
    }
    if (found) {
        atomic_fetch_add(&found->users, 1);
    }
    leave(shelf);
    return found;
}

void se3di_shelf_put(se3di_shelf *shelf, se3di_shelf_item *item)
{
    if (!enter(shelf)) {
        return;
    }
    se3di_shelf_item *old = shelf->items[shelf->next];
    atomic_fetch_add(&item->users, 1);
    shelf->items[shelf->next] = item;
    shelf->next = (shelf->next + 1) % PLACES;
    leave(shelf);
    se3di_shelf_item_drop(old);
}
