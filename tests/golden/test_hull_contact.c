/* SPDX-License-Identifier: BSD-3-Clause */
/* Convex hulls against every kind of shape: a hull of a box's corners is that box, wherever its
 * origin is. */
#include "support/scene.h"

enum { PLANE, BOX, SPHERE, CAPSULE, CYLINDER, HULL, MESH, SUPPORTS };
enum { AS_BOX, AS_HULL, AS_SHIFTED_HULL, SOLIDS };

static const double unit[24] = {-1, -1, -1, 1, -1, -1, -1, 1, -1, 1, 1, -1,
                                -1, -1, 1,  1, -1, 1,  -1, 1, 1,  1, 1, 1};
static const uint32_t sides[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                   2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/* On the ground, with its top at z = 0. */
static void add_support(scene *s, int kind)
{
    static se3d_status (*const create[SUPPORTS])(se3d_system *, const se3d_shape_def *,
                                                 se3d_shape *) = {
        se3d_shape_create_plane,   se3d_shape_create_box,      se3d_shape_create_sphere,
        se3d_shape_create_capsule, se3d_shape_create_cylinder, se3d_shape_create_hull,
        se3d_shape_create_mesh};
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    double corners[24];
    for (int k = 0; k < 24; ++k) {
        corners[k] = 0.3 * unit[k];
    }
    def.radius = 0.3;
    def.length = kind == CAPSULE ? 0.16 : 0.6;
    def.size[0] = def.size[1] = def.size[2] = 0.6;
    def.position[2] = kind == PLANE ? 0.0 : -0.3;
    if (kind == CAPSULE) { /* lies along y */
        def.orientation[0] = def.orientation[1] = sqrt(0.5);
    }
    def.vertices = corners;
    def.vertex_count = 8;
    def.triangles = sides;
    def.triangle_count = 12;
    CHECK(create[kind](s->system, &def, &shape) == SE3D_OK);
}

#define HALF 0.1

static se3d_body add_solid(scene *s, int kind, const double r[3])
{
    const double size[3] = {2.0 * HALF, 2.0 * HALF, 2.0 * HALF}, J[3] = {0.02, 0.02, 0.02};
    const double shift[3] = {0.3, -0.2, 0.25};
    double corners[24];
    se3d_body body = scene_body(s, 2.0, J, r, scene_zero);
    if (kind == AS_BOX) {
        scene_box_on(s, body, size, scene_zero);
        return body;
    }
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    for (int k = 0; k < 24; ++k) {
        const double off = kind == AS_SHIFTED_HULL ? shift[k % 3] : 0.0;
        corners[k] = HALF * unit[k] + off;
        def.position[k % 3] = -off;
    }
    def.vertices = corners;
    def.vertex_count = 8;
    CHECK(se3d_shape_create_hull(s->system, &def, &shape) == SE3D_OK);
    return body;
}

/* Dropped a little askew it comes to rest, carried; where depends on nothing but the shapes. */
static void a_hull_of_a_box_rests_as_the_box_does(void)
{
    static const int points[SUPPORTS] = {4, 4, 1, 2, 4, 4, 4};
    static const int32_t methods[3] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_VERLET,
                                       SE3D_METHOD_DOP853};
    const double m = 2.0, k = 1e5, tilt[3] = {0.6, 0.8, 0.0};
    for (int support = 0; support < SUPPORTS; ++support) {
        for (int kind = 0; kind < SOLIDS; ++kind) {
            const int32_t method = methods[(support + kind) % 3];
            scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.6, 0.2, k);
            const double r[3] = {0.0, 0.0, HALF + 2e-3};
            double at[3], force[3], torque[3];
            add_support(&s, support);
            se3d_body body = add_solid(&s, kind, r);
            if (support != SPHERE && support != CAPSULE) {
                scene_turn(&s, body, tilt, 0.01);
            }
            scene_solve(&s, method, (support + kind) % 2, 0.0, 1e-6);
            scene_run(&s, 0.6);
            const int before = check_failures;
            CHECK(se3d_body_get_position(s.system, body, at) == SE3D_OK);
            CHECK(se3d_body_get_contact_wrench(s.system, body, force, torque) == SE3D_OK);
            CHECK_NEAR(force[2], m * G, 0.02);
            CHECK_NEAR(torque[0], 0.0, 0.01);
            CHECK_NEAR(torque[1], 0.0, 0.01);
            CHECK_NEAR(at[0], 0.0, 1e-3);
            CHECK_NEAR(at[1], 0.0, 1e-3);
            CHECK_NEAR(at[2], HALF - m * G / (points[support] * k),
                       support == CYLINDER ? 1e-4 : 2e-6);
            if (check_failures > before) {
                fprintf(stderr, "  support %d, solid %d, method %d, %zu points\n", support, kind,
                        (int)method, se3d_system_count_contacts(s.system));
            }
            scene_end(&s);
        }
    }
}

/* Free boxes that meet askew: momentum is kept, and both descriptions part alike. */
static void hulls_collide_as_boxes_do(void)
{
    double parted[SOLIDS][3];
    for (int kind = 0; kind < SOLIDS; ++kind) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.6, 1e5);
        const double a[3] = {0.0, 0.0, 0.0}, b[3] = {0.32, 0.03, 0.05}, v[3] = {-1.0, 0.1, 0.0};
        const double axis[3] = {0.48, 0.6, 0.64};
        double u[3], w[3];
        CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
        se3d_body one = add_solid(&s, kind, a), two = add_solid(&s, kind, b);
        scene_turn(&s, two, axis, 0.9);
        CHECK(se3d_body_set_velocity(s.system, two, v) == SE3D_OK);
        scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-8);
        scene_run(&s, 0.3);
        CHECK(se3d_body_get_velocity(s.system, one, u) == SE3D_OK);
        CHECK(se3d_body_get_velocity(s.system, two, w) == SE3D_OK);
        CHECK(se3d_system_count_contacts(s.system) == 0);
        CHECK(u[0] < -0.2);
        for (int c = 0; c < 3; ++c) {
            CHECK_NEAR(u[c] + w[c], v[c], 1e-9);
            parted[kind][c] = w[c];
            CHECK_NEAR(parted[kind][c], parted[AS_BOX][c], 1e-3);
        }
        scene_end(&s);
    }
}

int main(void)
{
    RUN(a_hull_of_a_box_rests_as_the_box_does);
    RUN(hulls_collide_as_boxes_do);
    return check_finish();
}
