/* SPDX-License-Identifier: BSD-3-Clause */
/* Point on line: P_j stays on the line through P_i along axis_i.
 *
 *     dp2_a, dp2_b         ref_i . d = third_i . d = 0
 *
 * 2 equations; freedoms: the displacement axis_i . d and three rotations. Never degenerate.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_point_on_line_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                               se3di_draft *draft)
{
    (void)frames;
    (void)def;
    se3di_row_add_perpendicular2(draft);
}
