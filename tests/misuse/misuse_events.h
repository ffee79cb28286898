/* SPDX-License-Identifier: BSD-3-Clause */
/* Misuse of events. */
#ifndef SE3D_TESTS_MISUSE_EVENTS_H
#define SE3D_TESTS_MISUSE_EVENTS_H

#include "misuse/misuse_particles.h"

static se3d_status zero_value(void *ctx, const se3d_system *system, double *value)
{
    (void)system;
    *value = ctx ? (double)NAN : 0.0;
    return SE3D_OK;
}

static se3d_status failing_value(void *ctx, const se3d_system *system, double *value)
{
    (void)ctx, (void)system;
    *value = 0.0;
    return SE3D_ERR_STATE;
}

static void event_definitions_are_checked(arguments *a, se3d_solver *solver)
{
    se3d_event event = {7, 7};
    se3d_event_def def = se3d_event_def_default();
    CHECK(se3d_event_create(NULL, &def, &event) == SE3D_ERR_NULL && event.index1 == 0);
    REJECTED(se3d_event_create(solver, NULL, &event), SE3D_ERR_NULL);
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_NULL);
    def.value = zero_value;
    REJECTED(se3d_event_create(solver, &def, NULL), SE3D_ERR_NULL);
    def.level = (double)INFINITY;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.level = 0.0;
    def.hysteresis = -1.0;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.hysteresis = (double)NAN;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.hysteresis = 0.0;
    def.direction = 2;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.direction = -2;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.direction = 0;
    def.action = 2;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.action = -1;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.action = 0;
    def.name = "a.b";
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.name = "twice";
    def.struct_size = 0;
    REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_INVALID_ARGUMENT);
    def.struct_size = sizeof def;
    CHECK(!se3d_event_create(solver, &def, &event) && event.index1 != 0);
    se3d_event other = {7, 7};
    REJECTED(se3d_event_create(solver, &def, &other), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(other.index1 == 0);
    CHECK(!se3d_event_destroy(solver, event));
    CHECK(!se3d_event_create(solver, &def, &event)); /* the name is free again */
    CHECK(!se3d_event_destroy(solver, event));
}

static void events_need_a_motion(arguments *a)
{
    const int32_t still[2] = {SE3D_ANALYSIS_ASSEMBLY, SE3D_ANALYSIS_EQUILIBRIUM};
    for (int k = 0; k < 2; ++k) {
        se3d_solver_def how = se3d_solver_def_default();
        se3d_event_def def = se3d_event_def_default();
        se3d_solver *solver = NULL;
        se3d_event event;
        how.analysis = still[k];
        CHECK(!se3d_solver_create(a->system, &how, &solver));
        def.value = zero_value;
        REJECTED(se3d_event_create(solver, &def, &event), SE3D_ERR_UNSUPPORTED);
        se3d_solver_destroy(solver);
    }
}

/* A value that fails, or is no number, ends the run with a message that names the event. */
static void values_that_fail_are_reported(arguments *a)
{
    const int32_t methods[3] = {SE3D_METHOD_DOP853, SE3D_METHOD_RATTLE, SE3D_METHOD_BDF};
    for (int k = 0; k < 6; ++k) {
        se3d_solver_def how = se3d_solver_def_default();
        se3d_event_def def = se3d_event_def_default();
        se3d_solver *solver = NULL;
        se3d_event event;
        how.method = methods[k % 3];
        CHECK(!se3d_solver_create(a->system, &how, &solver));
        def.name = "broken";
        def.value = k < 3 ? failing_value : zero_value;
        def.ctx = a;
        CHECK(!se3d_event_create(solver, &def, &event));
        const double t = 1.0;
        REJECTED(se3d_solver_run(solver, t), k < 3 ? SE3D_ERR_CALLBACK : SE3D_ERR_NOT_FINITE);
        CHECK_CONTAINS(se3d_system_get_error(a->system), "broken");
        se3d_solver_destroy(solver);
    }
}

static void event_definitions_are_given_back(se3d_solver *solver, se3d_event event)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event found;
    CHECK(!se3d_event_get_def(solver, event, &def) && def.value == zero_value && !def.name);
    CHECK(se3d_event_get_def(NULL, event, &def) == SE3D_ERR_NULL);
    CHECK(se3d_event_get_def(solver, event, NULL) == SE3D_ERR_NULL);
    def.struct_size = 0;
    CHECK(se3d_event_get_def(solver, event, &def) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_solver_count_events(NULL) == 0 && se3d_solver_count_events(solver) == 1);
    CHECK(!se3d_solver_get_event(solver, 0, &found) && found.index1 == event.index1);
    CHECK(se3d_solver_get_event(solver, 1, &found) == SE3D_ERR_INVALID_ARGUMENT);
    CHECK(found.index1 == 0 && se3d_solver_get_event(NULL, 0, &found) == SE3D_ERR_NULL);
    CHECK(se3d_solver_get_event(solver, 0, NULL) == SE3D_ERR_NULL);
}

static se3d_status events_reject_misuse(arguments *a)
{
    const char *name = NULL;
    se3d_solver *solver = NULL;
    se3d_event_record record;
    se3d_solver_def how = se3d_solver_def_default();
    se3d_event event, none = {0, 0};
    se3d_event_def def = se3d_event_def_default();
    CHECK(!se3d_solver_create(a->system, &how, &solver));
    event_definitions_are_checked(a, solver);
    events_need_a_motion(a);
    values_that_fail_are_reported(a);
    def.value = zero_value;
    CHECK(!se3d_event_create(solver, &def, &event));
    CHECK(se3d_event_get_name(NULL, event, &name) == SE3D_ERR_NULL);
    REJECTED(se3d_event_get_name(solver, event, NULL), SE3D_ERR_NULL);
    CHECK(!se3d_event_get_name(solver, event, &name) && name[0] == '\0');
    event_definitions_are_given_back(solver, event);
    CHECK(se3d_event_destroy(NULL, event) == SE3D_ERR_NULL);
    REJECTED(se3d_event_destroy(solver, none), SE3D_ERR_STALE_HANDLE);
    CHECK(!se3d_event_destroy(solver, event));
    REJECTED(se3d_event_destroy(solver, event), SE3D_ERR_STALE_HANDLE);
    REJECTED(se3d_event_get_name(solver, event, &name), SE3D_ERR_STALE_HANDLE);
    REJECTED(se3d_event_get_def(solver, event, &def), SE3D_ERR_STALE_HANDLE);
    CHECK(se3d_solver_count_event_records(NULL) == 0);
    CHECK(se3d_solver_get_event_record(NULL, 0, &record) == SE3D_ERR_NULL);
    REJECTED(se3d_solver_get_event_record(solver, 0, NULL), SE3D_ERR_NULL);
    REJECTED(se3d_solver_get_event_record(solver, 0, &record), SE3D_ERR_INVALID_ARGUMENT);
    CHECK(se3d_solver_clear_event_records(NULL) == SE3D_ERR_NULL);
    CHECK(!se3d_solver_clear_event_records(solver));
    se3d_event_def_init(NULL, sizeof def);
    se3d_solver_destroy(solver);
    return SE3D_OK;
}

#endif
