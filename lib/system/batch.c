/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: batches. A batch has a clone of its system, which records its errors. */
#include "se3d/batch.h"

#include "analysis/batch.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

#define THREADS_MAX 1024

/* A call that changes a batch, whose system lives as long as it does. */
#define BATCH_EDIT(batch)                                                                          \
    do {                                                                                           \
        if (!(batch)) {                                                                            \
            return SE3D_ERR_NULL;                                                                  \
        }                                                                                          \
        SE3DI_EDIT((batch)->system);                                                               \
    } while (0)

struct se3d_batch {
    se3d_system *system; /* its own */
    se3di_batch of;
};

/* ---- life ---- */

se3d_status se3d_batch_create(se3d_system *system, size_t count, int32_t threads, se3d_batch **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    if (count < 1) {
        return SE3DI_FAIL_OF(system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = 0, must be at least 1");
    }
    if (threads < 1 || threads > THREADS_MAX) {
        return SE3DI_FAIL_OF(system, "threads", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be at least 1 and at most %d", threads, THREADS_MAX);
    }
    const se3d_allocator allocator = system->model.allocator;
    se3d_batch *batch = se3di_alloc(&allocator, 1, sizeof *batch);
    if (!batch) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a batch");
    }
    se3d_status status = se3d_system_clone(system, &batch->system);
    if (status < 0) {
        se3di_free(&allocator, batch, 1, sizeof *batch);
        return SE3DI_FAIL(system, status, "no copy of the system for a batch: %s",
                          se3d_status_get_text(status));
    }
    status = se3di_batch_init(&batch->of, &batch->system->model, count, threads, &system->error);
    if (status < 0) {
        se3d_system_destroy(batch->system);
        se3di_free(&allocator, batch, 1, sizeof *batch);
        return se3di_log_error(&system->error, status);
    }
    batch->of.error = &batch->system->error;
    *out = batch;
    return SE3D_OK;
}

void se3d_batch_destroy(se3d_batch *batch)
{
    if (!batch || se3di_enter(batch->system, SE3DI_BUSY_FREE, __func__) < 0) {
        return;
    }
    const se3d_allocator allocator = batch->system->model.allocator;
    se3di_batch_destroy(&batch->of);
    se3d_system_destroy(batch->system);
    se3di_free(&allocator, batch, 1, sizeof *batch);
}

/* ---- what it is ---- */

size_t se3d_batch_count(const se3d_batch *batch)
{
    return batch ? batch->of.count : 0;
}

size_t se3d_batch_count_positions(const se3d_batch *batch)
{
    return batch ? batch->of.tree.q_count : 0;
}

size_t se3d_batch_count_velocities(const se3d_batch *batch)
{
    return batch ? batch->of.tree.v_count : 0;
}

size_t se3d_batch_count_lanes(const se3d_batch *batch)
{
    return batch ? (size_t)batch->of.core->width : 0;
}

size_t se3d_batch_count_single_forces(const se3d_batch *batch)
{
    return batch && !batch->of.is_in_lanes ? batch->system->model.force_slots.count : 0;
}

const char *se3d_batch_get_error(const se3d_batch *batch)
{
    return batch ? batch->system->error.message : "the batch is NULL";
}

/* ---- checks ---- */

static int is_in_range(const se3d_batch *batch, size_t first, size_t count)
{
    return first <= batch->of.count && count <= batch->of.count - first;
}

static se3d_status check_range(const se3d_batch *batch, size_t first, size_t count)
{
    if (is_in_range(batch, first, count)) {
        return SE3D_OK;
    }
    return SE3DI_FAIL_OF(batch->system, "first", SE3D_ERR_INVALID_ARGUMENT,
                         " = %zu and count = %zu, must be within the %zu states of the batch",
                         first, count, batch->of.count);
}

/* [count x size] numbers of states from `first`; NULL is fine. */
static se3d_status check_numbers(const se3d_batch *batch, const char *what, size_t first,
                                 size_t count, size_t size, const double *values)
{
    for (size_t k = 0; values && k < count * size; ++k) {
        if (!isfinite(values[k])) {
            return SE3DI_FAIL_OF(batch->system, what, SE3D_ERR_NOT_FINITE,
                                 "[%zu] of state %zu = %g, must be finite", k % size,
                                 first + k / size, values[k]);
        }
    }
    return SE3D_OK;
}

static se3d_status check_quaternions(const se3d_batch *batch, size_t first, size_t count,
                                     const double *q)
{
    const se3di_tree *tree = &batch->of.tree;
    for (size_t k = 0; q && k < count * tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k % tree->count];
        const size_t at = n->q + (n->type == SE3DI_TREE_FREE ? 3 : 0);
        const double *p = q + k / tree->count * tree->q_count + at;
        if (n->type != SE3DI_TREE_FREE && n->type != SE3DI_TREE_SPHERICAL) {
            continue;
        }
        const double norm = sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
        if (!(norm > 1e-6 && norm < HUGE_VAL)) {
            return SE3DI_FAIL_OF(batch->system, "q", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] to [%zu] of state %zu are a quaternion of length %g", at,
                                 at + 3, first + k / tree->count, norm);
        }
    }
    return SE3D_OK;
}

/* ---- numbers in and out ---- */

se3d_status se3d_batch_set_state(se3d_batch *batch, size_t first, size_t count, const double *q,
                                 const double *qdot)
{
    BATCH_EDIT(batch);
    const se3di_batch_part positions = se3di_batch_positions(&batch->of);
    const se3di_batch_part velocities = se3di_batch_velocities(&batch->of);
    SE3DI_TRY(check_range(batch, first, count));
    SE3DI_TRY(check_numbers(batch, "q", first, count, positions.size, q));
    SE3DI_TRY(check_numbers(batch, "qdot", first, count, velocities.size, qdot));
    SE3DI_TRY(check_quaternions(batch, first, count, q));
    if (q) {
        se3di_batch_write(&batch->of, &positions, first, count, q);
        se3di_batch_normalise(&batch->of, first, count);
    }
    if (qdot) {
        se3di_batch_write(&batch->of, &velocities, first, count, qdot);
    }
    se3di_batch_revive(&batch->of, first, count);
    se3di_batch_settle(&batch->of, first, count);
    return SE3D_OK;
}

/* Readers leave no message; within callbacks other threads may be at work on the states. */
static se3d_status check_reader(const se3d_batch *batch, size_t first, size_t count)
{
    if (!se3di_is_settled(batch->system)) {
        return SE3D_ERR_STATE;
    }
    return is_in_range(batch, first, count) ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

static se3d_status get(const se3d_batch *batch, const se3di_batch_part *part, size_t first,
                       size_t count, double *values)
{
    SE3DI_TRY(check_reader(batch, first, count));
    if (values) {
        se3di_batch_read(&batch->of, part, first, count, values);
    }
    return SE3D_OK;
}

se3d_status se3d_batch_get_state(const se3d_batch *batch, size_t first, size_t count, double *q,
                                 double *qdot)
{
    if (!batch) {
        return SE3D_ERR_NULL;
    }
    const se3di_batch_part positions = se3di_batch_positions(&batch->of);
    const se3di_batch_part velocities = se3di_batch_velocities(&batch->of);
    SE3DI_TRY(get(batch, &positions, first, count, q));
    return get(batch, &velocities, first, count, qdot);
}

static se3d_status set(se3d_batch *batch, const char *what, const se3di_batch_part *part,
                       size_t first, size_t count, const double *values)
{
    SE3DI_TRY(se3di_check_pointer(batch->system, what, values));
    SE3DI_TRY(check_range(batch, first, count));
    SE3DI_TRY(check_numbers(batch, what, first, count, part->size, values));
    se3di_batch_write(&batch->of, part, first, count, values);
    return SE3D_OK;
}

se3d_status se3d_batch_set_time(se3d_batch *batch, size_t first, size_t count, const double *time)
{
    BATCH_EDIT(batch);
    const se3di_batch_part part = se3di_batch_time(&batch->of);
    return set(batch, "time", &part, first, count, time);
}

se3d_status se3d_batch_get_time(const se3d_batch *batch, size_t first, size_t count, double *time)
{
    if (!batch || !time) {
        return SE3D_ERR_NULL;
    }
    const se3di_batch_part part = se3di_batch_time(&batch->of);
    return get(batch, &part, first, count, time);
}

se3d_status se3d_batch_set_efforts(se3d_batch *batch, size_t first, size_t count,
                                   const double *effort)
{
    BATCH_EDIT(batch);
    const se3di_batch_part part = se3di_batch_efforts(&batch->of);
    return set(batch, "effort", &part, first, count, effort);
}

se3d_status se3d_batch_set_gravity(se3d_batch *batch, size_t first, size_t count,
                                   const double *gravity)
{
    BATCH_EDIT(batch);
    const se3di_batch_part part = se3di_batch_gravity(&batch->of);
    return set(batch, "gravity", &part, first, count, gravity);
}

se3d_status se3d_batch_set_mass(se3d_batch *batch, se3d_body body, size_t first, size_t count,
                                const double *mass, const double *inertia)
{
    uint32_t index;
    BATCH_EDIT(batch);
    se3d_system *system = batch->system;
    SE3DI_TRY(se3di_find_body(system, "body", body, &index));
    SE3DI_TRY(se3di_check_pointer(system, "mass", mass));
    SE3DI_TRY(se3di_check_pointer(system, "inertia", inertia));
    SE3DI_TRY(check_range(batch, first, count));
    if (system->model.bodies[index].fixed) {
        return SE3DI_FAIL_OF(system, "body", SE3D_ERR_INVALID_ARGUMENT,
                             ": a fixed body has no mass to set");
    }
    for (size_t k = 0; k < count; ++k) {
        SE3DI_TRY(se3di_check_mass(system, mass[k], inertia + 6 * k));
    }
    const se3d_status status =
        se3di_batch_set_inertia(&batch->of, index, first, count, mass, inertia);
    return status < 0 ? se3di_log_error(&system->error, status) : status;
}

se3d_status se3d_batch_get_status(const se3d_batch *batch, size_t first, size_t count,
                                  int32_t *status)
{
    if (!batch || !status) {
        return SE3D_ERR_NULL;
    }
    SE3DI_TRY(check_reader(batch, first, count));
    memcpy(status, batch->of.status + first, count * sizeof *status);
    return SE3D_OK;
}

/* ---- work ---- */

/* What is wrong with the first state that failed. */
static se3d_status report(se3d_batch *batch)
{
    const size_t failed = se3di_batch_find_failed(&batch->of);
    if (failed == batch->of.count) {
        return se3di_work_end(batch->system, SE3D_OK);
    }
    double time;
    const se3di_batch_part part = se3di_batch_time(&batch->of);
    const se3d_status status = (se3d_status)batch->of.status[failed];
    se3di_batch_read(&batch->of, &part, failed, 1, &time);
    return se3di_work_end(batch->system,
                          se3di_error_set(&batch->system->error, status, "state %zu, t = %g s: %s",
                                          failed, time, se3d_status_get_text(status)));
}

se3d_status se3d_batch_step(se3d_batch *batch, se3d_method method, double step, uint64_t steps)
{
    BATCH_EDIT(batch);
    const se3di_integrator *integrator = se3di_integrator_find((int32_t)method);
    const se3di_rk_tableau *tableau = integrator ? integrator->tableau : NULL;
    if (!tableau || tableau->stages > SE3DI_BATCH_STAGES) {
        return SE3DI_FAIL_OF(
            batch->system, "method", SE3D_ERR_UNSUPPORTED,
            " = %d, must be SE3D_METHOD_RK4 (%d), SE3D_METHOD_RK45 (%d) or SE3D_METHOD_DOP853 (%d)",
            (int)method, (int)SE3D_METHOD_RK4, (int)SE3D_METHOD_RK45, (int)SE3D_METHOD_DOP853);
    }
    if (!(step > 0.0 && step < HUGE_VAL)) {
        return SE3DI_FAIL_OF(batch->system, "step", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite and > 0", step);
    }
    se3di_work_begin(batch->system);
    se3di_batch_step(&batch->of, tableau, step, steps);
    return report(batch);
}

se3d_status se3d_batch_compute_accelerations(se3d_batch *batch, double *qddot)
{
    BATCH_EDIT(batch);
    SE3DI_TRY(se3di_check_pointer(batch->system, "qddot", qddot));
    se3di_work_begin(batch->system);
    se3di_batch_accelerate(&batch->of, qddot);
    return report(batch);
}

se3d_status se3d_batch_compute_efforts(se3d_batch *batch, const double *qddot, double *effort)
{
    BATCH_EDIT(batch);
    SE3DI_TRY(se3di_check_pointer(batch->system, "effort", effort));
    if (batch->of.has_loops) {
        return SE3DI_FAIL(batch->system, SE3D_ERR_UNSUPPORTED,
                          "with loops there are many efforts that give the same accelerations");
    }
    SE3DI_TRY(check_numbers(batch, "qddot", 0, batch->of.count, batch->of.tree.v_count, qddot));
    se3di_work_begin(batch->system);
    se3di_batch_find_efforts(&batch->of, qddot, effort);
    return report(batch);
}
