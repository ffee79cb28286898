/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of results and files that are read, in folders where others have left something. */
#define _XOPEN_SOURCE 700
#include <errno.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/hash.h"
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

static uint64_t hash_of(const char *text, size_t length)
{
    return se3di_hash_bytes(SE3DI_HASH_START, text, length);
}

static void write_text(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    CHECK(file && fputs(text, file) >= 0 && fclose(file) == 0);
}

static int has_text(const char *name, const char *text)
{
    char is[64] = "";
    FILE *file = fopen(name, "r");
    const size_t length = file ? fread(is, 1, sizeof is - 1, file) : 0;
    is[length] = '\0';
    return file && fclose(file) == 0 && strcmp(is, text) == 0;
}

static void a_file_that_was_begun_goes_on_after_what_is_known_of_it(void)
{
    FILE *file = se3di_partial_open(path);
    CHECK(file && fputs("one,two,three", file) >= 0);
    se3di_partial_leave(file);
    CHECK(se3di_partial_continue(path, 8, hash_of("one;two,", 8)) == NULL && errno == ESTALE);
    CHECK(se3di_partial_continue(path, 14, hash_of("one,two,three", 13)) == NULL);
    CHECK(errno == ESTALE && has_text(partial, "one,two,three"));
    file = se3di_partial_continue(path, 8, hash_of("one,two,", 8));
    CHECK(file && fputs("four", file) >= 0 && se3di_partial_close(file, path));
    CHECK(has_text(path, "one,two,four") && !exists(partial));
    /* the one that has its name stays as it is until the copy is complete */
    file = se3di_partial_continue(path, 4, hash_of("one,", 4));
    CHECK(file && has_text(path, "one,two,four"));
    CHECK(file && fputs("five", file) >= 0 && se3di_partial_close(file, path));
    CHECK(has_text(path, "one,five"));
    CHECK(unlink(path) == 0);
    CHECK(se3di_partial_continue(path, 4, hash_of("one,", 4)) == NULL && errno == ESTALE);
    CHECK(mkfifo(path, 0600) == 0);
    CHECK(se3di_partial_continue(path, 4, hash_of("one,", 4)) == NULL && errno == ESTALE);
    CHECK(unlink(path) == 0 && mkdir(partial, 0700) == 0);
    write_text(path, "one,two");
    CHECK(se3di_partial_continue(path, 4, hash_of("one,", 4)) == NULL && errno != 0);
    CHECK(has_text(path, "one,two") && rmdir(partial) == 0 && unlink(path) == 0);
}

/* Several blocks, the last of which is not full. */
static void long_beginnings_are_known(void)
{
    enum { SIZE = 10000 };
    static char text[SIZE];
    memset(text, 'x', sizeof text);
    FILE *file = se3di_partial_open(path);
    CHECK(file && fwrite(text, 1, SIZE, file) == SIZE && se3di_partial_close(file, path));
    text[SIZE - 2] = 'y';
    CHECK(se3di_partial_continue(path, SIZE - 1, hash_of(text, SIZE - 1)) == NULL);
    file = se3di_partial_continue(path, SIZE - 2, hash_of(text, SIZE - 2));
    CHECK(file && ftell(file) == SIZE - 2);
    se3di_partial_abandon(file, path);
    CHECK(exists(path) && !exists(partial) && unlink(path) == 0);
}

static void rows_that_were_written_are_kept(void)
{
    FILE *file = se3di_partial_open(path);
    CHECK(file && fputs("whole row\nhalf a", file) >= 0 && fflush(file) == 0);
    CHECK(file && se3di_partial_keep(file, path, 10));
    CHECK(has_text(path, "whole row\n") && unlink(path) == 0);
    file = se3di_partial_open(path);
    CHECK(file && fputs("row\nro", file) >= 0 && fflush(file) == 0 && mkdir(path, 0700) == 0);
    CHECK(file && se3di_partial_keep(file, path, 4)); /* under the temporary name */
    CHECK(has_text(partial, "row\n") && rmdir(path) == 0);
    file = fopen(partial, "r"); /* what cannot be cut is not kept */
    CHECK(file && !se3di_partial_keep(file, path, 2) && !exists(path));
    se3di_partial_abandon(file, path);
    CHECK(!exists(partial));
}

static void a_disk_that_is_full_is_told(void)
{
    FILE *full = fopen("/dev/full", "w");
    if (!full) {
        return;
    }
    touch(partial);
    errno = 0;
    CHECK(fputs("x", full) >= 0 && !se3di_file_sync(full) && errno == ENOSPC);
    CHECK(!se3di_file_cut(full, 0));
    CHECK(!se3di_partial_close(full, path) && errno != 0);
    CHECK(!exists(path) && !exists(partial));
    int ends[2];
    CHECK(pipe(ends) == 0);
    FILE *tube = fdopen(ends[1], "w");
    CHECK(tube && fputs("x", tube) >= 0 && se3di_file_sync(tube)); /* no disk, no mistake */
    CHECK(tube && !se3di_file_seek(tube, 0) && fclose(tube) == 0 && close(ends[0]) == 0);
}

/* Room for 4096 characters: what does not fit is refused, not cut. */
static void names_that_are_too_long_are_told(void)
{
    static char name[5000], made[5000];
    int hold = 0;
    memset(name, 'n', 4594);
    CHECK(se3di_partial_open(name) == NULL && errno == ENAMETOOLONG);
    errno = 0;
    CHECK(se3di_partial_continue(name, 0, SE3DI_HASH_START) == NULL && errno == ENAMETOOLONG);
    se3di_file_remove(name);
    memset(name, 'n', sizeof name - 1);
    errno = 0;
    CHECK(!se3di_file_make_folders(name) && errno == ENAMETOOLONG);
    errno = 0;
    CHECK(!se3di_file_join(folder, name, made, sizeof made) && errno == ENAMETOOLONG);
    errno = 0;
    CHECK(!se3di_temporary_make(folder, made, strlen(folder) + 12) && errno == ENAMETOOLONG);
    errno = 0;
    CHECK(!se3di_temporary_hold(folder, made, strlen(folder) + 12, &hold) && errno == ENAMETOOLONG);
    CHECK(hold == -1);
    errno = 0;
    CHECK(!se3di_file_find_folder(folder, made, 5) && errno == ENAMETOOLONG);
    /* room for the first name, not for that of a folder that is held */
    CHECK(se3di_temporary_hold(folder, made, strlen(folder) + 13, &hold) && hold == -1);
    CHECK_CONTAINS(made, "/se3d-");
    CHECK(exists(made));
    se3di_temporary_release(made, hold);
    CHECK(!exists(made));
}

static void paths_are_joined_and_found(void)
{
    char made[400], inner[400], link[300];
    CHECK(se3di_file_join(folder, "a/b.csv", made, sizeof made));
    CHECK(strncmp(made, folder, strlen(folder)) == 0 &&
          strcmp(made + strlen(folder), "/a/b.csv") == 0);
    CHECK(se3di_file_join(NULL, "b", made, sizeof made) && strcmp(made, "./b") == 0);
    CHECK(se3di_file_make_folders(made));
    snprintf(inner, sizeof inner, "%s/x//y/z.csv", folder);
    CHECK(se3di_file_make_folders(inner) && se3di_file_make_folders(inner));
    snprintf(inner, sizeof inner, "%s/x/y", folder);
    CHECK(exists(inner) && rmdir(inner) == 0);
    snprintf(link, sizeof link, "%s/x/away", folder);
    CHECK(symlink("/tmp", link) == 0);
    errno = 0;
    CHECK(!se3di_file_join(folder, "x/away/b.csv", made, sizeof made) && errno == ELOOP);
    errno = 0;
    CHECK(!se3di_file_join(folder, "x/away", made, sizeof made) && errno == ELOOP);
    CHECK(unlink(link) == 0);
    touch(link);
    snprintf(inner, sizeof inner, "%s/b/c.csv", link);
    errno = 0;
    CHECK(!se3di_file_make_folders(inner) && errno == ENOTDIR); /* in a file */
    errno = 0;
    CHECK(se3di_file_create(link) == NULL && errno == EEXIST);
    CHECK(unlink(link) == 0);
    snprintf(inner, sizeof inner, "%s/x", folder);
    CHECK(se3di_file_find_folder(inner, made, sizeof made));
    CHECK(made[strlen(made) - 1] == '/' && rmdir(inner) == 0);
    errno = 0;
    CHECK(!se3di_file_find_folder(inner, made, sizeof made) && errno == ENOENT);
    CHECK(se3di_file_find_folder("/", made, sizeof made) && strcmp(made, "/") == 0);
    CHECK(se3di_file_find_folder("", made, sizeof made) && made[0] == '/' &&
          made[strlen(made) - 1] == '/');
    CHECK(se3di_file_is_hdf5("a.h5") && se3di_file_is_hdf5("a.b.hdf5"));
    CHECK(!se3di_file_is_hdf5("a.csv") && !se3di_file_is_hdf5("h5"));
    CHECK(!se3di_file_is_same(folder, inner));
}

static void only_regular_files_are_gone_on_with(void)
{
    CHECK(mkfifo(path, 0600) == 0);
    errno = 0;
    CHECK(se3di_file_continue(path) == NULL && errno == EINVAL);
    CHECK(unlink(path) == 0 && symlink("nowhere", path) == 0);
    errno = 0;
    CHECK(se3di_file_continue(path) == NULL && errno == ELOOP);
    CHECK(unlink(path) == 0);
    const pid_t child = fork();
    if (child == 0) { /* who ends a little later has ended */
        FILE *file = se3di_file_continue(path);
        const struct timespec pause = {0, 100000000};
        nanosleep(&pause, NULL);
        _exit(file ? 0 : 1);
    }
    while (!exists(path)) {
    }
    FILE *file = se3di_file_continue(path);
    int status = 1;
    CHECK(file && fclose(file) == 0);
    CHECK(waitpid(child, &status, 0) == child && status == 0 && unlink(path) == 0);
}

/* Deep trees and those of other users are left, as are names that only look alike. */
static void what_is_not_its_own_is_not_taken_away(void)
{
    char name[700], like[300], made[300];
    int hold = -1;
    for (int depth = 60; depth <= 70; depth += 10) {
        size_t length = (size_t)snprintf(name, sizeof name, "%s/deep", folder);
        CHECK(mkdir(name, 0700) == 0);
        for (int k = 0; k < depth; ++k) {
            length += (size_t)snprintf(name + length, sizeof name - length, "/d");
            CHECK(mkdir(name, 0700) == 0);
        }
        name[strlen(folder) + 5] = '\0';
        se3di_temporary_remove(name);
        CHECK(exists(name) == (depth > 64));
    }
    snprintf(like, sizeof like, "%s/shallow", folder);
    strcat(name, "/d/d/d/d/d/d/d/d/d/d");
    CHECK(rename(name, like) == 0);
    se3di_temporary_remove(like);
    name[strlen(folder) + 5] = '\0';
    se3di_temporary_remove(name);
    CHECK(!exists(name) && !exists(like));
    snprintf(like, sizeof like, "%s/se3d-held-abcdefg", folder);
    CHECK(mkdir(like, 0700) == 0);
    CHECK(se3di_temporary_hold(folder, made, sizeof made, &hold));
    se3di_temporary_release(made, hold);
    CHECK(exists(like) && !exists(made));
    if (geteuid() == 0) {
        CHECK(chown(like, 12345, 12345) == 0);
        se3di_temporary_remove(like);
        CHECK(exists(like));
    }
    CHECK(rmdir(like) == 0);
    se3di_temporary_remove(like); /* which is not there */
}

/* Without descriptors a folder is made, and not held. */
static void descriptors_that_are_all_taken_are_survived(void)
{
    char made[300];
    int hold = 0;
    struct rlimit before;
    CHECK(getrlimit(RLIMIT_NOFILE, &before) == 0);
    const struct rlimit none = {3, before.rlim_max};
    CHECK(setrlimit(RLIMIT_NOFILE, &none) == 0);
    const int is_held = se3di_temporary_hold(folder, made, sizeof made, &hold);
    const FILE *file = se3di_partial_open(path);
    const int why = errno;
    CHECK(setrlimit(RLIMIT_NOFILE, &before) == 0);
    CHECK(is_held && hold == -1 && exists(made));
    CHECK(!file && why == EMFILE);
    (void)remove(partial); /* valgrind takes descriptors away when files have been made */
    se3di_temporary_release(made, hold);
    CHECK(!exists(made));
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
    RUN(a_file_that_was_begun_goes_on_after_what_is_known_of_it);
    RUN(long_beginnings_are_known);
    RUN(rows_that_were_written_are_kept);
    RUN(a_disk_that_is_full_is_told);
    RUN(names_that_are_too_long_are_told);
    RUN(paths_are_joined_and_found);
    RUN(only_regular_files_are_gone_on_with);
    RUN(what_is_not_its_own_is_not_taken_away);
    RUN(descriptors_that_are_all_taken_are_survived);
    CHECK(rmdir(folder) == 0);
    return check_finish();
}
