/* SPDX-License-Identifier: BSD-3-Clause */
/* Bonds against closed forms: cantilevers of beams, springs of parallel bonds, strengths; and what
 * must hold however they move and break: momentum, energy, turns without strain, equal bits. */
#include <stdlib.h>

#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#define PI 3.1415926535897932384626433832795

static const double none[6] = {0.0};

static void open_bed(bed *b, const double gravity[3], int32_t threads)
{
    se3d_material_def material = se3d_material_def_default();
    se3d_particles_def set = se3d_particles_def_default();
    material.density = 2000.0;
    material.stiffness = 1e4;
    material.restitution = 0.5;
    set.threads = threads;
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, gravity, &set, &material);
}

static se3d_bond_stats stats_of(const bed *b, int32_t group)
{
    se3d_bond_stats stats;
    CHECK(!se3d_particles_get_bond_stats(b->particles, group, &stats));
    return stats;
}

static double total(const bed *b)
{
    se3d_particles_energy energy;
    const se3d_bond_stats stats = stats_of(b, -1);
    CHECK(!se3d_particles_get_energy(b->particles, &energy));
    return energy.translation + energy.rotation + energy.potential + stats.energy +
           stats.dissipated + stats.released;
}

enum { LINKS = 3 };

/* How far gravity brings the spheres of a cantilever: by x and the loads beyond, with the shear of
 * Timoshenko's beam. */
static void bend_cantilever(const se3d_bond_def *def, double R, double weight, double down[LINKS])
{
    const double A = PI * R * R, I = 0.25 * A * R * R,
                 G = def->young / (2.0 * (1.0 + def->poisson));
    const double k = 6.0 * (1.0 + def->poisson) / (7.0 + 6.0 * def->poisson);
    for (int n = 0; n < LINKS; ++n) {
        const double x = (2 * n + 1) * R;
        down[n] = 0.0;
        for (int load = 0; load < LINKS; ++load) {
            const double at = (2 * load + 1) * R;
            const double near = fmin(x, at), far = fmax(x, at);
            down[n] += weight * near * near * (3.0 * far - near) / (6.0 * def->young * I);
            down[n] += def->law == SE3D_BOND_LAW_BEAM ? weight * near / (k * G * A) : 0.0;
        }
    }
}

/* A row of spheres glued to a wall and to each other sags as the beam does, from the wall on; the
 * wall carries its weight, and the moment at the root. */
static void cantilevers_sag_as_their_beams(void)
{
    const double R = 0.01, g = 1e-3, down[3] = {0.0, 0.0, -g};
    const double weight = 2000.0 * 4.0 / 3.0 * PI * R * R * R * g;
    for (int32_t law = SE3D_BOND_LAW_BEAM; law <= SE3D_BOND_LAW_SLENDER; ++law) {
        bed b;
        se3d_bond_def def = se3d_bond_def_default();
        double r[3 * LINKS], sag[LINKS], force[3], torque[3];
        size_t added = 0;
        open_bed(&b, down, 1);
        const se3d_shape wall = bed_add_plane(&b, none, (const double[3]){1.0, 0.0, 0.0});
        for (int k = 0; k < LINKS; ++k) {
            bed_add(&b, (const double[3]){(2 * k + 1) * R, 0.0, 0.0}, R, none, none);
        }
        def.law = law;
        def.young = 1e6;
        def.poisson = 0.25;
        def.damping = 1.0;
        CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, &added, NULL));
        CHECK(added == LINKS - 1);
        CHECK(!se3d_particles_bond_shape(b.particles, &def, wall, -1, &added, NULL) && added == 1);
        CHECK(!se3d_particles_run(b.particles, 2.0));
        CHECK(!se3d_particles_get_all(b.particles, LINKS, r, NULL, NULL));
        bend_cantilever(&def, R, weight, sag);
        for (int k = 0; k < LINKS; ++k) {
            CHECK_NEAR(-r[3 * k + 2] / sag[k], 1.0, 1e-6);
            CHECK_NEAR(r[3 * k + 1], 0.0, 1e-15);
        }
        CHECK(!se3d_shape_get_wrench(b.system, wall, force, torque));
        CHECK_NEAR(-force[2] / (LINKS * weight), 1.0, 1e-6);
        se3d_bond_stats root = stats_of(&b, 1);
        const double moment = weight * R * LINKS * LINKS, A = PI * R * R;
        CHECK_NEAR(torque[1] / moment, 1.0, 1e-6);
        CHECK_NEAR(root.tension / (4.0 * moment / (A * R)), 1.0, 1e-6);
        CHECK_NEAR(root.shear / (LINKS * weight / A), 1.0, 1e-6);
        bed_close(&b);
    }
}

/* Two spheres far from all, bonded; their mass and moment of inertia. */
static void open_pair(bed *b, const se3d_bond_def *def, double *mass, double *inertia)
{
    const double R = 0.01;
    open_bed(b, none, 1);
    bed_add(b, none, R, none, none);
    bed_add(b, (const double[3]){2.0 * R, 0.0, 0.0}, R, none, none);
    CHECK(!se3d_particles_bond(b->particles, def, 1, (const uint32_t[1]){0}, (const uint32_t[1]){1},
                               NULL));
    *mass = 2000.0 * 4.0 / 3.0 * PI * R * R * R;
    *inertia = 0.4 * *mass * R * R;
}

/* Each of the springs of a parallel bond: what one quarter of its period after a push it holds, and
 * that the push is gone then. */
static void parallel_bonds_swing_at_their_frequencies(void)
{
    const double R = 0.01, A = PI * R * R, I = 0.25 * A * R * R, small = 1e-6;
    se3d_bond_def def = se3d_bond_def_default();
    def.law = SE3D_BOND_LAW_PARALLEL;
    def.normal_stiffness = 3e8;
    def.shear_stiffness = 1e8;
    for (int mode = 0; mode < 3; ++mode) {
        bed b;
        double mass, inertia, v[6], w[6];
        open_pair(&b, &def, &mass, &inertia);
        /* along; bending, the ends against each other about y; twisting */
        const double omega = mode == 0   ? sqrt(2.0 * def.normal_stiffness * A / mass)
                             : mode == 1 ? sqrt(2.0 * def.normal_stiffness * I / inertia)
                                         : sqrt(4.0 * def.shear_stiffness * I / inertia);
        const double push[6] = {-small, 0.0, 0.0, small, 0.0, 0.0};
        const double tilt[6] = {0.0, -small, 0.0, 0.0, small, 0.0};
        CHECK(!se3d_particles_set_all(b.particles, 2, NULL, mode == 0 ? push : none,
                                      mode == 0   ? none
                                      : mode == 1 ? tilt
                                                  : push));
        CHECK(!se3d_particles_set_step(b.particles, 1e-3 / omega));
        CHECK(!se3d_particles_run(b.particles, 0.5 * PI / omega));
        CHECK(!se3d_particles_get_all(b.particles, 2, NULL, v, w));
        for (int k = 0; k < 6; ++k) {
            CHECK_NEAR(v[k], 0.0, 1e-5 * small);
            CHECK_NEAR(w[k], 0.0, 1e-5 * small);
        }
        const double kinetic = small * small * (mode == 0 ? mass : inertia);
        CHECK_NEAR(stats_of(&b, 0).energy / kinetic, 1.0, 1e-5);
        bed_close(&b);
    }
}

/* Springs of a bond as they are given, whatever the section. In mode 0 to 3 two spheres are pushed
 * along, across (both turn about y, and the shear that this makes moves them), bent and twisted. */
static const double springs[4] = {2e4, 5e3, 0.3, 0.7}, reach = 0.02; /* length of the bond */

static void push_pair(const bed *b, int mode, double size)
{
    double v[6] = {0.0}, w[6] = {0.0};
    for (int k = 0; k < 2; ++k) {
        const double sign = k ? 1.0 : -1.0;
        v[3 * k] = mode == 0 ? sign * size : 0.0;
        w[3 * k + 1] = mode == 1 ? size : mode == 2 ? sign * size : 0.0;
        w[3 * k] = mode == 3 ? sign * size : 0.0;
    }
    CHECK(!se3d_particles_set_all(b->particles, 2, NULL, v, w));
}

/* The inverse of the mass that the spring of this mode moves. */
static double ease(int mode, double mass, double inertia)
{
    return mode == 0   ? 2.0 / mass
           : mode == 1 ? 2.0 / mass + 0.5 * reach * reach / inertia
                       : 2.0 / inertia;
}

static void given_springs_and_dampers_swing(void)
{
    const double small = 1e-6;
    for (int mode = 0; mode < 4; ++mode) {
        bed b;
        se3d_bond_def def = se3d_bond_def_default();
        double mass, inertia, v[6], w[6];
        def.law = SE3D_BOND_LAW_SPRINGS;
        memcpy(def.springs, springs, sizeof springs);
        open_pair(&b, &def, &mass, &inertia);
        bed_close(&b);
        const double omega = sqrt(springs[mode] * ease(mode, mass, inertia)), zeta = 0.1;
        def.dampers[mode] = 2.0 * zeta * springs[mode] / omega;
        open_pair(&b, &def, &mass, &inertia);
        push_pair(&b, mode, small);
        const double t = 2.3 / omega, wd = omega * sqrt(1.0 - zeta * zeta);
        CHECK(!se3d_particles_set_step(b.particles, 1e-3 / omega));
        CHECK(!se3d_particles_run(b.particles, t));
        CHECK(!se3d_particles_get_all(b.particles, 2, NULL, v, w));
        const double left = exp(-zeta * omega * t) *
                            (cos(wd * t) - zeta * omega / wd * sin(wd * t)); /* of the rate */
        const double part = 0.5 * reach * reach / inertia / ease(1, mass, inertia);
        CHECK_NEAR(mode == 0   ? v[3]
                   : mode == 3 ? w[3]
                               : w[4],
                   small * (mode == 1 ? 1.0 - part * (1.0 - left) : left), 1e-4 * small);
        bed_close(&b);
    }
}

/* What is fixed later is a wall, also for the damping of its bonds; let go, it is as before. */
static void bonds_of_what_is_fixed_damp_by_the_other_mass(void)
{
    const double small = 1e-6, zeta = 0.1;
    const uint32_t first = 0;
    for (int fixed = 0; fixed < 3; ++fixed) { /* 2: and let go */
        bed b;
        se3d_bond_def def = se3d_bond_def_default();
        double mass, inertia, v[6], w[6];
        def.law = SE3D_BOND_LAW_SPRINGS;
        def.damping = zeta;
        memcpy(def.springs, springs, sizeof springs);
        open_pair(&b, &def, &mass, &inertia);
        if (fixed > 0) {
            CHECK(!se3d_particles_set_fixed(b.particles, 1, &first, 1));
        }
        if (fixed == 2) {
            CHECK(!se3d_particles_set_fixed(b.particles, 1, &first, 0));
        }
        const double m = fixed == 1 ? mass : 0.5 * mass, omega = sqrt(springs[0] / m);
        const double push[6] = {fixed == 1 ? 0.0 : -small, 0.0, 0.0, small, 0.0, 0.0};
        CHECK(!se3d_particles_set_all(b.particles, 2, NULL, push, none));
        const double t = 5.0 / omega, wd = omega * sqrt(1.0 - zeta * zeta);
        CHECK(!se3d_particles_set_step(b.particles, 1e-3 / omega));
        CHECK(!se3d_particles_run(b.particles, t));
        CHECK(!se3d_particles_get_all(b.particles, 2, NULL, v, w));
        CHECK_NEAR(v[3],
                   small * exp(-zeta * omega * t) * (cos(wd * t) - zeta * omega / wd * sin(wd * t)),
                   1e-3 * small);
        bed_close(&b);
    }
}

/* The largest that the swing of a push of this size holds. */
static double most_of(int mode, double size, double spring, double mass, double inertia)
{
    return (mode == 1 ? reach : 2.0) * size * sqrt(spring / ease(mode, mass, inertia));
}

/* Just below and just above the limit, of each alone; of two that swing alike, what they hold over
 * their limits adds up. A bond with a smooth end, which lets go little by little, takes a third of
 * N_max^2/k rather than a half, and gives it back if it does not break. */
static void given_limits_decide(void)
{
    const double size = 1e-4;
    for (int n = 0; n < 20; ++n) {
        const int mode = n / 2 % 5, both = mode == 4, smooth = n >= 10;
        const double factor = (n % 2 ? 1.01 : 0.99) * (smooth ? sqrt(1.5) : 1.0);
        bed b;
        se3d_bond_def def = se3d_bond_def_default();
        double mass, inertia;
        def.law = SE3D_BOND_LAW_SPRINGS;
        memcpy(def.springs, springs, sizeof springs);
        open_pair(&b, &def, &mass, &inertia);
        bed_close(&b);
        for (int k = 0; k < 4; ++k) {
            const int held = both ? k == 0 || k == 3 : k == mode;
            def.springs[k] = both && k == 3 ? springs[0] * inertia / mass : springs[k];
            const double most = most_of(k, size, def.springs[k], mass, inertia);
            def.limits[k] = held ? (both ? 2.0 : 1.0) * factor * most : 0.0;
        }
        def.smooth = smooth;
        open_pair(&b, &def, &mass, &inertia);
        if (both) {
            const double v[6] = {-size, 0.0, 0.0, size, 0.0, 0.0};
            CHECK(!se3d_particles_set_all(b.particles, 2, NULL, v, v));
        } else {
            push_pair(&b, mode, size);
        }
        const double before = total(&b);
        CHECK(!se3d_particles_run(b.particles, 10.0 * sqrt(mass / springs[1])));
        const se3d_bond_stats stats = stats_of(&b, 0);
        CHECK_NEAR(total(&b) / before, 1.0, 1e-3);
        CHECK_NEAR(stats.dissipated, 0.0, 2e-2 * before);
        CHECK(stats.count == (uint64_t)(n % 2));
        CHECK(stats.torn + stats.sheared == (uint64_t)(n % 2 == 0));
        CHECK(both || stats.torn == (uint64_t)(n % 2 == 0 && mode % 2 == 0));
        bed_close(&b);
    }
}

/* Spheres that turn as one body, far around, stay without strain but for what their spin pulls. */
static void turns_of_the_whole_strain_nothing(void)
{
    const double W[3] = {0.3, -0.5, 0.8};
    bed b;
    se3d_bond_def def = se3d_bond_def_default();
    double r[12] = {0.0}, v[12], w[12];
    def.young = 1e7;
    def.poisson = 0.3;
    open_bed(&b, none, 1);
    for (int k = 0; k < 4; ++k) {
        r[3 * k] = k % 2 ? 0.02 : 0.0;
        r[3 * k + 1] = k > 1 ? 0.02 : 0.0;
        bed_add(&b, r + 3 * k, 0.01, none, none);
        const double d[3] = {r[3 * k] - 0.01, r[3 * k + 1] - 0.01, 0.0};
        v[3 * k] = W[1] * d[2] - W[2] * d[1];
        v[3 * k + 1] = W[2] * d[0] - W[0] * d[2];
        v[3 * k + 2] = W[0] * d[1] - W[1] * d[0];
        memcpy(w + 3 * k, W, sizeof W);
    }
    CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, NULL, NULL));
    CHECK(stats_of(&b, 0).count == 4);
    CHECK(!se3d_particles_set_all(b.particles, 4, NULL, v, w));
    const double before = total(&b);
    CHECK(!se3d_particles_run(b.particles, 7.0)); /* once around */
    CHECK_NEAR(total(&b) / before, 1.0, 1e-8);
    CHECK(stats_of(&b, 0).energy < 1e-6 * before);
    bed_close(&b);
}

/* A block of bonded spheres whose parts fly at each other at random. */
static void open_block(bed *b, double damping, double strength, int32_t threads)
{
    se3d_fill_def fill = se3d_fill_def_default();
    se3d_bond_def def = se3d_bond_def_default();
    double v[3 * 64], w[3 * 64];
    uint32_t seed = 7;
    size_t added = 0;
    open_bed(b, none, threads);
    fill.material = b->material;
    fill.radius_min = fill.radius_max = 0.01;
    fill.spacing = 0.03; /* so that nothing touches for a while */
    for (int a = 0; a < 3; ++a) {
        fill.upper[a] = 0.1201;
    }
    CHECK(!se3d_particles_fill_lattice(b->particles, &fill, NULL));
    CHECK(se3d_particles_count(b->particles) == 64);
    def.young = 1e6;
    def.poisson = 0.2;
    def.gap = 0.0101;
    def.damping = damping;
    def.tensile_strength = strength;
    def.shear_strength = 0.3 * strength;
    CHECK(!se3d_particles_bond_near(b->particles, &def, -1, -1, &added, NULL) && added == 144);
    for (int k = 0; k < 3 * 64; ++k) {
        seed = seed * 1664525U + 1013904223U;
        v[k] = 0.1 * ((double)(seed >> 8) / 8388608.0 - 1.0);
        seed = seed * 1664525U + 1013904223U;
        w[k] = 10.0 * ((double)(seed >> 8) / 8388608.0 - 1.0);
    }
    CHECK(!se3d_particles_set_all(b->particles, 64, NULL, v, w));
}

static void momenta(const bed *b, double linear[3], double angular[3])
{
    double r[3 * 64], v[3 * 64], w[3 * 64];
    CHECK(!se3d_particles_get_all(b->particles, 64, r, v, w));
    for (int a = 0; a < 3; ++a) {
        const int n = (a + 1) % 3, m = (a + 2) % 3;
        linear[a] = angular[a] = 0.0;
        for (int k = 0; k < 64; ++k) {
            const double *x = r + 3 * k, *u = v + 3 * k;
            linear[a] += u[a];
            angular[a] += x[n] * u[m] - x[m] * u[n] + 0.4 * 1e-4 * w[3 * k + a];
        }
    }
}

/* Without damping and breaks the error of the energy is of the square of the step; momenta stay. */
static void energy_and_momenta_of_a_block_stay(void)
{
    double error[2];
    for (int n = 0; n < 2; ++n) {
        bed b;
        double linear[2][3], angular[2][3], step;
        open_block(&b, 0.0, 0.0, 1);
        CHECK(!se3d_particles_get_step(b.particles, &step));
        CHECK(!se3d_particles_set_step(b.particles, n ? 0.5 * step : step));
        const double before = total(&b);
        momenta(&b, linear[0], angular[0]);
        CHECK(!se3d_particles_run(b.particles, 0.2));
        error[n] = fabs(total(&b) / before - 1.0);
        momenta(&b, linear[1], angular[1]);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(linear[1][a], linear[0][a], 1e-13);
            CHECK_NEAR(angular[1][a], angular[0][a], 1e-14);
        }
        bed_close(&b);
    }
    printf("energy: %g, with half of the step %g\n", error[0], error[1]);
    CHECK(error[0] < 1e-3 && error[1] < 0.35 * error[0]);
}

/* Three dumb-bells in a row, held at their ends, that turn and fly at each other: the error of the
 * energy after 0.1 s, without damping. */
static double swing_clumps(double part_of_step)
{
    const double spheres[6] = {-0.009, 0.0, 0.0, 0.009, 0.0, 0.0}, radius[2] = {0.01, 0.01};
    const double r[9] = {0.0, 0.0, 0.0, 0.05, 0.0, 0.0, 0.1, 0.0, 0.0};
    const double v[9] = {0.1, 0.02, 0.0, 0.0, -0.03, 0.05, -0.1, 0.0, -0.04};
    const double w[9] = {3.0, 5.0, -4.0, -6.0, 2.0, 1.0, 4.0, -3.0, 2.0};
    se3d_clump_def clump = se3d_clump_def_default();
    se3d_bond_def def = se3d_bond_def_default();
    size_t added = 0;
    double step;
    bed b;
    open_bed(&b, none, 1);
    clump.count = 2;
    clump.r = spheres;
    clump.radius = radius;
    CHECK(!se3d_particles_add_clump_template(b.particles, &clump, NULL));
    CHECK(!se3d_particles_add_clumps(b.particles, 0, b.material, 3, r, NULL, v, w));
    def.young = 1e6;
    def.poisson = 0.2;
    def.gap = 0.0121;
    CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, &added, NULL) && added == 2);
    CHECK(!se3d_particles_get_step(b.particles, &step));
    CHECK(!se3d_particles_set_step(b.particles, part_of_step * step));
    const double before = total(&b);
    double most = 0.0;
    for (int k = 0; k < 20; ++k) {
        CHECK(!se3d_particles_run(b.particles, 0.005 * (k + 1)));
        most = fmax(most, stats_of(&b, 0).energy);
    }
    const double error = fabs(total(&b) / before - 1.0);
    CHECK(most > 0.05 * before);
    bed_close(&b);
    return error;
}

static void energy_of_bonded_clumps_stays(void)
{
    const double whole = swing_clumps(1.0), half = swing_clumps(0.5);
    printf("clumps: energy %g, with half of the step %g\n", whole, half);
    CHECK(whole < 1e-3 && half < 0.5 * whole);
}

/* A bed of a soft material, without gravity. */
static void open_soft(bed *b, const se3d_particles_def *set)
{
    se3d_material_def material = se3d_material_def_default();
    material.density = 1000.0;
    material.stiffness = 1e4;
    bed_open(b, SE3D_CONTACT_LAW_HOOKE, none, set, &material);
}

/* What a cell that shears does goes to motion and bonds: the error, as a part of the work. */
static double shear_lattice(double part_of_step)
{
    se3d_particles_def set = se3d_particles_def_default();
    se3d_cell_state cell;
    size_t added = 0;
    double v[3 * 64], step;
    bed b;
    for (int a = 0; a < 3; ++a) {
        set.boundary[a] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        set.upper[a] = 0.1;
    }
    open_soft(&b, &set);
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = b.material;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = 0.1;
    fill.radius_min = fill.radius_max = 0.01;
    fill.spacing = 0.025;
    CHECK(!se3d_particles_fill_lattice(b.particles, &fill, NULL));
    CHECK(se3d_particles_count(b.particles) == 64);
    for (int k = 0; k < 3 * 64; ++k) {
        v[k] = 0.01 * (k * 37 % 64 / 31.5 - 1.0);
    }
    CHECK(!se3d_particles_set_all(b.particles, 64, NULL, v, NULL));
    se3d_bond_def def = se3d_bond_def_default();
    def.young = 1e6;
    def.gap = 0.0051;
    CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, &added, NULL) && added == 192);
    se3d_cell_def stage = se3d_cell_def_default();
    stage.shear_rate = 2.0;
    stage.rate[0] = -1.0;
    CHECK(!se3d_particles_add_cell_stage(b.particles, &stage, NULL));
    CHECK(!se3d_particles_get_step(b.particles, &step));
    CHECK(!se3d_particles_set_step(b.particles, part_of_step * step));
    CHECK(!se3d_particles_step(b.particles, 1));
    CHECK(!se3d_particles_get_cell(b.particles, &cell));
    const double first = cell.kinetic_energy + stats_of(&b, -1).energy - cell.work;
    CHECK(!se3d_particles_run(b.particles, 0.05));
    CHECK(!se3d_particles_get_cell(b.particles, &cell));
    const double stored = stats_of(&b, -1).energy;
    CHECK(stored > 0.1 * cell.work && cell.work > 0.0);
    const double error = fabs(cell.kinetic_energy + stored - cell.work - first) / cell.work;
    bed_close(&b);
    return error;
}

static void work_of_a_cell_goes_into_bonds(void)
{
    const double whole = shear_lattice(1.0), half = shear_lattice(0.5);
    printf("cell: %g of the work, with half of the step %g\n", whole, half);
    CHECK(whole < 1e-4 && half < 1e-4);
}

/* What is damped and what goes with bonds that break is told; the sum stays. */
static double break_block(double part_of_step)
{
    bed b;
    double step;
    open_block(&b, 0.1, 4000.0, 1);
    CHECK(!se3d_particles_get_step(b.particles, &step));
    CHECK(!se3d_particles_set_step(b.particles, part_of_step * step));
    const double before = total(&b);
    CHECK(!se3d_particles_run(b.particles, 0.02));
    const se3d_bond_stats stats = stats_of(&b, 0);
    printf("held %llu, torn %llu, sheared %llu; energy %g of it damped %g, released %g, error %g\n",
           (unsigned long long)stats.count, (unsigned long long)stats.torn,
           (unsigned long long)stats.sheared, before, stats.dissipated, stats.released,
           total(&b) / before - 1.0);
    CHECK(stats.torn > 10 && stats.sheared > 0 && stats.count > 10);
    CHECK(stats.count + stats.torn + stats.sheared == 144 && stats.lost == 0);
    CHECK(stats.dissipated > 0.1 * before && stats.released > 0.001 * before);
    const double error = total(&b) / before - 1.0;
    bed_close(&b);
    return fabs(error);
}

static void energy_of_a_block_that_breaks_is_told(void)
{
    CHECK(break_block(1.0) < 1e-3);
    CHECK(break_block(0.5) < 3e-4);
}

/* Two spheres that a glued one holds: of a load that comes at once the stress is twice the still
 * one. */
static void strength_decides(void)
{
    const double R = 0.01, down[3] = {0.0, 0.0, -9.81};
    const double stress = 2000.0 * 4.0 / 3.0 * PI * R * R * R * 9.81 / (PI * R * R);
    for (int n = 0; n < 4; ++n) {
        bed b;
        se3d_bond_def def = se3d_bond_def_default();
        const double strength = (n % 2 ? 2.02 : 1.98) * stress;
        open_bed(&b, down, 1);
        /* hung below a ceiling; on the side of a wall, whose bond is as short as the radius */
        const double ceiling[3] = {0.0, 0.0, -1.0}, side[3] = {1.0, 0.0, 0.0};
        const se3d_shape wall = bed_add_plane(&b, none, n < 2 ? ceiling : side);
        bed_add(&b, (const double[3]){n < 2 ? 0.0 : R, 0.0, n < 2 ? -R : 0.0}, R, none, none);
        def.law = SE3D_BOND_LAW_PARALLEL;
        def.normal_stiffness = 1e9;
        def.shear_stiffness = 1e7;
        def.tensile_strength = n < 2 ? strength : 0.0;
        def.shear_strength = n < 2 ? 0.0 : strength;
        CHECK(!se3d_particles_bond_shape(b.particles, &def, wall, -1, NULL, NULL));
        CHECK(!se3d_particles_run(b.particles, 0.05));
        const se3d_bond_stats stats = stats_of(&b, 0);
        CHECK(stats.count == (uint64_t)(n % 2));
        CHECK(stats.torn == (uint64_t)(n == 0) && stats.sheared == (uint64_t)(n == 2));
        bed_close(&b);
    }
}

/* Bonded spheres that overlap do not push each other, unless they are to touch. */
static void bonds_decide_who_touches(void)
{
    for (int touch = 0; touch < 2; ++touch) {
        bed b;
        se3d_bond_def def = se3d_bond_def_default();
        double force[6];
        open_bed(&b, none, 1);
        bed_add(&b, none, 0.01, none, none);
        bed_add(&b, (const double[3]){0.019, 0.0, 0.0}, 0.01, none, none);
        def.young = 1e6;
        def.contact = touch;
        CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, NULL, NULL));
        CHECK(!se3d_particles_step(b.particles, 1));
        CHECK(!se3d_particles_get_forces(b.particles, 2, force, NULL));
        CHECK(touch ? force[3] > 1.0 : fabs(force[3]) < 1e-9);
        CHECK(se3d_particles_count_contacts(b.particles) == (size_t)touch);
        bed_close(&b);
    }
}

/* Particles may have been added, or have flown, far out of the period. */
static void images_that_are_near_are_bonded(void)
{
    const double r[9] = {-1.99, 0.0, 0.0, 0.03, 0.0, 0.0, 3.5, 0.0, 0.01};
    const double radius[3] = {0.01, 0.01, 0.01};
    se3d_particles_def set = se3d_particles_def_default();
    se3d_shape_def plane = se3d_shape_def_default();
    se3d_shape shape;
    size_t added = 0;
    bed b;
    set.boundary[0] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
    set.upper[0] = 1.0;
    open_soft(&b, &set);
    CHECK(!se3d_particles_add(b.particles, b.material, 3, r, radius, NULL, NULL, NULL));
    se3d_bond_def def = se3d_bond_def_default();
    def.young = 1e6;
    CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, &added, NULL) && added == 1);
    plane.material = b.material;
    plane.size[0] = plane.size[1] = plane.size[2] = 0.1;
    plane.position[0] = 0.5;
    plane.position[2] = -0.05;
    CHECK(!se3d_shape_create_box(b.system, &plane, &shape));
    CHECK(!se3d_particles_bond_shape(b.particles, &def, shape, -1, &added, NULL) && added == 1);
    CHECK(!se3d_particles_step(b.particles, 10));
    CHECK(stats_of(&b, -1).count == 2 && stats_of(&b, -1).energy < 1e-20);
    bed_close(&b);
}

/* Pairs of a cubic lattice, in a period and without; between two tags; gone with their spheres. */
static void near_spheres_are_bonded_once(void)
{
    for (int periodic = 0; periodic < 2; ++periodic) {
        se3d_material_def material = se3d_material_def_default();
        se3d_particles_def set = se3d_particles_def_default();
        se3d_fill_def fill = se3d_fill_def_default();
        se3d_bond_def def = se3d_bond_def_default();
        size_t added = 0;
        uint32_t group = 7;
        bed b;
        material.density = 1000.0;
        material.stiffness = 1e4;
        for (int a = 0; a < 3; ++a) {
            set.boundary[a] = periodic ? SE3D_DOMAIN_BOUNDARY_PERIODIC : SE3D_DOMAIN_BOUNDARY_OPEN;
            set.upper[a] = fill.upper[a] = a == 1 ? 0.2 : 0.1;
        }
        bed_open(&b, SE3D_CONTACT_LAW_HOOKE, none, &set, &material);
        fill.material = b.material;
        fill.radius_min = fill.radius_max = 0.01;
        fill.spacing = 0.02;
        CHECK(!se3d_particles_fill_lattice(b.particles, &fill, NULL));
        CHECK(se3d_particles_count(b.particles) == 250);
        CHECK(!se3d_particles_set_tags(b.particles, 2, (const uint32_t[2]){0, 1}, 3));
        def.young = 1e6;
        CHECK(!se3d_particles_bond_near(b.particles, &def, 3, 0, &added, NULL));
        CHECK(added == (periodic ? 10 : 5)); /* but not the two with each other */
        CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, &added, &group) && group == 1);
        CHECK(added == (periodic ? 750 - 10 : 5 * 5 * 9 + 2 * 4 * 5 * 10 - 5));
        CHECK(!se3d_particles_bond_near(b.particles, &def, -1, -1, &added, NULL) && added == 0);
        CHECK(!se3d_particles_step(b.particles, 10));
        CHECK(stats_of(&b, -1).energy < 1e-20);
        CHECK(!se3d_particles_remove(b.particles, 2, (const uint32_t[2]){0, 1}));
        CHECK(stats_of(&b, 0).lost == (periodic ? 10 : 5) && stats_of(&b, 1).lost == 1);
        CHECK(!se3d_particles_step(b.particles, 10));
        bed_close(&b);
    }
}

static void bits_do_not_depend_on_threads(void)
{
    uint64_t hash[3];
    static const int32_t threads[3] = {1, 3, 16};
    for (int n = 0; n < 3; ++n) {
        bed b;
        open_block(&b, 0.1, 4000.0, threads[n]);
        CHECK(!se3d_particles_run(b.particles, 0.02));
        hash[n] = se3d_particles_hash(b.particles);
        CHECK(hash[n] == hash[0]);
        bed_close(&b);
    }
}

int main(void)
{
    RUN(cantilevers_sag_as_their_beams);
    RUN(parallel_bonds_swing_at_their_frequencies);
    RUN(given_springs_and_dampers_swing);
    RUN(given_limits_decide);
    RUN(bonds_of_what_is_fixed_damp_by_the_other_mass);
    RUN(turns_of_the_whole_strain_nothing);
    RUN(energy_and_momenta_of_a_block_stay);
    RUN(energy_of_a_block_that_breaks_is_told);
    RUN(energy_of_bonded_clumps_stays);
    RUN(work_of_a_cell_goes_into_bonds);
    RUN(strength_decides);
    RUN(bonds_decide_who_touches);
    RUN(near_spheres_are_bonded_once);
    RUN(images_that_are_near_are_bonded);
    RUN(bits_do_not_depend_on_threads);
    return check_finish();
}
