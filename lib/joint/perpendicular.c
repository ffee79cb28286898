/* SPDX-License-Identifier: BSD-3-Clause */
/* Perpendicular: axis_i and axis_j stay perpendicular to each other.
 *
 *     dp1                  axis_i . axis_j = 0
 *
 * 1 equation, 5 freedoms. Regular wherever it holds.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_perpendicular_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                               se3di_draft *draft)
{
    (void)def;
    se3di_row_add_dp1(draft, "dp1", frames->axis_i, frames->axis_j);
}
