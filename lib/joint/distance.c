/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance: P_i and P_j keep a distance, as if joined by a massless link with balls.
 *
 *     d                    d . d = distance^2
 *
 * 1 equation, 5 freedoms. Degenerate if the points coincide (gradient 2 d), which a distance > 0
 * excludes.  docs/theory/joints.md */
#include "joint/joint.h"
#include "joint/rows.h"

void se3di_distance_build(const se3di_joint_frames *frames, const se3d_joint_def *def,
                          se3di_draft *draft)
{
    (void)frames;
    se3di_row_add_d(draft, def->distance);
}
