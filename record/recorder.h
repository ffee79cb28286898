/* SPDX-License-Identifier: BSD-3-Clause */
/* What the functions that tools/record_calls.py writes (recorded.c) need: they stand in the place
 * of the public ones, write what goes in, call the function of libse3d, and write what came out. */
#ifndef SE3D_RECORD_RECORDER_H
#define SE3D_RECORD_RECORDER_H

#include "layout.h"

typedef void (*recorder_function)(void);

typedef struct recorder_call {
    const layout_function *function; /* NULL: this call is not recorded */
    void *const *arguments;
    int depth; /* of calls of this thread, before */
} recorder_call;

/* A callback of the host; it lives as long as the program. */
typedef struct recorder_callback {
    struct recorder_callback *next;
    recorder_function function; /* of the host */
    void *ctx;                  /* of the host */
    void *definition;           /* copy of the definition that held it, NULL: a parameter did */
    const layout_function *type;
    uint32_t id;
} recorder_callback;

typedef struct recorder_answer {
    recorder_callback *callback;
    void *const *arguments;
    int depth;
    uint64_t hash;
} recorder_answer;

/* Find the function of libse3d that has this name, and keep its address in `next`. */
void recorder_find(const char *name, void *next, size_t size);
void recorder_get(const recorder_callback *callback, void *host, size_t size);

void recorder_enter(recorder_call *call, const layout_function *f, void *const *arguments);
void recorder_leave(recorder_call *call, const void *result);
void recorder_callback_enter(recorder_answer *answer, recorder_callback *callback,
                             void *const *arguments);
void recorder_callback_leave(recorder_answer *answer, const void *result);
void recorder_note(const char *name, int ends);

/* Written from the headers: one for each type of callback. */
extern const recorder_function recorder_callbacks[];

#endif
