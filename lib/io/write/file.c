/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders of results, on POSIX systems and on Windows. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif

#include "io/write/file.h"

#include <errno.h>
#include <string.h>

#if defined(_WIN32)
#include <direct.h>
#include <io.h>
static bool is_folder(const char *path)
{
    (void)path;
    return false; /* opening it fails there */
}

static bool cut(FILE *file, uint64_t size)
{
    return _chsize_s(_fileno(file), (long long)size) == 0;
}

static bool is_link(const char *path)
{
    (void)path;
    return false;
}

static int make_folder(const char *path)
{
    return _mkdir(path);
}
#else
#include <sys/stat.h>
#include <unistd.h>
static bool is_folder(const char *path)
{
    struct stat about;
    return stat(path, &about) == 0 && S_ISDIR(about.st_mode);
}

static bool cut(FILE *file, uint64_t size)
{
    return ftruncate(fileno(file), (off_t)size) == 0;
}

static bool is_link(const char *path)
{
    struct stat about;
    return lstat(path, &about) == 0 && S_ISLNK(about.st_mode);
}

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

bool se3di_file_join(const char *folder, const char *file, char *path, size_t size)
{
    const char *const in = folder ? folder : ".";
    const int length = snprintf(path, size, "%s/%s", in, file);
    if (length < 0 || (size_t)length >= size) {
        errno = ENAMETOOLONG;
        return false;
    }
    for (size_t k = strlen(in) + 1; k <= (size_t)length; ++k) {
        const char c = path[k];
        if (c != '\0' && !is_separator(c)) {
            continue;
        }
        path[k] = '\0';
        const bool leads_away = is_link(path);
        path[k] = c;
        if (leads_away) {
            errno = ELOOP;
            return false;
        }
    }
    return true;
}

/* The path at which a file is written before it has its name. @return false: it is too long. */
static bool format_partial(const char *path, char partial[4200])
{
    const int length = snprintf(partial, 4200, "%s.partial", path);
    return length >= 0 && length < 4200;
}

FILE *se3di_partial_open(const char *path)
{
    char partial[4200];
    if (!format_partial(path, partial)) {
        errno = ENAMETOOLONG;
        return NULL;
    }
    if (is_folder(path)) { /* known before the work, not after it */
        errno = EISDIR;
        return NULL;
    }
    remove(partial); /* of a run that was ended; or a link, which must not be followed */
    errno = 0;
    return fopen(partial, "wbx");
}

bool se3di_partial_close(FILE *file, const char *path)
{
    char partial[4200];
    errno = 0;
    bool good = !ferror(file);
    format_partial(path, partial);
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

bool se3di_partial_keep(FILE *file, const char *path, uint64_t size)
{
    char partial[4200];
    if (!format_partial(path, partial) || !cut(file, size)) {
        return false;
    }
    fclose(file);
#if defined(_WIN32)
    remove(path);
#endif
    rename(partial, path);
    return true;
}

void se3di_partial_abandon(FILE *file, const char *path)
{
    char partial[4200];
    fclose(file);
    if (format_partial(path, partial)) {
        remove(partial);
    }
}
