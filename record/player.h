/* SPDX-License-Identifier: BSD-3-Clause */
/* Plays a recording: makes its calls again and compares what they return and give with what they
 * did when they were recorded. Whatever the bytes are, the calls are made with memory that is
 * there, and objects that live. */
#ifndef SE3D_RECORD_PLAYER_H
#define SE3D_RECORD_PLAYER_H

#include "layout.h"

typedef void (*player_call)(void *const *arguments, void *result);
typedef void (*player_function)(void);

typedef enum player_verdict {
    PLAYER_SAME = 0,
    PLAYER_DIFFERS = 1,   /* a result or an output is another, or a callback was called otherwise */
    PLAYER_MALFORMED = 2, /* the recording */
    PLAYER_NO_MEMORY = 3
} player_verdict;

typedef struct player_options {
    int is_free;       /* nothing is compared; calls whose objects are missing are left out */
    size_t interrupts; /* runs are interrupted after so many questions; 0: never */
    size_t largest;    /* bytes of an output; 0: 2^28 */
    /* Whether a call may be made with arguments at these addresses; NULL: all may. */
    int (*allows)(void *ctx, const char *name, void *const *arguments);
    /* Told before and after each call, the second time with its status, 0 if it has none; NULL:
     * nobody. */
    void (*told)(void *ctx, size_t number, const char *name, int is_after, int status);
    void *ctx;
} player_options;

typedef struct player_report {
    size_t calls, callbacks, left_out, hashes; /* made, answered, left out, compared */
    int ends_within;                           /* the last call did not return when recorded */
    size_t number;                             /* of the call that differs, from 1 */
    const char *name;                          /* its function, NULL: none */
    char message[512];
} player_report;

player_verdict player_play(const unsigned char *data, size_t size, const player_options *options,
                           player_report *report);

/* What played.c has: a function for each of layout_functions, and for each of layout_callbacks. */
extern const player_call player_calls[];
extern const player_function player_answers[];
/* Answer a callback as it was when recorded. `ctx` is its context, `result` NULL if it has none. */
void player_answer(void *ctx, void *const *arguments, void *result);

#endif
