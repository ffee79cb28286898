/* SPDX-License-Identifier: BSD-3-Clause */
#define _XOPEN_SOURCE 700
#include "folder.h"

#include <dirent.h>
#include <errno.h>
#include <ftw.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#define PATH_SIZE 4400

static int copy_file(const char *from, const char *to)
{
    char part[65536];
    size_t count;
    FILE *in = fopen(from, "rb");
    FILE *out = in ? fopen(to, "wb") : NULL;
    int good = out != NULL;
    while (good && (count = fread(part, 1, sizeof part, in)) > 0) {
        good = fwrite(part, 1, count, out) == count;
    }
    good = in && !ferror(in) && good;
    if (in) {
        (void)fclose(in);
    }
    if (out) {
        good = fclose(out) == 0 && good;
    }
    return good;
}

static int copy_entry(const char *from, const char *to)
{
    struct stat info;
    if (stat(from, &info) != 0) {
        return 0;
    }
    if (S_ISDIR(info.st_mode)) {
        return mkdir(to, 0700) == 0 && folder_copy(from, to);
    }
    return !S_ISREG(info.st_mode) || copy_file(from, to);
}

int folder_copy(const char *from, const char *to)
{
    DIR *folder = opendir(from);
    const struct dirent *entry;
    int good = 1;
    if (!folder) {
        return errno == ENOENT;
    }
    while (good && (entry = readdir(folder))) {
        char here[PATH_SIZE], there[PATH_SIZE];
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0) {
            continue;
        }
        const int a = snprintf(here, sizeof here, "%s/%s", from, entry->d_name);
        const int b = snprintf(there, sizeof there, "%s/%s", to, entry->d_name);
        good = a > 0 && a < PATH_SIZE && b > 0 && b < PATH_SIZE && copy_entry(here, there);
    }
    (void)closedir(folder);
    return good;
}

static int remove_entry(const char *path, const struct stat *info, int type, struct FTW *walk)
{
    (void)info;
    (void)type;
    (void)walk;
    (void)remove(path);
    return 0;
}

void folder_remove(const char *path)
{
    (void)nftw(path, remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}
