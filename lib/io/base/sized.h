/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures of the public headers grow at their end: a caller that was compiled with another
 * header knows more or less of one than this library. What the one does not know of is zero. */
#ifndef SE3DI_IO_SIZED_H
#define SE3DI_IO_SIZED_H

#include "se3d/base.h"

#include <string.h>

#define SE3DI_IO_GROWTH 512 /* bytes that a structure may grow in versions to come */

#define SE3DI_IO_SIZE_TEXT                                                                         \
    "struct_size must be set by the _default function; what is set beyond the size that this "     \
    "version of the library knows must be zero"

/* Take the caller's structure, whose first member is its size, over the defaults in `copy`.
 * @return whether it is one that this library knows, or has nothing set beyond */
static inline int se3di_io_take(const void *from, void *copy, size_t full)
{
    const unsigned char *bytes = from;
    size_t size;
    memcpy(&size, from, sizeof size);
    if (size < sizeof size || size > full + SE3DI_IO_GROWTH) {
        return 0;
    }
    for (size_t k = full; k < size; ++k) {
        if (bytes[k] != 0) {
            return 0;
        }
    }
    memcpy(copy, from, size < full ? size : full);
    return 1;
}

/* Fill the caller's structure of `size` bytes. */
static inline se3d_status se3di_io_give(void *to, size_t size, const void *value, size_t full)
{
    if (size == 0 || size > full + SE3DI_IO_GROWTH) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    memcpy(to, value, size < full ? size : full);
    if (size > full) {
        memset((unsigned char *)to + full, 0, size - full);
    }
    return SE3D_OK;
}

/* A getter of one of `count` entries of `owner`: (owner)->member, which may depend on `index`. */
#define SE3DI_IO_GIVE_ENTRY(out, size, owner, index, count, member)                                \
    (!(owner) || !(out)          ? SE3D_ERR_NULL                                                   \
     : (index) >= (owner)->count ? SE3D_ERR_INVALID_ARGUMENT                                       \
                                 : se3di_io_give(out, size, &(owner)->member, sizeof *(out)))

#endif
