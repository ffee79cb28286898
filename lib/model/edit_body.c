/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding and removing bodies and markers. */
#include "model/edit.h"
#include "model/state.h"

#include <stddef.h>
#include <string.h>

static void replace_body(se3di_model *model, uint32_t index, const se3di_body *body,
                         const se3di_frame *frame)
{
    se3di_body *old = &model->bodies[index];
    char *name = old->name;
    const uint32_t users = old->users;
    *old = *body;
    old->name = name;
    old->users = users;
    model->frames[index] = *frame;
    memset(model->acceleration + 6 * (size_t)index, 0, 6 * sizeof *model->acceleration);
    se3di_model_touch(model);
}

se3d_status se3di_model_add_body(se3di_model *model, const se3di_body *body,
                                 const se3di_frame *frame, se3di_handle *handle)
{
    size_t count = model->body_slots.count;
    char *name;
    const uint32_t old = se3di_model_find_replaced(model, &model->body_slots, 0, body->name);
    if (old != SE3DI_NO_INDEX) {
        replace_body(model, old, body, frame);
        *handle = se3di_slots_handle(&model->body_slots, old);
        return SE3D_OK;
    }
    SE3DI_RESERVE(model, bodies, body_capacity, count + 1, sizeof *model->bodies);
    SE3DI_RESERVE(model, frames, frame_capacity, count + 1, sizeof *model->frames);
    SE3DI_RESERVE(model, acceleration, acceleration_capacity, count + 1,
                  6 * sizeof *model->acceleration);
    SE3DI_TRY(se3di_slots_reserve(&model->body_slots, &model->allocator));
    SE3DI_TRY(se3di_model_copy_name(model, &model->body_slots, body->name, &name));
    model->bodies[count] = *body;
    model->bodies[count].name = name;
    model->bodies[count].users = 0;
    model->frames[count] = *frame;
    memset(model->acceleration + 6 * count, 0, 6 * sizeof *model->acceleration);
    *handle = se3di_model_add_named(&model->body_slots, 0, name);
    se3di_model_touch(model);
    return SE3D_OK;
}

void se3di_model_remove_body(se3di_model *model, uint32_t body)
{
    size_t count = model->body_slots.count;
    char *name = model->bodies[body].name;
    se3di_array_close_gap(model->bodies, count, body, 1, sizeof *model->bodies);
    se3di_array_close_gap(model->frames, count, body, 1, sizeof *model->frames);
    se3di_array_close_gap(model->acceleration, count, body, 1, 6 * sizeof *model->acceleration);
    se3di_model_remove_named(model, &model->body_slots, body, 0, name);
    for (size_t k = 0; k < model->marker_slots.count; ++k) {
        se3di_index_lower(&model->markers[k].body, body);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        for (uint32_t b = 0; b < model->constraints[k].body_count; ++b) {
            se3di_index_lower(&model->constraints[k].bodies[b], body);
        }
    }
    for (size_t k = 0; k < model->term_count; ++k) {
        se3di_index_lower(&model->terms[k].body_i, body);
        se3di_index_lower(&model->terms[k].body_j, body);
    }
    for (size_t k = 0; k < model->angle_count; ++k) {
        se3di_index_lower(&model->angles[k].term.body_i, body);
        se3di_index_lower(&model->angles[k].term.body_j, body);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_index_lower(&model->forces[k].body_i, body);
        se3di_index_lower(&model->forces[k].body_j, body);
        for (int c = 0; c < 2 && model->forces[k].tyre; ++c) {
            se3di_index_lower(&model->forces[k].tyre->carrier[c], body);
        }
    }
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        se3di_index_lower(&model->shapes[k].body, body);
    }
    se3di_model_lower_signals(model, offsetof(se3di_signal, body), body);
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        se3di_index_lower(&model->wheels[k].body, body);
        se3di_index_lower(&model->wheels[k].chassis, body);
    }
    for (size_t k = 0; k < model->road_slots.count; ++k) {
        se3di_index_lower(&model->roads[k].body, body);
    }
    se3di_model_touch(model);
}

uint32_t se3di_model_nth_body(const se3di_model *model, size_t index)
{
    size_t passed = 0;
    for (uint32_t k = 0; k < model->body_slots.count; ++k) {
        if (model->bodies[k].state == 0 && passed++ == index) {
            return k;
        }
    }
    return SE3DI_NO_INDEX;
}

se3d_status se3di_model_add_marker(se3di_model *model, const se3di_marker *marker,
                                   se3di_handle *handle)
{
    size_t count = model->marker_slots.count;
    char *name;
    const uint32_t owner = se3di_model_owner(model, marker->body);
    const uint32_t old =
        se3di_model_find_replaced(model, &model->marker_slots, owner, marker->name);
    if (old != SE3DI_NO_INDEX && model->markers[old].body != marker->body) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    if (old != SE3DI_NO_INDEX) {
        memcpy(model->markers[old].s, marker->s, sizeof marker->s);
        memcpy(model->markers[old].p, marker->p, sizeof marker->p);
        *handle = se3di_slots_handle(&model->marker_slots, old);
        return SE3D_OK;
    }
    SE3DI_RESERVE(model, markers, marker_capacity, count + 1, sizeof *model->markers);
    SE3DI_TRY(se3di_slots_reserve(&model->marker_slots, &model->allocator));
    SE3DI_TRY(se3di_model_copy_name(model, &model->marker_slots, marker->name, &name));
    model->markers[count] = *marker;
    model->markers[count].name = name;
    model->markers[count].users = 0;
    ++model->bodies[marker->body].users;
    *handle = se3di_model_add_named(&model->marker_slots, owner, name);
    return SE3D_OK;
}

void se3di_model_remove_marker(se3di_model *model, uint32_t marker)
{
    --model->bodies[model->markers[marker].body].users;
    char *name = model->markers[marker].name;
    const uint32_t owner = se3di_model_owner(model, model->markers[marker].body);
    se3di_array_close_gap(model->markers, model->marker_slots.count, marker, 1,
                          sizeof *model->markers);
    se3di_model_remove_named(model, &model->marker_slots, marker, owner, name);
}
