/* SPDX-License-Identifier: BSD-3-Clause */
/* Applied loads on body j: a force F at a point s or a torque n, constant or functions of time,
 * with components in the ground frame or in the body frame (a follower load).
 *
 *     ground frame:  F, s x A^T F          follower:  A F, s x F          torque:  A^T n or n
 *     derivatives to dtheta:  A^T y -> tilde(A^T y),  A y -> -A tilde(y)
 *
 * docs/theory/loads.md */
#include "force/signal.h"
#include "math/vec3.h"

static se3d_status get_value(const se3di_model *model, const se3di_force *force, double t,
                             se3di_law_notes *notes, double value[3])
{
    for (int c = 0; c < 3; ++c) {
        double jet[3] = {force->value[c], 0.0, 0.0};
        if (force->function[c] >= 0) {
            SE3DI_TRY(
                se3di_law_eval(model, &model->functions[force->function[c]], &t, notes, jet, NULL));
        }
        value[c] = jet[0];
    }
    return SE3D_OK;
}

/* The 3 x 3 block of K for body j that begins at (row, 9). */
static void set_block(se3di_effect *effect, int row, const double M[9])
{
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            effect->K[12 * (row + r) + 9 + c] = M[3 * r + c];
        }
    }
}

static void add_power(const se3di_frame *frame, se3di_effect *effect)
{
    effect->power[1] =
        se3di_dot(effect->wrench + 6, frame->v) + se3di_dot(effect->wrench + 9, frame->w);
}

static se3d_status eval_load(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect)
{
    const se3di_frame *frame = &model->frames[force->body_j];
    double value[3], local[3], T[9], S[9], M[9];
    SE3DI_TRY(get_value(model, force, t, effect->notes, value));
    if (force->in_body_frame) {
        se3di_mul(frame->A, value, effect->wrench + 6);
        se3di_cross(force->s_j, value, effect->wrench + 9);
        if (effect->wants_derivative) {
            const double minus[3] = {-value[0], -value[1], -value[2]};
            se3di_tilde(minus, T);
            se3di_mat_mul(frame->A, T, M);
            set_block(effect, 6, M);
        }
    } else {
        se3di_copy(value, effect->wrench + 6);
        se3di_mul_transposed(frame->A, value, local);
        se3di_cross(force->s_j, local, effect->wrench + 9);
        if (effect->wants_derivative) {
            se3di_tilde(local, T);
            se3di_tilde(force->s_j, S);
            se3di_mat_mul(S, T, M);
            set_block(effect, 9, M);
        }
    }
    add_power(frame, effect);
    return SE3D_OK;
}

static se3d_status eval_torque(const se3di_model *model, const se3di_force *force, double t,
                               se3di_effect *effect)
{
    const se3di_frame *frame = &model->frames[force->body_j];
    double value[3], T[9];
    SE3DI_TRY(get_value(model, force, t, effect->notes, value));
    if (force->in_body_frame) {
        se3di_copy(value, effect->wrench + 9);
    } else {
        se3di_mul_transposed(frame->A, value, effect->wrench + 9);
        if (effect->wants_derivative) {
            se3di_tilde(effect->wrench + 9, T);
            set_block(effect, 9, T);
        }
    }
    add_power(frame, effect);
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_load = {
    .name = "force",
    .eval = eval_load,
};

const se3di_force_class se3di_force_class_torque = {
    .name = "torque",
    .eval = eval_torque,
};
