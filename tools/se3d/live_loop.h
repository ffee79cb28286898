/* SPDX-License-Identifier: BSD-3-Clause */
/* What goes on behind the page of a live model: orders of the user, files that were saved,
 * pieces of the run, and the texts that the page is told. What it talks to is behind
 * live_server.h, live_watch.h and interrupt.h: a server in `se3d live`, the page itself in the
 * playground. */
#ifndef SE3D_TOOL_LIVE_LOOP_H
#define SE3D_TOOL_LIVE_LOOP_H

#include "io/live/live.h"
#include "live_server.h"

typedef struct live_loop live_loop;

/* Read a model. @return NULL: `message` says why there is none. */
live_loop *live_loop_create(const char *path, const se3d_model_options *how,
                            char message[SE3DI_LIVE_MESSAGE_SIZE]);
void live_loop_destroy(live_loop *l);
/* Watch the files of the model by what live_watch_create gave; negative: not at all. @return false:
 * errno says why some are not watched. */
int live_loop_watch(live_loop *l, int watch);
/* Show the model to `server`, which stays the caller's, and let it run. @return false: out of
 * memory, or the model cannot be drawn. */
int live_loop_begin(live_loop *l, live_server *server);
/* One turn: obey, read what is due, go on, tell. @return s to wait before the next one, if no words
 * come; negative: for ever. */
double live_loop_turn(live_loop *l);

#endif
