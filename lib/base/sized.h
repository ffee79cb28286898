/* SPDX-License-Identifier: BSD-3-Clause */
/* Structures of the public headers grow at their end: a caller that was compiled with another
 * header knows more or less of one than this library. What the one does not know of is zero. */
#ifndef SE3DI_BASE_SIZED_H
#define SE3DI_BASE_SIZED_H

#include "se3d/base.h"

#define SE3DI_SIZED_GROWTH 512 /* bytes that a structure may grow in versions to come */

typedef enum se3di_sized_verdict {
    SE3DI_SIZED_FITS = 0,
    SE3DI_SIZED_NONE = 1,   /* no size that a structure of any version can have */
    SE3DI_SIZED_UNKNOWN = 2 /* beyond what is known, something is set */
} se3di_sized_verdict;

/* Take the caller's structure of `size` bytes, its first member, over the defaults in `copy` of
 * `full` bytes. */
se3di_sized_verdict se3di_sized_take(const void *from, void *copy, size_t full);
/* Fill the caller's structure of `size` bytes. @return OK, INVALID_ARGUMENT: no size at all */
se3d_status se3di_sized_give(void *to, size_t size, const void *value, size_t full);

#endif
