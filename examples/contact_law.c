/* SPDX-License-Identifier: BSD-3-Clause */
/* A law of contact of one's own: the force k x^n of a ball on a floor, without damping. It must
 * come back as fast as it fell, and go in as deep as its energy says:
 *
 *     m v^2/2 = k depth^(n + 1)/(n + 1)
 *
 * The library finds what touches, keeps the momentum and moves the ball; the law says the force. */
#include <se3d/se3d.h>

#include <math.h>
#include <stdio.h>

#define RADIUS 0.05
#define SPEED  2.0

typedef struct power_law {
    double k, n;
    double depth; /* the largest overlap that it has seen */
} power_law;

/* Forces are on the second of the two; `output` begins as zero, with the spring as it is. */
static se3d_status push(void *ctx, const se3d_contact_input *input, se3d_contact_output *output)
{
    power_law *law = ctx;
    output->force = law->k * pow(input->overlap, law->n);
    law->depth = fmax(law->depth, input->overlap);
    return SE3D_OK;
}

static int fail(se3d_system *system)
{
    fprintf(stderr, "%s\n", system ? se3d_system_get_error(system) : "no system");
    se3d_system_destroy(system);
    return 1;
}

/* A floor, and one particle above it that falls with SPEED. */
static se3d_status build(se3d_system *system, power_law *law, se3d_particles **ball)
{
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def floor = se3d_shape_def_default();
    se3d_material material;
    se3d_shape shape;
    const double r[3] = {0.0, 0.0, 1.2 * RADIUS}, v[3] = {0.0, 0.0, -SPEED}, radius = RADIUS;
    contact.law = SE3D_CONTACT_LAW_CALLBACK;
    contact.callback = push;
    contact.ctx = law;
    contact.step = 1e-5; /* only the law knows what it needs */
    stuff.density = 1000.0;
    se3d_status status = se3d_system_set_contact(system, &contact);
    status = status < 0 ? status : se3d_material_create(system, &stuff, &material);
    if (status >= 0) {
        floor.material = material;
        status = se3d_shape_create_plane(system, &floor, &shape);
    }
    status = status < 0 ? status : se3d_particles_create(system, NULL, ball);
    return status < 0 ? status : se3d_particles_add(*ball, material, 1, r, &radius, v, NULL, NULL);
}

int main(void)
{
    power_law law = {.k = 1e7, .n = 1.8};
    se3d_system_def def = se3d_system_def_default();
    se3d_system *system = NULL;
    se3d_particles *ball = NULL;
    double v[3];
    def.gravity[2] = 0.0;
    if (se3d_system_create(&def, &system) < 0 || build(system, &law, &ball) < 0 ||
        se3d_particles_run(ball, 0.05) < 0 || se3d_particles_get_all(ball, 1, NULL, v, NULL) < 0) {
        return fail(system);
    }
    const double mass = 1000.0 * 4.0 / 3.0 * acos(-1.0) * RADIUS * RADIUS * RADIUS;
    const double depth = pow(0.5 * mass * SPEED * SPEED * (law.n + 1.0) / law.k, 1 / (law.n + 1.0));
    printf("depth %.6f m, closed form %.6f m; speed %.6f m/s after %.6f m/s\n", law.depth, depth,
           v[2], SPEED);
    se3d_system_destroy(system);
    return fabs(law.depth / depth - 1.0) < 1e-4 && fabs(v[2] / SPEED - 1.0) < 1e-4 ? 0 : 1;
}
