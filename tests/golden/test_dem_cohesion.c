/* SPDX-License-Identifier: BSD-3-Clause */
/* Cohesion against closed forms: pull-off force, equilibrium, work of separation
 * (docs/theory/contact-laws.md; the first two are those of Johnson, Kendall and Roberts 1971). */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#define PI      3.1415926535897932384626433832795
#define RADIUS  0.005
#define DENSITY 2500.0
#define GAMMA   0.3 /* J/m^2 */
#define E_STAR  (1e7 / (2.0 * (1.0 - 0.09)))
#define KN      2e3

typedef struct pair {
    bed bed;
    double reduced_radius, reduced_mass;
    int hertz, wall;
} pair;

typedef struct kind {
    int hertz, wall, portable, overridden;
    double cohesion, adhesion, restitution;
} kind;

/* Two spheres along z, or one on a plane. */
static void open_pair(pair *b, const kind *what)
{
    const double none[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0};
    se3d_particles_def set = se3d_particles_def_default();
    se3d_material_def stuff = se3d_material_def_default();
    set.portable = what->portable;
    stuff.density = DENSITY;
    stuff.stiffness = KN;
    stuff.young = 1e7;
    stuff.poisson = 0.3;
    stuff.restitution = what->restitution;
    stuff.cohesion = what->overridden ? 0.0 : what->cohesion;
    stuff.adhesion = what->overridden ? 9.0 : what->adhesion;
    bed_open(&b->bed, what->hertz ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE, none,
             &set, &stuff);
    const se3d_material material = b->bed.material;
    if (what->overridden) {
        se3d_material_pair_def both = se3d_material_pair_def_default();
        both.cohesion = what->cohesion;
        both.adhesion = what->adhesion;
        CHECK(se3d_material_set_pair(b->bed.system, material, material, &both) == SE3D_OK);
    }
    const double r[6] = {0.0, 0.0, RADIUS, 0.0, 0.0, -RADIUS}, radius[2] = {RADIUS, RADIUS};
    CHECK(se3d_particles_add(b->bed.particles, material, what->wall ? 1 : 2, r, radius, NULL, NULL,
                             NULL) == SE3D_OK);
    if (what->wall) {
        (void)bed_add_plane(&b->bed, none, up);
    }
    double mass = DENSITY * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;
    b->hertz = what->hertz;
    b->wall = what->wall;
    b->reduced_radius = what->wall ? RADIUS : 0.5 * RADIUS;
    b->reduced_mass = what->wall ? mass : 0.5 * mass;
}

/* Put them at an overlap, parting with speed v. */
static void place(pair *b, double overlap, double v)
{
    double half = b->wall ? overlap : 0.5 * overlap;
    const double r[6] = {0.0, 0.0, RADIUS - half, 0.0, 0.0, half - RADIUS};
    const double u[6] = {0.0, 0.0, b->wall ? v : 0.5 * v, 0.0, 0.0, -0.5 * v};
    CHECK(se3d_particles_set_all(b->bed.particles, b->wall ? 1 : 2, r, u, NULL) == SE3D_OK);
}

/* Force on the first particle, away from its partner, at rest. */
static double force_at(pair *b, double overlap)
{
    double force[6];
    place(b, overlap, 0.0);
    CHECK(se3d_particles_set_step(b->bed.particles, 1e-14) == SE3D_OK);
    CHECK(se3d_particles_step(b->bed.particles, 1) == SE3D_OK);
    CHECK(se3d_particles_get_forces(b->bed.particles, b->wall ? 1 : 2, force, NULL) == SE3D_OK);
    CHECK_NEAR(force[0], 0.0, 1e-20);
    CHECK(b->wall || force[5] == -force[2]);
    return force[2];
}

static double pull_off(const pair *b)
{
    return 1.5 * PI * GAMMA * b->reduced_radius;
}

/* The overlap whose elastic force is `force`. */
static double overlap_of(const pair *b, double force)
{
    double kn = 4.0 / 3.0 * E_STAR * sqrt(b->reduced_radius);
    return b->hertz ? pow(force / kn, 2.0 / 3.0) : force / KN;
}

static kind variant(int k)
{
    return (kind){.hertz = k & 1,
                  .wall = k >> 1 & 1,
                  .portable = k >> 2 & 1,
                  .overridden = k >> 3 & 1,
                  .adhesion = GAMMA,
                  .restitution = 1.0};
}

static void adhesion_pulls_off_as_jkr_says(void)
{
    for (int k = 0; k < 16; ++k) {
        pair b;
        kind what = variant(k);
        open_pair(&b, &what);
        double fc = pull_off(&b), least = 0.0;
        double at = overlap_of(&b, fc);
        for (int n = 1; n < 200; ++n) {
            least = fmin(least, force_at(&b, at * n / 50.0));
        }
        CHECK_NEAR(least / fc, -1.0, 1e-9); /* n = 50 is the place; overlaps are rounded */
        CHECK_NEAR(force_at(&b, overlap_of(&b, 4.0 * fc)) / fc, 0.0, 1e-9);
        CHECK_NEAR(force_at(&b, overlap_of(&b, 9.0 * fc)) / fc, 3.0, 1e-9);
        CHECK(force_at(&b, -1e-9) == 0.0);
        bed_close(&b.bed);
    }
}

/* Hertz: the radius of contact without load is that of JKR. */
static void adhering_spheres_come_to_rest_where_jkr_says(void)
{
    for (int wall = 0; wall < 2; ++wall) {
        pair b;
        kind what = {.hertz = 1, .wall = wall, .adhesion = GAMMA, .restitution = 0.2};
        open_pair(&b, &what);
        place(&b, 1e-9, -1e-3);
        CHECK(se3d_particles_run(b.bed.particles, 0.3) == SE3D_OK);
        double r[6];
        CHECK(se3d_particles_get_all(b.bed.particles, wall ? 1 : 2, r, NULL, NULL) == SE3D_OK);
        double overlap = wall ? RADIUS - r[2] : 2.0 * RADIUS - (r[2] - r[5]);
        double R = b.reduced_radius;
        double a = cbrt(9.0 * PI * GAMMA * R * R / (2.0 * E_STAR));
        CHECK_NEAR(overlap / (a * a / R), 1.0, 1e-6);
        bed_close(&b.bed);
    }
}

static void separation_takes_the_work_of_adhesion(void)
{
    for (int k = 0; k < 4; ++k) {
        kind what = variant(k);
        pair b;
        open_pair(&b, &what);
        double d0 = overlap_of(&b, 4.0 * pull_off(&b));
        double kn = 4.0 / 3.0 * E_STAR * sqrt(b.reduced_radius);
        double work = b.hertz ? 6.0 / 35.0 * kn * pow(d0, 2.5) : KN * d0 * d0 / 6.0;
        double v0 = sqrt(2.0 * work / b.reduced_mass);
        double step, v[6];
        CHECK(se3d_particles_set_step(b.bed.particles, 0.0) == SE3D_OK);
        CHECK(se3d_particles_get_step(b.bed.particles, &step) == SE3D_OK);
        CHECK(se3d_particles_set_step(b.bed.particles, step / 50.0) == SE3D_OK);
        for (int slow = 0; slow < 2; ++slow) {
            place(&b, d0, slow ? 0.95 * v0 : 1.5 * v0);
            CHECK(se3d_particles_step(b.bed.particles, 30000) == SE3D_OK);
            CHECK(se3d_particles_count_contacts(b.bed.particles) == (size_t)slow);
            CHECK(se3d_particles_get_all(b.bed.particles, b.wall ? 1 : 2, NULL, v, NULL) ==
                  SE3D_OK);
            double parting = b.wall ? v[2] : v[2] - v[5];
            if (!slow) { /* v^2 = v1^2 - v0^2 */
                CHECK_NEAR(parting / v0, sqrt(1.25), 1e-3);
            }
        }
        bed_close(&b.bed);
    }
}

/* Fn = A delta^1.5 - B delta: least -4/27 B^3/A^2 at (2 B/3 A)^2, zero at (B/A)^2. */
static void linear_cohesion_is_an_energy_density_times_the_area(void)
{
    for (int k = 0; k < 4; ++k) {
        pair b;
        kind what = {.hertz = 1, .wall = k & 1, .portable = k >> 1, .restitution = 1.0};
        what.cohesion = 2e5;
        open_pair(&b, &what);
        double A = 4.0 / 3.0 * E_STAR * sqrt(b.reduced_radius);
        double B = 2.0 * PI * b.reduced_radius * what.cohesion;
        double at = 4.0 / 9.0 * B * B / (A * A), least = 0.0;
        for (int n = 1; n < 200; ++n) {
            least = fmin(least, force_at(&b, at * n / 50.0));
        }
        double expected = -4.0 / 27.0 * B * B * B / (A * A);
        CHECK_NEAR(least / expected, 1.0, 1e-9);
        CHECK_NEAR(force_at(&b, 2.25 * at) / expected, 0.0, 1e-8);
        bed_close(&b.bed);
    }
}

int main(void)
{
    RUN(adhesion_pulls_off_as_jkr_says);
    RUN(adhering_spheres_come_to_rest_where_jkr_says);
    RUN(separation_takes_the_work_of_adhesion);
    RUN(linear_cohesion_is_an_energy_density_times_the_area);
    return check_finish();
}
