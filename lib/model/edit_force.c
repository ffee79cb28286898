/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding and removing force elements, states with their carriers, and tyres. */
#include "model/edit.h"
#include "model/state.h"

#include <stddef.h>
#include <string.h>

static void count_force_users(se3di_model *model, const se3di_force *force, uint32_t by)
{
    model->bodies[force->body_i].users += by;
    model->bodies[force->body_j].users += by;
    if (force->joint >= 0) {
        model->constraints[force->joint].users += by;
    }
    for (int c = 0; c < SE3DI_FORCE_FUNCTIONS; ++c) {
        if (force->function[c] >= 0) {
            model->functions[force->function[c]].users += by;
        }
    }
    if (force->tyre && force->tyre->surface >= 0) {
        model->roads[force->tyre->surface].users += by;
    }
}

se3d_status se3di_force_own(const se3d_allocator *allocator, se3di_force *force)
{
    const se3di_tyre *original = force->tyre;
    force->tyre = NULL;
    if (original) {
        force->tyre = se3di_alloc(allocator, 1, sizeof *original);
        if (!force->tyre) {
            return SE3D_ERR_NO_MEMORY;
        }
        *force->tyre = *original;
    }
    return SE3D_OK;
}

void se3di_force_release(const se3d_allocator *allocator, se3di_force *force)
{
    if (force->tyre) {
        se3di_free(allocator, force->tyre, 1, sizeof *force->tyre);
    }
    force->tyre = NULL;
}

/* Tyres with the same coefficients are of one kind. */
static void take_kind(const se3di_model *model, se3di_tyre *tyre)
{
    tyre->kind = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_tyre *other = model->forces[k].tyre;
        if (other &&
            memcmp(other->coefficients, tyre->coefficients, sizeof other->coefficients) == 0) {
            tyre->kind = other->kind;
            return;
        }
        if (other && other->kind >= tyre->kind) {
            tyre->kind = other->kind + 1;
        }
    }
}

/* Of a tyre the states of its slips stay. */
static int has_same_lags(const se3di_tyre *a, const se3di_tyre *b)
{
    return (a != NULL) == (b != NULL) &&
           (!a || (a->lags[0] == b->lags[0] && a->lags[1] == b->lags[1]));
}

static se3d_status replace_force(se3di_model *model, uint32_t index, const se3di_force *force)
{
    se3di_force *old = &model->forces[index];
    se3di_force own = *force;
    if (old->type != force->type || old->type == SE3DI_FORCE_STATE ||
        old->owns_angle != force->owns_angle || !has_same_lags(old->tyre, force->tyre)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const int moves = old->body_i != own.body_i || old->body_j != own.body_j;
    if (model->target > 0 && moves &&
        se3di_model_is_signalled(model, offsetof(se3di_signal, force), index)) {
        return SE3D_ERR_IN_USE;
    }
    SE3DI_TRY(se3di_force_own(&model->allocator, &own));
    if (own.tyre) {
        memcpy(own.tyre->carrier, old->tyre->carrier, sizeof own.tyre->carrier);
        take_kind(model, own.tyre);
    }
    own.name = old->name;
    own.users = old->users;
    count_force_users(model, old, UINT32_MAX);
    se3di_force_release(&model->allocator, old);
    *old = own;
    count_force_users(model, old, 1);
    se3di_model_touch(model);
    return SE3D_OK;
}

se3d_status se3di_model_add_force(se3di_model *model, const se3di_force *force,
                                  se3di_handle *handle)
{
    size_t count = model->force_slots.count;
    se3di_force own = *force;
    const uint32_t old = se3di_model_find_replaced(model, &model->force_slots, 0, force->name);
    if (old != SE3DI_NO_INDEX) {
        *handle = se3di_slots_handle(&model->force_slots, old);
        return replace_force(model, old, force);
    }
    SE3DI_RESERVE(model, forces, force_capacity, count + 1, sizeof *model->forces);
    SE3DI_TRY(se3di_slots_reserve(&model->force_slots, &model->allocator));
    SE3DI_TRY(se3di_force_own(&model->allocator, &own));
    char *name;
    if (se3di_model_copy_name(model, &model->force_slots, force->name, &name) < 0) {
        se3di_force_release(&model->allocator, &own);
        return SE3D_ERR_NO_MEMORY;
    }
    if (own.tyre) {
        take_kind(model, own.tyre);
    }
    model->forces[count] = own;
    model->forces[count].name = name;
    model->forces[count].users = 0;
    count_force_users(model, force, 1);
    *handle = se3di_model_add_named(&model->force_slots, 0, name);
    se3di_model_touch(model);
    return SE3D_OK;
}

se3d_status se3di_model_add_force_with_angle(se3di_model *model, const se3di_force *force,
                                             const se3di_angle *angle, se3di_handle *handle)
{
    se3di_force owner = *force;
    const uint32_t old = se3di_model_find_replaced(model, &model->force_slots, 0, force->name);
    const int is_new = old == SE3DI_NO_INDEX;
    SE3DI_RESERVE(model, angles, angle_capacity, model->angle_count + 1, sizeof *model->angles);
    owner.angle = is_new ? (int32_t)model->angle_count : model->forces[old].angle;
    owner.owns_angle = 1;
    SE3DI_TRY(se3di_model_add_force(model, &owner, handle));
    model->angles[owner.angle] = *angle;
    model->angle_count += is_new ? 1 : 0;
    return SE3D_OK;
}

void se3di_model_remove_force(se3di_model *model, uint32_t force)
{
    int32_t own = model->forces[force].owns_angle ? model->forces[force].angle : -1;
    count_force_users(model, &model->forces[force], UINT32_MAX);
    char *name = model->forces[force].name;
    se3di_force_release(&model->allocator, &model->forces[force]);
    se3di_array_close_gap(model->forces, model->force_slots.count, force, 1, sizeof *model->forces);
    se3di_model_remove_named(model, &model->force_slots, force, 0, name);
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        model->bodies[k].state -= model->bodies[k].state > (int32_t)force + 1;
    }
    se3di_model_lower_signals(model, offsetof(se3di_signal, force), force);
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_index_lower_signed(&model->forces[k].tyre_index, force);
    }
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        se3di_index_lower_signed(&model->wheels[k].spring, force);
    }
    if (own >= 0) {
        se3di_model_remove_angle(model, (uint32_t)own);
    }
    se3di_model_touch(model);
}

uint32_t se3di_model_nth_force(const se3di_model *model, size_t index)
{
    size_t passed = 0;
    for (uint32_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].type != SE3DI_FORCE_STATE && passed++ == index) {
            return k;
        }
    }
    return SE3DI_NO_INDEX;
}

void se3di_model_set_state_function(se3di_model *model, uint32_t force, int place, int32_t function)
{
    count_force_users(model, &model->forces[force], UINT32_MAX);
    model->forces[force].function[place] = function;
    count_force_users(model, &model->forces[force], 1);
    se3di_model_touch(model);
}

se3d_status se3di_model_add_state(se3di_model *model, const se3di_force *state, double z,
                                  se3di_handle *handle)
{
    const double m = SE3DI_CARRIER_MASS;
    const se3di_body body = {.mass = m,
                             .J = {m, m, m, 0.0, 0.0, 0.0},
                             .held = 1,
                             .state = (int32_t)model->force_slots.count + 1};
    se3di_frame frame = {.p = {1.0, 0.0, 0.0, 0.0}, .v = {z, 0.0, 0.0}};
    se3di_force data = *state;
    se3di_handle carrier;
    if (se3di_model_find_replaced(model, &model->force_slots, 0, state->name) != SE3DI_NO_INDEX) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_frame_update(&frame);
    SE3DI_TRY(se3di_model_add_body(model, &body, &frame, &carrier));
    data.body_j = (uint32_t)model->body_slots.count - 1;
    const se3d_status status = se3di_model_add_force(model, &data, handle);
    if (status < 0) {
        se3di_model_remove_body(model, data.body_j);
        return status;
    }
    ++model->state_count;
    return SE3D_OK;
}

void se3di_model_remove_state(se3di_model *model, uint32_t force)
{
    const uint32_t body = model->forces[force].body_j;
    --model->state_count;
    se3di_model_remove_force(model, force);
    se3di_model_remove_body(model, body);
}

/* The states of the slips of a tyre that lag, from the last one on. */
static void remove_lags(se3di_model *model, uint32_t tyre)
{
    for (uint32_t k = (uint32_t)model->force_slots.count; k-- > 0;) {
        if (model->forces[k].tyre_index == (int32_t)tyre) {
            se3di_model_remove_state(model, k);
        }
    }
}

se3d_status se3di_model_add_tyre(se3di_model *model, const se3di_force *force,
                                 const se3di_force *lag, se3di_handle *handle)
{
    const size_t before = model->force_slots.count;
    SE3DI_TRY(se3di_model_add_force(model, force, handle));
    if (model->force_slots.count == before) {
        return SE3D_OK; /* replaced, its states are there */
    }
    const uint32_t tyre = (uint32_t)before;
    for (int k = 0; k < 2; ++k) {
        se3di_force state = *lag;
        se3di_handle unused;
        if (!force->tyre->lags[k]) {
            continue;
        }
        state.tyre_index = (int32_t)tyre;
        state.coordinate = k;
        if (se3di_model_add_state(model, &state, 0.0, &unused) < 0) {
            se3di_model_remove_tyre(model, tyre);
            return SE3D_ERR_NO_MEMORY;
        }
        model->forces[tyre].tyre->carrier[k] = (uint32_t)model->body_slots.count - 1;
    }
    return SE3D_OK;
}

void se3di_model_remove_tyre(se3di_model *model, uint32_t force)
{
    remove_lags(model, force);
    se3di_model_remove_force(model, force);
}
