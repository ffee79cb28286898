/* SPDX-License-Identifier: BSD-3-Clause */
#include "model/saved.h"

#include <string.h>

static void copy(void *to, const void *from, size_t size)
{
    if (size > 0) {
        memcpy(to, from, size);
    }
}

static se3d_status resize(se3di_saved_array *array, const se3d_allocator *allocator, size_t count,
                          size_t size)
{
    array->count = count;
    return se3di_array_reserve(allocator, &array->data, &array->capacity, count, size);
}

static se3d_status fit(se3di_saved *saved, const se3di_model *model,
                       const se3d_allocator *allocator)
{
    const size_t bodies = model->body_slots.count;
    const size_t history = model->history_tag ? model->history_count : 0;
    const size_t one = sizeof(double);
    SE3DI_TRY(resize(&saved->frames, allocator, bodies, sizeof(se3di_frame)));
    SE3DI_TRY(resize(&saved->acceleration, allocator, 6 * bodies, one));
    SE3DI_TRY(resize(&saved->lambda, allocator, model->row_count, one));
    SE3DI_TRY(resize(&saved->turns, allocator, model->angle_count, one));
    SE3DI_TRY(
        resize(&saved->memory, allocator, SE3DI_FORCE_STATES * model->force_slots.count, one));
    SE3DI_TRY(resize(&saved->history, allocator, history, one));
    SE3DI_TRY(resize(&saved->wrench, allocator, 6 * model->shape_slots.count, one));
    SE3DI_TRY(resize(&saved->left_out, allocator, model->left_out_count > 0 ? model->row_count : 0,
                     sizeof(uint8_t)));
    /* room for contacts to come: steps make new ones and allocate nothing */
    const size_t contacts = model->contacts.count;
    const int has_room = saved->contacts.capacity > contacts || model->shape_slots.count < 2;
    SE3DI_TRY(resize(&saved->contacts, allocator, has_room ? contacts : 2 * contacts + 16,
                     sizeof(se3di_body_contact)));
    saved->contacts.count = contacts;
    return SE3D_OK;
}

static void save_ranks(se3di_saved *saved, const se3di_model *model)
{
    uint8_t *left_out = saved->left_out.data;
    for (size_t k = 0; k < saved->left_out.count; ++k) {
        left_out[k] = (uint8_t)model->rows[k].left_out;
    }
}

static void restore_ranks(const se3di_saved *saved, se3di_model *model)
{
    const uint8_t *left_out = saved->left_out.data;
    int other = 0; /* joints were whole or broken */
    for (size_t k = 0; model->left_out_count > 0 && k < model->row_count; ++k) {
        other |= saved->left_out.count == 0 && (model->rows[k].left_out & SE3DI_ROW_BREAKS) != 0;
        model->rows[k].left_out &= saved->left_out.count > 0 ? SE3DI_ROW_BREAKS : 0;
    }
    for (size_t k = 0; k < saved->left_out.count; ++k) {
        other |= (model->rows[k].left_out ^ left_out[k]) & SE3DI_ROW_BREAKS;
        model->rows[k].left_out = left_out[k];
    }
    if (other) {
        se3di_model_follow_breaks(model);
    }
}

/* What is copied as it is. */
#define NUMBERS(X)                                                                                 \
    X(ranks_known)                                                                                 \
    X(left_out_count)                                                                              \
    X(left_out_row)                                                                                \
    X(left_out_gap)                                                                                \
    X(work_valid)                                                                                  \
    X(settled)                                                                                     \
    X(shows_before)                                                                                \
    X(history_tag)                                                                                 \
    X(history_redundant)                                                                           \
    X(history_inputs)                                                                              \
    X(history_values)                                                                              \
    X(time)                                                                                        \
    X(time_rest)                                                                                   \
    X(rest_time)

/* All but the history. */
static void save_state(se3di_saved *saved, const se3di_model *model)
{
    double *turns = saved->turns.data;
    double *wrench = saved->wrench.data;
    copy(saved->frames.data, model->frames, saved->frames.count * sizeof *model->frames);
    copy(saved->acceleration.data, model->acceleration, saved->acceleration.count * sizeof(double));
    copy(saved->lambda.data, model->lambda, saved->lambda.count * sizeof(double));
    copy(saved->contacts.data, model->contacts.list,
         saved->contacts.count * sizeof *model->contacts.list);
    for (size_t k = 0; k < saved->turns.count; ++k) {
        turns[k] = model->angles[k].theta;
    }
    se3di_model_save_memory(model, saved->memory.data);
    for (size_t k = 0; 6 * k < saved->wrench.count; ++k) {
        memcpy(wrench + 6 * k, model->shapes[k].force, 3 * sizeof *wrench);
        memcpy(wrench + 6 * k + 3, model->shapes[k].torque, 3 * sizeof *wrench);
    }
    save_ranks(saved, model);
    memcpy(saved->work, model->work, sizeof saved->work);
    memcpy(saved->power, model->power, sizeof saved->power);
    saved->contact_step = model->contacts.step;
    saved->contact_time = model->contacts.time;
#define SAVE(member) saved->member = model->member;
    NUMBERS(SAVE)
#undef SAVE
}

se3d_status se3di_saved_fill(se3di_saved *saved, const se3di_model *model,
                             const se3d_allocator *allocator)
{
    SE3DI_TRY(fit(saved, model, allocator));
    copy(saved->history.data, model->history, saved->history.count * sizeof(double));
    saved->history_stamp = model->history_stamp;
    save_state(saved, model);
    return SE3D_OK;
}

/* Its first two numbers are the times at which its last step has ended and begun. */
static int is_history_kept(const se3di_saved *saved, const se3di_model *model)
{
    return saved->history.count > 1 && saved->history.count == model->history_count &&
           saved->history_tag == model->history_tag &&
           saved->history_stamp == model->history_stamp &&
           memcmp(saved->history.data, model->history, 2 * sizeof(double)) == 0;
}

se3d_status se3di_saved_refill(se3di_saved *saved, const se3di_model *model,
                               const se3d_allocator *allocator)
{
    if (!is_history_kept(saved, model)) {
        return se3di_saved_fill(saved, model, allocator);
    }
    SE3DI_TRY(fit(saved, model, allocator));
    save_state(saved, model);
    return SE3D_OK;
}

int se3di_saved_fits(const se3di_saved *saved, const se3di_model *model)
{
    return saved->frames.count == model->body_slots.count &&
           saved->lambda.count == model->row_count && saved->turns.count == model->angle_count &&
           saved->memory.count == SE3DI_FORCE_STATES * model->force_slots.count &&
           saved->wrench.count == 6 * model->shape_slots.count;
}

se3d_status se3di_saved_reserve(const se3di_saved *saved, se3di_model *model)
{
    void *history = model->history;
    void *list = model->contacts.list;
    se3d_status status = se3di_array_reserve(&model->allocator, &history, &model->history_capacity,
                                             saved->history.count, sizeof(double));
    model->history = history;
    SE3DI_TRY(status);
    status = se3di_array_reserve(&model->allocator, &list, &model->contacts.capacity,
                                 saved->contacts.count, sizeof *model->contacts.list);
    model->contacts.list = list;
    return status;
}

void se3di_saved_restore(const se3di_saved *saved, se3di_model *model)
{
    const double *turns = saved->turns.data;
    const double *wrench = saved->wrench.data;
    copy(model->frames, saved->frames.data, saved->frames.count * sizeof *model->frames);
    copy(model->acceleration, saved->acceleration.data, saved->acceleration.count * sizeof(double));
    copy(model->lambda, saved->lambda.data, saved->lambda.count * sizeof(double));
    copy(model->history, saved->history.data, saved->history.count * sizeof(double));
    copy(model->contacts.list, saved->contacts.data,
         saved->contacts.count * sizeof *model->contacts.list);
    model->contacts.count = saved->contacts.count;
    model->contacts.step = saved->contact_step;
    model->contacts.time = saved->contact_time;
    for (size_t k = 0; k < saved->turns.count; ++k) {
        model->angles[k].theta = turns[k];
    }
    se3di_model_restore_memory(model, saved->memory.data);
    for (size_t k = 0; 6 * k < saved->wrench.count; ++k) {
        memcpy(model->shapes[k].force, wrench + 6 * k, 3 * sizeof *wrench);
        memcpy(model->shapes[k].torque, wrench + 6 * k + 3, 3 * sizeof *wrench);
    }
    restore_ranks(saved, model);
    memcpy(model->work, saved->work, sizeof saved->work);
    memcpy(model->power, saved->power, sizeof saved->power);
    model->remembers = 1;
    model->history_count = saved->history.count;
#define RESTORE(member) model->member = saved->member;
    NUMBERS(RESTORE)
#undef RESTORE
}

static void release(se3di_saved_array *array, const se3d_allocator *allocator, size_t size)
{
    se3di_free(allocator, array->data, array->capacity, size);
    *array = (se3di_saved_array){0};
}

void se3di_saved_destroy(se3di_saved *saved, const se3d_allocator *allocator)
{
    const size_t one = sizeof(double);
    release(&saved->frames, allocator, sizeof(se3di_frame));
    release(&saved->acceleration, allocator, one);
    release(&saved->lambda, allocator, one);
    release(&saved->turns, allocator, one);
    release(&saved->memory, allocator, one);
    release(&saved->history, allocator, one);
    release(&saved->wrench, allocator, one);
    release(&saved->left_out, allocator, sizeof(uint8_t));
    release(&saved->contacts, allocator, sizeof(se3di_body_contact));
}
