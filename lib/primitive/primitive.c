/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of constraint primitives. */
#include "primitive/primitive.h"

#include "primitive/table.h"

#define ROW(name)                                                                                  \
    {                                                                                              \
#name, se3di_primitive_##name##_value, se3di_primitive_##name##_jacobian_romega,           \
            se3di_primitive_##name##_jacobian_rp, se3di_primitive_##name##_gamma_romega,           \
            se3di_primitive_##name##_gamma_rp, se3di_primitive_##name##_curvature_romega,          \
            se3di_primitive_##name##_curvature_rp                                                  \
    }

const se3di_primitive se3di_primitives[SE3DI_PRIMITIVE_COUNT] = {
    [SE3DI_PRIMITIVE_DP1] = ROW(dp1),     [SE3DI_PRIMITIVE_DP2] = ROW(dp2),
    [SE3DI_PRIMITIVE_D] = ROW(d),         [SE3DI_PRIMITIVE_CD] = ROW(cd),
    [SE3DI_PRIMITIVE_ANGLE] = ROW(angle), [SE3DI_PRIMITIVE_TRIPLE] = ROW(triple),
};
