/* SPDX-License-Identifier: BSD-3-Clause */
/* The methods of integration, of which some tests try all. */
#ifndef SE3D_TESTS_METHODS_H
#define SE3D_TESTS_METHODS_H

#include "se3d/se3d.h"

/* How many there are: their numbers are 0 .. count - 1. */
static inline int32_t method_count(void)
{
    int32_t count = 0;
    while (*se3d_method_get_name(count)) {
        ++count;
    }
    return count;
}

#endif
