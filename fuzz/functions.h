/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of any public function of libse3d, by the tables that tools/record_calls.py makes of the
 * headers: what fuzz_functions.c and its part functions_arguments.c share. */
#ifndef SE3D_FUZZ_FUNCTIONS_H
#define SE3D_FUZZ_FUNCTIONS_H

#include "fuzz.h"
#include "player.h"

enum {
    FUNCTIONS_CALLS = 60,   /* of one input, those within callbacks too */
    FUNCTIONS_OBJECTS = 40, /* that are made */
    FUNCTIONS_KEPT = 24,    /* handles of a kind, those of what is gone too */
    FUNCTIONS_KINDS = 32,
    FUNCTIONS_LONGEST = 64 /* elements of an array that goes in */
};

typedef struct functions_object {
    void *pointer;
    size_t kind, parent; /* parent: index + 1 of its system, 0: none */
    int lives;
} functions_object;

typedef struct functions_block {
    struct functions_block *next;
    void *memory; /* of its own, so that a sanitizer sees its end */
} functions_block;

typedef struct functions {
    layout_walk walk; /* first: a pointer to it is one to all */
    const uint8_t *at, *end;
    functions_object objects[FUNCTIONS_OBJECTS];
    size_t object_count;
    uint64_t handles[FUNCTIONS_KINDS][FUNCTIONS_KEPT];
    size_t handle_count[FUNCTIONS_KINDS]; /* ever made */
    functions_block *blocks;              /* arguments: callbacks may look at them to the end */
    size_t calls;
    int depth;            /* of callbacks */
    int is_other_version; /* the structure that is made, so that it gets no callback */
    fuzz_patience left;   /* of all runs */
    long allocations;     /* before one fails; < 0: none does */
    long live;            /* blocks of the host's allocator */
    int is_odd;           /* the host rounds upwards and flushes small numbers to zero */
    uint64_t trace;       /* of all statuses and outputs */
} functions;

/* The next byte, 0 after the end. */
unsigned functions_byte(functions *f);
/* Zeroed memory, to the end of the input. */
void *functions_take(functions *f, size_t size);
/* `arguments` get the addresses of what is passed. */
void functions_make_arguments(functions *f, const layout_function *call, void **arguments);

/* One that fails when `allocations` says so, and lives as long. */
const se3d_allocator *functions_allocator(functions *f);

/* Make one call that the input chooses. */
void functions_call(functions *f);

#endif
