/* SPDX-License-Identifier: BSD-3-Clause */
/* Free spheres side by side: at every level of instructions they move as one at a time, to the bit.
 */
#include "check.h"
#include "math/larger.h"
#include "support/clump_mix.h"
#include "system/particles.h"

#include <stdlib.h>
#include <string.h>

/* One at a time. */
static void move(se3di_particles *set, size_t begin, size_t end,
                 const se3di_particle_motion *motion, double most[2])
{
    const double half = 0.5 * motion->h;
    for (size_t k = begin; k < end; ++k) {
        se3di_particle *p = &set->particles[k];
        se3di_load *load = &set->loads[k];
        const double turn = 2.5 * p->inverse_mass / (p->radius * p->radius);
        double v2 = 0.0;
        for (int a = 0; a < 3; ++a) {
            const double dv = half * (load->force[a] * p->inverse_mass + set->gravity[a]);
            const double dw = half * (load->torque[a] * turn);
            for (int n = 0; n < motion->kicks; ++n) {
                p->v[a] += dv;
                set->spins[k].w[a] += dw;
            }
            v2 += p->v[a] * p->v[a];
            p->x[a] += motion->drift * p->v[a];
        }
        most[0] = se3di_larger(most[0], v2);
        most[1] = se3di_larger(most[1], v2 * se3di_particles_wear(set)[k]);
        if (motion->drift != 0.0) {
            memset(load, 0, sizeof *load);
        }
    }
}

/* Integers that are no number, or a small one, stand behind angular velocities. */
static se3di_particles *copy_of(const bed *b, se3d_particles **copy)
{
    static const uint32_t ids[] = {0, 0xffffffffu, 0x7ff00000u, 0xfff80000u, 7, 0x00000001u};
    uint64_t seed = 23;
    CHECK(se3d_particles_clone(b->particles, copy) == SE3D_OK);
    se3di_particles *set = &(*copy)->set;
    for (size_t k = 0; k < set->count; ++k) {
        for (int a = 0; a < 3; ++a) {
            set->loads[k].force[a] = 2.0 * check_random(&seed);
            set->loads[k].torque[a] = 0.01 * check_random(&seed);
            set->spins[k].w[a] = 30.0 * check_random(&seed);
        }
        set->spins[k].id = ids[k % 6];
        set->spins[k].tag = (uint16_t)(k % 5);
        set->particles[k].radius *= 1.0 + 0.1 * check_random(&seed);
        se3di_particles_wear(set)[k] = 1e6 * (1.5 + check_random(&seed));
    }
    if (set->count > 3) {
        memset(set->particles[2].x, 0x80, sizeof set->particles[2].x); /* a little below 0 */
        set->spins[3].w[0] = set->spins[3].w[1] = -0.0;
        set->loads[3].torque[0] = -0.0;
    }
    return set;
}

/* Numbers of the copies are none that a set may have: they go before it is destroyed. */
static void destroy(se3d_particles *copy)
{
    for (size_t k = 0; k < copy->set.count; ++k) {
        copy->set.spins[k].id = 0;
        copy->set.spins[k].tag = 0;
    }
    se3d_particles_destroy(copy);
}

static int are_same(const se3di_particles *a, const se3di_particles *b)
{
    const size_t n = a->count;
    return memcmp(a->particles, b->particles, n * sizeof *a->particles) == 0 &&
           memcmp(a->spins, b->spins, n * sizeof *a->spins) == 0 &&
           memcmp(a->loads, b->loads, n * sizeof *a->loads) == 0;
}

static void compare(const bed *b, const se3di_kernels *level, const se3di_particle_motion *motion)
{
    static const size_t ranges[][2] = {{0, SIZE_MAX}, {0, 8}, {3, 12}, {4, 5}, {9, 16}, {5, 5}};
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; ++k) {
        se3d_particles *copies[2];
        se3di_particles *one = copy_of(b, &copies[0]), *other = copy_of(b, &copies[1]);
        double most[2] = {1e-9, 1e-9}, seen[2] = {1e-9, 1e-9};
        const size_t begin = ranges[k][0];
        const size_t end = ranges[k][1] < one->count ? ranges[k][1] : one->count;
        move(one, begin, end, motion, most);
        level->spheres(other, begin, end, motion, &seen[0], &seen[1]);
        CHECK(are_same(one, other));
        CHECK(memcmp(most, seen, sizeof most) == 0);
        CHECK(begin == end || seen[0] > 1e-9);
        destroy(copies[0]);
        destroy(copies[1]);
    }
}

static void each_level(void (*look)(const bed *b, const se3di_kernels *level))
{
    const se3di_kernels *levels[4] = {se3di_particle_kernels_portable(),
                                      se3di_particle_kernels_fma(), se3di_particle_kernels_avx2(),
                                      se3di_particle_kernels_avx512()};
    bed b;
    clump_mix_open(&b, 1, 0, SE3D_CONTACT_LAW_HOOKE);
    CHECK(se3d_particles_step(b.particles, 10) == SE3D_OK);
    for (int level = 0; level < 4; ++level) {
        if (levels[level]) {
            look(&b, levels[level]);
        }
    }
    bed_destroy(&b);
}

static void move_all_ways(const bed *b, const se3di_kernels *level)
{
    static const se3di_particle_motion motions[] = {
        {2, 1e-4, 1e-4}, {2, 1e-4, 0.0}, {1, 1e-4, 0.0}, {0, 1e-4, -1e-4}, {1, 2e-2, 2e-2}};
    for (size_t k = 0; k < sizeof motions / sizeof *motions; ++k) {
        compare(b, level, &motions[k]);
    }
}

static void spheres_side_by_side_move_as_one_at_a_time(void)
{
    each_level(move_all_ways);
}

static void lose_each(const bed *b, const se3di_kernels *level)
{
    const se3di_particle_motion motion = {2, 1e-4, 1e-4};
    for (size_t k = 0; k < 21; ++k) { /* the last is beyond whole groups */
        se3d_particles *copy;
        se3di_particles *set = copy_of(b, &copy);
        double fastest = 0.0, hasty = 0.0;
        set->loads[k].force[k % 3] = NAN;
        level->spheres(set, 0, 21, &motion, &fastest, &hasty);
        CHECK(isnan(fastest) && isnan(hasty));
        CHECK(isfinite(set->particles[k + 1].x[0]) && isfinite(set->spins[k].w[k % 3]));
        CHECK(isfinite(set->particles[k].v[(k + 1) % 3]) && set->particles[k].inverse_mass > 0.0);
        destroy(copy);
    }
}

/* A sphere that is nowhere is seen by who asks for the fastest, whatever comes after it. */
static void what_is_not_a_number_is_told(void)
{
    each_level(lose_each);
}

int main(void)
{
    RUN(spheres_side_by_side_move_as_one_at_a_time);
    RUN(what_is_not_a_number_is_told);
    return check_finish();
}
