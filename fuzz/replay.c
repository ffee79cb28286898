/* SPDX-License-Identifier: BSD-3-Clause */
/* The main of a fuzz target without libFuzzer, for any compiler: each file that is named, and each
 * one in a folder that is named, is tried once.
 *
 *     fuzz_model fuzz/seeds/model fuzz/finds/model some.yaml */
#define _POSIX_C_SOURCE 200809L

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "fuzz.h"

enum { SIZE_MAX_INPUT = 1 << 20, PATH_SIZE = 2000 };

static size_t input_count;

static int replay_file(const char *path)
{
    FILE *file = fopen(path, "rb");
    uint8_t *data = malloc(SIZE_MAX_INPUT);
    const size_t room = SIZE_MAX_INPUT;
    if (!file || !data) {
        fprintf(stderr, "%s: cannot be read\n", path);
        exit(2);
    }
    const size_t size = fread(data, 1, room, file);
    fclose(file);
    uint8_t *exact = malloc(size + (size == 0)); /* so that a sanitizer sees its end */
    if (exact) {
        for (size_t k = 0; k < size; ++k) {
            exact[k] = data[k];
        }
        printf("%s\n", path);
        fflush(stdout);
        LLVMFuzzerTestOneInput(exact, size);
        ++input_count;
    }
    free(exact);
    free(data);
    return exact != NULL;
}

static void replay(const char *path)
{
    struct stat info;
    if (stat(path, &info) != 0) {
        fprintf(stderr, "%s: there is no such file or folder\n", path);
        exit(2);
    }
    DIR *folder = S_ISDIR(info.st_mode) ? opendir(path) : NULL;
    if (!folder) {
        replay_file(path);
        return;
    }
    for (struct dirent *entry = readdir(folder); entry; entry = readdir(folder)) {
        char name[PATH_SIZE];
        if (entry->d_name[0] != '.') {
            snprintf(name, sizeof name, "%.1000s/%.900s", path, entry->d_name);
            replay(name);
        }
    }
    closedir(folder);
}

int main(int argc, char **argv)
{
    for (int k = 1; k < argc; ++k) {
        replay(argv[k]);
    }
    printf("%zu inputs\n", input_count);
    return input_count == 0;
}
