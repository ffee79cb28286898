/* SPDX-License-Identifier: BSD-3-Clause */
/* Compresses blocks by zlib, each for itself, with memory of a pool. */
#ifndef SE3D_IO_DEFLATE_H
#define SE3D_IO_DEFLATE_H

#include "io/base/pool.h"

typedef struct se3di_deflate {
    se3di_iopool *pool;
    void *stream;
    unsigned char *out; /* [capacity] */
    size_t capacity;
} se3di_deflate;

/* Whether this build has zlib. Here, so that readers of models do not ask for that to be linked. */
static inline bool se3di_deflate_is_there(void)
{
#if defined(SE3D_HAS_ZLIB)
    return true;
#else
    return false;
#endif
}

/* Begin with a level of 1 (fast) ... 9 (small). @return false: errno says why (ENOTSUP: there is no
 * zlib); there is nothing to close. */
bool se3di_deflate_open(se3di_deflate *d, se3di_iopool *pool, int level);
/* A block in zlib's format, which is there until the next one. @return NULL: errno says why. */
const unsigned char *se3di_deflate_block(se3di_deflate *d, const void *data, size_t size,
                                         size_t *made);
/* The memory is the pool's. */
void se3di_deflate_close(se3di_deflate *d);

#endif
