/* SPDX-License-Identifier: BSD-3-Clause */
/* Quantiles: the value below which the share u of a distribution lies. */
#ifndef SE3D_IO_STUDY_QUANTILE_H
#define SE3D_IO_STUDY_QUANTILE_H

/* Of the normal distribution with mean 0 and deviation 1; 0 < u < 1. Its relative error is about
 * 1e-15. */
double se3di_quantile_normal(double u);
/* Of the triangular distribution from a[0] over a[1] to a[2]. */
double se3di_quantile_triangular(const double a[3], double u);
/* -log(1 - u), of the exponential distribution with mean 1. */
double se3di_quantile_exponential(double u);

#endif
