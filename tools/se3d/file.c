/* SPDX-License-Identifier: BSD-3-Clause */
/* Safe reading and writing, on POSIX systems and on Windows. */
#if !defined(_WIN32)
#define _XOPEN_SOURCE 700
#endif

#include "file.h"

#include <errno.h>
#include <string.h>

enum { PATH_SIZE = 4300, BLOCK = 1 << 16 };

#if defined(_WIN32)
static FILE *open_new(const char *path)
{
    return fopen(path, "wbx");
}

FILE *file_read(const char *path)
{
    return fopen(path, "rb");
}

int file_is_own(const char *path)
{
    FILE *file = fopen(path, "rb");
    return file && fclose(file) == 0;
}
#else
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

static FILE *open_new(const char *path)
{
    const int number = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    FILE *file = number >= 0 ? fdopen(number, "wb") : NULL;
    if (number >= 0 && !file) {
        close(number);
    }
    return file;
}

FILE *file_read(const char *path)
{
    struct stat about;
    const int number = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (number < 0) {
        return NULL;
    }
    const int known = fstat(number, &about) == 0;
    FILE *file = known && S_ISREG(about.st_mode) ? fdopen(number, "rb") : NULL;
    if (!file) {
        const int why = !known                    ? errno
                        : S_ISDIR(about.st_mode)  ? EISDIR
                        : !S_ISREG(about.st_mode) ? EINVAL
                                                  : ENOMEM;
        close(number);
        errno = why;
    }
    return file;
}

int file_is_own(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && (about.st_uid == geteuid() || about.st_uid == 0) &&
           (about.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}
#endif

static int format_partial(const char *path, char partial[PATH_SIZE])
{
    const int length = snprintf(partial, PATH_SIZE, "%s.partial", path);
    if (length < 0 || length >= PATH_SIZE) {
        errno = ENAMETOOLONG;
        return 0;
    }
    return 1;
}

FILE *file_begin(const char *path)
{
    char partial[PATH_SIZE];
    if (!format_partial(path, partial)) {
        return NULL;
    }
    remove(partial);
    errno = 0;
    return open_new(partial);
}

int file_end(FILE *file, const char *path, int good)
{
    char partial[PATH_SIZE];
    const int before = errno;
    format_partial(path, partial);
    errno = 0;
    good = !ferror(file) && good;
    good = fclose(file) == 0 && good;
#if defined(_WIN32)
    if (good) {
        remove(path); /* rename does not replace there */
    }
#endif
    if (good && rename(partial, path) == 0) {
        return 1;
    }
    const int why = errno ? errno : before ? before : ENOSPC; /* a write before has failed */
    remove(partial);
    errno = why;
    return 0;
}

int file_append(FILE *file, const char *from)
{
    char block[BLOCK];
    FILE *source = file_read(from);
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
    FILE *file = file_begin(to);
    return file && file_end(file, to, file_append(file, from));
}
