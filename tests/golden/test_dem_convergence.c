/* SPDX-License-Identifier: BSD-3-Clause */
/* How the errors of particles fall with the step: for every closed form of an impact the error at
 * the automatic step, its half and its quarter, root mean square over 64 phases of the step in
 * which the two meet, and the observed order; and forms that hold at any step. It prints the table
 * of docs/theory/contact-laws.md. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>
#include <stdlib.h>

#define PI     3.1415926535897932384626433832795
#define PHASES 64
#define RADIUS 0.005
#define DENSE  2500.0
#define STIFF  4e6
#define YOUNG  1e9
#define SPEED  1.0
#define MU     0.1
#define SLIDE  3.0

enum { RESTITUTION, OVERLAP, DURATION, SLIDING };

typedef struct form {
    const char *name;
    se3d_contact_law law;
    int what, wall;
    double e;
    double exact;
    double order; /* least that is expected */
} form;

/* What the impacts have shown so far. */
typedef struct record {
    double overlap[PHASES], before[PHASES], since[PHASES], until[PHASES];
} record;

typedef struct field {
    bed bed;
    int wall;
} field;

static field open_field(se3d_contact_law law, double e, double friction, int wall)
{
    const double none[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0};
    field f = {.wall = wall};
    se3d_material_def def = se3d_material_def_default();
    def.density = DENSE;
    def.stiffness = STIFF;
    def.young = YOUNG;
    def.poisson = 0.3;
    def.restitution = e;
    def.friction = friction;
    bed_open(&f.bed, (int32_t)law, none, NULL, &def);
    if (wall) {
        (void)bed_add_plane(&f.bed, none, up);
    }
    return f;
}

/* A sphere above the floor or above another, and how fast it comes. */
static void add_impact(field *b, int n, double gap, double slide)
{
    const double x = 0.1 * (n % 8), y = 0.1 * (n / 8), radius[2] = {RADIUS, RADIUS};
    const double r[6] = {x, y, (b->wall ? RADIUS : 2.0 * RADIUS) + gap, x, y, 0.0};
    const double v[6] = {slide, 0.0, b->wall ? -SPEED : -0.5 * SPEED, 0.0, 0.0, 0.5 * SPEED};
    CHECK(se3d_particles_add(b->bed.particles, b->bed.material, b->wall ? 1 : 2, r, radius, v, NULL,
                             NULL) == SE3D_OK);
}

/* Times of touching by linear interpolation of the overlap. */
static void watch(const field *b, double t, double h, record *seen)
{
    double r[6 * PHASES];
    const size_t each = b->wall ? 1 : 2;
    CHECK(se3d_particles_get_all(b->bed.particles, PHASES * each, r, NULL, NULL) == SE3D_OK);
    for (size_t n = 0; n < PHASES; ++n) {
        const double *at = r + 3 * n * each;
        double overlap = b->wall ? RADIUS - at[2] : 2.0 * RADIUS - (at[2] - at[5]);
        double share = overlap / (overlap - seen->before[n]); /* of the step, since it was zero */
        if (overlap > 0.0 && seen->before[n] <= 0.0) {
            seen->since[n] = t - share * h;
        } else if (overlap <= 0.0 && seen->before[n] > 0.0) {
            seen->until[n] = t - share * h;
        }
        seen->overlap[n] = fmax(seen->overlap[n], overlap);
        seen->before[n] = overlap;
    }
}

static double found(const form *f, const record *seen, size_t n, const double v[6])
{
    switch (f->what) {
    case OVERLAP:
        return seen->overlap[n];
    case DURATION:
        return seen->until[n] - seen->since[n];
    case SLIDING:
        return SLIDE - v[0];
    default:
        return (f->wall ? v[2] : v[2] - v[5]) / SPEED;
    }
}

/* Root mean square of the relative error over all phases. */
static double error_of(const form *f, double divide)
{
    field b = open_field(f->law, f->e, f->what == SLIDING ? MU : 0.0, f->wall);
    const size_t each = f->wall ? 1 : 2;
    const double slide = f->what == SLIDING ? SLIDE : 0.0;
    record seen = {.before = {0.0}};
    double step, sum = 0.0, v[6 * PHASES];
    add_impact(&b, 0, 1e-3 * RADIUS, slide);
    CHECK(se3d_particles_get_step(b.bed.particles, &step) == SE3D_OK);
    for (int n = 1; n < PHASES; ++n) {
        add_impact(&b, n, 1e-3 * RADIUS + step * SPEED * n / PHASES, slide);
    }
    step /= divide;
    CHECK(se3d_particles_set_step(b.bed.particles, step) == SE3D_OK);
    for (size_t n = 0; n < PHASES; ++n) {
        seen.before[n] = -1.0;
    }
    for (int k = 1; k < (int)(400 * divide); ++k) {
        CHECK(se3d_particles_step(b.bed.particles, 1) == SE3D_OK);
        watch(&b, k * step, step, &seen);
    }
    CHECK(se3d_particles_count_contacts(b.bed.particles) == 0);
    CHECK(se3d_particles_get_all(b.bed.particles, PHASES * each, NULL, v, NULL) == SE3D_OK);
    for (size_t n = 0; n < PHASES; ++n) {
        double error = found(f, &seen, n, v + 3 * n * each) / f->exact - 1.0;
        sum += error * error;
    }
    bed_close(&b.bed);
    return sqrt(sum / PHASES);
}

static double mass(void)
{
    return DENSE * 4.0 / 3.0 * PI * RADIUS * RADIUS * RADIUS;
}

/* Largest overlap of an elastic impact of two spheres by Hertz. */
static double hertz_overlap(void)
{
    const double k = 4.0 / 3.0 * YOUNG / (2.0 * (1.0 - 0.09)) * sqrt(0.5 * RADIUS);
    return pow(5.0 / 4.0 * 0.5 * mass() * SPEED * SPEED / k, 0.4);
}

static void errors_fall_with_the_step(void)
{
    const double rate = sqrt(STIFF / (0.5 * mass()));
    const form forms[] = {
        {"restitution .5, hooke, pair", SE3D_CONTACT_LAW_HOOKE, RESTITUTION, 0, 0.5, 0.5, 1.5},
        {"restitution .8, hooke, wall", SE3D_CONTACT_LAW_HOOKE, RESTITUTION, 1, 0.8, 0.8, 1.5},
        {"restitution .5, hertz_mindlin, pair", SE3D_CONTACT_LAW_HERTZ_MINDLIN, RESTITUTION, 0, 0.5,
         0.5, 1.1},
        {"restitution .8, hertz_mindlin, wall", SE3D_CONTACT_LAW_HERTZ_MINDLIN, RESTITUTION, 1, 0.8,
         0.8, 1.1},
        {"largest overlap, hooke, pair", SE3D_CONTACT_LAW_HOOKE, OVERLAP, 0, 1.0, SPEED / rate,
         1.8},
        {"duration, hooke, pair", SE3D_CONTACT_LAW_HOOKE, DURATION, 0, 1.0, PI / rate, 1.8},
        {"largest overlap, hertz_mindlin, pair", SE3D_CONTACT_LAW_HERTZ_MINDLIN, OVERLAP, 0, 1.0,
         hertz_overlap(), 1.8},
        {"duration, hertz_mindlin, pair", SE3D_CONTACT_LAW_HERTZ_MINDLIN, DURATION, 0, 1.0,
         2.9432750995 * hertz_overlap() / SPEED, 1.8},
        {"tangential impulse when sliding, hooke, wall", SE3D_CONTACT_LAW_HOOKE, SLIDING, 1, 0.8,
         MU * 1.8 * SPEED, 1.5},
    };
    printf("| closed form | h | h/2 | h/4 | order |\n|---|---|---|---|---|\n");
    for (size_t k = 0; k < sizeof forms / sizeof forms[0]; ++k) {
        double error[3];
        for (int n = 0; n < 3; ++n) {
            error[n] = error_of(&forms[k], 1 << n);
        }
        double order = 0.5 * log2(error[0] / error[2]);
        printf("| %s | %.1e | %.1e | %.1e | %.1f |\n", forms[k].name, error[0], error[1], error[2],
               order);
        CHECK(error[0] < 2e-3);
        CHECK(order > forms[k].order);
    }
}

/* A sphere in its dent on the floor with velocity and spin, after a time; returns v_x and w_y, w_z.
 */
static void roll(double steps_of, double rolling, double torsion, const double start[3], double t,
                 double out[3])
{
    field b = open_field(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.3, 0);
    const double g[3] = {0.0, 0.0, -9.81}, radius = RADIUS;
    const double r[3] = {0.0, 0.0, RADIUS - mass() * 9.81 / STIFF};
    const double v[3] = {start[0], 0.0, 0.0}, w[3] = {0.0, start[1], start[2]};
    double step, u[3], s[3];
    se3d_shape_def floor = se3d_shape_def_default();
    se3d_shape shape;
    se3d_material_def def = se3d_material_def_default();
    CHECK(se3d_system_set_gravity(b.bed.system, g) == SE3D_OK);
    def.density = DENSE;
    def.stiffness = STIFF;
    def.restitution = 0.3;
    def.friction = 0.3;
    def.rolling_friction = rolling;
    def.torsional_friction = torsion;
    CHECK(se3d_material_create(b.bed.system, &def, &b.bed.material) == SE3D_OK);
    floor.material = b.bed.material;
    CHECK(se3d_shape_create_plane(b.bed.system, &floor, &shape) == SE3D_OK);
    CHECK(se3d_particles_add(b.bed.particles, b.bed.material, 1, r, &radius, v, w, NULL) ==
          SE3D_OK);
    CHECK(se3d_particles_get_step(b.bed.particles, &step) == SE3D_OK);
    CHECK(se3d_particles_set_step(b.bed.particles, step * steps_of) == SE3D_OK);
    CHECK(se3d_particles_run(b.bed.particles, t) == SE3D_OK);
    CHECK(se3d_particles_get_all(b.bed.particles, 1, NULL, u, s) == SE3D_OK);
    out[0] = u[0];
    out[1] = s[1];
    out[2] = s[2];
    bed_close(&b.bed);
}

static void forms_with_constant_forces_hold_at_any_step(void)
{
    const double arm = RADIUS - mass() * 9.81 / STIFF, inertia = 0.4 * RADIUS * RADIUS;
    const double slides[3] = {1.0, 0.0, 0.0}, spins[3] = {0.0, 0.0, 50.0};
    const double rolls[3] = {0.2, 0.2 / arm, 0.0};
    for (int n = 0; n < 3; ++n) {
        double out[3];
        roll(1.0 / (1 << n), 0.0, 0.0, slides, 0.05, out);
        CHECK_NEAR(out[0], 1.0 - 0.3 * 9.81 * 0.05, 1e-6); /* slips */
        roll(1.0 / (1 << n), 0.0, 0.0, slides, 0.2, out);
        CHECK_NEAR(out[0], 1.0 / (1.0 + inertia / (arm * arm)), 1e-6); /* has begun to roll */
        roll(1.0 / (1 << n), 0.0, 0.05, spins, 0.1, out);
        CHECK_NEAR(out[2], 50.0 - 0.05 * 9.81 * RADIUS / inertia * 0.1, 1e-4);
        roll(1.0 / (1 << n), 0.02, 0.0, rolls, 0.1, out);
        CHECK_NEAR(out[0], 0.2 - 0.02 * 9.81 * RADIUS * arm / (inertia + arm * arm) * 0.1, 1e-4);
    }
}

int main(void)
{
    RUN(errors_fall_with_the_step);
    RUN(forms_with_constant_forces_hold_at_any_step);
    return check_finish();
}
