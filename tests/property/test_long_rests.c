/* SPDX-License-Identifier: BSD-3-Clause */
/* What steps must not shrink for: bearings that turn back and forth for long, and stiff loops that
 * are at rest. */
#include "check.h"
#include "support/text_model.h"

/* A double pendulum with friction in its bearings, beside a block that rests. */
#define BEARINGS                                                                                   \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: a, mass: 1, inertia: [.1, .1, .1], position: [0.5, 0, 0]}\n"                       \
    "  - {name: b, mass: 1, inertia: [.1, .1, .1], position: [1.2, 0, 0]}\n"                       \
    "  - {name: c, mass: 1, inertia: [.1, .1, .1], position: [0, 1, 0]}\n"                         \
    "joints:\n"                                                                                    \
    "  - {name: A, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"   \
    "  - {name: B, type: revolute, body_i: a, body_j: b, at: [1, 0, 0], axis: [0, 1, 0]}\n"        \
    "  - {name: C, type: prismatic, body_i: ground, body_j: c, at: [0, 1, 0], axis: [1, 0, 0]}\n"  \
    "forces:\n"                                                                                    \
    "  - {name: fA, type: friction, joint: A, mu: 0.3, radius: 0.05}\n"                            \
    "  - {name: fB, type: friction, joint: B, mu: 0.3, radius: 0.08}\n"                            \
    "  - {name: fC, type: friction, joint: C, mu: 0.3}\n"                                          \
    "analysis: {type: dynamics, duration: 12, tolerance: %s}\n"                                    \
    "output:\n  - {file: o.csv, channels: [b.position]}\n"

static void radau_goes_on_where_bearings_rub(void)
{
    static const char *const tolerances[] = {"1e-5", "1e-7"};
    double end[2][3];
    for (int k = 0; k < 2; ++k) {
        char text[2000];
        se3d_solver_stats stats;
        snprintf(text, sizeof text, BEARINGS, tolerances[k]);
        text_model m = text_model_open(text, SE3D_METHOD_RADAU, -1, 0.0);
        text_model_run(&m, 10.0);
        CHECK(!se3d_solver_get_stats(m.solver, &stats));
        CHECK(stats.steps + stats.rejected < (k == 0 ? 1000 : 2000)); /* 619, 1291 */
        for (size_t i = 0; i < 3; ++i) {
            end[k][i] = text_model_get(&m, 0, i);
        }
        text_model_close(&m);
    }
    for (int i = 0; i < 3; ++i) {
        CHECK_NEAR(end[0][i], end[1][i], 1e-3);
    }
}

/* A mass of 1 g between a spring of 1e4 N/m with a damper and a line: it rests, its rate is 5e3/s
 * or its vibration 500 Hz. */
#define LOOP                                                                                       \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: a, mass: 1, inertia: [.1, .1, .1], position: [0, 0, -0.00981981]}\n"               \
    "  - {name: small, mass: 0.001, inertia: [1e-6, 1e-6, 1e-6], position: [0, 0, 0.090179209]}\n" \
    "joints:\n"                                                                                    \
    "  - {name: A, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 0, 1]}\n"  \
    "  - {name: P, type: prismatic, body_i: a, body_j: small, at: [0, 0, 0.1], axis: [0, 0, 1]}\n" \
    "  - {name: L, type: point_on_line, body_i: ground, body_j: small, at: [0, 0, 0.1], axis: "    \
    "[0, 0, 1]}\n"                                                                                 \
    "forces:\n"                                                                                    \
    "  - {name: s, type: tsda, body_i: a, body_j: small, point_i: [0, 0, 0], point_j: [0, 0, 0], " \
    "k: 1e4, c: %g, l0: 0.1}\n"                                                                    \
    "  - {name: g, type: tsda, body_i: ground, body_j: a, point_i: [0, 0, -1], point_j: [0, 0, "   \
    "0], k: 1000, c: 100, l0: 1}\n"                                                                \
    "analysis: {type: dynamics, duration: 10, tolerance: %g}\n"

static void stiff_loops_at_rest_are_left_to_radau(void)
{
    /* damping, tolerance; steps where dop853 stays: 33,519, 9,482, 1.3e6, 70,780 */
    static const double cases[][2] = {{5.0, 1e-6}, {1.0, 1e-6}, {5.0, 1e-8}, {0.1, 1e-7}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[2000];
        se3d_solver_stats stats;
        snprintf(text, sizeof text, LOOP, cases[k][0], cases[k][1]);
        text_model m = text_model_open(text, -1, -1, 0.0);
        text_model_run(&m, 10.0);
        CHECK(!se3d_solver_get_stats(m.solver, &stats));
        CHECK(stats.steps + stats.rejected < 700); /* 52, 46, 591, 51 */
        text_model_close(&m);
    }
}

/* A block that friction holds on a slope, an arm that a bearing holds, and two wheels behind a gear
 * whose first bearing holds a weight on the second. */
#define HELD                                                                                       \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: block, mass: 1, inertia: [.1, .2, .3], position: [0.3, 0, 0.1]}\n"                 \
    "  - {name: arm, mass: 2, inertia: [.1, .1, .1], position: [0.37, 2, 0.11]}\n"                 \
    "  - {name: a, mass: 1, inertia: [.1, .1, .1], position: [0, 4, 0]}\n"                         \
    "  - {name: b, mass: 1, inertia: [.1, .1, .1], position: [1.1, 4, 0.03]}\n"                    \
    "joints:\n"                                                                                    \
    "  - {name: S, type: prismatic, body_i: ground, body_j: block, at: [0, 0, 0], axis: [1, 0, "   \
    "0.31]}\n"                                                                                     \
    "  - {name: A, type: revolute, body_i: ground, body_j: arm, at: [0, 2, 0], axis: [0, 1, 0]}\n" \
    "  - {name: ja, type: revolute, body_i: ground, body_j: a, at: [0, 4, 0], axis: [0, 1, 0]}\n"  \
    "  - {name: jb, type: revolute, body_i: ground, body_j: b, at: [1, 4, 0], axis: [0, 1, 0]}\n"  \
    "  - {name: g, type: gear, joint_1: ja, joint_2: jb, ratio: 2}\n"                              \
    "forces:\n"                                                                                    \
    "  - {type: friction, joint: S, mu: 0.5}\n"                                                    \
    "  - {type: friction, joint: A, limit: 30}\n"                                                  \
    "  - {type: friction, joint: ja, limit: 30}\n"                                                 \
    "analysis: {type: dynamics, duration: 10, tolerance: 1e-6}\n"                                  \
    "output:\n  - {file: o.csv, channels: [block.position, arm.position, b.position, "             \
    "block.velocity]}\n"

static void what_sticks_does_not_creep(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_RK4,
                                      SE3D_METHOD_GAUSS};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        for (int32_t f = 0; f < 3; ++f) {
            double from[3][3], size = 0.0;
            text_model m =
                text_model_open(HELD, methods[k], f, methods[k] == SE3D_METHOD_RK4 ? 1e4 : 0.0);
            text_model_run(&m, 0.0);
            for (size_t c = 0; c < 9; ++c) {
                from[c / 3][c % 3] = text_model_get(&m, c / 3, c % 3);
            }
            for (int row = 1; row <= 4; ++row) {
                text_model_run(&m, 0.25e6 * row); /* 0.02 m in 1e6 s at 4e-14 m/s^2 */
                for (size_t c = 0; c < 9; ++c) {
                    const double way = text_model_get(&m, c / 3, c % 3) - from[c / 3][c % 3];
                    size = fmax(size, fabs(way));
                }
            }
            if (!(size < 1e-12)) {
                fprintf(stderr, "method %d, formulation %d: %g m\n", (int)methods[k], (int)f, size);
            }
            CHECK(size < 1e-12);
            text_model_close(&m);
        }
    }
}

/* A pendulum whose elbow sticks: what a step makes of the elbow's rate does not add up. */
#define ELBOW                                                                                      \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: a, mass: 1, inertia: [.1, .1, .1], position: [0.5, 0, 0]}\n"                       \
    "  - {name: b, mass: 1, inertia: [.1, .1, .1], position: [1.2, 0, 0.3]}\n"                     \
    "joints:\n"                                                                                    \
    "  - {name: A, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"   \
    "  - {name: B, type: revolute, body_i: a, body_j: b, at: [1, 0, 0], axis: [0, 1, 0]}\n"        \
    "forces:\n  - {type: friction, joint: B, limit: 1000}\n"                                       \
    "analysis: {type: dynamics, duration: 100, tolerance: 1e-6}\n"                                 \
    "output:\n  - {file: o.csv, channels: [B.angle]}\n"

static void an_elbow_that_sticks_stays_bent(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RK45, SE3D_METHOD_GAUSS};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        for (int32_t f = 0; f < 3; ++f) {
            text_model m = text_model_open(ELBOW, methods[k], f, 0.0);
            text_model_run(&m, 50.0); /* bodies: 3e-7 to 3e-5 if it added up; joints: 3e-12 */
            CHECK_NEAR(text_model_get(&m, 0, 0), 0.0, f == 2 ? 1e-13 : 2e-7);
            text_model_close(&m);
        }
    }
}

/* Forces that balance leave nothing but their rounding, which no tolerance is below: a chain that
 * hangs and is pulled, blocks that are held askew, a box that lies on a slope. */
#define PULLED                                                                                     \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: a, mass: 2, inertia: [.015, .015, 3e-4], position: [0, 0, -.15]}\n"                \
    "  - {name: b, mass: 2, inertia: [.015, .015, 3e-4], position: [0, 0, -.45]}\n"                \
    "  - {name: c, mass: 2, inertia: [.015, .015, 3e-4], position: [0, 0, -.75]}\n"                \
    "joints:\n"                                                                                    \
    "  - {name: A, type: spherical, body_i: ground, body_j: a, at: [0, 0, 0]}\n"                   \
    "  - {name: B, type: spherical, body_i: a, body_j: b, at: [0, 0, -.3]}\n"                      \
    "  - {name: C, type: spherical, body_i: b, body_j: c, at: [0, 0, -.6]}\n"                      \
    "forces:\n"                                                                                    \
    "  - {name: f, type: force, body: c, point: [0, 0, -.15], value: [0, 0, -100*t]}\n"
#define ASKEW                                                                                      \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: a, mass: 1, inertia: [.01, .01, .01], position: [0, 0, 0]}\n"                      \
    "  - {name: b, mass: 1, inertia: [.01, .01, .01], position: [.4, .3, 0]}\n"                    \
    "joints:\n"                                                                                    \
    "  - {name: A, type: fixed, body_i: ground, body_j: a, at: [.1, 0, .2]}\n"                     \
    "  - {name: B, type: fixed, body_i: a, body_j: b, at: [.3, .2, .1]}\n"
#define LYING                                                                                      \
    "se3d: 1\ncontact: {law: hooke}\n"                                                             \
    "materials:\n"                                                                                 \
    "  - {name: m, density: 250, friction: .5, restitution: .3, stiffness: 1e5}\n"                 \
    "bodies:\n"                                                                                    \
    "  - {name: ground, shapes: [{type: plane, material: m, normal: [.6, 0, 1.6]}]}\n"             \
    "  - {name: b, mass: 2, inertia: [.013, .013, .013], position: [.0351, 0, .0937], "            \
    "orientation: {axis: [0, 1, 0], angle: 20.556*deg}, "                                          \
    "shapes: [{type: box, size: [.2, .2, .2], material: m}]}\n"
#define FOR(tolerance) "analysis: {type: dynamics, duration: 3, tolerance: " tolerance "}\n"

static void balanced_forces_hold_no_steps_down(void)
{
    static const struct {
        const char *text;
        uint64_t steps;                    /* allowed; those before */
    } rows[] = {{PULLED FOR("1e-10"), 40}, /* 6310 */
                {ASKEW FOR("1e-10"), 40},  /* 985 */
                {LYING FOR("1e-8"), 900}}; /* 22,173 */
    for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
        for (int32_t way = 0; way < 2; ++way) {
            se3d_solver_stats stats;
            text_model m =
                text_model_open(rows[k].text, SE3D_METHOD_DOP853,
                                way ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA, 0.0);
            text_model_run(&m, 1.0);
            CHECK(!se3d_solver_get_stats(m.solver, &stats));
            CHECK(stats.steps + stats.rejected < rows[k].steps);
            text_model_close(&m);
        }
    }
}

/* A body on a stiff bushing under its weight, and a box that friction holds on a slope. */
#define ON_BUSHING                                                                                 \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: b, mass: 2, inertia: [.01, .01, .02], position: [0, 0, -1.001], "                  \
    "angular_velocity: [.3, .1, 0]}\n"                                                             \
    "forces:\n"                                                                                    \
    "  - {type: bushing, body_i: ground, body_j: b, at: [.1, 0, -1], K: [1e6, 1e6, 1e6, 100, "     \
    "100, 100], C: [2000, 2000, 2000, 1, 1, 1]}\n"

#define ON_SLOPE                                                                                   \
    "se3d: 1\nmaterials:\n"                                                                        \
    "  - {name: wood, density: 250, friction: .5, restitution: .3, stiffness: 1e5}\n"              \
    "contact: {law: hooke}\nbodies:\n"                                                             \
    "  - {name: ground, shapes: [{type: plane, material: wood, normal: [sin(20*deg), 0, "          \
    "cos(20*deg)]}]}\n"                                                                            \
    "  - {name: b, mass: 2, inertia: [.0133, .0133, .0133], position: [.1*sin(20*deg), 0, "        \
    ".1*cos(20*deg)], orientation: {axis: [0, 1, 0], angle: 20*deg}, "                             \
    "shapes: [{type: box, size: [.2, .2, .2], material: wood}]}\n"

/* The scales of the errors fall with the motion, and what is asked for below the rounding of
 * positions: no step gets shorter by that. */
static void rounding_at_rest_does_not_shorten_steps(void)
{
    static const struct {
        const char *text;
        int32_t method, most; /* steps */
        double tolerance, end;
    } cases[] = {
        {ON_BUSHING, SE3D_METHOD_RADAU, 800, 1e-8, 5.0},   /* 381; 859 with the rounding */
        {ON_BUSHING, SE3D_METHOD_RADAU, 5000, 1e-12, 5.0}, /* 2,512; 527,869 */
        {ON_BUSHING, SE3D_METHOD_BDF, 1500, 1e-6, 5.0},    /* 638; 10,328 */
        {ON_BUSHING, SE3D_METHOD_BDF, 8000, 1e-8, 5.0},    /* 4,261; beyond a million */
        {ON_SLOPE, SE3D_METHOD_RADAU, 2500, 1e-10, 2.0},   /* 1,238; 430,608 */
        {ON_SLOPE, SE3D_METHOD_BDF, 4000, 1e-8, 2.0},      /* 2,085; 26,590 */
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        char text[2000];
        se3d_solver_stats stats;
        snprintf(text, sizeof text, "%sanalysis: {type: dynamics, duration: %g, tolerance: %g}\n",
                 cases[k].text, cases[k].end, cases[k].tolerance);
        text_model m = text_model_open(text, cases[k].method, -1, 0.0);
        text_model_run(&m, cases[k].end);
        CHECK(!se3d_solver_get_stats(m.solver, &stats));
        if (!(stats.steps + stats.rejected < (uint64_t)cases[k].most)) {
            fprintf(stderr, "case %zu: %lu steps\n", k, (unsigned long)stats.steps);
        }
        CHECK(stats.steps + stats.rejected < (uint64_t)cases[k].most);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(balanced_forces_hold_no_steps_down);
    RUN(what_sticks_does_not_creep);
    RUN(an_elbow_that_sticks_stays_bent);
    RUN(radau_goes_on_where_bearings_rub);
    RUN(stiff_loops_at_rest_are_left_to_radau);
    RUN(rounding_at_rest_does_not_shorten_steps);
    return check_finish();
}
