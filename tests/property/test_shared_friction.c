/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction in all joints of a mechanism: many elements hold few freedoms. What sticks and what
 * slips is decided right, and always ends: methods agree with each other and with references, and
 * energy never grows. */
#include "support/text_model.h"

#define RANDOM 10

/* ---- Andrews' squeezer ---- */

static const char *const pins[10] = {"O", "F", "B", "E3", "E4", "E6", "A5", "A7", "H", "G"};

typedef struct squeezer {
    se3d_model *model;
    se3d_system *system;
    se3d_solver *solver;
} squeezer;

static squeezer open_squeezer(double mu, int32_t method, int32_t formulation, double tolerance)
{
    squeezer s;
    se3d_model_error error;
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(!se3d_model_read_file("examples/models/andrews.yaml", NULL, &s.model, &error));
    s.system = se3d_model_get_system(s.model);
    for (int k = 0; k < 10; ++k) {
        se3d_friction_def friction = se3d_friction_def_default();
        se3d_force made;
        CHECK(!se3d_constraint_find(s.system, pins[k], &friction.joint));
        friction.mu = mu;
        friction.radius = 0.002;
        friction.presliding = 1e-12;
        CHECK(!se3d_force_create_friction(s.system, &friction, &made));
    }
    def.method = method;
    def.formulation = formulation;
    def.tolerance = tolerance;
    CHECK(!se3d_solver_create(s.system, &def, &s.solver));
    return s;
}

static void close_squeezer(const squeezer *s)
{
    se3d_solver_destroy(s->solver);
    se3d_model_destroy(s->model);
}

static double angle_of(const squeezer *s, const char *pin)
{
    se3d_constraint joint;
    double angle = (double)NAN;
    CHECK(!se3d_constraint_find(s->system, pin, &joint));
    CHECK(!se3d_joint_get_coordinate(s->system, joint, SE3D_JOINT_COORDINATE_ANGLE, &angle, NULL,
                                     NULL));
    return angle;
}

/* The crank and a rocker at .008 s, by dop853 at 3e-12. The squeezer starts at rest, half of its
 * joints at dead points: how they begin to slip counts, and with it the tolerance, and in methods
 * with springs the presliding of 1e-12 rad. At mu = .3 it does not start. */
static void a_squeezer_with_friction_in_all_joints_runs_in_every_method(void)
{
    static const struct {
        double mu, crank, rocker;
    } cases[] = {{1e-3, 1.0378496717721875, 0.36675827420633678},
                 {0.05, 0.45026495505088232, 0.43434853464704398},
                 {0.3, -0.0617138900142764496, 0.455279819163070380}};
    static const struct {
        int32_t method;
        double tolerance, accuracy;
    } methods[] = {
        {SE3D_METHOD_DOP853, 1e-8, 6e-6}, {SE3D_METHOD_RADAU, 1e-7, 6e-5},
        {SE3D_METHOD_BDF, 1e-7, 6e-5},    {SE3D_METHOD_RK45, 1e-7, 2e-5},
        {SE3D_METHOD_AUTO, 1e-8, 6e-6},   {SE3D_METHOD_GENERALIZED_ALPHA, 1e-4, 1e-3},
        {SE3D_METHOD_HHT, 1e-4, 1e-3},
    };
    for (size_t c = 0; c < sizeof cases / sizeof *cases; ++c) {
        for (size_t k = 0; k < 2 * sizeof methods / sizeof *methods; ++k) {
            squeezer s = open_squeezer(cases[c].mu, methods[k / 2].method, (int32_t)(k % 2),
                                       methods[k / 2].tolerance);
            const se3d_status status = se3d_solver_run(s.solver, 0.008);
            CHECK(status >= 0);
            if (status < 0) {
                fprintf(stderr, "%s\n", se3d_system_get_error(s.system));
            }
            CHECK_NEAR(angle_of(&s, "O"), cases[c].crank, methods[k / 2].accuracy);
            CHECK_NEAR(angle_of(&s, "B"), cases[c].rocker, methods[k / 2].accuracy);
            close_squeezer(&s);
        }
    }
}

/* ---- several elements, one freedom ---- */

static const int32_t all_methods[] = {SE3D_METHOD_DOP853,
                                      SE3D_METHOD_RK45,
                                      SE3D_METHOD_RADAU,
                                      SE3D_METHOD_BDF,
                                      SE3D_METHOD_GENERALIZED_ALPHA,
                                      SE3D_METHOD_HHT,
                                      SE3D_METHOD_RATTLE,
                                      SE3D_METHOD_VERLET};
enum { METHODS = sizeof all_methods / sizeof *all_methods };

/* At rest under a load; `part` of what all elements hold together. Coordinate and its acceleration
 * at .1 s, forces of two elements at the start. */
typedef struct outcome {
    double x, rate, n[2];
} outcome;

static outcome run_loaded(const char *text, double part, int run)
{
    const int32_t method = all_methods[run / 2];
    const int steps = method == SE3D_METHOD_RATTLE || method == SE3D_METHOD_VERLET;
    char full[3000];
    outcome o;
    snprintf(full, sizeof full, "se3d: 1\nparameters: {part: %.17g}\n%s", part, text);
    text_model m = text_model_open(full, method, run % 2, steps ? 1e-3 : 0.0);
    CHECK(text_model_run(&m, 0.0));
    o.n[0] = text_model_get(&m, 2, 0);
    o.n[1] = text_model_get(&m, 3, 0);
    CHECK(text_model_run(&m, 0.1));
    o.x = text_model_get(&m, 0, 0);
    o.rate = text_model_get(&m, 1, 0);
    text_model_close(&m);
    return o;
}

/* Elements of limits 3 : 1 carry in all 4: below that nothing moves, and they carry it in
 * proportion; above, what is left accelerates `inertia`. */
static void check_loaded(const char *text, double inertia)
{
    for (int run = 0; run < 2 * METHODS; ++run) {
        const int rigid = all_methods[run / 2] == SE3D_METHOD_RATTLE ||
                          all_methods[run / 2] == SE3D_METHOD_VERLET;
        outcome o = run_loaded(text, 0.98, run);
        CHECK_NEAR(o.x, 0.0, 2e-9);
        CHECK_NEAR(o.rate, 0.0, 5e-3); /* springs of the presliding may swing */
        CHECK_NEAR(o.n[0] + o.n[1], 4.0 * 0.98, 1e-9);
        CHECK_NEAR(o.n[0], 3.0 * 0.98, rigid ? 0.07 : 1e-6); /* those share as they come */
        o = run_loaded(text, 1.02, run);
        CHECK_NEAR(o.n[0], 3.0, 1e-9);
        CHECK_NEAR(o.n[1], 1.0, 1e-9);
        CHECK_NEAR(o.rate, 0.08 / inertia * 0.1, 1e-4 * 0.08 / inertia);
        CHECK_NEAR(o.x, 0.5 * 0.08 / inertia * 0.01, 1e-4 * 0.08 / inertia);
    }
}

static void two_elements_on_one_slider_share_what_they_hold(void)
{
    check_loaded("gravity: [0, 0, -10]\n"
                 "bodies: [{name: a, mass: 2, inertia: [1, 1, 1]}]\n"
                 "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], "
                 "axis: [1, 0, "
                 "0]}]\nforces:\n  - {name: f, type: friction, joint: j, mu: 0.1, limit: 1}\n"
                 "  - {name: g, type: friction, joint: j, mu: 0.05}\n"
                 "  - {type: force, body: a, value: [4*part, 0, 0]}\n"
                 "analysis: {type: dynamics, duration: 1}\n"
                 "output: [{file: r.csv, channels: [j.displacement, j.rate, f.force, g.force]}]\n",
                 2.0);
}

/* Two hinges on one axis: of their equations five are dependent. */
static void two_hinges_on_one_axis_share_what_they_hold(void)
{
    check_loaded(
        "gravity: [0, 0, 0]\n"
        "bodies: [{name: a, mass: 2, inertia: [1, 1, 0.5]}]\n"
        "joints:\n  - {name: j, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0.5], axis: "
        "[0, 0, 1]}\n"
        "  - {name: k, type: revolute, body_i: ground, body_j: a, at: [0, 0, -0.5], axis: [0, 0, "
        "1]}\n"
        "forces:\n  - {name: f, type: friction, joint: j, limit: 3}\n"
        "  - {name: g, type: friction, joint: k, limit: 1}\n"
        "  - {type: torque, body: a, value: [0, 0, 4*part]}\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [j.angle, j.rate, f.force, g.force]}]\n",
        0.5);
}

/* A parallelogram turns in all four pins alike: 1.2 + 1 + .8 on three of them, 1 on the fourth. */
static void a_four_bar_breaks_away_where_all_its_joints_together_yield(void)
{
    static const char *const text =
        "gravity: [0, 0, 0]\nbodies:\n"
        "  - {name: crank, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0, 0.5, 0]}\n"
        "  - {name: rod, mass: 2, inertia: [0.1, 0.1, 0.1], position: [1, 1, 0]}\n"
        "  - {name: rocker, mass: 1, inertia: [0.1, 0.1, 0.1], position: [2, 0.5, 0]}\n"
        "joints:\n"
        "  - {name: a, type: revolute, body_i: ground, body_j: crank, at: [0, 0, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: b, type: revolute, body_i: crank, body_j: rod, at: [0, 1, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: c, type: revolute, body_i: rod, body_j: rocker, at: [2, 1, 0], axis: [0, 0, "
        "1]}\n"
        "  - {name: d, type: revolute, body_i: ground, body_j: rocker, at: [2, 0, 0], axis: [0, 0, "
        "1]}\n"
        "forces:\n  - {name: fa, type: friction, joint: a, limit: 1.2}\n"
        "  - {name: fb, type: friction, joint: b, limit: 1}\n"
        "  - {name: fc, type: friction, joint: c, limit: 0.8}\n"
        "  - {name: fd, type: friction, joint: d, limit: 1}\n"
        "  - {type: torque, body: crank, value: [0, 0, 4*part]}\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [a.angle, a.rate, fa.force, fb.force]}]\n";
    const double inertia = 2.0 * (0.1 + 0.25) + 2.0;
    for (int run = 0; run < 2 * METHODS; ++run) {
        outcome o = run_loaded(text, 0.98, run);
        CHECK_NEAR(o.x, 0.0, 2e-9);
        CHECK_NEAR(o.rate, 0.0, 5e-3); /* springs of the presliding may swing */
        CHECK(fabs(o.n[0]) <= 1.2 && fabs(o.n[1]) <= 1.0);
        o = run_loaded(text, 1.02, run);
        CHECK_NEAR(o.n[0], 1.2, 1e-9);
        CHECK_NEAR(o.n[1], -1.0, 1e-9);
        CHECK_NEAR(o.rate, 0.08 / inertia * 0.1, 1e-4 * 0.08 / inertia);
    }
}

/* ---- random mechanisms ---- */

static double uniform(uint64_t *seed, double low, double high)
{
    return low + 0.5 * (high - low) * (1.0 + check_random(seed));
}

/* A chain of 2 to 5 links in a plane, in half of the cases closed to a loop, at rest or in motion,
 * with friction in every pin. */
static void write_random(uint64_t *seed, char *text, size_t size)
{
    const int links = 2 + (int)uniform(seed, 0.0, 3.999), closed = check_random(seed) > 0.0;
    const double spin = check_random(seed) > 0.0 ? uniform(seed, -5.0, 5.0) : 0.0;
    double x = 0.0, y = 0.0, ends[6][2] = {{0.0, 0.0}};
    size_t at = (size_t)snprintf(text, size, "se3d: 1\ngravity: [0, -9.81, 0]\nbodies:\n");
    for (int k = 1; k <= links; ++k) {
        const double next[2] = {x + uniform(seed, 0.3, 1.0), y + uniform(seed, -1.0, 1.0)};
        const double m = uniform(seed, 0.2, 3.0), J = uniform(seed, 0.02, 0.2);
        at += (size_t)snprintf(text + at, size - at,
                               "  - {name: b%d, mass: %.17g, inertia: [%.17g, %.17g, %.17g], "
                               "position: [%.17g, %.17g, 0], angular_velocity: [0, 0, %.17g]}\n",
                               k, m, J, J, J, 0.5 * (x + next[0]), 0.5 * (y + next[1]),
                               k == links ? spin : 0.0);
        memcpy(ends[k], next, sizeof next);
        x = next[0];
        y = next[1];
    }
    at += (size_t)snprintf(text + at, size - at, "joints:\n");
    for (int k = 0; k < links + closed; ++k) {
        char i[8], j[8];
        snprintf(i, sizeof i, k == 0 ? "ground" : "b%d", k);
        snprintf(j, sizeof j, k == links ? "ground" : "b%d", k + 1);
        at += (size_t)snprintf(text + at, size - at,
                               "  - {name: j%d, type: revolute, body_i: %s, body_j: %s, at: "
                               "[%.17g, %.17g, 0], axis: [0, 0, 1]}\n",
                               k, i, j, ends[k][0], ends[k][1]);
    }
    at += (size_t)snprintf(text + at, size - at, "forces:\n");
    for (int k = 0; k < links + closed; ++k) {
        const double mu = uniform(seed, 0.0, 0.4), more = check_random(seed) > 0.0 ? 1.5 : 1.0;
        at += (size_t)snprintf(text + at, size - at,
                               "  - {type: friction, joint: j%d, mu: %.17g, mu_static: %.17g, "
                               "radius: %.17g}\n",
                               k, mu, more * mu, uniform(seed, 0.005, 0.1));
    }
    snprintf(text + at, size - at,
             "analysis: {type: dynamics, duration: 1}\n"
             "output: [{file: r.csv, channels: [energy.total, "
             "energy.balance]}]\n");
}

static void random_mechanisms_never_jam_nor_gain_energy(void)
{
    static const struct {
        int32_t method;
        double gain;
    } methods[] = {{SE3D_METHOD_DOP853, 1e-6}, {SE3D_METHOD_RADAU, 1e-5}, {SE3D_METHOD_BDF, 1e-4}};
    uint64_t seed = 41;
    for (int k = 0; k < RANDOM; ++k) {
        char text[6000];
        write_random(&seed, text, sizeof text);
        for (size_t method = 0; method < sizeof methods / sizeof *methods; ++method) {
            text_model m = text_model_open(text, methods[method].method, k % 2, 0.0);
            CHECK(text_model_run(&m, 0.0));
            double before = text_model_get(&m, 0, 0), gain = 0.0;
            int runs = 1;
            for (int n = 1; n <= 200 && runs; ++n) {
                runs = text_model_run(&m, 2.5e-3 * n);
                gain = fmax(gain, text_model_get(&m, 0, 0) - before);
                before = text_model_get(&m, 0, 0);
            }
            CHECK(gain <= methods[method].gain);
            if (!runs) {
                fprintf(stderr, "mechanism %d, method %d:\n%s", k, methods[method].method, text);
            }
            text_model_close(&m);
        }
    }
}

/* ---- null friction ---- */

#define DOUBLE_PENDULUM(forces)                                                                    \
    "se3d: 1\nbodies:\n"                                                                           \
    "  - {name: p, mass: 1, inertia: [0.1, 0.1, 0.1], position: [0.5, 0, 0]}\n"                    \
    "  - {name: q, mass: 1, inertia: [0.1, 0.1, 0.1], position: [1.5, 0, 0]}\njoints:\n"           \
    "  - {name: a, type: revolute, body_i: ground, body_j: p, at: [0, 0, 0], axis: [0, 1, 0]}\n"   \
    "  - {name: b, type: revolute, body_i: p, body_j: q, at: [1, 0, 0], axis: [0, 1, 0]}\n" forces \
    "analysis: {type: dynamics, duration: 1}\n"

static se3d_solver_stats count_work(const char *text, int32_t method, double step)
{
    se3d_solver_stats stats = {0};
    text_model m = text_model_open(text, method, 0, step);
    CHECK(text_model_run(&m, 1.0));
    CHECK(!se3d_solver_get_stats(m.solver, &stats));
    text_model_close(&m);
    return stats;
}

/* No more steps and iterations than without, but for a fifth where it turns. */
static void null_friction_costs_nothing(void)
{
    static const char *const without = DOUBLE_PENDULUM("");
    static const char *const with[2] = {
        DOUBLE_PENDULUM("forces:\n  - {type: friction, joint: a, mu: 0, radius: 0.01}\n"
                        "  - {type: friction, joint: b, mu: 0, radius: 0.01}\n"),
        DOUBLE_PENDULUM("forces:\n  - {type: friction, joint: a, mu: 1.0e-12, radius: 0.01}\n"
                        "  - {type: friction, joint: b, limit: 1.0e-12}\n")};
    static const struct {
        int32_t method;
        int32_t reserved;
        double step;
    } ways[] = {
        {SE3D_METHOD_GENERALIZED_ALPHA, 0, 1e-3},
        {SE3D_METHOD_HHT, 0, 1e-3},
        {SE3D_METHOD_GENERALIZED_ALPHA, 0, 0.0},
        {SE3D_METHOD_HHT, 0, 0.0},
        {SE3D_METHOD_RADAU, 0, 0.0},
        {SE3D_METHOD_BDF, 0, 0.0},
    };
    for (size_t k = 0; k < 2 * sizeof ways / sizeof *ways; ++k) {
        const se3d_solver_stats bare = count_work(without, ways[k / 2].method, ways[k / 2].step);
        const se3d_solver_stats null =
            count_work(with[k % 2], ways[k / 2].method, ways[k / 2].step);
        CHECK((double)null.steps <= 1.2 * (double)bare.steps);
        CHECK((double)null.iterations <= 1.2 * (double)bare.iterations);
    }
}

int main(void)
{
    RUN(null_friction_costs_nothing);
    RUN(two_elements_on_one_slider_share_what_they_hold);
    RUN(two_hinges_on_one_axis_share_what_they_hold);
    RUN(a_four_bar_breaks_away_where_all_its_joints_together_yield);
    RUN(a_squeezer_with_friction_in_all_joints_runs_in_every_method);
    RUN(random_mechanisms_never_jam_nor_gain_energy);
    return check_finish();
}
