/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/friction_start.h"

#include "force/friction.h"
#include "force/measure.h"

#include <math.h>

/* Take up elements that nothing was remembered of. @return how many */
static uint32_t take_up(se3di_equations *equations)
{
    se3di_model *model = equations->assembly.model;
    se3di_friction_system *system = &equations->friction;
    uint32_t fresh = 0;
    for (uint32_t k = 0; k < system->count; ++k) {
        se3di_force *force = &model->forces[system->element[k]];
        if (!(force->state[SE3DI_FRICTION_SET] > 0.0)) {
            se3di_friction_begin(model, force);
            system->rests[k] = se3di_friction_sticks(force);
            ++fresh;
        }
    }
    return fresh;
}

/* Decide what those that rest do, if there are any. */
static se3d_status find_holds(se3di_equations *equations, uint32_t count)
{
    se3di_model *model = equations->assembly.model;
    if (count > 0) {
        SE3DI_TRY(se3di_friction_system_decide(equations, model->time));
        SE3DI_TRY(se3di_acceleration_solve(equations, model->time));
    }
    se3di_forces_accept(model);
    return SE3D_OK;
}

se3d_status se3di_friction_start(se3di_equations *equations)
{
    return find_holds(equations, take_up(equations));
}

se3d_status se3di_friction_renew(se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    se3di_friction_system *system = &equations->friction;
    (void)take_up(equations);
    for (uint32_t k = 0; k < system->count; ++k) {
        system->rests[k] |= se3di_friction_sticks(&model->forces[system->element[k]]);
    }
    return system->count > 0 ? find_holds(equations, system->count) : SE3D_OK;
}

se3d_status se3di_friction_pass(se3di_equations *equations)
{
    se3di_model *model = equations->assembly.model;
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        se3di_force *force = &model->forces[equations->friction.element[k]];
        se3di_measure measure;
        (void)se3di_measure_force(model, force, 0, &measure);
        const double mode = force->state[SE3DI_FRICTION_MODE];
        const int goes_on = se3di_friction_sticks(force)
                                ? fabs(measure.rate) <= SE3DI_FRICTION_REST
                                : mode * measure.rate > SE3DI_FRICTION_REST;
        force->state[SE3DI_FRICTION_SET] = goes_on ? force->state[SE3DI_FRICTION_SET] : 0.0;
    }
    return se3di_friction_renew(equations);
}

/* Slip as the coordinate moves. Nothing is held: a motion alone does not say with which force. */
static void follow_motion(se3di_equations *equations)
{
    se3di_model *model = equations->assembly.model;
    for (uint32_t k = 0; k < equations->friction.count; ++k) {
        se3di_force *force = &model->forces[equations->friction.element[k]];
        se3di_measure measure;
        (void)se3di_measure_force(model, force, 0, &measure);
        const int slips = fabs(measure.rate) > SE3DI_FRICTION_REST;
        se3di_friction_set(model, force, slips ? copysign(1.0, measure.rate) : 0.0, 0.0);
        force->state[SE3DI_FRICTION_SET] = slips ? 1.0 : 0.0;
    }
}

se3d_status se3di_friction_follow(se3di_equations *equations, double t)
{
    if (equations->friction.count == 0) {
        return SE3D_OK;
    }
    follow_motion(equations);
    return se3di_acceleration_solve(equations, t);
}
