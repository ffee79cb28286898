/* SPDX-License-Identifier: BSD-3-Clause */
/* Fixed: no relative motion.
 *
 *     cd_x, cd_y, cd_z     d = 0
 *     dp1_a, dp1_b         ref_i . axis_j = third_i . axis_j = 0
 *     dp1_c                ref_i . third_j = 0
 *
 * 6 equations, no freedom. The rotational rows vanish also if body j is turned by half a turn
 * about one of its directions: a guess within a quarter of a turn finds the right one. Regular
 * there: the gradients of dp1_a, dp1_b, dp1_c are -third, ref, axis.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_fixed_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                       se3di_draft *draft)
{
    (void)frames;
    (void)def;
    se3di_row_add_spherical(draft);
    se3di_row_add_orientation(draft);
}
