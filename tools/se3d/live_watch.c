/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders are watched, not files: many editors write a new file and give it the old one's name. */
#define _XOPEN_SOURCE 700

#include "live_watch.h"

#if defined(__linux__)

#include <stddef.h>
#include <sys/inotify.h>
#include <unistd.h>

#include "page.h"
#include "process.h"

int live_watch_create(void)
{
    return inotify_init1(IN_NONBLOCK | IN_CLOEXEC);
}

static int add_folder(int watch, const char *path)
{
    char folder[PAGE_PATH];
    return path_get_folder(path, folder, sizeof folder) &&
           inotify_add_watch(watch, folder,
                             IN_CLOSE_WRITE | IN_MOVED_TO | IN_DELETE_SELF | IN_MOVE_SELF) >= 0;
}

int live_watch_add(int watch, const char *path)
{
    char real[PAGE_PATH];
    return watch >= 0 && add_folder(watch, path) &&
           (!path_get_absolute(path, real, sizeof real) || add_folder(watch, real));
}

/* A folder that has another name now is not watched any more. */
static unsigned look_at(int watch, const struct inotify_event *event,
                        int (*is_meant)(void *ctx, const char *name), void *ctx)
{
    if (event->mask & IN_MOVE_SELF) {
        (void)inotify_rm_watch(watch, event->wd);
    }
    return ((event->mask & IN_Q_OVERFLOW) || (event->len > 0 && is_meant(ctx, event->name))
                ? LIVE_WATCH_SAVED
                : 0) |
           (event->mask & (IN_DELETE_SELF | IN_MOVE_SELF | IN_UNMOUNT) ? LIVE_WATCH_LOST : 0);
}

unsigned live_watch_take(int watch, int (*is_meant)(void *ctx, const char *name), void *ctx)
{
    union {
        char bytes[8192];
        struct inotify_event aligned;
    } block;
    unsigned found = 0;
    ssize_t size = 0;
    while (watch >= 0 && (size = read(watch, block.bytes, sizeof block.bytes)) > 0) {
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *event =
                (const struct inotify_event *)(const void *)(block.bytes + at);
            found |= look_at(watch, event, is_meant, ctx);
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
    return found;
}

#else

#include <errno.h>

int live_watch_create(void)
{
    errno = ENOSYS;
    return -1;
}

int live_watch_add(int watch, const char *path)
{
    (void)watch;
    (void)path;
    return 0;
}

unsigned live_watch_take(int watch, int (*is_meant)(void *ctx, const char *name), void *ctx)
{
    (void)watch;
    (void)is_meant;
    (void)ctx;
    return 0;
}

#endif
