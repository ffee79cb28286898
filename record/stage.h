/* SPDX-License-Identifier: BSD-3-Clause */
/* What lives while a recording is played: objects, handles, callbacks, and memory of arguments. */
#ifndef SE3D_RECORD_STAGE_H
#define SE3D_RECORD_STAGE_H

#include <stdatomic.h>

#include "player.h"
#include "score.h"
#include "se3d/base.h"

#define STAGE_HANDLE_KINDS 32

typedef struct stage_object {
    void *pointer;
    size_t kind;
    size_t parent; /* index + 1 of the object that it was made of, 0: none */
    int lives;
    uint32_t id;
} stage_object;

typedef struct stage stage;

typedef struct stage_callback {
    stage *of;
    const layout_function *type;
    const void *definition;
    uint32_t id;
    size_t at; /* the ANSWER that it gave last, SCORE_NONE */
} stage_callback;

typedef struct stage_block { /* of memory */
    struct stage_block *next;
    _Alignas(16) unsigned char data[];
} stage_block;

typedef struct stage_check { /* of the length of an array that was read */
    const layout_item *item;
    const void *base;
    size_t count;
} stage_check;

struct stage {
    layout_walk walk; /* first: a pointer to it is one to the stage */
    const player_options *options;
    player_report *report;
    player_verdict verdict;
    score score;
    stage_object *objects;
    size_t object_count, object_capacity;
    map object_of;                     /* number in the recording -> index */
    map handle_of[STAGE_HANDLE_KINDS]; /* bits in the recording -> bits now */
    map variables_of;                  /* key of a function or expression now -> its variables */
    map callback_of;                   /* number -> stage_callback * */
    stage_block *whole;                /* memory that lives to the end */
    stage_block *part;                 /* that of the present call */
    size_t at;                         /* the next piece of the thread that is played */
    size_t number;                     /* of the call that is made, from 1 */
    const char *name;                  /* its function, NULL: none */
    size_t parent;                     /* index + 1 of what new objects are made of */
    size_t depth;                      /* of callbacks in which calls are played */
    int is_quiet;                      /* a question of ours is asked */
    atomic_flag locked;                /* by a callback that several threads may call */
    stage_callback interrupter;        /* limits the work */
    size_t interrupts;                 /* how often it was asked */
    stage_check *checks;
    size_t check_count, check_capacity;
    int is_missing; /* the call that was read needs an object that is not there */
};

void stage_init(stage *s, const player_options *options, player_report *report);
/* Destroy what lives. */
void stage_clear(stage *s);

/* End the play, unless it has ended. @return -1 */
int stage_end(stage *s, player_verdict verdict, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Zeroed memory, until the present call (or all) has ended. NULL: the play has ended. */
void *stage_take(stage *s, size_t size, int is_whole);
void stage_release(stage_block **blocks);

stage_object *stage_find(stage *s, uint32_t id);
/* The object that has this pointer, NULL: none that lives. */
stage_object *stage_find_pointer(stage *s, size_t kind, const void *pointer);
/* An object came to be, or is the one that it was. `id` may be FORMAT_UNKNOWN. */
int stage_bind(stage *s, uint32_t id, size_t kind, void *pointer, size_t parent);
/* It is destroyed, and so is what goes with it. */
void stage_kill(stage *s, stage_object *object);
size_t stage_index(const stage *s, const stage_object *object);

/* An allocator whose allocations fail as they did in the recording. NULL: the play has ended. */
const se3d_allocator *stage_add_allocator(stage *s, uint32_t id);

stage_callback *stage_add_callback(stage *s, uint32_t id, const layout_item *item,
                                   const void *definition);

#endif
