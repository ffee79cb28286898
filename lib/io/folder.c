/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders of results, on POSIX systems and on Windows. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif

#include <errno.h>
#include <string.h>

#include "io/csv.h"

#if defined(_WIN32)
#include <direct.h>
static int make_folder(const char *path)
{
    return _mkdir(path);
}
#else
#include <sys/stat.h>
static int make_folder(const char *path)
{
    return mkdir(path, 0777);
}
#endif

static bool is_separator(char c)
{
#if defined(_WIN32)
    return c == '/' || c == '\\';
#else
    return c == '/';
#endif
}

bool se3di_file_make_folders(const char *path)
{
    char part[4096];
    const size_t length = strlen(path);
    if (length >= sizeof part) {
        errno = ENAMETOOLONG;
        return false;
    }
    for (size_t k = 0; k < length; ++k) {
        part[k] = path[k];
        if (k == 0 || !is_separator(path[k]) || is_separator(path[k - 1])) {
            continue;
        }
        part[k] = '\0';
        if (make_folder(part) != 0 && errno != EEXIST && errno != EISDIR && errno != EACCES) {
            return false; /* a folder without permission is reported when the file is opened */
        }
        part[k] = path[k];
    }
    return true;
}

static bool is_absolute(const char *path)
{
#if defined(_WIN32)
    return path[0] == '/' || path[0] == '\\' || (path[0] && path[1] == ':');
#else
    return path[0] == '/';
#endif
}

bool se3di_file_join(const char *folder, const char *file, char *path, size_t size)
{
    const int length = is_absolute(file)
                           ? snprintf(path, size, "%s", file)
                           : snprintf(path, size, "%s/%s", folder ? folder : ".", file);
    return length >= 0 && (size_t)length < size;
}

FILE *se3di_partial_open(const char *path)
{
    char partial[4200];
    errno = 0;
    const int length = snprintf(partial, sizeof partial, "%s.partial", path);
    if (length < 0 || (size_t)length >= sizeof partial) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    return fopen(partial, "wb");
}

bool se3di_partial_close(FILE *file, const char *path)
{
    char partial[4200];
    errno = 0;
    bool good = !ferror(file);
    snprintf(partial, sizeof partial, "%s.partial", path);
    good = fclose(file) == 0 && good;
#if defined(_WIN32)
    remove(path); /* rename does not replace there */
#endif
    if (good && rename(partial, path) == 0) {
        return true;
    }
    const int why = errno ? errno : ENOSPC; /* a write before has failed */
    remove(partial);
    errno = why;
    return false;
}
