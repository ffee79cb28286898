/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/sort.h"

static int is_less(const int32_t *a, const int32_t *b, size_t width)
{
    for (size_t k = 0; k < width; ++k) {
        if (a[k] != b[k]) {
            return a[k] < b[k];
        }
    }
    return 0;
}

static void swap(int32_t *a, int32_t *b, size_t width)
{
    for (size_t k = 0; k < width; ++k) {
        const int32_t kept = a[k];
        a[k] = b[k];
        b[k] = kept;
    }
}

/* Let the tuple at `root` sink until none below it in the heap is larger. */
static void sink(int32_t *tuples, size_t root, size_t count, size_t width)
{
    for (size_t child = 2 * root + 1; child < count; child = 2 * root + 1) {
        if (child + 1 < count &&
            is_less(tuples + child * width, tuples + (child + 1) * width, width)) {
            ++child;
        }
        if (!is_less(tuples + root * width, tuples + child * width, width)) {
            return;
        }
        swap(tuples + root * width, tuples + child * width, width);
        root = child;
    }
}

void se3di_sort_tuples(int32_t *tuples, size_t count, size_t width)
{
    for (size_t root = count / 2; root-- > 0;) {
        sink(tuples, root, count, width);
    }
    for (size_t end = count; end-- > 1;) {
        swap(tuples, tuples + end * width, width);
        sink(tuples, 0, end, width);
    }
}
