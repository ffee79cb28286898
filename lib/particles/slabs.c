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
