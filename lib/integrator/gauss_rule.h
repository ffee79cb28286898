/* SPDX-License-Identifier: BSD-3-Clause */
/* Gauss collocation on [0, 1]: the polynomial u' of degree s - 1 through the derivatives K_i at the
 * zeros c_i of the Legendre polynomial P_s(2x - 1), in Lagrange's basis
 *
 *     l_i(x) = b_i sum_{k<s} (2k + 1) P_k(2c_i - 1) P_k(2x - 1),    a_ij = int_0^{c_i} l_j
 *
 * and the one of degree s + 1 that goes through the derivatives at both ends, too (s even):
 *
 *     u'(x) + P_s(2x - 1) (d_0 (1 - x) + d_1 x),    d_0 = f_0 - u'(0),  d_1 = f_1 - u'(1)
 *
 * (Hairer, Wanner 1996, sec. IV.5.)  docs/theory/gauss.md */
#ifndef SE3DI_GAUSS_RULE_H
#define SE3DI_GAUSS_RULE_H

#define SE3DI_GAUSS_MAX   8  /* stages */
#define SE3DI_GAUSS_NODES 10 /* derivatives: of the stages, and at [8] the start, at [9] the end */

typedef struct se3di_gauss_rule {
    int stages;
    double largest;       /* of |int_0^x P_s(2z - 1) dz| in [0, 1] */
    const double *c, *b;  /* [stages] */
    const double *A;      /* [stages * stages] */
    const double *values; /* [k * stages + i]: b_i (2k + 1) P_k(2c_i - 1) */
} se3di_gauss_rule;

/* Of 4 or 8 stages. */
const se3di_gauss_rule *se3di_gauss_find(int stages);

/* The polynomial of degree s + 1 at x, and its integral from 0 to x, as sums over the nodes. */
void se3di_gauss_value(const se3di_gauss_rule *rule, double x, double weights[SE3DI_GAUSS_NODES]);
void se3di_gauss_integral(const se3di_gauss_rule *rule, double x,
                          double weights[SE3DI_GAUSS_NODES]);

/* d_0 and d_1 as sums over the nodes. */
void se3di_gauss_defects(const se3di_gauss_rule *rule, double begin[SE3DI_GAUSS_NODES],
                         double end[SE3DI_GAUSS_NODES]);

#endif
