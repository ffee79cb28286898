/* SPDX-License-Identifier: BSD-3-Clause */
/* Perpendicular 1 (ME751): the direction axis_j of body j is perpendicular to the plane whose
 * normal on body i is axis_i; the same equations as parallel.
 *
 *     dp1_a, dp1_b         ref_i . axis_j = third_i . axis_j = 0
 *
 * 2 equations; freedoms: the angle and three translations. Never degenerate.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_perpendicular1_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                                se3di_draft *draft)
{
    (void)frames;
    (void)def;
    se3di_row_add_perpendicular1(draft);
}
