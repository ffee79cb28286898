/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that turn by radians in a step: turns are counted, or the step is refused with its limit.
 */
#include "support/text_model.h"

#define SPIN(analysis, extra, joints)                                                              \
    "se3d: 1\ngravity: [0, 0, 0]\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1], "                \
    "angular_velocity: [0, 0, 3000]}]\n" joints extra "analysis: {type: " analysis                 \
    ", duration: 1}\n"                                                                             \
    "output: [{file: r.csv, channels: [a.angular_velocity]}]\n"
#define PIN                                                                                        \
    "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]" \
    "}]\n"

static double angle_of(const text_model *m)
{
    se3d_constraint joint;
    double angle = (double)NAN;
    CHECK(!se3d_constraint_find(m->system, "j", &joint));
    CHECK(!se3d_joint_get_coordinate(m->system, joint, SE3D_COORDINATE_ANGLE, &angle, NULL, NULL));
    return angle;
}

static void kinematics_counts_turns_at_a_million_radians_a_second(void)
{
    static const char *const kinds[2] = {
        SPIN("kinematics", "drivers: [{name: d, joint: j, value: 1e6*t}]\n", PIN),
        SPIN("inverse_dynamics", "drivers: [{name: d, joint: j, value: 1e6*t}]\n", PIN)};
    for (int run = 0; run < 4; ++run) {
        text_model m = text_model_open(kinds[run / 2], -1, run % 2, 0.0);
        CHECK(text_model_run(&m, 0.08)); /* four radians in each of 20,000 steps */
        CHECK_NEAR(angle_of(&m), 8e4, 1e-6);
        text_model_close(&m);
    }
}

static void kinematics_says_which_joint_turns_too_fast_to_count(void)
{
    text_model m = text_model_open(
        SPIN("kinematics", "drivers: [{name: d, joint: j, value: 1e9*t}]\n", PIN), -1, 0, 0.0);
    CHECK(se3d_solver_run(m.solver, 1.0) == SE3D_ERR_STEP_SIZE);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "joint j turns by");
    CHECK_CONTAINS(se3d_system_get_error(m.system), "the step must be at most 3e-09 s");
    text_model_close(&m);
}

/* 3000 rad/s in steps of a millisecond, and of a tenth of one: r-p had become nonsense in both. */
static void dynamics_refuses_steps_that_mean_nothing(void)
{
    static const int32_t methods[] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    for (int run = 0; run < 8; ++run) {
        const int pinned = run / 4;
        const char *text = pinned ? SPIN("dynamics", "", PIN) : SPIN("dynamics", "", "");
        text_model m = text_model_open(text, methods[run % 2], run / 2 % 2, 0.0011);
        CHECK(se3d_solver_run(m.solver, 0.1) == SE3D_ERR_STEP_SIZE);
        CHECK_CONTAINS(se3d_system_get_error(m.system),
                       pinned ? "joint j turns by 3.3 rad" : "body a turns by 3.3 rad");
        CHECK_NEAR(text_model_get(&m, 0, 2), 3000.0, 1e-9);
        text_model_close(&m);
        m = text_model_open(text, methods[run % 2], run / 2 % 2, 0.0001);
        CHECK(text_model_run(&m, 0.1));
        const int rp = run / 2 % 2;
        CHECK_NEAR(text_model_get(&m, 0, 2), 3000.0, rp ? (run % 2 ? 60.0 : 1.0) : 1e-5);
        CHECK(!pinned || fabs(angle_of(&m) - 300.0) < (rp ? 6.0 : 1e-6));
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(kinematics_counts_turns_at_a_million_radians_a_second);
    RUN(kinematics_says_which_joint_turns_too_fast_to_count);
    RUN(dynamics_refuses_steps_that_mean_nothing);
    return check_finish();
}
