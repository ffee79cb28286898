/* SPDX-License-Identifier: BSD-3-Clause */
/* Screw: body j advances along the common axis by `pitch` per turn.
 *
 *     dp1_a, dp1_b         ref_i . axis_j = third_i . axis_j = 0
 *     dp2_a, dp2_b         ref_i . d = third_i . d = 0
 *     screw                axis_i . d - pitch / (2 pi) angle = constant, of the present pose
 *
 * 5 equations; freedom: the angle (or the displacement). The angle counts turns. Never degenerate.
 * docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

#define TWO_PI 6.283185307179586476925286766559

void se3di_screw_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                       se3di_draft *draft)
{
    se3di_row_add_perpendicular1(draft);
    se3di_row_add_perpendicular2(draft);
    se3di_term displacement;
    se3di_displacement_term_init(&displacement, frames, draft->constraint.bodies);
    se3di_draft_add_row(draft, "screw", 0.0);
    se3di_draft_add_term(draft, &displacement, 1.0);
    se3di_draft_add_term(draft, &draft->angle.term, -def->pitch / TWO_PI);
}
