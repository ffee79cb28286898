/* SPDX-License-Identifier: BSD-3-Clause */
/* Method convex at steps of milliseconds against closed forms and against verlet at small steps:
 * rest, sticking, sliding, impacts, stacks, dominoes, heaps, contact of what joints hold. */
#include "support/scene.h"

#define STEP 1e-3

static const double about_y[3] = {0.0, 1.0, 0.0};

static void get(const scene *s, se3d_body body, double r[3], double v[3])
{
    CHECK(se3d_body_get_position(s->system, body, r) == SE3D_OK);
    CHECK(se3d_body_get_velocity(s->system, body, v) == SE3D_OK);
}

static double distance(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2.0) + pow(a[1] - b[1], 2.0) + pow(a[2] - b[2], 2.0));
}

static double get_energy(const scene *s)
{
    se3d_energy energy;
    CHECK(se3d_system_get_energy(s->system, &energy) == SE3D_OK);
    return energy.kinetic + energy.potential;
}

/* Four corners carry the weight: as deep as the law's springs say, with any stiffness. */
static void a_box_rests_as_deep_as_its_springs_say(void)
{
    static const double stiffness[3] = {2e3, 1e5, 1e8};
    const double size[3] = {0.2, 0.2, 0.2}, start[3] = {0.0, 0.0, 0.1};
    for (int k = 0; k < 12; ++k) {
        double r[3], v[3], force[3], torque[3];
        const double stiff = stiffness[k % 3], h = k < 6 ? STEP : 5e-3;
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, stiff);
        se3d_body box = scene_box(&s, size, 2.0, start, scene_zero);
        scene_floor(&s, 0.0);
        scene_solve(&s, SE3D_METHOD_CONVEX, k / 3 % 2, h, 0.0);
        scene_run(&s, 3.0);
        get(&s, box, r, v);
        CHECK_NEAR(r[2], 0.1 - 2.0 * G / (4.0 * stiff), 1e-9);
        CHECK(fabs(v[2]) < 1e-9);
        CHECK(se3d_body_get_contact_wrench(s.system, box, force, torque) == SE3D_OK);
        CHECK_NEAR(force[2], 2.0 * G, 2e-6 * G);
        CHECK(se3d_system_count_contacts(s.system) == 4);
        scene_end(&s);
    }
}

/* A cylinder or a hull that stands on four corners, leant by an angle. */
static se3d_body stand(scene *s, int is_hull, double angle)
{
    static const double corners[24] = {-0.1, -0.1, -0.1, 0.1,  -0.1,  -0.1, -0.1,  0.1,
                                       -0.1, 0.1,  0.1,  -0.1, -0.05, 0.0,  0.1,   0.05,
                                       0.0,  0.1,  0.0,  0.05, 0.1,   0.0,  -0.05, 0.1};
    const double J[3] = {0.01, 0.01, 0.01};
    const double r[3] = {0.02, -0.01, 0.1 * cos(angle) + 0.1 * sin(angle)};
    se3d_body body = scene_body(s, 2.0, J, r, scene_zero);
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    scene_turn(s, body, about_y, angle);
    def.radius = 0.1;
    def.length = 0.2;
    def.vertices = corners;
    def.vertex_count = 8;
    CHECK((is_hull ? se3d_shape_create_hull(s->system, &def, &shape)
                   : se3d_shape_create_cylinder(s->system, &def, &shape)) == SE3D_OK);
    return body;
}

/* Let go on an edge, they fall onto a mesh and come to rest as deep as the law says. */
static void cylinders_and_hulls_come_to_rest_on_meshes(void)
{
    static const double points[15] = {-1.0, -1.0, 0.0, 1.0, -1.1, 0.0,  1.2, 1.0,
                                      0.0,  -0.9, 1.0, 0.0, 0.01, 0.02, 0.0};
    static const uint32_t faces[12] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    for (int k = 0; k < 8; ++k) {
        double r[3], v[3];
        se3d_energy energy;
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5);
        se3d_body body = stand(&s, k % 2, k / 4 ? 0.2 : 0.0);
        scene_mesh_on(&s, scene_ground(&s), points, 5, faces, 4);
        scene_solve(&s, SE3D_METHOD_CONVEX, k / 2 % 2, k % 3 ? STEP : 5e-3, 0.0);
        scene_run(&s, 3.0);
        get(&s, body, r, v);
        const double count = (double)se3d_system_count_contacts(s.system);
        CHECK(count > 3.5);
        CHECK_NEAR(r[2], 0.1 - 2.0 * G / (count * 1e5), 3e-6);
        CHECK(se3d_system_get_energy(s.system, &energy) == SE3D_OK);
        CHECK(energy.kinetic < 1e-12);
        scene_end(&s);
    }
}

static void a_ball_rests_as_deep_as_hertz_says(void)
{
    const double start[3] = {0.0, 0.0, 0.0502};
    for (int k = 0; k < 2; ++k) {
        double r[3], v[3];
        scene s = scene_begin(SE3D_CONTACT_LAW_HERTZ_MINDLIN, 0.5, 0.3, 1e5);
        se3d_body ball = scene_ball(&s, 0.05, 0.5, start, scene_zero);
        scene_floor(&s, 0.0);
        scene_solve(&s, k ? SE3D_METHOD_CONVEX : SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA,
                    k ? STEP : 0.0, 0.0);
        scene_run(&s, 2.0);
        get(&s, ball, r, v);
        const double young = 1e7 / (2.0 * (1.0 - 0.3 * 0.3));
        const double depth = pow(0.5 * G / (4.0 / 3.0 * young * sqrt(0.05)), 2.0 / 3.0);
        CHECK_NEAR(r[2], 0.05 - depth, k ? 1e-3 * depth : 0.1 * depth);
        scene_end(&s);
    }
}

/* A cube on a plane that leans, and where it is after a time. */
static void lean(double angle, double mu, double until, double r[3], double v[3])
{
    const double size[3] = {0.2, 0.2, 0.2};
    const double height = 0.1 - 2.0 * G * cos(angle) / (4.0 * 1e5);
    const double start[3] = {height * sin(angle), 0.0, height * cos(angle)};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, mu, 0.3, 1e5);
    se3d_body box = scene_box(&s, size, 2.0, start, scene_zero);
    scene_turn(&s, box, about_y, angle);
    scene_floor(&s, angle);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    scene_run(&s, until);
    get(&s, box, r, v);
    scene_end(&s);
}

static void a_box_on_a_slope_slips_at_the_angle_of_friction(void)
{
    const double limit = atan(0.5);
    double before[3], after[3], v[3];
    lean(0.99 * limit, 0.5, 2.0, before, v);
    lean(0.99 * limit, 0.5, 12.0, after, v);
    CHECK(distance(before, after) < 1e-6);
    lean(1.01 * limit, 0.5, 2.0, before, v);
    CHECK(sqrt(v[0] * v[0] + v[2] * v[2]) > 0.05);
    const double slope = 20.0 * PI / 180.0;
    lean(slope, 0.2, 1.0, after, v);
    CHECK_NEAR(sqrt(v[0] * v[0] + v[2] * v[2]), G * (sin(slope) - 0.2 * cos(slope)), 0.01);
}

/* A ball thrown at the floor; how it leaves. */
static void bounce(int32_t law, double e, double mu, double stiffness, const double v0[3],
                   double v[3], double height)
{
    const double start[3] = {0.0, 0.0, 0.05 + height};
    double r[3];
    se3d_material_def stuff = scene_stuff(mu, e, stiffness);
    stuff.young = 5e4 * sqrt(stiffness);
    scene s = scene_begin_with(NULL, law, &stuff);
    CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
    se3d_body ball = scene_ball(&s, 0.05, 0.5, start, v0);
    scene_floor(&s, 0.0);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    scene_run(&s, 0.6);
    get(&s, ball, r, v);
    scene_end(&s);
}

/* Impacts of one step, slow and fast; they are as rigid as to give 1e-3 of the change of speed. */
static void short_impacts_have_the_restitution_typed(void)
{
    const double speeds[4] = {0.02, 0.2, 1.0, 6.0};
    for (int k = 0; k < 32; ++k) {
        const double e = 0.2 + 0.2 * (k % 4), v0[3] = {0.0, 0.0, -speeds[k / 4 % 4]};
        double v[3];
        bounce(k / 16 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE, e, 0.3, 1e7, v0, v,
               fmin(0.0102, 0.3 * speeds[k / 4 % 4]));
        CHECK_NEAR(v[2] / -v0[2], e, 1.01e-3 * (1.0 + e));
    }
}

/* Stiff: an impact of one step; soft: its time is 100 steps. */
static void impacts_have_the_restitution_typed(void)
{
    const double stiffness[3] = {1e7, 1e5, 490.0};
    for (int k = 0; k < 24; ++k) {
        const double e = 0.2 + 0.2 * (k % 4), v0[3] = {0.0, 0.0, -0.2};
        double v[3];
        bounce(k / 12 ? SE3D_CONTACT_LAW_HERTZ_MINDLIN : SE3D_CONTACT_LAW_HOOKE, e, 0.3,
               stiffness[k / 4 % 3], v0, v, 0.0102 + 3e-5 * (k % 5));
        CHECK_NEAR(v[2] / 0.2, e, 0.05 * e);
    }
}

/* Contacts of 13 to 60 steps are followed: the ball is away for half a swing, and keeps its speed.
 */
static void what_lasts_a_dozen_steps_is_followed(void)
{
    static const double steps[] = {13.0, 20.0, 31.0, 60.0}, given[] = {1.0, 0.5, 0.3};
    const double mass = 0.5, u = 0.2;
    for (int k = 0; k < 60; ++k) {
        const double e = given[k / 4 % 3], gap = 0.0102 + 4e-5 * (k / 12);
        const double time = steps[k % 4] * STEP, rate = 3.14159265358979324 / time;
        const double start[3] = {0.0, 0.0, 0.05 + gap}, v0[3] = {0.0, 0.0, -u};
        double r[3], v[3];
        se3d_material_def stuff = scene_stuff(0.3, e, mass * rate * rate);
        scene s = scene_begin_with(NULL, SE3D_CONTACT_LAW_HOOKE, &stuff);
        CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
        const se3d_body ball = scene_ball(&s, 0.05, mass, start, v0);
        scene_floor(&s, 0.0);
        scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
        scene_run(&s, 0.3);
        get(&s, ball, r, v);
        CHECK_NEAR(v[2] / u, e, 0.025 * e);
        if (k / 4 % 3 == 0) {
            CHECK_NEAR(r[2], 0.05 + u * (0.3 - gap / u - time), 0.015 * 0.05);
        }
        scene_end(&s);
    }
}

/* The friction impulse of a gross slide is mu times that of the normal force. */
static void sliding_impacts_take_mu_times_the_normal_impulse(void)
{
    for (int k = 0; k < 4; ++k) {
        const double e = 0.2 + 0.2 * k, v0[3] = {5.0, 0.0, -1.0};
        double v[3];
        bounce(SE3D_CONTACT_LAW_HOOKE, e, 0.3, 1e6, v0, v, 0.0102);
        CHECK_NEAR((v0[0] - v[0]) / (0.3 * (v[2] - v0[2])), 1.0, 0.01);
    }
}

static void a_stack_of_ten_stands_without_creep(void)
{
    const double size[3] = {0.1, 0.1, 0.1};
    se3d_body boxes[10];
    double before[10][3], after[3], v[3];
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e6);
    scene_floor(&s, 0.0);
    for (int k = 0; k < 10; ++k) {
        const double r[3] = {0.004 * (k % 2), 0.0, 0.05 + 0.1 * k};
        boxes[k] = scene_box(&s, size, 1.0, r, scene_zero);
    }
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    scene_run(&s, 2.0);
    for (int k = 0; k < 10; ++k) {
        get(&s, boxes[k], before[k], v);
    }
    scene_run(&s, 12.0);
    for (int k = 0; k < 10; ++k) {
        get(&s, boxes[k], after, v);
        CHECK(distance(before[k], after) < 1e-6);
    }
    double sink = 0.0; /* contact k carries 10 - k boxes on four corners */
    for (int k = 0; k < 10; ++k) {
        sink += (10 - k) * G / (4.0 * 1e6);
    }
    CHECK_NEAR(after[2], 0.95 - sink, 1e-6);
    scene_end(&s);
}

/* Edges of equal boxes lie on each other: what touches must not change by turns of 1e-6. */
static void a_pyramid_stands_without_creep(void)
{
    enum { ROWS = 6, COUNT = ROWS * (ROWS + 1) / 2 };
    const double size[3] = {0.1, 0.1, 0.1};
    se3d_body box[COUNT];
    double before[COUNT][3], r[3];
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.1, 1e5);
    int count = 0;
    for (int row = 0; row < ROWS; ++row) {
        for (int k = 0; k < ROWS - row; ++k) {
            const double at[3] = {0.105 * (k + 0.5 * row), 0.0, 0.05 + 0.1 * row};
            box[count++] = scene_box(&s, size, 1.0, at, scene_zero);
        }
    }
    scene_floor(&s, 0.0);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    for (int second = 0; second < 2; ++second) {
        CHECK(scene_run(&s, 0.7 + second));
        CHECK(se3d_system_count_contacts(s.system) == 4 * ROWS + 8 * (COUNT - ROWS));
        for (int k = 0; k < COUNT; ++k) {
            CHECK(se3d_body_get_position(s.system, box[k], r) == SE3D_OK);
            for (int c = 0; c < 3 && second; ++c) {
                CHECK(fabs(r[c] - before[k][c]) < 1e-6);
            }
            memcpy(before[k], r, sizeof r);
        }
    }
    scene_end(&s);
}

/* In a row; the first is pushed over. */
static void set_up_dominoes(const scene *begun, int count, se3d_body *stones)
{
    scene s = *begun;
    const double size[3] = {0.02, 0.05, 0.1};
    const double push[3] = {0.0, 4.0, 0.0}, forth[3] = {0.2, 0.0, 0.0};
    scene_floor(&s, 0.0);
    for (int k = 0; k < count; ++k) {
        const double r[3] = {0.05 * k, 0.0, 0.05};
        stones[k] = scene_box(&s, size, 0.05, r, scene_zero);
    }
    CHECK(se3d_body_set_velocity(s.system, stones[0], forth) == SE3D_OK);
    CHECK(se3d_body_set_angular_velocity(s.system, stones[0], push) == SE3D_OK);
}

static void twenty_dominoes_fall(void)
{
    se3d_body stones[20];
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.4, 0.1, 1e5);
    set_up_dominoes(&s, 20, stones);
    const double first = get_energy(&s);
    double energy = first;
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    for (int k = 1; k <= 60; ++k) {
        scene_run(&s, 0.05 * k);
        CHECK(get_energy(&s) < energy + 0.01 * first);
        energy = get_energy(&s);
    }
    for (int k = 0; k < 20; ++k) {
        double r[3], v[3];
        get(&s, stones[k], r, v);
        CHECK(r[2] < 0.04);
    }
    scene_end(&s);
}

/* auto takes convex for ten bodies or more, unless a tolerance asks for control of the error. */
static void many_bodies_are_stepped_by_convex(void)
{
    static const struct {
        int32_t method;
        int count;
        double tolerance;
    } runs[5] = {{SE3D_METHOD_CONVEX, 10, 0.0},
                 {SE3D_METHOD_AUTO, 10, 0.0},
                 {SE3D_METHOD_AUTO, 10, 1e-6},
                 {SE3D_METHOD_CONVEX, 9, 0.0},
                 {SE3D_METHOD_AUTO, 9, 0.0}};
    uint64_t hash[5];
    for (int k = 0; k < 5; ++k) {
        se3d_body stones[10];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.4, 0.1, 1e5);
        set_up_dominoes(&s, runs[k].count, stones);
        scene_solve(&s, runs[k].method, SE3D_FORMULATION_AUTO, 0.0, runs[k].tolerance);
        scene_run(&s, 0.005);
        scene_run(&s, 0.01); /* goes on by the same method */
        hash[k] = se3d_system_hash(s.system);
        scene_end(&s);
    }
    CHECK(hash[0] == hash[1] && hash[0] != hash[2]);
    CHECK(hash[3] != hash[4]);
}

static const char *method_of(const scene *s)
{
    const char *name = "";
    CHECK(se3d_solver_get_method(s->solver, &name) == SE3D_OK);
    return name;
}

/* Balls in a row, one diameter apart, at a height above a floor, if there is one. */
static scene line_up_balls(int count, double height, int has_floor, uint32_t mask)
{
    const double v[3] = {0.1, 0.0, 0.0};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.4, 0.5, 1e4);
    if (has_floor) {
        scene_floor(&s, 0.0);
    }
    for (int k = 0; k < count; ++k) {
        const double r[3] = {0.2 * k, 0.0, 0.05 + height}, j = 0.4 * 0.5 * 0.0025;
        const double J[3] = {j, j, j};
        se3d_shape_def def = scene_shape(&s, scene_body(&s, 0.5, J, r, v));
        se3d_shape shape;
        def.radius = 0.05;
        def.mask = mask;
        CHECK(se3d_shape_create_sphere(s.system, &def, &shape) == SE3D_OK);
    }
    return s;
}

/* auto follows what has not come together with error control, and leaves it for convex then. */
static void bodies_far_apart_are_no_crowd(void)
{
    for (int k = 0; k < 3; ++k) {
        const int falls = k > 0, steps = k == 2;
        double time = 0.0;
        const char *left = "";
        scene s = line_up_balls(12, 0.05, falls, UINT32_MAX);
        scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0, 0.0);
        for (int i = 1; steps && i <= 200; ++i) {
            CHECK(se3d_solver_step(s.solver, 1e-3) >= 0);
        }
        scene_run(&s, steps ? 0.2 : 0.05);
        CHECK(steps || strcmp(method_of(&s), "dop853") == 0);
        scene_run(&s, 0.2);
        CHECK(strcmp(method_of(&s), falls ? "convex" : "dop853") == 0);
        CHECK(se3d_solver_get_switch(s.solver, &time, &left) == SE3D_OK);
        CHECK(strcmp(left, falls ? "dop853" : "") == 0);
        CHECK(!falls || fabs(time - sqrt(2.0 * 0.05 / G)) < 0.02);
        scene_end(&s);
    }
}

/* Clones choose as the one that they are of does. */
static void clones_meet_a_crowd_at_the_same_step(void)
{
    uint64_t hash[3];
    for (int k = 0; k < 3; ++k) {
        scene s = line_up_balls(12, 0.05, 1, UINT32_MAX);
        se3d_system *copy = NULL;
        scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0, 0.0);
        for (int i = 1; i <= 4; ++i) {
            scene_run(&s, 0.05 * i);
            if (k == i) {
                CHECK(se3d_system_clone(s.system, &copy) == SE3D_OK);
                scene_end(&s);
                s.system = copy;
                scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0, 0.0);
            }
        }
        CHECK(strcmp(method_of(&s), "convex") == 0);
        hash[k] = se3d_system_hash(s.system);
        scene_end(&s);
    }
    CHECK(hash[0] == hash[1] && hash[0] == hash[2]);
}

/* What convex is not made for stays with error control: a longer step, gravity that changes, what
 * masks let not touch; what has been stepped by convex goes on by it. */
static void auto_knows_the_limits_of_convex(void)
{
    for (int k = 0; k < 6; ++k) {
        const double step[6] = {5e-3, 6e-3, 0.0, 0.0, 0.0, 0.0};
        const int count = k < 4 ? 12 : 9 + (k - 4);
        scene s = line_up_balls(count, 0.0, 1, k == 3 ? 0 : UINT32_MAX);
        if (k == 2) {
            se3d_function gravity[3] = {{0, 0}, {0, 0}, {0, 0}};
            CHECK(se3d_function_create_expression(s.system, "-9 - t", &gravity[2]) == SE3D_OK);
            CHECK(se3d_system_set_gravity_function(s.system, gravity) == SE3D_OK);
        }
        if (k >= 4) {
            scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_AUTO, 0.0, 0.0);
            scene_run(&s, 0.01);
            se3d_solver_destroy(s.solver);
        }
        scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, step[k], 0.0);
        scene_run(&s, 0.02);
        CHECK(strcmp(method_of(&s), k == 0 || k >= 4 ? "convex" : "dop853") == 0);
        scene_end(&s);
    }
}

/* Hills of 5 mm. */
static void scene_hills(scene *s)
{
    enum { ROWS = 17, COLUMNS = 41 };
    static double heights[ROWS * COLUMNS];
    for (int k = 0; k < ROWS * COLUMNS; ++k) {
        const int row = k / COLUMNS, column = k % COLUMNS;
        heights[k] = 0.005 * cos(row - ROWS / 2) * sin(column - COLUMNS / 2);
    }
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    def.heights = heights;
    def.row_count = ROWS;
    def.column_count = COLUMNS;
    def.spacing[0] = def.spacing[1] = 0.05;
    CHECK(se3d_shape_create_heightfield(s->system, &def, &shape) == SE3D_OK);
}

/* A frame on four wheels, cylinders on hinges about y, which rolls on a plane or over hills. */
static scene build_cart(int has_hills, se3d_body *last)
{
    const double J[3] = {0.004, 0.004, 0.004}, forth[3] = {0.5, 0.0, 0.0};
    const double about_x[3] = {1.0, 0.0, 0.0}, height = has_hills ? 0.106 : 0.1005;
    const double top[3] = {0.0, 0.0, height};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.6, 0.2, 1e8);
    const se3d_body frame = scene_body(&s, 10.0, J, top, forth);
    if (has_hills) {
        scene_hills(&s);
    } else {
        scene_floor(&s, 0.0);
    }
    for (int k = 0; k < 4; ++k) {
        const double r[3] = {0.3 * (k % 2) - 0.15, 0.2 * (k / 2) - 0.1, height};
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint hinge;
        *last = scene_body(&s, 1.0, J, r, scene_zero);
        scene_turn(&s, *last, about_x, 0.5 * PI);
        se3d_shape_def shape = scene_shape(&s, *last);
        se3d_shape made;
        shape.radius = 0.1;
        shape.length = 0.06;
        CHECK(se3d_shape_create_cylinder(s.system, &shape, &made) == SE3D_OK);
        def.body_i = frame;
        def.body_j = *last;
        def.point_i[0] = r[0];
        def.point_i[1] = r[1];
        memcpy(def.axis_i, about_y, sizeof about_y);
        def.axis_j[0] = def.axis_j[1] = 0.0;
        def.axis_j[2] = -1.0;
        CHECK(se3d_joint_create_revolute(s.system, &def, &hinge) == SE3D_OK);
    }
    return s;
}

/* 0: a cart on hills; balls on hinges about y: 1: five that hang beside each other, of which the
 * first one is let go; 2: two on arms that fall on the floor; 3: a cart on a plane. */
static scene build_machine(int kind, se3d_body *last)
{
    enum { CARTS_ON_HILLS, CRADLES, ARMS, CARTS };
    const double J[3] = {0.004, 0.004, 0.004}, arm = 0.4;
    const int count = kind == CRADLES ? 5 : 2;
    if (kind == CARTS_ON_HILLS || kind == CARTS) {
        return build_cart(kind == CARTS_ON_HILLS, last);
    }
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.6, kind == CRADLES ? 1.0 : 0.2, 1e6);
    if (kind == ARMS) {
        scene_floor(&s, 0.0);
    }
    for (int k = 0; k < count; ++k) {
        const double angle = kind == CRADLES && k == 0 ? 0.3 : 0.0;
        const double x = kind == CRADLES ? 0.1 * k - arm * sin(angle) : 0.3 * (k % 2) - 0.15;
        const double z = kind == CRADLES ? 1.0 - arm * cos(angle) : 0.2;
        const double r[3] = {x, 0.0, z};
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint hinge;
        *last = scene_body(&s, 1.0, J, r, scene_zero);
        scene_turn(&s, *last, about_y, angle);
        se3d_shape_def shape = scene_shape(&s, *last);
        se3d_shape made;
        shape.radius = 0.05;
        CHECK(se3d_shape_create_sphere(s.system, &shape, &made) == SE3D_OK);
        def.body_i = scene_ground(&s);
        def.body_j = *last;
        memcpy(def.axis_i, about_y, sizeof about_y);
        memcpy(def.axis_j, about_y, sizeof about_y);
        if (kind == CRADLES) {
            def.point_i[0] = 0.1 * k;
            def.point_i[2] = 1.0;
            def.point_j[2] = arm;
        } else {
            def.point_i[0] = x - 0.4;
            def.point_i[2] = 0.2;
            def.point_j[0] = -0.4;
        }
        CHECK(se3d_joint_create_revolute(s.system, &def, &hinge) == SE3D_OK);
    }
    return s;
}

/* auto follows contacts of what joints hold, and leaves it for convex where these make its steps
 * short; not if a few bodies hit something or roll, or balls pass impacts on to each other. */
static void auto_leaves_machines_that_touch_for_convex(void)
{
    static const double until[4] = {0.4, 0.5, 0.6, 0.4};
    for (int kind = 0; kind < 4; ++kind) {
        double r[3], v[3], time = 0.0;
        const char *left = "";
        se3d_body last;
        scene s = build_machine(kind, &last);
        scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_AUTO, 0.0, 0.0);
        CHECK(scene_run(&s, until[kind]));
        CHECK(strcmp(method_of(&s), kind == 0 ? "convex" : "dop853") == 0 ||
              (kind && strcmp(method_of(&s), "radau") == 0));
        CHECK(se3d_solver_get_switch(s.solver, &time, &left) == SE3D_OK);
        CHECK(kind || (strcmp(left, "dop853") == 0 && time > 0.01 && time < 0.3));
        get(&s, last, r, v);
        if (kind == 0) {
            CHECK(v[0] > 0.1 && v[0] < 0.5); /* it has not stopped */
        } else if (kind == 1) {
            CHECK(r[0] > 0.43); /* it was sent off */
        } else if (kind == 3) {
            CHECK_NEAR(v[0], 10.0 * 0.5 / (14.0 + 4.0 * 0.004 / 0.01), 0.02); /* it rolls */
        }
        scene_end(&s);
    }
}

/* A step that radau cannot make is told with what would do. */
static void what_fails_names_convex(void)
{
    const double size[3] = {0.1, 0.1, 0.1}, r[3] = {0.0, 0.0, 0.06}, v[3] = {0.0, 0.0, -1.0};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e30);
    scene_floor(&s, 0.0);
    scene_box(&s, size, 0.5, r, v);
    scene_solve(&s, SE3D_METHOD_RADAU, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    CHECK(se3d_solver_run(s.solver, 0.1) < 0);
    CHECK_CONTAINS(se3d_system_get_error(s.system), "method convex");
    scene_end(&s);
}

/* Boxes that fall on each other come to rest, and no step makes energy. */
static void a_heap_of_27_boxes_settles(void)
{
    const double size[3] = {0.1, 0.1, 0.1};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5);
    scene_floor(&s, 0.0);
    for (int k = 0; k < 27; ++k) {
        const double r[3] = {0.13 * (k % 3) + 0.011 * (k / 9), 0.13 * (k / 3 % 3) - 0.017 * (k / 9),
                             0.12 + 0.18 * (k / 9)};
        const double axis[3] = {0.6, 0.0, 0.8};
        scene_turn(&s, scene_box(&s, size, 0.5, r, scene_zero), axis, 0.02 * k);
    }
    const double first = get_energy(&s);
    double energy = first;
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    for (int k = 1; k <= 150; ++k) {
        scene_run(&s, 0.02 * k);
        CHECK(get_energy(&s) < energy + 1e-3 * first);
        energy = get_energy(&s);
    }
    se3d_energy last;
    CHECK(se3d_system_get_energy(s.system, &last) == SE3D_OK);
    CHECK(last.kinetic < 1e-6);
    scene_end(&s);
}

/* What acts in an island of many contacts is found at once, not one kink after the other. */
static void a_block_of_boxes_lands_in_few_iterations(void)
{
    const double size[3] = {0.1, 0.1, 0.1}, v[3] = {0.0, 0.0, -2.0}, axis[3] = {0.6, 0.0, 0.8};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5);
    se3d_solver_stats stats;
    scene_floor(&s, 0.0);
    for (int k = 0; k < 125; ++k) {
        const int layer = k / 25, place = k % 25;
        const double r[3] = {0.1001 * (place % 5) + 0.03 * (layer % 2),
                             0.1001 * (place / 5) + 0.02 * (layer % 2), 0.06 + 0.101 * layer};
        const double angle = 0.02 * ((7 * place + 3 * layer) % 5);
        scene_turn(&s, scene_box(&s, size, 0.5, r, v), axis, angle);
    }
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    scene_run(&s, 0.1);
    CHECK(se3d_solver_get_stats(s.solver, &stats) == SE3D_OK);
    CHECK(stats.iterations < 1700); /* 1135; 2402 by the velocities alone */
    scene_end(&s);
}

/* A pendulum that hits a box, which slides: where both are then. */
static void strike(int32_t method, int32_t formulation, double h, double r[2][3])
{
    const double size[3] = {0.1, 0.1, 0.1}, at[3] = {0.12, 0.0, 0.05};
    const double up[3] = {-0.4, 0.0, 0.46};
    double v[3];
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.4, 1e6);
    scene_floor(&s, 0.0);
    se3d_body box = scene_box(&s, size, 0.5, at, scene_zero);
    se3d_body bob = scene_ball(&s, 0.05, 1.0, up, scene_zero);
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint pin;
    const double pivot[3] = {0.0, 0.0, 0.46}, arm[3] = {0.4, 0.0, 0.0};
    def.body_i = scene_ground(&s);
    def.body_j = bob;
    memcpy(def.point_i, pivot, sizeof pivot);
    memcpy(def.point_j, arm, sizeof arm);
    memcpy(def.axis_i, about_y, sizeof about_y);
    memcpy(def.axis_j, about_y, sizeof about_y);
    CHECK(se3d_joint_create_revolute(s.system, &def, &pin) == SE3D_OK);
    scene_solve(&s, method, formulation, h, 0.0);
    scene_run(&s, 0.8);
    get(&s, box, r[0], v);
    get(&s, bob, r[1], v);
    double violation[3];
    CHECK(se3d_system_get_violation(s.system, violation) == SE3D_OK);
    CHECK(violation[0] < 1e-9 && violation[1] < 1e-9);
    scene_end(&s);
}

static void what_joints_hold_touches_as_with_verlet(void)
{
    double exact[2][3], r[2][3];
    strike(SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 1e-5, exact);
    CHECK(exact[0][0] > 0.2);
    for (int32_t f = SE3D_FORMULATION_ROMEGA; f <= SE3D_FORMULATION_JOINT; ++f) {
        strike(SE3D_METHOD_CONVEX, f, STEP, r);
        CHECK(distance(r[0], exact[0]) < 0.05 * (exact[0][0] - 0.12));
        CHECK(distance(r[1], exact[1]) < 0.02);
    }
}

/* The energy of a moving heap and what was dissipated. */
static void the_audit_balances(void)
{
    const double size[3] = {0.1, 0.1, 0.1}, r[3] = {0.0, 0.0, 0.3}, v[3] = {1.0, 0.3, 0.0};
    const double axis[3] = {0.6, 0.0, 0.8};
    double rest[2];
    for (int fine = 0; fine < 2; ++fine) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5);
        se3d_work work;
        scene_floor(&s, 0.0);
        scene_turn(&s, scene_box(&s, size, 0.5, r, v), axis, 0.4);
        const double first = get_energy(&s);
        scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, fine ? STEP / 8.0 : STEP, 0.0);
        scene_run(&s, 1.5);
        CHECK(se3d_system_get_work(s.system, &work) == SE3D_OK);
        CHECK(work.dissipated > 0.5 * first);
        rest[fine] = fabs(get_energy(&s) + work.dissipated - first) / first;
        scene_end(&s);
    }
    CHECK(rest[0] < 1e-9 && rest[1] < 1e-8);
}

/* A ball wedges two boxes apart, which lean on walls: loads do not act along these normals, and
 * still the contacts are no impacts for ever, which have no spring. */
static void what_is_pressed_across_gravity_rests_on_its_spring(void)
{
    const double size[3] = {0.1, 0.1, 0.1}, k = 1e5;
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.1, 0.3, k);
    double r[3] = {0.0, 0.0, 0.17}, force = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        const double at[3] = {0.081 * side, 0.0, 0.05};
        se3d_shape_def wall = scene_shape(&s, scene_ground(&s));
        se3d_shape made;
        (void)scene_box(&s, size, 1.0, at, scene_zero);
        wall.position[0] = 0.1315 * side;
        wall.normal[0] = -side;
        wall.normal[2] = 0.0;
        CHECK(se3d_shape_create_plane(s.system, &wall, &made) == SE3D_OK);
    }
    (void)scene_ball(&s, 0.05, 1.0, r, scene_zero);
    scene_floor(&s, 0.0);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    CHECK(scene_run(&s, 3.0));
    se3d_contact contacts[32];
    const size_t count = se3d_system_count_contacts(s.system);
    CHECK(count >= 12 && count <= 32 &&
          se3d_system_get_contacts(s.system, count, contacts) == SE3D_OK);
    for (size_t c = 0; c < count && count <= 32; ++c) {
        const double *f = contacts[c].force, *n = contacts[c].normal;
        const double normal = f[0] * n[0] + f[1] * n[1] + f[2] * n[2];
        force += fabs(n[0]) > 0.99 ? normal : 0.0;
        CHECK(fabs(normal - k * contacts[c].overlap) < 1e-3);
    }
    CHECK(force > 5.0);
    scene_end(&s);
}

/* A disk that rolls around on its rim may give more in a step than its contacts held. */
static void the_energy_of_a_rolling_disk_stays_a_number(void)
{
    const double J[3] = {1.2506666666666669e-3, 1.2506666666666669e-3, 2.5e-3},
                 r[3] = {0.0, 0.0, 0.031457788644385171};
    const double axis[3] = {0.0, 1.0, 0.0}, w[3] = {-10.799331626024189, 0.0, 0.21598663252048378};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.3, 1e6);
    const se3d_body disk = scene_body(&s, 0.5, J, r, scene_zero);
    se3d_shape_def def = scene_shape(&s, disk);
    se3d_shape made;
    se3d_energy energy;
    def.radius = 0.1;
    def.length = 0.004;
    scene_turn(&s, disk, axis, 0.3);
    CHECK(se3d_body_set_angular_velocity(s.system, disk, w) == SE3D_OK);
    CHECK(se3d_shape_create_cylinder(s.system, &def, &made) == SE3D_OK);
    scene_floor(&s, 0.0);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
    for (int k = 1; k <= 20; ++k) {
        scene_run(&s, 0.02 * k);
        CHECK(se3d_system_get_energy(s.system, &energy) == SE3D_OK && isfinite(energy.total));
    }
    scene_end(&s);
}

/* Euler's disk: the centre of a disk that leans by `tilt` rests while the disk rolls around on its
 * rim, its axis about the vertical at the rate W. Then w = lam d, d from the centre to the point of
 * contact, lam R = -W sin(tilt), and the torque of its weight makes the change W x L of its moment
 * of momentum. */
static double precession(double m, double R, double height, double tilt, double w[3])
{
    const double across = m * (3.0 * R * R + height * height) / 12.0, along = 0.5 * m * R * R;
    const double s = sin(tilt), c = cos(tilt);
    const double rate = -(s / R) * (c * across * R - s * along * 0.5 * height);
    const double W = sqrt(m * G * (0.5 * height * s - R * c) / rate), lam = -W * s / R;
    w[0] = lam * R;
    w[1] = 0.0;
    w[2] = -lam * 0.5 * height;
    return W;
}

/* The angle by which its axis has turned about the vertical in a second, and its tilt. */
static void roll_around(double R, double height, double tilt, double h, double result[3])
{
    enum { LOOKS = 50 };
    const double m = 0.5, k = 1e6;
    double w[3], last = 0.0, p[4];
    const double W = precession(m, R, height, tilt, w);
    const double r[3] = {0.0, 0.0, R * sin(tilt) + 0.5 * height * cos(tilt) - m * G / k};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.3, k);
    scene_floor(&s, 0.0);
    const se3d_body disk = scene_disk(&s, m, R, height, r, tilt, w);
    const double first = get_energy(&s);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, h, 0.0);
    result[0] = -W;
    for (int look = 1; look <= LOOKS && scene_run(&s, (double)look / LOOKS); ++look) {
        CHECK(se3d_body_get_orientation(s.system, disk, p) == SE3D_OK);
        const double x = p[1] * p[3] + p[0] * p[2], y = p[2] * p[3] - p[0] * p[1];
        const double turn = remainder(atan2(y, x) - last, 2.0 * PI);
        result[0] += turn;
        last += turn;
    }
    result[1] = acos(1.0 - 2.0 * (p[1] * p[1] + p[2] * p[2])) - tilt;
    result[2] = get_energy(&s) / first - 1.0;
    scene_end(&s);
}

static void a_disk_rolls_around_on_its_rim_as_fast_as_euler_says(void)
{
    static const double tilt[3] = {0.15, 0.3, 0.6}, height[3] = {0.004, 0.004, 0.02};
    for (int k = 0; k < 3; ++k) {
        double at_2_ms[3], at_1_ms[3];
        roll_around(0.1, height[k], tilt[k], 2e-3, at_2_ms);
        roll_around(0.1, height[k], tilt[k], 1e-3, at_1_ms);
        CHECK(fabs(at_1_ms[0]) < 0.02 && fabs(at_2_ms[0]) < 0.02); /* of 27 to 51 */
        CHECK(fabs(at_1_ms[1]) < 1.5e-3 && fabs(at_1_ms[1]) < 0.7 * fabs(at_2_ms[1]));
        CHECK(fabs(at_1_ms[2]) < 2e-4 && fabs(at_2_ms[2]) < 1.5e-3);
    }
}

/* What joints and springs hold keeps its energy, whether something touches elsewhere or not. */
static double energy_error(int has_spring, int has_contact, double h)
{
    const double start[3] = {has_spring ? 1.1 : 0.0, has_spring ? 0.0 : 0.2 * sin(0.3),
                             has_spring ? 0.0 : 0.2 * cos(0.3)};
    const double J[3] = {0.002, 0.002, 0.003}, spin[3] = {0.0, 0.0, 100.0};
    const double about_x[3] = {1.0, 0.0, 0.0}, far[3] = {5.0, 5.0, 0.05 - 0.5 * G / 1e5};
    double worst = 0.0;
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5);
    const se3d_body body = scene_body(&s, 1.0, J, start, scene_zero);
    if (has_spring) {
        se3d_tsda_def def = se3d_tsda_def_default();
        se3d_force spring;
        def.body_i = scene_ground(&s);
        def.body_j = body;
        def.k = 1e4;
        def.l0 = 1.0;
        CHECK(se3d_force_create_tsda(s.system, &def, &spring) == SE3D_OK);
        CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
    } else {
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint joint;
        def.body_i = scene_ground(&s);
        def.body_j = body;
        def.point_j[2] = -0.2;
        scene_turn(&s, body, about_x, -0.3);
        CHECK(se3d_body_set_angular_velocity(s.system, body, spin) == SE3D_OK);
        CHECK(se3d_joint_create_spherical(s.system, &def, &joint) == SE3D_OK);
    }
    if (has_contact) {
        scene_floor(&s, 0.0);
        (void)scene_ball(&s, 0.05, 0.5, far, scene_zero);
    }
    const double first = get_energy(&s);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, h, 0.0);
    for (int k = 1; k <= 170 && scene_run(&s, 6e-3 * k); ++k) {
        worst = fmax(worst, fabs(get_energy(&s) - first));
    }
    scene_end(&s);
    return worst / (has_spring ? 50.0 : 15.0); /* of the spring; of the spin */
}

/* A top of 100 rad/s on a ball joint; a spring of 100 rad/s, which steps of the first order would
 * make swing 1 / (1 - h w) times as far in each step. */
static void tops_and_springs_keep_their_energy(void)
{
    static const double most[2][2] = {{5e-5, 2e-3}, {4e-3, 6e-2}};
    for (int spring = 0; spring < 2; ++spring) {
        for (int touches = 0; touches < 2; ++touches) {
            const double coarse = energy_error(spring, touches, 2e-3);
            const double fine = energy_error(spring, touches, 1e-3);
            CHECK(fine < most[spring][touches]);
            CHECK(fine < (touches ? 0.7 : 0.3) * coarse);
        }
    }
}

/* In a step of 5 ms a card of 1 mm falls 10 mm, onto a table or another card. */
static void thin_cards_that_fall_fast_land(void)
{
    const double size[3] = {0.09, 0.06, 0.001}, low[3] = {0.0, 0.0, 0.0005};
    const double high[3] = {0.02, 0.01, 0.0605}, fall[3] = {0.3, 0.0, -2.0};
    for (int lies = 0; lies < 2; ++lies) {
        double r[3], v[3];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.1, 1e5);
        const se3d_body card = scene_box(&s, size, 0.01, high, fall);
        scene_floor(&s, 0.0);
        if (lies) {
            scene_box(&s, size, 0.01, low, scene_zero);
        }
        scene_solve(&s, SE3D_METHOD_CONVEX, 0, 5e-3, 0.0);
        if (scene_run(&s, 1.0)) {
            get(&s, card, r, v);
            CHECK_NEAR(r[2], lies ? 0.0015 : 0.0005, 2e-6);
            CHECK_NEAR(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 0.0, 1e-8);
        }
        scene_end(&s);
    }
}

/* Logs between walls, three, two and one, not quite parallel: they come to rest. The normal of two
 * of them has no end to alternate between, and what touches does not wander from end to end. */
static void a_pile_of_logs_comes_to_rest(void)
{
    enum { ROWS = 3, LOGS = ROWS * (ROWS + 1) / 2 };
    const double R = 0.05, half = 0.5 * PI, J[3] = {0.0214, 0.0214, 0.00125};
    for (int is_capsule = 0; is_capsule < 2; ++is_capsule) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
        se3d_body logs[LOGS];
        se3d_energy energy;
        se3d_shape made;
        double r[3], v[3], before[3];
        scene_floor(&s, 0.0);
        for (int side = -1; side <= 1; side += 2) {
            const double size[3] = {0.05, 1.0, 0.4};
            se3d_shape_def wall = scene_shape(&s, scene_ground(&s));
            memcpy(wall.size, size, sizeof size);
            wall.position[0] = side * (ROWS * R + 0.027);
            wall.position[2] = 0.2;
            CHECK(se3d_shape_create_box(s.system, &wall, &made) == SE3D_OK);
        }
        for (int k = 0, row = 0; row < ROWS; ++row) {
            for (int c = 0; c < ROWS - row; ++c, ++k) {
                const double yaw = 0.002 * (k * 7 % 5 - 2), axis[3] = {cos(yaw), sin(yaw), 0.0};
                const double at[3] = {(2 * c - (ROWS - row - 1)) * R, 0.003 * (k * 3 % 5 - 2),
                                      R + row * (1.7320508 * R + 0.002) + 0.001};
                logs[k] = scene_body(&s, 1.0, J, at, scene_zero);
                scene_turn(&s, logs[k], axis, half);
                se3d_shape_def def = scene_shape(&s, logs[k]);
                def.radius = R;
                def.length = 0.5;
                CHECK((is_capsule ? se3d_shape_create_capsule(s.system, &def, &made)
                                  : se3d_shape_create_cylinder(s.system, &def, &made)) == SE3D_OK);
            }
        }
        scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, STEP, 0.0);
        scene_run(&s, 1.5);
        get(&s, logs[LOGS - 1], before, v);
        scene_run(&s, 1.8);
        get(&s, logs[LOGS - 1], r, v);
        CHECK(se3d_system_get_energy(s.system, &energy) == SE3D_OK);
        CHECK_NEAR(energy.kinetic, 0.0, 1e-9);
        for (int k = 0; k < 3; ++k) {
            CHECK_NEAR(r[k], before[k], 1e-7);
        }
        scene_end(&s);
    }
}

int main(void)
{
    RUN(a_box_rests_as_deep_as_its_springs_say);
    RUN(cylinders_and_hulls_come_to_rest_on_meshes);
    RUN(a_ball_rests_as_deep_as_hertz_says);
    RUN(a_box_on_a_slope_slips_at_the_angle_of_friction);
    RUN(short_impacts_have_the_restitution_typed);
    RUN(impacts_have_the_restitution_typed);
    RUN(what_lasts_a_dozen_steps_is_followed);
    RUN(sliding_impacts_take_mu_times_the_normal_impulse);
    RUN(a_stack_of_ten_stands_without_creep);
    RUN(a_pyramid_stands_without_creep);
    RUN(a_pile_of_logs_comes_to_rest);
    RUN(twenty_dominoes_fall);
    RUN(many_bodies_are_stepped_by_convex);
    RUN(bodies_far_apart_are_no_crowd);
    RUN(clones_meet_a_crowd_at_the_same_step);
    RUN(auto_knows_the_limits_of_convex);
    RUN(auto_leaves_machines_that_touch_for_convex);
    RUN(what_fails_names_convex);
    RUN(a_heap_of_27_boxes_settles);
    RUN(a_block_of_boxes_lands_in_few_iterations);
    RUN(what_joints_hold_touches_as_with_verlet);
    RUN(the_audit_balances);
    RUN(what_is_pressed_across_gravity_rests_on_its_spring);
    RUN(the_energy_of_a_rolling_disk_stays_a_number);
    RUN(a_disk_rolls_around_on_its_rim_as_fast_as_euler_says);
    RUN(tops_and_springs_keep_their_energy);
    RUN(thin_cards_that_fall_fast_land);
    return check_finish();
}
