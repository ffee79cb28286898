/* SPDX-License-Identifier: BSD-3-Clause */
/* Small symmetric matrices. */
#ifndef SE3DI_SYMMETRIC_H
#define SE3DI_SYMMETRIC_H

#define SE3DI_SYMMETRIC_MAX 12

/* A <- |A|: the same eigenvectors with the absolute eigenvalues, by Jacobi's method. A [n n]
 * symmetric (its mean with its transpose is taken), n <= 12. What is not finite stays so. */
void se3di_symmetric_abs(int n, double *A);

#endif
