/* SPDX-License-Identifier: BSD-3-Clause */
/* A host that is recorded by test_recording.sh: what it does is its first word. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "record.h"
#include "se3d/io.h"
#include "se3d/se3d.h"

#define CHECK(condition)                                                                           \
    do {                                                                                           \
        if (!(condition)) {                                                                        \
            fprintf(stderr, "host: line %d: %s\n", __LINE__, #condition);                          \
            exit(3);                                                                               \
        }                                                                                          \
    } while (0)
#define OK(call) CHECK((call) == SE3D_OK)

typedef struct host {
    int crosses;
    se3d_body bar;
    const char *action;
} host;

static se3d_status height(void *ctx, const se3d_system *system, double *value)
{
    double r[3] = {0.0, 0.0, 0.0};
    const host *h = ctx;
    const se3d_status status = se3d_body_get_position(system, h->bar, r);
    *value = r[2];
    return status;
}

/* Reads, sets, and tries what is not allowed, all from within. */
static se3d_status crossed(void *ctx, se3d_system *system, const se3d_event_record *record)
{
    host *h = ctx;
    const double gravity[3] = {0.0, 0.0, -9.0 - ++h->crosses};
    CHECK(record->event.index1 > 0);
    if (strcmp(h->action, "crash") == 0) {
        abort();
    }
    CHECK(se3d_body_destroy(system, h->bar) == SE3D_ERR_STATE);
    se3d_system_destroy(system); /* refused */
    return se3d_system_set_gravity(system, gravity);
}

static void swing(const char *action, double length)
{
    host h = {.action = action};
    se3d_system *system = NULL;
    se3d_solver *solver = NULL;
    se3d_constraint pin;
    se3d_event event;
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_solver_def def = se3d_solver_def_default();
    se3d_event_def watch = se3d_event_def_default();
    const double at[3] = {0.0, 0.0, 0.0}, axis[3] = {0.0, 1.0, 0.0};
    OK(se3d_system_create(NULL, &system));
    body.name = "bar";
    body.mass = 1.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.1;
    body.position[0] = length;
    OK(se3d_body_create(system, &body, &h.bar));
    OK(se3d_system_get_ground(system, &joint.body_i));
    joint.body_j = h.bar;
    OK(se3d_joint_def_set_frame(system, &joint, at, axis, NULL));
    OK(se3d_joint_create_revolute(system, &joint, &pin));
    def.step = 1e-3;
    OK(se3d_solver_create(system, &def, &solver));
    watch.name = "low";
    watch.value = height;
    watch.callback = crossed;
    watch.ctx = watch.callback_ctx = &h;
    watch.level = -0.5 * length;
    OK(se3d_event_create(solver, &watch, &event));
    OK(se3d_solver_run(solver, 1.0));
    CHECK(h.crosses > 0);
    se3d_solver_destroy(solver);
    se3d_system_destroy(system);
}

static void *swing_apart(void *length)
{
    swing("threads", *(const double *)length);
    return NULL;
}

static void swing_in_threads(void)
{
    pthread_t threads[2];
    double lengths[2] = {0.5, 0.8};
    for (int k = 0; k < 2; ++k) {
        CHECK(pthread_create(&threads[k], NULL, swing_apart, &lengths[k]) == 0);
    }
    for (int k = 0; k < 2; ++k) {
        CHECK(pthread_join(threads[k], NULL) == 0);
    }
}

static void run_model(const char *path, const char *folder)
{
    se3d_model *model = NULL;
    se3d_run *run = NULL;
    se3d_run_options options = se3d_run_options_default();
    se3d_model_error error;
    OK(se3d_model_read_file(path, NULL, &model, &error));
    options.directory = folder;
    CHECK(se3d_model_run(model, &options, &run, &error) >= 0);
    se3d_run_destroy(run);
    se3d_model_destroy(model);
}

int main(int count, char **words)
{
    const char *action = count > 1 ? words[1] : "swing";
#if defined(HOST_IS_LINKED)
    CHECK(count > 2 && se3d_record_begin(words[2]) == 0);
    CHECK(se3d_record_begin("/dev/null") != 0);
#endif
    if (strcmp(action, "model") == 0) {
        CHECK(count > 3);
        run_model(words[2], words[3]);
    } else if (strcmp(action, "threads") == 0) {
        swing_in_threads();
    } else {
        swing(action, 0.5);
    }
#if defined(HOST_IS_LINKED)
    CHECK(se3d_record_end() == 0);
    CHECK(se3d_record_end() != 0);
#endif
    return 0;
}
