/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/friction_start.h"

#include "force/measure.h"

#include <math.h>

#define SWEEPS 30

static int is_fresh(const se3di_force *force)
{
    return force->type == SE3DI_FORCE_FRICTION && !(force->state[3] > 0.0);
}

/* Let the element hold with force n against its coordinate and solve for the accelerations. */
static se3d_status hold(se3di_equations *equations, se3di_force *force, double mode, double n)
{
    se3di_model *model = equations->assembly.model;
    se3di_friction_set(model, force, mode, n);
    return se3di_acceleration_solve(equations, model->time);
}

/* One element, the others as they are: the coordinate's acceleration is linear in n. */
static se3d_status balance(se3di_equations *equations, se3di_force *force, double *change)
{
    se3di_model *model = equations->assembly.model;
    const double limit = se3di_friction_limit(force, 0);
    double n = se3di_friction_get(model, force);
    if (!(limit > 0.0)) {
        return SE3D_OK;
    }
    SE3DI_TRY(hold(equations, force, 0.0, n));
    double before = se3di_measure_acceleration(model, force);
    double trial = n > 0.0 ? n - limit : n + limit;
    SE3DI_TRY(hold(equations, force, 0.0, trial));
    double slope = (se3di_measure_acceleration(model, force) - before) / (trial - n);
    double wanted = fabs(slope) > 0.0 ? n - before / slope : n;
    const double mode = fabs(wanted) > limit ? copysign(1.0, wanted) : 0.0;
    wanted = fmin(fmax(wanted, -limit), limit);
    *change = fmax(*change, fabs(wanted - n) / limit);
    return hold(equations, force, mode, wanted);
}

se3d_status se3di_friction_start(se3di_equations *equations)
{
    se3di_model *model = equations->assembly.model;
    uint32_t fresh = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        fresh += (uint32_t)is_fresh(&model->forces[k]);
    }
    se3di_forces_accept(model);
    double change = 1.0;
    for (int sweep = 0; fresh > 0 && change > 1e-12 && sweep < SWEEPS; ++sweep) {
        change = 0.0;
        for (size_t k = 0; k < model->force_slots.count; ++k) {
            se3di_force *force = &model->forces[k];
            int rests = force->type == SE3DI_FORCE_FRICTION && force->state[3] > 0.0 &&
                        !(fabs(force->state[2]) > 0.0);
            if (rests) {
                SE3DI_TRY(balance(equations, force, &change));
            }
        }
        change = fmax(change, se3di_forces_revise(model) > 0 ? 1.0 : 0.0);
    }
    if (fresh > 0) {
        SE3DI_TRY(se3di_acceleration_solve(equations, model->time));
        se3di_forces_accept(model);
    }
    return SE3D_OK;
}
