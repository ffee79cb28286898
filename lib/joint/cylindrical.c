/* SPDX-License-Identifier: BSD-3-Clause */
/* Cylindrical: body j turns about and slides along the common axis.
 *
 *     dp1_a, dp1_b         ref_i . axis_j = third_i . axis_j = 0
 *     dp2_a, dp2_b         ref_i . d = third_i . d = 0
 *
 * 4 equations; freedoms: the angle and the displacement axis_i . d. Never degenerate.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_cylindrical_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                             se3di_draft *draft)
{
    (void)frames;
    (void)def;
    se3di_row_add_perpendicular1(draft);
    se3di_row_add_perpendicular2(draft);
}
