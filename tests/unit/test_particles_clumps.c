/* SPDX-License-Identifier: BSD-3-Clause */
/* Clumps side by side: at every level of instructions they move as one at a time, to the bit. */
#include "check.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "particles/clump.h"
#include "support/clump_mix.h"
#include "system/particles.h"

#include <stdlib.h>
#include <string.h>

/* ---- one at a time ---- */

static void kick(se3di_particles *set, se3di_clump *clump, const se3di_particle_motion *motion)
{
    const double half = 0.5 * motion->h, mobility = 1.0 / se3di_clump_mass(set, clump);
    double force[3], torque[3], turned[3];
    se3di_clump_loads(set, clump, force, torque);
    se3di_mul_transposed(clump->A, torque, turned);
    for (int a = 0; a < 3; ++a) {
        const double dv = half * (force[a] * mobility + set->gravity[a]);
        for (int n = 0; n < motion->kicks; ++n) {
            clump->v[a] += dv;
            clump->spin[a] += half * turned[a];
        }
    }
}

/* The turn about principal axis k by an angle whose half has this tangent. */
static void turn(const double inertia[3], int k, double by, se3di_clump *clump)
{
    const int b = (k + 1) % 3, c = (k + 2) % 3;
    const double u = 0.5 * (by * clump->spin[k] / inertia[k]), u2 = u * u;
    const double t = u * (1.0 + u2 * (1.0 / 3.0 + u2 * (2.0 / 15.0)));
    const double scale = 1.0 / (1.0 + t * t);
    const double cosine = (1.0 - t * t) * scale, sine = 2.0 * t * scale;
    const double L_b = clump->spin[b], L_c = clump->spin[c];
    const double q[4] = {clump->q[0], clump->q[1 + k], clump->q[1 + b], clump->q[1 + c]};
    clump->spin[b] = cosine * L_b + sine * L_c;
    clump->spin[c] = cosine * L_c - sine * L_b;
    clump->q[0] = q[0] - t * q[1];
    clump->q[1 + k] = q[1] + t * q[0];
    clump->q[1 + b] = q[2] + t * q[3];
    clump->q[1 + c] = q[3] - t * q[2];
}

static void drift(const se3di_particles *set, se3di_clump *clump, double h)
{
    static const int axes[5] = {0, 1, 2, 1, 0};
    const double *inertia = set->templates[clump->template_index].inertia;
    const double by = h / (clump->factor * clump->scale * clump->scale);
    for (int n = 0; n < 5; ++n) {
        turn(inertia, axes[n], n == 2 ? by : 0.5 * by, clump);
    }
    se3di_add_scaled(h, clump->v, clump->x);
    (void)se3di_quat_normalize(clump->q, clump->q);
    se3di_quat_to_matrix(clump->q, clump->A);
}

static void carry(se3di_particles *set, const se3di_clump *clump, double drift, double *fastest,
                  double *hasty)
{
    const uint32_t count = set->templates[clump->template_index].count;
    double before[8][3];
    for (uint32_t k = 0; k < count; ++k) {
        se3di_copy(set->particles[set->index_of[clump->first + k]].x, before[k]);
    }
    se3di_clump_place(set, clump, drift != 0.0);
    for (uint32_t k = 0; k < count && drift != 0.0; ++k) {
        const uint32_t index = set->index_of[clump->first + k];
        double *x = set->particles[index].x, way[3];
        for (int a = 0; a < 2; ++a) { /* the periods of the mix */
            const double length = set->upper[a] - set->lower[a];
            x[a] -= length * nearbyint((x[a] - before[k][a]) / length);
        }
        se3di_sub(x, before[k], way);
        const double v2 = se3di_dot(way, way) * (1.0 / (drift * drift));
        *fastest = se3di_larger(*fastest, v2);
        *hasty = se3di_larger(*hasty, v2 * se3di_particles_wear(set)[index]);
        memset(&set->loads[index], 0, sizeof set->loads[index]);
    }
}

static void move(se3di_particles *set, size_t begin, size_t end,
                 const se3di_particle_motion *motion, double *fastest, double *hasty)
{
    for (size_t k = begin; k < end; ++k) {
        kick(set, &set->clumps[k], motion);
        if (motion->drift != 0.0) {
            drift(set, &set->clumps[k], motion->drift);
        }
        carry(set, &set->clumps[k], motion->drift, fastest, hasty);
    }
}

/* ---- comparison ---- */

static void load_at_random(se3di_particles *set)
{
    uint64_t seed = 23;
    for (size_t k = 0; k < set->count; ++k) {
        for (int a = 0; a < 3; ++a) {
            set->loads[k].force[a] = 2.0 * check_random(&seed);
            set->loads[k].torque[a] = 0.01 * check_random(&seed);
        }
        se3di_particles_wear(set)[k] = 1e6 * (1.5 + check_random(&seed));
    }
}

static se3di_particles *copy_of(const bed *b, se3d_particles **copy)
{
    CHECK(se3d_particles_clone(b->particles, copy) == SE3D_OK);
    load_at_random(&(*copy)->set);
    return &(*copy)->set;
}

static int are_same(const se3di_particles *a, const se3di_particles *b)
{
    const size_t n = a->count;
    return memcmp(a->clumps, b->clumps, a->clump_count * sizeof *a->clumps) == 0 &&
           memcmp(a->particles, b->particles, n * sizeof *a->particles) == 0 &&
           memcmp(a->spins, b->spins, n * sizeof *a->spins) == 0 &&
           memcmp(a->loads, b->loads, n * sizeof *a->loads) == 0;
}

static void compare(const bed *b, const se3di_kernels *level, const se3di_particle_motion *motion)
{
    static const size_t ranges[][2] = {{0, SIZE_MAX}, {0, 8}, {40, 47}, {44, 45}, {30, 62}, {5, 5}};
    for (size_t k = 0; k < sizeof ranges / sizeof *ranges; ++k) {
        se3d_particles *copies[2];
        se3di_particles *one = copy_of(b, &copies[0]), *other = copy_of(b, &copies[1]);
        double most[2] = {1e-9, 1e-9}, seen[2] = {1e-9, 1e-9};
        const size_t begin = ranges[k][0];
        const size_t end = ranges[k][1] < one->clump_count ? ranges[k][1] : one->clump_count;
        move(one, begin, end, motion, &most[0], &most[1]);
        level->clumps(other, begin, end, motion, &seen[0], &seen[1]);
        CHECK(are_same(one, other));
        CHECK(memcmp(most, seen, sizeof most) == 0);
        CHECK(begin == end || motion->drift == 0.0 || seen[0] > 1e-9);
        se3d_particles_destroy(copies[0]);
        se3d_particles_destroy(copies[1]);
    }
}

static void clumps_side_by_side_move_as_one_at_a_time(void)
{
    static const se3di_particle_motion motions[] = {
        {2, 1e-4, 1e-4}, {1, 1e-4, 0.0}, {0, 1e-4, -1e-4}, {1, 2e-2, 2e-2}};
    const se3di_kernels *levels[4] = {se3di_particle_kernels_portable(),
                                      se3di_particle_kernels_fma(), se3di_particle_kernels_avx2(),
                                      se3di_particle_kernels_avx512()};
    bed b;
    clump_mix_open(&b, 1, 0, SE3D_CONTACT_LAW_HOOKE);
    CHECK(se3d_particles_step(b.particles, 100) == SE3D_OK);
    for (int level = 0; level < 4; ++level) {
        for (size_t k = 0; levels[level] && k < sizeof motions / sizeof *motions; ++k) {
            compare(&b, levels[level], &motions[k]);
        }
    }
    bed_destroy(&b);
}

/* A sphere that is nowhere is seen by who asks for the fastest, whatever comes after it. */
static void what_is_not_a_number_is_told(void)
{
    const se3di_kernels *kernels = se3di_particle_kernels_choose(0);
    const se3di_particle_motion motion = {1, 1e-4, 1e-4};
    bed b;
    se3d_particles *copy;
    clump_mix_open(&b, 1, 0, SE3D_CONTACT_LAW_HOOKE);
    CHECK(se3d_particles_step(b.particles, 1) == SE3D_OK);
    for (size_t k = 0; k < 20; ++k) {
        se3di_particles *set = copy_of(&b, &copy);
        double fastest = 0.0, hasty = 0.0;
        set->clumps[k].v[k % 3] = NAN;
        kernels->clumps(set, 0, set->clump_count, &motion, &fastest, &hasty);
        CHECK(isnan(fastest) && isnan(hasty));
        CHECK(isfinite(set->clumps[k + 1].x[0]) && isfinite(set->clumps[k + 1].spin[0]));
        se3d_particles_destroy(copy);
    }
    bed_destroy(&b);
}

int main(void)
{
    RUN(clumps_side_by_side_move_as_one_at_a_time);
    RUN(what_is_not_a_number_is_told);
    return check_finish();
}
