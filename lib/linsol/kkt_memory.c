/* SPDX-License-Identifier: BSD-3-Clause */
/* The memory of a KKT solver, which it lists to free it. */
#include "linsol/kkt_internal.h"

void *se3di_kkt_take(se3di_kkt *kkt, size_t count, size_t size)
{
    void *memory = NULL;
    if (!kkt->out_of_memory && kkt->array_count < KKT_MAX_ARRAYS) {
        memory = se3di_alloc(&kkt->allocator, count, size);
    }
    if (!memory) {
        kkt->out_of_memory = true;
        return NULL;
    }
    kkt->arrays[kkt->array_count++] = (se3di_kkt_block_list){memory, count, size};
    return memory;
}

double *se3di_kkt_take_aligned(se3di_kkt *kkt, size_t count)
{
    char *memory = se3di_kkt_take(kkt, count + 8, sizeof(double));
    if (!memory) {
        return NULL;
    }
    size_t past = (size_t)((uintptr_t)memory % 64);
    return (double *)(void *)(memory + (past > 0 ? 64 - past : 0));
}

void se3di_kkt_give_back(se3di_kkt *kkt)
{
    for (size_t k = 0; k < kkt->array_count; ++k) {
        const se3di_kkt_block_list *array = &kkt->arrays[k];
        se3di_free(&kkt->allocator, array->memory, array->count, array->size);
    }
    kkt->array_count = 0;
}

void se3di_kkt_destroy(se3di_kkt *kkt)
{
    if (kkt) {
        se3di_kkt_give_back(kkt);
        se3di_shelf_item_drop(kkt->structure ? &kkt->structure->item : NULL);
        se3d_allocator allocator = kkt->allocator;
        se3di_free(&allocator, kkt, 1, sizeof *kkt);
    }
}
