/* SPDX-License-Identifier: BSD-3-Clause */
/* Perpendicular 2 (ME751): d is perpendicular to the plane whose normal on body i is axis_i; the
 * same equations as point_on_line.
 *
 *     dp2_a, dp2_b         ref_i . d = third_i . d = 0
 *
 * 2 equations; freedoms: the displacement axis_i . d and three rotations. Regular also if d = 0.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_perpendicular2_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                                se3di_draft *draft)
{
    (void)frames;
    (void)def;
    se3di_row_add_perpendicular2(draft);
}
