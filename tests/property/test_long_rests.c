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

int main(void)
{
    RUN(radau_goes_on_where_bearings_rub);
    RUN(stiff_loops_at_rest_are_left_to_radau);
    return check_finish();
}
