/* SPDX-License-Identifier: BSD-3-Clause */
/* What definitions with hostile numbers are tried in, and the tables of their fields. */
#ifndef SE3D_TESTS_MISUSE_HOSTILE_WORLD_H
#define SE3D_TESTS_MISUSE_HOSTILE_WORLD_H

#include "check.h"
#include "misuse/element_defs.h"
#include "support/parts.h"

/* A hinged and a sliding body, a ball over a floor, a few particles beside it. */
typedef struct world {
    se3d_system *system;
    se3d_body ground, hinged, sliding, ball;
    se3d_constraint pin, slide;
    se3d_material material;
    se3d_particles *set;
    se3d_solver *solver;
    se3d_fill_def fill;
} world;

/* The largest definition fits. */
typedef union def_storage {
    size_t struct_size;
    double numbers[200];
} def_storage;

/* One kind of definition: its fields, good values, and the call that takes it. */
typedef struct subject {
    const char *name;
    const field *fields;
    void (*fill)(world *w, void *def);
    se3d_status (*create)(world *w, const void *def);
    int with_particles;
} subject;

static inline void world_touch(world *w)
{
    se3d_material_def stuff = se3d_material_def_default();
    se3d_shape_def shape = se3d_shape_def_default();
    se3d_shape made;
    stuff.density = 1000.0;
    stuff.stiffness = 1e5;
    stuff.young = 1e7;
    CHECK(se3d_material_create(w->system, &stuff, &w->material) == SE3D_OK);
    shape.material = w->material;
    CHECK(se3d_shape_create_plane(w->system, &shape, &made) == SE3D_OK);
    shape.body = w->ball;
    shape.radius = 0.1;
    CHECK(se3d_shape_create_sphere(w->system, &shape, &made) == SE3D_OK);
}

static inline void world_add_particles(world *w)
{
    se3d_particles_def def = se3d_particles_def_default();
    const double r[6] = {3.0, 0.0, 0.1, 3.5, 0.0, 0.2};
    const double radius[2] = {0.1, 0.1};
    uint32_t first;
    CHECK(se3d_particles_create(w->system, &def, &w->set) == SE3D_OK);
    CHECK(se3d_particles_add(w->set, w->material, 2, r, radius, NULL, NULL, &first) == SE3D_OK);
}

static inline void world_open(world *w, int with_particles)
{
    memset(w, 0, sizeof *w);
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_solver_def how = se3d_solver_def_default();
    CHECK(se3d_system_create(NULL, &w->system) == SE3D_OK);
    CHECK(se3d_system_get_ground(w->system, &w->ground) == SE3D_OK);
    w->hinged = part_body(w->system, "hinged", 1.0, 2.0);
    w->sliding = part_body(w->system, "sliding", -1.0, 2.0);
    w->ball = part_body(w->system, "ball", 0.0, 0.0999);
    joint.body_i = w->ground;
    joint.body_j = w->hinged;
    joint.axis_i[1] = joint.axis_j[1] = 1.0;
    joint.axis_i[2] = joint.axis_j[2] = 0.0;
    joint.point_i[2] = 2.0;
    joint.point_j[0] = -1.0;
    CHECK(se3d_joint_create_revolute(w->system, &joint, &w->pin) == SE3D_OK);
    joint.body_j = w->sliding;
    joint.point_j[0] = 1.0;
    CHECK(se3d_joint_create_prismatic(w->system, &joint, &w->slide) == SE3D_OK);
    world_touch(w);
    if (with_particles) {
        world_add_particles(w);
    }
    how.method = with_particles ? SE3D_METHOD_VERLET : SE3D_METHOD_GENERALIZED_ALPHA;
    how.step = with_particles ? 0.0 : 5e-4;
    CHECK(se3d_solver_create(w->system, &how, &w->solver) == SE3D_OK);
}

static inline void world_close(world *w)
{
    se3d_solver_destroy(w->solver);
    se3d_particles_destroy(w->set);
    se3d_system_destroy(w->system);
}

#endif
