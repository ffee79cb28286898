/* SPDX-License-Identifier: BSD-3-Clause */
/* Effort: a generalised force u along a coordinate x of a joint,
 *
 *     wrench = u g,  g = dx/dq       K = g (u_x g + u_xdot w^T H) + u H       D = u_xdot g g^T
 *     actuator power = u xdot,       w the velocities, H = dg/dq
 *
 * u is a number that is set between steps, or a function of (t, x, xdot). A number needs no
 * coordinate: no angle is measured and no turn counted, only g.  docs/theory/springs.md */
#include "force/signal.h"

#include <stddef.h>
#include <string.h>

static se3d_status eval_effort(const se3di_model *model, const se3di_force *force, double t,
                               se3di_effect *effect)
{
    se3di_measure measure;
    se3di_law law = {.n = -force->value[0]};
    if (force->function[0] < 0 && !effect->wants_derivative) {
        se3di_measure_gradient(model, force, &measure);
    } else {
        (void)se3di_measure_force(model, force, effect->wants_derivative, &measure);
    }
    if (force->function[0] >= 0) {
        const double variables[3] = {t, measure.value, measure.rate};
        double jet[3] = {0.0, 0.0, 0.0};
        double gradient[SE3D_FUNCTION_VARIABLES_MAX] = {0.0};
        SE3DI_TRY(se3di_law_eval(model, &model->functions[force->function[0]], variables,
                                 effect->notes, jet, effect->wants_derivative ? gradient : NULL));
        se3di_law_keep_own(&model->functions[force->function[0]], gradient);
        law = (se3di_law){-jet[0], -gradient[1], -gradient[2]};
    }
    se3di_effect_add(effect, &measure, &law);
    effect->value = -law.n;
    effect->power[1] = effect->value * measure.rate;
    return SE3D_OK;
}

/* None; the callback of a user may fail all the same. */
static se3d_status find_potential(const se3di_model *model, const se3di_force *force, double t,
                                  double *potential)
{
    se3di_effect effect;
    *potential = 0.0;
    if (!se3di_law_has_callback(model, force)) {
        return SE3D_OK;
    }
    memset(&effect, 0, offsetof(se3di_effect, K));
    effect.wants_derivative = 0;
    return eval_effort(model, force, t, &effect);
}

const se3di_force_class se3di_force_class_effort = {
    .name = "effort",
    .eval = eval_effort,
    .find_potential = find_potential,
    .traits = SE3DI_FORCE_IS_SCALAR,
};
