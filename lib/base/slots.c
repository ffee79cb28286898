/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/slots.h"

#include <string.h>

#define COUNT_BITS 20u
#define COUNT_MASK ((1u << COUNT_BITS) - 1u)

void se3di_slots_init(se3di_slots *slots, uint32_t salt)
{
    *slots = (se3di_slots){.salt = salt << COUNT_BITS};
}

void se3di_slots_destroy(se3di_slots *slots, const se3d_allocator *allocator)
{
    se3di_free(allocator, slots->slots, slots->slot_capacity, sizeof *slots->slots);
    se3di_free(allocator, slots->slot_of, slots->slot_of_capacity, sizeof *slots->slot_of);
    se3di_free(allocator, slots->free_list, slots->free_capacity, sizeof *slots->free_list);
    se3di_names_destroy(&slots->names, allocator);
    *slots = (se3di_slots){.salt = slots->salt};
}

/* The free list is kept as large as the slots, so that removing never allocates. */
static se3d_status reserve(se3di_slots *slots, const se3d_allocator *allocator, size_t slot_count)
{
    void *slot_array = slots->slots;
    void *dense_array = slots->slot_of;
    void *free_array = slots->free_list;
    se3d_status status = se3di_array_reserve(allocator, &slot_array, &slots->slot_capacity,
                                             slot_count, sizeof *slots->slots);
    slots->slots = slot_array;
    if (status == SE3D_OK) {
        status = se3di_array_reserve(allocator, &dense_array, &slots->slot_of_capacity,
                                     slots->slot_capacity, sizeof *slots->slot_of);
        slots->slot_of = dense_array;
    }
    if (status == SE3D_OK) {
        status = se3di_array_reserve(allocator, &free_array, &slots->free_capacity,
                                     slots->slot_capacity, sizeof *slots->free_list);
        slots->free_list = free_array;
    }
    return status;
}

se3d_status se3di_slots_reserve(se3di_slots *slots, const se3d_allocator *allocator)
{
    if (slots->slot_count >= UINT32_MAX - 1) { /* unreached: there is no memory for them */
        return SE3D_ERR_NO_MEMORY;
    }
    return reserve(slots, allocator, slots->slot_count + 1);
}

se3di_handle se3di_slots_add(se3di_slots *slots)
{
    uint32_t slot;
    if (slots->free_count > 0) {
        slot = slots->free_list[--slots->free_count];
    } else {
        slot = (uint32_t)slots->slot_count++;
        slots->slots[slot].generation = slots->salt | 1u;
    }
    slots->slots[slot].dense = (uint32_t)slots->count;
    slots->slot_of[slots->count++] = slot;
    return (se3di_handle){slot + 1, slots->slots[slot].generation};
}

void se3di_slots_remove(se3di_slots *slots, uint32_t dense)
{
    uint32_t slot = slots->slot_of[dense];
    for (size_t k = dense; k + 1 < slots->count; ++k) {
        slots->slot_of[k] = slots->slot_of[k + 1];
        slots->slots[slots->slot_of[k]].dense = (uint32_t)k;
    }
    --slots->count;
    slots->slots[slot].dense = SE3DI_NO_INDEX;
    if ((slots->slots[slot].generation & COUNT_MASK) == COUNT_MASK) {
        return; /* retired: this slot's generations are used up */
    }
    ++slots->slots[slot].generation;
    slots->free_list[slots->free_count++] = slot;
}

void se3di_slots_name(se3di_slots *slots, uint32_t dense, uint32_t owner, const char *name)
{
    se3di_names_add(&slots->names, owner, name, slots->slot_of[dense]);
}

uint32_t se3di_slots_find_name(const se3di_slots *slots, uint32_t owner, const char *name)
{
    const uint32_t slot = se3di_names_find(&slots->names, owner, name);
    return slot == SE3DI_NO_INDEX ? slot : slots->slots[slot].dense;
}

uint32_t se3di_slots_find(const se3di_slots *slots, uint32_t index1, uint32_t generation)
{
    if (index1 == 0 || index1 > slots->slot_count) {
        return SE3DI_NO_INDEX;
    }
    const se3di_slot *slot = &slots->slots[index1 - 1];
    return slot->generation == generation ? slot->dense : SE3DI_NO_INDEX;
}

se3di_handle se3di_slots_handle(const se3di_slots *slots, uint32_t dense)
{
    uint32_t slot = slots->slot_of[dense];
    return (se3di_handle){slot + 1, slots->slots[slot].generation};
}

/* Lists without elements may have no memory. */
static void copy_list(void *to, const void *from, size_t count, size_t size)
{
    if (count > 0) {
        memcpy(to, from, count * size);
    }
}

se3d_status se3di_slots_clone(const se3di_slots *slots, const se3d_allocator *allocator,
                              se3di_slots *copy)
{
    se3di_slots_init(copy, 0);
    copy->salt = slots->salt;
    if (slots->slot_capacity > 0) {
        se3d_status status = reserve(copy, allocator, slots->slot_count + 1);
        if (status == SE3D_OK && slots->names.count > 0) {
            status = se3di_names_reserve(&copy->names, allocator, slots->names.count);
        }
        if (status != SE3D_OK) {
            se3di_slots_destroy(copy, allocator);
            return status;
        }
        copy_list(copy->slots, slots->slots, slots->slot_count, sizeof *copy->slots);
        copy_list(copy->slot_of, slots->slot_of, slots->count, sizeof *copy->slot_of);
        copy_list(copy->free_list, slots->free_list, slots->free_count, sizeof *copy->free_list);
    }
    copy->slot_count = slots->slot_count;
    copy->count = slots->count;
    copy->free_count = slots->free_count;
    return SE3D_OK;
}
