/* SPDX-License-Identifier: BSD-3-Clause */
/* The elementary functions that expressions are made of, for callbacks that are to give the same
 * bits on every machine: those of libm differ from library to library.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_ELEMENTARY_H
#define SE3D_ELEMENTARY_H

#include "se3d/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of x, the last three of x and y. @since 0.1 */
typedef enum se3d_elementary {
    SE3D_ELEMENTARY_SIN = 0,
    SE3D_ELEMENTARY_COS = 1,
    SE3D_ELEMENTARY_TAN = 2,
    SE3D_ELEMENTARY_ASIN = 3,
    SE3D_ELEMENTARY_ACOS = 4,
    SE3D_ELEMENTARY_ATAN = 5,
    SE3D_ELEMENTARY_EXP = 6,
    SE3D_ELEMENTARY_LOG = 7,
    SE3D_ELEMENTARY_LOG10 = 8,
    SE3D_ELEMENTARY_SINH = 9,
    SE3D_ELEMENTARY_COSH = 10,
    SE3D_ELEMENTARY_TANH = 11,
    SE3D_ELEMENTARY_ATAN2 = 12, /* the angle of the point (y, x): x is the ordinate, as in C */
    SE3D_ELEMENTARY_HYPOT = 13,
    SE3D_ELEMENTARY_POW = 14
} se3d_elementary;

/* Evaluate an elementary function: the double nearest to the exact value (ties to even), with the
 * special cases of C11, annex F. Angles are in radians.
 * @param[in] function  se3d_elementary
 * @param[in] x         any number [1, rad]
 * @param[in] y         any number [1]; counts for ATAN2, HYPOT and POW only
 * @return the value; NaN if `function` is none of them.
 * @since 0.1 */
SE3D_API double se3d_elementary_eval(int32_t function, double x, double y);

#ifdef __cplusplus
}
#endif

#endif
