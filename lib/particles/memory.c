/* SPDX-License-Identifier: BSD-3-Clause */
#include "particles/memory.h"

#include <string.h>

#define ALIGNMENT 64

se3d_status se3di_aligned_reserve(const se3d_allocator *allocator, se3di_aligned *memory,
                                  size_t bytes, size_t keep)
{
    if (bytes <= memory->bytes) {
        return SE3D_OK;
    }
    if (bytes > SIZE_MAX - 2 * ALIGNMENT) {
        return SE3D_ERR_NO_MEMORY;
    }
    void *raw = se3di_alloc(allocator, bytes + ALIGNMENT, 1);
    if (!raw) {
        return SE3D_ERR_NO_MEMORY;
    }
    size_t offset = (size_t)((uintptr_t)raw % ALIGNMENT);
    void *data = (char *)raw + (ALIGNMENT - offset);
    if (keep > 0) {
        memcpy(data, memory->data, keep);
    }
    if (memory->raw) {
        se3di_free(allocator, memory->raw, memory->bytes + ALIGNMENT, 1);
    }
    *memory = (se3di_aligned){data, raw, bytes};
    return SE3D_OK;
}

void se3di_aligned_free(const se3d_allocator *allocator, se3di_aligned *memory)
{
    if (memory->raw) {
        se3di_free(allocator, memory->raw, memory->bytes + ALIGNMENT, 1);
    }
    *memory = (se3di_aligned){NULL, NULL, 0};
}

se3d_status se3di_particles_grow(const se3di_particles *set, uint32_t **data, size_t *capacity,
                                 size_t needed)
{
    if (needed <= *capacity) {
        return SE3D_OK;
    }
    size_t grown = needed + needed / 32 + 16;
    uint32_t *memory = se3di_alloc(&set->allocator, grown, sizeof *memory);
    if (!memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    if (*capacity > 0) {
        memcpy(memory, *data, *capacity * sizeof *memory);
    }
    se3di_free(&set->allocator, *data, *capacity, sizeof *memory);
    *data = memory;
    *capacity = grown;
    return SE3D_OK;
}
