/* SPDX-License-Identifier: BSD-3-Clause */
/* Revolute-cylindrical: a massless link turns about axis_i through P_i on body i and carries a
 * cylindrical joint along axis_j through P_j on body j; the axes are square to each other and meet.
 *
 *     dp1                  axis_i . axis_j = 0
 *     dp2_a, dp2_b         ref_j . d = third_j . d = 0: P_i is on the line through P_j along axis_j
 *
 * 3 equations; freedoms: the turns about axis_i and about axis_j and the slide along axis_j. The
 * equations are regular in every position that meets them.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

#include "math/vec3.h"

/* direction of body j . (P_i - P_j) = 0: the primitive DP2 with the bodies exchanged */
static void add_row(se3di_draft *draft, const char *name, const double a_j[3])
{
    se3di_term term = {.type = SE3DI_PRIMITIVE_DP2,
                       .angle = -1,
                       .body_i = draft->constraint.bodies[1],
                       .body_j = draft->constraint.bodies[0]};
    se3di_copy(a_j, term.a_i);
    se3di_copy(draft->constraint.frames.point_j, term.s_i);
    se3di_copy(draft->constraint.frames.point_i, term.s_j);
    se3di_draft_add_row(draft, name, 0.0);
    se3di_draft_add_term(draft, &term, 1.0);
}

void se3di_revolute_cylindrical_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                                      se3di_draft *draft)
{
    (void)def;
    se3di_row_add_dp1(draft, "dp1", frames->axis_i, frames->axis_j);
    add_row(draft, "dp2_a", frames->ref_j);
    add_row(draft, "dp2_b", frames->third_j);
}
