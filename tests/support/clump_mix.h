/* SPDX-License-Identifier: BSD-3-Clause */
/* Clumps of different numbers of spheres and sizes and free spheres, mixed up in a box with
 * periods, for tests of bits. */
#ifndef SE3D_TESTS_SUPPORT_CLUMP_MIX_H
#define SE3D_TESTS_SUPPORT_CLUMP_MIX_H

#include "avalanche.h"

/* Add a template of `count` spheres in a bow; the first is the largest. */
static inline uint32_t clump_mix_template(bed *b, size_t count)
{
    double r[3 * 8], radius[8];
    se3d_clump_def def = se3d_clump_def_default();
    uint32_t index;
    for (size_t k = 0; k < count; ++k) {
        const double t = 0.002 * (double)k;
        r[3 * k] = t;
        r[3 * k + 1] = 20.0 * t * t;
        r[3 * k + 2] = -9.0 * t * t;
        radius[k] = 0.003 - 0.0001 * (double)k;
    }
    def.count = count;
    def.r = r;
    def.radius = radius;
    CHECK(count <= 8);
    CHECK(se3d_particles_add_clump_template(b->particles, &def, &index) == SE3D_OK);
    return index;
}

/* Layers of one kind each, thrown onto a floor and onto each other. */
static inline void clump_mix_open(bed *b, int32_t threads, int32_t portable, int32_t law)
{
    static const size_t counts[] = {2, 5, 1, 0, 3, 2, 8}; /* spheres of a clump; 0: free */
    se3d_system_def system = se3d_system_def_default();
    se3d_particles_def def = se3d_particles_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def floor = se3d_shape_def_default();
    se3d_fill_def fill = se3d_fill_def_default();
    se3d_shape shape;
    system.gravity[2] = -60.0;
    CHECK(se3d_system_create(&system, &b->system) == SE3D_OK);
    contact.law = law;
    CHECK(se3d_system_set_contact(b->system, &contact) == SE3D_OK);
    def.threads = threads;
    def.portable = portable;
    def.upper[0] = 0.16;
    def.upper[1] = 0.12;
    for (int a = 0; a < 2; ++a) {
        def.boundary[a] = SE3D_DOMAIN_BOUNDARY_PERIODIC;
        fill.upper[a] = def.upper[a];
        fill.velocity[a] = 0.4;
    }
    CHECK(se3d_particles_create(b->system, &def, &b->particles) == SE3D_OK);
    stuff.density = 2500.0;
    stuff.stiffness = 2e4;
    stuff.young = 1e8;
    stuff.restitution = 0.6;
    CHECK(se3d_material_create(b->system, &stuff, &fill.material) == SE3D_OK);
    floor.material = fill.material;
    floor.normal[2] = 1.0;
    CHECK(se3d_shape_create_plane(b->system, &floor, &shape) == SE3D_OK);
    for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
        fill.lower[2] = fill.upper[2];
        fill.upper[2] += 0.025;
        fill.velocity[2] = -0.5 - 0.3 * (double)k;
        fill.seed = 3 + k;
        fill.count = 45 + k; /* no multiple of a number of lanes */
        fill.clump = counts[k] > 0 ? 1 + clump_mix_template(b, counts[k]) : 0;
        fill.radius_min = counts[k] > 0 ? 0.006 : 0.003;
        fill.radius_max = 1.5 * fill.radius_min;
        CHECK(se3d_particles_fill_lattice(b->particles, &fill, NULL) == SE3D_OK);
    }
    CHECK(se3d_particles_count_clumps(b->particles) > 200);
    CHECK(se3d_particles_set_step(b->particles, 1e-5) == SE3D_OK);
}

#endif
