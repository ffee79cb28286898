/* SPDX-License-Identifier: BSD-3-Clause */
/* Sequences of calls: the input says which calls are made with which arguments, good and bad,
 * stale handles and failing allocations included. What must hold: an edit that fails changes
 * nothing and says why; a run that ends well leaves finite states and small violations of the
 * constraints; the same input gives the same states, statuses and hashes; a clone, a snapshot and
 * its bytes go on with the same bits; the formulations agree; nothing is left behind. */
#include "calls.h"

#include <math.h>
#include <stdlib.h>

#include "base/hash.h"

typedef struct operation {
    void (*run)(calls *c);
    int weight;
} operation;

static const operation operations[] = {{calls_create_body, 4},
                                       {calls_create_marker, 1},
                                       {calls_create_function, 1},
                                       {calls_create_joint, 4},
                                       {calls_create_driver, 1},
                                       {calls_create_primitive, 1},
                                       {calls_create_spring, 1},
                                       {calls_create_load, 1},
                                       {calls_create_on_joint, 1},
                                       {calls_create_shape, 1},
                                       {calls_destroy, 1},
                                       {calls_set_state, 1},
                                       {calls_set_value, 1},
                                       {calls_create_solver, 2},
                                       {calls_step, 3},
                                       {calls_run, 2},
                                       {calls_create_event, 1},
                                       {calls_take_snapshot, 1},
                                       {calls_restore_snapshot, 1},
                                       {calls_fail_memory, 1},
                                       {calls_clone, 1},
                                       {calls_agree, 1},
                                       {calls_batch, 1},
                                       {calls_coordinates, 1},
                                       {calls_check, 1},
                                       {calls_modes, 1},
                                       {calls_query, 1}};

static int sum_weights(void)
{
    int sum = 0;
    for (size_t k = 0; k < sizeof operations / sizeof *operations; ++k) {
        sum += operations[k].weight;
    }
    return sum;
}

unsigned calls_byte(calls *c)
{
    return c->at < c->end ? *c->at++ : 0;
}

size_t calls_pick(calls *c, size_t count)
{
    return calls_byte(c) % count;
}

double calls_number(calls *c)
{
    return ((int)calls_byte(c) - 128) / 128.0;
}

double calls_any_number(calls *c)
{
    static const double bad[] = {(double)NAN,
                                 (double)INFINITY,
                                 -(double)INFINITY,
                                 1e308,
                                 -1e308,
                                 5e-324,
                                 0.0,
                                 -0.0,
                                 -1.0,
                                 1e16,
                                 1e-16};
    const size_t which = calls_pick(c, 40);
    return which < sizeof bad / sizeof *bad ? bad[which] : 2.0 * calls_number(c);
}

void calls_vector(calls *c, double scale, double v[3])
{
    for (int k = 0; k < 3; ++k) {
        v[k] = scale * calls_number(c);
    }
}

static int must_fail(calls_memory *m)
{
    const int fails = m->left == 0;
    m->left -= m->left >= 0;
    m->failed |= fails;
    return fails;
}

static void *take(void *ctx, size_t size)
{
    calls_memory *m = ctx;
    void *memory = must_fail(m) ? NULL : malloc(size);
    m->live += memory != NULL;
    m->bytes += memory ? (long)size : 0;
    return memory;
}

static void *retake(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    calls_memory *m = ctx;
    void *grown = must_fail(m) ? NULL : realloc(memory, new_size);
    m->live += grown != NULL && memory == NULL;
    m->bytes += grown ? (long)new_size - (long)old_size : 0;
    return grown;
}

static void give(void *ctx, void *memory, size_t size)
{
    calls_memory *m = ctx;
    m->live -= memory != NULL;
    m->bytes -= memory ? (long)size : 0;
    free(memory);
}

se3d_allocator calls_allocator(calls_memory *memory)
{
    return (se3d_allocator){take, retake, give, memory};
}

uint64_t calls_state(const calls *c)
{
    const size_t counts[] = {
        se3d_system_count_bodies(c->system), se3d_system_count_markers(c->system),
        se3d_system_count_constraints(c->system), se3d_system_count_forces(c->system)};
    uint64_t hash = se3d_system_hash(c->system);
    for (size_t k = 0; k < sizeof counts / sizeof *counts; ++k) {
        hash = hash * UINT64_C(1099511628211) + counts[k];
    }
    return hash;
}

/* Of the status, and that a failure has a message which is about it; ends a failure of memory. */
static int note(calls *c, se3d_status status)
{
    c->trace = (c->trace ^ (uint64_t)(int64_t)status) * UINT64_C(1099511628211);
    FUZZ_MUST(status != SE3D_ERR_NO_MEMORY || c->memory.failed);
    if (status < 0 && status != SE3D_ERR_NULL && status != SE3D_ERR_NO_MEMORY) {
        FUZZ_MUST(se3d_system_get_error(c->system)[0] != '\0');
        FUZZ_MUST(se3d_system_get_error_status(c->system) == status);
    }
    if (c->memory.failed) {
        c->memory.failed = 0;
        c->memory.left = -1;
    }
    return status >= 0;
}

int calls_edited(calls *c, se3d_status status, uint64_t before)
{
    const int worked = note(c, status);
    if (!worked) {
        FUZZ_MUST_SAY(calls_state(c) == before, se3d_system_get_error(c->system));
    }
    c->edits += worked != 0;
    fuzz_check_finite(c->system, "after an edit");
    return worked;
}

int calls_ended(calls *c, se3d_status status)
{
    return note(c, status);
}

static void run_operation(calls *c, int which)
{
    size_t k = 0;
    while (which >= operations[k].weight) {
        which -= operations[k].weight;
        ++k;
    }
    operations[k].run(c);
    c->trace = (c->trace ^ calls_state(c)) * UINT64_C(1099511628211);
}

static void close_calls(calls *c)
{
    c->memory.left = -1;
    if (c->trace % 2 == 0) { /* either order */
        se3d_solver_destroy(c->solver);
        se3d_system_destroy(c->system);
    } else {
        se3d_system_destroy(c->system);
        FUZZ_MUST(!c->solver || se3d_solver_step(c->solver, 1e-3) == SE3D_ERR_STATE);
        se3d_solver_destroy(c->solver);
    }
    se3d_snapshot_destroy(c->snapshot);
    FUZZ_MUST(c->memory.live == 0 && c->memory.bytes == 0);
}

/* The trace of all that an input does. */
static uint64_t run_all(const uint8_t *data, size_t size)
{
    static const calls empty;
    calls c = empty;
    se3d_system_def def = se3d_system_def_default();
    const se3d_allocator allocator = calls_allocator(&c.memory);
    const int weights = sum_weights();
    c.at = data;
    c.end = data + size;
    c.memory.left = -1;
    c.trace = SE3DI_HASH_START;
    c.solver_def = se3d_solver_def_default();
    c.solver_def.interrupt = fuzz_interrupt;
    c.solver_def.interrupt_ctx = &c.patience;
    def.allocator = &allocator;
    FUZZ_MUST(!se3d_system_create(&def, &c.system));
    FUZZ_MUST(!se3d_system_get_ground(c.system, &c.bodies[0]));
    c.body_count = 1;
    for (int k = 0; k < CALLS_OPERATIONS && c.at < c.end; ++k) {
        run_operation(&c, (int)calls_pick(&c, (size_t)weights));
    }
    const uint64_t trace = c.trace;
    close_calls(&c);
    return trace;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    FUZZ_MUST(run_all(data, size) == run_all(data, size));
    return 0;
}
