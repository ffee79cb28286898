/* SPDX-License-Identifier: BSD-3-Clause */
/* Running other programs, and paths. */
#if !defined(_WIN32)
#define _XOPEN_SOURCE 700
#endif

#include "process.h"
#include "file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "options.h"
#include "outcome.h"

enum { PATH_SIZE = 4096 };

#if defined(_WIN32)
#include <direct.h>
#include <io.h>
#include <process.h>

static int is_executable(const char *path)
{
    return _access(path, 0) == 0;
}

int process_run(const char *folder, const char *const *words)
{
    if (folder && _chdir(folder) != 0) {
        return -1;
    }
    return (int)_spawnvp(_P_WAIT, words[0], words);
}

int path_get_absolute(const char *path, char *out, size_t size)
{
    return _fullpath(out, path, size) != NULL;
}
#else
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

static int is_executable(const char *path)
{
    return access(path, X_OK) == 0;
}

int process_run(const char *folder, const char *const *words)
{
    char *copy[64] = {NULL}; /* execvp takes them without const and leaves them alone */
    size_t count = 0;
    int is_whole = words[0] != NULL;
    for (; words[count] && count < 63; ++count) {
        copy[count] = strdup(words[count]);
        is_whole = is_whole && copy[count];
    }
    fflush(NULL);
    const pid_t child = is_whole ? fork() : -1;
    if (child == 0) {
        signal(SIGXFSZ, SIG_DFL); /* this program ignores it */
        if (!folder || chdir(folder) == 0) {
            execvp(copy[0], copy);
        }
        _exit(127);
    }
    for (size_t k = 0; k < count; ++k) {
        free(copy[k]);
    }
    int status = 0;
    pid_t ended = -1;
    do {
        ended = child < 0 ? -1 : waitpid(child, &status, 0);
    } while (ended < 0 && child > 0 && errno == EINTR);
    return ended == child && ended > 0 && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

int path_get_absolute(const char *path, char *out, size_t size)
{
    char *found = realpath(path, NULL);
    const int fits = found && strlen(found) < size;
    if (fits) {
        strcpy(out, found);
    }
    free(found);
    return fits;
}
#endif

static int is_separator(char c)
{
#if defined(_WIN32)
    return c == '/' || c == '\\' || c == ':';
#else
    return c == '/';
#endif
}

/* The place of a program: `name` if it is a path, else on the PATH. @return false: nowhere. */
static int find_program(const char *name, char *path, size_t size)
{
#if defined(_WIN32)
    const char *between = ";";
#else
    const char *between = ":";
#endif
    const char *at = getenv("PATH");
    if (strchr(name, '/')) {
        const int used = snprintf(path, size, "%s", name);
        return used > 0 && (size_t)used < size && is_executable(path);
    }
    while (at && *at) {
        const size_t length = strcspn(at, between);
        const int used = snprintf(path, size, "%.*s/%s", (int)length, at, name);
        if (used > 0 && (size_t)used < size && is_executable(path)) {
            return 1;
        }
        at += length;
        at += *at ? 1 : 0;
    }
    return 0;
}

int process_is_found(const char *name)
{
    char path[PATH_SIZE];
    return find_program(name, path, sizeof path);
}

static const char *own_name = ""; /* by which this program was called */

void process_set_own_name(const char *name)
{
    own_name = name;
}

int process_get_own_folder(char *folder, size_t size)
{
    char path[PATH_SIZE];
    char real[PATH_SIZE];
    const int is_known = path_get_absolute("/proc/self/exe", real, sizeof real) ||
                         (own_name[0] && find_program(own_name, path, sizeof path) &&
                          path_get_absolute(path, real, sizeof real));
    return is_known && path_get_folder(real, folder, size);
}

int process_report_missing(const char *command, const char *name, const char *package)
{
    complain("se3d %s: the program `%s` is not installed; on Debian and Ubuntu:\n"
             "    apt-get install --no-install-recommends %s\n",
             command, name, package);
    return EXIT_FAILED;
}

const char *path_get_name(const char *path)
{
    const char *name = path;
    for (const char *c = path; *c; ++c) {
        name = is_separator(*c) ? c + 1 : name;
    }
    return name;
}

int path_get_folder(const char *path, char *folder, size_t size)
{
    const size_t length = (size_t)(path_get_name(path) - path);
    const int used = length == 0   ? snprintf(folder, size, ".")
                     : length == 1 ? snprintf(folder, size, "%.1s", path)
                                   : snprintf(folder, size, "%.*s", (int)(length - 1), path);
    return used >= 0 && (size_t)used < size;
}

int path_cut(const char *path, const char *extension, char *out, size_t size)
{
    size_t length = strlen(path);
    const size_t tail = strlen(extension);
    if (length > tail && strcmp(path + length - tail, extension) == 0) {
        length -= tail;
    }
    if (length >= size) {
        return 0;
    }
    memmove(out, path, length);
    out[length] = '\0';
    return 1;
}

int path_is_model(const char *path)
{
    static const char *const endings[] = {".yaml", ".yml", ".json"};
    const size_t length = strlen(path);
    if (strcmp(path, "-") == 0) {
        return file_is_missing(path); /* standard input, unless there are results of that name */
    }
    for (size_t k = 0; k < sizeof endings / sizeof *endings; ++k) {
        const size_t tail = strlen(endings[k]);
        if (length > tail && strcmp(path + length - tail, endings[k]) == 0) {
            return 1;
        }
    }
    return 0;
}

int path_is_absolute(const char *path)
{
    return is_separator(path[0]) || (path[0] && path[1] == ':');
}
