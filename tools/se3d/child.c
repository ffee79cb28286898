/* SPDX-License-Identifier: BSD-3-Clause */
/* Programs beside this one, on POSIX systems. */
#define _XOPEN_SOURCE 700

#include "child.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "interrupt.h"
#include "io/base/file.h"

void child_pause(int milliseconds)
{
    const struct timespec moment = {milliseconds / 1000, milliseconds % 1000 * 1000000L};
    nanosleep(&moment, NULL);
}

static void close_one(int *end)
{
    if (*end >= 0) {
        close(*end);
    }
    *end = -1;
}

/* A pipe whose ends are above all numbers that a program expects, and closed in every program. */
static int open_pipe(int ends[2])
{
    int low[2];
    if (pipe(low) != 0) {
        return 0;
    }
    ends[0] = fcntl(low[0], F_DUPFD_CLOEXEC, 16);
    ends[1] = fcntl(low[1], F_DUPFD_CLOEXEC, 16);
    close(low[0]);
    close(low[1]);
    return ends[0] >= 0 && ends[1] >= 0;
}

/* In the new process; does not return. */
static void become(char *const *words, const int to[2], const int from[2], const int numbers[2],
                   int mute)
{
    const int nothing = open("/dev/null", O_RDWR);
    signal(SIGPIPE, SIG_DFL);
    signal(SIGXFSZ, SIG_DFL); /* this program ignores it */
    setpgid(0, 0);
    dup2(nothing, 0);
    if (mute) {
        dup2(nothing, 1);
        dup2(nothing, 2);
    }
    if (to[0] >= 0) {
        dup2(to[0], numbers[0]);
    }
    if (from[1] >= 0) {
        dup2(from[1], numbers[1]);
    }
    execvp(words[0], words);
    _exit(127);
}

int child_start(child *c, const char *const *words, int reads, int writes, int mute)
{
    int to[2] = {-1, -1};
    int from[2] = {-1, -1};
    char *copy[64] = {NULL}; /* execvp takes them without const and leaves them alone */
    const int numbers[2] = {reads, writes};
    const child none = {0, -1, -1};
    *c = none;
    for (size_t k = 0; words[k] && k < 63; ++k) {
        copy[k] = strdup(words[k]);
    }
    fflush(NULL);
    const int ready = (reads < 0 || open_pipe(to)) && (writes < 0 || open_pipe(from));
    const pid_t id = ready && copy[0] ? fork() : -1;
    if (id == 0) {
        become(copy, to, from, numbers, mute);
    }
    for (size_t k = 0; k < 63; ++k) {
        free(copy[k]);
    }
    close_one(&to[0]);
    close_one(&from[1]);
    if (id < 0) {
        close_one(&to[1]);
        close_one(&from[0]);
        return 0;
    }
    setpgid(id, id); /* also here: whoever comes first */
    c->id = id;
    c->to = to[1];
    c->from = from[0];
    return 1;
}

int child_write(child *c, const void *data, size_t size)
{
    const char *at = data;
    while (size > 0) {
        const ssize_t written = write(c->to, at, size);
        if (written < 0 && errno == EINTR && !interrupt_came()) {
            continue;
        }
        if (written <= 0) {
            return 0;
        }
        at += written;
        size -= (size_t)written;
    }
    return 1;
}

size_t child_read(child *c, void *data, size_t size, int seconds)
{
    struct pollfd wait = {c->from, POLLIN, 0};
    if (interrupt_came() || poll(&wait, 1, 1000 * seconds) <= 0) {
        return 0;
    }
    const ssize_t count = read(c->from, data, size);
    return count > 0 ? (size_t)count : 0;
}

int child_finish(child *c, int seconds)
{
    int status = 0;
    pid_t ended = 0;
    if (c->id == 0) {
        return -1;
    }
    close_one(&c->to);
    close_one(&c->from);
    const pid_t id = (pid_t)c->id;
    for (int k = 0; k < 50 * seconds && ended == 0; ++k) {
        ended = waitpid(id, &status, WNOHANG);
        if (ended == 0) {
            child_pause(20);
        }
    }
    kill(-id, SIGKILL); /* the group: also what it has started */
    if (ended == 0) {
        waitpid(id, NULL, 0);
    }
    c->id = 0;
    return ended == id && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int folder_make_temporary(char *path, size_t size)
{
    const char *where = getenv("TMPDIR");
    return se3di_temporary_make(where && where[0] == '/' ? where : NULL, path, size);
}

void folder_remove(const char *path)
{
    for (int k = 0; k < 100; ++k) {
        se3di_temporary_remove(path);
        if (access(path, F_OK) != 0) {
            return;
        }
        child_pause(20);
    }
}
