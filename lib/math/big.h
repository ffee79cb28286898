/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of 384 bits for the second phase of the elementary functions: cut, not rounded, after
 * each operation. Slow (a function takes about 20 us) and rarely asked. */
#ifndef SE3DI_MATH_BIG_H
#define SE3DI_MATH_BIG_H

#include <stdint.h>

#define SE3DI_BIG_WORDS 12

/* sign 0.w[0] w[1] .. 2^exponent; w[0] has its top bit set, or all are 0 */
typedef struct se3di_big {
    uint32_t w[SE3DI_BIG_WORDS];
    int32_t sign; /* 1 or -1 */
    int64_t exponent;
} se3di_big;

/* Of a finite x. */
se3di_big se3di_big_from(double x);
/* Rounded to nearest, ties to even, also to subnormals; too large: infinite. What is within 2^-256
 * of 54 bits counts as them, so that exact results and ties come out as such. */
double se3di_big_round(const se3di_big *a);

int se3di_big_is_zero(const se3di_big *a);
se3di_big se3di_big_add(const se3di_big *a, const se3di_big *b);
se3di_big se3di_big_subtract(const se3di_big *a, const se3di_big *b);
se3di_big se3di_big_multiply(const se3di_big *a, const se3di_big *b);
se3di_big se3di_big_divide(const se3di_big *a, const se3di_big *b); /* b not 0 */
se3di_big se3di_big_divide_by(const se3di_big *a, uint32_t b);      /* b not 0 */
se3di_big se3di_big_shift(const se3di_big *a, int64_t by);          /* times 2^by */
se3di_big se3di_big_root(const se3di_big *a);                       /* a >= 0 */

/* The number 0.words (most significant first), `count` of them. */
se3di_big se3di_big_of_words(const uint32_t *words, int count);

#endif
