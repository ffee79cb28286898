/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy that particles lose: one bounce, one slide against closed forms; heaps with all
 * kinds of resistance, whose energies close. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846
#define G  9.81

static const double none[3] = {0.0, 0.0, 0.0};

static se3d_material_def stuff(double restitution, double rolling)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 2500.0;
    def.stiffness = 2e4;
    def.young = 1e7;
    def.friction = 0.4;
    def.restitution = restitution;
    def.rolling_friction = rolling;
    def.torsional_friction = 0.5 * rolling;
    def.rolling_ratio = 0.6;
    def.tangential_damping = 0.7;
    return def;
}

static void open_bed(bed *b, int32_t law, double gravity, int32_t threads,
                     const se3d_material_def *material)
{
    static const double up[3] = {0.0, 0.0, 1.0};
    const double down[3] = {0.0, 0.0, -gravity};
    se3d_particles_def def = se3d_particles_def_default();
    def.audit = 1;
    def.threads = threads;
    bed_open(b, law, down, &def, material);
    bed_add_plane(b, none, up);
}

static se3d_particles_dissipation lost(const bed *b)
{
    se3d_particles_dissipation d;
    CHECK(!se3d_particles_get_dissipation(b->particles, &d));
    return d;
}

static double all_of(const bed *b)
{
    const se3d_particles_dissipation d = lost(b);
    se3d_particles_energy e;
    CHECK(!se3d_particles_get_energy(b->particles, &e));
    return e.translation + e.rotation + e.potential + d.elastic + d.normal + d.tangential +
           d.rolling + d.torsion + d.bonds - d.wall_work;
}

static void bounce_loses_what_its_restitution_takes(void)
{
    static const int32_t laws[2] = {SE3D_CONTACT_LAW_HOOKE, SE3D_CONTACT_LAW_HERTZ_MINDLIN};
    for (int k = 0; k < 2; ++k) {
        bed b;
        const se3d_material_def material = stuff(0.6, 0.0);
        const double r[3] = {0.0, 0.0, 0.0101}, v[3] = {0.0, 0.0, -0.5};
        const double energy = 0.5 * 2500.0 * 4.0 / 3.0 * PI * 1e-6 * 0.25;
        open_bed(&b, laws[k], 0.0, 1, &material);
        bed_add(&b, r, 0.01, v, NULL);
        CHECK(se3d_particles_run(b.particles, 0.02) >= 0);
        CHECK(se3d_particles_count_contacts(b.particles) == 0);
        CHECK_NEAR(lost(&b).normal / energy, 1.0 - 0.36, 0.01);
        CHECK_NEAR(lost(&b).tangential / energy, 0.0, 1e-12);
        CHECK_NEAR(lost(&b).elastic, 0.0, 0.0);
        CHECK_NEAR(all_of(&b) / energy, 1.0, 0.01);
        bed_close(&b);
    }
}

/* It slides until it rolls with 5/7 of its speed. */
static void slide_loses_two_sevenths(void)
{
    bed b;
    const se3d_material_def material = stuff(0.5, 0.0);
    const double mass = 2500.0 * 4.0 / 3.0 * PI * 1e-6;
    const double v[3] = {0.3, -0.4, 0.0}, r[3] = {0.0, 0.0, 0.01 - 0.5 * mass * G / 2e4};
    open_bed(&b, SE3D_CONTACT_LAW_HOOKE, G, 1, &material);
    bed_add(&b, r, 0.01, v, NULL);
    CHECK(se3d_particles_run(b.particles, 0.2) >= 0);
    CHECK_NEAR(lost(&b).tangential / (0.5 * mass * 0.25), 2.0 / 7.0, 2e-3);
    CHECK_NEAR(lost(&b).normal, 0.0, 1e-5 * mass);
    bed_close(&b);
}

/* A heap that falls between walls, one of which comes up; returns the part that is missing. */
static double heap(int32_t law, int32_t threads, uint64_t *hash)
{
    bed b;
    const se3d_material_def material = stuff(0.5, 0.2);
    const double sides[4][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}};
    se3d_fill_def fill = se3d_fill_def_default();
    open_bed(&b, law, G, threads, &material);
    for (int k = 0; k < 4; ++k) {
        const double at[3] = {-0.05 * sides[k][0], -0.05 * sides[k][1], 0.0};
        bed_add_plane(&b, at, sides[k]);
    }
    const double high[3] = {0.0, 0.0, 0.13}, down[3] = {0.0, 0.0, -1.0};
    se3d_servo_def lid = se3d_servo_def_default();
    lid.shape = bed_add_plane(&b, high, down);
    lid.axis[2] = -1.0;
    lid.load = 5.0;
    lid.speed_max = 0.5;
    CHECK(!se3d_particles_add_servo(b.particles, &lid, NULL));
    fill.material = b.material;
    fill.lower[0] = fill.lower[1] = -0.05;
    fill.upper[0] = fill.upper[1] = 0.05;
    fill.upper[2] = 0.12;
    fill.radius_min = 0.008;
    fill.radius_max = 0.01;
    fill.jitter = 0.0005;
    fill.velocity[0] = 0.5;
    CHECK(!se3d_particles_fill_lattice(b.particles, &fill, NULL));
    const double before = all_of(&b);
    CHECK(se3d_particles_run(b.particles, 0.15) >= 0);
    const se3d_particles_dissipation d = lost(&b);
    const double total = d.normal + d.tangential + d.rolling + d.torsion;
    CHECK(d.normal > 0.05 * total && d.tangential > 0.05 * total);
    CHECK(d.rolling > 0.001 * total && d.torsion > 1e-5 * total && d.wall_work > 0.0);
    *hash = se3d_particles_hash(b.particles);
    const double missing = (all_of(&b) - before) / total;
    bed_close(&b);
    return missing;
}

static void energies_of_a_heap_close(void)
{
    uint64_t one, three;
    const double missing = heap(SE3D_CONTACT_LAW_HOOKE, 1, &one);
    CHECK_NEAR(heap(SE3D_CONTACT_LAW_HOOKE, 3, &three), missing, 0.0);
    CHECK(one == three);
    CHECK_NEAR(missing, 0.0, 2e-3);
    CHECK_NEAR(heap(SE3D_CONTACT_LAW_HERTZ_MINDLIN, 1, &one), 0.0, 2e-3);
}

/* Two balls, or one on a plane, that meet at any angle and with any spin: how far all energies are
 * from what they were, at any of the moments, over what there is. */
static double oblique(int32_t law, int has_plane, uint64_t *seed, size_t parts)
{
    static const double up[3] = {0.0, 0.0, 1.0};
    bed b;
    double h, missing = 0.0, speed[3], spin[3];
    se3d_particles_def def = se3d_particles_def_default();
    se3d_material_def material =
        stuff(0.6 + 0.4 * check_random(seed), 0.1 + 0.1 * check_random(seed));
    const double high[3] = {0.0, 0.0, 0.0101}, low[3] = {0.0, 0.0, -0.0098};
    def.audit = 1;
    material.poisson = 0.25 + 0.25 * check_random(seed);
    for (int k = 0; k < 3; ++k) {
        speed[k] = k < 2 ? check_random(seed) : -1.0;
        spin[k] = 50.0 * check_random(seed);
    }
    bed_open(&b, law, none, &def, &material);
    if (has_plane) {
        bed_add_plane(&b, none, up);
    } else {
        bed_add(&b, low, 0.009, none, none);
    }
    bed_add(&b, high, 0.01, speed, spin);
    CHECK(!se3d_particles_get_step(b.particles, &h));
    CHECK(!se3d_particles_set_step(b.particles, h / (double)parts));
    const double before = all_of(&b);
    for (int k = 0; k < 400; ++k) {
        CHECK(se3d_particles_step(b.particles, parts) >= 0);
        missing = fmax(missing, fabs(all_of(&b) / before - 1.0));
    }
    CHECK(lost(&b).tangential > 1e-5 * before && se3d_particles_count_contacts(b.particles) == 0);
    bed_close(&b);
    return missing;
}

/* Also while they slip, and although the tangential stiffness of hertz_mindlin follows the overlap:
 * what is missing is the error of the motion, of the second order. */
static void oblique_impacts_close_to_second_order(void)
{
    static const int32_t laws[2] = {SE3D_CONTACT_LAW_HOOKE, SE3D_CONTACT_LAW_HERTZ_MINDLIN};
    for (int k = 0; k < 4; ++k) {
        double coarse = 0.0, fine = 0.0;
        uint64_t seed = 7, same = 7;
        for (int n = 0; n < 5; ++n) {
            coarse = fmax(coarse, oblique(laws[k / 2], k % 2, &seed, 4));
            fine = fmax(fine, oblique(laws[k / 2], k % 2, &same, 32));
        }
        CHECK(coarse < 1e-4);
        CHECK(fine < coarse / 40.0);
    }
}

/* Kernels with and without vectors give the same numbers; a set that is not audited the same
 * motion. */
static void audits_change_no_bits(void)
{
    uint64_t hashes[3];
    double normal[3] = {0.0}, places[3][120], speeds[3][120];
    for (int k = 0; k < 3; ++k) {
        bed b;
        static const double up[3] = {0.0, 0.3, 1.0}, down[3] = {0.0, 0.0, -G};
        se3d_particles_def def = se3d_particles_def_default();
        const se3d_material_def material = stuff(0.5, 0.1);
        def.portable = k == 1;
        def.audit = k < 2;
        bed_open(&b, SE3D_CONTACT_LAW_HERTZ_MINDLIN, down, &def, &material);
        bed_add_plane(&b, none, up);
        for (int n = 0; n < 40; ++n) {
            const double r[3] = {0.018 * (n % 4), 0.019 * (n / 4 % 4), 0.05 + 0.019 * (n / 16)};
            bed_add(&b, r, 0.0098 - 0.0001 * n, NULL, NULL);
        }
        CHECK(se3d_particles_run(b.particles, 0.1) >= 0);
        se3d_particles_dissipation d;
        CHECK(se3d_particles_get_dissipation(b.particles, &d) ==
              (k < 2 ? SE3D_OK : SE3D_ERR_STATE));
        normal[k] = k < 2 ? d.normal + d.tangential : 0.0;
        hashes[k] = se3d_particles_hash(b.particles);
        CHECK(!se3d_particles_get_all(b.particles, 40, places[k], speeds[k], NULL));
        bed_close(&b);
    }
    CHECK(hashes[0] == hashes[1] && hashes[0] != hashes[2]); /* what is lost is hashed, too */
    CHECK(!memcmp(places[0], places[2], sizeof places[0]));
    CHECK(!memcmp(speeds[0], speeds[2], sizeof speeds[0]));
    CHECK(normal[0] > 0.0 && normal[0] == normal[1]);
}

int main(void)
{
    RUN(bounce_loses_what_its_restitution_takes);
    RUN(slide_loses_two_sevenths);
    RUN(energies_of_a_heap_close);
    RUN(oblique_impacts_close_to_second_order);
    RUN(audits_change_no_bits);
    return check_finish();
}
