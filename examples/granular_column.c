/* SPDX-License-Identifier: BSD-3-Clause */
/* A thousand spheres fall into a box and come to rest; floor and walls carry their weight. */
#include <se3d/se3d.h>

#include <math.h>
#include <stdio.h>

#define WIDTH  0.11
#define RADIUS 0.005

static int fail(se3d_system *system, const char *what)
{
    fprintf(stderr, "%s: %s\n", what, se3d_system_get_error(system));
    return 1;
}

/* A floor and four walls of planes, all on the ground. */
static se3d_status build_box(se3d_system *system, se3d_material material, se3d_shape walls[5])
{
    static const double normals[5][3] = {
        {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}};
    for (int k = 0; k < 5; ++k) {
        se3d_shape_def wall = se3d_shape_def_default();
        wall.material = material;
        for (int a = 0; a < 3; ++a) {
            wall.normal[a] = normals[k][a];
        }
        wall.position[0] = k == 2 ? WIDTH : 0.0;
        wall.position[1] = k == 4 ? WIDTH : 0.0;
        se3d_status status = se3d_shape_create_plane(system, &wall, &walls[k]);
        if (SE3D_FAILED(status)) {
            return status;
        }
    }
    return SE3D_OK;
}

static se3d_status build(se3d_system *system, se3d_particles **particles, se3d_shape walls[5])
{
    se3d_status status = se3d_particles_create(system, NULL, particles); /* Hooke's law */
    if (SE3D_FAILED(status)) {
        return status;
    }
    se3d_material_def stuff = se3d_material_def_default();
    stuff.density = 2500.0;
    stuff.stiffness = 2.5e4;
    stuff.restitution = 0.3;
    se3d_material glass;
    status = se3d_material_create(system, &stuff, &glass);
    if (SE3D_FAILED(status)) {
        return status;
    }
    se3d_fill_def fill = se3d_fill_def_default();
    fill.material = glass;
    fill.upper[0] = fill.upper[1] = fill.upper[2] = WIDTH;
    fill.radius_min = fill.radius_max = RADIUS;
    fill.jitter = 0.0004;
    fill.seed = 1;
    status = se3d_particles_fill_lattice(*particles, &fill, NULL);
    return SE3D_FAILED(status) ? status : build_box(system, glass, walls);
}

int main(void)
{
    se3d_system *system = NULL;
    se3d_particles *particles = NULL;
    se3d_shape walls[5];
    if (SE3D_FAILED(se3d_system_create(NULL, &system))) {
        return 1;
    }
    if (SE3D_FAILED(build(system, &particles, walls))) {
        return fail(system, "building");
    }
    const double count = (double)se3d_particles_count(particles);
    const double weight =
        count * 2500.0 * 4.0 / 3.0 * 3.14159265358979 * RADIUS * RADIUS * RADIUS * 9.81;
    se3d_particles_energy energy;
    double held = 0.0;
    printf("%.0f spheres weigh %.4f N\n", count, weight);
    for (int k = 1; k <= 4; ++k) {
        double force[3], torque[3], floor = 0.0;
        if (SE3D_FAILED(se3d_particles_run(particles, 0.2 * k))) {
            return fail(system, "running");
        }
        held = 0.0;
        for (int w = 0; w < 5; ++w) {
            (void)se3d_shape_get_wrench(system, walls[w], force, torque);
            floor = w == 0 ? -force[2] : floor;
            held -= force[2];
        }
        (void)se3d_particles_get_energy(particles, &energy);
        printf("t %.1f s: kinetic %.3e J, floor %.4f N, walls %.4f N, %zu contacts\n", 0.2 * k,
               energy.translation + energy.rotation, floor, held - floor,
               se3d_particles_count_contacts(particles));
    }
    se3d_particles_destroy(particles);
    se3d_system_destroy(system);
    return fabs(held / weight - 1.0) < 1e-3 ? 0 : 1;
}
