/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that a model names: meshes, tables of particles. */
#include "io/document/attachment.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "io/base/file.h"
#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/reader.h"

enum { FILE_BYTES_MAX = 1 << 28 };

/* The path beside the model file; absolute ones stay. */
const char *se3di_find_attachment(const se3di_reader *reader, se3di_iopool *pool, const char *file)
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

static bool fail(se3di_reader *reader, const se3di_node *map, const char *key, const char *file,
                 const char *what)
{
    return se3di_reader_fail_key(reader, map, key, "`%.200s`: the file %s", file, what);
}

/* Keep what the file was. */
static bool note(se3di_reader *reader, const char *path, const char *file)
{
    se3di_iopool *pool = reader->pool;
    se3di_attached_file *made = se3di_iopool_alloc(pool, sizeof *made);
    if (!made) {
        return false;
    }
    made->path = se3di_iopool_copy(pool, path, strlen(path));
    made->name = se3di_iopool_copy(pool, file, strlen(file));
    made->next = reader->files;
    reader->files = made;
    return made->path && made->name;
}

bool se3di_read_attachment(se3di_reader *reader, const se3di_node *map, const char *key,
                           const char *file, se3di_iopool *pool, char **text, size_t *size)
{
    const char *path = se3di_find_attachment(reader, pool, file);
    if (!path || !note(reader, path, file)) {
        return se3di_reader_fail_memory(reader);
    }
    errno = 0;
    FILE *stream = se3di_file_open(path);
    if (!stream) {
        const bool other = errno == EISDIR || errno == EINVAL;
        return fail(reader, map, key, file,
                    other ? "is a folder, a pipe or a device, must be a regular file"
                          : "cannot be opened");
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
    reader->attached += *size;
    reader->content = se3di_hash_bytes(reader->content, *text, *size);
    reader->timeless = se3di_hash_bytes(reader->timeless, *text, *size);
    return good || fail(reader, map, key, file, "is empty, too large or cannot be read");
}
