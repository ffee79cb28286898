/* SPDX-License-Identifier: BSD-3-Clause */
/* The parts of the player. */
#ifndef SE3D_RECORD_PLAYER_PARTS_H
#define SE3D_RECORD_PLAYER_PARTS_H

#include "stage.h"

/* Where a value stands: its structure, or the addresses of all parameters. */
typedef struct player_place {
    unsigned char *base;
    int is_member;
    int is_whole; /* what it points to lives to the end */
} player_place;

/* Memory of the arguments of one call. */
typedef struct player_arguments {
    _Alignas(16) unsigned char slots[LAYOUT_PARAMETERS_MAX][16];
    void *at[LAYOUT_PARAMETERS_MAX];
    _Alignas(16) unsigned char result[16];
} player_arguments;

/* player_read.c: the arguments of a call, with room for its outputs. @return 0; -1: the play has
 * ended, or (s->is_missing) the call has to be left out. */
int player_read_arguments(stage *s, const layout_function *f, player_arguments *a, bytes_reader *r);

/* player_compare.c: compare what a call returned and gave with what it did when recorded, and take
 * note of new objects and handles. @return 0, -1: the play has ended */
int player_compare(stage *s, const layout_function *f, player_arguments *a, bytes_reader *r);

/* Objects that a call gave and that the recording does not know are destroyed at the end. @return
 * 0, -1: the play has ended */
int player_bind_all(stage *s, const layout_function *f, const player_arguments *a);

/* player.c: make the call of this piece, and those within it. */
int player_make_call(stage *s, size_t piece);

#endif
