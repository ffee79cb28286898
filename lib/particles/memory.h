/* SPDX-License-Identifier: BSD-3-Clause */
/* Memory of the particles: aligned blocks, arrays of indices. */
#ifndef SE3DI_PARTICLES_MEMORY_H
#define SE3DI_PARTICLES_MEMORY_H

#include "particles/set.h"

/* Grow an aligned block to hold `bytes`, keeping the first `keep` bytes. */
se3d_status se3di_aligned_reserve(const se3d_allocator *allocator, se3di_aligned *memory,
                                  size_t bytes, size_t keep);
void se3di_aligned_free(const se3d_allocator *allocator, se3di_aligned *memory);
/* Grow an array to hold `needed` elements, a little more. */
se3d_status se3di_particles_grow(const se3di_particles *set, uint32_t **data, size_t *capacity,
                                 size_t needed);

#endif
