/* SPDX-License-Identifier: BSD-3-Clause */
/* Slabs: what can be done to all of them at a time. */
#ifndef SE3DI_PARTICLES_SLABS_H
#define SE3DI_PARTICLES_SLABS_H

#include "particles/set.h"

/* Do something for every slab, on all threads at a time. */
void se3di_particles_each_slab(se3di_particles *set, void (*work)(se3di_particles *, uint32_t));

/* The same for every part of what can be divided into SE3DI_PARTS, with a context. */
#define SE3DI_PARTS 64
typedef void se3di_part_work(se3di_particles *set, size_t part, void *ctx);
void se3di_particles_each_part(se3di_particles *set, se3di_part_work *work, void *ctx);
/* The first of `count` things in a part, which ends before that of the next part. */
size_t se3di_part_begin(size_t count, size_t part);

/* The same for the parts of `count` things, each by itself. */
typedef void se3di_range_work(se3di_particles *set, size_t begin, size_t end, double h);
void se3di_particles_each_range(se3di_particles *set, size_t count, se3di_range_work *work,
                                double h);

#endif
