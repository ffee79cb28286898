/* SPDX-License-Identifier: BSD-3-Clause */
/* Gauss collocation on [0, 1]: the polynomial u' of degree s - 1 through the derivatives K_i at the
 * zeros c_i of the Legendre polynomial P_s(xi), xi = 2x - 1,
 *
 *     u' = sum_{k<s} a_k P_k(xi),    a_k = sum_i b_i (2k + 1) P_k(2c_i - 1) K_i,
 *     a_ij = int_0^{c_i} l_j    (l_j: Lagrange's basis)
 *
 * and the one of degree s + 1 that goes through the derivatives at both ends, too (s even):
 *
 *     u' + P_s(xi) (d_0 (1 - x) + d_1 x),    d_0 = f_0 - u'(0),  d_1 = f_1 - u'(1)
 *
 * (Hairer, Wanner 1996, sec. IV.5.)  docs/theory/gauss.md */
#ifndef SE3DI_GAUSS_RULE_H
#define SE3DI_GAUSS_RULE_H

#define SE3DI_GAUSS_MAX 8 /* stages */
/* Of the polynomial through both ends: a_0 ... a_{s-1} of P_k, then (d_0 + d_1)/2 of P_s and
 * (d_1 - d_0)/2 of xi P_s. */
#define SE3DI_GAUSS_FORMS  10
#define SE3DI_GAUSS_POINTS (SE3DI_GAUSS_MAX + 1) /* the most at which forms are asked for at once */

typedef struct se3di_gauss_rule {
    int stages;
    double largest;       /* of |int_0^x P_s(2z - 1) dz| in [0, 1] */
    const double *c, *b;  /* [stages] */
    const double *A;      /* [stages * stages] */
    const double *values; /* [k * stages + i]: b_i (2k + 1) P_k(2c_i - 1) */
} se3di_gauss_rule;

/* Derivatives of stages as the polynomial of the step before goes on: that at its end, and of each
 * form but the first one (which is constant) weights[(k - 1) * SE3DI_GAUSS_MAX + i]. */
typedef struct se3di_gauss_prediction {
    int forms; /* 0: all are that at the end */
    double weights[(SE3DI_GAUSS_FORMS - 1) * SE3DI_GAUSS_MAX];
} se3di_gauss_prediction;

/* Of 4 or 8 stages. */
const se3di_gauss_rule *se3di_gauss_find(int stages);

/* What the s + 2 forms are multiplied by at points x, side by side: bases[form *
 * SE3DI_GAUSS_POINTS + point], all 1 at the end. */
void se3di_gauss_bases(const se3di_gauss_rule *rule, int points, const double *x, double *bases);
/* Integrals of the forms from 0 to x. */
void se3di_gauss_integral(const se3di_gauss_rule *rule, double x,
                          double integral[SE3DI_GAUSS_FORMS]);

#endif
