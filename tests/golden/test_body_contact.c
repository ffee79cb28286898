/* SPDX-License-Identifier: BSD-3-Clause */
/* Contact between bodies against closed forms: restitution, Coulomb's incline, rolling, stacks. */
#include "support/scene.h"

static double speed_of(const scene *s, se3d_body body, int axis)
{
    double v[3];
    CHECK(se3d_body_get_velocity(s->system, body, v) == SE3D_OK);
    return v[axis];
}

/* A sphere thrown at a wall leaves with e times its speed. */
static double bounce(int32_t law, int32_t method, double e, double speed, double step)
{
    scene s = scene_begin(law, 0.3, e, 1e5);
    CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
    const double r[3] = {0.0, 0.0, 0.05 + 1e-3 * speed};
    const double v[3] = {0.0, 0.0, -speed};
    se3d_body ball = scene_ball(&s, 0.05, 0.5, r, v);
    scene_floor(&s, 0.0);
    scene_solve(&s, method, SE3D_FORMULATION_ROMEGA, step, 1e-7);
    scene_run(&s, law == SE3D_CONTACT_LAW_HOOKE ? 0.04 : 0.15);
    double out = speed_of(&s, ball, 2) / speed;
    scene_end(&s);
    return out;
}

/* A step that is asked for meets the contact anywhere: of second order all the same. */
static void restitution_is_of_second_order_in_a_given_step(void)
{
    static const int32_t methods[4] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT,
                                       SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET};
    for (int k = 0; k < 16; ++k) {
        double worst[2] = {0.0, 0.0};
        for (int phase = 0; phase < 4; ++phase) {
            double e = 0.3 + 0.2 * (k % 4), step = 8e-5 * (1.0 + 0.07 * phase);
            for (int fine = 0; fine < 2; ++fine) {
                double out =
                    bounce(SE3D_CONTACT_LAW_HOOKE, methods[k / 4], e, 0.1, fine ? step / 4 : step);
                worst[fine] = fmax(worst[fine], fabs(out - e));
            }
        }
        CHECK(worst[0] < 1e-3 && worst[1] < 0.15 * worst[0] + 2e-6);
    }
}

static void two_spheres_part_with_the_restitution(void)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.6, 1e5);
    CHECK(se3d_system_set_gravity(s.system, scene_zero) == SE3D_OK);
    const double r1[3] = {0.0, 0.0, 0.0}, r2[3] = {0.2, 0.0, 0.0};
    const double v1[3] = {1.0, 0.0, 0.0}, v2[3] = {-0.5, 0.0, 0.0};
    se3d_body a = scene_ball(&s, 0.05, 0.5, r1, v1);
    se3d_body b = scene_ball(&s, 0.08, 2.0, r2, v2);
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_RP, 0.0, 1e-8);
    scene_run(&s, 0.2);
    double va = speed_of(&s, a, 0), vb = speed_of(&s, b, 0);
    CHECK_NEAR(vb - va, 0.6 * 1.5, 1e-3);
    CHECK_NEAR(0.5 * va + 2.0 * vb, 0.5 * 1.0 - 2.0 * 0.5, 1e-9);
    scene_end(&s);
}

static const double about_y[3] = {0.0, 1.0, 0.0};

static se3d_body add_cube(scene *s, double a, double mass, const double r[3], double angle)
{
    const double size[3] = {a, a, a};
    se3d_body body = scene_box(s, size, mass, r, scene_zero);
    scene_turn(s, body, about_y, angle);
    return body;
}

/* The places where a box rests on its four lower corners. */
static void incline_position(double a, double mass, double stiffness, double angle, double r[3])
{
    double sink = mass * G * cos(angle) / (4.0 * stiffness);
    double height = 0.5 * a - sink;
    r[0] = height * sin(angle);
    r[1] = 0.0;
    r[2] = height * cos(angle);
}

static const double slope = 20.0 * PI / 180.0;

static void box_on_an_incline_stays(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_DOP853, SE3D_METHOD_GENERALIZED_ALPHA};
    for (int k = 0; k < 4; ++k) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5);
        double r[3], before[3], after[3], force[3], torque[3];
        incline_position(0.2, 2.0, 1e5, slope, r);
        se3d_body box = add_cube(&s, 0.2, 2.0, r, slope);
        scene_floor(&s, slope);
        scene_solve(&s, methods[k % 2], k / 2 ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA,
                    k % 2 ? 2e-3 : 0.0, 1e-6);
        scene_run(&s, 2.0);
        CHECK(se3d_body_get_position(s.system, box, before) == SE3D_OK);
        scene_run(&s, k < 2 ? 12.0 : 4.0);
        CHECK(se3d_body_get_position(s.system, box, after) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(after[a], before[a], 1e-9);
        }
        CHECK_NEAR(sqrt(pow(before[0] - r[0], 2.0) + pow(before[2] - r[2], 2.0)), 0.0, 2e-4);
        CHECK(se3d_body_get_contact_wrench(s.system, box, force, torque) == SE3D_OK);
        CHECK_NEAR(force[0], 0.0, 1e-4);
        CHECK_NEAR(force[2], 2.0 * G, 1e-4);
        CHECK_NEAR(torque[1], 0.0, 1e-4);
        scene_end(&s);
    }
}

static void box_on_an_incline_slides(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_DOP853, SE3D_METHOD_GENERALIZED_ALPHA};
    for (int k = 0; k < 2; ++k) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.2, 0.3, 1e5);
        double r[3], v0[3], v1[3];
        incline_position(0.2, 2.0, 1e5, slope, r);
        se3d_body box = add_cube(&s, 0.2, 2.0, r, slope);
        scene_floor(&s, slope);
        scene_solve(&s, methods[k], SE3D_FORMULATION_ROMEGA, k ? 1e-3 : 0.0, 1e-6);
        scene_run(&s, 0.5);
        CHECK(se3d_body_get_velocity(s.system, box, v0) == SE3D_OK);
        scene_run(&s, 1.5);
        CHECK(se3d_body_get_velocity(s.system, box, v1) == SE3D_OK);
        double gained = (v1[0] - v0[0]) * cos(slope) - (v1[2] - v0[2]) * sin(slope);
        CHECK_NEAR(gained, G * (sin(slope) - 0.2 * cos(slope)), 1e-4);
        scene_end(&s);
    }
}

static void ten_spheres_stay_stacked(void)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.5, 0.3, 1e5);
    se3d_body ball[10];
    double z = 0.0, before[3], after[3];
    scene_floor(&s, 0.0);
    for (int k = 0; k < 10; ++k) {
        double sink = 0.5 * G * (10 - k) / 1e5; /* of the contact below */
        z += (k ? 0.1 : 0.05) - sink;
        const double r[3] = {0.0, 0.0, z};
        ball[k] = scene_ball(&s, 0.05, 0.5, r, scene_zero);
    }
    scene_solve(&s, SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_ROMEGA, 5e-3, 1e-6);
    scene_run(&s, 0.1);
    CHECK(se3d_body_get_position(s.system, ball[9], before) == SE3D_OK);
    scene_run(&s, 10.1);
    CHECK(se3d_body_get_position(s.system, ball[9], after) == SE3D_OK);
    CHECK_NEAR(after[2], z, 1e-9);
    CHECK_NEAR(after[2], before[2], 1e-9);
    CHECK_NEAR(after[0], 0.0, 1e-9);
    scene_end(&s);
}

/* On a slope a body rolls with g sin / (1 + J / (m R^2)). */
static double roll(int kind, int32_t method, int32_t formulation)
{
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.8, 0.3, 1e6);
    const double R = 0.1, L = 0.3, m = 2.0, tilt = 0.2;
    double along = 0.5 * m * R * R; /* a cylinder; the same numbers for all */
    const double J[3] = {0.2, 0.2, along};
    double height = R - m * G * cos(tilt) / (2.0 * 1e6);
    const double r[3] = {height * sin(tilt), 0.0, height * cos(tilt)};
    se3d_body body = scene_body(&s, m, J, r, scene_zero);
    const double about_x[3] = {1.0, 0.0, 0.0};
    scene_turn(&s, body, about_x, 0.5 * PI); /* z of the shape along -y */
    se3d_shape_def def = scene_shape(&s, body);
    se3d_shape shape;
    def.radius = R;
    def.length = L;
    CHECK((kind ? se3d_shape_create_capsule(s.system, &def, &shape)
                : se3d_shape_create_cylinder(s.system, &def, &shape)) == SE3D_OK);
    scene_floor(&s, tilt);
    double v0[3], v1[3];
    scene_solve(&s, method, formulation, method == SE3D_METHOD_DOP853 ? 0.0 : 1e-3, 1e-6);
    scene_run(&s, 0.2);
    CHECK(se3d_body_get_velocity(s.system, body, v0) == SE3D_OK);
    scene_run(&s, 0.7);
    CHECK(se3d_body_get_velocity(s.system, body, v1) == SE3D_OK);
    scene_end(&s);
    double gained = (v1[0] - v0[0]) * cos(tilt) - (v1[2] - v0[2]) * sin(tilt);
    return gained / 0.5 / (G * sin(tilt) / 1.5);
}

static void cylinder_and_capsule_roll_without_slipping(void)
{
    for (int kind = 0; kind < 2; ++kind) {
        CHECK_NEAR(roll(kind, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA), 1.0, 1e-3);
        CHECK_NEAR(roll(kind, SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_RP), 1.0, 1e-3);
    }
}

int main(void)
{
    RUN(restitution_is_of_second_order_in_a_given_step);
    RUN(two_spheres_part_with_the_restitution);
    RUN(box_on_an_incline_stays);
    RUN(box_on_an_incline_slides);
    RUN(ten_spheres_stay_stacked);
    RUN(cylinder_and_capsule_roll_without_slipping);
    return check_finish();
}
