/* SPDX-License-Identifier: BSD-3-Clause */
/* Ranks do not depend on masses: a plate of 20 kg on six driven legs (Stewart platform, 78
 * equations of rank 78) whose legs weigh nearly nothing. */
#include "support/text_model.h"

#include <math.h>

enum { LEGS = 6, TEXT = 16384 };

typedef struct legs {
    double mass, slender, axial; /* inertias over mass [m^2] */
} legs;

static void append(char *text, const char *part)
{
    CHECK(strlen(text) + strlen(part) < TEXT);
    strncat(text, part, TEXT - strlen(text) - 1);
}

static void make_leg(char *text, char *joints, int k, legs leg)
{
    const double around = 2.0 * acos(-1.0) / 3.0 * (k / 2);
    const double side = k % 2 ? 1.0 : -1.0;
    const double foot[3] = {cos(around + 0.87 * side), sin(around + 0.87 * side), 0.0};
    const double head[3] = {0.5 * cos(around + 0.17 * side), 0.5 * sin(around + 0.17 * side), 1.0};
    double z[3], length = 0.0;
    char part[2000];
    for (int c = 0; c < 3; ++c) {
        z[c] = head[c] - foot[c];
        length += z[c] * z[c];
    }
    length = sqrt(length);
    for (int c = 0; c < 3; ++c) {
        z[c] /= length;
    }
    const double level = hypot(z[0], z[1]);
    const double x[3] = {z[1] / level, -z[0] / level, 0.0};
    const double y[3] = {z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2],
                         z[0] * x[1] - z[1] * x[0]};
    for (int half = 0; half < 2; ++half) {
        const double s = half ? 0.75 : 0.25;
        snprintf(part, sizeof part,
                 "  - {name: %s%d, mass: %.17g, inertia: [%.17g, %.17g, %.17g], position: [%.17g, "
                 "%.17g, %.17g], orientation: {matrix: [[%.17g, %.17g, %.17g], [%.17g, %.17g, "
                 "%.17g], [%.17g, %.17g, %.17g]]}}\n",
                 half ? "up" : "low", k, leg.mass, leg.mass * leg.slender, leg.mass * leg.slender,
                 leg.mass * leg.axial, foot[0] + s * (head[0] - foot[0]),
                 foot[1] + s * (head[1] - foot[1]), s, x[0], y[0], z[0], x[1], y[1], z[1], x[2],
                 y[2], z[2]);
        append(text, part);
    }
    snprintf(part, sizeof part,
             "  - {name: u%d, type: universal, body_i: ground, body_j: low%d, point_i: [%.17g, "
             "%.17g, 0], point_j: [0, 0, %.17g], axis_i: [%.17g, %.17g, 0], axis_j: [0, 1, 0]}\n"
             "  - {name: p%d, type: prismatic, body_i: low%d, body_j: up%d, at: [%.17g, %.17g, "
             "0.5], axis: [%.17g, %.17g, %.17g]}\n"
             "  - {name: s%d, type: spherical, body_i: up%d, body_j: plate, at: [%.17g, %.17g, "
             "1]}\n",
             k, k, foot[0], foot[1], -0.25 * length, x[0], x[1], k, k, k, 0.5 * (foot[0] + head[0]),
             0.5 * (foot[1] + head[1]), z[0], z[1], z[2], k, k, head[0], head[1]);
    append(joints, part);
}

/* Efforts are channels 0 .. 5. */
static text_model open_platform(legs leg, const char *analysis, int32_t formulation)
{
    char text[TEXT] = "se3d: 1\nbodies:\n"
                      "  - {name: plate, mass: 20, inertia: [0.5, 0.5, 1], position: [0, 0, 1]}\n";
    char joints[TEXT] = "joints:\n";
    char part[300];
    for (int k = 0; k < LEGS; ++k) {
        make_leg(text, joints, k, leg);
    }
    append(text, joints);
    append(text, "drivers:\n");
    for (int k = 0; k < LEGS; ++k) {
        snprintf(part, sizeof part,
                 "  - {name: d%d, joint: p%d, coordinate: displacement, value: "
                 "\"0.1*(sin(2*t+%d)-sin(%d))\"}\n",
                 k, k, k, k);
        append(text, part);
    }
    snprintf(part, sizeof part,
             "analysis: {type: %s, duration: 1, step: 0.05}\noutput:\n  - {file: e.csv, channels: "
             "[d0.effort, d1.effort, d2.effort, d3.effort, d4.effort, d5.effort]}\n",
             analysis);
    append(text, part);
    return text_model_open(text, -1, formulation, 0.0);
}

static void run_platform(legs leg, const char *analysis, int32_t formulation, double effort[LEGS],
                         uint64_t *steps)
{
    text_model m = open_platform(leg, analysis, formulation);
    se3d_status status = se3d_solver_run(m.solver, 0.7);
    if (status != SE3D_OK) {
        fprintf(stderr, "%s of %g kg: status %d, %s\n", analysis, leg.mass, (int)status,
                se3d_system_get_error(m.system));
    }
    CHECK(status == SE3D_OK); /* no row is redundant */
    for (size_t k = 0; k < LEGS; ++k) {
        effort[k] = text_model_get(&m, k, 0);
    }
    se3d_solver_stats stats = {0};
    CHECK(se3d_solver_get_stats(m.solver, &stats) >= 0);
    *steps = stats.steps;
    text_model_close(&m);
}

static const legs lightness[] = {{3e-6, 1e-2, 1e-3}, {1.5e-7, 1e-3, 1e-5}, {1.5e-7, 1e-2, 1e-3},
                                 {1e-8, 1e-3, 1e-5}, {1e-8, 1e-1, 1e-5},   {1e-9, 1e-1, 1e-2}};

static void check_analysis(const char *analysis, double tolerance)
{
    const legs heavy = {1e-5, 1e-1, 1e-2};
    double expected[LEGS];
    uint64_t steps;
    run_platform(heavy, "inverse_dynamics", 0, expected, &steps);
    for (int rp = 0; rp < 2; ++rp) {
        for (size_t k = 0; k < sizeof lightness / sizeof *lightness; ++k) {
            double effort[LEGS];
            run_platform(lightness[k], analysis, rp, effort, &steps);
            CHECK(steps <= 1000);
            for (int e = 0; e < LEGS; ++e) { /* 1e-5 kg of 20 kg move */
                CHECK_NEAR(effort[e], expected[e], tolerance);
            }
        }
    }
}

static void light_legs_are_no_reason_for_redundancy_in_inverse_dynamics(void)
{
    check_analysis("inverse_dynamics", 2e-3);
}

static void light_legs_are_no_reason_for_redundancy_in_dynamics(void)
{
    check_analysis("dynamics", 2e-3);
}

/* From masses alike to masses of nothing: the driven motion needs none. */
static void driven_motions_do_not_feel_masses(void)
{
    double effort[LEGS], first[LEGS];
    uint64_t steps;
    for (int rp = 0; rp < 2; ++rp) {
        run_platform((legs){1e-12, 1e-2, 1e-3}, "inverse_dynamics", rp, first, &steps);
        run_platform((legs){1e-15, 1e-4, 1e-6}, "inverse_dynamics", rp, effort, &steps);
        for (int e = 0; e < LEGS; ++e) {
            CHECK_NEAR(effort[e], first[e], 1e-9);
        }
        text_model m = open_platform((legs){1e-15, 1e-4, 1e-6}, "kinematics", rp);
        CHECK(se3d_solver_run(m.solver, 1.0) == SE3D_OK);
        text_model_close(&m);
    }
}

/* A bar that slides along x and y and turns, as the root of a plane robot: between its joints are
 * bodies of next to no mass, in a row. It falls as without them. */
static void check_root(double part, int first, int32_t formulation)
{
    static const char *const joints[] = {
        "  - {name: x, type: prismatic, body_i: ground, body_j: one, at: [0, -0.05, 0], axis: [1, "
        "0, "
        "0]}\n",
        "  - {name: y, type: prismatic, body_i: one, body_j: two, at: [0, -0.05, 0], axis: [0, 1, "
        "0]}\n",
        "  - {name: z, type: revolute, body_i: two, body_j: bar, at: [0, -0.05, 0], axis: [0, 0, "
        "1]}\n"};
    char text[TEXT], light[200];
    const double m = 0.01 * part;
    snprintf(light, sizeof light, "mass: %.17g, inertia: [%.17g, %.17g, %.17g]}\n", m, 0.01 * m,
             0.01 * m, 0.01 * m);
    snprintf(
        text, sizeof text,
        "se3d: 1\ngravity: [0, -9.81, 0]\nbodies:\n"
        "  - {name: bar, mass: 0.01, inertia: [8.6e-6, 3.4e-7, 8.3e-6]}\n"
        "  - {name: one, %s  - {name: two, %sjoints:\n%s%s%sanalysis: {type: dynamics, duration: "
        "1}\noutput: [{file: e.csv, channels: [bar.position.y]}]\n",
        light, light, joints[first], joints[(first + 1) % 3], joints[(first + 2) % 3]);
    text_model root = text_model_open(text, -1, formulation, 0.0);
    if (text_model_run(&root, 0.3)) {
        CHECK_NEAR(text_model_get(&root, 0, 0), -0.5 * 9.81 * 0.09, 1e-6);
    }
    text_model_close(&root);
}

static void light_bodies_in_a_row_contradict_nothing(void)
{
    static const double parts[] = {1e-8, 1e-11, 1e-12, 5e-12, 1e-14};
    for (size_t k = 0; k < sizeof parts / sizeof *parts; ++k) {
        for (int first = 0; first < 3; ++first) {
            check_root(parts[k], first, SE3D_FORMULATION_AUTO);
            check_root(parts[k], first, SE3D_FORMULATION_ROMEGA);
            check_root(parts[k], first, SE3D_FORMULATION_RP);
        }
    }
}

int main(void)
{
    RUN(light_legs_are_no_reason_for_redundancy_in_inverse_dynamics);
    RUN(light_legs_are_no_reason_for_redundancy_in_dynamics);
    RUN(driven_motions_do_not_feel_masses);
    RUN(light_bodies_in_a_row_contradict_nothing);
    return check_finish();
}
