/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls that are let fail: what refusals.py wraps asks the test whether it shall. */
#ifndef SE3D_TESTS_SUPPORT_REFUSALS_H
#define SE3D_TESTS_SUPPORT_REFUSALS_H

#include "se3d/base.h"

/* Provided by the test. `documented`: the worst failure that the description of the function tells,
 * SE3D_OK where it tells mistakes of the caller only. @return SE3D_OK, or how this call fails */
se3d_status support_refusal(const char *function, se3d_status documented);

#endif
