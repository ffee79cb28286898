/* SPDX-License-Identifier: BSD-3-Clause */
/* Planar: the plane through P_j perpendicular to axis_j glides on the plane through P_i
 * perpendicular to axis_i.
 *
 *     dp1_a, dp1_b         ref_i . axis_j = third_i . axis_j = 0
 *     dp2                  axis_i . d = 0
 *
 * 3 equations; freedoms: two translations and the angle. Never degenerate.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_planar_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                        se3di_draft *draft)
{
    (void)def;
    se3di_row_add_perpendicular1(draft);
    se3di_row_add_dp2(draft, "dp2", frames->axis_i);
}
