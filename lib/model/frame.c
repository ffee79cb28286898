/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/quaternion.h"
#include "math/vec3.h"
#include "model/model.h"

#include <string.h>

void se3di_frame_update(se3di_frame *frame)
{
    se3di_quat_to_matrix(frame->p, frame->A);
    se3di_quat_rate(frame->p, frame->w, frame->pdot);
}

void se3di_frame_get_motion(const se3di_frame *frame, se3d_body_motion *motion)
{
    se3di_copy(frame->r, motion->r);
    memcpy(motion->p, frame->p, sizeof motion->p);
    se3di_copy(frame->v, motion->v);
    se3di_copy(frame->w, motion->w);
}
