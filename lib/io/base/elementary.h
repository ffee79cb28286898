/* SPDX-License-Identifier: BSD-3-Clause */
/* Elementary functions with the same bits everywhere, through the public header. */
#ifndef SE3DI_IO_ELEMENTARY_H
#define SE3DI_IO_ELEMENTARY_H

#include "se3d/elementary.h"

static inline double io_sin(double x)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_SIN, x, 0.0);
}

static inline double io_cos(double x)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_COS, x, 0.0);
}

static inline double io_exp(double x)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_EXP, x, 0.0);
}

static inline double io_log(double x)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_LOG, x, 0.0);
}

static inline double io_log10(double x)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_LOG10, x, 0.0);
}

static inline double io_atan2(double y, double x)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_ATAN2, y, x);
}

static inline double io_hypot(double x, double y)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_HYPOT, x, y);
}

static inline double io_pow(double x, double y)
{
    return se3d_elementary_eval(SE3D_ELEMENTARY_POW, x, y);
}

#endif
