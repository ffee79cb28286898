/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/friction_start.h"

#include "force/measure.h"

#include <math.h>

#define SWEEPS         30
#define ROUNDS_MAX     200
#define LOAD_TOLERANCE 1e-13

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

/* Find what those that rest hold with, of which `fresh` elements do not know it. */
static se3d_status find_holds(se3di_equations *equations, uint32_t fresh)
{
    se3di_model *model = equations->assembly.model;
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

se3d_status se3di_friction_start(se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    uint32_t fresh = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        fresh += (uint32_t)is_fresh(&model->forces[k]);
    }
    return find_holds(equations, fresh);
}

se3d_status se3di_friction_renew(se3di_equations *equations)
{
    const se3di_model *model = equations->assembly.model;
    uint32_t count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        count += model->forces[k].type == SE3DI_FORCE_FRICTION;
    }
    return count > 0 ? find_holds(equations, count) : SE3D_OK;
}

/* Count the elements; some follow a load. */
static int takes_load(const se3di_model *model, uint32_t *count)
{
    int has_load = 0;
    *count = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_FRICTION) {
            ++*count;
            has_load |= model->forces[k].mu_static > 0.0;
        }
    }
    return has_load;
}

/* Slip as the coordinate moves, under the load of the present multipliers; returns the largest
 * relative change of a load. Nothing is held: a motion alone does not say with which force. */
static double follow_motion(se3di_model *model)
{
    double change = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_force *force = &model->forces[k];
        if (force->type != SE3DI_FORCE_FRICTION) {
            continue;
        }
        se3di_measure measure;
        const double before = force->state[1];
        (void)se3di_measure_force(model, force, 0, &measure);
        se3di_friction_take_load(model, force);
        const double load = force->state[1];
        const int slips = fabs(measure.rate) > SE3DI_FRICTION_REST;
        const double mode = slips ? copysign(1.0, measure.rate) : 0.0;
        se3di_friction_set(model, force, mode, mode * se3di_friction_limit(force, 1));
        force->state[3] = slips ? 1.0 : 0.0;
        if (slips && !(fabs(load - before) <= change * load)) {
            change = load > 0.0 ? fabs(load - before) / load : 1.0;
        }
    }
    return change;
}

se3d_status se3di_friction_follow(se3di_equations *equations, double t)
{
    se3di_model *model = equations->assembly.model;
    uint32_t count;
    const int has_load = takes_load(model, &count);
    if (count == 0) {
        return SE3D_OK;
    }
    (void)follow_motion(model);
    for (int round = 0; round < ROUNDS_MAX; ++round) {
        SE3DI_TRY(se3di_acceleration_solve(equations, t));
        if (!has_load || follow_motion(model) <= LOAD_TOLERANCE) {
            return SE3D_OK;
        }
    }
    return se3di_error_set(equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: friction jams: it and the reaction that it follows from "
                           "raise each other without end",
                           t);
}
