/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef SE3DI_EIGEN_MODES_H
#define SE3DI_EIGEN_MODES_H

#include "base/alloc.h"

/* Eigenvalues s of (s^2 M + s D + K) y = 0, matrices [f f] row-major. */
typedef struct se3di_eigen {
    int32_t f;       /* length of a shape */
    int32_t room;    /* modes at most; of all modes 2 f */
    int32_t count;   /* modes: imaginary >= 0, increasing |s| */
    double *re, *im; /* [room] */
    double *y_re;    /* [room f]: shape of mode k in row k */
    double *y_im;
} se3di_eigen;

/* Without damping and with symmetric K by the symmetric problem (eigenvalues exactly real or
 * imaginary), else by linearisation and QZ. On failure nothing is held. @return OK, SINGULAR (M),
 * NOT_FINITE, NO_CONVERGENCE, NO_MEMORY. docs/theory/modes.md */
se3d_status se3di_eigen_solve(const se3d_allocator *allocator, int32_t f, const double *M,
                              const double *D, const double *K, se3di_eigen *eigen);
/* Room for modes, none yet. @return OK, NO_MEMORY: nothing is held */
se3d_status se3di_eigen_reserve(const se3d_allocator *allocator, int32_t f, int32_t room,
                                se3di_eigen *eigen);
/* A mode, in its place; y_im [f] may be NULL. */
void se3di_eigen_add(se3di_eigen *eigen, double re, double im, const double *y_re,
                     const double *y_im);
void se3di_eigen_destroy(const se3d_allocator *allocator, se3di_eigen *eigen);

#endif
