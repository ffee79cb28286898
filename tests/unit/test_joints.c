/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints, couplers, drivers and primitives: coordinates that count turns, frames, lookups, life
 * time, misuse. */
#include "property/test_joint_world.h"

#define PI 3.1415926535897932384626433832795

static const double Z[3] = {0.0, 0.0, 1.0}, ORIGIN[3] = {0.0, 0.0, 0.0};

static double angle_of(const world *w, se3d_constraint joint)
{
    double value;
    CHECK(se3d_joint_get_coordinate(w->system, joint, SE3D_JOINT_COORDINATE_ANGLE, &value, NULL,
                                    NULL) == SE3D_OK);
    return value;
}

static double phi_of(const world *w, se3d_constraint constraint)
{
    double phi[8];
    CHECK(se3d_constraint_eval(w->system, constraint, SE3D_FORMULATION_ROMEGA, phi, NULL, NULL) ==
          SE3D_OK);
    return phi[0];
}

/* A revolute or other joint between the ground and a body about z through the origin. */
static se3d_constraint joint_about_z(world *w, joint_create create, se3d_body body, double angle0)
{
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint joint;
    def.body_i = w->ground;
    def.body_j = body;
    def.angle0 = angle0;
    def.pitch = 0.25;
    CHECK(se3d_joint_def_set_frame(w->system, &def, ORIGIN, Z, NULL) == SE3D_OK);
    CHECK(create(w->system, &def, &joint) == SE3D_OK);
    return joint;
}

static void angles_count_turns_in_both_directions(void)
{
    world w;
    world_init(&w, 1);
    se3d_constraint pin = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], 0.5);
    for (int k = 1; k <= 25; ++k) {
        world_move(&w, w.body[0], Z, ORIGIN, 1.0, 0.0);
        CHECK_NEAR(angle_of(&w, pin), 0.5 + k, 1e-13);
    }
    for (int k = 1; k <= 60; ++k) {
        world_move(&w, w.body[0], Z, ORIGIN, -1.0, 0.0);
        CHECK_NEAR(angle_of(&w, pin), 25.5 - k, 1e-13);
    }
    world_destroy(&w);
}

static void angle_starts_at_angle0_whatever_its_turn(void)
{
    const double starts[5] = {0.0, PI, -PI, 7.5 * PI, -100.0};
    for (int k = 0; k < 5; ++k) {
        world w;
        world_init(&w, 2);
        se3d_constraint pin = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], starts[k]);
        CHECK_NEAR(angle_of(&w, pin), starts[k], 1e-13);
        world_destroy(&w);
    }
}

/* With both directions given, the angle is angle0 where they coincide, nearest to angle0. */
static void given_references_define_the_angle(void)
{
    world w;
    world_init(&w, 3);
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint pin;
    const double identity[4] = {1.0, 0.0, 0.0, 0.0};
    CHECK(se3d_body_set_orientation(w.system, w.body[0], identity) == SE3D_OK);
    def.body_i = w.ground;
    def.body_j = w.body[0];
    def.ref_i[0] = 2.0;
    def.ref_i[2] = 5.0; /* only the part across the axis counts */
    def.ref_j[1] = 3.0;
    CHECK(se3d_joint_create_revolute(w.system, &def, &pin) == SE3D_OK);
    CHECK_NEAR(angle_of(&w, pin), PI / 2, 1e-15);
    def.angle0 = 4 * PI + 0.1;
    CHECK(se3d_joint_create_revolute(w.system, &def, &pin) == SE3D_OK);
    CHECK_NEAR(angle_of(&w, pin), 4.5 * PI + 0.1, 1e-14);
    def.axis_i[2] = -1.0; /* about the opposite axis */
    def.axis_j[2] = -1.0;
    def.angle0 = 0.0;
    CHECK(se3d_joint_create_revolute(w.system, &def, &pin) == SE3D_OK);
    CHECK_NEAR(angle_of(&w, pin), -PI / 2, 1e-15);
    def = se3d_joint_def_default(); /* about x, measured from z */
    def.body_i = w.ground;
    def.body_j = w.body[0];
    def.axis_i[0] = def.axis_j[0] = def.ref_i[2] = def.ref_j[2] = 1.0;
    def.axis_i[2] = def.axis_j[2] = 0.0;
    def.angle0 = 2 * PI;
    CHECK(se3d_joint_create_revolute(w.system, &def, &pin) == SE3D_OK);
    CHECK_NEAR(angle_of(&w, pin), 2 * PI, 1e-15);
    world_destroy(&w);
}

/* A reference chosen by the library gives angle0 exactly, also if the axes are not aligned. */
static void chosen_reference_gives_angle0_at_a_rough_pose(void)
{
    for (uint64_t trial = 0; trial < 40; ++trial) {
        world w;
        world_init(&w, 50 + trial);
        se3d_joint_def def = se3d_joint_def_default();
        se3d_constraint pin;
        def.body_i = w.body[0];
        def.body_j = w.body[1];
        def.angle0 = 0.9;
        world_random_unit(&w, def.axis_i, 3);
        world_random_unit(&w, def.axis_j, 3);
        double a_i[3], a_j[3];
        se3di_mul(world_frame(&w, w.body[0])->A, def.axis_i, a_i);
        se3di_mul(world_frame(&w, w.body[1])->A, def.axis_j, a_j);
        CHECK(se3d_joint_create_revolute(w.system, &def, &pin) == SE3D_OK);
        if (fabs(se3di_dot(a_i, a_j)) > 0.11) {
            CHECK_NEAR(angle_of(&w, pin), 0.9, 1e-13);
        }
        world_destroy(&w);
    }
}

static void screw_advances_by_its_pitch_over_many_turns(void)
{
    world w;
    world_init(&w, 4);
    se3d_constraint screw = joint_about_z(&w, se3d_joint_create_screw, w.body[0], 0.0);
    double displacement, phi[5];
    for (int k = 0; k < 30; ++k) {
        world_move(&w, w.body[0], Z, ORIGIN, PI / 2, 0.25 / 4);
    }
    CHECK(se3d_joint_get_coordinate(w.system, screw, SE3D_JOINT_COORDINATE_DISPLACEMENT,
                                    &displacement, NULL, NULL) == SE3D_OK);
    CHECK_NEAR(displacement, 7.5 * 0.25, 1e-13);
    CHECK_NEAR(angle_of(&w, screw), 15 * PI, 1e-12);
    CHECK(se3d_constraint_eval(w.system, screw, SE3D_FORMULATION_RP, phi, NULL, NULL) == SE3D_OK);
    CHECK_NEAR(phi[4], 0.0, 1e-13);
    world_move(&w, w.body[0], Z, ORIGIN, 0.0, 0.1);
    CHECK(se3d_constraint_eval(w.system, screw, SE3D_FORMULATION_RP, phi, NULL, NULL) == SE3D_OK);
    CHECK_NEAR(phi[4], 0.1, 1e-13);
    world_destroy(&w);
}

static void gears_racks_and_couplers_hold_over_many_turns(void)
{
    world w;
    world_init(&w, 6);
    se3d_constraint a = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], 0.3);
    se3d_constraint b = joint_about_z(&w, se3d_joint_create_revolute, w.body[1], -2.0);
    se3d_constraint c = joint_about_z(&w, se3d_joint_create_prismatic, w.body[2], 0.0);
    se3d_constraint gear, rack, coupler;
    se3d_coupler_def def = se3d_coupler_def_default();
    def.joint[0] = a;
    def.joint[1] = b;
    def.ratio[0] = 2.0;
    def.ratio[1] = 1.0;
    def.count = 2;
    def.value = -1.0; /* 2 * 0.3 - 2.0 = -1.4 */
    CHECK(se3d_joint_create_gear(w.system, "gear", a, b, 2.0, &gear) == SE3D_OK);
    CHECK(se3d_joint_create_rack_pinion(w.system, "rack", a, c, 0.05, &rack) == SE3D_OK);
    CHECK(se3d_joint_create_coupler(w.system, &def, &coupler) == SE3D_OK);
    CHECK_NEAR(phi_of(&w, gear), 0.0, 1e-15);
    CHECK_NEAR(phi_of(&w, rack), 0.0, 1e-15);
    CHECK_NEAR(phi_of(&w, coupler), -0.4, 1e-14);
    for (int k = 0; k < 20; ++k) {
        world_move(&w, w.body[0], Z, ORIGIN, 0.8, 0.0);
        world_move(&w, w.body[1], Z, ORIGIN, -1.6, 0.0);
        world_move(&w, w.body[2], Z, ORIGIN, 0.0, 0.05 * 0.8);
    }
    CHECK_NEAR(angle_of(&w, b), -2.0 - 32.0, 1e-12);
    CHECK_NEAR(phi_of(&w, gear), 0.0, 1e-12);
    CHECK_NEAR(phi_of(&w, rack), 0.0, 1e-13);
    CHECK_NEAR(phi_of(&w, coupler), -0.4, 1e-12);
    world_move(&w, w.body[1], Z, ORIGIN, 0.25, 0.0);
    CHECK_NEAR(phi_of(&w, gear), 0.25, 1e-12);
    world_destroy(&w);
}

/* The driver's equation lies in (-pi, pi] whatever the turn of f and of the angle. */
static void angle_drivers_do_not_mind_turns(void)
{
    world w;
    world_init(&w, 7);
    se3d_constraint pin = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], 0.3);
    se3d_constraint driver;
    se3d_driver_def def = se3d_driver_def_default();
    def.joint = pin;
    for (int turns = -3; turns <= 3; ++turns) {
        def.value = 0.1 + 2 * PI * turns;
        CHECK(se3d_driver_create(w.system, &def, &driver) == SE3D_OK);
        CHECK_NEAR(phi_of(&w, driver), 0.2, 1e-14);
        def.value = 0.3 + PI + 2 * PI * turns;
        CHECK(se3d_driver_create(w.system, &def, &driver) == SE3D_OK);
        CHECK_NEAR(fabs(phi_of(&w, driver)), PI, 1e-14);
    }
    double value;
    CHECK(se3d_driver_get_value(w.system, driver, &value) == SE3D_OK);
    CHECK_NEAR(value, 0.3 + 7 * PI, 1e-14);
    world_destroy(&w);
}

static void constraints_are_found_by_name_and_counted(void)
{
    world w;
    world_init(&w, 9);
    se3d_joint_def def = se3d_joint_def_default();
    se3d_constraint named, unnamed, found;
    const char *text;
    se3d_body body;
    size_t count;
    def.body_i = w.body[0];
    def.body_j = w.body[1];
    CHECK(se3d_joint_create_spherical(w.system, &def, &unnamed) == SE3D_OK);
    def.name = "ball";
    CHECK(se3d_joint_create_spherical(w.system, &def, &named) == SE3D_OK);
    CHECK(se3d_constraint_find(w.system, "ball", &found) == SE3D_OK);
    CHECK(memcmp(&found, &named, sizeof found) == 0);
    CHECK(se3d_constraint_find(w.system, "bal", &found) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(found.index1 == 0 && found.generation == 0);
    CHECK(se3d_constraint_get_name(w.system, named, &text) == SE3D_OK && strcmp(text, "ball") == 0);
    CHECK(se3d_constraint_get_name(w.system, unnamed, &text) == SE3D_OK && strcmp(text, "") == 0);
    CHECK(se3d_constraint_count_bodies(w.system, named, &count) == SE3D_OK && count == 2);
    CHECK(se3d_constraint_get_body(w.system, named, 0, &body) == SE3D_OK);
    CHECK(memcmp(&body, &w.body[0], sizeof body) == 0);
    CHECK(se3d_constraint_get_body(w.system, named, 1, &body) == SE3D_OK);
    CHECK(memcmp(&body, &w.body[1], sizeof body) == 0);
    CHECK(se3d_constraint_get_body(w.system, named, 2, &body) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_constraint_get_equation_name(w.system, named, 3, &text) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(text == NULL);
    /* the name is taken, also for other kinds of constraints */
    CHECK(se3d_joint_create_fixed(w.system, &def, &found) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "ball");
    CHECK(found.index1 == 0);
    CHECK(se3d_system_count_constraints(w.system) == 2);
    world_destroy(&w);
}

static void what_is_in_use_cannot_be_destroyed(void)
{
    world w;
    world_init(&w, 10);
    se3d_constraint a = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], 0.0);
    se3d_constraint b = joint_about_z(&w, se3d_joint_create_revolute, w.body[1], 0.0);
    se3d_constraint gear, driver;
    se3d_driver_def def = se3d_driver_def_default();
    def.joint = a;
    CHECK(se3d_function_create_expression(w.system, "t", &def.function) == SE3D_OK);
    CHECK(se3d_joint_create_gear(w.system, NULL, a, b, 1.0, &gear) == SE3D_OK);
    CHECK(se3d_driver_create(w.system, &def, &driver) == SE3D_OK);
    CHECK(se3d_constraint_destroy(w.system, a) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "revolute");
    CHECK(se3d_function_destroy(w.system, def.function) == SE3D_ERR_IN_USE);
    CHECK(se3d_body_destroy(w.system, w.body[0]) == SE3D_ERR_IN_USE);
    CHECK(se3d_constraint_destroy(w.system, driver) == SE3D_OK);
    CHECK(se3d_constraint_destroy(w.system, driver) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_constraint_destroy(w.system, a) == SE3D_ERR_IN_USE);
    CHECK(se3d_constraint_destroy(w.system, gear) == SE3D_OK);
    CHECK(se3d_constraint_destroy(w.system, a) == SE3D_OK);
    CHECK_NEAR(angle_of(&w, b), 0.0, 1e-15); /* its turn counter moved down */
    world_move(&w, w.body[1], Z, ORIGIN, 0.7, 0.0);
    CHECK_NEAR(angle_of(&w, b), 0.7, 1e-14);
    CHECK(se3d_body_destroy(w.system, w.body[0]) == SE3D_OK);
    CHECK(se3d_function_destroy(w.system, def.function) == SE3D_OK);
    CHECK_NEAR(angle_of(&w, b), 0.7, 1e-14);
    CHECK(se3d_constraint_destroy(w.system, b) == SE3D_OK);
    CHECK(se3d_system_count_constraints(w.system) == 0);
    world_destroy(&w);
}

/* Call with a def and expect a status and a part of the message; nothing may be created. */
static void rejects(world *w, joint_create create, const se3d_joint_def *def, se3d_status status,
                    const char *part)
{
    se3d_constraint joint = {7, 7};
    size_t count = se3d_system_count_constraints(w->system);
    CHECK(create(w->system, def, &joint) == status);
    CHECK_CONTAINS(se3d_system_get_error(w->system), part);
    CHECK(joint.index1 == 0 && joint.generation == 0);
    CHECK(se3d_system_count_constraints(w->system) == count);
}

static void joints_reject_what_makes_no_sense(void)
{
    const se3d_status invalid = SE3D_ERR_INVALID_ARGUMENT;
    world w, other;
    world_init(&w, 11);
    world_init(&other, 12);
    for (size_t k = 0; k < JOINT_CASES; ++k) {
        const joint_create create = joint_cases[k].create;
        se3d_joint_def good, def;
        se3d_constraint joint;
        world_joint_def(&w, &joint_cases[k], w.body[0], w.body[1], &good);
        good.name = NULL;
        CHECK(create(w.system, &good, &joint) == SE3D_OK);
        CHECK(create(NULL, &good, &joint) == SE3D_ERR_NULL);
        CHECK(create(w.system, &good, NULL) == SE3D_ERR_NULL);
        rejects(&w, create, NULL, SE3D_ERR_NULL, "def");
        def = good;
        def.struct_size = 0;
        rejects(&w, create, &def, invalid, "struct_size");
        def = good;
        def.body_j = def.body_i;
        rejects(&w, create, &def, invalid, "same body");
        def = good;
        def.body_j = (se3d_body){0, 0};
        rejects(&w, create, &def, SE3D_ERR_STALE_HANDLE, "body_j");
        def = good;
        def.body_i = other.body[0];
        rejects(&w, create, &def, SE3D_ERR_STALE_HANDLE, "body_i");
        def = good;
        memset(def.axis_i, 0, sizeof def.axis_i);
        rejects(&w, create, &def, invalid, "axis_i");
        def = good;
        memset(def.axis_j, 0, sizeof def.axis_j);
        rejects(&w, create, &def, invalid, "axis_j");
        def = good;
        se3di_scale(-3.0, def.axis_i, def.ref_i);
        rejects(&w, create, &def, invalid, "ref_i");
        def = good;
        se3di_scale(2.0, def.axis_j, def.ref_j);
        rejects(&w, create, &def, invalid, "ref_j");
        def = good;
        def.point_i[1] = (double)NAN;
        rejects(&w, create, &def, invalid, "point_i[1]");
        def = good;
        def.point_j[2] = (double)INFINITY;
        rejects(&w, create, &def, invalid, "point_j[2]");
        def = good;
        def.axis_i[0] = (double)NAN;
        rejects(&w, create, &def, invalid, "axis_i[0]");
        def = good;
        def.angle0 = (double)NAN;
        rejects(&w, create, &def, invalid, "angle0");
        def = good;
        def.name = "a.b";
        rejects(&w, create, &def, invalid, "a.b");
    }
    world_destroy(&other);
    world_destroy(&w);
}

static void parameters_of_joints_are_checked(void)
{
    const se3d_status invalid = SE3D_ERR_INVALID_ARGUMENT;
    world w;
    world_init(&w, 13);
    se3d_joint_def def = se3d_joint_def_default();
    def.body_i = w.body[0];
    def.body_j = w.body[1];
    rejects(&w, se3d_joint_create_screw, &def, invalid, "pitch = 0");
    def.pitch = (double)INFINITY;
    rejects(&w, se3d_joint_create_screw, &def, invalid, "pitch");
    def.pitch = 0.0;
    def.distance = -1.0;
    rejects(&w, se3d_joint_create_distance, &def, invalid, "distance = -1 m");
    rejects(&w, se3d_joint_create_revolute_spherical, &def, invalid, "distance = -1 m");
    rejects(&w, se3d_joint_create_revolute_cylindrical, &def, invalid, "distance = -1 m");
    def.distance = (double)NAN;
    rejects(&w, se3d_joint_create_distance, &def, invalid, "distance");
    world_destroy(&w);
}

static void set_frame_rejects_bad_frames(void)
{
    world w, other;
    world_init(&w, 14);
    world_init(&other, 15);
    se3d_joint_def def = se3d_joint_def_default();
    const double nan3[3] = {0.0, (double)NAN, 0.0};
    def.body_i = w.body[0];
    def.body_j = w.body[1];
    const se3d_joint_def before = def;
    CHECK(se3d_joint_def_set_frame(NULL, &def, ORIGIN, Z, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(w.system, NULL, ORIGIN, Z, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(w.system, &def, NULL, Z, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(w.system, &def, ORIGIN, NULL, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_joint_def_set_frame(w.system, &def, nan3, Z, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_def_set_frame(w.system, &def, ORIGIN, ORIGIN, NULL) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_def_set_frame(w.system, &def, ORIGIN, Z, Z) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_def_set_frame(w.system, &def, ORIGIN, Z, nan3) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_def_set_frame(other.system, &def, ORIGIN, Z, NULL) == SE3D_ERR_STALE_HANDLE);
    CHECK(memcmp(&def, &before, sizeof def) == 0);
    world_destroy(&other);
    world_destroy(&w);
}

static void drivers_need_a_coordinate_of_a_live_joint(void)
{
    world w, other;
    world_init(&w, 16);
    world_init(&other, 17);
    se3d_constraint pin = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], 0.0);
    se3d_constraint ball = joint_about_z(&w, se3d_joint_create_spherical, w.body[1], 0.0);
    se3d_constraint slide = joint_about_z(&w, se3d_joint_create_prismatic, w.body[2], 0.0);
    se3d_constraint foreign = joint_about_z(&other, se3d_joint_create_revolute, other.body[0], 0.0);
    const se3d_constraint null = {0, 0};
    const struct {
        se3d_constraint joint;
        int32_t coordinate;
        double value;
        se3d_status status;
        const char *part;
    } bad[] = {
        {ball, SE3D_JOINT_COORDINATE_ANGLE, 0, SE3D_ERR_INVALID_ARGUMENT, "spherical"},
        {ball, SE3D_JOINT_COORDINATE_DISPLACEMENT, 0, SE3D_ERR_INVALID_ARGUMENT, "no displacement"},
        {pin, SE3D_JOINT_COORDINATE_DISPLACEMENT, 0, SE3D_ERR_INVALID_ARGUMENT,
         "has no displacement, must be SE3D_JOINT_COORDINATE_ANGLE"},
        {slide, SE3D_JOINT_COORDINATE_ANGLE, 0, SE3D_ERR_INVALID_ARGUMENT,
         "must be SE3D_JOINT_COORDINATE_DISPLACEMENT"},
        {pin, 2, 0, SE3D_ERR_INVALID_ARGUMENT, "coordinate = 2"},
        {pin, -1, 0, SE3D_ERR_INVALID_ARGUMENT, "coordinate = -1"},
        {pin, SE3D_JOINT_COORDINATE_ANGLE, (double)NAN, SE3D_ERR_INVALID_ARGUMENT, "value"},
        {null, SE3D_JOINT_COORDINATE_ANGLE, 0, SE3D_ERR_STALE_HANDLE, "joint"},
        {foreign, SE3D_JOINT_COORDINATE_ANGLE, 0, SE3D_ERR_STALE_HANDLE, "joint"},
    };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; ++k) {
        se3d_driver_def def = se3d_driver_def_default();
        se3d_coupler_def couple = se3d_coupler_def_default();
        se3d_constraint out = {7, 7};
        def.joint = couple.joint[0] = bad[k].joint;
        def.coordinate = couple.coordinate[0] = bad[k].coordinate;
        def.value = couple.value = bad[k].value;
        couple.count = 1;
        couple.ratio[0] = 1.0;
        CHECK(se3d_driver_create(w.system, &def, &out) == bad[k].status);
        CHECK_CONTAINS(se3d_system_get_error(w.system), bad[k].part);
        CHECK(out.index1 == 0);
        out.index1 = 7;
        CHECK(se3d_joint_create_coupler(w.system, &couple, &out) == bad[k].status);
        CHECK(out.index1 == 0);
        CHECK(se3d_system_count_constraints(w.system) == 3);
    }
    double value = 1.0;
    CHECK(se3d_driver_get_value(w.system, pin, &value) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_driver_get_effort(w.system, pin, &value) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_driver_get_effort(w.system, foreign, &value) == SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_driver_get_effort(w.system, pin, NULL) == SE3D_ERR_NULL);
    CHECK(value == 0.0);
    world_destroy(&other);
    world_destroy(&w);
}

static void couplers_check_their_terms(void)
{
    world w;
    world_init(&w, 18);
    se3d_constraint pin = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], 0.0);
    se3d_constraint out;
    se3d_coupler_def def = se3d_coupler_def_default();
    def.joint[0] = pin;
    def.ratio[0] = 1.0;
    CHECK(se3d_joint_create_coupler(w.system, &def, &out) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "count = 0");
    def.count = SE3D_COUPLER_TERMS_MAX + 1;
    CHECK(se3d_joint_create_coupler(w.system, &def, &out) == SE3D_ERR_INVALID_ARGUMENT);
    def.count = 1;
    def.ratio[0] = 0.0;
    CHECK(se3d_joint_create_coupler(w.system, &def, &out) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "ratio[0]");
    CHECK(se3d_joint_create_gear(w.system, NULL, pin, pin, 0.0, &out) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_create_gear(w.system, NULL, pin, pin, (double)NAN, &out) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_joint_create_rack_pinion(w.system, NULL, pin, pin, 1.0, &out) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK_CONTAINS(se3d_system_get_error(w.system), "coordinate[1]");
    CHECK(se3d_system_count_constraints(w.system) == 1);
    world_destroy(&w);
}

static void primitives_check_what_they_use(void)
{
    world w;
    world_init(&w, 19);
    for (int32_t type = 0; type < 4; ++type) {
        static const char *const missing[4] = {"a_j", "a_i", "value", "c ="};
        se3d_primitive_def def = se3d_primitive_def_default();
        se3d_constraint out;
        def.type = type;
        def.body_i = w.body[0];
        def.body_j = w.body[1];
        def.a_i[0] = type == SE3D_PRIMITIVE_DP1 ? 1.0 : 0.0;
        CHECK(se3d_primitive_create(w.system, &def, &out) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(w.system), missing[type]);
        def.a_i[0] = def.a_j[0] = def.c[0] = def.value = 1.0;
        CHECK(se3d_primitive_create(w.system, &def, &out) == SE3D_OK);
        def.body_j = def.body_i;
        CHECK(se3d_primitive_create(w.system, &def, &out) == SE3D_ERR_INVALID_ARGUMENT);
        def.body_j = w.ground;
        def.type = 4 + type;
        CHECK(se3d_primitive_create(w.system, &def, &out) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(w.system), "type");
        def.type = type;
        def.value = (double)NAN;
        CHECK(se3d_primitive_create(w.system, &def, &out) == SE3D_ERR_INVALID_ARGUMENT);
        CHECK_CONTAINS(se3d_system_get_error(w.system), "value");
    }
    world_destroy(&w);
}

/* Getters on a stale handle: the status, and outputs that are zero. */
static void queries_detect_stale_handles_and_null(void)
{
    world w;
    world_init(&w, 20);
    se3d_constraint pin = joint_about_z(&w, se3d_joint_create_revolute, w.body[0], 0.0);
    const se3d_marker ground_frame = {0, 0}, no_marker = {9, 9};
    double v[6] = {1, 1, 1, 1, 1, 1};
    size_t count = 5;
    const char *text = "x";
    se3d_body body = {5, 5};
    CHECK(se3d_constraint_get_reaction_at(w.system, pin, 2, ORIGIN, ground_frame, v) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_constraint_get_reaction_at(w.system, pin, 1, NULL, ground_frame, v) ==
          SE3D_ERR_NULL);
    CHECK(se3d_constraint_get_reaction_at(w.system, pin, 1, ORIGIN, no_marker, v) ==
          SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_constraint_eval(w.system, pin, (se3d_formulation)2, v, NULL, NULL) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_constraint_eval_jacobian(w.system, pin, SE3D_FORMULATION_RP, 2, NULL, NULL) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_constraint_destroy(w.system, pin) == SE3D_OK);
    const se3d_status stale = SE3D_ERR_STALE_HANDLE;
    v[0] = v[5] = 1.0;
    CHECK(se3d_constraint_get_reaction(w.system, pin, v, v + 3) == stale && v[0] == 0 && v[5] == 0);
    v[0] = 1.0;
    CHECK(se3d_constraint_get_reaction_at(w.system, pin, 1, ORIGIN, ground_frame, v) == stale);
    CHECK(v[0] == 0.0);
    CHECK(se3d_constraint_count_equations(w.system, pin, &count) == stale && count == 0);
    count = 5;
    CHECK(se3d_constraint_count_bodies(w.system, pin, &count) == stale && count == 0);
    CHECK(se3d_constraint_get_type(w.system, pin, &text) == stale && text == NULL);
    text = "x";
    CHECK(se3d_constraint_get_name(w.system, pin, &text) == stale && text == NULL);
    CHECK(se3d_constraint_get_body(w.system, pin, 0, &body) == stale && body.index1 == 0);
    CHECK(se3d_constraint_eval(w.system, pin, SE3D_FORMULATION_RP, v, v, v) == stale);
    CHECK(se3d_constraint_get_multipliers(w.system, pin, v) == stale);
    CHECK(se3d_joint_get_coordinate(w.system, pin, SE3D_JOINT_COORDINATE_ANGLE, v, v, v) == stale);
    CHECK(se3d_constraint_get_multipliers(w.system, pin, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_constraint_eval(NULL, pin, SE3D_FORMULATION_RP, v, v, v) == SE3D_ERR_NULL);
    CHECK(se3d_constraint_destroy(NULL, pin) == SE3D_ERR_NULL);
    CHECK(se3d_constraint_find(w.system, NULL, &pin) == SE3D_ERR_NULL);
    world_destroy(&w);
}

int main(void)
{
    RUN(angles_count_turns_in_both_directions);
    RUN(angle_starts_at_angle0_whatever_its_turn);
    RUN(given_references_define_the_angle);
    RUN(chosen_reference_gives_angle0_at_a_rough_pose);
    RUN(screw_advances_by_its_pitch_over_many_turns);
    RUN(gears_racks_and_couplers_hold_over_many_turns);
    RUN(angle_drivers_do_not_mind_turns);
    RUN(constraints_are_found_by_name_and_counted);
    RUN(what_is_in_use_cannot_be_destroyed);
    RUN(joints_reject_what_makes_no_sense);
    RUN(parameters_of_joints_are_checked);
    RUN(set_frame_rejects_bad_frames);
    RUN(drivers_need_a_coordinate_of_a_live_joint);
    RUN(couplers_check_their_terms);
    RUN(primitives_check_what_they_use);
    RUN(queries_detect_stale_handles_and_null);
    return check_finish();
}
