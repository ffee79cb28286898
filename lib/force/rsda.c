/* SPDX-License-Identifier: BSD-3-Clause */
/* RSDA: rotational spring-damper-actuator on an angle about the axis b_i of body i,
 *
 *     n = k (theta - theta0) + c thetadot + h(t, theta, thetadot)     torque on j: -n b, on i: +n b
 *
 * theta counts turns. The wrench is the generalised force -n d theta/d q: with parallel axes the
 * torque above, off parallel the one that does the work -n d theta.  docs/theory/springs.md */
#include "force/measure.h"

static se3d_status eval_rsda(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect)
{
    se3di_measure measure;
    se3di_law law;
    (void)se3di_measure_force(model, force, effect->wants_derivative, &measure);
    SE3DI_TRY(se3di_spring_law(model, force, t, &measure, effect, &law));
    se3di_effect_add(effect, &measure, &law);
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_rsda = {
    .name = "rsda",
    .eval = eval_rsda,
    .find_potential = se3di_spring_find_potential,
    .traits = SE3DI_FORCE_IS_SCALAR | SE3DI_FORCE_IS_ELASTIC,
};
