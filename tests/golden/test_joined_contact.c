/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that are hinged to the ground touch it, but not at the hinge itself. */
#include "support/scene.h"

#define LENGTH 0.5
#define RADIUS 0.02

/* A rod that hangs on a pin at the height `height`, standing nearly upright. */
static se3d_body arm(scene *s, double height, int weld)
{
    const double J[3] = {0.02, 0.02, 1e-4};
    const double r[3] = {0.0, 0.0, height + 0.5 * LENGTH};
    const double y[3] = {0.0, 1.0, 0.0};
    se3d_body body = scene_body(s, 1.0, J, r, scene_zero);
    se3d_shape_def def = scene_shape(s, body);
    se3d_joint_def pin = se3d_joint_def_default();
    se3d_shape shape;
    se3d_constraint joint;
    def.radius = RADIUS;
    def.length = LENGTH;
    CHECK(se3d_shape_create_capsule(s->system, &def, &shape) == SE3D_OK);
    pin.body_i = scene_ground(s);
    pin.body_j = body;
    pin.point_i[2] = height;
    pin.point_j[2] = -0.5 * LENGTH;
    memcpy(pin.axis_i, y, sizeof y);
    memcpy(pin.axis_j, y, sizeof y);
    CHECK((weld ? se3d_joint_create_fixed : se3d_joint_create_revolute)(s->system, &pin, &joint) ==
          SE3D_OK);
    return body;
}

static void push(scene *s, se3d_body body)
{
    const double w[3] = {0.0, 0.5, 0.0}, v[3] = {0.25 * LENGTH, 0.0, 0.0};
    CHECK(se3d_body_set_angular_velocity(s->system, body, w) == SE3D_OK);
    CHECK(se3d_body_set_velocity(s->system, body, v) == SE3D_OK);
}

static void an_arm_falls_on_the_floor(void)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.0, 0.2, 1e5);
    double r[3], force[3], torque[3];
    se3d_body body = arm(&s, 0.1, 0);
    scene_floor(&s, 0.0);
    push(&s, body);
    scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    if (scene_run(&s, 3.0)) {
        const double lean = asin((0.1 - RADIUS) / LENGTH); /* its end on the floor */
        CHECK(se3d_body_get_position(s.system, body, r) == SE3D_OK);
        CHECK(se3d_body_get_contact_wrench(s.system, body, force, torque) == SE3D_OK);
        CHECK_NEAR(r[2], 0.1 - 0.5 * LENGTH * sin(lean), 1e-4);
        CHECK_NEAR(force[2] * cos(lean) * LENGTH, G * 0.5 * LENGTH * cos(lean), 0.02);
    }
    scene_end(&s);
}

/* A post that holds the pin, and a floor below the pin by less than the rod is thick. */
static void a_pin_does_not_touch_its_post(void)
{
    for (int floor = 0; floor < 2; ++floor) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
        const double post[3] = {0.03, 0.2, 0.3}, at[3] = {0.0, 0.0, 0.2};
        const double height = floor ? 0.5 * RADIUS : 0.3;
        double r[3];
        se3d_body body = arm(&s, height, 0);
        if (floor) {
            scene_floor(&s, 0.0);
        } else {
            scene_box_on(&s, scene_ground(&s), post, at);
        }
        push(&s, body);
        scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
        double lowest = HUGE_VAL;
        for (int k = 1; k <= 60 && scene_run(&s, 0.05 * k); ++k) {
            CHECK(se3d_body_get_position(s.system, body, r) == SE3D_OK);
            CHECK(se3d_system_count_contacts(s.system) == 0);
            lowest = fmin(lowest, r[2]);
        }
        CHECK(lowest < height - 0.4 * LENGTH); /* through it, all the way round */
        scene_end(&s);
    }
}

static void what_is_welded_to_the_ground_does_not_touch_it(void)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
    double force[3], torque[3];
    se3d_body body = arm(&s, 0.5 * RADIUS, 1);
    scene_floor(&s, 0.0);
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    scene_run(&s, 0.1);
    CHECK(se3d_body_get_contact_wrench(s.system, body, force, torque) == SE3D_OK);
    CHECK(se3d_system_count_contacts(s.system) == 0);
    scene_end(&s);
}

/* Down a rail that goes through it, onto the floor; groups keep it from that. */
static void a_lift_lands_on_the_floor(void)
{
    for (int group = 0; group < 2; ++group) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
        const double size[3] = {0.2, 0.2, 0.1}, rail[3] = {0.02, 0.02, 4.0};
        const double r0[3] = {0.0, 0.0, 0.3}, z[3] = {0.0, 0.0, 1.0};
        double r[3];
        se3d_joint_def slide = se3d_joint_def_default();
        se3d_shape_def plane = scene_shape(&s, scene_ground(&s));
        se3d_constraint joint;
        se3d_shape shape;
        se3d_body body = scene_box(&s, size, 1.0, r0, scene_zero);
        scene_box_on(&s, scene_ground(&s), rail, scene_zero);
        plane.mask = group ? 2u : plane.mask;
        CHECK(se3d_shape_create_plane(s.system, &plane, &shape) == SE3D_OK);
        slide.body_i = scene_ground(&s);
        slide.body_j = body;
        slide.point_i[2] = 0.3;
        memcpy(slide.axis_i, z, sizeof z);
        memcpy(slide.axis_j, z, sizeof z);
        CHECK(se3d_joint_create_prismatic(s.system, &slide, &joint) == SE3D_OK);
        scene_solve(&s, SE3D_METHOD_AUTO, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
        if (scene_run(&s, 1.0)) {
            CHECK(se3d_body_get_position(s.system, body, r) == SE3D_OK);
            CHECK_NEAR(r[2], group ? 0.3 - 0.5 * G : 0.05, 1e-4);
        }
        scene_end(&s);
    }
}

/* A ball hung over a block, or in its edge, is let go; in the edge it is not thrown. */
static void what_a_broken_joint_held_touches_once_it_has_been_apart(void)
{
    static const int32_t methods[] = {SE3D_METHOD_CONVEX, SE3D_METHOD_VERLET, SE3D_METHOD_DOP853,
                                      SE3D_METHOD_RADAU};
    const double size[3] = {0.4, 0.4, 0.2}, at_block[3] = {0.0, 0.0, 0.1}, radius = 0.05;
    for (int overlaps = 0; overlaps < 2; ++overlaps) {
        for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
            const double at[3] = {overlaps ? 0.21 : 0.0, 0.0, overlaps ? 0.235 : 0.4};
            const double end = overlaps ? 0.05 : 0.8;
            scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
            se3d_joint_def hold = se3d_joint_def_default();
            se3d_constraint joint;
            double r[3], v[3];
            const se3d_body block = scene_box(&s, size, 20.0, at_block, scene_zero);
            const se3d_body ball = scene_ball(&s, radius, 0.5, at, scene_zero);
            scene_floor(&s, 0.0);
            hold.body_i = block;
            hold.body_j = ball;
            for (int k = 0; k < 3; ++k) {
                hold.point_i[k] = at[k] - at_block[k];
            }
            CHECK(se3d_joint_create_spherical(s.system, &hold, &joint) == SE3D_OK);
            CHECK(se3d_joint_set_broken(s.system, joint, 1) == SE3D_OK);
            scene_solve(&s, methods[m], SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
            if (scene_run(&s, end)) {
                CHECK(se3d_body_get_position(s.system, ball, r) == SE3D_OK);
                CHECK(se3d_body_get_velocity(s.system, ball, v) == SE3D_OK);
                CHECK_NEAR(r[2], overlaps ? 0.235 - 0.5 * G * end * end : 0.25,
                           overlaps ? 2e-3 : 1e-2);
                CHECK_NEAR(v[0], 0.0, 1e-3);
            }
            scene_end(&s);
        }
    }
}

/* Also if the joint was driven, and elements are added while the two touch. */
static void what_touches_after_a_break_goes_on_touching(void)
{
    const double size[3] = {0.4, 0.4, 0.2}, at_block[3] = {0.0, 0.0, 0.1}, at[3] = {0.0, 0.0, 0.26};
    const double away[3] = {2.0, 0.0, 0.05};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
    se3d_joint_def slide = se3d_joint_def_default();
    se3d_driver_def drive = se3d_driver_def_default();
    se3d_constraint joint, driver;
    double r[3];
    const se3d_body block = scene_box(&s, size, 20.0, at_block, scene_zero);
    const se3d_body ball = scene_ball(&s, 0.05, 0.5, at, scene_zero);
    scene_floor(&s, 0.0);
    slide.body_i = block;
    slide.body_j = ball;
    slide.point_i[2] = at[2] - at_block[2];
    CHECK(se3d_joint_create_prismatic(s.system, &slide, &joint) == SE3D_OK);
    drive.joint = joint;
    drive.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    CHECK(se3d_driver_create(s.system, &drive, &driver) == SE3D_OK);
    CHECK(se3d_joint_set_broken(s.system, joint, 1) == SE3D_OK);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, 1e-3, 0.0);
    if (scene_run(&s, 0.3)) {
        CHECK(se3d_body_get_position(s.system, ball, r) == SE3D_OK);
        CHECK_NEAR(r[2], 0.25, 1e-3);
        scene_ball(&s, 0.05, 0.5, away, scene_zero);
        CHECK(se3d_joint_set_broken(s.system, joint, 1) == SE3D_OK); /* as it is */
        CHECK(scene_run(&s, 0.6));
        CHECK(se3d_body_get_position(s.system, ball, r) == SE3D_OK);
        CHECK_NEAR(r[2], 0.25, 1e-3);
    }
    scene_end(&s);
}

/* A halo that touches nothing does not keep its ball from landing on what let it go. */
static void what_never_touches_need_not_part(void)
{
    const double size[3] = {0.4, 0.4, 0.2}, at_block[3] = {0.0, 0.0, 0.1}, at[3] = {0.0, 0.0, 0.4};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.2, 1e5);
    se3d_joint_def hold = se3d_joint_def_default();
    se3d_constraint joint;
    se3d_shape shape;
    double r[3];
    const se3d_body block = scene_box(&s, size, 20.0, at_block, scene_zero);
    const se3d_body ball = scene_ball(&s, 0.05, 0.5, at, scene_zero);
    se3d_shape_def halo = scene_shape(&s, ball);
    scene_floor(&s, 0.0);
    halo.radius = 1.0;
    halo.mask = 0;
    CHECK(se3d_shape_create_sphere(s.system, &halo, &shape) == SE3D_OK);
    hold.body_i = block;
    hold.body_j = ball;
    hold.point_i[2] = at[2] - at_block[2];
    CHECK(se3d_joint_create_spherical(s.system, &hold, &joint) == SE3D_OK);
    CHECK(se3d_joint_set_broken(s.system, joint, 1) == SE3D_OK);
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    CHECK(scene_run(&s, 0.8));
    CHECK(se3d_body_get_position(s.system, ball, r) == SE3D_OK);
    CHECK_NEAR(r[2], 0.25, 1e-2);
    scene_end(&s);
}

/* Nor does the floor, on which a ball has lain all along, keep it from the post it was held in. */
static void what_touched_all_along_need_not_part(void)
{
    const double post[3] = {0.2, 0.2, 0.4}, at[3] = {0.1, 0.0, 0.0499};
    const double away[3] = {0.4, 0.0, 0.0499}, back[3] = {-2.0, 0.0, 0.0};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.0, 0.5, 1e5);
    se3d_joint_def hold = se3d_joint_def_default();
    se3d_constraint joint;
    double r[3];
    const se3d_body ball = scene_ball(&s, 0.05, 0.5, at, scene_zero);
    scene_floor(&s, 0.0);
    scene_box_on(&s, scene_ground(&s), post, scene_zero);
    hold.body_i = scene_ground(&s);
    hold.body_j = ball;
    hold.point_i[0] = at[0];
    hold.point_i[2] = 0.06;
    hold.point_j[2] = 0.06 - at[2];
    CHECK(se3d_joint_create_spherical(s.system, &hold, &joint) == SE3D_OK);
    CHECK(se3d_joint_set_broken(s.system, joint, 1) == SE3D_OK);
    CHECK(se3d_body_set_position(s.system, ball, away) == SE3D_OK);
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 0.0);
    CHECK(scene_run(&s, 0.1));
    CHECK(se3d_body_set_velocity(s.system, ball, back) == SE3D_OK);
    CHECK(scene_run(&s, 0.4));
    CHECK(se3d_body_get_position(s.system, ball, r) == SE3D_OK);
    CHECK(r[0] > 0.15 - 1e-3);
    scene_end(&s);
}

int main(void)
{
    RUN(an_arm_falls_on_the_floor);
    RUN(a_pin_does_not_touch_its_post);
    RUN(what_is_welded_to_the_ground_does_not_touch_it);
    RUN(a_lift_lands_on_the_floor);
    RUN(what_a_broken_joint_held_touches_once_it_has_been_apart);
    RUN(what_touches_after_a_break_goes_on_touching);
    RUN(what_never_touches_need_not_part);
    RUN(what_touched_all_along_need_not_part);
    return check_finish();
}
