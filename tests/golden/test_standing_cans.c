/* SPDX-License-Identifier: BSD-3-Clause */
/* Cylinders that stand on a plane, on a box and on a mesh, by n points around the cap, each with
 * the stiffness k. A tilt t is held by n k R^2 t/2 (the mean of cos^2 is 1/2), less m g H t/2. */
#include "support/scene.h"

#define M    1.0
#define R    0.05
#define H    0.12
#define K    1e5
#define WAYS 5 /* directions of a tilt */

typedef enum support { ON_PLANE, ON_BOX, ON_MESH, SUPPORTS } support;

static const int points[SUPPORTS] = {4, 8, 4};

static void floor_of(scene *s, support on)
{
    static const double corners[12] = {-1.0, -0.9, 0.0, 1.0,  -0.9, 0.0,
                                       1.0,  1.1,  0.0, -1.0, 1.1,  0.0};
    static const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    if (on == ON_PLANE) {
        CHECK(se3d_shape_create_plane(s->system, &def, &shape) == SE3D_OK);
    } else if (on == ON_BOX) {
        def.size[0] = def.size[1] = 1.0;
        def.size[2] = 0.2;
        def.position[2] = -0.1;
        CHECK(se3d_shape_create_box(s->system, &def, &shape) == SE3D_OK);
    } else {
        def.vertices = corners;
        def.vertex_count = 4;
        def.triangles = faces;
        def.triangle_count = 2;
        CHECK(se3d_shape_create_mesh(s->system, &def, &shape) == SE3D_OK);
    }
}

/* A can as deep as it rests, tilted towards a direction. */
static se3d_body can(scene *s, support on, double direction, double tilt)
{
    const double axis[3] = {-sin(direction), cos(direction), 0.0};
    const double r[3] = {0.0, 0.0, 0.5 * H - M * G / (points[on] * K)};
    const se3d_body body = scene_disk(s, M, R, H, r, 0.0, scene_zero);
    scene_turn(s, body, axis, tilt);
    floor_of(s, on);
    return body;
}

/* The axis' part along a direction, and across it. */
static void lean_of(const scene *s, se3d_body body, double direction, double lean[2])
{
    double p[4];
    CHECK(se3d_body_get_orientation(s->system, body, p) == SE3D_OK);
    const double x = 2.0 * (p[1] * p[3] + p[0] * p[2]), y = 2.0 * (p[2] * p[3] - p[0] * p[1]);
    lean[0] = x * cos(direction) + y * sin(direction);
    lean[1] = y * cos(direction) - x * sin(direction);
}

static double way_of(int k)
{
    static const double directions[WAYS] = {0.0, 0.7, PI, 1.25 * PI, 5.0};
    return directions[k];
}

/* Against a tilt. */
static double stiffness_of(support on)
{
    return 0.5 * points[on] * K * R * R - M * G * 0.5 * H;
}

/* Without friction and losses, in any direction, however small the tilt: one and a half times to
 * and fro. */
static void a_can_rocks_as_the_points_around_its_cap_say(void)
{
    static const double tilts[3] = {1e-9, 1e-6, 1e-4};
    const double across = M * (3.0 * R * R + H * H) / 12.0;
    for (int n = 0; n < SUPPORTS * 3 * WAYS; ++n) {
        const support on = (support)(n / (3 * WAYS));
        const double tilt = tilts[n / WAYS % 3], direction = way_of(n % WAYS);
        double lean[2];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.0, 1.0, K);
        const se3d_body body = can(&s, on, direction, tilt);
        scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-3 * tilt);
        scene_run(&s, 3.0 * PI * sqrt(across / stiffness_of(on)));
        lean_of(&s, body, direction, lean);
        CHECK_NEAR(lean[0] / tilt, -1.0, 1e-4);
        CHECK_NEAR(lean[1] / tilt, 0.0, 1e-4);
        scene_end(&s);
    }
}

/* The normal forces have a potential: a can that rocks so far that it comes off all but one point
 * and bounces keeps its energy. Of one that turns besides the points move around the cap. */
static void rocking_keeps_the_energy(void)
{
    for (int n = 0; n < SUPPORTS * WAYS; ++n) {
        const support on = (support)(n / WAYS);
        const double tilt = n % 2 ? 1e-2 : 1e-3, direction = way_of(n % WAYS);
        const double w[3] = {0.0, 0.1, 3.0};
        se3d_energy before, after;
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.0, 1.0, K);
        const se3d_body body = can(&s, on, direction, tilt);
        CHECK(se3d_body_set_angular_velocity(s.system, body, w) == SE3D_OK);
        scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-10);
        scene_run(&s, 0.01);
        CHECK(se3d_system_get_energy(s.system, &before) == SE3D_OK);
        scene_run(&s, 0.15);
        CHECK(se3d_system_get_energy(s.system, &after) == SE3D_OK);
        CHECK_NEAR(after.total, before.total, 1e-9);
        scene_end(&s);
    }
}

/* With friction and losses it comes to rest upright, whatever it leant by. */
static void a_can_goes_back_upright(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_CONVEX, SE3D_METHOD_GENERALIZED_ALPHA};
    static const double tilts[3] = {1e-9, 1e-6, 1e-3};
    for (int n = 0; n < 2 * 3 * SUPPORTS * WAYS; ++n) {
        const support on = (support)(n / WAYS % SUPPORTS);
        const double tilt = tilts[n / (WAYS * SUPPORTS) % 3], direction = way_of(n % WAYS);
        double lean[2];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, K);
        const se3d_body body = can(&s, on, direction, tilt);
        const int32_t method = methods[n / (3 * SUPPORTS * WAYS)];
        scene_solve(&s, method, SE3D_FORMULATION_ROMEGA, method == SE3D_METHOD_CONVEX ? 2e-3 : 2e-4,
                    0.0);
        scene_run(&s, 0.25);
        lean_of(&s, body, direction, lean);
        CHECK(fabs(lean[0]) + fabs(lean[1]) < 1e-3 * tilt + 1e-12);
        scene_end(&s);
    }
}

/* A push at the height of the centre: the tilt is that of the springs. */
static void a_pushed_can_leans_by_what_holds_it(void)
{
    const double push = 0.5;
    for (int n = 0; n < SUPPORTS * WAYS; ++n) {
        const support on = (support)(n / WAYS);
        const double direction = way_of(n % WAYS);
        double lean[2];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.3, K);
        const se3d_body body = can(&s, on, 0.0, 0.0);
        se3d_load_def load = se3d_load_def_default();
        se3d_force force;
        load.body = body;
        load.value[0] = push * cos(direction);
        load.value[1] = push * sin(direction);
        CHECK(se3d_force_create_load(s.system, &load, &force) == SE3D_OK);
        scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, 2e-3, 0.0);
        scene_run(&s, 1.0);
        lean_of(&s, body, direction, lean);
        CHECK_NEAR(lean[0] * stiffness_of(on) / (push * 0.5 * H), 1.0, 1e-3);
        CHECK_NEAR(lean[1], 0.0, 1e-9);
        scene_end(&s);
    }
}

int main(void)
{
    RUN(a_can_rocks_as_the_points_around_its_cap_say);
    RUN(rocking_keeps_the_energy);
    RUN(a_can_goes_back_upright);
    RUN(a_pushed_can_leans_by_what_holds_it);
    return check_finish();
}
