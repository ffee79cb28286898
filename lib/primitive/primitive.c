/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of constraint primitives. */
#include "primitive/primitive.h"

#include "primitive/table.h"
#include "se3d/constraint.h"

#define ROW(TYPE, name)                                                                            \
    [SE3DI_PRIMITIVE_##TYPE] = {#name,                                                             \
                                se3di_primitive_##name##_value,                                    \
                                se3di_primitive_##name##_jacobian_romega,                          \
                                se3di_primitive_##name##_jacobian_rp,                              \
                                se3di_primitive_##name##_gamma_romega,                             \
                                se3di_primitive_##name##_gamma_rp,                                 \
                                se3di_primitive_##name##_curvature_romega,                         \
                                se3di_primitive_##name##_curvature_rp},

const se3di_primitive se3di_primitives[SE3DI_PRIMITIVE_COUNT] = {SE3DI_PRIMITIVE_LIST(ROW)};

/* The public numbers are ours. */
_Static_assert((int)SE3D_PRIMITIVE_DP1 == SE3DI_PRIMITIVE_DP1 &&
                   (int)SE3D_PRIMITIVE_DP2 == SE3DI_PRIMITIVE_DP2 &&
                   (int)SE3D_PRIMITIVE_D == SE3DI_PRIMITIVE_D &&
                   (int)SE3D_PRIMITIVE_CD == SE3DI_PRIMITIVE_CD,
               "se3d_primitive_type numbers the first primitives of the list");
