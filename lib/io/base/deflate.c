/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/base/deflate.h"

#include <errno.h>
#include <limits.h>

#if defined(SE3D_HAS_ZLIB)
#include <zlib.h>

static void *take(void *ctx, unsigned count, unsigned size)
{
    return se3di_iopool_array(ctx, count, size);
}

static void leave(void *ctx, void *memory)
{
    (void)ctx; /* with the pool */
    (void)memory;
}

bool se3di_deflate_open(se3di_deflate *d, se3di_iopool *pool, int level)
{
    *d = (se3di_deflate){.pool = pool};
    z_stream *stream = se3di_iopool_alloc(pool, sizeof *stream);
    if (stream) {
        stream->zalloc = take;
        stream->zfree = leave;
        stream->opaque = pool;
    }
    const int status = stream ? deflateInit(stream, level) : Z_MEM_ERROR;
    if (status != Z_OK) {
        errno = status == Z_MEM_ERROR ? ENOMEM : EIO;
        return false;
    }
    d->stream = stream;
    return true;
}

const unsigned char *se3di_deflate_block(se3di_deflate *d, const void *data, size_t size,
                                         size_t *made)
{
    z_stream *stream = d->stream;
    const size_t most = size <= INT_MAX ? deflateBound(stream, (uLong)size) : 0;
    if (most == 0 || most > UINT_MAX) {
        errno = EOVERFLOW;
        return NULL;
    }
    if (most > d->capacity) {
        d->out = se3di_iopool_alloc(d->pool, most);
        d->capacity = d->out ? most : 0;
    }
    if (!d->out) {
        errno = ENOMEM;
        return NULL;
    }
    stream->next_in = (z_const Bytef *)(uintptr_t)data;
    stream->avail_in = (uInt)size;
    stream->next_out = d->out;
    stream->avail_out = (uInt)d->capacity;
    if (deflateReset(stream) != Z_OK || deflate(stream, Z_FINISH) != Z_STREAM_END) {
        errno = EIO;
        return NULL;
    }
    *made = d->capacity - stream->avail_out;
    return d->out;
}

void se3di_deflate_close(se3di_deflate *d)
{
    if (d->stream) {
        (void)deflateEnd(d->stream);
        d->stream = NULL;
    }
}

#else

bool se3di_deflate_open(se3di_deflate *d, se3di_iopool *pool, int level)
{
    *d = (se3di_deflate){.pool = pool};
    (void)level;
    errno = ENOTSUP;
    return false;
}

const unsigned char *se3di_deflate_block(se3di_deflate *d, const void *data, size_t size,
                                         size_t *made)
{
    (void)d;
    (void)data;
    (void)size;
    *made = 0;
    errno = ENOTSUP;
    return NULL;
}

void se3di_deflate_close(se3di_deflate *d)
{
    (void)d;
}

#endif
