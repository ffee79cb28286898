/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of results and files that are read, in folders where others have left something. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "check.h"
#include "io/base/file.h"

static char folder[200];
static char path[300], partial[320];

static int exists(const char *name)
{
    struct stat about;
    return lstat(name, &about) == 0;
}

static void a_file_has_its_name_only_when_it_is_complete(void)
{
    FILE *file = se3di_partial_open(path);
    CHECK(file && exists(partial) && !exists(path));
    CHECK(file && fputs("x", file) >= 0 && se3di_partial_close(file, path));
    CHECK(!exists(partial) && exists(path));
    file = se3di_partial_open(path);
    CHECK(file != NULL);
    se3di_partial_abandon(file, path);
    CHECK(!exists(partial) && exists(path));
    CHECK(unlink(path) == 0);
}

static void what_stood_under_the_temporary_name_goes_but_is_not_followed(void)
{
    char target[300];
    snprintf(target, sizeof target, "%s/target", folder);
    CHECK(symlink(target, partial) == 0);
    FILE *file = se3di_partial_open(path);
    CHECK(file && se3di_partial_close(file, path));
    CHECK(!exists(target) && exists(path));
    CHECK(unlink(path) == 0);
}

static void an_empty_folder_of_that_name_stays(void)
{
    CHECK(mkdir(partial, 0700) == 0);
    errno = 0;
    CHECK(se3di_partial_open(path) == NULL && errno != 0);
    CHECK(exists(partial));
    CHECK(rmdir(partial) == 0);
    CHECK(mkdir(path, 0700) == 0);
    CHECK(se3di_partial_open(path) == NULL && errno == EISDIR);
    CHECK(rmdir(path) == 0);
}

/* What stands under the name of a file to be is replaced only if it is a file, or a link. */
static void pipes_are_not_replaced(void)
{
    char link[300];
    snprintf(link, sizeof link, "%s/link", folder);
    CHECK(mkfifo(path, 0600) == 0 && symlink(path, link) == 0);
    CHECK(se3di_partial_open(path) == NULL && errno == EINVAL);
    CHECK(se3di_partial_open(link) == NULL && errno == EINVAL);
    CHECK_CONTAINS(se3di_file_get_text(EINVAL), "is no regular file");
    CHECK(unlink(path) == 0);
    FILE *file = se3di_partial_open(path);
    CHECK(file && mkfifo(path, 0600) == 0);
    CHECK(file && !se3di_partial_close(file, path) && errno == EINVAL);
    CHECK(!exists(partial) && unlink(path) == 0);
    file = se3di_partial_open(link); /* it leads to nothing */
    CHECK(file && se3di_partial_close(file, link) && !exists(path));
    CHECK(unlink(link) == 0);
}

static void two_paths_of_one_file_are_known(void)
{
    char link[300];
    char other[300];
    snprintf(link, sizeof link, "%s/link", folder);
    snprintf(other, sizeof other, "%s/./a.csv", folder);
    CHECK(!se3di_file_is_same(path, path)); /* it is not there */
    FILE *file = se3di_partial_open(path);
    CHECK(file && se3di_partial_close(file, path) && symlink("a.csv", link) == 0);
    CHECK(se3di_file_is_same(path, other) && se3di_file_is_same(path, link));
    CHECK(!se3di_file_is_same(path, folder));
    CHECK(unlink(path) == 0 && unlink(link) == 0);
}

/* Opening a pipe that nobody writes to must not wait. */
static void only_regular_files_are_opened_for_reading(void)
{
    CHECK(mkfifo(path, 0600) == 0);
    CHECK(se3di_file_open(path) == NULL && errno == EINVAL);
    CHECK(unlink(path) == 0);
    CHECK(se3di_file_open(folder) == NULL && errno == EISDIR);
    CHECK(se3di_file_open(path) == NULL && errno == ENOENT);
}

static void touch(const char *name)
{
    FILE *file = fopen(name, "w");
    CHECK(file && fclose(file) == 0);
}

/* A tree whose process was killed, with a folder `in`, in which many files are, and a link. */
static void leave_folder(const char *held, const char *far)
{
    char name[400];
    CHECK(mkdir(held, 0700) == 0);
    snprintf(name, sizeof name, "%s/link", held);
    CHECK(symlink(far, name) == 0);
    snprintf(name, sizeof name, "%s/in", held);
    CHECK(mkdir(name, 0700) == 0);
    for (int k = 0; k < 40; ++k) {
        snprintf(name, sizeof name, "%s/in/%d", held, k);
        touch(name);
    }
}

/* Another user, who may write where temporary folders are, puts links in the place of those that
 * are being swept: for ever. */
static void exchange_folders(const char *held, const char *far)
{
    char in[400], away[400], outside[400];
    snprintf(in, sizeof in, "%s/in", held);
    snprintf(away, sizeof away, "%s/away", held);
    snprintf(outside, sizeof outside, "%s-away", held);
    for (;;) {
        if (rename(in, away) == 0 && symlink(far, in) == 0) {
            unlink(in);
        }
        rename(away, in);
        if (rename(held, outside) == 0 && symlink(far, held) == 0) {
            unlink(held);
        }
        rename(outside, held);
    }
}

static void what_was_left_is_swept_and_nothing_else(void)
{
    char far[300], kept[400], held[300], made[300];
    struct stat about;
    snprintf(far, sizeof far, "%s/far", folder);
    snprintf(held, sizeof held, "%s/se3d-held-abcdef", folder);
    CHECK(mkdir(far, 0700) == 0);
    for (int k = 0; k < 40; ++k) {
        snprintf(kept, sizeof kept, "%s/%d", far, k);
        touch(kept);
    }
    for (int round = 0; round < 60; ++round) {
        int hold = -1;
        leave_folder(held, far);
        const pid_t child = round < 2 ? 0 : fork();
        if (round >= 2 && child == 0) {
            exchange_folders(held, far);
        }
        CHECK(se3di_temporary_hold(folder, made, sizeof made, &hold) && hold >= 0);
        if (child > 0) {
            CHECK(kill(child, SIGKILL) == 0 && waitpid(child, NULL, 0) == child);
        }
        CHECK(round >= 2 || !exists(held));
        se3di_temporary_release(made, hold);
        CHECK(!exists(made));
        for (int k = 0; k < 40; ++k) {
            snprintf(kept, sizeof kept, "%s/%d", far, k);
            CHECK(lstat(kept, &about) == 0);
        }
        char rest[400];
        snprintf(rest, sizeof rest, "%s-away", held);
        unlink(held);
        se3di_temporary_remove(held);
        se3di_temporary_remove(rest);
        CHECK(!exists(held) && !exists(rest));
    }
    se3di_temporary_remove(far);
    CHECK(!exists(far));
}

int main(void)
{
    const char *where = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%.100s/se3d-files-XXXXXX", where && where[0] ? where : "/tmp");
    if (!mkdtemp(folder)) {
        return 1;
    }
    snprintf(path, sizeof path, "%s/a.csv", folder);
    snprintf(partial, sizeof partial, "%s.partial", path);
    RUN(a_file_has_its_name_only_when_it_is_complete);
    RUN(what_stood_under_the_temporary_name_goes_but_is_not_followed);
    RUN(an_empty_folder_of_that_name_stays);
    RUN(pipes_are_not_replaced);
    RUN(two_paths_of_one_file_are_known);
    RUN(only_regular_files_are_opened_for_reading);
    RUN(what_was_left_is_swept_and_nothing_else);
    rmdir(folder);
    return check_finish();
}
