/* SPDX-License-Identifier: BSD-3-Clause */
/* Products of columns of Householder reflections: at all levels the bits of plain sums. */
#include "linsol/mirrors.h"

#include "check.h"

#include <string.h>

#define MOST  40
#define LEAST 8 /* zeros before the numbers of a column: a multiple of eight */

static uint64_t seed = 1;

static void fill(double *x, size_t n)
{
    for (size_t k = 0; k < n; ++k) {
        x[k] = check_random(&seed);
    }
}

/* Number k is added to the sum k % 8. */
static double plain_dot(const double *a, const double *b, size_t n)
{
    double sum[8] = {0.0};
    for (size_t k = 0; k < n; ++k) {
        sum[k % 8] += a[k] * b[k];
    }
    return ((sum[0] + sum[4]) + (sum[2] + sum[6])) + ((sum[1] + sum[5]) + (sum[3] + sum[7]));
}

static void plain_mirror(size_t n, double tau, const double *v, double *x)
{
    const double f = tau * (x[0] + plain_dot(v + 1, x + 1, n));
    x[0] -= f;
    for (size_t k = 0; k < n; ++k) {
        x[1 + k] -= f * v[1 + k];
    }
}

static void try_level(const se3di_mirrors *mirrors)
{
    for (size_t n = 0; n <= MOST; ++n) {
        double a[MOST + 2], b[MOST + 2], wanted[MOST + 2];
        fill(a, MOST + 2);
        fill(b, MOST + 2);
        const double sum = mirrors->dot(a + 1, b + 1, n), plain = plain_dot(a + 1, b + 1, n);
        CHECK(memcmp(&sum, &plain, sizeof sum) == 0);
        memcpy(wanted, b, sizeof b);
        plain_mirror(n, 1.25, a, wanted);
        mirrors->mirror(0, n, 1.25, a, b);
        CHECK(memcmp(wanted, b, sizeof b) == 0); /* what follows is not touched */
    }
}

static void all_levels_give_the_bits_of_plain_sums(void)
{
    try_level(se3di_mirrors_portable());
    if (se3di_mirrors_avx2()) {
        try_level(se3di_mirrors_avx2());
    }
}

static void zeros_at_both_ends_may_be_left_out(void)
{
    const se3di_mirrors *levels[2] = {se3di_mirrors_portable(), se3di_mirrors_avx2()};
    for (size_t to = LEAST; to <= MOST; ++to) {
        double v[MOST + 1] = {1.0}, x[MOST + 1], whole[MOST + 1], part[MOST + 1];
        fill(v + 1 + LEAST, to - LEAST);
        fill(x, MOST + 1);
        for (int k = 0; k < 2 && levels[k]; ++k) {
            memcpy(whole, x, sizeof x);
            memcpy(part, x, sizeof x);
            levels[k]->mirror(0, MOST, 0.75, v, whole);
            levels[k]->mirror(LEAST, to, 0.75, v, part);
            CHECK(memcmp(whole, part, sizeof whole) == 0);
        }
    }
}

int main(void)
{
    RUN(all_levels_give_the_bits_of_plain_sums);
    RUN(zeros_at_both_ends_may_be_left_out);
    return check_finish();
}
