/* SPDX-License-Identifier: BSD-3-Clause */
/* Armature: the inertia of what turns with a coordinate x of a joint, a rotor behind a gear,
 *
 *     kinetic energy = 1/2 a xdot^2,   a times xddot against the coordinate
 *
 * and nothing else: it has no weight and takes no part in the motion of the joint as a whole. It is
 * a part of the mass matrix (assembly/armature.h), not a wrench: forces and their Jacobians are
 * zero here.  docs/theory/armature.md */
#include "force/force.h"

static se3d_status eval_armature(const se3di_model *model, const se3di_force *force, double t,
                                 se3di_effect *effect)
{
    (void)model;
    (void)force;
    (void)t;
    (void)effect;
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_armature = {
    .name = "armature",
    .eval = eval_armature,
    .traits = SE3DI_FORCE_IS_SCALAR,
};
