/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that a model names: meshes, tables of particles. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif

#include "io/document/attachment.h"

#include <stdio.h>
#include <string.h>
#if !defined(_WIN32)
#include <sys/stat.h>
#endif

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/reader.h"

enum { FILE_BYTES_MAX = 1 << 28 };

/* The path beside the model file; absolute ones stay. */
static const char *find(const se3di_reader *reader, se3di_iopool *pool, const char *file)
{
    const char *model = reader->file;
    const char *slash = model ? strrchr(model, '/') : NULL;
    const size_t folder = slash && file[0] != '/' ? (size_t)(slash - model) + 1 : 0;
    char *path = se3di_iopool_array(pool, folder + strlen(file) + 1, 1);
    if (path) {
        memcpy(path, model ? model : "", folder);
        memcpy(path + folder, file, strlen(file) + 1);
    }
    return path;
}

/* Not a folder, nor a pipe or device, which might never end. */
static bool is_plain(const char *path)
{
#if defined(_WIN32)
    (void)path;
    return true;
#else
    struct stat about;
    return stat(path, &about) != 0 || S_ISREG(about.st_mode);
#endif
}

static bool fail(se3di_reader *reader, const se3di_node *map, const char *file, const char *what)
{
    return se3di_reader_fail_key(reader, map, "file", "`%.200s`: the file %s", file, what);
}

bool se3di_read_attachment(se3di_reader *reader, const se3di_node *map, const char *file,
                           se3di_iopool *pool, char **text, size_t *size)
{
    const char *path = find(reader, pool, file);
    if (!path) {
        return se3di_reader_fail_memory(reader);
    }
    if (!is_plain(path)) {
        return fail(reader, map, file, "is a folder, a pipe or a device, must be a regular file");
    }
    FILE *stream = fopen(path, "rb");
    if (!stream) {
        return fail(reader, map, file, "cannot be opened");
    }
    const long length = fseek(stream, 0, SEEK_END) == 0 ? ftell(stream) : -1;
    bool good = length > 0 && length <= FILE_BYTES_MAX && fseek(stream, 0, SEEK_SET) == 0;
    *text = good ? se3di_iopool_array(pool, (size_t)length + 1, 1) : NULL;
    const bool memory = !good || *text;
    good = good && *text && fread(*text, 1, (size_t)length, stream) == (size_t)length;
    fclose(stream);
    if (!memory) {
        return se3di_reader_fail_memory(reader);
    }
    *size = good ? (size_t)length : 0;
    return good || fail(reader, map, file, "is empty, too large or cannot be read");
}
