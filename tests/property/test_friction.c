/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction in joints: rigid stick and slip of rattle and verlet; the spring of the presliding. */
#include "support/text_model.h"

static const int32_t methods[2] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET};

#define SLIDE(velocity, friction, more)                                                            \
    "se3d: 1\nbodies: [{name: a, mass: 2, inertia: [1, 1, 1], velocity: [" velocity ", 0, 0]}]\n"  \
    "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "  \
    "0]}]\nforces:\n  - {name: f, type: friction, joint: j, " friction "}\n" more                  \
    "analysis: {type: dynamics, duration: 2, step: 0.001}\n"                                       \
    "output: [{file: r.csv, channels: [j.displacement, j.rate, f.force, energy.balance, "          \
    "energy.dissipated]}]\n"

/* v^2 / (2 mu g), for the finest presliding too, and then not a rounding error further. */
static void a_sliding_block_stops_where_it_should_and_stays(void)
{
    static const char *const texts[3] = {
        SLIDE("1", "mu: 0.5", ""), SLIDE("1", "mu: 0.5, presliding: 1.0e-12", ""),
        SLIDE("1", "mu: 0.2, limit: 0.3*2*9.81, mu_static: 0.7", "")};
    for (int run = 0; run < 12; ++run) {
        text_model m = text_model_open(texts[run / 4], methods[run % 2], run / 2 % 2, 0.001);
        CHECK(text_model_run(&m, 0.0));
        CHECK_NEAR(text_model_get(&m, 2, 0), 9.81, 1e-9); /* it slides at the start, too */
        CHECK(text_model_run(&m, 0.1));
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.1 - 0.5 * 0.5 * 9.81 * 0.01, 1e-12);
        CHECK_NEAR(text_model_get(&m, 2, 0), 9.81, 1e-9);
        CHECK(text_model_run(&m, 0.5));
        const double stop = text_model_get(&m, 0, 0);
        CHECK_NEAR(stop, 0.5 / (0.5 * 9.81), 1e-5);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-15);
        CHECK_NEAR(text_model_get(&m, 3, 0), 1.0, 1e-5);
        CHECK_NEAR(text_model_get(&m, 4, 0), 1.0, 1e-5);
        CHECK(text_model_run(&m, 2.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), stop, 1e-15);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.0, 1e-9);
        text_model_close(&m);
    }
}

/* A load that swings below the limit does not move it; one that rises passes mu_static, and from
 * then on only mu brakes. */
static void a_block_sticks_until_the_static_limit(void)
{
    static const char *const swings =
        SLIDE("0", "mu: 0.5", "  - {type: force, body: a, value: [\"9.5*sin(50*t)\", 0, 0]}\n");
    static const char *const rises = SLIDE("0", "mu: 0.25, mu_static: 0.5",
                                           "  - {type: force, body: a, value: [9.81*t, 0, 0]}\n");
    for (int run = 0; run < 4; ++run) {
        text_model m = text_model_open(swings, methods[run % 2], run / 2, 0.001);
        CHECK(text_model_run(&m, 2.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.0, 1e-12);
        CHECK_NEAR(text_model_get(&m, 2, 0), 9.5 * sin(100.0), 1e-5);
        text_model_close(&m);
        m = text_model_open(rises, methods[run % 2], run / 2, 0.001);
        CHECK(text_model_run(&m, 0.99));
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.0, 1e-12);
        CHECK(text_model_run(&m, 2.0)); /* a = 9.81 (t - 0.5)/2 from t = 1 */
        CHECK_NEAR(text_model_get(&m, 0, 0), 9.81 * (0.125 + 1.0 / 12.0), 5e-3);
        CHECK_NEAR(text_model_get(&m, 1, 0), 9.81 * 0.5, 1e-2);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.25 * 2.0 * 9.81, 1e-9);
        text_model_close(&m);
    }
}

/* Two sleds with friction between them and on the ground, pulled: they move as one. */
static void elements_that_act_on_each_other_are_solved_together(void)
{
    static const char *const text =
        "se3d: 1\nbodies:\n  - {name: a, mass: 2, inertia: [1, 1, 1]}\n"
        "  - {name: b, mass: 1, inertia: [1, 1, 1], position: [0, 0, 1]}\njoints:\n"
        "  - {name: ja, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], axis: [1, 0, "
        "0]}\n"
        "  - {name: jb, type: prismatic, body_i: a, body_j: b, at: [0, 0, 1], axis: [1, 0, 0]}\n"
        "forces:\n  - {name: fa, type: friction, joint: ja, mu: 0.1}\n"
        "  - {name: fb, type: friction, joint: jb, mu: 0.3}\n"
        "  - {type: force, body: a, value: [9, 0, 0]}\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [ja.displacement, jb.displacement, fb.force, "
        "fa.force]}]\n";
    for (int run = 0; run < 4; ++run) {
        text_model m = text_model_open(text, methods[run % 2], run / 2, 0.01);
        const double a = (9.0 - 0.1 * 3.0 * 9.81) / 3.0;
        CHECK(text_model_run(&m, 1.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.5 * a, 1e-9);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-9);
        CHECK_NEAR(text_model_get(&m, 2, 0), -a, 1e-6);
        CHECK_NEAR(text_model_get(&m, 3, 0), 0.3 * 9.81, 1e-9);
        text_model_close(&m);
    }
}

#define PENDULUM(mu, radius)                                                                       \
    "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1], position: [1, 0, 0]}]\n"             \
    "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, -1, "  \
    "0]}]\nforces: [{name: f, type: friction, joint: j, mu: " mu ", radius: " radius "}]\n"        \
    "analysis: {type: dynamics, duration: 10, step: 0.001}\n"                                      \
    "output: [{file: r.csv, channels: [j.angle, j.rate, energy.balance, energy.dissipated]}]\n"

/* While it slips one way the load varies smoothly: order 2. */
static void a_load_that_varies_leaves_the_order_at_2(void)
{
    for (int run = 0; run < 4; ++run) {
        double angle[3], balance[3];
        for (int k = 0; k < 3; ++k) {
            text_model m =
                text_model_open(PENDULUM("0.2", "0.1"), methods[run % 2], run / 2, 0.01 / (1 << k));
            CHECK(text_model_run(&m, 0.8));
            angle[k] = text_model_get(&m, 0, 0);
            balance[k] = text_model_get(&m, 2, 0);
            CHECK(text_model_get(&m, 3, 0) > 0.1);
            text_model_close(&m);
        }
        CHECK_NEAR((angle[0] - angle[1]) / (angle[1] - angle[2]), 4.0, 0.1);
        CHECK_NEAR(balance[0] / balance[1], 4.0, 0.2);
        CHECK_NEAR(balance[1] / balance[2], 4.0, 0.2);
    }
}

/* dop853 follows the bristles of the presliding; rattle and verlet need none. */
static void a_pendulum_with_a_dry_bearing_comes_to_rest_as_with_other_methods(void)
{
    text_model m = text_model_open(PENDULUM("0.4", "0.2"), SE3D_METHOD_DOP853, 0, 0.01);
    CHECK(text_model_run(&m, 3.0));
    const double angle = text_model_get(&m, 0, 0), lost = text_model_get(&m, 3, 0);
    text_model_close(&m);
    for (int run = 0; run < 4; ++run) {
        m = text_model_open(PENDULUM("0.4", "0.2"), methods[run % 2], run / 2, 0.001);
        CHECK(text_model_run(&m, 3.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), angle, 2e-4);
        CHECK_NEAR(text_model_get(&m, 3, 0), lost, 2e-4);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.0, 2e-4);
        CHECK(text_model_run(&m, 20.0));
        const double rest = text_model_get(&m, 0, 0);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.0, 1e-12);
        CHECK(text_model_run(&m, 30.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), rest, 1e-12);
        text_model_close(&m);
    }
}

static void what_friction_cannot_do_is_said_and_undone(void)
{
    text_model m = text_model_open(SLIDE("1", "mu: 0.5", ""), SE3D_METHOD_RATTLE, 0, 0.001);
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *fourth = NULL;
    def.method = SE3D_METHOD_RATTLE;
    def.order = 4;
    CHECK(!se3d_solver_create(m.system, &def, &fourth));
    CHECK(se3d_solver_run(fourth, 0.1) == SE3D_ERR_UNSUPPORTED);
    CHECK_CONTAINS(se3d_system_get_error(m.system), "use order 2");
    se3d_solver_destroy(fourth);
    text_model_close(&m);
    /* from t = 0.0105 on the load is not a number: what was is what it was at 0.010 */
    m = text_model_open(
        SLIDE("0", "mu: 0.5", "  - {type: force, body: a, value: [\"sqrt(0.0105 - t)\", 0, 0]}\n"),
        SE3D_METHOD_VERLET, 0, 0.001);
    CHECK(text_model_run(&m, 0.01));
    const uint64_t before = se3d_system_hash(m.system);
    const double force = text_model_get(&m, 2, 0);
    CHECK_NEAR(force, sqrt(0.0005), 1e-6);
    CHECK(se3d_solver_run(m.solver, 0.011) < 0);
    CHECK(se3d_system_hash(m.system) == before);
    CHECK_NEAR(text_model_get(&m, 2, 0), force, 0.0);
    text_model_close(&m);
}

#define HANGING(before, limit)                                                                     \
    "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [0.1, 0.2, 0.3], position: [1, 0, 0]}]\n"       \
    "joints: [{name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, -1, "  \
    "0]}]\nforces: [{name: f, type: friction, joint: j, limit: " limit "}]\n"                      \
    "analysis: [" before "{type: equilibrium}]\n"                                                  \
    "output: [{file: r.csv, channels: [j.angle, f.force]}]\n"

/* Friction that nothing has set is none; what a run has left sticking holds. */
static void an_equilibrium_knows_the_friction_that_a_run_has_left(void)
{
    static const char *const texts[3] = {
        HANGING("", "2"), HANGING("", "20"),
        HANGING("{type: dynamics, duration: 0.1, step: 0.01, method: rattle}, ", "20")};
    for (int run = 0; run < 6; ++run) {
        text_model m = text_model_open(texts[run / 2], -1, run % 2, 0.0);
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *statics = NULL;
        def.analysis = SE3D_ANALYSIS_EQUILIBRIUM;
        def.formulation = run % 2;
        CHECK(text_model_run(&m, run / 4 ? 0.1 : 0.0));
        CHECK(!se3d_solver_create(m.system, &def, &statics));
        CHECK(!se3d_solver_run(statics, 0.1));
        CHECK_NEAR(text_model_get(&m, 0, 0), run / 4 ? 0.0 : -0.5 * 3.14159265358979323846, 1e-9);
        se3d_solver_destroy(statics);
        text_model_close(&m);
    }
}

static void the_advice_for_an_equilibrium_is_about_equilibria(void)
{
    static const char *const text =
        "se3d: 1\nbodies: [{name: a, mass: 1, inertia: [1, 1, 1]}]\nanalysis: {type: equilibrium}\n"
        "output: []\n";
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    se3d_run *run = NULL;
    CHECK(!se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error));
    CHECK(se3d_model_run(model, NULL, &run, &error) < 0);
    CHECK_CONTAINS(error.message, "What to try: start from a position nearer");
    CHECK(!strstr(error.message, "--step") && !strstr(error.message, "--method"));
    se3d_run_destroy(run);
    se3d_model_destroy(model);
}

/* Each half swing ends 2 mu m g/k nearer to the middle: methods with error control find where. */
static void a_mass_on_a_spring_loses_as_much_in_every_swing(void)
{
    static const char *const text =
        "se3d: 1\nbodies: [{name: a, mass: 2, inertia: [1, 1, 1], position: [0.2, 0, 0]}]\n"
        "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, point_i: [0, 0, 0], "
        "axis_i: "
        "[1, 0, 0], axis_j: [1, 0, 0], ref_i: [0, 1, 0], ref_j: [0, 1, 0]}]\nforces:\n"
        "  - {type: tsda, body_i: ground, body_j: a, point_i: [-5, 0, 0], k: 300, l0: 5}\n"
        "  - {name: f, type: friction, joint: j, mu: 0.2}\n"
        "analysis: {type: dynamics, duration: 3}\n"
        "output: [{file: r.csv, channels: [j.displacement, f.force, energy.balance]}]\n";
    static const int32_t controlled[] = {SE3D_METHOD_RADAU, SE3D_METHOD_BDF, SE3D_METHOD_DOP853,
                                         SE3D_METHOD_RK45};
    const double pi = 3.14159265358979323846, w = sqrt(150.0), shift = 0.2 * 2.0 * 9.81 / 300.0;
    for (int run = 0; run < 8; ++run) {
        text_model m = text_model_open(text, controlled[run / 2], run % 2, 0.0);
        CHECK(text_model_run(&m, 0.0));
        const double energy = text_model_get(&m, 2, 0);
        for (int k = 1; k <= 38; ++k) { /* it rests from 2.05 s on */
            const double t = 0.05 * k, half = floor(w * t / pi);
            const double way = fmod(half, 2.0) > 0.5 ? 1.0 : -1.0; /* of the motion */
            const double c = -way * (0.2 - (2.0 * half + 1.0) * shift);
            CHECK(text_model_run(&m, t));
            CHECK_NEAR(text_model_get(&m, 0, 0), c * cos(w * t - pi * half) - way * shift, 5e-5);
            CHECK_NEAR(text_model_get(&m, 1, 0), way * 0.2 * 2.0 * 9.81, 1e-6);
            CHECK_NEAR(text_model_get(&m, 2, 0), energy, 2e-4);
        }
        text_model_close(&m);
    }
}

/* What sticks as 10 m/s^2 decelerate it gives under a load without swinging: critically damped. */
static void the_spring_of_the_presliding_is_damped_critically(void)
{
    static const char *const text =
        SLIDE("0", "limit: 20, presliding: 1.0e-8",
              "  - {type: force, body: a, value: [\"if(t < 1e-5, 0, 10)\", 0, 0]}\n");
    const double way = 0.5e-8, w = sqrt(10.0 / 1e-8);
    text_model m = text_model_open(text, SE3D_METHOD_GENERALIZED_ALPHA, -1, 1e-7);
    for (int k = 1; k <= 6; ++k) {
        const double t = 2.5e-5 * k;
        CHECK(text_model_run(&m, 1e-5 + t));
        CHECK_NEAR(text_model_get(&m, 0, 0), way * (1.0 - (1.0 + w * t) * exp(-w * t)), 5e-3 * way);
    }
    text_model_close(&m);
}

int main(void)
{
    RUN(a_mass_on_a_spring_loses_as_much_in_every_swing);
    RUN(a_sliding_block_stops_where_it_should_and_stays);
    RUN(a_block_sticks_until_the_static_limit);
    RUN(elements_that_act_on_each_other_are_solved_together);
    RUN(a_load_that_varies_leaves_the_order_at_2);
    RUN(a_pendulum_with_a_dry_bearing_comes_to_rest_as_with_other_methods);
    RUN(what_friction_cannot_do_is_said_and_undone);
    RUN(an_equilibrium_knows_the_friction_that_a_run_has_left);
    RUN(the_advice_for_an_equilibrium_is_about_equilibria);
    RUN(the_spring_of_the_presliding_is_damped_critically);
    return check_finish();
}
