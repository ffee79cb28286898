/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/elementary.h"

#include <math.h>

#include "se3d/elementary.h"

double se3d_elementary_eval(int32_t function, double x, double y)
{
    static double (*const of_one[])(double) = {se3di_sin,   se3di_cos,  se3di_tan,  se3di_asin,
                                               se3di_acos,  se3di_atan, se3di_exp,  se3di_log,
                                               se3di_log10, se3di_sinh, se3di_cosh, se3di_tanh};
    static double (*const of_two[])(double, double) = {se3di_atan2, se3di_hypot, se3di_pow};
    if (function >= SE3D_ELEMENTARY_SIN && function <= SE3D_ELEMENTARY_TANH) {
        return of_one[function](x);
    }
    if (function >= SE3D_ELEMENTARY_ATAN2 && function <= SE3D_ELEMENTARY_POW) {
        return of_two[function - SE3D_ELEMENTARY_ATAN2](x, y);
    }
    return (double)NAN;
}
