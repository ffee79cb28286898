/* SPDX-License-Identifier: BSD-3-Clause */
/* PKWARE's APPNOTE 6.3: for each file a local header and its bytes; at the end the central
 * directory. Method 0 (stored), names in UTF-8 (flag bit 11), the date 1 January 1980. Archives of
 * less than 4 GiB and 65535 files. */
#include "io/fmi/zip.h"

#include <errno.h>
#include <string.h>

#include "io/base/inflate.h"
#include "io/base/little.h"

enum { LOCAL_SIZE = 30, CENTRAL_SIZE = 46, END_SIZE = 22, FILES_MAX = 65534 };
enum { VERSION = 20, UTF8 = 1 << 11, DATE = 1 << 5 | 1 };
#define BYTES_MAX UINT64_C(0xfffffff0)
static const char too_large[] = "the archive is too large";

typedef struct se3di_zip_entry {
    const char *name;
    uint32_t crc, size, offset;
} se3di_zip_entry;

static void write_bytes(se3di_zip *zip, const void *bytes, size_t size)
{
    errno = 0;
    if (!zip->problem && size > 0 && fwrite(bytes, 1, size, zip->file) != size) {
        zip->problem = strerror(errno ? errno : ENOSPC);
    }
    zip->written += size;
}

/* Numbers of 2 or 4 bytes, least byte first. */
typedef struct record {
    unsigned char bytes[64];
    size_t used;
} record;

static void put(record *r, size_t size, uint32_t value)
{
    se3di_little_put(r->bytes + r->used, value, size);
    r->used += size;
}

/* What both headers of a file have in common. */
static void put_common(record *r, const se3di_zip_entry *e)
{
    put(r, 2, VERSION);
    put(r, 2, UTF8);
    put(r, 2, 0); /* stored */
    put(r, 2, 0); /* time */
    put(r, 2, DATE);
    put(r, 4, e->crc);
    put(r, 4, e->size);
    put(r, 4, e->size);
    put(r, 2, (uint32_t)strlen(e->name));
    put(r, 2, 0);
}

se3di_zip se3di_zip_begin(FILE *file, se3di_iopool *pool)
{
    return (se3di_zip){.file = file, .pool = pool};
}

void se3di_zip_add(se3di_zip *zip, const char *name, const void *bytes, size_t size)
{
    record r = {.used = 0};
    se3di_zip_entry *grown =
        se3di_iopool_grow(zip->pool, zip->entries, zip->count, &zip->capacity, sizeof *grown);
    const char *copy = se3di_iopool_copy(zip->pool, name, strlen(name));
    if (!grown || !copy || strlen(name) > UINT16_MAX || zip->count >= FILES_MAX ||
        size > BYTES_MAX || zip->written > BYTES_MAX - size) { /* the pool knows if it is short */
        zip->problem = zip->problem ? zip->problem : too_large;
        return;
    }
    zip->entries = grown;
    se3di_zip_entry *e = &zip->entries[zip->count++];
    *e = (se3di_zip_entry){copy, se3di_crc32(bytes, size), (uint32_t)size, (uint32_t)zip->written};
    put(&r, 4, 0x04034b50U);
    put_common(&r, e);
    write_bytes(zip, r.bytes, LOCAL_SIZE);
    write_bytes(zip, name, strlen(name));
    write_bytes(zip, bytes, size);
}

static void write_central(se3di_zip *zip, const se3di_zip_entry *e)
{
    record r = {.used = 0};
    put(&r, 4, 0x02014b50U);
    put(&r, 2, 3U << 8 | VERSION); /* made on UNIX: modes count */
    put_common(&r, e);
    put(&r, 2, 0);               /* comment */
    put(&r, 2, 0);               /* disk */
    put(&r, 2, 0);               /* no text */
    put(&r, 4, 0100644U << 16U); /* regular file, rw-r--r-- */
    put(&r, 4, e->offset);
    write_bytes(zip, r.bytes, CENTRAL_SIZE);
    write_bytes(zip, e->name, strlen(e->name));
}

const char *se3di_zip_end(se3di_zip *zip)
{
    record r = {.used = 0};
    const uint64_t begin = zip->written;
    for (size_t k = 0; k < zip->count; ++k) {
        write_central(zip, &zip->entries[k]);
    }
    if (!zip->problem && zip->written > BYTES_MAX) {
        zip->problem = too_large;
    }
    put(&r, 4, 0x06054b50U);
    put(&r, 4, 0); /* disks */
    put(&r, 2, (uint32_t)zip->count);
    put(&r, 2, (uint32_t)zip->count);
    put(&r, 4, (uint32_t)(zip->written - begin));
    put(&r, 4, (uint32_t)begin);
    put(&r, 2, 0);
    write_bytes(zip, r.bytes, END_SIZE);
    return zip->problem;
}
