/* SPDX-License-Identifier: BSD-3-Clause */
/* The pieces of a recording, in order and by thread. */
#ifndef SE3D_RECORD_SCORE_H
#define SE3D_RECORD_SCORE_H

#include "bytes.h"
#include "format.h"
#include "map.h"

#define SCORE_NONE SIZE_MAX

typedef struct score_piece {
    const unsigned char *content;
    uint32_t size, thread;
    int kind;     /* format_kind */
    size_t next;  /* of its thread, SCORE_NONE: none */
    size_t later; /* ANSWER: the next one of the same callback, SCORE_NONE: none */
    int is_done;
} score_piece;

typedef struct score {
    score_piece *pieces;
    size_t count;
    size_t *functions; /* number in the recording -> index, layout_function_count: unknown */
    size_t function_count;
    map answers;  /* hash of callback and what it was given -> its first ANSWER */
    map failures; /* of allocator and number: the allocations that fail */
    map first;    /* callback -> its first ANSWER */
    char message[128];
    int is_cut; /* the last piece is not whole */
} score;

/* @return 0; -1: malformed, or no memory: `message` */
int score_read(score *s, const unsigned char *data, size_t size);
void score_free(score *s);
uint64_t score_key(uint32_t callback, uint64_t hash);

#endif
