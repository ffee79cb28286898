/* SPDX-License-Identifier: BSD-3-Clause */
/* Into how many equal steps a way in time is divided, and how long they are. */
#ifndef SE3DI_MATH_STEPS_H
#define SE3DI_MATH_STEPS_H

#include "math/over.h"

#include <float.h>
#include <math.h>

/* As many steps of at most `step` as the time `rest` until `t_end` takes, at least 1; it may be
 * longer than a number of steps by its rounding, which is that of the times and grows with them. */
static inline double se3di_steps_count(double rest, double step, double t_end)
{
    const double rounding = 1e-9 + se3di_over(4.0 * DBL_EPSILON * fabs(t_end), step);
    return fmax(1.0, ceil(se3di_over(rest, step) - fmin(rounding, 0.5)));
}

/* The length of a step of h from t, which ends at `end`, both rounded. At late times, after a
 * minute, it is what they say, else their rounding would add up; before, equal steps stay equal. */
static inline double se3di_step_length(double t, double end, double h)
{
    const double length = end - t;
    return fabs(length - h) > 1e-14 ? length : h;
}

#endif
