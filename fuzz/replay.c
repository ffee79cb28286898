/* SPDX-License-Identifier: BSD-3-Clause */
/* The main of a fuzz target without libFuzzer, for any compiler: each file that is named, and each
 * one in a folder that is named, is tried once.
 *
 *     fuzz_model fuzz/seeds/model fuzz/finds/model some.yaml
 *
 * With SE3D_FUZZ_MUTATE=N it is tried N times more with changes by chance, the same ones in every
 * run: a smoke test where there is no libFuzzer. SE3D_FUZZ_SEED begins another row of changes. */
#define _POSIX_C_SOURCE 200809L

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "fuzz.h"

enum { SIZE_MAX_INPUT = 1 << 20, PATH_SIZE = 2000, CHANGES_MAX = 6 };

static size_t input_count;

static uint64_t number_of(const char *name)
{
    const char *text = getenv(name);
    return text ? strtoull(text, NULL, 10) : 0;
}

/* Steele, Lea and Flood's splitmix64. */
static uint64_t draw(uint64_t *state)
{
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}

/* Change some bytes: flip a bit, set one to an end of its range, copy a piece over, cut the end. */
static size_t change(uint8_t *data, size_t size, uint64_t *state)
{
    static const uint8_t ends[] = {0, 1, 0x7f, 0x80, 0xfe, 0xff, '0', '-', '9', '{', '\n', '.'};
    for (uint64_t k = 1 + draw(state) % CHANGES_MAX; k > 0 && size > 0; --k) {
        const size_t at = draw(state) % size, from = draw(state) % size;
        const size_t most = size - (at > from ? at : from);
        switch (draw(state) % 8) {
        case 0:
        case 1:
        case 2:
            data[at] ^= (uint8_t)(1u << draw(state) % 8);
            break;
        case 3:
        case 4:
            data[at] = ends[draw(state) % sizeof ends];
            break;
        case 5:
        case 6:
            memmove(data + at, data + from, 1 + draw(state) % most);
            break;
        default:
            size = draw(state) % 4 == 0 ? at : size;
            break;
        }
    }
    return size;
}

/* Each in memory of its own size, so that a sanitizer sees its end. */
static void mutate(const uint8_t *data, size_t size)
{
    uint64_t state = number_of("SE3D_FUZZ_SEED") + size;
    for (uint64_t k = number_of("SE3D_FUZZ_MUTATE"); k > 0; --k) {
        uint8_t *changed = malloc(size + 1);
        if (!changed) {
            return;
        }
        memcpy(changed, data, size);
        const size_t left = change(changed, size, &state);
        uint8_t *exact = malloc(left + (left == 0));
        if (exact) {
            memcpy(exact, changed, left);
            LLVMFuzzerTestOneInput(exact, left);
            ++input_count;
        }
        free(exact);
        free(changed);
    }
}

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
        mutate(exact, size);
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
