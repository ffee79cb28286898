/* SPDX-License-Identifier: BSD-3-Clause */
/* RSDA: rotational spring-damper-actuator on the angle of a joint, about its axis b_i of body i,
 *
 *     n = k (theta - theta0) + c thetadot + h(t, theta, thetadot)      torque on j: -n b_i, on i:
 * +n b_i
 *
 * theta counts turns; thetadot is the relative angular velocity along the axis.
 * docs/theory/springs.md */
#include "force/force.h"
#include "math/vec3.h"
#include "primitive/primitive.h"
#include "primitive/turn_counter.h"

/* The rate belongs to the angle exactly, also where the axes of the two bodies differ. */
static double angle_rate(const se3di_term *term, const se3di_frame *i, const se3di_frame *j)
{
    double phi_i[6];
    double phi_j[6];
    se3di_primitives[SE3DI_PRIMITIVE_ANGLE].jacobian_romega(term, i, j, phi_i, phi_j);
    return se3di_dot(phi_i + 3, i->w) + se3di_dot(phi_j + 3, j->w);
}

se3d_status se3di_rsda_state(const se3di_model *model, const se3di_force *force, double t,
                             se3di_spring_state *state)
{
    const se3di_term *term = &model->angles[force->angle].term;
    const se3di_frame *i = &model->frames[force->body_i];
    const se3di_frame *j = &model->frames[force->body_j];
    double theta = se3di_angle_value(model, (uint32_t)force->angle);
    double x[3] = {t, theta, angle_rate(term, i, j)};
    double jet[3] = {0.0, 0.0, 0.0};
    if (force->function[0] >= 0) {
        SE3DI_TRY(se3di_function_eval(&model->functions[force->function[0]], x, jet, NULL));
    }
    double stretch = theta - force->rest;
    *state = (se3di_spring_state){.coordinate = theta, .rate = x[2]};
    state->value = force->k * stretch + force->c * x[2] + jet[0];
    state->potential = 0.5 * force->k * stretch * stretch;
    se3di_mul(i->A, term->b_i, state->direction);
    return SE3D_OK;
}

/* The generalised force of the angle: -n d theta/d q. With parallel axes it is the torque -n b on
 * j, +n b on i; off parallel it is the one that does the work -n dtheta. */
se3d_status se3di_rsda_add(const se3di_model *model, const se3di_force *force, double t,
                           double *wrench)
{
    se3di_spring_state state;
    SE3DI_TRY(se3di_rsda_state(model, force, t, &state));
    double phi_i[6];
    double phi_j[6];
    se3di_primitives[SE3DI_PRIMITIVE_ANGLE].jacobian_romega(
        &model->angles[force->angle].term, &model->frames[force->body_i],
        &model->frames[force->body_j], phi_i, phi_j);
    se3di_add_scaled(-state.value, phi_i + 3, wrench + 6 * force->body_i + 3);
    se3di_add_scaled(-state.value, phi_j + 3, wrench + 6 * force->body_j + 3);
    return SE3D_OK;
}
