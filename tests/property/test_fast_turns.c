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
    CHECK(!se3d_joint_get_coordinate(m->system, joint, SE3D_JOINT_COORDINATE_ANGLE, &angle, NULL,
                                     NULL));
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

/* Ten radians in 1e-4 s and less, long after the last output: the driver is smooth, so the angle is
 * followed through all of it. */
static void kinematics_divides_its_steps_where_a_smooth_driver_is_fast(void)
{
    static const char *const kinds[4] = {
        SPIN("kinematics", "drivers: [{name: d, joint: j, value: \"5*tanh(1e4*(t - 1)) + 5\"}]\n",
             PIN),
        SPIN("kinematics", "drivers: [{name: d, joint: j, value: \"5*tanh(1e9*(t - 1)) + 5\"}]\n",
             PIN),
        SPIN("kinematics",
             "drivers: [{name: d, joint: j, value: \"5*tanh(1e4*(t - 1)) + 5 + t\"}]\n", PIN),
        SPIN("inverse_dynamics",
             "drivers: [{name: d, joint: j, value: \"5*tanh(1e4*(t - 1)) + 5\"}]\n", PIN)};
    for (int run = 0; run < 16; ++run) {
        text_model m = text_model_open(kinds[run / 4], -1, run % 2, 0.0);
        for (int k = 1; k <= (run / 2 % 2 ? 30 : 1); ++k) {
            CHECK(text_model_run(&m, run / 2 % 2 ? 2.0 * k / 30.0 : 2.0));
        }
        CHECK_NEAR(angle_of(&m), run / 4 == 2 ? 12.0 : 10.0, 1e-12);
        text_model_close(&m);
    }
}

/* The limit is rounded down: it differs from the step, and a step of that length is taken. */
static void the_longest_step_that_a_message_names_can_be_taken(void)
{
    const char *text = SPIN("dynamics", "", PIN);
    const double h = 0.1 / ceil(0.1 / (1.0000001 * 3.0 / 3000.0) - 1.0);
    text_model m = text_model_open(text, SE3D_METHOD_HHT, 0, h);
    double longest = 0.0;
    CHECK(se3d_solver_step(m.solver, h) == SE3D_ERR_STEP_SIZE);
    const char *at = strstr(se3d_system_get_error(m.system), "must be at most ");
    CHECK(at && sscanf(at, "must be at most %lf", &longest) == 1);
    CHECK(longest < h && longest > 0.98 * h);
    CHECK(!SE3D_FAILED(se3d_solver_step(m.solver, longest)));
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
    RUN(kinematics_divides_its_steps_where_a_smooth_driver_is_fast);
    RUN(the_longest_step_that_a_message_names_can_be_taken);
    RUN(dynamics_refuses_steps_that_mean_nothing);
    return check_finish();
}
