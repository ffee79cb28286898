/* SPDX-License-Identifier: BSD-3-Clause */
/* The playground: the library in a page, without a server. The worker of the page (worker.js)
 * writes the model file, calls se3d_play_turn again and again, and takes the texts that `se3d
 * live` would have sent. */
#ifndef SE3D_PLAYGROUND_H
#define SE3D_PLAYGROUND_H

/* Read a model and show it. @return "", or why there is none. */
const char *se3d_play_open(const char *path);
/* The file of the model has changed. */
void se3d_play_save(void);
/* Whether anybody looks: if not, the model waits. */
void se3d_play_watch(int is_watched);
/* An order of the page. @return 0: too many wait, or it is too long. */
int se3d_play_say(const char *words);
/* @return s to wait for the next turn, negative: until something is said. */
double se3d_play_turn(void);
/* The scene, the state; "": as it was. A text stands until the next one is taken. */
const char *se3d_play_take_scene(void);
const char *se3d_play_take_state(void);

#endif
