/* SPDX-License-Identifier: BSD-3-Clause */
/* A solver that is continued from bytes in another program goes on as the one that was there: with
 * its events, their records and its counters; bytes that are damaged, foreign or made up are
 * refused or do no harm. */
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "check.h"
#include "support/damage.h"
#include "support/models.h"
#include "support/text_model.h"

enum { ROOM = 40000, EVENTS = 3 };

typedef struct world {
    support_model model;
    se3d_solver *solver;
    unsigned char state[ROOM], bytes[ROOM];
    size_t state_size, size;
} world;

/* Heights of the first body: it passes them, comes back to them, begins at one. */
static se3d_status height(void *ctx, const se3d_system *system, double *value)
{
    const support_model *model = ctx;
    double r[3];
    const se3d_status status = se3d_body_get_position(system, model->bodies[0], r);
    *value = r[0] + r[2];
    return status;
}

static void open_world(world *w, const char *name, int32_t analysis, int32_t method, int events)
{
    se3d_solver_def def = se3d_solver_def_default();
    double begin = 0.0;
    support_model_make(&w->model, name, 1);
    CHECK(!height(&w->model, w->model.system, &begin));
    def.method = method;
    def.analysis = analysis;
    def.tolerance = 1e-6;
    CHECK(!se3d_solver_create(w->model.system, &def, &w->solver));
    for (int k = 0; k < events; ++k) {
        se3d_event_def event = se3d_event_def_default();
        se3d_event made;
        event.value = height;
        event.ctx = &w->model;
        event.level = begin - 0.02 * k;
        event.name = k == 1 ? "one" : NULL;
        CHECK(!se3d_event_create(w->solver, &event, &made));
    }
}

static void close_world(world *w)
{
    se3d_solver_destroy(w->solver);
    support_model_destroy(&w->model);
}

static void write_world(world *w)
{
    se3d_snapshot *snapshot = NULL;
    CHECK(!se3d_snapshot_create(w->model.system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, w->state, ROOM, &w->state_size));
    se3d_snapshot_destroy(snapshot);
    CHECK(!se3d_solver_write(w->solver, NULL, 0, &w->size));
    CHECK(se3d_solver_write(w->solver, w->bytes, w->size - 1, &w->size) ==
          SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_solver_write(w->solver, w->bytes, ROOM, &w->size));
}

static void restore_state(world *to, const world *from)
{
    se3d_snapshot *snapshot = NULL;
    CHECK(!se3d_snapshot_read(to->model.system, from->state, from->state_size, &snapshot));
    CHECK(!se3d_snapshot_restore(snapshot, to->model.system));
    se3d_snapshot_destroy(snapshot);
}

/* What both have become, in one number. */
static uint64_t hash_world(world *w)
{
    se3d_solver_stats stats;
    uint64_t hash = se3d_system_hash(w->model.system);
    CHECK(!se3d_solver_get_stats(w->solver, &stats));
    hash = se3di_hash_bytes(hash, &stats, sizeof stats);
    for (size_t k = 0; k < se3d_solver_count_event_records(w->solver); ++k) {
        se3d_event_record record;
        CHECK(!se3d_solver_get_event_record(w->solver, k, &record));
        hash = se3di_hash_bytes(hash, record.name, strlen(record.name) + 1);
        hash = se3di_hash_bytes(hash, &record.time, sizeof record.time);
        hash = se3di_hash_bytes(hash, &record.value, sizeof record.value);
        hash = se3di_hash_bytes(hash, &record.direction, sizeof record.direction);
    }
    return hash;
}

static void check_course(const char *name, int32_t analysis, int32_t method, double time)
{
    static world w, other;
    open_world(&w, name, analysis, method, EVENTS);
    CHECK(se3d_solver_run(w.solver, time) >= 0);
    write_world(&w);
    open_world(&other, name, analysis, method, EVENTS);
    restore_state(&other, &w);
    CHECK(!se3d_solver_read(other.solver, w.bytes, w.size));
    CHECK(hash_world(&w) == hash_world(&other));
    for (int k = 1; k < 5; ++k) {
        CHECK(se3d_solver_run(w.solver, time + 0.11 * k) >= 0);
        CHECK(se3d_solver_run(other.solver, time + 0.11 * k) >= 0);
        CHECK(hash_world(&w) == hash_world(&other));
    }
    CHECK(analysis != SE3D_ANALYSIS_DYNAMICS || se3d_solver_count_event_records(w.solver) > 0);
    close_world(&w);
    close_world(&other);
}

static void another_program_goes_on_as_if_it_had_run_from_the_beginning(void)
{
    static const int32_t methods[] = {SE3D_METHOD_AUTO,
                                      SE3D_METHOD_DOP853,
                                      SE3D_METHOD_BDF,
                                      SE3D_METHOD_RADAU,
                                      SE3D_METHOD_GENERALIZED_ALPHA,
                                      SE3D_METHOD_RATTLE,
                                      SE3D_METHOD_VERLET,
                                      SE3D_METHOD_GAUSS};
    static const double times[] = {0.0, 0.0317, 0.2};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
        for (int t = 0; t < 3; ++t) {
            check_course("double_pendulum", SE3D_ANALYSIS_DYNAMICS, methods[k], times[t]);
        }
    }
    for (int t = 0; t < 3; ++t) {
        check_course("four_bar", SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_AUTO, times[t]);
    }
}

/* A bar on a rail and a hinge, the one or the other driven. */
static text_model open_driven(const char *driver, int32_t method, int32_t formulation)
{
    char text[1500];
    snprintf(text, sizeof text,
             "se3d: 1\nbodies:\n"
             "  - {name: car, mass: 2, inertia: [0.01, 0.01, 0.02]}\n"
             "  - {name: bar, mass: 1, inertia: [0.01, 0.1, 0.1], position: [0.5, 0, 0]}\n"
             "joints:\n"
             "  - {name: rail, type: cylindrical, body_i: ground, body_j: car, at: [0, 0, 0], "
             "axis: [1, 0, 0]}\n"
             "  - {name: pin, type: revolute, body_i: car, body_j: bar, at: [0, 0, 0], "
             "axis: [0, 1, 0]}\n"
             "states:\n  - {name: servo, type: lag, time_constant: 0.2, input: sin(9*t)}\n"
             "drivers:\n  - {name: motor, joint: rail, %s}\n"
             "analysis: {type: dynamics, duration: 1, tolerance: 1e-7}\n",
             driver);
    return text_model_open(text, method, formulation, 0.0);
}

static void hand_over(const text_model *from, const text_model *to, se3d_status wanted)
{
    static unsigned char state[ROOM], bytes[ROOM];
    size_t state_size, size;
    se3d_snapshot *snapshot = NULL;
    CHECK(!se3d_snapshot_create(from->system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, state, ROOM, &state_size));
    CHECK(!se3d_solver_write(from->solver, bytes, ROOM, &size));
    se3d_snapshot_destroy(snapshot);
    CHECK(se3d_snapshot_read(to->system, state, state_size, &snapshot) == wanted);
    if (!wanted) {
        CHECK(!se3d_snapshot_restore(snapshot, to->system));
        CHECK(!se3d_solver_read(to->solver, bytes, size));
    }
    se3d_snapshot_destroy(snapshot);
}

#define RATE "rate: 0.4*servo.value + 0.1*pin.rate, coordinate: displacement"

/* The coordinate is the integral of its rate over the whole past. */
static void what_a_rate_drives_goes_on(void)
{
    static const int32_t methods[] = {SE3D_METHOD_DOP853, SE3D_METHOD_RADAU, SE3D_METHOD_BDF,
                                      SE3D_METHOD_GAUSS};
    for (int32_t k = 0; k < 12; ++k) {
        text_model m = open_driven(RATE, methods[k % 4], k / 4);
        text_model other = open_driven(RATE, methods[k % 4], k / 4);
        CHECK(text_model_run(&m, 0.2));
        hand_over(&m, &other, SE3D_OK);
        CHECK(se3d_system_hash(m.system) == se3d_system_hash(other.system));
        CHECK(text_model_run(&m, 0.5) && text_model_run(&other, 0.5));
        CHECK(se3d_system_hash(m.system) == se3d_system_hash(other.system));
        text_model_close(&m);
        text_model_close(&other);
    }
}

/* As many drivers of the same bodies, of other coordinates or by their values. */
static void another_driver_is_another_model(void)
{
    static const char *const others[] = {"value: 0.1*t, coordinate: displacement",
                                         "rate: servo.value, coordinate: angle"};
    text_model m = open_driven("rate: servo.value, coordinate: displacement", -1, -1);
    CHECK(text_model_run(&m, 0.1));
    for (int k = 0; k < 2; ++k) {
        text_model other = open_driven(others[k], -1, -1);
        CHECK(text_model_run(&other, 0.1));
        hand_over(&m, &other, SE3D_ERR_STATE);
        hand_over(&other, &m, SE3D_ERR_STATE);
        text_model_close(&other);
    }
    text_model_close(&m);
}

static void sign(unsigned char *bytes, size_t size)
{
    const uint64_t sum = se3di_hash_bytes(SE3DI_HASH_START, bytes, size - 8);
    for (int k = 0; k < 8; ++k) {
        bytes[size - 8 + (size_t)k] = (unsigned char)(sum >> (8 * k));
    }
}

static void damaged_and_foreign_bytes_are_refused(void)
{
    static world w, other;
    static unsigned char bytes[ROOM];
    open_world(&w, "double_pendulum", SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_AUTO, EVENTS);
    CHECK(se3d_solver_run(w.solver, 0.3) >= 0);
    write_world(&w);
    for (size_t k = 0; k < w.size; ++k) {
        memcpy(bytes, w.bytes, w.size);
        CHECK(se3d_solver_read(w.solver, bytes, k) == SE3D_ERR_INVALID_ARGUMENT);
        bytes[k] ^= 0x20;
        CHECK(se3d_solver_read(w.solver, bytes, w.size) == SE3D_ERR_INVALID_ARGUMENT);
    }
    open_world(&other, "double_pendulum", SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_AUTO, 1);
    CHECK(se3d_solver_read(other.solver, w.bytes, w.size) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(strstr(se3d_system_get_error(other.model.system), "other events") != NULL);
    CHECK(se3d_solver_run(other.solver, 0.1) >= 0); /* it is as new */
    close_world(&other);
    open_world(&other, "four_bar", SE3D_ANALYSIS_ASSEMBLY, SE3D_METHOD_AUTO, 0);
    CHECK(se3d_solver_read(other.solver, w.bytes, w.size) == SE3D_ERR_STATE);
    close_world(&other);
    close_world(&w);
}

static void made_up_words_do_no_harm(void)
{
    static world w;
    static unsigned char bytes[ROOM];
    size_t taken = 0, refused = 0;
    open_world(&w, "double_pendulum", SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_AUTO, EVENTS);
    CHECK(se3d_solver_run(w.solver, 0.3) >= 0);
    write_world(&w);
    for (size_t at = 16; at + 16 <= w.size; at += 8) {
        for (size_t n = 0; n < DAMAGE_WORDS; ++n) {
            memcpy(bytes, w.bytes, w.size);
            damage_write(bytes, at, damage_words[n]);
            sign(bytes, w.size);
            restore_state(&w, &w);
            const se3d_status status = se3d_solver_read(w.solver, bytes, w.size);
            taken += status >= 0;
            refused += status < 0;
            (void)se3d_solver_run(w.solver, 0.301);
        }
    }
    CHECK(taken > 100 && refused > 50);
    close_world(&w);
}

int main(void)
{
    RUN(another_program_goes_on_as_if_it_had_run_from_the_beginning);
    RUN(damaged_and_foreign_bytes_are_refused);
    RUN(what_a_rate_drives_goes_on);
    RUN(another_driver_is_another_model);
    RUN(made_up_words_do_no_harm);
    return check_finish();
}
