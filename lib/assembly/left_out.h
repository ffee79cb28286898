/* SPDX-License-Identifier: BSD-3-Clause */
/* Rows of the model that are left out of the equations (nonlinear/ranks.h): they stay numbered,
 * with zeros for their values and their part of the Jacobian, and multipliers zero. */
#ifndef SE3DI_LEFT_OUT_H
#define SE3DI_LEFT_OUT_H

#include "assembly/assembly.h"

void se3di_left_out_clear_values(const se3di_assembly *assembly, double *values); /* [rows] */
void se3di_left_out_clear_blocks(const se3di_assembly *assembly, double *C);      /* as C */

#endif
