/* SPDX-License-Identifier: BSD-3-Clause */
/* Universal (Cardan, Hooke): the arms of the cross lie along axis_i and axis_j.
 *
 *     cd_x, cd_y, cd_z     d = 0
 *     dp1                  axis_i . axis_j = 0
 *
 * 4 equations; freedoms: the turns about axis_i and about axis_j. The equations are regular in
 * every position; parallel axes (gradient zero) violate dp1 the most.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_universal_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                           se3di_draft *draft)
{
    (void)def;
    se3di_row_add_spherical(draft);
    se3di_row_add_dp1(draft, "dp1", frames->axis_i, frames->axis_j);
}
