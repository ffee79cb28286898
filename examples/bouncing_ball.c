/* SPDX-License-Identifier: BSD-3-Clause */
/* A ball falls on the floor and bounces: every height is e^2 times the one before. */
#include <se3d/se3d.h>

#include <math.h>
#include <stdio.h>

#define RADIUS      0.05
#define HEIGHT      1.0 /* of the centre above where it touches */
#define RESTITUTION 0.8

static int fail(se3d_system *system, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, se3d_system_get_error(system));
    return 1;
}

/* Ball, floor and material. */
static se3d_status build(se3d_system *system, se3d_particles **particles)
{
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = SE3D_CONTACT_LAW_HERTZ_MINDLIN;
    se3d_status status = se3d_system_set_contact(system, &contact);
    if (SE3D_FAILED(status)) {
        return status;
    }
    status = se3d_particles_create(system, NULL, particles);
    if (SE3D_FAILED(status)) {
        return status;
    }
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 1100.0;
    stuff.young = 4e8; /* hard rubber: its own weight hardly matters in a bounce */
    stuff.poisson = 0.45;
    stuff.restitution = RESTITUTION;
    se3d_material rubber;
    status = se3d_material_create(system, &stuff, &rubber);
    if (SE3D_FAILED(status)) {
        return status;
    }
    se3d_shape_def floor = se3d_shape_def_default(); /* through the origin, normal z, on ground */
    floor.material = rubber;
    se3d_shape plane;
    status = se3d_shape_create_plane(system, &floor, &plane);
    if (SE3D_FAILED(status)) {
        return status;
    }
    const double r[3] = {0.0, 0.0, HEIGHT + RADIUS}, radius = RADIUS;
    return se3d_particles_add(*particles, rubber, 1, r, &radius, NULL, NULL, NULL);
}

int main(void)
{
    se3d_system *system = NULL;
    se3d_particles *particles = NULL;
    if (SE3D_FAILED(se3d_system_create(NULL, &system))) {
        return 1;
    }
    if (SE3D_FAILED(build(system, &particles))) {
        return fail(system, "building");
    }
    double expected = HEIGHT;
    double worst = 0.0;
    double before = 0.0;
    printf("%-8s %-10s %-10s\n", "time", "height", "e^2 law");
    for (int bounces = 0; bounces < 5;) {
        double r[3], v[3], time;
        if (SE3D_FAILED(se3d_particles_step(particles, 1))) {
            return fail(system, "stepping");
        }
        (void)se3d_particles_get_all(particles, 1, r, v, NULL);
        if (before > 0.0 && v[2] <= 0.0) { /* the top of a bounce */
            (void)se3d_particles_get_time(particles, &time);
            expected *= RESTITUTION * RESTITUTION;
            printf("%-8.4f %-10.6f %-10.6f\n", time, r[2] - RADIUS, expected);
            worst = fmax(worst, fabs((r[2] - RADIUS) / expected - 1.0));
            ++bounces;
        }
        before = v[2];
    }
    se3d_particles_destroy(particles);
    se3d_system_destroy(system);
    return worst < 0.02 ? 0 : 1;
}
