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

static void add_folder(int watch, const char *path)
{
    char folder[PAGE_PATH];
    if (path_get_folder(path, folder, sizeof folder)) {
        (void)inotify_add_watch(watch, folder, IN_CLOSE_WRITE | IN_MOVED_TO);
    }
}

void live_watch_add(int watch, const char *path)
{
    char real[PAGE_PATH];
    if (watch < 0) {
        return;
    }
    add_folder(watch, path);
    if (path_get_absolute(path, real, sizeof real)) {
        add_folder(watch, real);
    }
}

int live_watch_take(int watch, int (*is_meant)(void *ctx, const char *name), void *ctx)
{
    union {
        char bytes[8192];
        struct inotify_event aligned;
    } block;
    int found = 0;
    ssize_t size = 0;
    while (watch >= 0 && (size = read(watch, block.bytes, sizeof block.bytes)) > 0) {
        for (ssize_t at = 0; at < size;) {
            const struct inotify_event *event =
                (const struct inotify_event *)(const void *)(block.bytes + at);
            found = found || (event->mask & IN_Q_OVERFLOW) != 0 ||
                    (event->len > 0 && is_meant(ctx, event->name));
            at += (ssize_t)(sizeof *event + event->len);
        }
    }
    return found;
}

#else

int live_watch_create(void)
{
    return -1;
}

void live_watch_add(int watch, const char *path)
{
    (void)watch;
    (void)path;
}

int live_watch_take(int watch, int (*is_meant)(void *ctx, const char *name), void *ctx)
{
    (void)watch;
    (void)is_meant;
    (void)ctx;
    return 0;
}

#endif
