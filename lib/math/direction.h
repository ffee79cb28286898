/* SPDX-License-Identifier: BSD-3-Clause */
/* Directions that are given. */
#ifndef SE3DI_MATH_DIRECTION_H
#define SE3DI_MATH_DIRECTION_H

#include "base/error.h"

/* Whether `count` values are finite; `what` names them in the message.
 * @return OK, INVALID_ARGUMENT */
se3d_status se3di_finites_check(const char *what, const double *values, int count,
                                se3di_error *error);

/* The unit vector along `values`, which must be finite and not zero.
 * @return OK, INVALID_ARGUMENT */
se3d_status se3di_direction_read(const char *what, const double values[3], double unit[3],
                                 se3di_error *error);

#endif
