/* SPDX-License-Identifier: BSD-3-Clause */
/* The one door to memory: every allocation of the library goes through an se3d_allocator. */
#ifndef SE3DI_BASE_ALLOC_H
#define SE3DI_BASE_ALLOC_H

#include "se3d/base.h"

/* The allocator used if the user gave none: malloc and friends. */
se3d_allocator se3di_alloc_default(void);

/* Zeroed memory of count * size bytes, or NULL (also if the product overflows). count may be 0. */
void *se3di_alloc(const se3d_allocator *allocator, size_t count, size_t size);

/* Give back what se3di_alloc or se3di_array_reserve returned with the same count and size; NULL is
 * fine. */
void se3di_free(const se3d_allocator *allocator, void *memory, size_t count, size_t size);

/* Grow *data (of *capacity elements of `size` bytes) to hold at least `needed`. The new part is
 * zeroed. On failure nothing changed. Growth is geometric. */
se3d_status se3di_array_reserve(const se3d_allocator *allocator, void **data, size_t *capacity,
                                size_t needed, size_t size);
/* The same for an array of any type: `place` is the address of the pointer to it. */
se3d_status se3di_array_reserve_at(const se3d_allocator *allocator, void *place, size_t *capacity,
                                   size_t needed, size_t size);

/* An array that is made once: where its address is kept, its elements and their bytes. */
typedef struct se3di_array {
    void **data;
    size_t count, size;
} se3di_array;

/* Make all arrays of a list, zeroed. @return NO_MEMORY: some may be there, se3di_arrays_free gives
 * them back. */
se3d_status se3di_arrays_alloc(const se3d_allocator *allocator, const se3di_array *list, int count);
void se3di_arrays_free(const se3d_allocator *allocator, const se3di_array *list, int count);

/* A copy of `text` with its terminating zero, or NULL; free with se3di_text_free. */
char *se3di_text_copy(const se3d_allocator *allocator, const char *text);
void se3di_text_free(const se3d_allocator *allocator, char *text);

#endif
