/* SPDX-License-Identifier: BSD-3-Clause */
/* The fused multiply-add by integers gives the bits of the C library's, which is right where the
 * tests run: terms of all distances, such that cancel, results that are subnormal or too large. */
#include "check.h"
#include "math/fma.h"

#include <string.h>

static uint64_t bits_of(double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

static void compare(double a, double b, double c)
{
    const double want = fma(a, b, c), got = se3di_fma_by_integers(a, b, c);
    const int is_same = (isnan(want) && isnan(got)) || bits_of(want) == bits_of(got);
    if (!is_same) {
        fprintf(stderr, "fma(%a, %a, %a) = %a, not %a\n", a, b, c, want, got);
    }
    CHECK(is_same);
}

/* Few of the bits are set, so that ties and exact results happen. */
static double next(uint64_t *seed, int reach)
{
    const double x = check_random(seed);
    const int shift = (int)(reach * check_random(seed)),
              keep = (int)(26.5 + 26.5 * check_random(seed));
    return ldexp(rint(ldexp(x, keep)), shift - keep);
}

static void ordinary_terms(void)
{
    uint64_t seed = 3;
    compare(1.0 + 0x1p-52, 1.0 + 0x1p-52, -1.0 - 0x1p-51); /* but for one bit, all cancels */
    for (int k = 0; k < 300000; ++k) {
        const double a = next(&seed, 4), b = next(&seed, 4);
        compare(a, b, next(&seed, 120));
        compare(a, b, -a * b);
        compare(a, b, -a * b + ldexp(next(&seed, 3), -60));
        compare(a, b, ldexp(a * b, 53) * (k % 2 ? 1.0 : -0.5));
    }
}

static void terms_at_the_ends_of_the_range(void)
{
    uint64_t seed = 5;
    for (int k = 0; k < 300000; ++k) {
        const double a = ldexp(next(&seed, 40), -540), b = ldexp(next(&seed, 40), -540);
        compare(a, b, ldexp(next(&seed, 30), -1060));
        compare(a, b, ldexp(next(&seed, 2), -1073));
        if (a != 0.0 && b != 0.0) {
            compare(1.0 / a, 1.0 / b, ldexp(next(&seed, 30), 1000));
            compare(a, 1.0 / b, next(&seed, 60));
        }
    }
}

static void what_is_no_ordinary_number(void)
{
    const double values[] = {0.0,
                             -0.0,
                             1.0,
                             -1.0,
                             HUGE_VAL,
                             -HUGE_VAL,
                             (double)NAN,
                             0x1p-1074,
                             -0x1p-1074,
                             0x1p-1022,
                             0x1.fffffffffffffp1023,
                             -0x1.fffffffffffffp1023};
    const int count = (int)(sizeof values / sizeof *values);
    for (int k = 0; k < count * count * count; ++k) {
        compare(values[k % count], values[k / count % count], values[k / count / count]);
    }
}

int main(void)
{
    RUN(ordinary_terms);
    RUN(terms_at_the_ends_of_the_range);
    RUN(what_is_no_ordinary_number);
    return check_finish();
}
