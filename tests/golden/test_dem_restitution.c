/* SPDX-License-Identifier: BSD-3-Clause */
/* The given restitution is the restitution obtained by particles at their automatic step, whatever
 * the part of a step in which they meet: a hundred impacts at random phases each. So is the one
 * that follows from a damping over the mass. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>
#include <stdlib.h>

#define IMPACTS 100
#define RADIUS  0.005
#define SMALL   (0.7 * RADIUS)
#define DENSITY 2500.0
#define HOOKE   4e6 /* N/m: 10 m/s within the allowed overlap */
#define YOUNG   1e9
#define POISSON 0.3

/* One kind of impact. */
typedef struct kind {
    se3d_contact_law law;
    int wall, portable, sizes; /* sizes: radii differ */
    double e, v, divide;       /* divide: of the automatic step */
    double rate;               /* > 0: damping, e follows */
} kind;

static double draw(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state / 4294967296.0;
}

static bed open_bed(const kind *k)
{
    const double none[3] = {0.0, 0.0, 0.0};
    bed b;
    se3d_particles_def set = se3d_particles_def_default();
    se3d_material_def def = se3d_material_def_default();
    set.portable = k->portable;
    def.density = DENSITY;
    def.stiffness = HOOKE;
    def.young = YOUNG;
    def.poisson = POISSON;
    def.restitution = k->rate > 0.0 ? 0.5 : k->e;
    def.damping_rate = k->rate;
    bed_open(&b, (int32_t)k->law, none, &set, &def);
    return b;
}

/* Column n: a sphere above another or above the floor, which it meets after some steps. */
static void add_column(bed *b, const kind *k, int n, double gap)
{
    const double x = 0.1 * (n % 10), y = 0.1 * (n / 10), top = k->sizes ? SMALL : RADIUS;
    double z = k->wall ? top + gap : RADIUS + top + gap;
    const double r[6] = {x, y, z, x, y, 0.0}, radius[2] = {top, RADIUS};
    const double v[6] = {0.0, 0.0, k->wall ? -k->v : -0.5 * k->v, 0.0, 0.0, 0.5 * k->v};
    size_t count = k->wall ? 1 : 2;
    CHECK(se3d_particles_add(b->particles, b->material, count, r, radius, v, NULL, NULL) ==
          SE3D_OK);
}

/* The largest error of the restitution over all phases; *mean: of all. */
static double worst_error(const kind *k, double *mean)
{
    bed b = open_bed(k);
    double step;
    uint32_t seed = 7u;
    if (k->wall) {
        const double at[3] = {0.0, 0.0, 0.0}, up[3] = {0.0, 0.0, 1.0};
        (void)bed_add_plane(&b, at, up);
    }
    add_column(&b, k, 0, 1e-6 * RADIUS); /* for the step */
    CHECK(se3d_particles_get_step(b.particles, &step) == SE3D_OK);
    step /= k->divide;
    CHECK(se3d_particles_set_step(b.particles, step) == SE3D_OK);
    for (int n = 1; n < IMPACTS; ++n) {
        add_column(&b, k, n, (2.0 + draw(&seed)) * step * k->v);
    }
    const size_t count = se3d_particles_count(b.particles), each = k->wall ? 1 : 2;
    double *v = calloc(3 * count, sizeof *v);
    int steps = 0, met = 0;
    CHECK(v != NULL);
    do {
        CHECK(se3d_particles_step(b.particles, 20) == SE3D_OK);
        met = met || se3d_particles_count_contacts(b.particles) > 0;
    } while (++steps < 100000 && (!met || se3d_particles_count_contacts(b.particles) > 0));
    CHECK(se3d_particles_get_all(b.particles, count, NULL, v, NULL) == SE3D_OK);
    double worst = *mean = 0.0;
    for (size_t n = 0; n < count; n += each) {
        double e = (k->wall ? v[3 * n + 2] : v[3 * n + 2] - v[3 * n + 5]) / k->v;
        worst = fmax(worst, fabs(e - k->e));
        *mean += (e - k->e) / IMPACTS;
    }
    free(v);
    bed_close(&b);
    return worst;
}

/* Every law, partner, kernel, size and speed, by the bits of a number. */
static kind kind_of(int n)
{
    return (kind){.law = n & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE,
                  .wall = n >> 1 & 1,
                  .portable = n >> 2 & 1,
                  .sizes = n >> 3 & 1,
                  .v = n >> 4 & 1 ? 10.0 : 0.1,
                  .divide = 1.0};
}

static void check_errors(const kind *k)
{
    double mean;
    CHECK_NEAR(worst_error(k, &mean), 0.0, 5e-4);
    CHECK_NEAR(mean, 0.0, 2e-4);
}

static void restitution_typed_is_restitution_obtained_at_the_automatic_step(void)
{
    static const double es[4] = {0.3, 0.5, 0.7, 0.9};
    for (int n = 0; n < 128; ++n) {
        kind k = kind_of(n);
        k.e = es[n >> 5];
        check_errors(&k);
    }
}

/* x'' = -max(0, x^1.5 + beta x^.5 x') from x' = 1. */
static double restitution_of_rate(double beta)
{
    const double h = 1e-5;
    double x = 0.0, v = 1.0, force = 0.0;
    for (int k = 0; k < 1000000 && (force > 0.0 || v > 0.0); ++k) {
        x += 0.5 * h * v;
        force = pow(fmax(x, 0.0), 1.5) + beta * sqrt(fmax(x, 0.0)) * v;
        v -= h * fmax(force, 0.0);
        x += 0.5 * h * v;
    }
    return -v;
}

/* Of two spheres, or of one and a wall: in units of the length (m v^2/(kn sqrt(R)))^(2/5). */
static double restitution_of(const kind *k)
{
    const double top = k->sizes ? SMALL : RADIUS, density = 4.0 / 3.0 * 3.14159265358979 * DENSITY;
    const double m1 = density * top * top * top, m2 = density * RADIUS * RADIUS * RADIUS;
    const double m = k->wall ? m1 : m1 * m2 / (m1 + m2);
    const double R = k->wall ? top : top * RADIUS / (top + RADIUS);
    if (k->law == SE3D_CONTACT_LAW_HOOKE) {
        const double zeta = 0.5 * k->rate * sqrt(m / HOOKE), w = sqrt(1.0 - zeta * zeta);
        return exp(-zeta / w * (3.14159265358979 - atan2(2.0 * zeta * w, w * w - zeta * zeta)));
    }
    const double kn = 2.0 / 3.0 * YOUNG / (1.0 - POISSON * POISSON);
    const double length = pow(m * k->v * k->v / (kn * sqrt(R)), 0.4);
    return restitution_of_rate(k->rate * sqrt(R * length) * length / k->v);
}

/* Over the mass (hooke), or over mass and radius of contact (hertz_mindlin): small spheres lose
 * less, and fast ones, too. */
static void damping_over_the_mass_gives_the_restitution_that_follows(void)
{
    static const double rates[2] = {1e4, 1.5e7}; /* hooke, hertz_mindlin */
    for (int n = 0; n < 64; ++n) {
        kind k = kind_of(n);
        k.rate = (n >> 5 ? 1.0 : 0.3) * rates[n & 1];
        k.e = restitution_of(&k);
        CHECK(k.e > 0.2 && k.e < 0.97);
        check_errors(&k);
    }
}

int main(void)
{
    RUN(restitution_typed_is_restitution_obtained_at_the_automatic_step);
    RUN(damping_over_the_mass_gives_the_restitution_that_follows);
    return check_finish();
}
