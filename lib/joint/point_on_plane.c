/* SPDX-License-Identifier: BSD-3-Clause */
/* Point on plane: P_j stays in the plane through P_i perpendicular to axis_i.
 *
 *     dp2                  axis_i . d = 0
 *
 * 1 equation, 5 freedoms. Never degenerate.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_point_on_plane_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                                se3di_draft *draft)
{
    (void)def;
    se3di_row_add_dp2(draft, "dp2", frames->axis_i);
}
