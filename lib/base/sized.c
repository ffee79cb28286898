/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/sized.h"

#include <string.h>

se3di_sized_verdict se3di_sized_take(const void *from, void *copy, size_t full)
{
    const unsigned char *bytes = from;
    size_t size;
    memcpy(&size, from, sizeof size);
    if (size < sizeof size || size > full + SE3DI_SIZED_GROWTH) {
        return SE3DI_SIZED_NONE;
    }
    for (size_t k = full; k < size; ++k) {
        if (bytes[k] != 0) {
            return SE3DI_SIZED_UNKNOWN;
        }
    }
    memcpy(copy, from, size < full ? size : full);
    return SE3DI_SIZED_FITS;
}

se3d_status se3di_sized_give(void *to, size_t size, const void *value, size_t full)
{
    if (size == 0 || size > full + SE3DI_SIZED_GROWTH) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    memcpy(to, value, size < full ? size : full);
    if (size > full) {
        memset((unsigned char *)to + full, 0, size - full);
    }
    return SE3D_OK;
}
