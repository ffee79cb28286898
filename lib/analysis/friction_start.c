/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/friction_start.h"

#include "force/measure.h"
#include "joint/rows.h"
#include "primitive/primitive.h"

#include <math.h>

#define SWEEPS 30

static int is_fresh(const se3di_force *force)
{
    return force->type == SE3DI_FORCE_FRICTION && !(force->state[3] > 0.0);
}

/* Second derivative of the coordinate at the present accelerations. */
static double coordinate_acceleration(const se3di_model *model, const se3di_force *force)
{
    se3di_term term;
    se3di_measure measure;
    if (force->coordinate == SE3D_COORDINATE_ANGLE) {
        term = model->angles[force->angle].term;
    } else {
        const se3di_constraint *joint = &model->constraints[force->joint];
        se3di_displacement_term_init(&term, &joint->frames, joint->bodies);
    }
    (void)se3di_measure_force(model, force, 0, &measure);
    double sum = -se3di_primitives[term.type].gamma_romega(&term, &model->frames[term.body_i],
                                                           &model->frames[term.body_j]);
    for (int k = 0; k < 6; ++k) {
        sum += measure.g[k] * model->acceleration[6 * term.body_i + (uint32_t)k];
        sum += measure.g[6 + k] * model->acceleration[6 * term.body_j + (uint32_t)k];
    }
    return sum;
}

/* Let the element hold with force n against its coordinate and solve for the accelerations. */
static se3d_status hold(se3di_equations *equations, se3di_force *force, double n)
{
    se3di_model *model = equations->assembly.model;
    se3di_measure measure;
    double stiffness = se3di_friction_stiffness(force);
    (void)se3di_measure_force(model, force, 0, &measure);
    force->state[0] = measure.value - (stiffness > 0.0 ? n / stiffness : 0.0);
    SE3DI_TRY(se3di_acceleration_solve(equations, model->time));
    return SE3D_OK;
}

/* One element, the others as they are: the coordinate's acceleration is linear in n. */
static se3d_status balance(se3di_equations *equations, se3di_force *force, double *change)
{
    se3di_model *model = equations->assembly.model;
    se3di_measure measure;
    double limit = se3di_friction_stiffness(force) * force->presliding;
    (void)se3di_measure_force(model, force, 0, &measure);
    double n = se3di_friction_stiffness(force) * (measure.value - force->state[0]);
    if (!(limit > 0.0)) {
        return SE3D_OK;
    }
    SE3DI_TRY(hold(equations, force, n));
    double before = coordinate_acceleration(model, force);
    double trial = n > 0.0 ? n - limit : n + limit;
    SE3DI_TRY(hold(equations, force, trial));
    double slope = (coordinate_acceleration(model, force) - before) / (trial - n);
    double wanted = fabs(slope) > 0.0 ? n - before / slope : n;
    force->state[2] = fabs(wanted) > limit ? (wanted > 0.0 ? 1.0 : -1.0) : 0.0;
    wanted = fmin(fmax(wanted, -limit), limit);
    *change = fmax(*change, fabs(wanted - n) / limit);
    SE3DI_TRY(hold(equations, force, wanted));
    return SE3D_OK;
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
