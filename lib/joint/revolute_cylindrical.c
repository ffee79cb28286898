/* SPDX-License-Identifier: BSD-3-Clause */
/* Revolute-cylindrical: a massless link turns about axis_i through P_i on body i, perpendicular to
 * it, and carries a cylindrical joint along axis_j through P_j on body j; the axes are
 * perpendicular to each other at `distance`.
 *
 *     dp1                  axis_i . axis_j = 0
 *     dp2                  axis_i . d = 0
 *     triple               d . (axis_i x axis_j) = +-distance, on the side of the present pose
 *
 * 3 equations; freedoms: the turns about axis_i and about axis_j and the slide along axis_j. The
 * equations are regular in every position that meets them, also for a distance of 0.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_revolute_cylindrical_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                                      se3di_draft *draft)
{
    (void)def;
    se3di_row_add_dp1(draft, "dp1", frames->axis_i, frames->axis_j);
    se3di_row_add_dp2(draft, "dp2", frames->axis_i);
    se3di_row_add_triple(draft, "triple", frames->axis_i, frames->axis_j);
}
