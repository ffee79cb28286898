/* SPDX-License-Identifier: BSD-3-Clause */
/* An allocator that counts what is live, checks the sizes it is given back, and can fail. */
#ifndef SE3D_TESTS_SUPPORT_COUNTING_H
#define SE3D_TESTS_SUPPORT_COUNTING_H

#include <stdint.h>

#include "se3d/base.h"

typedef struct support_counting {
    size_t calls;   /* of alloc and realloc */
    size_t fail_at; /* the call that fails, counted from 1; 0: none */
    int for_ever;   /* not 0: all later ones fail too */
    uint64_t seed;  /* not 0: one of `one_in` fails, by chance */
    uint64_t one_in;
    size_t failed; /* calls that failed */
    size_t live;   /* blocks */
    size_t bytes;  /* in them */
    size_t wrong;  /* blocks given back with another size, or unknown ones */
} support_counting;

se3d_allocator support_counting_allocator(support_counting *counting);

#endif
