/* SPDX-License-Identifier: BSD-3-Clause */
/* TSDA: translational spring-damper-actuator between point s_i of body i and s_j of body j,
 *
 *     d = r_j + A_j s_j - r_i - A_i s_i,  l = |d|,  u = d / l,  ldot = u . ddot
 *     f = k (l - l0) + c ldot + h(t, l, ldot)      F_i = f u,  F_j = -f u
 *
 * (Haug 1989, sec. 11.4.) At l = 0 the direction is lost; with l0 = 0 and no actuator the force k d
 * + c ddot is still regular.  docs/theory/springs.md */
#include "force/force.h"
#include "math/vec3.h"

static void point_motion(const se3di_frame *frame, const double s[3], double position[3],
                         double velocity[3])
{
    double turned[3];
    se3di_mul(frame->A, s, turned);
    se3di_add(frame->r, turned, position);
    se3di_cross(frame->w, s, turned);
    se3di_mul(frame->A, turned, velocity);
    se3di_add(velocity, frame->v, velocity);
}

se3d_status se3di_tsda_state(const se3di_model *model, const se3di_force *force, double t,
                             se3di_spring_state *state)
{
    double d[3];
    double ddot[3];
    double from[3];
    double from_rate[3];
    point_motion(&model->frames[force->body_i], force->s_i, from, from_rate);
    point_motion(&model->frames[force->body_j], force->s_j, d, ddot);
    se3di_sub(d, from, d);
    se3di_sub(ddot, from_rate, ddot);
    double l = se3di_norm(d);
    *state = (se3di_spring_state){.coordinate = l};
    if (l < 1e-14 * (1.0 + se3di_norm(from))) {
        if (force->rest > 0.0 || force->function[0] >= 0) {
            return SE3D_ERR_SINGULAR;
        }
        for (int k = 0; k < 3; ++k) {
            state->pull[k] = force->k * d[k] + force->c * ddot[k];
        }
        return SE3D_OK;
    }
    se3di_scale(1.0 / l, d, state->direction);
    double x[3] = {t, l, se3di_dot(state->direction, ddot)};
    double jet[3] = {0.0, 0.0, 0.0};
    if (force->function[0] >= 0) {
        SE3DI_TRY(se3di_function_eval(&model->functions[force->function[0]], x, jet, NULL));
    }
    state->rate = x[2];
    state->value = force->k * (l - force->rest) + force->c * x[2] + jet[0];
    state->potential = 0.5 * force->k * (l - force->rest) * (l - force->rest);
    se3di_scale(state->value, state->direction, state->pull);
    return SE3D_OK;
}

se3d_status se3di_tsda_add(const se3di_model *model, const se3di_force *force, double t,
                           double *wrench)
{
    se3di_spring_state state;
    SE3DI_TRY(se3di_tsda_state(model, force, t, &state));
    double push[3];
    se3di_scale(-1.0, state.pull, push);
    se3di_wrench_add_at(&model->frames[force->body_i], force->s_i, state.pull,
                        wrench + 6 * force->body_i);
    se3di_wrench_add_at(&model->frames[force->body_j], force->s_j, push,
                        wrench + 6 * force->body_j);
    return SE3D_OK;
}
