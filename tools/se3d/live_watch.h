/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether files were saved, as Linux tells it (inotify); elsewhere nothing is told. */
#ifndef SE3D_TOOL_LIVE_WATCH_H
#define SE3D_TOOL_LIVE_WATCH_H

enum {
    LIVE_WATCH_SAVED = 1, /* a file was saved that is meant */
    LIVE_WATCH_LOST = 2   /* a folder has gone: another one may have its name */
};

/* @return a descriptor that can be read when something was saved; -1: errno says why there is none.
 */
int live_watch_create(void);
/* Watch the folder of a file, and that of the file that a link leads to. @return false: errno says
 * why not. */
int live_watch_add(int watch, const char *path);
/* Take what has happened, as bits. A file is meant if `is_meant` holds of its name without the
 * folder. */
unsigned live_watch_take(int watch, int (*is_meant)(void *ctx, const char *name), void *ctx);

#endif
