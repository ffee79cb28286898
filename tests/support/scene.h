/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies with shapes of one material, and a solver: scenes of contact for tests. */
#ifndef SE3D_TESTS_SUPPORT_SCENE_H
#define SE3D_TESTS_SUPPORT_SCENE_H

#include "check.h"
#include "se3d/se3d.h"

#define G  9.81
#define PI 3.14159265358979323846

typedef struct scene {
    se3d_system *system;
    se3d_material material;
    se3d_solver *solver;
} scene;

static const double scene_zero[3] = {0.0, 0.0, 0.0};

static inline se3d_material_def scene_stuff(double friction, double restitution, double stiffness)
{
    se3d_material_def def = se3d_material_def_default();
    def.density = 1000.0;
    def.friction = friction;
    def.restitution = restitution;
    def.stiffness = stiffness;
    def.young = 1e7;
    return def;
}

/* Without an allocator: the standard one. */
static inline scene scene_begin_with(const se3d_allocator *allocator, int32_t law,
                                     const se3d_material_def *stuff)
{
    scene s = {0};
    se3d_system_def def = se3d_system_def_default();
    se3d_contact_settings settings = se3d_contact_settings_default();
    if (allocator) {
        def.allocator = allocator;
    }
    CHECK(se3d_system_create(&def, &s.system) == SE3D_OK);
    settings.law = law;
    CHECK(se3d_system_set_contact(s.system, &settings) == SE3D_OK);
    CHECK(se3d_material_create(s.system, stuff, &s.material) == SE3D_OK);
    return s;
}

static inline scene scene_begin(int32_t law, double friction, double restitution, double stiffness)
{
    const se3d_material_def stuff = scene_stuff(friction, restitution, stiffness);
    return scene_begin_with(NULL, law, &stuff);
}

static inline void scene_end(scene *s)
{
    se3d_solver_destroy(s->solver);
    se3d_system_destroy(s->system);
}

static inline void scene_solve(scene *s, int32_t method, int32_t formulation, double step,
                               double tolerance)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.method = method;
    def.formulation = formulation;
    def.step = step;
    def.tolerance = tolerance;
    CHECK(se3d_solver_create(s->system, &def, &s->solver) == SE3D_OK);
}

/* Run to t; a failure counts as one and is shown. */
static inline int scene_run(scene *s, double t)
{
    const int runs = se3d_solver_run(s->solver, t) >= 0;
    CHECK(runs);
    if (!runs) {
        fprintf(stderr, "%s\n", se3d_system_get_error(s->system));
    }
    return runs;
}

/* With principal moments of inertia J, at r with the velocity v. */
static inline se3d_body scene_body(scene *s, double mass, const double J[3], const double r[3],
                                   const double v[3])
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    def.mass = mass;
    memcpy(def.inertia, J, 3 * sizeof *J);
    memcpy(def.position, r, 3 * sizeof *r);
    memcpy(def.velocity, v, 3 * sizeof *v);
    CHECK(se3d_body_create(s->system, &def, &body) == SE3D_OK);
    return body;
}

static inline se3d_body scene_ground(const scene *s)
{
    se3d_body ground;
    CHECK(se3d_system_get_ground(s->system, &ground) == SE3D_OK);
    return ground;
}

/* Turn a body about an axis (unit). */
static inline void scene_turn(scene *s, se3d_body body, const double axis[3], double angle)
{
    const double c = cos(0.5 * angle), h = sin(0.5 * angle);
    const double p[4] = {c, h * axis[0], h * axis[1], h * axis[2]};
    CHECK(se3d_body_set_orientation(s->system, body, p) == SE3D_OK);
}

/* A shape of the scene's material on a body, all else zero. */
static inline se3d_shape_def scene_shape(const scene *s, se3d_body body)
{
    se3d_shape_def def = se3d_shape_def_default();
    def.body = body;
    def.material = s->material;
    return def;
}

/* A cylinder about z, solid and of mass m, that is turned about y and spins with w. */
static inline se3d_body scene_disk(scene *s, double m, double radius, double height,
                                   const double r[3], double tilt, const double w[3])
{
    const double across = m * (3.0 * radius * radius + height * height) / 12.0;
    const double J[3] = {across, across, 0.5 * m * radius * radius}, y[3] = {0.0, 1.0, 0.0};
    const se3d_body disk = scene_body(s, m, J, r, scene_zero);
    scene_turn(s, disk, y, tilt);
    CHECK(se3d_body_set_angular_velocity(s->system, disk, w) == SE3D_OK);
    se3d_shape_def solid = scene_shape(s, disk);
    se3d_shape shape;
    solid.radius = radius;
    solid.length = height;
    CHECK(se3d_shape_create_cylinder(s->system, &solid, &shape) == SE3D_OK);
    return disk;
}

/* A solid ball. */
static inline se3d_body scene_ball(scene *s, double radius, double mass, const double r[3],
                                   const double v[3])
{
    const double j = 0.4 * mass * radius * radius;
    const double J[3] = {j, j, j};
    se3d_body body = scene_body(s, mass, J, r, v);
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    def.radius = radius;
    CHECK(se3d_shape_create_sphere(s->system, &def, &shape) == SE3D_OK);
    return body;
}

static inline se3d_shape scene_box_on(scene *s, se3d_body body, const double size[3],
                                      const double position[3])
{
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    memcpy(def.size, size, sizeof def.size);
    memcpy(def.position, position, sizeof def.position);
    CHECK(se3d_shape_create_box(s->system, &def, &shape) == SE3D_OK);
    return shape;
}

/* A solid box. */
static inline se3d_body scene_box(scene *s, const double size[3], double mass, const double r[3],
                                  const double v[3])
{
    double J[3];
    for (int k = 0; k < 3; ++k) {
        double a = size[(k + 1) % 3], b = size[(k + 2) % 3];
        J[k] = mass * (a * a + b * b) / 12.0;
    }
    se3d_body body = scene_body(s, mass, J, r, v);
    scene_box_on(s, body, size, scene_zero);
    return body;
}

/* The ground: a plane through the origin whose normal leans by `angle` towards x. */
static inline se3d_shape scene_floor(scene *s, double angle)
{
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    def.name = "floor";
    def.normal[0] = sin(angle);
    def.normal[2] = cos(angle);
    CHECK(se3d_shape_create_plane(s->system, &def, &shape) == SE3D_OK);
    return shape;
}

static inline void scene_mesh_on(scene *s, se3d_body body, const double *points, size_t point_count,
                                 const uint32_t *faces, size_t face_count)
{
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    def.vertices = points;
    def.vertex_count = point_count;
    def.triangles = faces;
    def.triangle_count = face_count;
    CHECK(se3d_shape_create_mesh(s->system, &def, &shape) == SE3D_OK);
}

#endif
