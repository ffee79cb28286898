/* SPDX-License-Identifier: BSD-3-Clause */
/* Archives: each input is unpacked as an archive (zip), also with the checksums that its files
 * would need, and as bytes packed by Deflate behind the size they are to have. What is refused has
 * a reason, and nothing is written beside the folder that was asked for. */
#define _XOPEN_SOURCE 700

#include "fuzz.h"

#include <dirent.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "io/base/inflate.h"
#include "io/base/unzip.h"

enum { PATH_SIZE = 1000, ENTRY_SIZE = 46, LOCAL_SIZE = 30, CONTENT_MAX = 1 << 20, HANDLES = 8 };

static bool want_all(const char *name)
{
    (void)name;
    return true;
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *at)
{
    (void)status, (void)kind, (void)at;
    return remove(path);
}

/* What a folder holds beside `.` and `..`. */
static size_t count_names(const char *folder)
{
    size_t count = 0;
    DIR *list = opendir(folder);
    FUZZ_MUST(list != NULL);
    while (readdir(list)) {
        ++count;
    }
    closedir(list);
    return count - 2;
}

static void unpack(const uint8_t *data, size_t size)
{
    char outer[PATH_SIZE], inner[PATH_SIZE + 8], problem[400] = "";
    const char *path = fuzz_write_file("a.zip", data, size);
    snprintf(outer, sizeof outer, "%.*s", (int)(strrchr(path, '/') - path), path);
    snprintf(inner, sizeof inner, "%s/in", outer);
    FUZZ_MUST(mkdir(inner, 0700) == 0);
    const se3d_status status = se3di_unzip(path, inner, want_all, NULL, problem, sizeof problem);
    FUZZ_MUST(status == SE3D_OK || status == SE3D_ERR_IO || status == SE3D_ERR_UNSUPPORTED ||
              status == SE3D_ERR_NO_MEMORY);
    FUZZ_MUST((status < 0) == (problem[0] != '\0'));
    FUZZ_MUST(count_names(outer) == 2);
    FUZZ_MUST(nftw(inner, remove_one, HANDLES, FTW_DEPTH | FTW_PHYS) == 0);
}

static size_t get(const uint8_t *bytes, int count)
{
    size_t value = 0;
    while (count-- > 0) {
        value = value << 8 | bytes[count];
    }
    return value;
}

/* The checksum that the file of an entry of the list has, if it can be unpacked. */
static void set_checksum(uint8_t *entry, const uint8_t *data, size_t size)
{
    const size_t offset = get(entry + 42, 4), packed = get(entry + 20, 4);
    const size_t made = get(entry + 24, 4), method = get(entry + 10, 2);
    if (offset > size || size - offset < LOCAL_SIZE || made > CONTENT_MAX) {
        return;
    }
    const uint8_t *local = data + offset;
    const size_t at = offset + LOCAL_SIZE + get(local + 26, 2) + get(local + 28, 2);
    uint8_t *bytes = malloc(made + 1);
    if (bytes && at <= size && packed <= size - at) {
        if (method == 0 && made == packed) {
            memcpy(bytes, data + at, made);
        } else if (!se3di_inflate(data + at, packed, bytes, made)) {
            memset(bytes, 0, made);
        }
        const uint32_t crc = se3di_crc32(bytes, made);
        for (int k = 0; k < 4; ++k) {
            entry[16 + k] = (uint8_t)(crc >> 8 * k);
        }
    }
    free(bytes);
}

static void unpack_with_checksums(const uint8_t *data, size_t size)
{
    static const uint8_t mark[] = {'P', 'K', 1, 2};
    uint8_t *copy = malloc(size);
    FUZZ_MUST(copy != NULL);
    memcpy(copy, data, size);
    for (size_t k = 0; k + ENTRY_SIZE <= size; ++k) {
        if (memcmp(copy + k, mark, sizeof mark) == 0) {
            set_checksum(copy + k, data, size);
        }
    }
    if (memcmp(copy, data, size) != 0) {
        unpack(copy, size);
    }
    free(copy);
}

/* Exactly as many bytes as said, in an array of that size. */
static void inflate(const uint8_t *data, size_t size)
{
    const size_t made = get(data, 2);
    uint8_t *bytes = malloc(made + 1), *packed = malloc(size - 2 + 1);
    FUZZ_MUST(bytes && packed);
    memcpy(packed, data + 2, size - 2);
    (void)se3di_inflate(packed, size - 2, bytes, made);
    free(bytes);
    free(packed);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    unpack(data, size);
    if (size >= 2) {
        unpack_with_checksums(data, size);
        inflate(data, size);
    }
    return 0;
}
