/* SPDX-License-Identifier: BSD-3-Clause */
/* Fast turns, counted whatever the outputs are; friction on what slides already when a run begins;
 * levers that are long beside the radius of gyration. */
#include "check.h"
#include "se3d/io.h"
#include "support/text_model.h"

/* Driven angles against their functions, with an output every tenth of a second. */
static void angles_count_turns_between_outputs(void)
{
    static const char *const angles[] = {"50*sin(t)", "20*t^2", "100*sin(t)", "1000*t^2"};
    for (size_t k = 0; k < sizeof angles / sizeof *angles; ++k) {
        for (int f = 0; f < 2; ++f) {
            char text[900];
            se3d_model *model = NULL;
            se3d_model_error error;
            se3d_solver *solver = NULL;
            se3d_constraint joint;
            double angle, value, t;
            snprintf(text, sizeof text,
                     "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1]}]\n"
                     "joints: [{name: j, type: revolute, body_i: ground, body_j: a, "
                     "at: [0, 0, 0], axis: [0, 0, 1]}]\n"
                     "drivers: [{name: d, joint: j, value: \"%s\"}]\n"
                     "analysis: {type: dynamics, duration: 3}\n",
                     angles[k]);
            CHECK(!se3d_model_read_text(text, strlen(text), "m", NULL, &model, &error));
            se3d_system *system = se3d_model_get_system(model);
            se3d_solver_def def = se3d_solver_def_default();
            def.analysis = SE3D_ANALYSIS_DYNAMICS;
            def.formulation = f ? SE3D_FORMULATION_RP : SE3D_FORMULATION_ROMEGA;
            CHECK(!se3d_solver_create(system, &def, &solver));
            CHECK(!se3d_constraint_find(system, "j", &joint));
            for (int row = 1; row <= 20; ++row) {
                CHECK(!se3d_solver_run(solver, 0.1 * row));
                CHECK(!se3d_system_get_time(system, &t));
                value = k == 0   ? 50.0 * sin(t)
                        : k == 1 ? 20.0 * t * t
                        : k == 2 ? 100.0 * sin(t)
                                 : 1000.0 * t * t;
                CHECK(!se3d_joint_get_coordinate(system, joint, SE3D_JOINT_COORDINATE_ANGLE, &angle,
                                                 NULL, NULL));
                CHECK_NEAR(angle, value, 1e-8);
            }
            se3d_solver_destroy(solver);
            se3d_model_destroy(model);
        }
    }
}

/* 1 kg at 1 m/s against F: it stops after 1/(2 F), and F stays in the audit. */
static void block_that_slides_at_the_start_is_braked(void)
{
    static const int32_t methods[] = {SE3D_METHOD_AUTO, SE3D_METHOD_HHT, SE3D_METHOD_DOP853,
                                      SE3D_METHOD_BDF, SE3D_METHOD_RADAU};
    for (int limit = 1; limit <= 4; ++limit) {
        for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
            const double F = 0.5 * limit;
            char text[900];
            se3d_model *model = NULL;
            se3d_model_error error;
            se3d_solver *solver = NULL;
            se3d_constraint joint;
            double x;
            snprintf(text, sizeof text,
                     "se3d: 1\ngravity: [0, 0, 0]\n"
                     "bodies: [{name: a, mass: 1, inertia: [1, 1, 1], velocity: [1, 0, 0]}]\n"
                     "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, "
                     "at: [0, 0, 0], axis: [1, 0, 0]}]\n"
                     "forces: [{name: f, type: friction, joint: j, limit: %g}]\n"
                     "analysis: {type: dynamics, duration: 1}\n",
                     F);
            CHECK(!se3d_model_read_text(text, strlen(text), "m", NULL, &model, &error));
            se3d_system *system = se3d_model_get_system(model);
            se3d_solver_def def = se3d_solver_def_default();
            def.analysis = SE3D_ANALYSIS_DYNAMICS;
            def.method = methods[m];
            def.step = 1e-3;
            CHECK(!se3d_solver_create(system, &def, &solver));
            CHECK(se3d_solver_run(solver, 0.1) >= 0);
            CHECK(!se3d_constraint_find(system, "j", &joint));
            CHECK(!se3d_joint_get_coordinate(system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT, &x,
                                             NULL, NULL));
            CHECK_NEAR(x, 0.1 - 0.005 * F, 1e-6);
            /* the presliding's stiffness keeps explicit steps small where it sticks */
            const double end = m == 2 || m == 3 ? 0.15 : 2.5;
            CHECK(se3d_solver_run(solver, end) >= 0);
            CHECK(!se3d_joint_get_coordinate(system, joint, SE3D_JOINT_COORDINATE_DISPLACEMENT, &x,
                                             NULL, NULL));
            CHECK_NEAR(x, end < 1.0 ? 0.15 - 0.01125 * F : 0.5 / F, 2e-3 / F);
            se3d_solver_destroy(solver);
            se3d_model_destroy(model);
        }
    }
}

/* A point mass is a ball of a tenth of a millimetre: noise of its accelerations, 1e16 times smaller
 * than the pull of the pin at the lever, must not be taken for error. */
static void point_masses_swing_at_every_tolerance(void)
{
    static const char *const tolerances[] = {"1e-6", "1e-8", "1e-9", "1e-10", "1e-11"};
    for (int run = 0; run < 10; ++run) {
        char text[600];
        snprintf(text, sizeof text,
                 "se3d: 1\ngravity: [0, -9.81, 0]\n"
                 "bodies: [{name: a, mass: 1, inertia: [4e-9, 4e-9, 4e-9], position: [-1, 0, 0]}]\n"
                 "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], "
                 "axis: [0, 0, 1]}]\n"
                 "analysis: {type: dynamics, method: dop853, duration: 10, tolerance: %s}\n"
                 "output: [{file: a.csv, channels: [a.position, energy.total]}]\n",
                 tolerances[run / 2]);
        text_model m = text_model_open(text, -1, run % 2, 0.0);
        se3d_solver_stats stats;
        CHECK(text_model_run(&m, 10.0));
        CHECK(!se3d_solver_get_stats(m.solver, &stats));
        CHECK(stats.steps < 1000);
        double tolerance = atof(tolerances[run / 2]);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, fmax(tolerance, 1e-12));
        CHECK_NEAR(text_model_get(&m, 0, 0), -0.275087546088, fmax(10.0 * tolerance, 1e-11));
        CHECK_NEAR(text_model_get(&m, 0, 1), -0.961419181204, fmax(10.0 * tolerance, 1e-11));
        text_model_close(&m);
    }
}

/* All points at the origins: nothing but the gap says how large the mechanism is. */
static void slides_without_a_size_start_from_any_distance(void)
{
    static const char *const drivers[] = {"1.0e-3", "0.3", "40", "-2.0e+5"};
    for (int run = 0; run < 8; ++run) {
        char text[800];
        snprintf(text, sizeof text,
                 "se3d: 1\nbodies:\n  - {name: a, mass: 2, inertia: [1, 1, 1]}\n"
                 "  - {name: b, mass: 2, inertia: [1, 1, 1]}\njoints:\n"
                 "  - {name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: "
                 "[1, 2, 3]}\n"
                 "  - {name: k, type: prismatic, body_i: a, body_j: b, at: [0, 0, 0], axis: [1, "
                 "-2, 3]}\n"
                 "drivers: [{joint: j, value: %s}, {joint: k, value: 0.5}]\n"
                 "analysis: {type: kinematics, duration: 1}\n"
                 "output: [{file: a.csv, channels: [j.displacement, k.displacement]}]\n",
                 drivers[run / 2]);
        text_model m = text_model_open(text, -1, run % 2, 0.0);
        CHECK(text_model_run(&m, 0.0));
        const double x = atof(drivers[run / 2]);
        CHECK_NEAR(text_model_get(&m, 0, 0), x, 1e-14 + 1e-15 * fabs(x));
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.5, 1e-14 + 1e-15 * fabs(x));
        text_model_close(&m);
    }
}

/* If a rate grows without end, steps shrink to the rounding of the time, and the run ends. */
static void a_driver_that_ends_in_the_middle_ends_the_run(void)
{
    for (int run = 0; run < 4; ++run) {
        char text[500];
        snprintf(text, sizeof text,
                 "se3d: 1\nbodies: [{name: a, mass: 2, inertia: [1, 1, 1], position: [1, 0, 0]}]\n"
                 "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], "
                 "axis: [0, -1, 0]}]\ndrivers: [{name: m, joint: j, value: sqrt(1 - t)}]\n"
                 "analysis: {type: %s, duration: 2, step: 0.01}\n"
                 "output: [{file: a.csv, channels: [j.angle]}]\n",
                 run / 2 ? "kinematics" : "inverse_dynamics");
        text_model m = text_model_open(text, -1, run % 2, 0.01);
        CHECK(text_model_run(&m, 0.99));
        CHECK(se3d_solver_run(m.solver, 1.0) < 0);
        CHECK_CONTAINS(se3d_system_get_error(m.system), "m.angle");
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_driver_that_ends_in_the_middle_ends_the_run);
    RUN(slides_without_a_size_start_from_any_distance);
    RUN(point_masses_swing_at_every_tolerance);
    RUN(angles_count_turns_between_outputs);
    RUN(block_that_slides_at_the_start_is_braked);
    return check_finish();
}
