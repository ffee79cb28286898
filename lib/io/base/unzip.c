/* SPDX-License-Identifier: BSD-3-Clause */
/* PKWARE's APPNOTE 6.3: the end record, which is searched from the end, says where the list of the
 * files is; each entry says where its local header is, after which its bytes stand. Sizes and
 * checksums are those of the list. No archives of several parts or of 4 GiB and more (zip64). */
#include "io/base/unzip.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/file.h"
#include "io/base/inflate.h"
#include "io/base/pool.h"

enum { LOCAL_SIZE = 30, ENTRY_SIZE = 46, END_SIZE = 22, NOTE_MAX = 65535 };
enum { NAME_MOST = 1000, PATH_SIZE = 4096, ENCRYPTED = 1, MADE_ON_UNIX = 3 };
enum { TYPE = 0170000, FOLDER = 0040000, REGULAR = 0100000 };
#define ARCHIVE_MAX ((long)1 << 30)
#define CONTENT_MAX (UINT64_C(1) << 30)
/* Ten times as much as programs and tables pack to. */
#define RATIO_MAX 200
#define SMALL     (UINT64_C(16) << 20) /* of this size nobody minds */

typedef struct archive {
    const unsigned char *bytes;
    size_t size;
    const char *folder;
    se3di_iopool pool;
    uint64_t content, packed; /* of all files so far */
    char *problem;
    size_t problem_size;
} archive;

/* What the list says of a file. */
typedef struct entry {
    char name[NAME_MOST + 1];
    uint32_t crc, packed_size, size, offset;
    uint32_t method;
    size_t next; /* where the next entry is */
} entry;

SE3DI_IO_FORMAT(3, 4)
static se3d_status refuse(archive *a, se3d_status status, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(a->problem, a->problem_size, format, arguments);
    va_end(arguments);
    return status;
}

static se3d_status refuse_damaged(archive *a, const char *what)
{
    return refuse(a, SE3D_ERR_IO, "the archive is damaged or cut: %s", what);
}

/* A number of `size` bytes, least byte first. */
static uint32_t get(const archive *a, size_t at, int size)
{
    uint32_t value = 0;
    for (int k = size - 1; k >= 0; --k) {
        value = value << 8 | a->bytes[at + (size_t)k];
    }
    return value;
}

/* ---- names ------------------------------------------------------------------------------------*/

/* Whether no part of a name is empty, `.` or `..`, or has what other systems take for a separator
 * or what terminals obey. One slash at its end makes it a folder. */
static bool stays_inside(const char *name)
{
    const char *part = name;
    for (const char *c = name;; ++c) {
        if (*c != '/' && *c != '\0') {
            if (*c == '\\' || *c == ':' || (unsigned char)*c < 0x20 || *c == 0x7f) {
                return false;
            }
            continue;
        }
        const size_t length = (size_t)(c - part);
        const bool ends = *c == '\0';
        if ((length == 0 && !(ends && c > name)) || (length == 1 && part[0] == '.') ||
            (length == 2 && part[0] == '.' && part[1] == '.')) {
            return false;
        }
        if (ends) {
            return true;
        }
        part = c + 1;
    }
}

/* A name for a message, whatever is in it. */
static const char *show(const char *name, char text[81])
{
    size_t k = 0;
    for (; name[k] && k < 80; ++k) {
        text[k] = '?';
        if ((unsigned char)name[k] >= 0x20 && name[k] != 0x7f) {
            text[k] = name[k];
        }
    }
    text[k] = '\0';
    return text;
}

static se3d_status check_name(archive *a, const entry *e, size_t length)
{
    char text[81];
    if (strlen(e->name) != length || !stays_inside(e->name)) {
        return refuse(a, SE3D_ERR_UNSUPPORTED,
                      "the archive has a file `%s`, whose name may lead out of it",
                      show(e->name, text));
    }
    return SE3D_OK;
}

/* ---- the list ---------------------------------------------------------------------------------*/

static se3d_status find_end(archive *a, size_t *end)
{
    const size_t least = a->size > END_SIZE + NOTE_MAX ? a->size - END_SIZE - NOTE_MAX : 0;
    for (size_t at = a->size >= END_SIZE ? a->size - END_SIZE + 1 : 0; at-- > least;) {
        if (get(a, at, 4) == 0x06054b50U && at + END_SIZE + get(a, at + 20, 2) == a->size) {
            *end = at;
            return SE3D_OK;
        }
    }
    return refuse(a, SE3D_ERR_IO, "it is neither a folder nor a whole zip archive");
}

static se3d_status check_end(archive *a, size_t end, size_t *first, size_t *count)
{
    const uint32_t size = get(a, end + 12, 4), offset = get(a, end + 16, 4);
    *first = offset;
    *count = get(a, end + 10, 2);
    if (*count == 0xffff || size == UINT32_MAX || offset == UINT32_MAX) {
        return refuse(a, SE3D_ERR_UNSUPPORTED, "the archive has a list of the form zip64");
    }
    if (get(a, end + 4, 2) != 0 || get(a, end + 6, 2) != 0 || get(a, end + 8, 2) != *count) {
        return refuse(a, SE3D_ERR_UNSUPPORTED, "the archive is one part of several");
    }
    return (uint64_t)offset + size == end ? SE3D_OK : refuse_damaged(a, "its list is elsewhere");
}

/* What may be made of an entry: a file or a folder, of a size that its packed bytes can have. */
static se3d_status check_entry(archive *a, const entry *e, uint32_t flags, uint32_t type)
{
    char text[81];
    const char *why = NULL;
    if (flags & ENCRYPTED) {
        why = "is encrypted";
    } else if (type != 0 && type != REGULAR && type != FOLDER) {
        why = "is a link or a device";
    } else if (e->packed_size == UINT32_MAX || e->size == UINT32_MAX || e->offset == UINT32_MAX) {
        why = "has sizes of the form zip64";
    } else if (e->method != 0 && e->method != 8) {
        why = "is packed by another method than Deflate";
    } else if (e->method == 0 ? e->size != e->packed_size
                              : e->size > (uint64_t)e->packed_size * SE3DI_INFLATE_MOST) {
        why = "has sizes that cannot be";
    }
    if (why) {
        return refuse(a, SE3D_ERR_UNSUPPORTED, "the archive's file `%s` %s", show(e->name, text),
                      why);
    }
    a->packed += (uint64_t)e->packed_size + LOCAL_SIZE;
    return a->packed <= a->size ? SE3D_OK : refuse_damaged(a, "its files overlap");
}

static se3d_status read_entry(archive *a, size_t at, size_t end, entry *e)
{
    if (end - at < ENTRY_SIZE || get(a, at, 4) != 0x02014b50U) {
        return refuse_damaged(a, "its list is shorter than it says");
    }
    const size_t length = get(a, at + 28, 2);
    const size_t next = at + ENTRY_SIZE + length + get(a, at + 30, 2) + get(a, at + 32, 2);
    if (next > end || length == 0 || length > NAME_MOST) {
        return refuse_damaged(a, "a name is empty or too long");
    }
    *e = (entry){.method = get(a, at + 10, 2),
                 .crc = get(a, at + 16, 4),
                 .packed_size = get(a, at + 20, 4),
                 .size = get(a, at + 24, 4),
                 .offset = get(a, at + 42, 4),
                 .next = next};
    memcpy(e->name, a->bytes + at + ENTRY_SIZE, length);
    const uint32_t mode = a->bytes[at + 5] == MADE_ON_UNIX ? get(a, at + 40, 2) : 0;
    const se3d_status status = check_name(a, e, length);
    return status < 0 ? status : check_entry(a, e, get(a, at + 8, 2), mode & TYPE);
}

/* Find the bytes of a file. */
static se3d_status find_bytes(archive *a, const entry *e, size_t *at)
{
    const size_t begin = e->offset;
    if (begin >= a->size || a->size - begin < LOCAL_SIZE || get(a, begin, 4) != 0x04034b50U) {
        return refuse_damaged(a, "a file is not where its list says");
    }
    const size_t length = get(a, begin + 26, 2);
    *at = begin + LOCAL_SIZE + length + get(a, begin + 28, 2);
    if (*at > a->size || e->packed_size > a->size - *at || length != strlen(e->name) ||
        memcmp(a->bytes + begin + LOCAL_SIZE, e->name, length) != 0) {
        return refuse_damaged(a, "a file is not where its list says");
    }
    return SE3D_OK;
}

/* ---- files ------------------------------------------------------------------------------------*/

static se3d_status write_file(archive *a, const entry *e, const unsigned char *bytes)
{
    char path[PATH_SIZE], text[81];
    const int length = snprintf(path, sizeof path, "%s/%s", a->folder, e->name);
    errno = ENAMETOOLONG;
    FILE *file = length > 0 && (size_t)length < sizeof path && se3di_file_make_folders(path)
                     ? se3di_file_create(path)
                     : NULL;
    bool good = file && fwrite(bytes, 1, e->size, file) == e->size;
    int why = errno;
    if (file && fclose(file) != 0 && good) {
        good = false;
        why = errno;
    }
    return good ? SE3D_OK
                : refuse(a, SE3D_ERR_IO, "the archive's file `%s` cannot be unpacked: %s",
                         show(e->name, text),
                         why == EEXIST ? "the name is there twice" : strerror(why));
}

static se3d_status unpack_deflated(archive *a, const entry *e, const unsigned char *bytes)
{
    char text[81];
    const se3d_allocator *allocator = &a->pool.allocator;
    unsigned char *made = allocator->alloc(allocator->ctx, (size_t)e->size + 1);
    if (!made) {
        return refuse(a, SE3D_ERR_NO_MEMORY, "out of memory");
    }
    const se3d_status status =
        se3di_inflate(bytes, e->packed_size, made, e->size) && se3di_crc32(made, e->size) == e->crc
            ? write_file(a, e, made)
            : refuse(a, SE3D_ERR_IO, "the archive's file `%s` is damaged", show(e->name, text));
    allocator->free(allocator->ctx, made, (size_t)e->size + 1);
    return status;
}

static se3d_status unpack(archive *a, const entry *e)
{
    size_t at = 0;
    char text[81];
    const se3d_status status = find_bytes(a, e, &at);
    if (status < 0) {
        return status;
    }
    a->content += e->size;
    if (a->content > CONTENT_MAX || (a->content > SMALL && a->content / RATIO_MAX > a->size)) {
        return refuse(a, SE3D_ERR_UNSUPPORTED, "the archive would become far too large");
    }
    return e->method == 8 ? unpack_deflated(a, e, a->bytes + at)
           : se3di_crc32(a->bytes + at, e->size) == e->crc
               ? write_file(a, e, a->bytes + at)
               : refuse(a, SE3D_ERR_IO, "the archive's file `%s` is damaged", show(e->name, text));
}

static se3d_status unpack_all(archive *a, bool (*is_wanted)(const char *name))
{
    size_t end = 0, at = 0, count = 0;
    entry e;
    se3d_status status = find_end(a, &end);
    status = status < 0 ? status : check_end(a, end, &at, &count);
    for (size_t k = 0; k < count && status >= 0; ++k) {
        status = read_entry(a, at, end, &e);
        if (status >= 0) {
            const bool is_file = e.name[strlen(e.name) - 1] != '/';
            status = is_file && is_wanted(e.name) ? unpack(a, &e) : SE3D_OK;
            at = e.next;
        }
    }
    return status < 0 || at == end ? status : refuse_damaged(a, "its list is longer than it says");
}

static se3d_status read_all(archive *a, const char *path)
{
    FILE *file = se3di_file_open(path);
    const long size = file && fseek(file, 0, SEEK_END) == 0 ? ftell(file) : -1;
    se3d_status status = SE3D_OK;
    if (size < 0 || size > ARCHIVE_MAX) {
        status = size < 0 ? refuse(a, SE3D_ERR_IO, "%s", se3di_file_get_text(errno))
                          : refuse(a, SE3D_ERR_UNSUPPORTED, "the archive is larger than 1 GiB");
    } else {
        unsigned char *bytes = se3di_iopool_alloc(&a->pool, (size_t)size + 1);
        rewind(file);
        if (!bytes) {
            status = refuse(a, SE3D_ERR_NO_MEMORY, "out of memory");
        } else if (fread(bytes, 1, (size_t)size, file) != (size_t)size) {
            status = refuse(a, SE3D_ERR_IO, "it cannot be read");
        }
        a->bytes = bytes;
        a->size = (size_t)size;
    }
    if (file) {
        fclose(file);
    }
    return status;
}

se3d_status se3di_unzip(const char *path, const char *folder, bool (*is_wanted)(const char *name),
                        const se3d_allocator *allocator, char *problem, size_t size)
{
    archive a = {.folder = folder, .problem = problem, .problem_size = size};
    se3di_iopool_init(&a.pool, allocator);
    se3d_status status = read_all(&a, path);
    status = status < 0 ? status : unpack_all(&a, is_wanted);
    se3di_iopool_destroy(&a.pool);
    return status;
}
