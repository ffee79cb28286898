/* SPDX-License-Identifier: BSD-3-Clause */
/* Sorting in place, against counting. */
#include "check.h"

#include "base/sort.h"

#include <string.h>

#define COUNT 300

static uint64_t seed = 88172645463325252u;

static int32_t next(int32_t range)
{
    seed ^= seed << 13;
    seed ^= seed >> 7;
    seed ^= seed << 17;
    return (int32_t)(seed >> 33) % range - range / 2;
}

static int compare(const int32_t *a, const int32_t *b, size_t width)
{
    for (size_t k = 0; k < width; ++k) {
        if (a[k] != b[k]) {
            return a[k] < b[k] ? -1 : 1;
        }
    }
    return 0;
}

static size_t count_equal(const int32_t *tuples, size_t count, const int32_t *tuple, size_t width)
{
    size_t equal = 0;
    for (size_t k = 0; k < count; ++k) {
        equal += compare(tuples + k * width, tuple, width) == 0;
    }
    return equal;
}

static void tuples_are_in_order_and_all_there(void)
{
    for (size_t width = 1; width <= 3; ++width) {
        for (size_t count = 0; count < COUNT; count += 1 + count / 4) {
            int32_t before[3 * COUNT], after[3 * COUNT];
            for (size_t k = 0; k < count * width; ++k) {
                before[k] = next(count % 2 ? 7 : 100000);
            }
            memcpy(after, before, sizeof after);
            se3di_sort_tuples(after, count, width);
            for (size_t k = 0; k < count; ++k) {
                const int32_t *tuple = after + k * width;
                CHECK(k == 0 || compare(tuple - width, tuple, width) <= 0);
                CHECK(count_equal(before, count, tuple, width) ==
                      count_equal(after, count, tuple, width));
            }
        }
    }
}

static void extreme_numbers_compare_without_overflow(void)
{
    int32_t numbers[5] = {INT32_MAX, 0, INT32_MIN, -1, INT32_MAX};
    se3di_sort_tuples(numbers, 5, 1);
    CHECK(numbers[0] == INT32_MIN && numbers[1] == -1 && numbers[2] == 0);
    CHECK(numbers[3] == INT32_MAX && numbers[4] == INT32_MAX);
}

int main(void)
{
    RUN(tuples_are_in_order_and_all_there);
    RUN(extreme_numbers_compare_without_overflow);
    return check_finish();
}
