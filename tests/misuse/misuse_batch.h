/* SPDX-License-Identifier: BSD-3-Clause */
/* Misuse of batches, which record their own errors. */
#ifndef SE3D_TESTS_MISUSE_BATCH_H
#define SE3D_TESTS_MISUSE_BATCH_H

#include "misuse/misuse_world.h"

/* `call` on the batch `b` fails with `status`, and a message that contains `part` says why. */
#define BATCH_REJECTS(call, status, part)                                                          \
    do {                                                                                           \
        CHECK((call) == (status));                                                                 \
        CHECK_CONTAINS(se3d_batch_get_error(b), part);                                             \
    } while (0)

static void no_batch_is_no_batch(double *x, int32_t *status)
{
    const se3d_body none = {0, 0};
    CHECK(se3d_batch_count(NULL) == 0 && se3d_batch_count_positions(NULL) == 0 &&
          se3d_batch_count_velocities(NULL) == 0 && se3d_batch_count_lanes(NULL) == 0 &&
          se3d_batch_count_single_forces(NULL) == 0);
    CHECK(se3d_batch_get_error(NULL)[0] != '\0');
    CHECK(se3d_batch_set_state(NULL, 0, 1, x, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_get_state(NULL, 0, 1, x, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_set_time(NULL, 0, 1, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_get_time(NULL, 0, 1, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_set_efforts(NULL, 0, 1, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_set_gravity(NULL, 0, 1, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_set_mass(NULL, none, 0, 1, x, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_step(NULL, SE3D_METHOD_RK4, 0.1, 1) == SE3D_ERR_NULL);
    CHECK(se3d_batch_get_status(NULL, 0, 1, status) == SE3D_ERR_NULL);
    CHECK(se3d_batch_compute_accelerations(NULL, x) == SE3D_ERR_NULL);
    CHECK(se3d_batch_compute_efforts(NULL, x, x) == SE3D_ERR_NULL);
    se3d_batch_destroy(NULL);
}

static void batch_numbers_are_checked(se3d_batch *b, se3d_body ball, const double *state)
{
    const double nan = (double)NAN, inertia[6] = {1.0, 1.0, 1.0}, minus = -1.0, one = 1.0;
    double q[21], x[18] = {0.0};
    memcpy(q, state, sizeof q);
    BATCH_REJECTS(se3d_batch_set_state(b, 3, 1, q, x), SE3D_ERR_INVALID_ARGUMENT, "3 states");
    BATCH_REJECTS(se3d_batch_set_state(b, 1, SIZE_MAX, q, x), SE3D_ERR_INVALID_ARGUMENT, "count");
    q[8] = nan;
    BATCH_REJECTS(se3d_batch_set_state(b, 1, 2, q, x), SE3D_ERR_NOT_FINITE, "q[1] of state 2");
    memcpy(q, state, sizeof q);
    memset(q + 10, 0, 4 * sizeof *q);
    BATCH_REJECTS(se3d_batch_set_state(b, 0, 3, q, x), SE3D_ERR_INVALID_ARGUMENT,
                  "of state 1 are a quaternion of length 0");
    x[7] = nan;
    BATCH_REJECTS(se3d_batch_set_state(b, 0, 2, NULL, x), SE3D_ERR_NOT_FINITE, "qdot[1]");
    BATCH_REJECTS(se3d_batch_set_efforts(b, 0, 2, x), SE3D_ERR_NOT_FINITE, "effort[1] of state 1");
    BATCH_REJECTS(se3d_batch_set_gravity(b, 0, 3, x), SE3D_ERR_NOT_FINITE, "gravity[1] of state 2");
    BATCH_REJECTS(se3d_batch_set_time(b, 2, 1, &nan), SE3D_ERR_NOT_FINITE, "time[0] of state 2");
    BATCH_REJECTS(se3d_batch_compute_efforts(b, x, x), SE3D_ERR_NOT_FINITE, "qddot[1] of state 1");
    BATCH_REJECTS(se3d_batch_set_mass(b, ball, 0, 1, &minus, inertia), SE3D_ERR_INVALID_ARGUMENT,
                  "mass = -1 kg");
    BATCH_REJECTS(se3d_batch_set_mass(b, ball, 0, 1, &one, q + 10), SE3D_ERR_INVALID_ARGUMENT,
                  "inertia has principal moments");
}

static void batch_pointers_are_checked(se3d_batch *b, se3d_body ball)
{
    const double one = 1.0;
    se3d_body stale = ball;
    double x[7];
    stale.generation ^= 1;
    BATCH_REJECTS(se3d_batch_set_efforts(b, 0, 1, NULL), SE3D_ERR_NULL, "effort");
    BATCH_REJECTS(se3d_batch_set_gravity(b, 0, 1, NULL), SE3D_ERR_NULL, "gravity");
    BATCH_REJECTS(se3d_batch_set_time(b, 0, 1, NULL), SE3D_ERR_NULL, "time");
    BATCH_REJECTS(se3d_batch_set_mass(b, ball, 0, 1, NULL, x), SE3D_ERR_NULL, "mass");
    BATCH_REJECTS(se3d_batch_set_mass(b, ball, 0, 1, &one, NULL), SE3D_ERR_NULL, "inertia");
    BATCH_REJECTS(se3d_batch_set_mass(b, stale, 0, 1, &one, x), SE3D_ERR_STALE_HANDLE, "body");
    BATCH_REJECTS(se3d_batch_compute_accelerations(b, NULL), SE3D_ERR_NULL, "qddot");
    BATCH_REJECTS(se3d_batch_compute_efforts(b, NULL, NULL), SE3D_ERR_NULL, "effort");
    CHECK(se3d_batch_get_time(b, 0, 1, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_batch_get_status(b, 0, 1, NULL) == SE3D_ERR_NULL);
    CHECK(se3d_batch_get_time(b, 2, 2, x) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_batch_get_state(b, 4, 0, x, NULL) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(!se3d_batch_get_state(b, 3, 0, x, NULL) && !se3d_batch_get_state(b, 0, 1, NULL, NULL));
}

static void batch_steps_are_checked(se3d_batch *b)
{
    BATCH_REJECTS(se3d_batch_step(b, (se3d_method)1000, 0.1, 1), SE3D_ERR_UNSUPPORTED, "method = ");
    BATCH_REJECTS(se3d_batch_step(b, SE3D_METHOD_RK4, 0.0, 1), SE3D_ERR_INVALID_ARGUMENT,
                  "step = 0 s");
    BATCH_REJECTS(se3d_batch_step(b, SE3D_METHOD_RK4, (double)NAN, 1), SE3D_ERR_INVALID_ARGUMENT,
                  "step = ");
    BATCH_REJECTS(se3d_batch_step(b, SE3D_METHOD_RK4, (double)INFINITY, 1),
                  SE3D_ERR_INVALID_ARGUMENT, "step = inf");
}

/* Three free balls. */
static se3d_status batch_rejects_misuse(arguments *a)
{
    se3d_system *system = NULL;
    se3d_batch *b = NULL;
    se3d_body ball = {0, 0}, ground = {0, 0};
    se3d_body_def def = body_def("ball");
    double q[21], other[21], x[18], mass = 1.0, inertia[6] = {1.0, 1.0, 1.0};
    int32_t status[3];
    no_batch_is_no_batch(q, status);
    CHECK(se3d_batch_create(NULL, 1, 1, &b) == SE3D_ERR_NULL && !b);
    CHECK(se3d_batch_create(a->system, 1, 1, NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_system_create(NULL, &system) && !se3d_body_create(system, &def, &ball));
    CHECK(!se3d_system_get_ground(system, &ground));
    CHECK(se3d_batch_create(system, 0, 1, &b) == SE3D_ERR_INVALID_ARGUMENT && !b);
    CHECK_CONTAINS(se3d_system_get_error(system), "count = 0");
    CHECK(se3d_batch_create(system, 1, 0, &b) == SE3D_ERR_INVALID_ARGUMENT && !b);
    CHECK_CONTAINS(se3d_system_get_error(system), "threads = 0");
    CHECK(se3d_batch_create(system, 1, 1025, &b) == SE3D_ERR_INVALID_ARGUMENT && !b);
    CHECK(se3d_batch_create(system, SIZE_MAX / 2, 1, &b) == SE3D_ERR_NO_MEMORY && !b);
    CHECK(!se3d_batch_create(system, 3, 1, &b));
    se3d_system_destroy(system);
    CHECK(se3d_batch_count(b) == 3 && se3d_batch_count_positions(b) == 7 &&
          se3d_batch_count_velocities(b) == 6 && se3d_batch_count_lanes(b) >= 1);
    CHECK(!se3d_batch_get_state(b, 0, 3, q, x));
    batch_numbers_are_checked(b, ball, q);
    batch_pointers_are_checked(b, ball);
    batch_steps_are_checked(b);
    BATCH_REJECTS(se3d_batch_set_mass(b, ground, 0, 1, &mass, inertia), SE3D_ERR_INVALID_ARGUMENT,
                  "fixed");
    CHECK(!se3d_batch_get_state(b, 0, 3, other, x) && memcmp(q, other, sizeof q) == 0);
    CHECK(!se3d_batch_get_status(b, 0, 3, status) && status[0] == SE3D_OK);
    se3d_batch_destroy(b);
    return SE3D_OK;
}

#endif
