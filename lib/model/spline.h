/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves through tables: natural cubic splines, straight lines, Akima's, and periodic ones. Those
 * that do not repeat are straight beyond their ends.               docs/theory/functions.md */
#ifndef SE3DI_MODEL_SPLINE_H
#define SE3DI_MODEL_SPLINE_H

#include "se3d/function.h"

/* A view of a table: x [n] increasing, y [n], and of every point what the kind needs, m [n]: the
 * second derivative (cubic), the slope (Akima), nothing (linear). */
typedef struct se3di_spline {
    const double *x, *y, *m;
    size_t n;
    int32_t kind;     /* se3d_table_kind */
    int32_t periodic; /* y[n - 1] is y[0], one period after it */
} se3di_spline;

/* Numbers that se3di_spline_build works with. */
size_t se3di_spline_scratch_size(size_t n);
/* Compute m [n]; `s->m` is not looked at. */
void se3di_spline_build(const se3di_spline *s, double *m, double *scratch);
/* Jet {f, f', f''} at u. At a point at which a derivative jumps
 * it is that behind. */
void se3di_spline_eval(const se3di_spline *s, double u, double jet[3]);
/* Fill knots [n]: the integral from the first point to each. */
void se3di_spline_integrate(const se3di_spline *s, double *knots);
/* The integral from the first point to u. */
double se3di_spline_integral(const se3di_spline *s, const double *knots, double u);

#endif
