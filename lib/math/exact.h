/* SPDX-License-Identifier: BSD-3-Clause */
/* Sums that do not depend on the order of what is added: each number in parts that are multiples of
 * powers of two, the sums of which are exact. */
#ifndef SE3DI_MATH_EXACT_H
#define SE3DI_MATH_EXACT_H

#define SE3DI_EXACT_SIZE 8

/* Part k: multiples of 2^(8 - 24 k), of numbers up to 2^59; what is below 2^-160 is left out. */
typedef struct se3di_exact {
    double part[SE3DI_EXACT_SIZE];
} se3di_exact;

/* Nothing is rounded up to 2^28 calls without se3di_exact_carry() in between. */
void se3di_exact_add(se3di_exact *sum, double value);
void se3di_exact_add_sum(se3di_exact *sum, const se3di_exact *other);
/* The same sum in parts that are small. */
void se3di_exact_carry(se3di_exact *sum);
/* The sum, rounded at last: it depends on nothing but what was added. */
double se3di_exact_get(const se3di_exact *sum);

#endif
