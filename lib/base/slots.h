/* SPDX-License-Identifier: BSD-3-Clause */
/* Generational slots: map a handle {index1, generation} to the dense index of a live object.
 *
 * A generation has a salt of the owning system in its upper 12 bits (so that a handle of another
 * system is detected) and a count in its lower 20. A slot whose count is used up is retired, so
 * that a stale handle is detected for ever. */
#ifndef SE3DI_BASE_SLOTS_H
#define SE3DI_BASE_SLOTS_H

#include "base/alloc.h"
#include "base/names.h"

typedef struct se3di_handle {
    uint32_t index1;     /* slot + 1; 0 = null */
    uint32_t generation; /* must equal the slot's */
} se3di_handle;

typedef struct se3di_slot {
    uint32_t generation; /* of the present or next object */
    uint32_t dense;      /* index of the object, SE3DI_NO_INDEX if free */
} se3di_slot;

typedef struct se3di_slots {
    se3di_slot *slots;
    size_t slot_count, slot_capacity;
    uint32_t *slot_of; /* dense index -> slot */
    size_t count, slot_of_capacity;
    uint32_t *free_list;
    size_t free_count, free_capacity;
    se3di_names names; /* of objects that have one: slots */
    uint32_t salt;
} se3di_slots;

void se3di_slots_init(se3di_slots *slots, uint32_t salt);
void se3di_slots_destroy(se3di_slots *slots, const se3d_allocator *allocator);

/* Make room for one more object: the next se3di_slots_add cannot fail. */
se3d_status se3di_slots_reserve(se3di_slots *slots, const se3d_allocator *allocator);

/* Handle of a new object whose dense index is the present count. */
se3di_handle se3di_slots_add(se3di_slots *slots);

/* Give the object `dense` (< count) a name, unique among those of `owner`, for which there is room
 * (se3di_names_reserve); the text stays the caller's, and must live as long as the entry. */
void se3di_slots_name(se3di_slots *slots, uint32_t dense, uint32_t owner, const char *name);
/* Dense index of the object of that name, SE3DI_NO_INDEX if there is none. */
uint32_t se3di_slots_find_name(const se3di_slots *slots, uint32_t owner, const char *name);

/* Remove object `dense`, whose name has been taken out; the objects behind it move down by one. */
void se3di_slots_remove(se3di_slots *slots, uint32_t dense);

/* Dense index of a handle, SE3DI_NO_INDEX if it is null, stale or foreign. */
uint32_t se3di_slots_find(const se3di_slots *slots, uint32_t index1, uint32_t generation);

/* Handle of the object `dense` (< count). */
se3di_handle se3di_slots_handle(const se3di_slots *slots, uint32_t dense);

/* Deep copy into `copy` (uninitialised) without the names, for which there is room; on failure
 * `copy` is empty. */
se3d_status se3di_slots_clone(const se3di_slots *slots, const se3d_allocator *allocator,
                              se3di_slots *copy);

#endif
