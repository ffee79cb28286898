/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction on a joint coordinate x with load N (the joint's reaction square to its axis):
 *
 *     stick   n = s (x - z) + viscous xdot         |s (x - z)| <= F_s,  s = F_s / presliding
 *     slip    n = +-F_c + viscous xdot             in the direction of the motion
 *     F_c = mu R N + limit,  F_s = mu_static R N + limit,  R = 1 (displacement) or radius (angle)
 *
 * Whether it sticks or slips, z and N do not change within a step, so that the step solves smooth
 * equations; `revise` compares them with its end and has it repeated where they differ (the return
 * mapping of elasto-plasticity). Sticking is elastic without any drift: it really sticks.
 *
 * state: [0] z, [1] N, [2] -1, 0 (stick), +1, [3] not 0: z is set.  docs/theory/friction.md */
#include "force/measure.h"
#include "math/vec3.h"
#include "primitive/primitive.h"

#include <math.h>

typedef struct friction_limits {
    double slip, stick, stiffness;
} friction_limits;

static friction_limits limits_of(const se3di_force *force)
{
    double load =
        force->state[1] * (force->coordinate == SE3D_COORDINATE_ANGLE ? force->radius : 1.0);
    friction_limits l = {.slip = force->mu * load + force->limit,
                         .stick = force->mu_static * load + force->limit};
    l.stiffness = l.stick / force->presliding;
    return l;
}

double se3di_friction_stiffness(const se3di_force *force)
{
    return limits_of(force).stiffness;
}

double se3di_friction_limit(const se3di_force *force, int slips)
{
    const friction_limits limits = limits_of(force);
    return slips ? limits.slip : limits.stick;
}

double se3di_friction_get(const se3di_model *model, const se3di_force *force)
{
    const friction_limits limits = limits_of(force);
    se3di_measure measure;
    if (fabs(force->state[2]) > 0.0) {
        return force->state[2] * limits.slip;
    }
    (void)se3di_measure_force(model, force, 0, &measure);
    return force->state[3] > 0.0 ? limits.stiffness * (measure.value - force->state[0]) : 0.0;
}

void se3di_friction_set(const se3di_model *model, se3di_force *force, double mode, double n)
{
    const friction_limits limits = limits_of(force);
    se3di_measure measure;
    (void)se3di_measure_force(model, force, 0, &measure);
    force->state[0] = measure.value - (limits.stiffness > 0.0 ? n / limits.stiffness : 0.0);
    force->state[2] = mode;
    force->state[3] = 1.0;
}

se3d_status se3di_friction_eval(const se3di_model *model, const se3di_force *force, double t,
                                se3di_effect *effect)
{
    (void)t;
    se3di_measure measure;
    friction_limits limits = limits_of(force);
    int sticks = !(fabs(force->state[2]) > 0.0);
    (void)se3di_measure_force(model, force, effect->wants_derivative, &measure);
    if (!(force->state[3] > 0.0)) { /* nothing to hold on to */
        limits.stiffness = 0.0;
    }
    double x = measure.value - force->state[0];
    se3di_law law = {.n = sticks ? limits.stiffness * x : force->state[2] * limits.slip,
                     .n_x = sticks ? limits.stiffness : 0.0,
                     .n_rate = force->viscous};
    effect->potential = sticks ? 0.5 * limits.stiffness * x * x : 0.0;
    effect->power[0] = sticks ? 0.0 : law.n * measure.rate;
    law.n += force->viscous * measure.rate;
    effect->power[0] += force->viscous * measure.rate * measure.rate;
    se3di_effect_add(effect, &measure, &law);
    return SE3D_OK;
}

/* The joint's force on body j square to the axis, from the multipliers. */
static double load_of(const se3di_model *model, const se3di_force *force)
{
    const se3di_constraint *joint = &model->constraints[force->joint];
    double F[3] = {0.0, 0.0, 0.0};
    double axis[3];
    for (uint32_t r = 0; r < joint->row_count; ++r) {
        const se3di_row *row = &model->rows[joint->row_begin + r];
        for (uint32_t k = 0; k < row->term_count; ++k) {
            const se3di_term *term = &model->terms[row->term_begin + k];
            double phi_i[6], phi_j[6];
            se3di_primitives[term->type].jacobian_romega(
                term, &model->frames[term->body_i], &model->frames[term->body_j], phi_i, phi_j);
            se3di_add_scaled(model->lambda[joint->row_begin + r] * term->coefficient, phi_j, F);
        }
    }
    se3di_mul(model->frames[joint->bodies[0]].A, joint->frames.axis_i, axis);
    se3di_add_scaled(-se3di_dot(axis, F), axis, F);
    return se3di_norm(F);
}

void se3di_friction_take_load(const se3di_model *model, se3di_force *force)
{
    force->state[1] = force->mu_static > 0.0 ? load_of(model, force) : 0.0;
}

uint32_t se3di_friction_revise(const se3di_model *model, se3di_force *force)
{
    se3di_measure measure;
    const double before = force->state[1];
    se3di_friction_take_load(model, force);
    uint32_t changes = fabs(force->state[1] - before) > 1e-9 * force->state[1];
    if (!(force->state[3] > 0.0)) {
        return changes;
    }
    friction_limits limits = limits_of(force);
    (void)se3di_measure_force(model, force, 0, &measure);
    double n = limits.stiffness * (measure.value - force->state[0]);
    double mode = force->state[2];
    double rounding = 2e-15 * limits.stiffness * fabs(measure.value) + 1e-12 * limits.slip;
    if (mode * n < limits.slip - rounding && fabs(mode) > 0.0) {
        mode = 0.0;
    } else if (!(fabs(mode) > 0.0) && fabs(n) > limits.stick) {
        mode = n > 0.0 ? 1.0 : -1.0;
    }
    changes += fabs(mode - force->state[2]) > 0.0;
    force->state[2] = mode;
    return changes;
}

void se3di_friction_accept(const se3di_model *model, se3di_force *force)
{
    se3di_measure measure;
    se3di_friction_take_load(model, force);
    friction_limits limits = limits_of(force);
    (void)se3di_measure_force(model, force, 0, &measure);
    if (!(force->state[3] > 0.0)) {
        force->state[3] = 1.0;
        force->state[0] = measure.value;
        force->state[2] =
            fabs(measure.rate) > SE3DI_FRICTION_REST ? (measure.rate > 0.0 ? 1.0 : -1.0) : 0.0;
    }
    double mode = force->state[2];
    if (fabs(mode) > 0.0) {
        double stretch = limits.stiffness > 0.0 ? limits.slip / limits.stiffness : 0.0;
        force->state[0] = measure.value - mode * stretch;
        force->state[2] = mode * measure.rate < 0.0 ? 0.0 : mode;
    } else if (fabs(limits.stiffness * (measure.value - force->state[0])) > limits.stick) {
        mode = measure.value > force->state[0] ? 1.0 : -1.0;
        force->state[2] = mode * measure.rate < 0.0 ? 0.0 : mode; /* it swings back by itself */
    }
}
