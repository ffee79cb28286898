/* SPDX-License-Identifier: BSD-3-Clause */
/* Many particles in motion, for tests of bits. */
#ifndef SE3D_TESTS_SUPPORT_AVALANCHE_H
#define SE3D_TESTS_SUPPORT_AVALANCHE_H

#include "check.h"
#include "se3d/se3d.h"

typedef struct bed {
    se3d_system *system;
    se3d_particles *particles;
} bed;

/* An avalanche in a box: two sizes, two materials, rolling resistance, tilted gravity. */
static inline void avalanche_open(bed *b, int32_t threads, int32_t portable, int32_t law)
{
    se3d_system_def system = se3d_system_def_default();
    system.gravity[0] = system.gravity[2] = -9.81 * sqrt(0.5);
    CHECK(se3d_system_create(&system, &b->system) == SE3D_OK);
    se3d_particles_def def = se3d_particles_def_default();
    def.threads = threads;
    def.portable = portable;
    se3d_contact_settings contact = se3d_contact_settings_default();
    contact.law = law;
    CHECK(se3d_system_set_contact(b->system, &contact) == SE3D_OK);
    CHECK(se3d_particles_create(b->system, &def, &b->particles) == SE3D_OK);
    se3d_material material[2];
    for (int k = 0; k < 2; ++k) {
        se3d_material_def stuff = se3d_material_def_default();
        stuff.density = 2500.0 + 500.0 * k;
        stuff.stiffness = 2e4 + 1e4 * k;
        stuff.young = 1e8;
        stuff.rolling_friction = 0.02 * k;
        stuff.restitution = 0.6;
        CHECK(se3d_material_create(b->system, &stuff, &material[k]) == SE3D_OK);
    }
    static const double normals[5][3] = {
        {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}};
    for (int k = 0; k < 5; ++k) {
        se3d_shape_def wall = se3d_shape_def_default();
        se3d_shape handle;
        wall.material = material[0];
        memcpy(wall.normal, normals[k], sizeof wall.normal);
        wall.position[0] = k == 2 ? 0.3 : 0.0;
        wall.position[1] = k == 4 ? 0.06 : 0.0;
        CHECK(se3d_shape_create_plane(b->system, &wall, &handle) == SE3D_OK);
    }
    for (int k = 0; k < 2; ++k) {
        se3d_fill_def fill = se3d_fill_def_default();
        fill.material = material[k];
        fill.lower[0] = 0.12 * k;
        fill.upper[0] = 0.12 * k + 0.12;
        fill.upper[1] = 0.06;
        fill.upper[2] = 0.12;
        fill.radius_min = 0.003;
        fill.radius_max = 0.005;
        fill.jitter = 0.0003;
        fill.seed = 11;
        CHECK(se3d_particles_fill_lattice(b->particles, &fill, NULL) == SE3D_OK);
    }
    CHECK(se3d_particles_count(b->particles) > 500);
    CHECK(se3d_particles_set_step(b->particles, 1e-5) == SE3D_OK);
}

static inline void bed_destroy(bed *b)
{
    se3d_particles_destroy(b->particles);
    se3d_system_destroy(b->system);
}

#endif
