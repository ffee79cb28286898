/* SPDX-License-Identifier: BSD-3-Clause */
/* The loopback server of `se3d live`: one page, the scene and the state of one model for those who
 * know the token of its address, and words from them. Its thread does nothing but answer. */
#ifndef SE3D_TOOL_LIVE_SERVER_H
#define SE3D_TOOL_LIVE_SERVER_H

#include <stddef.h>
#include <stdint.h>

enum { LIVE_WORDS_SIZE = 256, LIVE_ADDRESS_SIZE = 100 };

typedef struct live_server live_server;

/* Listen on 127.0.0.1. A byte is written to `wake` when there is something to do.
 * @param[in] port       0: one that is free
 * @param[in] page       kept until the end
 * @param[out] address   with the token
 * @return NULL after a message. */
live_server *live_server_create(int port, const char *page, size_t size, int wake,
                                char address[LIVE_ADDRESS_SIZE]);
void live_server_destroy(live_server *server);
/* Texts that are answered from now on; the server frees them. The state goes to all who wait. */
void live_server_set_scene(live_server *server, char *text, size_t size);
void live_server_set_state(live_server *server, char *text, size_t size, uint64_t sequence);
/* Take the next words that a user sent. @return false: there are none. */
int live_server_take(live_server *server, char words[LIVE_WORDS_SIZE]);
/* Whether words wait: any (NULL), or some of these verbs, the last of which is NULL. */
int live_server_has_words(live_server *server, const char *const *verbs);
/* Whether someone waits for the next state, or was given one in the last two seconds. */
int live_server_is_watched(live_server *server);

#endif
