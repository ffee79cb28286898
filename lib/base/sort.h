/* SPDX-License-Identifier: BSD-3-Clause */
/* Sorting in place: the standard library's qsort may allocate, past the system's allocator. */
#ifndef SE3DI_SORT_H
#define SE3DI_SORT_H

#include <stddef.h>
#include <stdint.h>

/* Sort `count` tuples of `width` numbers, the first ones weighing most, by a heap. */
void se3di_sort_tuples(int32_t *tuples, size_t count, size_t width);

#endif
