/* SPDX-License-Identifier: BSD-3-Clause */
#include "math/quaternion.h"
#include "model/model.h"

void se3di_frame_update(se3di_frame *frame)
{
    se3di_quat_to_matrix(frame->p, frame->A);
    se3di_quat_rate(frame->p, frame->w, frame->pdot);
}
