/* SPDX-License-Identifier: BSD-3-Clause */
/* A spring so stiff that the joint across which it acts is as good as fixed: rounding of positions
 * makes forces, and vibrations are a million times too fast for the step. The methods for stiff
 * motions choose steps as if there were none, and the motion is that of the fixed joint. */
#include "analysis/stiffness.h"
#include "support/text_model.h"
#include "system/system_internal.h"

#define HEAD                                                                                       \
    "gravity: [0, 0, -9.81]\n"                                                                     \
    "bodies:\n"                                                                                    \
    "  - {name: a, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0]}\n"                   \
    "  - {name: b, mass: 0.7, inertia: [0.005, 0.06, 0.06], position: [1.4, 0, 0]}\n"
#define PIN                                                                                        \
    "joints:\n"                                                                                    \
    "  - {type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"
#define HINGE                                                                                      \
    "  - {name: q, type: revolute, body_i: a, body_j: b, at: [1, 0, 0], axis: [0, 1, 0]}\n"
#define TAIL "analysis: {type: dynamics, duration: 1}\n"

static const struct link {
    const char *name, *text;
} links[] = {
    {"rsda", HEAD PIN HINGE "forces: [{type: rsda, joint: q, k: k}]\n" TAIL},
    {"tsda", HEAD PIN HINGE "forces: [{type: tsda, body_i: a, body_j: b, point_i: [0.5, 0, -0.1], "
                            "point_j: [-0.2, 0, 0.1], k: k, l0: 0.28284271247461906}]\n" TAIL},
    {"bushing", HEAD PIN "forces: [{type: bushing, body_i: a, body_j: b, at: [1, 0, 0], K: [k, k, "
                         "k, k, k, k]}]\n" TAIL},
};

#define FIXED "se3d: 1\n" HEAD PIN "  - {type: fixed, body_i: a, body_j: b, at: [1, 0, 0]}\n" TAIL
enum { LINKS = sizeof links / sizeof *links, TIMES = 4 };
#define DURATION 0.3

typedef struct path {
    double position[TIMES][9], velocity[TIMES][9], spin[TIMES][9];
    uint64_t steps;
} path;

static int follow(const char *text, int32_t method, double step, double tolerance, path *p)
{
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    se3d_solver *solver = NULL;
    se3d_solver_stats stats;
    se3d_solver_def def = se3d_solver_def_default();
    CHECK(!se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error));
    se3d_system *system = se3d_model_get_system(model);
    def.method = method;
    def.step = step;
    def.tolerance = tolerance;
    def.steps_max = 20000;
    CHECK(!se3d_solver_create(system, &def, &solver));
    int runs = 1;
    for (int k = 0; k < TIMES && runs; ++k) {
        runs = se3d_solver_run(solver, DURATION * (k + 1) / TIMES) >= 0;
        CHECK(!se3d_body_get_all(system, 3, p->position[k], NULL, p->velocity[k], p->spin[k]));
    }
    if (!runs) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
    }
    CHECK(!se3d_solver_get_stats(solver, &stats));
    p->steps = stats.steps + stats.rejected;
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
    return runs;
}

static double compare(const path *a, const path *b)
{
    double worst = 0.0;
    for (int k = 0; k < TIMES; ++k) {
        for (int c = 0; c < 9; ++c) {
            worst = fmax(worst, fabs(a->position[k][c] - b->position[k][c]));
            worst = fmax(worst, fabs(a->velocity[k][c] - b->velocity[k][c]));
            worst = fmax(worst, fabs(a->spin[k][c] - b->spin[k][c]));
        }
    }
    return worst;
}

static void check(const struct link *link, double k, int32_t method, double step, double most)
{
    char text[1500];
    static path got, truth;
    (void)snprintf(text, sizeof text, "se3d: 1\nparameters: {k: %g}\n%s", k, link->text);
    CHECK(follow(FIXED, SE3D_METHOD_DOP853, 0.0, 1e-12, &truth));
    const int runs = follow(text, method, step, step > 0.0 ? 0.0 : 1e-5, &got);
    const double error = runs ? compare(&got, &truth) : HUGE_VAL;
    const int holds = runs && error <= most;
    CHECK(holds);
    if (!holds) {
        fprintf(stderr, "%s of %g by %s, step %g: off by %.2g after %llu steps\n", link->name, k,
                se3d_method_get_name(method), step, error, (unsigned long long)got.steps);
    }
}

static void check_all(int32_t method, double step, double most)
{
    for (size_t link = 0; link < LINKS; ++link) {
        for (int power = 13; power <= 16; ++power) {
            check(&links[link], pow(10.0, power), method, step, most);
        }
    }
}

static void chosen_steps_of_the_newmark_family_are_those_of_the_slow_motion(void)
{
    check_all(SE3D_METHOD_GENERALIZED_ALPHA, 0.0, 1e-4);
    check_all(SE3D_METHOD_HHT, 0.0, 1e-4);
}

static void equal_steps_of_the_newmark_family_follow_the_slow_motion(void)
{
    check_all(SE3D_METHOD_GENERALIZED_ALPHA, 1e-3, 1e-3);
    check_all(SE3D_METHOD_HHT, 1e-3, 1e-3);
}

static void states_within_steps_of_radau_do_not_feel_what_the_spring_is_off_by(void)
{
    check_all(SE3D_METHOD_RADAU, 0.0, 2e-3); /* what positions are off by, over the step */
}

/* And if they are damped: what the joint yields by creeps back within 0.1 ms. Steps are those of
 * the slow motion, not of the vibration, nor of the creep. */
static void bushings_with_dampers_are_as_good_as_joints(void)
{
    static const struct way {
        int32_t method;
        double power; /* of 10, the least */
        uint64_t steps;
    } ways[] = {{SE3D_METHOD_BDF, 9.0, 1500},
                {SE3D_METHOD_RADAU, 9.0, 1500},
                {SE3D_METHOD_AUTO, 9.0, 1500},
                {SE3D_METHOD_HHT, 11.0, 4000},
                {SE3D_METHOD_GENERALIZED_ALPHA, 11.0, 4000}};
    static path got, truth;
    CHECK(follow(FIXED, SE3D_METHOD_DOP853, 0.0, 1e-12, &truth));
    for (size_t way = 0; way < sizeof ways / sizeof *ways; ++way) {
        for (double power = ways[way].power; power <= 13.0; power += 1.0) {
            char text[1500];
            (void)snprintf(text, sizeof text,
                           "se3d: 1\nparameters: {k: %g, c: %g}\n" HEAD PIN
                           "forces: [{type: bushing, body_i: a, body_j: b, at: [1, 0, 0], "
                           "K: [k, k, k, k, k, k], C: [c, c, c, c, c, c]}]\n" TAIL,
                           pow(10.0, power), pow(10.0, power - 4.0));
            const int runs = follow(text, ways[way].method, 0.0, 1e-6, &got);
            const double error = runs ? compare(&got, &truth) : HUGE_VAL;
            const int holds = runs && error < 1e-5 && got.steps < ways[way].steps;
            CHECK(holds);
            if (!holds || getenv("SE3D_SHOW")) {
                fprintf(stderr, "bushing of 1e%g N/m by %s: off by %.2g after %llu steps\n", power,
                        se3d_method_get_name(ways[way].method), error,
                        (unsigned long long)got.steps);
            }
        }
    }
}

typedef struct notes {
    char last[512];
    int32_t count;
} notes;

static void note(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    notes *n = ctx;
    if (level == SE3D_LOG_WARNING && kind == SE3D_LOG_STEP && strstr(message, "vibration")) {
        ++n->count;
        (void)snprintf(n->last, sizeof n->last, "%s", message);
    }
}

static notes follow_noted(const char *text, int32_t method, double duration, int rows)
{
    notes n = {"", 0};
    text_model m = text_model_open(text, method, SE3D_FORMULATION_ROMEGA, 0.0);
    CHECK(!se3d_system_set_log(m.system, note, &n));
    for (int k = 0; k < rows; ++k) {
        CHECK(se3d_solver_run(m.solver, duration * (k + 1) / rows) >= 0);
    }
    text_model_close(&m);
    return n;
}

/* Whose steps are those of a vibration that nobody asked for says so, once, and of which element;
 * methods that pass over it, dampers and springs whose motion is the one to see say nothing. */
static void vibrations_that_make_steps_short_are_named(void)
{
    static const struct shaken {
        double k, c;
        int32_t method, rows;
        double duration;
        int32_t told[2]; /* of the bushing, of the spring */
    } rows[] = {{1e9, 0.0, SE3D_METHOD_BDF, 1, 0.004, {1, 0}},
                {1e9, 0.0, SE3D_METHOD_BDF, 20, 0.004, {1, 0}},
                {1e9, 1e3, SE3D_METHOD_BDF, 1, 0.004, {0, 0}}, /* it is over soon */
                {1e9, 0.0, SE3D_METHOD_RATTLE, 1, 0.002, {1, 1}},
                {1e9, 0.0, SE3D_METHOD_RADAU, 1, 0.3, {0, 0}},
                {1e9, 1e5, SE3D_METHOD_BDF, 3, 0.3, {0, 0}},
                {1e3, 0.0, SE3D_METHOD_BDF, 1, 0.3, {0, 0}},
                {1e3, 0.0, SE3D_METHOD_RATTLE, 1, 0.3, {0, 0}}};
    static const char *const elements[] = {
        "type: bushing, at: [1, 0, 0], K: [k, k, k, k, k, k], C: [c, c, c, c, c, c]",
        "type: tsda, at: [0.5, 0, 0.5], at_2: [1, 0, 0], k: k, c: c, l0: 0.7071"};
    for (size_t row = 0; row < sizeof rows / sizeof *rows; ++row) {
        for (int element = 0; element < 2; ++element) {
            const struct shaken *s = &rows[row];
            char text[1500];
            (void)snprintf(text, sizeof text,
                           "se3d: 1\nparameters: {k: %g, c: %g}\n" HEAD PIN "%s"
                           "forces: [{name: rubber, body_i: a, body_j: b, %s}]\n" TAIL,
                           s->k, s->c, element ? HINGE : "", elements[element]);
            const notes n = follow_noted(text, s->method, s->duration, s->rows);
            CHECK(n.count == s->told[element]);
            if (n.count != s->told[element] || getenv("SE3D_SHOW")) {
                fprintf(stderr, "row %zu, element %d: %s\n", row, element, n.last);
            }
            if (s->told[element]) {
                CHECK_CONTAINS(n.last, "it may be that of");
                CHECK_CONTAINS(n.last, "\"rubber\"");
            }
        }
    }
}

/* Nothing could take the place of a tyre: to damp it is no advice. */
static void no_tyre_is_named_as_a_vibration(void)
{
    static const char text[] =
        "se3d: 1\nbodies: [{name: rim, mass: 10, inertia: [1e5, 1e5, 1e5], "
        "position: [0, 0, 0.29981], velocity: [50, 0, 0]}]\n"
        "joints: [{type: planar, body_i: ground, body_j: rim, at: [0, 0, 0], axis: [0, 1, 0]}]\n"
        "forces:\n"
        "  - {name: hard, type: tyre, body: rim, radius: 0.3, k: 1e9, mu: 0.9, "
        "slip_stiffness: 5e4, cornering_stiffness: 4e4}\n"
        "  - {type: force, body: rim, value: [0, 0, -1e5]}\n" TAIL;
    const se3di_force *force;
    text_model m = text_model_open(text, SE3D_METHOD_BDF, SE3D_FORMULATION_ROMEGA, 0.0);
    CHECK(se3d_solver_run(m.solver, 1e-4) >= 0);
    CHECK(se3di_stiffness_vibration(&m.system->model, &force) == 0.0 && force == NULL);
    text_model_close(&m);
}

/* A strong spring against as strong a damper: what creeps back within a second is no error to be
 * left out. m x'' + k x' + k x = 0 from rest at .5 m. */
static void what_creeps_against_a_damper_is_followed(void)
{
    static const double values[3] = {1e5, 1e7, 1e9};
    for (int way = 0; way < 6; ++way) {
        const double k = values[way % 3], slow = 2.0 * k / (k + sqrt(k * k - 4.0 * k));
        const double fast = k - slow, t = 2.0;
        const double x = 0.5 * (fast * exp(-slow * t) - slow * exp(-fast * t)) / (fast - slow);
        char text[800];
        (void)snprintf(
            text, sizeof text,
            "se3d: 1\nparameters: {k: %g}\nbodies: [{name: a, mass: 1, "
            "inertia: [1, 1, 1], "
            "position: [0.5, 0, 0]}]\njoints: [{type: prismatic, body_i: ground, body_j: "
            "a, at: [0, 0, 0], axis: [1, 0, 0]}]\nforces: [{type: tsda, body_i: ground, "
            "body_j: a, point_i: [-2, 0, 0], k: k, c: k, l0: 2}]\n" TAIL,
            k);
        text_model m = text_model_open(text, way < 3 ? SE3D_METHOD_BDF : SE3D_METHOD_RADAU,
                                       SE3D_FORMULATION_ROMEGA, 0.0);
        double r[3];
        se3d_body body;
        CHECK(se3d_solver_run(m.solver, t) >= 0);
        CHECK(!se3d_system_get_body(m.system, 1, &body));
        CHECK(!se3d_body_get_position(m.system, body, r));
        CHECK_NEAR(r[0], x, 2e-7);
        text_model_close(&m);
    }
}

/* Three bars in a row; dampers so strong that the bars which they join do not turn against each
 * other, and springs. */
#define BARS                                                                                       \
    "gravity: [0, 0, -9.81]\n"                                                                     \
    "bodies:\n"                                                                                    \
    "  - {name: a, mass: 1, inertia: [0.001, 0.08, 0.08], position: [0.5, 0, 0]}\n"                \
    "  - {name: b, mass: 1, inertia: [0.001, 0.08, 0.08], position: [1.5, 0, 0]}\n"                \
    "  - {name: c, mass: 1, inertia: [0.001, 0.08, 0.08], position: [2.5, 0, 0]}\n"                \
    "joints:\n"                                                                                    \
    "  - {type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], axis: [0, 1, 0]}\n"            \
    "  - {type: revolute, body_i: b, body_j: c, at: [2, 0, 0], axis: [0, 1, 0]}\n"
#define HELD BARS "  - {type: fixed, body_i: a, body_j: b, at: [1, 0, 0]}\n" TAIL
#define TURNS                                                                                      \
    BARS "  - {name: q, type: revolute, body_i: a, body_j: b, at: [1, 0, 0], axis: [0, 1, 0]}\n"

static const struct bond {
    const char *name, *text;
    double value, rough; /* of accelerations */
    int32_t turns;       /* its direction does, which the one matrix of all stages does not know */
    int32_t reserved;
} bonds[] = {
    {"torsional damper", TURNS "forces: [{type: rsda, joint: q, c: k}]\n" TAIL, 1e8, 1e-3, 0, 0},
    {"torsional damper", TURNS "forces: [{type: rsda, joint: q, c: k}]\n" TAIL, 1e10, 1e-3, 0, 0},
    {"damper",
     TURNS "forces: [{type: tsda, body_i: a, body_j: b, point_i: [0.2, 0, 0.1], point_j: [-0.2, 0, "
           "0.1], c: k}]\n" TAIL,
     1e8, 1e-3, 1, 0},
    {"damper",
     TURNS "forces: [{type: tsda, body_i: a, body_j: b, point_i: [0.2, 0, 0.1], point_j: [-0.2, 0, "
           "0.1], c: k}]\n" TAIL,
     1e9, 1e-3, 1, 0},
    {"spring",
     TURNS "forces: [{type: tsda, body_i: a, body_j: b, point_i: [0.2, 0, 0.1], point_j: [-0.2, 0, "
           "0.1], k: k, l0: 0.6}]\n" TAIL,
     1e14, 1e-2, 1, 0},
    {"torsional spring", TURNS "forces: [{type: rsda, joint: q, k: k}]\n" TAIL, 1e13, 3e-2, 0, 0},
    {"torsional spring and damper", TURNS "forces: [{type: rsda, joint: q, k: k, c: k/1e4}]\n" TAIL,
     1e12, 1e-2, 0, 0},
};
enum { BONDS = sizeof bonds / sizeof *bonds, LOOKS = 7 };

typedef struct course {
    double acceleration[LOOKS][9], alpha[LOOKS][9], velocity[LOOKS][9];
    se3d_solver_stats stats;
    double balance; /* of the energy, largest [J] */
} course;

static void run_course(const char *text, const se3d_solver_def *def, course *p)
{
    se3d_model *model = NULL;
    se3d_model_error error = {0};
    se3d_solver *solver = NULL;
    CHECK(!se3d_model_read_text(text, strlen(text), "m.yaml", NULL, &model, &error));
    se3d_system *system = se3d_model_get_system(model);
    CHECK(!se3d_solver_create(system, def, &solver));
    p->balance = 0.0;
    for (int k = 0; k < LOOKS; ++k) {
        se3d_energy energy;
        se3d_work work;
        CHECK(se3d_solver_run(solver, 0.1 * (k + 1)) >= 0);
        for (size_t body = 0; body < 3; ++body) {
            se3d_body id;
            CHECK(!se3d_system_get_body(system, body + 1, &id));
            CHECK(!se3d_body_get_acceleration(system, id, p->acceleration[k] + 3 * body));
            CHECK(!se3d_body_get_angular_acceleration(system, id, p->alpha[k] + 3 * body));
            CHECK(!se3d_body_get_velocity(system, id, p->velocity[k] + 3 * body));
        }
        CHECK(!se3d_system_get_energy(system, &energy) && !se3d_system_get_work(system, &work));
        p->balance = fmax(p->balance, fabs(energy.total + work.dissipated - work.actuators));
    }
    CHECK(!se3d_solver_get_stats(solver, &p->stats));
    se3d_solver_destroy(solver);
    se3d_model_destroy(model);
}

static double apart(double a[LOOKS][9], double b[LOOKS][9])
{
    double gap = 0.0, size = 0.0;
    for (int k = 0; k < 9 * LOOKS; ++k) {
        gap = fmax(gap, fabs(a[k / 9][k % 9] - b[k / 9][k % 9]));
        size = fmax(size, fabs(b[k / 9][k % 9]));
    }
    return gap / size;
}

static void accelerations_are_those_of_the_motion_however_fast_a_force_is(void)
{
    static course got, truth;
    se3d_solver_def def = se3d_solver_def_default();
    def.method = SE3D_METHOD_DOP853;
    def.tolerance = 1e-11;
    run_course("se3d: 1\n" HELD, &def, &truth);
    def.method = SE3D_METHOD_RADAU;
    def.tolerance = 1e-6;
    for (size_t k = 0; k < BONDS; ++k) {
        const struct bond *bond = &bonds[k];
        char text[1800];
        (void)snprintf(text, sizeof text, "se3d: 1\nparameters: {k: %g}\n%s", bond->value,
                       bond->text);
        run_course(text, &def, &got);
        const double a =
            fmax(apart(got.acceleration, truth.acceleration), apart(got.alpha, truth.alpha));
        const double v = apart(got.velocity, truth.velocity);
        const double steps = (double)got.stats.steps, rejected = (double)got.stats.rejected;
        printf("%s of %g: v %.1e, a %.1e, energy %.1e J, %g steps, %g rejected\n", bond->name,
               bond->value, v, a, got.balance - truth.balance, steps, rejected);
        CHECK(v < 1e-5 && a < bond->rough);
        CHECK_NEAR(got.balance, truth.balance, 1e-4);
        CHECK(rejected < 0.3 * steps && steps < (bond->turns ? 600.0 : 200.0));
    }
}

/* A bar held by an element that its weight has just been laid on. */
#define LAID                                                                                       \
    "gravity: [0, 0, -9.81]\n"                                                                     \
    "bodies: [{name: a, mass: 2, inertia: [0.02, 0.02, 0.02], position: [1, 0, 0]}]\n"
#define LAID_PIN                                                                                   \
    LAID "joints: [{name: q, type: revolute, body_i: ground, body_j: a, at: [0, 0, 0], "           \
         "axis: [0, 1, 0]}]\n"
#define SHOWN(channel)                                                                             \
    "analysis: {type: dynamics, duration: 1}\n"                                                    \
    "output: [{file: a.csv, every: 0.1, channels: [" channel "]}]\n"

static const struct laid {
    const char *name, *text;
    double force;
    size_t part;
} laid[] = {
    {"tsda",
     LAID_PIN "forces: [{name: s, type: tsda, body_i: ground, body_j: a, at: [0, 0, 1], at_2: "
              "[1, 0, 0], k: k, l0: sqrt(2)}]\n" SHOWN("s.force"),
     27.746869895772, 0},
    {"rsda", LAID_PIN "forces: [{name: s, type: rsda, joint: q, k: k}]\n" SHOWN("s.torque"), 19.62,
     0},
    {"bushing",
     LAID "forces: [{name: s, type: bushing, body_i: ground, body_j: a, at: [0, 0, 0], K: [k, k, "
          "k, k, k, k]}]\n" SHOWN("s.force"),
     19.62, 2},
};

/* @return how far it is off the weight between steps, at most, in rows of a tenth of a second
 * [N, N m] */
static double weigh(const struct laid *l, double k, int32_t method, int32_t formulation,
                    int32_t shown, int rows)
{
    char text[1500];
    double off = 0.0;
    (void)snprintf(text, sizeof text, "se3d: 1\nparameters: {k: %g}\n%s", k, l->text);
    text_model m = text_model_open(text, method, formulation, 0.0);
    CHECK(!se3d_solver_set_shown(m.solver, shown));
    for (int row = 0; row < rows; ++row) {
        CHECK(text_model_run(&m, 0.2 + 0.1 * row));
        off = fmax(off, fabs(fabs(text_model_get(&m, 0, l->part)) - l->force));
    }
    text_model_close(&m);
    return off;
}

/* The force of an element is its stiffness times what positions are off by: between steps, too, it
 * is the weight, or, if it still swings about that, no more than twice. */
static void forces_between_steps_of_the_newmark_family_are_those_of_the_motion(void)
{
    static const int32_t methods[] = {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_METHOD_HHT};
    static const int32_t formulations[] = {SE3D_FORMULATION_ROMEGA, SE3D_FORMULATION_RP};
    for (size_t k = 0; k < sizeof laid / sizeof *laid; ++k) {
        for (int way = 0; way < 32; ++way) {
            const int32_t method = methods[way % 2], formulation = formulations[way / 2 % 2];
            const int32_t shown = way / 4 % 2 ? SE3D_SHOWN_MOTION : SE3D_SHOWN_ALL;
            const double stiffness = pow(10.0, 9 + 2 * (way / 8));
            const int swings = stiffness < 1e13;
            if (swings && (way % 8 != (int)k || (!check_is_long() && way / 8 != (int)k % 2))) {
                continue; /* small steps: seconds each */
            }
            const double most = swings ? 1.1 * laid[k].force : 1e-2 + 1e-15 * stiffness;
            const double off =
                weigh(&laid[k], stiffness, method, formulation, shown, swings ? 3 : 9);
            CHECK(off <= most);
            if (!(off <= most) || getenv("SE3D_SHOW")) {
                fprintf(stderr, "%s of %g by %s, formulation %d, shown %d: off by %.2g\n",
                        laid[k].name, stiffness, se3d_method_get_name(method), (int)formulation,
                        (int)shown, off);
            }
        }
    }
}

int main(void)
{
    RUN(forces_between_steps_of_the_newmark_family_are_those_of_the_motion);
    RUN(accelerations_are_those_of_the_motion_however_fast_a_force_is);
    RUN(bushings_with_dampers_are_as_good_as_joints);
    RUN(vibrations_that_make_steps_short_are_named);
    RUN(no_tyre_is_named_as_a_vibration);
    RUN(what_creeps_against_a_damper_is_followed);
    RUN(states_within_steps_of_radau_do_not_feel_what_the_spring_is_off_by);
    RUN(chosen_steps_of_the_newmark_family_are_those_of_the_slow_motion);
    RUN(equal_steps_of_the_newmark_family_follow_the_slow_motion);
    return check_finish();
}
