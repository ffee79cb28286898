/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums that do not depend on the order, nor on how they are divided. */
#include "check.h"
#include "math/exact.h"

#include <math.h>
#include <string.h>

enum { COUNT = 5000, PARTS = 7 };

static int is_same(double a, double b)
{
    return memcmp(&a, &b, sizeof a) == 0;
}

/* Numbers of sizes from 1e-40 to 1e10 of both signs. */
static void draw(uint64_t *seed, double *x)
{
    for (int k = 0; k < COUNT; ++k) {
        x[k] = check_random(seed) * pow(10.0, 25.0 * check_random(seed) - 15.0);
    }
}

static void no_order_matters(void)
{
    static double x[COUNT];
    uint64_t seed = 3;
    for (int trial = 0; trial < 20; ++trial) {
        se3di_exact forward = {{0.0}}, back = {{0.0}}, all = {{0.0}}, some[PARTS];
        memset(some, 0, sizeof some);
        draw(&seed, x);
        for (int k = 0; k < COUNT; ++k) {
            se3di_exact_add(&forward, x[k]);
            se3di_exact_add(&back, x[COUNT - 1 - k]);
            se3di_exact *part = &some[(k * k + trial) % PARTS];
            se3di_exact_add(part, x[k]);
            if (k % 11 == 0) {
                se3di_exact_carry(part);
            }
        }
        for (int k = 0; k < PARTS; ++k) {
            se3di_exact_add_sum(&all, &some[k]);
        }
        const double sum = se3di_exact_get(&forward);
        CHECK(is_same(sum, se3di_exact_get(&back)));
        CHECK(is_same(sum, se3di_exact_get(&all)));
        long double expected = 0.0L;
        for (int k = 0; k < COUNT; ++k) {
            expected += (long double)x[k];
        }
        CHECK(fabs(sum - (double)expected) <= 1e-9 * fabs((double)expected) + 1e-9);
    }
}

/* What is left of numbers that cancel is right to its own last bits, of either sign. */
static void small_differences_are_exact(void)
{
    static const double left[] = {1e-10, -1e-10, 3e-40, -3e-40, 1.0, -1.0, 0x1p-24, -0x1p-24, 0.0};
    for (size_t k = 0; k < sizeof left / sizeof left[0]; ++k) {
        se3di_exact sum = {{0.0}};
        se3di_exact_add(&sum, 1e9 / 3.0);
        se3di_exact_add(&sum, left[k]);
        se3di_exact_add(&sum, -1e5 / 7.0);
        se3di_exact_add(&sum, -1e9 / 3.0);
        se3di_exact_carry(&sum);
        se3di_exact_add(&sum, 1e5 / 7.0);
        CHECK(fabs(se3di_exact_get(&sum) - left[k]) <= 1e-9 * fabs(left[k]));
    }
    se3di_exact one = {{0.0}};
    se3di_exact_add(&one, -1.0 / 3.0);
    CHECK(is_same(se3di_exact_get(&one), -1.0 / 3.0));
}

int main(void)
{
    RUN(no_order_matters);
    RUN(small_differences_are_exact);
    return check_finish();
}
