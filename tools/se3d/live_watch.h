/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether files were saved, as Linux tells it (inotify); elsewhere nothing is told. */
#ifndef SE3D_TOOL_LIVE_WATCH_H
#define SE3D_TOOL_LIVE_WATCH_H

/* @return a descriptor that can be read when something was saved; -1: there is no such thing. */
int live_watch_create(void);
/* Watch the folder of a file, and that of the file that a link leads to. */
void live_watch_add(int watch, const char *path);
/* Take what has happened. @return whether a file was saved for which `is_meant` holds: its name
 * without the folder. */
int live_watch_take(int watch, int (*is_meant)(void *ctx, const char *name), void *ctx);

#endif
