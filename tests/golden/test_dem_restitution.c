/* SPDX-License-Identifier: BSD-3-Clause */
/* The given restitution is the restitution obtained by particles at their automatic step, whatever
 * the part of a step in which they meet: a hundred impacts at random phases each. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/bed.h"

#include <math.h>
#include <stdlib.h>

#define IMPACTS 100
#define RADIUS  0.005

/* One kind of impact. */
typedef struct kind {
    se3d_contact_law law;
    int wall, portable, sizes; /* sizes: radii differ */
    double e, v, divide;       /* divide: of the automatic step */
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
    def.density = 2500.0;
    def.stiffness = 4e6; /* 10 m/s within the allowed overlap */
    def.young = 1e9;
    def.poisson = 0.3;
    def.restitution = k->e;
    bed_open(&b, (int32_t)k->law, none, &set, &def);
    return b;
}

/* Column n: a sphere above another or above the floor, which it meets after some steps. */
static void add_column(bed *b, const kind *k, int n, double gap)
{
    const double x = 0.1 * (n % 10), y = 0.1 * (n / 10), top = k->sizes ? 0.7 * RADIUS : RADIUS;
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

static void restitution_typed_is_restitution_obtained_at_the_automatic_step(void)
{
    static const double es[4] = {0.3, 0.5, 0.7, 0.9};
    for (int n = 0; n < 128; ++n) {
        kind k = {.law = n & 1 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE,
                  .wall = n >> 1 & 1,
                  .portable = n >> 2 & 1,
                  .sizes = n >> 3 & 1,
                  .v = n >> 4 & 1 ? 10.0 : 0.1,
                  .e = es[n >> 5],
                  .divide = 1.0};
        double mean;
        CHECK_NEAR(worst_error(&k, &mean), 0.0, 5e-4);
        CHECK_NEAR(mean, 0.0, 2e-4);
    }
}

int main(void)
{
    RUN(restitution_typed_is_restitution_obtained_at_the_automatic_step);
    return check_finish();
}
