/* SPDX-License-Identifier: BSD-3-Clause */
/* Sequences of calls: what fuzz_calls.c and its parts calls_*.c share. */
#ifndef SE3D_FUZZ_CALLS_H
#define SE3D_FUZZ_CALLS_H

#include "fuzz.h"

enum { CALLS_OPERATIONS = 48, CALLS_KEPT = 10, CALLS_STEPS = 300 };

/* An allocator that counts what lives, and fails when told to. */
typedef struct calls_memory {
    long live;  /* blocks */
    long bytes; /* as their sizes were told */
    long left;  /* allocations before one fails; < 0: none will */
    int failed; /* one did */
} calls_memory;

typedef struct calls {
    const uint8_t *at, *end; /* what is left of the input */
    calls_memory memory;
    se3d_system *system;
    se3d_solver *solver;
    se3d_solver_def solver_def;
    fuzz_patience patience;
    se3d_snapshot *snapshot;
    uint64_t snapshot_hash;
    uint32_t edits, snapshot_edits; /* successful edits so far, and when the snapshot was taken */
    se3d_body bodies[CALLS_KEPT];   /* the ground first; destroyed ones stay, and are stale */
    se3d_marker markers[CALLS_KEPT];
    se3d_constraint joints[CALLS_KEPT];
    se3d_force forces[CALLS_KEPT];
    se3d_function functions[CALLS_KEPT];
    se3d_shape shapes[CALLS_KEPT];
    se3d_material material;
    size_t body_count, marker_count, joint_count, force_count, function_count, shape_count;
    uint64_t trace; /* of all statuses and states */
} calls;

/* The next byte, 0 after the end; one below `count`; a number in [-1, 1); one that is often bad. */
unsigned calls_byte(calls *c);
size_t calls_pick(calls *c, size_t count);
double calls_number(calls *c);
double calls_any_number(calls *c);
void calls_vector(calls *c, double scale, double v[3]);

/* The allocator of `memory`. */
se3d_allocator calls_allocator(calls_memory *memory);

/* What an edit returned: it worked, or it left everything as it was and says why. `before` is
 * calls_state before it. @return it worked */
int calls_edited(calls *c, se3d_status status, uint64_t before);
/* What a run, step or query returned: it worked, or says why. @return it worked */
int calls_ended(calls *c, se3d_status status);
/* State and number of elements in one number. */
uint64_t calls_state(const calls *c);

/* Operations: each takes its arguments from the input. */
void calls_create_body(calls *c);
void calls_create_marker(calls *c);
void calls_create_function(calls *c);
void calls_create_joint(calls *c);
void calls_create_driver(calls *c);
void calls_create_primitive(calls *c);
void calls_create_spring(calls *c);
void calls_create_load(calls *c);
void calls_create_on_joint(calls *c); /* friction, stop, effort */
void calls_create_shape(calls *c);
void calls_destroy(calls *c);
void calls_set_state(calls *c);
void calls_set_value(calls *c);

void calls_create_solver(calls *c);
void calls_step(calls *c);
void calls_run(calls *c);
void calls_create_event(calls *c);
void calls_take_snapshot(calls *c);
void calls_restore_snapshot(calls *c);
void calls_fail_memory(calls *c);

void calls_clone(calls *c);
void calls_agree(calls *c);
void calls_batch(calls *c);
void calls_coordinates(calls *c);
void calls_check(calls *c);
void calls_modes(calls *c);
void calls_query(calls *c);

#endif
