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

size_t se3di_part_begin(size_t count, size_t c)
{
    const size_t begin = c * (count / SE3DI_PARTS + 1);
    return begin < count ? begin : count;
}

void se3di_particles_each_part(se3di_particles *set, se3di_part_work *work, void *ctx)
{
#ifdef _OPENMP
    const int32_t team = se3di_particles_team(set);
#pragma omp parallel for if (team > 1) num_threads(team) schedule(static)
#endif
    for (size_t c = 0; c < SE3DI_PARTS; ++c) {
        const se3di_floats host = se3di_floats_set();
        work(set, c, ctx);
        se3di_floats_restore(host);
    }
}

typedef struct ranges {
    se3di_range_work *work;
    size_t count;
    double h;
} ranges;

static void work_on_range(se3di_particles *set, size_t c, void *ctx)
{
    const ranges *r = ctx;
    r->work(set, se3di_part_begin(r->count, c), se3di_part_begin(r->count, c + 1), r->h);
}

void se3di_particles_each_range(se3di_particles *set, size_t count, se3di_range_work *work,
                                double h)
{
    ranges r = {work, count, h};
    se3di_particles_each_part(set, work_on_range, &r);
}
