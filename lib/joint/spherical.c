/* SPDX-License-Identifier: BSD-3-Clause */
/* Spherical: the joint points coincide.
 *
 *     cd_x, cd_y, cd_z     d = 0
 *
 * 3 equations; freedoms: three rotations. Never degenerate.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_spherical_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                           se3di_draft *draft)
{
    (void)frames;
    (void)def;
    se3di_row_add_spherical(draft);
}
