/* SPDX-License-Identifier: BSD-3-Clause */
/* Two drivers of one coordinate, or a driver of what a joint locks: what contradicts is told when
 * it does, by names, in all formulations; what agrees is redundant. */
#include "support/text_model.h"

#include "se3d/check.h"

typedef struct twice {
    const char *speed;   /* of the body at the start [rad/s] */
    const char *drivers; /* and what more there is of joints */
    const char *said;    /* NULL: they agree, */
    const char *named;   /* and this is named as redundant */
    double latest;       /* when it is told [s] */
} twice;

#define LOCK       "  - {name: lock, type: fixed, body_i: ground, body_j: roll, at: [0, 0, 0]}\n"
#define PAIR(a, b) "drivers:\n  - {name: a, joint: pin, " a "}\n  - {name: b, joint: pin, " b "}\n"
#define BOTH       "a and b drive the angle of pin"

static const twice cases[] = {
    {"6", PAIR("value: 6*t", "rate: servo.value"), BOTH, NULL, 0.0},
    {"0", PAIR("value: t^2", "rate: servo.value"), BOTH, NULL, 0.0},
    {"0", PAIR("rate: servo.value", "rate: 2*servo.value"), BOTH, NULL, 0.0},
    {"0", PAIR("value: 2.5*t^2", "rate: servo.value"), BOTH, NULL, 0.01},
    {"0", PAIR("rate: servo.value", "rate: quick.value/2"), BOTH, NULL, 0.01},
    {"0", PAIR("value: 2.5*t^2", "value: 2.5*t^2 + t^3"), BOTH, NULL, 0.0},
    {"0", PAIR("value: 0", "value: \"max(t - 0.3, 0)^4\""), BOTH, NULL, 0.0},
    {"0", PAIR("value: shaft.angle", "rate: servo.value"), BOTH, NULL, 0.0},
    {"0", "drivers:\n  - {name: a, joint: pin, rate: servo.value}\n", "lock.dp1_c", NULL, 0.0},
    {"0", PAIR("rate: servo.value", "rate: servo.value"), NULL, "b.angle duplicates a.angle", 0.0},
    {"0", PAIR("value: t^2", "value: t^2"), NULL, "b.angle duplicates a.angle", 0.0},
    {"0", PAIR("value: t^2", "rate: shaft.rate"), NULL, "b.angle duplicates", 0.0}};

enum { CASES = sizeof cases / sizeof *cases, LOCKED = 8 };

static void write(size_t k, char *text, size_t size)
{
    snprintf(
        text, size,
        "se3d: 1\nbodies:\n"
        "  - {name: roll, mass: 2, inertia: [0.01, 0.01, 0.02], angular_velocity: [0, 0, %s]}\n"
        "  - {name: other, mass: 2, inertia: [0.01, 0.01, 0.02], position: [1, 0, 0]}\n"
        "joints:\n"
        "  - {name: pin, type: revolute, body_i: ground, body_j: roll, at: [0, 0, 0], "
        "axis: [0, 0, 1]}\n"
        "  - {name: shaft, type: revolute, body_i: ground, body_j: other, at: [1, 0, 0], "
        "axis: [0, 0, 1]}\n%s%s"
        "  - {name: c, joint: shaft, value: t^2}\n"
        "states:\n  - {name: servo, type: lag, time_constant: 0.2, input: 1}\n"
        "  - {name: quick, type: lag, time_constant: 0.1, input: 1}\n"
        "analysis: {type: dynamics, duration: 0.5, tolerance: 1e-8, steps_max: 2000}\n"
        "output: [{file: r.csv, channels: [pin.angle]}]\n",
        cases[k].speed, k == LOCKED ? LOCK : "", cases[k].drivers);
}

static int is_told(const text_model *m, const char *what)
{
    se3d_check *check = NULL;
    int told = 0;
    CHECK(se3d_check_create(m->system, &check) >= 0);
    for (size_t k = 0; k < se3d_check_count_messages(check); ++k) {
        const char *text;
        CHECK(!se3d_check_get_message(check, k, &text));
        told = told || strstr(text, what) != NULL;
    }
    se3d_check_destroy(check);
    return told;
}

static void contradictions_are_told_when_they_begin(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU, SE3D_METHOD_BDF};
    for (size_t k = 0; k < CASES; ++k) {
        char text[3000];
        write(k, text, sizeof text);
        for (int32_t way = 0; way < 9; ++way) {
            text_model m = text_model_open(text, methods[way / 3], way % 3, 0.0);
            const se3d_status status = se3d_solver_run(m.solver, 0.5);
            const char *message = se3d_system_get_error(m.system);
            double t;
            CHECK(!se3d_system_get_time(m.system, &t));
            if (cases[k].said) {
                CHECK(status == SE3D_ERR_INCONSISTENT);
                CHECK_CONTAINS(message, cases[k].said);
                CHECK(t <= cases[k].latest);
            } else {
                CHECK(status == SE3D_INFO_REDUNDANT);
                CHECK(is_told(&m, cases[k].named));
            }
            if (status >= 0 ? cases[k].said != NULL : !cases[k].said) {
                fprintf(stderr, "case %d, way %d: %d %s\n", (int)k, (int)way, (int)status, message);
            }
            text_model_close(&m);
        }
    }
}

/* What parts at the start is inconsistent for the check, too. */
static void the_check_compares_accelerations(void)
{
    static const size_t parting[] = {0, 1, 2, LOCKED};
    for (size_t k = 0; k < sizeof parting / sizeof *parting; ++k) {
        char text[3000];
        write(parting[k], text, sizeof text);
        text_model m = text_model_open(text, -1, -1, 0.0);
        CHECK(is_told(&m, " contradicts "));
        text_model_close(&m);
    }
}

enum { PARTING = 6 }; /* at 0.3 s */

/* Runs are refused for what would happen in them, be there a horizon or not. */
static void what_parts_after_a_run_does_not_end_it(void)
{
    static const int32_t analyses[] = {SE3D_ANALYSIS_DYNAMICS, SE3D_ANALYSIS_KINEMATICS};
    char text[3000];
    write(PARTING, text, sizeof text);
    for (int k = 0; k < 4; ++k) {
        text_model m = text_model_open(text, -1, -1, 0.0);
        se3d_solver *solver;
        se3d_solver_def def = se3d_solver_def_default();
        def.analysis = analyses[k % 2];
        def.horizon = k < 2 ? 0.5 : 0.0;
        CHECK(!se3d_solver_create(m.system, &def, &solver));
        for (int step = 1; step <= 15; ++step) {
            CHECK(se3d_solver_run(solver, 0.02 * step) == SE3D_INFO_REDUNDANT);
        }
        CHECK(se3d_solver_run(solver, 0.5) == SE3D_ERR_INCONSISTENT);
        CHECK_CONTAINS(se3d_system_get_error(m.system), BOTH);
        se3d_solver_destroy(solver);
        text_model_close(&m);
    }
}

int main(void)
{
    RUN(contradictions_are_told_when_they_begin);
    RUN(the_check_compares_accelerations);
    RUN(what_parts_after_a_run_does_not_end_it);
    return check_finish();
}
