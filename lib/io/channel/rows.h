/* SPDX-License-Identifier: BSD-3-Clause */
/* What a number adds up to between two rows, h apart, where it counts as a straight line from a to
 * b. The errors are h^2/12 times the change of the rate. */
#ifndef SE3D_IO_ROWS_H
#define SE3D_IO_ROWS_H

static inline double se3di_rows_integral(double h, double a, double b)
{
    return h * 0.5 * (a + b);
}

/* Of the square. */
static inline double se3di_rows_squares(double h, double a, double b)
{
    return h * (a * a + a * b + b * b) / 3.0;
}

#endif
