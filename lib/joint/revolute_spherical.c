/* SPDX-License-Identifier: BSD-3-Clause */
/* Revolute-spherical: a massless link of length `distance` turns about axis_i on body i,
 * perpendicular to it, and holds P_j with a ball: P_j runs on a circle.
 *
 *     d                    d . d = distance^2
 *     dp2                  axis_i . d = 0
 *
 * 2 equations, 4 freedoms. Regular for a distance > 0: the gradients with respect to r_j, 2 d and
 * axis_i, are perpendicular to each other.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_revolute_spherical_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                                    se3di_draft *draft)
{
    se3di_row_add_d(draft, def->distance);
    se3di_row_add_dp2(draft, "dp2", frames->axis_i);
}
