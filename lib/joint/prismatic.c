/* SPDX-License-Identifier: BSD-3-Clause */
/* Prismatic (translational): body j slides along the common axis and does not turn.
 *
 *     dp1_a, dp1_b         ref_i . axis_j = third_i . axis_j = 0
 *     dp2_a, dp2_b         ref_i . d = third_i . d = 0
 *     dp1_c                ref_i . third_j = 0
 *
 * 5 equations; freedom: the displacement axis_i . d. Like the fixed joint it holds also after half
 * a turn.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_prismatic_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                           se3di_draft *draft)
{
    (void)def;
    se3di_row_add_perpendicular1(draft);
    se3di_row_add_perpendicular2(draft);
    se3di_row_add_dp1(draft, "dp1_c", frames->ref_i, frames->third_j);
}
