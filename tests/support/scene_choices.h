/* SPDX-License-Identifier: BSD-3-Clause */
/* The methods that scenes of contact run in: an explicit one with a given step, one with control of
 * the error and an implicit one; in the other formulations, too, if all is wanted. */
#ifndef SE3D_TESTS_SUPPORT_SCENE_CHOICES_H
#define SE3D_TESTS_SUPPORT_SCENE_CHOICES_H

#include "support/scene.h"

typedef struct choice {
    int32_t method, formulation;
} choice;

static const choice choices[] = {{SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA},
                                 {SE3D_METHOD_DOP853, SE3D_FORMULATION_RP},
                                 {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_ROMEGA},
                                 {SE3D_METHOD_VERLET, SE3D_FORMULATION_RP},
                                 {SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA},
                                 {SE3D_METHOD_GENERALIZED_ALPHA, SE3D_FORMULATION_RP}};
#define CHOICES (sizeof choices / sizeof choices[0] / (check_is_long() ? 1 : 2))

#endif
