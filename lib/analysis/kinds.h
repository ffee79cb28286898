/* SPDX-License-Identifier: BSD-3-Clause */
/* The analyses: their numbers are those of se3d_analysis. */
#ifndef SE3DI_ANALYSIS_KINDS_H
#define SE3DI_ANALYSIS_KINDS_H

#include "se3d/solver.h"

#define SE3DI_ANALYSIS_HAS_MOTION 1u /* goes on in time */
#define SE3DI_ANALYSIS_IS_DRIVEN  2u /* its motion follows from constraints and drivers alone */

/* X(ANALYSIS, name in model files, traits), in the order of the numbers. */
#define SE3DI_ANALYSIS_LIST(X)                                                                     \
    X(ASSEMBLY, assembly, 0u)                                                                      \
    X(KINEMATICS, kinematics, SE3DI_ANALYSIS_HAS_MOTION | SE3DI_ANALYSIS_IS_DRIVEN)                \
    X(INVERSE_DYNAMICS, inverse_dynamics, SE3DI_ANALYSIS_HAS_MOTION | SE3DI_ANALYSIS_IS_DRIVEN)    \
    X(DYNAMICS, dynamics, SE3DI_ANALYSIS_HAS_MOTION)                                               \
    X(EQUILIBRIUM, equilibrium, 0u)

/* The name, "" if no analysis has that number. */
const char *se3di_analysis_get_name(int32_t analysis);
/* Whether it has one of the traits. */
int se3di_analysis_is(int32_t analysis, uint32_t traits);

#endif
