/* SPDX-License-Identifier: BSD-3-Clause */
/* Natural cubic splines, straight beyond their ends.               docs/theory/functions.md */
#ifndef SE3DI_MODEL_SPLINE_H
#define SE3DI_MODEL_SPLINE_H

#include <stddef.h>

/* Second derivatives of the spline through x, y into m [n]; scratch [n]. */
void se3di_spline_build(const double *x, const double *y, size_t n, double *m, double *scratch);
/* Index of the interval of x [n] that holds u; outside the first or last one. */
size_t se3di_spline_find(const double *x, size_t n, double u);
/* Jet {f, f', f''} at u of the spline through x [n]; y [n] and m [n] come after them. */
void se3di_spline_eval(const double *x, size_t n, double u, double jet[3]);

#endif
