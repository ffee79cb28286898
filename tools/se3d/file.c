/* SPDX-License-Identifier: BSD-3-Clause */
/* Copying and asking about files, on POSIX systems and on Windows. */
#if !defined(_WIN32)
#define _XOPEN_SOURCE 700
#endif

#include "file.h"

#include <errno.h>
#include <string.h>

enum { BLOCK = 1 << 16 };

#if defined(_WIN32)
int file_is_own(const char *path)
{
    FILE *file = fopen(path, "rb");
    return file && fclose(file) == 0;
}

int file_is_missing(const char *path)
{
    (void)path;
    return 0;
}
#else
#include <sys/stat.h>
#include <unistd.h>

int file_is_own(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && (about.st_uid == geteuid() || about.st_uid == 0) &&
           (about.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

int file_is_missing(const char *path)
{
    struct stat about;
    return lstat(path, &about) != 0 && errno == ENOENT;
}
#endif

int file_end(FILE *file, const char *path, int good)
{
    if (good) {
        return se3di_partial_close(file, path);
    }
    const int why = errno ? errno : ENOSPC;
    se3di_partial_abandon(file, path);
    errno = why;
    return 0;
}

int file_append(FILE *file, const char *from)
{
    char block[BLOCK];
    FILE *source = se3di_file_open(from);
    size_t used = 0;
    int good = source != NULL;
    while (good && (used = fread(block, 1, sizeof block, source)) > 0) {
        good = fwrite(block, 1, used, file) == used;
    }
    if (source) {
        const int why = errno;
        good = !ferror(source) && good;
        fclose(source);
        errno = why;
    }
    return good;
}

int file_copy(const char *from, const char *to)
{
    FILE *file = se3di_partial_open(to);
    return file && file_end(file, to, file_append(file, from));
}
