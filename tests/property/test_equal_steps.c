/* SPDX-License-Identifier: BSD-3-Clause */
/* Methods that are named without step and tolerance: each is near the truth, as rattle and verlet
 * choose the length of their equal steps; and what becomes of that choice. */
#include "support/mechanisms.h"
#include "support/text_model.h"

static const char pendulum[] = "{se3d: 1, bodies: [{name: a, mass: 1, inertia: [0.01, 0.0833, "
                               "0.0833], position: [0.5, 0, 0]}],"
                               "joints: [{name: s, type: revolute, body_i: ground, body_j: a, at: "
                               "[0, 0, 0], axis: [0, 1, 0]}],"
                               "analysis: {type: dynamics, duration: 2}}";
static const char double_pendulum[] =
    "{se3d: 1, bodies: ["
    "{name: a, mass: 1, inertia: [0.01, 0.02, 0.03], position: [0.5, 0, 0], velocity: [0, 0.75, 0],"
    " angular_velocity: [0, 0, 1.5]},"
    "{name: b, mass: 1, inertia: [0.01, 0.02, 0.03], position: [1.5, 0, 0], velocity: [0, 1.5, "
    "0]}],"
    "joints: [{name: s, type: spherical, body_i: ground, body_j: a, at: [0, 0, 0]},"
    "         {name: t, type: spherical, body_i: a, body_j: b, at: [1, 0, 0]}],"
    "analysis: {type: dynamics, duration: 1}}";
static const char kicked[] =
    "{se3d: 1, bodies: [{name: a, mass: 1, inertia: [0.01, 0.0833, 0.0833], position: [0.5, 0, "
    "0]}],"
    "joints: [{name: s, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, "
    "0]}],"
    "forces: [{name: m, type: torque, body: a, value: [\"0\", "
    "\"60*exp(-((t-0.5)/0.04)^8)*sin(300*t)\", "
    "\"0\"]}],"
    "analysis: {type: dynamics, duration: 2}}";
static const char spun_up[] =
    "{se3d: 1, bodies: [{name: a, mass: 1, inertia: [0.01, 0.0833, 0.0833], position: [0.5, 0, "
    "0]}],"
    "joints: [{name: s, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, "
    "0]}],"
    "forces: [{name: m, type: torque, body: a, value: [\"0\", \"20*t^2\", \"0\"]}],"
    "analysis: {type: dynamics, duration: 2}}";

enum { POINTS = 10, BODIES_MAX = 8, COLUMNS = 6 * BODIES_MAX };

/* Positions and velocities of all bodies of a run of `duration` at POINTS times. */
typedef struct motion {
    double value[POINTS][COLUMNS];
} motion;

static void look(const se3d_system *system, double *row)
{
    se3d_body body = {0, 0};
    for (int k = 0; k < BODIES_MAX && k + 1 < (int)se3d_system_count_bodies(system); ++k) {
        if (se3d_system_get_body(system, (size_t)k + 1, &body) >= 0) {
            CHECK(!se3d_body_get_position(system, body, row + 6 * k));
            CHECK(!se3d_body_get_velocity(system, body, row + 6 * k + 3));
        }
    }
}

static motion follow(se3d_system *system, const se3d_solver_def *def, double duration)
{
    motion m = {{{0.0}}};
    se3d_solver *solver = NULL;
    se3d_solver_def full = *def;
    full.horizon = duration;
    CHECK(!se3d_solver_create(system, &full, &solver));
    for (int k = 0; k < POINTS; ++k) {
        CHECK(se3d_solver_run(solver, duration * (k + 1) / POINTS) >= 0);
        look(system, m.value[k]);
    }
    se3d_solver_destroy(solver);
    return m;
}

static double gap(const motion *a, const motion *b)
{
    double worst = 0.0;
    for (int c = 0; c < COLUMNS; ++c) {
        double most = 0.0, size = 0.0;
        for (int k = 0; k < POINTS; ++k) {
            most = fmax(most, fabs(a->value[k][c] - b->value[k][c]));
            size = fmax(size, fabs(b->value[k][c]));
        }
        worst = size > 1e-6 && !(most <= worst * size) ? most / size : worst;
    }
    return worst;
}

static se3d_system *open_copy(const char *text)
{
    text_model m = text_model_open(text, -1, -1, 0.0);
    se3d_system *copy = NULL;
    CHECK(!se3d_system_clone(m.system, &copy));
    text_model_close(&m);
    return copy;
}

static se3d_system *open_squeezer(void)
{
    se3d_model *model = NULL;
    se3d_model_error error;
    se3d_system *copy = NULL;
    CHECK(!se3d_model_read_file("examples/models/andrews.yaml", NULL, &model, &error));
    CHECK(!se3d_system_clone(se3d_model_get_system(model), &copy));
    se3d_model_destroy(model);
    return copy;
}

static se3d_system *open_mechanism(int k)
{
    switch (k) {
    case 0:
        return open_copy(pendulum);
    case 1:
        return open_copy(double_pendulum);
    case 2:
        return create_windows(2, se3d_joint_create_revolute).system;
    default:
        return open_squeezer();
    }
}

static void every_method_is_near_the_truth_without_step_and_tolerance(void)
{
    static const double duration[4] = {2.0, 1.0, 1.5, 0.01};
    for (int k = 0; k < 4; ++k) {
        se3d_system *system = open_mechanism(k);
        se3d_system *copy = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        def.method = SE3D_METHOD_DOP853;
        def.tolerance = 1e-11;
        CHECK(!se3d_system_clone(system, &copy));
        const motion truth = follow(copy, &def, duration[k]);
        se3d_system_destroy(copy);
        for (int32_t method = 0; se3d_method_get_name(method)[0]; ++method) {
            if (method == SE3D_METHOD_CONVEX) {
                continue; /* of order 1 at 1 ms, which it takes without asking for the error */
            }
            for (int order = 0; order <= (method == SE3D_METHOD_RATTLE ? 4 : 0); order += 4) {
                def = se3d_solver_def_default();
                def.method = method;
                def.order = order;
                CHECK(!se3d_system_clone(system, &copy));
                const motion got = follow(copy, &def, duration[k]);
                const double worst = gap(&got, &truth);
                printf("mechanism %d, %s %d: %.1e\n", k, se3d_method_get_name(method), order,
                       worst);
                CHECK(worst <= 1e-4);
                se3d_system_destroy(copy);
            }
        }
        se3d_system_destroy(system);
    }
}

static void the_error_falls_with_the_tolerance(void)
{
    for (int order = 2; order <= 4; order += 2) {
        double error[2];
        se3d_solver_def def = se3d_solver_def_default();
        def.method = SE3D_METHOD_DOP853;
        def.tolerance = 1e-12;
        se3d_system *system = open_copy(double_pendulum);
        const motion truth = follow(system, &def, 1.0);
        se3d_system_destroy(system);
        for (int k = 0; k < 2; ++k) {
            system = open_copy(double_pendulum);
            def.method = SE3D_METHOD_RATTLE;
            def.order = order;
            def.tolerance = k ? 1e-6 : 1e-4;
            const motion got = follow(system, &def, 1.0);
            error[k] = gap(&got, &truth);
            CHECK(error[k] < 30.0 * def.tolerance);
            se3d_system_destroy(system);
        }
        CHECK(error[1] < 0.1 * error[0]);
    }
}

static void the_choice_goes_on_in_clones_and_snapshots(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET};
    for (int k = 0; k < 2; ++k) {
        se3d_system *system = open_copy(double_pendulum), *copy = NULL;
        se3d_snapshot *snapshot = NULL;
        se3d_solver *solver = NULL, *other = NULL;
        se3d_solver_def def = se3d_solver_def_default();
        def.method = methods[k];
        def.horizon = 1.0;
        double step = -1.0, again = -1.0;
        CHECK(!se3d_solver_create(system, &def, &solver));
        CHECK(!se3d_solver_get_step(solver, &step) && !(fabs(step) > 0.0));
        CHECK(!se3d_solver_run(solver, 0.3));
        CHECK(!se3d_solver_get_step(solver, &step) && step > 1e-6 && step < 1e-3);
        CHECK(!se3d_system_clone(system, &copy));
        CHECK(!se3d_snapshot_create(system, &snapshot));
        CHECK(!se3d_solver_run(solver, 0.6));
        const uint64_t hash = se3d_system_hash(system);
        CHECK(!se3d_solver_create(copy, &def, &other) && !se3d_solver_run(other, 0.6));
        CHECK(!se3d_solver_get_step(other, &again) && !(fabs(again - step) > 0.0));
        CHECK(se3d_system_hash(copy) == hash);
        CHECK(!se3d_snapshot_restore(snapshot, system) && !se3d_solver_run(solver, 0.6));
        CHECK(se3d_system_hash(system) == hash);
        se3d_snapshot_destroy(snapshot);
        se3d_solver_destroy(other);
        se3d_solver_destroy(solver);
        se3d_system_destroy(copy);
        se3d_system_destroy(system);
    }
}

static void steps_are_equal_and_a_given_one_is_reported(void)
{
    se3d_system *system = open_copy(pendulum);
    se3d_solver *solver = NULL;
    se3d_solver_stats stats;
    se3d_solver_def def = se3d_solver_def_default();
    double step = 0.0;
    def.method = SE3D_METHOD_RATTLE;
    CHECK(!se3d_solver_create(system, &def, &solver) && !se3d_solver_run(solver, 1.0));
    CHECK(!se3d_solver_get_step(solver, &step) && !se3d_solver_get_stats(solver, &stats));
    CHECK_NEAR((double)stats.steps * step, 1.0, 1e-12);
    se3d_solver_destroy(solver);
    def.step = 2e-3;
    CHECK(!se3d_solver_create(system, &def, &solver) && !se3d_solver_get_step(solver, &step));
    CHECK_NEAR(step, 2e-3, 0.0);
    se3d_solver_destroy(solver);
    def.method = SE3D_METHOD_DOP853; /* the largest one, not equal ones */
    CHECK(!se3d_solver_create(system, &def, &solver) && !se3d_solver_get_step(solver, &step));
    CHECK_NEAR(step, 0.0, 0.0);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

/* From rest, in frames that know nothing of what comes: the choice is far too long, and mended (the
 * log is told: unit.log). */
static void a_choice_that_turns_out_wrong_is_mended(void)
{
    se3d_solver_def def = se3d_solver_def_default();
    double first = 0.0, step = 0.0;
    text_model m = text_model_open(spun_up, SE3D_METHOD_RATTLE, -1, 0.0);
    for (int frame = 1; frame <= 120; ++frame) {
        CHECK(se3d_solver_run(m.solver, frame / 60.0) >= 0);
        CHECK(!se3d_solver_get_step(m.solver, frame == 1 ? &first : &step));
    }
    CHECK(step > 0.0 && step < 0.1 * first);
    motion got = {{{0.0}}}, truth = {{{0.0}}};
    look(m.system, got.value[0]);
    text_model_close(&m);
    m = text_model_open(spun_up, SE3D_METHOD_DOP853, -1, 0.0);
    def.tolerance = 1e-11;
    se3d_solver *solver = NULL;
    CHECK(!se3d_solver_create(m.system, &def, &solver) && !se3d_solver_run(solver, 2.0));
    look(m.system, truth.value[0]);
    for (int c = 0; c < 6; ++c) {
        CHECK_NEAR(got.value[0][c], truth.value[0][c], 1e-2 * (c < 3 ? 0.5 : 100.0));
    }
    se3d_solver_destroy(solver);
    text_model_close(&m);
}

/* Boulders that take seconds to touch, with what else moves and what is said of the step. */
static void check_boulders(const char *contact, const char *bodies, double expected)
{
    char text[700];
    double step = 0.0;
    se3d_solver_stats stats;
    (void)snprintf(text, sizeof text,
                   "{se3d: 1, contact: {law: hooke%s}, bodies: [%s],"
                   "materials: [{name: rock, density: 2000, stiffness: 1e6}],"
                   "particles: [{material: rock, radius: 10, position: [0, 0, 0]},"
                   "{material: rock, radius: 10, position: [20, 0, 0]}],"
                   "analysis: {type: dynamics, duration: 4}}",
                   contact, bodies);
    text_model m = text_model_open(text, SE3D_METHOD_VERLET, -1, 0.0);
    CHECK(!se3d_solver_run(m.solver, 4.0));
    CHECK(!se3d_solver_get_step(m.solver, &step) && !se3d_solver_get_stats(m.solver, &stats));
    CHECK_NEAR(step, expected, 2e-3 * expected);
    CHECK(fabs((double)stats.steps - 4.0 / step) <= 1.0);
    text_model_close(&m);
}

static void particles_alone_are_stepped_as_their_contacts_allow(void)
{
    static const char body[] = "{name: a, mass: 1, inertia: [1, 1, 1], position: [0, 0, 99]}";
    check_boulders("", "", 0.08513);
    check_boulders(", step: 0.05", "", 0.05);
    check_boulders("", body, 0.001);
    check_boulders(", step: 0.05", body, 0.05);
}

/* In frames that do not know of it: steps are short in a pulse and long again behind it, where they
 * stayed as short. */
static void steps_are_long_again_behind_a_pulse(void)
{
    double first = 0.0, step = 0.0, shortest = HUGE_VAL;
    motion end[2] = {{{{0.0}}}, {{{0.0}}}};
    for (int k = 0; k < 2; ++k) {
        se3d_solver_def def = se3d_solver_def_default();
        se3d_solver *solver = NULL;
        se3d_system *system = open_copy(kicked);
        def.method = k ? SE3D_METHOD_DOP853 : SE3D_METHOD_RATTLE;
        def.tolerance = k ? 1e-11 : 1e-5;
        CHECK(!se3d_solver_create(system, &def, &solver));
        for (int frame = 1; frame <= 120; ++frame) {
            CHECK(se3d_solver_run(solver, frame / 60.0) >= 0);
            if (k == 0) {
                CHECK(!se3d_solver_get_step(solver, frame == 1 ? &first : &step));
                shortest = frame > 1 ? fmin(shortest, step) : shortest;
            }
        }
        look(system, end[k].value[0]);
        se3d_solver_destroy(solver);
        se3d_system_destroy(system);
    }
    CHECK(shortest < 0.2 * first && step > 0.4 * first);
    for (int c = 0; c < 6; ++c) {
        CHECK_NEAR(end[0].value[0][c], end[1].value[0][c], 1e-3 * (c < 3 ? 0.5 : 5.0));
    }
}

/* A block on a slide of 0.2 m/s, which drags it to a stand by its friction, under a load of 5 t N
 * that breaks it loose: t and the way there, from closed forms. */
#define ON_SLIDE(load, duration)                                                                   \
    "se3d: 1\nbodies:\n  - {name: base, mass: 1, inertia: [1, 1, 1]}\n"                            \
    "  - {name: block, mass: 1, inertia: [1, 1, 1]}\njoints:\n"                                    \
    "  - {name: s, type: prismatic, body_i: ground, body_j: base, at: [0, 0, 0], axis: [1, 0, "    \
    "0]}\n"                                                                                        \
    "  - {name: j, type: prismatic, body_i: base, body_j: block, at: [0, 0, 0], axis: [1, 0, "     \
    "0]}\n"                                                                                        \
    "drivers: [{name: d, joint: s, value: \"0.2*t\"}]\nforces:\n"                                  \
    "  - {name: f, type: friction, joint: j, mu: 0.2, mu_static: 0.3}\n"                           \
    "  - {type: force, body: block, value: [\"" load "\", 0, 0]}\n"                                \
    "analysis: {type: dynamics, duration: " duration "}\n"                                         \
    "output: [{file: r.csv, channels: [j.displacement, energy.balance]}]\n"

static void friction_that_changes_within_a_step_is_followed(void)
{
    static const int32_t methods[] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET, SE3D_METHOD_DOP853,
                                      SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    const double v = 0.2, slip = 0.2 * 9.81, hold = 0.3 * 9.81, stop = v / slip;
    const double stands = (sqrt(slip * slip + 10.0 * v) - slip) / 5.0, late = 1.0 - hold / 5.0;
    const double way = stands * (-v + stands * (0.5 * slip + stands * 5.0 / 6.0)) +
                       late * late * (5.0 / 6.0 * late + 0.5 * (hold - slip));
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        se3d_solver_stats stats;
        text_model m = text_model_open(ON_SLIDE("0", "2"), methods[k], -1, 0.0);
        CHECK(text_model_run(&m, 2.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), -0.5 * v * stop, 1e-9);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.5 * v * v, 1e-6);
        CHECK(!se3d_solver_get_stats(m.solver, &stats) && stats.steps < 300);
        text_model_close(&m);
        m = text_model_open(ON_SLIDE("5*t", "1"), methods[k], -1, 0.0);
        CHECK(text_model_run(&m, 1.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), way, 1e-6);
        CHECK_NEAR(text_model_get(&m, 1, 0), 0.5 * v * v, 1e-6);
        text_model_close(&m);
    }
}

/* Pushed back from 0.123 m on, by a force that jumps there: it comes back at the speed that it has
 * had, in steps that its constant accelerations ask for. */
static void a_force_that_jumps_within_a_step_is_followed(void)
{
    static const char text[] =
        "se3d: 1\ngravity: [0, 0, 0]\n"
        "bodies: [{name: a, mass: 2, inertia: [1, 1, 1], velocity: [0.5, 0, 0]}]\n"
        "joints: [{name: j, type: prismatic, body_i: ground, body_j: a, at: [0, 0, 0], "
        "axis: [1, 0, 0]}]\nforces:\n"
        "  - {name: f, type: force, body: a, value: [\"if(j.displacement > 0.123, -3, 0)\", 0, "
        "0]}\n"
        "analysis: {type: dynamics, duration: 1}\n"
        "output: [{file: r.csv, channels: [j.displacement, j.rate, energy.balance]}]\n";
    static const int32_t methods[3] = {SE3D_METHOD_RATTLE, SE3D_METHOD_VERLET, SE3D_METHOD_RADAU};
    const double back = 0.123 / 0.5 + 2.0 * 0.5 / 1.5;
    for (int k = 0; k < 3; ++k) {
        se3d_solver_stats stats;
        text_model m = text_model_open(text, methods[k], -1, 0.0);
        CHECK(text_model_run(&m, 1.0));
        CHECK_NEAR(text_model_get(&m, 0, 0), 0.123 - 0.5 * (1.0 - back), 3e-6);
        CHECK_NEAR(text_model_get(&m, 1, 0), -0.5, 1e-5);
        CHECK_NEAR(text_model_get(&m, 2, 0), 0.25, 1e-8);
        CHECK(!se3d_solver_get_stats(m.solver, &stats) && stats.steps < 300);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(a_force_that_jumps_within_a_step_is_followed);
    RUN(friction_that_changes_within_a_step_is_followed);
    RUN(every_method_is_near_the_truth_without_step_and_tolerance);
    RUN(the_error_falls_with_the_tolerance);
    RUN(the_choice_goes_on_in_clones_and_snapshots);
    RUN(steps_are_equal_and_a_given_one_is_reported);
    RUN(particles_alone_are_stepped_as_their_contacts_allow);
    RUN(a_choice_that_turns_out_wrong_is_mended);
    RUN(steps_are_long_again_behind_a_pulse);
    return check_finish();
}
