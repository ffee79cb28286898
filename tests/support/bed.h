/* SPDX-License-Identifier: BSD-3-Clause */
/* A bed for tests: a system with one set of particles and one material. */
#ifndef SE3D_TESTS_SUPPORT_BED_H
#define SE3D_TESTS_SUPPORT_BED_H

#include "check.h"
#include "se3d/se3d.h"

typedef struct bed {
    se3d_system *system;
    se3d_particles *particles;
    se3d_material material;
} bed;

/* `set` NULL: the default one. */
static inline void bed_open(bed *b, int32_t law, const double gravity[3],
                            const se3d_particles_def *set, const se3d_material_def *material)
{
    se3d_system_def system = se3d_system_def_default();
    se3d_contact_settings contact = se3d_contact_settings_default();
    memcpy(system.gravity, gravity, sizeof system.gravity);
    contact.law = law;
    CHECK(se3d_system_create(&system, &b->system) == SE3D_OK);
    CHECK(se3d_system_set_contact(b->system, &contact) == SE3D_OK);
    CHECK(se3d_particles_create(b->system, set, &b->particles) == SE3D_OK);
    CHECK(se3d_material_create(b->system, material, &b->material) == SE3D_OK);
}

static inline void bed_close(bed *b)
{
    se3d_particles_destroy(b->particles);
    se3d_system_destroy(b->system);
}

/* A wall at rest. */
static inline se3d_shape bed_add_plane(const bed *b, const double at[3], const double normal[3])
{
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape wall;
    def.material = b->material;
    memcpy(def.position, at, sizeof def.position);
    memcpy(def.normal, normal, sizeof def.normal);
    CHECK(se3d_shape_create_plane(b->system, &def, &wall) == SE3D_OK);
    return wall;
}

static inline void bed_add(const bed *b, const double r[3], double radius, const double v[3],
                           const double w[3])
{
    CHECK(se3d_particles_add(b->particles, b->material, 1, r, &radius, v, w, NULL) == SE3D_OK);
}

#endif
