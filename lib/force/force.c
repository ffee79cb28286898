/* SPDX-License-Identifier: BSD-3-Clause */
/* All force elements of a model together, and gravity. */
#include "force/force.h"

#include "force/friction.h"
#include "math/vec3.h"
#include "model/state.h"

#include <stddef.h>
#include <string.h>

static const se3di_force_class *const classes[SE3DI_FORCE_COUNT] = {
#define ROW(TYPE, name) [SE3DI_FORCE_##TYPE] = &se3di_force_class_##name,
    SE3DI_FORCE_LIST(ROW)
#undef ROW
};

const se3di_force_class *se3di_force_class_of(const se3di_force *force)
{
    return classes[force->type];
}

se3d_status se3di_force_eval(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect)
{
    size_t size = effect->wants_derivative ? sizeof *effect : offsetof(se3di_effect, K);
    int32_t wants = effect->wants_derivative;
    memset(effect, 0, size);
    effect->wants_derivative = wants;
    return classes[force->type]->eval(model, force, t, effect);
}

se3d_status se3di_forces_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed)
{
    double g[3];
    se3di_effect effect;
    effect.wants_derivative = 0;
    memset(wrench, 0, 6 * model->body_slots.count * sizeof *wrench);
    *failed = (uint32_t)model->force_slots.count;
    SE3DI_TRY(se3di_gravity_eval(model, t, g, NULL));
    for (size_t b = 0; b < model->body_slots.count; ++b) {
        if (model->bodies[b].state == 0) {
            se3di_add_scaled(model->bodies[b].mass, g, wrench + 6 * b);
        }
    }
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        *failed = k;
        SE3DI_TRY(se3di_force_eval(model, force, t, &effect));
        for (int c = 0; c < 6; ++c) {
            wrench[6 * force->body_i + (uint32_t)c] += effect.wrench[c];
            wrench[6 * force->body_j + (uint32_t)c] += effect.wrench[6 + c];
        }
    }
    return SE3D_OK;
}

int se3di_forces_have_memory(const se3di_model *model)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (classes[model->forces[k].type]->accept) {
            return 1;
        }
    }
    return 0;
}

uint32_t se3di_forces_revise(se3di_model *model)
{
    uint32_t changes = 0;
    se3di_frictions_take_loads(model, model->lambda);
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force_class *type = classes[model->forces[k].type];
        changes += type->revise ? type->revise(model, &model->forces[k]) : 0;
    }
    return changes;
}

void se3di_stops_accept(se3di_model *model)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type == SE3DI_FORCE_STOP) {
            classes[SE3DI_FORCE_STOP]->accept(model, &model->forces[k]);
        }
    }
}

void se3di_forces_accept(se3di_model *model)
{
    se3di_frictions_take_loads(model, model->lambda);
    model->shows_before = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force_class *type = classes[model->forces[k].type];
        double *state = model->forces[k].state;
        memcpy(state + SE3DI_FORCE_BEFORE, state, SE3DI_FORCE_BEFORE * sizeof *state);
        if (type->accept) {
            type->accept(model, &model->forces[k]);
        }
        if (model->forces[k].type == SE3DI_FORCE_STATE) {
            state[0] = se3di_state_size(model, model->forces[k].body_j);
        }
    }
}

void se3di_forces_show(se3di_model *model, int is_before_end)
{
    if (model->shows_before == is_before_end) {
        return;
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        double *state = model->forces[k].state, now[SE3DI_FORCE_BEFORE];
        memcpy(now, state, sizeof now);
        memcpy(state, state + SE3DI_FORCE_BEFORE, sizeof now);
        memcpy(state + SE3DI_FORCE_BEFORE, now, sizeof now);
    }
    model->shows_before = is_before_end;
}

void se3di_forces_stay(se3di_model *model)
{
    for (size_t k = 0; model->shows_before && k < model->force_slots.count; ++k) {
        double *state = model->forces[k].state;
        memcpy(state + SE3DI_FORCE_BEFORE, state, SE3DI_FORCE_BEFORE * sizeof *state);
    }
    model->shows_before = 0;
}
