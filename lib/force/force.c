/* SPDX-License-Identifier: BSD-3-Clause */
/* All force elements of a model together, and gravity. */
#include "force/force.h"

#include "force/friction.h"
#include "force/tyre.h"
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

se3d_status se3di_force_eval_with(const se3di_model *model, const se3di_force *force, double t,
                                  se3di_law_notes *notes, se3di_effect *effect)
{
    size_t size = effect->wants_derivative ? sizeof *effect : offsetof(se3di_effect, K);
    int32_t wants = effect->wants_derivative;
    memset(effect, 0, size);
    effect->wants_derivative = wants;
    effect->notes = notes;
    return force->released ? SE3D_OK : classes[force->type]->eval(model, force, t, effect);
}

se3d_status se3di_force_eval(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect)
{
    return se3di_force_eval_with(model, force, t, NULL, effect);
}

se3d_status se3di_force_fail(const se3di_model *model, uint32_t failed, se3d_status status,
                             double t, se3di_error *error)
{
    const int is_gravity = failed >= model->force_slots.count;
    const char *name = is_gravity ? "gravity" : model->forces[failed].name;
    return se3di_error_set(
        error, status, "t = %g s: force element %s (%s): %s", t, name ? name : "without a name",
        is_gravity ? "gravity" : se3di_force_class_of(&model->forces[failed])->name,
        status == SE3D_ERR_SINGULAR ? "its two points coincide, it has no direction"
                                    : "its function is not finite or failed");
}

se3d_status se3di_force_potential(const se3di_model *model, const se3di_force *force, double t,
                                  double *potential)
{
    const se3di_force_class *type = classes[force->type];
    se3d_status status = SE3DI_FORCE_LEFT;
    if (type->find_potential && !force->released) {
        status = type->find_potential(model, force, t, potential);
    }
    if (status != SE3DI_FORCE_LEFT) {
        return status;
    }
    se3di_effect effect;
    effect.wants_derivative = 0;
    status = se3di_force_eval(model, force, t, &effect);
    *potential = effect.potential;
    return status;
}

int se3di_force_is_number(const se3di_force *force)
{
    return force->type == SE3DI_FORCE_EFFORT && force->function[0] < 0;
}

/* Wrenches begin with it. */
static se3d_status sum_gravity(const se3di_model *model, double t, se3di_force_sums *sums)
{
    double g[3], g_t[3];
    const int changes = model->gravity_function[0] >= 0 || model->gravity_function[1] >= 0 ||
                        model->gravity_function[2] >= 0;
    SE3DI_TRY(se3di_gravity_eval(model, t, g, g_t));
    for (size_t b = 0; b < model->body_slots.count; ++b) {
        const se3di_body *body = &model->bodies[b];
        double *wrench = sums->wrench + 6 * b;
        memset(wrench, 0, 6 * sizeof *wrench);
        if (body->state == 0) {
            se3di_add_scaled(body->mass, g, wrench);
        }
        if (changes && !body->fixed && body->state == 0) {
            sums->power[1] -= body->mass * se3di_dot(g_t, model->frames[b].r);
        }
    }
    return SE3D_OK;
}

/* A slip that lags, whose rate comes with the tyre. */
static int is_told_by_tyre(const se3di_model *model, const se3di_force *force)
{
    return force->type == SE3DI_FORCE_STATE && force->tyre_index >= 0 && !force->released &&
           !model->forces[force->tyre_index].released;
}

static void add_wrench(const se3di_force *force, const double wrench[12], const double power[2],
                       se3di_force_sums *sums)
{
    for (int c = 0; c < 6; ++c) {
        sums->wrench[6 * force->body_i + (uint32_t)c] += wrench[c];
        sums->wrench[6 * force->body_j + (uint32_t)c] += wrench[6 + c];
    }
    sums->power[0] += power[0];
    sums->power[1] += power[1];
}

/* `loads`: of the tyres that were computed last. */
static se3d_status sum_tyre(const se3di_model *model, uint32_t k, double t, se3di_tyre_loads *loads,
                            se3di_force_sums *sums)
{
    const se3di_force *force = &model->forces[k];
    int at = 0;
    while (at < loads->count && loads->index[at] != k) {
        ++at;
    }
    if (at == loads->count) {
        se3di_tyre_eval_alike(model, k, t, loads);
        at = 0;
    }
    const se3di_tyre_load *load = &loads->of[at];
    SE3DI_TRY(load->status);
    for (int d = 0; d < 2; ++d) {
        const size_t carrier = force->tyre->lags[d] ? force->tyre->carrier[d] : 0;
        sums->wrench[6 * carrier] += SE3DI_CARRIER_MASS * load->rate[d];
    }
    add_wrench(force, load->wrench, load->power, sums);
    return SE3D_OK;
}

/* What elements at one state share. */
typedef struct shared {
    se3di_tyre_loads loads;
    se3di_law_notes notes;
} shared;

static se3d_status sum_element(const se3di_model *model, uint32_t k, double t, shared *common,
                               se3di_force_sums *sums)
{
    const se3di_force *force = &model->forces[k];
    const int32_t along = sums->along ? sums->along[k] : -1;
    if (along >= 0 && se3di_force_is_number(force)) {
        sums->effort[along] += sums->has_efforts ? 0.0 : force->value[0];
        return SE3D_OK;
    }
    if (is_told_by_tyre(model, force) || se3di_force_is_apart(model, force)) {
        return SE3D_OK;
    }
    if (force->type == SE3DI_FORCE_TYRE && !force->released) {
        return sum_tyre(model, k, t, &common->loads, sums);
    }
    se3di_effect effect;
    effect.wants_derivative = 0;
    SE3DI_TRY(se3di_force_eval_with(model, force, t, &common->notes, &effect));
    add_wrench(force, effect.wrench, effect.power, sums);
    return SE3D_OK;
}

se3d_status se3di_forces_sum(const se3di_model *model, double t, se3di_force_sums *sums)
{
    shared common;
    common.loads.count = common.notes.count = 0;
    sums->power[0] = sums->power[1] = 0.0;
    sums->failed = (uint32_t)model->force_slots.count;
    SE3DI_TRY(sum_gravity(model, t, sums));
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        sums->failed = k;
        SE3DI_TRY(sum_element(model, k, t, &common, sums));
    }
    return SE3D_OK;
}

se3d_status se3di_forces_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed)
{
    se3di_force_sums sums = {.wrench = wrench};
    const se3d_status status = se3di_forces_sum(model, t, &sums);
    *failed = sums.failed;
    return status;
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
