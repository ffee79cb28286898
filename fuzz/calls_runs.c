/* SPDX-License-Identifier: BSD-3-Clause */
/* Operations that step, run, save and restore. */
#include "calls.h"

#include <math.h>
#include <stdlib.h>

/* How far a run that ended well may leave the equations open, in their units. */
#define VIOLATION_MAX 1e-3

/* Constraints are met where a run of dynamics or kinematics ended well. */
static void check_violation(calls *c)
{
    double violation[3];
    if (se3d_system_get_violation(c->system, violation) >= 0) {
        FUZZ_MUST(isfinite(violation[0]) && isfinite(violation[1]) && isfinite(violation[2]));
        FUZZ_MUST(violation[0] < VIOLATION_MAX);
    }
}

/* Energies are finite, or a status says why there are none. */
static void check_energy(calls *c)
{
    se3d_energy energy;
    if (se3d_system_get_energy(c->system, &energy) >= 0) {
        FUZZ_MUST(isfinite(energy.total) && isfinite(energy.dissipated) && energy.kinetic >= 0.0);
    }
}

static void ended(calls *c, se3d_status status)
{
    fuzz_check_finite(c->system, "after a run");
    if (calls_ended(c, status)) {
        check_violation(c);
        check_energy(c);
    }
}

/* The solver of the system, made of its definition if there is none. */
static int have_solver(calls *c)
{
    if (!c->solver) {
        (void)calls_ended(c, se3d_solver_create(c->system, &c->solver_def, &c->solver));
    }
    c->patience.left = CALLS_STEPS;
    return c->solver != NULL;
}

void calls_create_solver(calls *c)
{
    se3d_solver_def def = se3d_solver_def_default();
    const unsigned kind = calls_byte(c);
    se3d_solver_destroy(c->solver);
    c->solver = NULL;
    def.analysis = kind < 192 ? SE3D_ANALYSIS_DYNAMICS : (int32_t)(kind % 6);
    def.method = (int32_t)calls_pick(c, 13);
    def.formulation = (int32_t)calls_pick(c, 5);
    def.tolerance = calls_byte(c) & 1 ? 1e-4 : 0.0;
    def.step = calls_byte(c) & 1 ? 1e-3 : 0.0;
    def.interrupt = fuzz_interrupt;
    def.interrupt_ctx = &c->patience;
    if (kind % 32 == 31) {
        def.tolerance = calls_any_number(c);
        def.step = calls_any_number(c);
    }
    if (calls_ended(c, se3d_solver_create(c->system, &def, &c->solver))) {
        c->solver_def = def;
    }
}

void calls_step(calls *c)
{
    const double h = calls_pick(c, 16) == 15 ? calls_any_number(c) : 1e-4 * (1 + calls_byte(c));
    if (have_solver(c)) {
        ended(c, se3d_solver_step(c->solver, h));
    }
}

void calls_run(calls *c)
{
    double time;
    const double by = calls_pick(c, 16) == 15 ? calls_any_number(c) : 1e-3 * calls_byte(c);
    const int32_t shown = calls_pick(c, 4) == 3 ? SE3D_SHOWN_MOTION : SE3D_SHOWN_ALL;
    FUZZ_MUST(!se3d_system_get_time(c->system, &time));
    if (have_solver(c)) {
        FUZZ_MUST(!se3d_solver_set_shown(c->solver, shown));
        ended(c, se3d_solver_run(c->solver, time + by));
    }
}

static se3d_status height(void *ctx, const se3d_system *system, double *value)
{
    se3d_body body;
    double r[3] = {0.0, 0.0, 0.0};
    (void)ctx;
    const size_t count = se3d_system_count_bodies(system);
    se3d_status status = se3d_system_get_body(system, count - 1, &body);
    if (status >= 0) {
        status = se3d_body_get_position(system, body, r);
    }
    *value = r[2];
    return status;
}

void calls_create_event(calls *c)
{
    se3d_event_def def = se3d_event_def_default();
    se3d_event event;
    def.value = height;
    def.level = calls_number(c);
    def.action = (int32_t)calls_pick(c, 2);
    def.motion_only = 1;
    if (have_solver(c)) {
        (void)calls_ended(c, se3d_event_create(c->solver, &def, &event));
    }
}

void calls_take_snapshot(calls *c)
{
    se3d_snapshot *snapshot = NULL;
    if (calls_ended(c, se3d_snapshot_create(c->system, &snapshot))) {
        se3d_snapshot_destroy(c->snapshot);
        c->snapshot = snapshot;
        c->snapshot_hash = se3d_system_hash(c->system);
        c->snapshot_edits = c->edits;
    }
}

/* The saved state, by way of its bytes. */
static se3d_status read_again(calls *c, se3d_snapshot **again)
{
    size_t size = 0;
    FUZZ_MUST(!se3d_snapshot_write(c->snapshot, NULL, 0, &size));
    uint8_t *bytes = malloc(size);
    FUZZ_MUST(bytes && !se3d_snapshot_write(c->snapshot, bytes, size, &size));
    const se3d_status status = se3d_snapshot_read(c->system, bytes, size, again);
    free(bytes);
    return status;
}

/* Without an edit since it was taken it fits, and the state has the same bits, also from bytes. */
void calls_restore_snapshot(calls *c)
{
    const int bytes = calls_byte(c) & 1;
    const uint64_t before = calls_state(c);
    se3d_snapshot *again = NULL;
    se3d_status status = SE3D_OK;
    if (!c->snapshot) {
        return;
    }
    if (bytes) {
        status = read_again(c, &again);
    }
    if (status >= 0) {
        status = se3d_snapshot_restore(again ? again : c->snapshot, c->system);
    }
    se3d_snapshot_destroy(again);
    const int worked = calls_ended(c, status);
    FUZZ_MUST(worked || calls_state(c) == before);
    FUZZ_MUST(worked || c->edits != c->snapshot_edits || status == SE3D_ERR_NO_MEMORY);
    FUZZ_MUST(!worked || se3d_system_hash(c->system) == c->snapshot_hash);
}

void calls_fail_memory(calls *c)
{
    c->memory.left = calls_byte(c);
}
