/* SPDX-License-Identifier: BSD-3-Clause */
/* What sources insert while lists hold: it waits with its owner until they are made anew; all know
 * where it is, so that nothing else is put there. */
#include <string.h>

#include "particles/wall.h"
#include "team.h"

/* A sphere at index k that was appended; it has the next number of the whole. */
static mover take_out(se3di_particles *set, size_t k)
{
    team *t = team_of(set);
    mover m = {(uint32_t)t->share.ids++, 0, set->particles[k], set->spins[k]};
    se3di_particles_come_home(set, m.particle.x);
    team_reserve(t, &t->share.fresh, &t->fresh_capacity, t->share.fresh_count + 1,
                 sizeof *t->share.fresh);
    double *fresh = t->share.fresh[t->share.fresh_count++];
    memcpy(fresh, m.particle.x, sizeof m.particle.x);
    fresh[3] = m.particle.radius;
    return m;
}

void team_insert(se3di_particles *set, size_t spheres, int is_clump)
{
    team *t = team_of(set);
    const size_t begin = set->count - spheres;
    const double *x = set->particles[begin].x;
    double home[3];
    if (is_clump) {
        x = set->clumps[--set->clump_count].x;
        memset(set->clump_of + begin, 0xff, spheres * sizeof *set->clump_of); /* SE3DI_NO_INDEX */
    }
    memcpy(home, x, sizeof home);
    se3di_particles_come_home(set, home);
    const int here = boxes_find(&t->boxes, home) == t->rank;
    if (here && is_clump) {
        se3di_clump clump = set->clumps[set->clump_count];
        memcpy(clump.x, home, sizeof home);
        bytes_put(t, &t->clump_arrivals, &clump, sizeof clump);
        ++t->clump_arrival_count;
    }
    for (size_t k = begin; k < begin + spheres; ++k) {
        const mover m = take_out(set, k);
        if (here && is_clump) {
            bytes_put(t, &t->clump_arrivals, &m, sizeof m);
        } else if (here) {
            team_reserve(t, &t->arrivals, &t->arrival_capacity, t->arrival_count + 1,
                         sizeof *t->arrivals);
            t->arrivals[t->arrival_count++] = m;
        }
    }
    set->count = set->id_count = begin;
}

void team_forget_arrivals(team *t)
{
    t->arrival_count = t->clump_arrival_count = t->share.fresh_count = 0;
    t->clump_arrivals.count = 0;
}
