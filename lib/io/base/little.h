/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of binary files, least byte first. */
#ifndef SE3D_IO_LITTLE_H
#define SE3D_IO_LITTLE_H

#include <stddef.h>
#include <stdint.h>

/* The low `size` bytes of `bits`. */
static inline void se3di_little_put(unsigned char *at, uint64_t bits, size_t size)
{
    for (size_t k = 0; k < size; ++k) {
        at[k] = (unsigned char)(bits >> (8 * k));
    }
}

#endif
