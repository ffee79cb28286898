/* SPDX-License-Identifier: BSD-3-Clause */
/* Orientation: no relative rotation; the triads stay parallel.
 *
 *     dp1_a, dp1_b         ref_i . axis_j = third_i . axis_j = 0
 *     dp1_c                ref_i . third_j = 0
 *
 * 3 equations; freedoms: three translations. Holds also after half a turn, see fixed.c.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_orientation_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                             se3di_draft *draft)
{
    (void)frames;
    (void)def;
    se3di_row_add_orientation(draft);
}
