/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/energy.h"

#include "assembly/armature.h"
#include "contact/bodies/body_contacts.h"
#include "force/force.h"
#include "math/vec3.h"
#include "primitive/user.h"

#include <string.h>

double se3di_kinetic_energy(const se3di_model *model)
{
    double energy = 0.0;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_body *body = &model->bodies[k];
        const se3di_frame *frame = &model->frames[k];
        const double *J = body->J;
        const double *w = frame->w;
        if (!body->fixed && body->state == 0) {
            energy += 0.5 * body->mass * se3di_dot(frame->v, frame->v);
            energy += 0.5 * (J[0] * w[0] * w[0] + J[1] * w[1] * w[1] + J[2] * w[2] * w[2]);
            energy += J[3] * w[0] * w[1] + J[4] * w[1] * w[2] + J[5] * w[0] * w[2];
        }
    }
    return energy + se3di_armatures_energy(model);
}

se3d_status se3di_forces_potential(const se3di_model *model, double t, double *potential)
{
    double g[3], sum = 0.0;
    *potential = 0.0;
    SE3DI_TRY(se3di_gravity_eval(model, t, g, NULL));
    for (size_t b = 0; b < model->body_slots.count; ++b) {
        if (model->bodies[b].state == 0) {
            sum -= model->bodies[b].mass * se3di_dot(g, model->frames[b].r);
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        double own;
        SE3DI_TRY(se3di_force_potential(model, &model->forces[k], t, &own));
        sum += own;
    }
    *potential = sum;
    return SE3D_OK;
}

static se3d_status user_power(const se3di_model *model, double t, double *power)
{
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        se3di_user_values values;
        if (se3di_is_user(constraint) && !se3di_is_broken(constraint, model->rows)) {
            SE3DI_TRY(se3di_user_eval(model, constraint, t, SE3DI_USER_NU, &values));
            for (uint32_t r = 0; r < constraint->row_count; ++r) {
                *power -= model->lambda[constraint->row_begin + r] * values.nu[r];
            }
        }
    }
    return SE3D_OK;
}

/* -lambda . nu: the power of constraints that change in time. */
static se3d_status driver_power(const se3di_model *model, double t, double *power)
{
    for (size_t k = 0; k < model->row_count; ++k) {
        double jet[3];
        if (model->rows[k].function >= 0) {
            SE3DI_TRY(
                se3di_function_eval(&model->functions[model->rows[k].function], &t, jet, NULL));
            *power -= model->lambda[k] * jet[1];
        }
    }
    return user_power(model, t, power);
}

/* Of gravity and elements. */
static se3d_status eval_power(const se3di_model *model, double t, double power[3])
{
    double g[3];
    double g_t[3];
    se3di_law_notes notes = {.count = 0};
    se3di_effect effect;
    effect.wants_derivative = 0;
    power[0] = power[1] = power[2] = 0.0;
    SE3DI_TRY(se3di_gravity_eval(model, t, g, g_t));
    for (size_t b = 0; b < model->body_slots.count; ++b) {
        if (!model->bodies[b].fixed && model->bodies[b].state == 0) {
            power[1] -= model->bodies[b].mass * se3di_dot(g_t, model->frames[b].r);
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (se3di_force_is_apart(model, &model->forces[k])) {
            continue;
        }
        SE3DI_TRY(se3di_force_eval_with(model, &model->forces[k], t, &notes, &effect));
        power[0] += effect.power[0];
        power[1] += effect.power[1];
    }
    return SE3D_OK;
}

se3d_status se3di_loads_potential(const se3di_model *model, double t, double *potential,
                                  double *springs)
{
    SE3DI_TRY(se3di_forces_potential(model, t, potential));
    *springs = se3di_contacts_potential(model, t);
    *potential += *springs;
    return SE3D_OK;
}

se3d_status se3di_loads_complete_power(const se3di_model *model, double t, const double contacts[2],
                                       double power[3])
{
    power[2] = 0.0;
    SE3DI_TRY(driver_power(model, t, &power[2]));
    power[0] += contacts[0];
    power[1] += contacts[1];
    return SE3D_OK;
}

se3d_status se3di_loads_power(const se3di_model *model, double t, double power[3])
{
    double contacts[2];
    SE3DI_TRY(eval_power(model, t, power));
    se3di_contacts_power(model, t, contacts);
    return se3di_loads_complete_power(model, t, contacts, power);
}

se3d_status se3di_work_accept(se3di_model *model, double h)
{
    double power[3];
    SE3DI_TRY(se3di_loads_power(model, model->time, power));
    se3di_work_take(model, h, power);
    return SE3D_OK;
}

void se3di_work_take(se3di_model *model, double h, const double power[3])
{
    if (model->work_valid <= 0) {
        double stored;
        memset(model->work, 0, sizeof model->work);
        model->work[0] = se3di_contacts_potential(model, model->time);
        (void)se3di_callbacks_energy(model, model->time, &stored); /* whose powers were found */
        model->work[1] = 0.0 - stored;
    }
    for (int k = 0; k < 3; ++k) {
        model->work[k] += model->work_valid > 0 ? 0.5 * h * (model->power[k] + power[k]) : 0.0;
        model->power[k] = power[k];
    }
    model->work_valid = 1;
}

se3d_status se3di_work_fed(const se3di_model *model, double *fed)
{
    double stored = 0.0;
    if (se3di_has_work(model)) {
        SE3DI_TRY(se3di_callbacks_energy(model, model->time, &stored));
    }
    *fed = model->work[1] + stored;
    return SE3D_OK;
}

double se3di_work_lost(const se3di_model *model, double springs)
{
    return se3di_has_work(model) ? model->work[0] - springs : model->work[0];
}
