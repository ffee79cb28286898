/* SPDX-License-Identifier: BSD-3-Clause */
#include "particles/energy.h"

#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/flow.h"

/* Of particle k: translation, rotation, potential; returns the mass. Those of a clump are its first
 * sphere's; a fixed one has none. */
static double eval(const se3di_particles *set, size_t k, const double g[3], double energy[3])
{
    const se3di_particle *particle = &set->particles[k];
    const se3di_clump *clump = se3di_clump_find(set, k);
    const double *w = set->spins[k].w;
    double mass = se3di_particles_mass(set, k);
    if (se3di_particle_is_fixed(particle) || (clump && clump->first != set->spins[k].id)) {
        energy[0] = energy[1] = energy[2] = 0.0;
        return clump ? 0.0 : mass;
    }
    if (clump) {
        mass = se3di_clump_mass(set, clump);
        se3di_clump_energy(set, clump, energy);
        energy[2] = -mass * se3di_dot(g, clump->x);
        return mass;
    }
    energy[0] = 0.5 * mass * se3di_dot(particle->v, particle->v);
    energy[1] = 0.2 * mass * particle->radius * particle->radius * se3di_dot(w, w);
    energy[2] = -mass * se3di_dot(g, particle->x);
    return mass;
}

se3d_particles_energy se3di_particles_energy(const se3di_particles *set, const double g[3])
{
    se3d_particles_energy sum = {0.0, 0.0, 0.0};
    size_t id = 0;
    for (size_t k = 0; k < set->count; ++k) {
        double share[3];
        (void)eval(set, se3di_particles_next(set, &id), g, share);
        sum.translation += share[0];
        sum.rotation += share[1];
        sum.potential += share[2];
    }
    return sum;
}

se3d_particles_tally se3di_particles_tally(const se3di_particles *set, uint32_t tag,
                                           const double g[3])
{
    se3d_particles_tally tally = {.lost = set->lost_of[tag]};
    size_t id = 0;
    for (size_t n = 0; n < set->count; ++n) {
        const size_t k = se3di_particles_next(set, &id);
        if (set->spins[k].tag == tag) {
            double share[3];
            tally.mass += eval(set, k, g, share);
            ++tally.count;
            tally.outside += (uint64_t)se3di_particles_is_out(set, k);
            tally.energy += share[0] + share[1] + share[2];
            tally.kinetic += share[0] + share[1];
            tally.rotation += share[1];
        }
    }
    return tally;
}

se3d_particles_stats se3di_particles_stats(const se3di_particles *set)
{
    se3d_particles_stats stats = {.steps = set->steps,
                                  .rebuilds = set->rebuilds,
                                  .contacts = set->touching,
                                  .lost = set->lost,
                                  .bytes = se3di_particles_memory(set),
                                  .threads = (uint64_t)set->team,
                                  .left = set->lost,
                                  .clumps = set->clump_count};
    for (size_t k = 0; k < set->count; ++k) {
        stats.left += (uint64_t)se3di_particles_is_out(set, k);
    }
    return stats;
}

static int is_same(se3di_handle a, se3di_handle b)
{
    return a.index1 == b.index1 && a.generation == b.generation;
}

static void push(const se3di_wall *wall, double force[3], double torque[3])
{
    se3di_add(force, wall->force, force);
    se3di_add(torque, wall->torque, torque);
}

void se3di_particles_push_body(const se3di_particles *set, se3di_handle body, double force[3],
                               double torque[3])
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        if (is_same(set->walls[k].body, body)) {
            push(&set->walls[k], force, torque);
        }
    }
}

void se3di_particles_push_shape(const se3di_particles *set, se3di_handle shape, double force[3],
                                double torque[3])
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        if (is_same(set->walls[k].handle, shape)) {
            push(&set->walls[k], force, torque);
        }
    }
}
