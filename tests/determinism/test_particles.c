/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles give the same bits for any number of threads, on every run, and from a copy in the
 * middle. */
#include <stdlib.h>

#include "check.h"
#include "se3d/se3d.h"
#include "support/avalanche.h"
#include "support/clump_mix.h"

static uint64_t run(int32_t threads, int32_t portable, int32_t law)
{
    bed b;
    avalanche_open(&b, threads, portable, law);
    CHECK(se3d_particles_step(b.particles, 3000) == SE3D_OK);
    se3d_particles *copy; /* goes on from the middle */
    CHECK(se3d_particles_clone(b.particles, &copy) == SE3D_OK);
    CHECK(se3d_particles_step(b.particles, 1500) == SE3D_OK);
    CHECK(se3d_particles_restore(b.particles, copy) == SE3D_OK);
    se3d_particles_destroy(copy);
    CHECK(se3d_particles_step(b.particles, 3000) == SE3D_OK);
    se3d_particles_stats stats;
    CHECK(se3d_particles_get_stats(b.particles, &stats) == SE3D_OK);
    CHECK(stats.rebuilds > 2 && stats.contacts > 100 && stats.lost == 0);
#ifdef SE3D_HAS_OPENMP
    CHECK(stats.threads == (uint64_t)threads);
#else
    CHECK(stats.threads == 1);
#endif
    uint64_t hash = se3d_particles_hash(b.particles);
    bed_destroy(&b);
    return hash;
}

/* Two and four threads in one case, three in the next one, or with SE3D_LONG all in each. */
static int32_t first_count(int32_t case_number)
{
    return check_is_long() ? 2 : 2 + case_number % 2;
}

static int32_t next_count(void)
{
    return check_is_long() ? 1 : 2;
}

static void bits_do_not_depend_on_the_number_of_threads(void)
{
    for (int32_t k = 0; k < 4; ++k) {
        uint64_t one = run(1, k & 1, k >> 1);
        for (int32_t threads = first_count(k); threads <= 4; threads += next_count()) {
            CHECK(run(threads, k & 1, k >> 1) == one);
        }
    }
}

/* A tall box with slabs that keep a thread busy for longer than it takes to wake the next one. */
static uint64_t run_box(int32_t threads)
{
    bed b;
    CHECK(se3d_system_create(NULL, &b.system) == SE3D_OK);
    se3d_particles_def def = se3d_particles_def_default();
    def.threads = threads;
    def.step = 2e-5;
    CHECK(se3d_particles_create(b.system, &def, &b.particles) == SE3D_OK);
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 2e4;
    se3d_fill_def fill = se3d_fill_def_default();
    CHECK(se3d_material_create(b.system, &stuff, &fill.material) == SE3D_OK);
    fill.radius_min = fill.radius_max = 0.005;
    fill.spacing = 0.0101;
    fill.jitter = 0.0004;
    fill.upper[0] = fill.upper[1] = 0.3;
    fill.upper[2] = 0.5;
    CHECK(se3d_particles_fill_lattice(b.particles, &fill, NULL) == SE3D_OK);
    CHECK(se3d_particles_count(b.particles) > 30000);
    CHECK(se3d_particles_step(b.particles, 60) == SE3D_OK);
    uint64_t hash = se3d_particles_hash(b.particles);
    bed_destroy(&b);
    return hash;
}

static void bits_of_a_large_set_do_not_depend_on_the_number_of_threads(void)
{
    uint64_t one = run_box(1);
    for (int32_t threads = 2; threads <= 4; ++threads) {
        CHECK(run_box(threads) == one);
    }
}

static se3d_material material_of(const bed *b)
{
    const size_t count = se3d_particles_count(b->particles);
    se3d_material *all = malloc(count * sizeof *all), one = {0, 0};
    CHECK(all && se3d_particles_get_materials(b->particles, count, all) == SE3D_OK);
    one = all ? all[0] : one;
    free(all);
    return one;
}

/* Clumps between the spheres of an avalanche. */
static void open_clumps(bed *b, int32_t threads, int32_t portable, int32_t law)
{
    static const double r[9] = {0.0, 0.0, 0.0, 0.004, 0.0, 0.0, 0.0, 0.003, 0.002},
                        radii[3] = {0.004, 0.003, 0.0025};
    se3d_clump_def def = se3d_clump_def_default();
    se3d_fill_def fill = se3d_fill_def_default();
    uint32_t index;
    avalanche_open(b, threads, portable, law);
    def.count = 3;
    def.r = r;
    def.radius = radii;
    CHECK(se3d_particles_add_clump_template(b->particles, &def, &index) == SE3D_OK);
    fill.material = material_of(b);
    fill.clump = index + 1;
    fill.lower[2] = 0.12;
    fill.upper[0] = 0.24;
    fill.upper[1] = 0.06;
    fill.upper[2] = 0.22;
    fill.velocity[2] = -2.0;
    CHECK(se3d_particles_fill_lattice(b->particles, &fill, NULL) == SE3D_OK);
    CHECK(se3d_particles_count_clumps(b->particles) > 100);
}

typedef void opener(bed *b, int32_t threads, int32_t portable, int32_t law);

/* In one piece, or cut, with a copy that goes on from the middle. */
static uint64_t run_clumps(opener *open, int32_t threads, int32_t portable, int32_t law,
                           size_t piece)
{
    bed b;
    open(&b, threads, portable, law);
    for (size_t k = 0; k < 1200; k += piece) {
        CHECK(se3d_particles_step(b.particles, piece) == SE3D_OK);
    }
    if (piece < 1200) {
        se3d_particles *copy;
        CHECK(se3d_particles_clone(b.particles, &copy) == SE3D_OK);
        CHECK(se3d_particles_step(b.particles, 77) == SE3D_OK);
        CHECK(se3d_particles_restore(b.particles, copy) == SE3D_OK);
        se3d_particles_destroy(copy);
    }
    CHECK(se3d_particles_step(b.particles, 600) == SE3D_OK);
    const uint64_t hash = se3d_particles_hash(b.particles);
    bed_destroy(&b);
    return hash;
}

static void clumps_have_the_same_bits(void)
{
    static opener *const openers[] = {open_clumps, clump_mix_open};
    for (int n = 0; n < 4; ++n) {
        opener *open = openers[n / 2];
        const int32_t law = n % 2;
        const uint64_t one = run_clumps(open, 1, 0, law, 1200);
        CHECK(run_clumps(open, 1, 1, law, 1200) == one); /* another level of instructions */
        CHECK(run_clumps(open, 1, 0, law, 40) == one);
        for (int32_t threads = first_count(n); threads <= 4; threads += next_count()) {
            CHECK(run_clumps(open, threads, 0, law, 1200) == one);
        }
    }
}

static void bits_do_not_depend_on_how_a_run_is_cut(void)
{
    bed a, b;
    avalanche_open(&a, 1, 0, SE3D_CONTACT_LAW_HOOKE);
    avalanche_open(&b, 1, 0, SE3D_CONTACT_LAW_HOOKE);
    CHECK(se3d_particles_step(a.particles, 3000) == SE3D_OK);
    for (size_t k = 0; k < 3000; k += 1 + k % 7) {
        size_t steps = 1 + k % 7;
        CHECK(se3d_particles_step(b.particles, k + steps > 3000 ? 3000 - k : steps) == SE3D_OK);
    }
    CHECK(se3d_particles_hash(a.particles) == se3d_particles_hash(b.particles));
    bed_destroy(&a);
    bed_destroy(&b);
}

static void copies_and_restored_states_continue_with_the_same_bits(void)
{
    bed b;
    avalanche_open(&b, 1, 0, SE3D_CONTACT_LAW_HERTZ_MINDLIN);
    se3d_particles *copy;
    CHECK(se3d_particles_step(b.particles, 2345) == SE3D_OK);
    CHECK(se3d_particles_clone(b.particles, &copy) == SE3D_OK);
    CHECK(se3d_particles_hash(copy) == se3d_particles_hash(b.particles));
    CHECK(se3d_particles_step(b.particles, 2000) == SE3D_OK);
    uint64_t hash = se3d_particles_hash(b.particles);
    CHECK(hash != se3d_particles_hash(copy));
    CHECK(se3d_particles_restore(b.particles, copy) == SE3D_OK);
    CHECK(hash != se3d_particles_hash(b.particles));
    CHECK(se3d_particles_step(copy, 2000) == SE3D_OK);
    CHECK(se3d_particles_hash(copy) == hash);
    CHECK(se3d_particles_step(b.particles, 2000) == SE3D_OK);
    CHECK(se3d_particles_hash(b.particles) == hash);
    se3d_particles_destroy(copy);
    bed_destroy(&b);
}

static void queries_change_nothing(void)
{
    bed a, b;
    avalanche_open(&a, 1, 0, SE3D_CONTACT_LAW_HOOKE);
    avalanche_open(&b, 1, 0, SE3D_CONTACT_LAW_HOOKE);
    static se3d_particles_contact contacts[20000];
    for (int k = 0; k < 20; ++k) {
        CHECK(se3d_particles_step(a.particles, 150) == SE3D_OK);
        CHECK(se3d_particles_step(b.particles, 150) == SE3D_OK);
        se3d_particles_energy energy;
        size_t count = se3d_particles_count_contacts(b.particles);
        CHECK(se3d_particles_get_energy(b.particles, &energy) == SE3D_OK);
        CHECK(se3d_particles_get_contacts(b.particles, count, contacts) == SE3D_OK);
    }
    CHECK(se3d_particles_hash(a.particles) == se3d_particles_hash(b.particles));
    bed_destroy(&a);
    bed_destroy(&b);
}

int main(void)
{
    RUN(bits_do_not_depend_on_the_number_of_threads);
    RUN(bits_of_a_large_set_do_not_depend_on_the_number_of_threads);
    RUN(clumps_have_the_same_bits);
    RUN(bits_do_not_depend_on_how_a_run_is_cut);
    RUN(copies_and_restored_states_continue_with_the_same_bits);
    RUN(queries_change_nothing);
    return check_finish();
}
