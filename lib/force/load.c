/* SPDX-License-Identifier: BSD-3-Clause */
/* Applied loads: a force at a point of a body or a torque, constant or functions of time, with
 * components in the ground frame or in the body frame (a follower load).  docs/theory/loads.md */
#include "force/force.h"
#include "math/vec3.h"

se3d_status se3di_load_add(const se3di_model *model, const se3di_force *force, double t,
                           double *wrench)
{
    const se3di_frame *frame = &model->frames[force->body_j];
    double *out = wrench + 6 * force->body_j;
    double value[3];
    double turned[3];
    for (int c = 0; c < 3; ++c) {
        double jet[3] = {force->value[c], 0.0, 0.0};
        if (force->function[c] >= 0) {
            SE3DI_TRY(se3di_function_eval(&model->functions[force->function[c]], &t, jet, NULL));
        }
        value[c] = jet[0];
    }
    int is_torque = force->type == SE3DI_FORCE_TORQUE;
    if (is_torque && force->in_body_frame) {
        se3di_add(out + 3, value, out + 3);
    } else if (is_torque) {
        se3di_mul_transposed(frame->A, value, turned);
        se3di_add(out + 3, turned, out + 3);
    } else if (force->in_body_frame) {
        se3di_mul(frame->A, value, turned);
        se3di_wrench_add_at(frame, force->s_j, turned, out);
    } else {
        se3di_wrench_add_at(frame, force->s_j, value, out);
    }
    return SE3D_OK;
}
