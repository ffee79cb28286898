/* SPDX-License-Identifier: BSD-3-Clause */
#include "particles/slabs.h"

#include "base/floats.h"

void se3di_particles_each_slab(se3di_particles *set, void (*work)(se3di_particles *, uint32_t))
{
    const long slabs = (long)set->slab_count;
#ifdef _OPENMP
    const int32_t team = se3di_particles_team(set);
#pragma omp parallel for if (team > 1) num_threads(team) schedule(dynamic)
#endif
    for (long s = 0; s < slabs; ++s) {
        const se3di_floats host = se3di_floats_set();
        work(set, (uint32_t)s);
        se3di_floats_restore(host);
    }
}

#define PARTS 64

/* The first of `count` things in part c, which ends before that of part c + 1. */
static size_t part_begin(size_t count, size_t c)
{
    const size_t begin = c * (count / PARTS + 1);
    return begin < count ? begin : count;
}

void se3di_particles_each_range(se3di_particles *set, size_t count, se3di_range_work *work,
                                double h)
{
#ifdef _OPENMP
    const int32_t team = se3di_particles_team(set);
#pragma omp parallel for if (team > 1) num_threads(team) schedule(static)
#endif
    for (size_t c = 0; c < PARTS; ++c) {
        const se3di_floats host = se3di_floats_set();
        work(set, part_begin(count, c), part_begin(count, c + 1), h);
        se3di_floats_restore(host);
    }
}
