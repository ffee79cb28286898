/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding and removing elements. Adding reserves first; nothing below the reservation can fail. */
#include "math/quaternion.h"
#include "model/function.h"
#include "model/model.h"
#include "model/state.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

/* Grow one typed array of the model. */
#define RESERVE(model, array, capacity, needed, size)                                              \
    do {                                                                                           \
        void *reserve_data = (model)->array;                                                       \
        se3d_status reserve_status = se3di_array_reserve(&(model)->allocator, &reserve_data,       \
                                                         &(model)->capacity, (needed), (size));    \
        (model)->array = reserve_data;                                                             \
        if (reserve_status < 0) {                                                                  \
            return reserve_status;                                                                 \
        }                                                                                          \
    } while (0)

/* Close the gap of `removed` elements at `first` in an array of `count`. */
static void close_gap(void *array, size_t count, size_t first, size_t removed, size_t size)
{
    char *bytes = array;
    if (removed > 0 && first + removed < count) {
        memmove(bytes + first * size, bytes + (first + removed) * size,
                (count - first - removed) * size);
    }
}

/* A copy of a name, and room for it among those of its kind. */
static se3d_status copy_name(se3di_model *model, se3di_slots *slots, const char *name, char **copy)
{
    *copy = NULL;
    if (name) {
        SE3DI_TRY(se3di_names_reserve(&slots->names, &model->allocator, slots->names.count + 1));
        *copy = se3di_text_copy(&model->allocator, name);
        return *copy ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    }
    return SE3D_OK;
}

static se3di_handle add_named(se3di_slots *slots, uint32_t owner, const char *name)
{
    const se3di_handle handle = se3di_slots_add(slots);
    if (name) {
        se3di_slots_name(slots, (uint32_t)slots->count - 1, owner, name);
    }
    return handle;
}

uint32_t se3di_model_find_replaced(const se3di_model *model, const se3di_slots *slots,
                                   uint32_t owner, const char *name)
{
    if (model->target > 0) {
        return model->target - 1;
    }
    return model->replaces && name ? se3di_slots_find_name(slots, owner, name) : SE3DI_NO_INDEX;
}

/* Take the object `dense` out, and its name. */
static void remove_named(se3di_model *model, se3di_slots *slots, uint32_t dense, uint32_t owner,
                         char *name)
{
    if (name) {
        se3di_names_remove(&slots->names, owner, name);
        se3di_text_free(&model->allocator, name);
    }
    se3di_slots_remove(slots, dense);
}

void se3di_model_touch_state(se3di_model *model)
{
    model->settled &= ~SE3DI_SETTLED;
    model->history_tag = 0;
    ++model->history_stamp;
    ++model->poses_version;
    model->work_valid = se3di_has_work(model) ? SE3DI_WORK_LEFT : SE3DI_WORK_NONE;
    if (!model->remembers) {
        return;
    }
    model->remembers = model->shows_before = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        memset(model->forces[k].state, 0, sizeof model->forces[k].state);
    }
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        memset(model->shapes[k].force, 0, sizeof model->shapes[k].force);
        memset(model->shapes[k].torque, 0, sizeof model->shapes[k].torque);
    }
    model->contacts.count = 0;
    model->contacts.step = 0.0;
}

void se3di_model_follow_breaks(se3di_model *model)
{
    model->left_out_count = model->broken_count = 0;
    for (size_t k = 0; k < model->row_count; ++k) {
        model->left_out_count += model->rows[k].left_out != 0;
        model->broken_count += (model->rows[k].left_out & SE3DI_ROW_BROKEN) != 0;
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const int32_t joint = model->forces[k].joint;
        model->forces[k].released =
            joint >= 0 && se3di_is_broken(&model->constraints[joint], model->rows);
    }
    model->contacts.version = 0; /* others may touch */
    ++model->break_version;
}

void se3di_model_take_all_rows(se3di_model *model)
{
    for (size_t k = 0; model->left_out_count > 0 && k < model->row_count; ++k) {
        model->rows[k].left_out &= SE3DI_ROW_BREAKS;
    }
    model->left_out_count = model->broken_count;
    model->left_out_row = 0;
    model->left_out_gap = 0.0;
    model->ranks_known = 0;
}

/* It prescribes a coordinate of the joint, or couples it to others. */
static int acts_on(const se3di_constraint *constraint, uint32_t joint)
{
    int acts = 0;
    for (int k = 0; k < SE3D_COUPLER_TERMS_MAX; ++k) {
        acts |= constraint->joints[k] == (int32_t)joint;
    }
    return acts;
}

/* Of what acts on several joints, one that is broken is enough. */
static int acts_on_broken(const se3di_model *model, const se3di_constraint *constraint)
{
    int broken = 0;
    for (int k = 0; k < SE3D_COUPLER_TERMS_MAX; ++k) {
        const int32_t joint = constraint->joints[k];
        broken |= joint >= 0 && se3di_is_broken(&model->constraints[joint], model->rows);
    }
    return broken;
}

/* What is broken already stays as it is: its bodies may have been apart. */
static void leave_out(se3di_model *model, const se3di_constraint *constraint, int broken)
{
    if (broken && se3di_is_broken(constraint, model->rows)) {
        return;
    }
    for (uint32_t k = 0; k < constraint->row_count; ++k) {
        const uint32_t row = constraint->row_begin + k;
        model->rows[row].left_out = broken ? SE3DI_ROW_BROKEN : 0;
        model->lambda[row] = 0.0;
    }
}

void se3di_model_break(se3di_model *model, uint32_t joint, int32_t broken)
{
    leave_out(model, &model->constraints[joint], broken);
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        if (acts_on(constraint, joint)) {
            leave_out(model, constraint, acts_on_broken(model, constraint));
        }
    }
    se3di_model_follow_breaks(model);
    se3di_model_take_all_rows(model);
    model->history_tag = 0;
    ++model->history_stamp;
}

void se3di_model_touch_poses(se3di_model *model)
{
    se3di_model_take_all_rows(model);
    se3di_model_touch_state(model);
}

/* Elements came or went: of those that are there, what acts on a broken joint does not. */
static void follow_edit(se3di_model *model)
{
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        if (acts_on_broken(model, constraint)) {
            leave_out(model, constraint, 1);
        }
    }
    se3di_model_follow_breaks(model);
}

void se3di_model_touch(se3di_model *model)
{
    ++model->topology_version;
    if (model->broken_count > 0) {
        follow_edit(model);
    }
    se3di_model_touch_poses(model);
}

/* The next version, another one than of any clone: states go from one to the other, and with them
 * which version they belong to. Versions are only compared. */
static void renew(const se3di_model *model, uint64_t *version)
{
    *version = *version * UINT64_C(6364136223846793005) + 2 * (uint64_t)(uintptr_t)model + 1;
}

void se3di_model_touch_inputs(se3di_model *model)
{
    renew(model, &model->inputs_version);
    model->settled &= ~SE3DI_SETTLED;
}

void se3di_model_touch_contact(se3di_model *model)
{
    renew(model, &model->contact_version);
    se3di_model_touch_inputs(model);
}

void se3di_model_touch_values(se3di_model *model)
{
    renew(model, &model->values_version);
    se3di_model_touch_inputs(model);
}

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
    RESERVE(model, bodies, body_capacity, count + 1, sizeof *model->bodies);
    RESERVE(model, frames, frame_capacity, count + 1, sizeof *model->frames);
    RESERVE(model, acceleration, acceleration_capacity, count + 1, 6 * sizeof *model->acceleration);
    SE3DI_TRY(se3di_slots_reserve(&model->body_slots, &model->allocator));
    SE3DI_TRY(copy_name(model, &model->body_slots, body->name, &name));
    model->bodies[count] = *body;
    model->bodies[count].name = name;
    model->bodies[count].users = 0;
    model->frames[count] = *frame;
    memset(model->acceleration + 6 * count, 0, 6 * sizeof *model->acceleration);
    *handle = add_named(&model->body_slots, 0, name);
    se3di_model_touch(model);
    return SE3D_OK;
}

static void lower(uint32_t *index, uint32_t removed)
{
    *index -= *index > removed;
}

static void lower_signed(int32_t *index, uint32_t removed)
{
    *index -= *index >= 0 && (uint32_t)*index > removed;
}

/* The same in all signals of functions: the index at `offset`. */
static void lower_signals(se3di_model *model, size_t offset, uint32_t removed)
{
    for (size_t k = 0; k < model->function_slots.count; ++k) {
        for (uint32_t s = 0; s < model->functions[k].signal_count; ++s) {
            uint32_t index;
            char *at = (char *)&model->functions[k].signals[s] + offset;
            memcpy(&index, at, sizeof index);
            if (index != SE3DI_NO_INDEX) {
                lower(&index, removed);
                memcpy(at, &index, sizeof index);
            }
        }
    }
}

/* Count (+1) or discount (-1) the elements that the signals of a function are of. */
static void count_signal_users(se3di_model *model, const se3di_function *function, uint32_t by)
{
    for (uint32_t k = 0; k < function->signal_count; ++k) {
        const se3di_signal *s = &function->signals[k];
        model->bodies[s->body].users += by;
        if (s->joint != SE3DI_NO_INDEX) {
            model->constraints[s->joint].users += by;
        }
        if (s->force != SE3DI_NO_INDEX) {
            model->forces[s->force].users += by;
        }
    }
}

void se3di_model_remove_body(se3di_model *model, uint32_t body)
{
    size_t count = model->body_slots.count;
    char *name = model->bodies[body].name;
    close_gap(model->bodies, count, body, 1, sizeof *model->bodies);
    close_gap(model->frames, count, body, 1, sizeof *model->frames);
    close_gap(model->acceleration, count, body, 1, 6 * sizeof *model->acceleration);
    remove_named(model, &model->body_slots, body, 0, name);
    for (size_t k = 0; k < model->marker_slots.count; ++k) {
        lower(&model->markers[k].body, body);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        for (uint32_t b = 0; b < model->constraints[k].body_count; ++b) {
            lower(&model->constraints[k].bodies[b], body);
        }
    }
    for (size_t k = 0; k < model->term_count; ++k) {
        lower(&model->terms[k].body_i, body);
        lower(&model->terms[k].body_j, body);
    }
    for (size_t k = 0; k < model->angle_count; ++k) {
        lower(&model->angles[k].term.body_i, body);
        lower(&model->angles[k].term.body_j, body);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        lower(&model->forces[k].body_i, body);
        lower(&model->forces[k].body_j, body);
        for (int c = 0; c < 2 && model->forces[k].tyre; ++c) {
            lower(&model->forces[k].tyre->carrier[c], body);
        }
    }
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        lower(&model->shapes[k].body, body);
    }
    lower_signals(model, offsetof(se3di_signal, body), body);
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        lower(&model->wheels[k].body, body);
        lower(&model->wheels[k].chassis, body);
    }
    for (size_t k = 0; k < model->road_slots.count; ++k) {
        lower(&model->roads[k].body, body);
    }
    se3di_model_touch(model);
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
    RESERVE(model, markers, marker_capacity, count + 1, sizeof *model->markers);
    SE3DI_TRY(se3di_slots_reserve(&model->marker_slots, &model->allocator));
    SE3DI_TRY(copy_name(model, &model->marker_slots, marker->name, &name));
    model->markers[count] = *marker;
    model->markers[count].name = name;
    model->markers[count].users = 0;
    ++model->bodies[marker->body].users;
    *handle = add_named(&model->marker_slots, owner, name);
    return SE3D_OK;
}

void se3di_model_remove_marker(se3di_model *model, uint32_t marker)
{
    --model->bodies[model->markers[marker].body].users;
    char *name = model->markers[marker].name;
    const uint32_t owner = se3di_model_owner(model, model->markers[marker].body);
    close_gap(model->markers, model->marker_slots.count, marker, 1, sizeof *model->markers);
    remove_named(model, &model->marker_slots, marker, owner, name);
}

se3d_status se3di_model_add_function(se3di_model *model, const se3di_function *function,
                                     se3di_handle *handle)
{
    size_t count = model->function_slots.count;
    RESERVE(model, functions, function_capacity, count + 1, sizeof *model->functions);
    SE3DI_TRY(se3di_slots_reserve(&model->function_slots, &model->allocator));
    model->functions[count] = *function;
    model->functions[count].users = 0;
    count_signal_users(model, function, 1);
    *handle = se3di_slots_add(&model->function_slots);
    return SE3D_OK;
}

void se3di_model_remove_function(se3di_model *model, uint32_t function)
{
    count_signal_users(model, &model->functions[function], UINT32_MAX);
    se3di_function_release(&model->allocator, &model->functions[function]);
    close_gap(model->functions, model->function_slots.count, function, 1, sizeof *model->functions);
    se3di_slots_remove(&model->function_slots, function);
    for (size_t k = 0; k < model->row_count; ++k) {
        lower_signed(&model->rows[k].function, function);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        lower_signed(&model->constraints[k].law, function);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        for (int c = 0; c < SE3DI_FORCE_FUNCTIONS; ++c) {
            lower_signed(&model->forces[k].function[c], function);
        }
    }
    for (int c = 0; c < 3; ++c) {
        lower_signed(&model->gravity_function[c], function);
    }
    for (size_t k = 0; k < model->road_slots.count; ++k) {
        lower_signed(&model->roads[k].function, function);
    }
}

/* Count (+1) or discount (-1) the elements that a constraint refers to. */
static void count_constraint_users(se3di_model *model, const se3di_constraint *constraint,
                                   uint32_t by)
{
    for (uint32_t k = 0; k < constraint->body_count; ++k) {
        model->bodies[constraint->bodies[k]].users += by;
    }
    for (int k = 0; k < SE3D_COUPLER_TERMS_MAX; ++k) {
        if (constraint->joints[k] >= 0) {
            model->constraints[constraint->joints[k]].users += by;
        }
    }
    for (uint32_t k = 0; k < constraint->row_count; ++k) {
        int32_t function = model->rows[constraint->row_begin + k].function;
        if (function >= 0) {
            model->functions[function].users += by;
        }
    }
    if (constraint->law >= 0) {
        model->functions[constraint->law].users += by;
    }
}

/* Put the rows and terms of a draft where `constraint` has its own. Angle terms of the joint's own
 * rows (a screw) refer to its turn counter. */
static void place_terms(se3di_model *model, const se3di_draft *draft,
                        const se3di_constraint *constraint)
{
    if (draft->term_count > 0) { /* a callback's rows have none */
        memcpy(model->terms + constraint->term_begin, draft->terms,
               draft->term_count * sizeof *draft->terms);
    }
    for (uint32_t k = 0; k < draft->term_count; ++k) {
        se3di_term *term = &model->terms[constraint->term_begin + k];
        if (draft->has_angle && term->type == SE3DI_PRIMITIVE_ANGLE && term->angle < 0) {
            term->angle = constraint->angle;
        }
    }
    for (uint32_t k = 0; k < draft->row_count; ++k) {
        const uint32_t row = constraint->row_begin + k;
        model->rows[row] = draft->rows[k];
        model->rows[row].term_begin += constraint->term_begin;
        model->lambda[row] = 0.0;
    }
    if (draft->has_angle) {
        model->angles[constraint->angle] = draft->angle;
    }
}

/* A function has a signal of the element whose index is at `offset` in signals. */
static int is_signalled(const se3di_model *model, size_t offset, uint32_t element)
{
    for (size_t k = 0; k < model->function_slots.count; ++k) {
        for (uint32_t s = 0; s < model->functions[k].signal_count; ++s) {
            uint32_t index;
            memcpy(&index, (const char *)&model->functions[k].signals[s] + offset, sizeof index);
            if (index == element) {
                return 1;
            }
        }
    }
    return 0;
}

/* Force elements on a joint, and laws that it goes into, have copies of which bodies it joins. */
static int is_tied(const se3di_model *model, uint32_t joint)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].joint == (int32_t)joint) {
            return 1;
        }
    }
    return is_signalled(model, offsetof(se3di_signal, joint), joint);
}

static int has_same_bodies(const se3di_constraint *a, const se3di_constraint *b)
{
    return a->body_count == b->body_count &&
           memcmp(a->bodies, b->bodies, a->body_count * sizeof *a->bodies) == 0;
}

/* A constraint with as many rows and terms, and with a turn counter or without, takes the place of
 * another one. A joint that is defined again stays broken: definitions do not say it. */
static se3d_status replace_constraint(se3di_model *model, uint32_t index, const se3di_draft *draft)
{
    se3di_constraint *constraint = &model->constraints[index];
    const se3di_constraint old = *constraint;
    if (strcmp(old.type, draft->constraint.type) != 0 || old.row_count != draft->row_count ||
        old.term_count != draft->term_count || (old.angle >= 0) != (draft->has_angle != 0)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    if (model->target > 0 && !has_same_bodies(&old, &draft->constraint) && is_tied(model, index)) {
        return SE3D_ERR_IN_USE;
    }
    const int is_broken =
        model->target > 0 && old.joints[0] < 0 && se3di_is_broken(&old, model->rows);
    count_constraint_users(model, &old, UINT32_MAX);
    *constraint = draft->constraint;
    constraint->name = old.name;
    constraint->users = old.users;
    constraint->row_begin = old.row_begin;
    constraint->row_count = old.row_count;
    constraint->term_begin = old.term_begin;
    constraint->term_count = old.term_count;
    constraint->angle = old.angle;
    place_terms(model, draft, constraint);
    leave_out(model, constraint, is_broken);
    count_constraint_users(model, constraint, 1);
    se3di_model_touch(model);
    return SE3D_OK;
}

se3d_status se3di_model_add_constraint(se3di_model *model, const se3di_draft *draft,
                                       se3di_handle *handle)
{
    size_t count = model->constraint_slots.count;
    size_t rows = model->row_count + draft->row_count;
    char *name;
    const uint32_t old =
        se3di_model_find_replaced(model, &model->constraint_slots, 0, draft->constraint.name);
    if (old != SE3DI_NO_INDEX) {
        *handle = se3di_slots_handle(&model->constraint_slots, old);
        return replace_constraint(model, old, draft);
    }
    RESERVE(model, constraints, constraint_capacity, count + 1, sizeof *model->constraints);
    RESERVE(model, rows, row_capacity, rows, sizeof *model->rows);
    RESERVE(model, lambda, lambda_capacity, rows, sizeof *model->lambda);
    RESERVE(model, terms, term_capacity, model->term_count + draft->term_count,
            sizeof *model->terms);
    RESERVE(model, angles, angle_capacity, model->angle_count + 1, sizeof *model->angles);
    SE3DI_TRY(se3di_slots_reserve(&model->constraint_slots, &model->allocator));
    SE3DI_TRY(copy_name(model, &model->constraint_slots, draft->constraint.name, &name));
    se3di_constraint *constraint = &model->constraints[count];
    *constraint = draft->constraint;
    constraint->name = name;
    constraint->users = 0;
    constraint->row_begin = (uint32_t)model->row_count;
    constraint->row_count = draft->row_count;
    constraint->term_begin = (uint32_t)model->term_count;
    constraint->term_count = draft->term_count;
    constraint->angle = draft->has_angle ? (int32_t)model->angle_count : -1;
    place_terms(model, draft, constraint);
    model->angle_count += draft->has_angle ? 1 : 0;
    model->row_count += draft->row_count;
    model->term_count += draft->term_count;
    count_constraint_users(model, constraint, 1);
    *handle = add_named(&model->constraint_slots, 0, name);
    se3di_model_touch(model);
    return SE3D_OK;
}

static void remove_angle(se3di_model *model, uint32_t angle)
{
    close_gap(model->angles, model->angle_count--, angle, 1, sizeof *model->angles);
    for (size_t k = 0; k < model->term_count; ++k) {
        lower_signed(&model->terms[k].angle, angle);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        lower_signed(&model->constraints[k].angle, angle);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        lower_signed(&model->forces[k].angle, angle);
    }
}

void se3di_model_remove_constraint(se3di_model *model, uint32_t index)
{
    se3di_constraint gone = model->constraints[index];
    count_constraint_users(model, &gone, UINT32_MAX);
    close_gap(model->rows, model->row_count, gone.row_begin, gone.row_count, sizeof *model->rows);
    close_gap(model->lambda, model->row_count, gone.row_begin, gone.row_count,
              sizeof *model->lambda);
    close_gap(model->terms, model->term_count, gone.term_begin, gone.term_count,
              sizeof *model->terms);
    close_gap(model->constraints, model->constraint_slots.count, index, 1,
              sizeof *model->constraints);
    remove_named(model, &model->constraint_slots, index, 0, gone.name);
    model->row_count -= gone.row_count;
    model->term_count -= gone.term_count;
    for (size_t k = index; k < model->constraint_slots.count; ++k) {
        model->constraints[k].row_begin -= gone.row_count;
        model->constraints[k].term_begin -= gone.term_count;
    }
    for (size_t k = gone.row_begin; k < model->row_count; ++k) {
        model->rows[k].term_begin -= gone.term_count;
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        for (int j = 0; j < SE3D_COUPLER_TERMS_MAX; ++j) {
            lower_signed(&model->constraints[k].joints[j], index);
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        lower_signed(&model->forces[k].joint, index);
    }
    lower_signals(model, offsetof(se3di_signal, joint), index);
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        lower_signed(&model->wheels[k].travel, index);
        lower_signed(&model->wheels[k].steering, index);
    }
    if (gone.angle >= 0) {
        remove_angle(model, (uint32_t)gone.angle);
    }
    se3di_model_touch(model);
}

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
    if (model->target > 0 && moves && is_signalled(model, offsetof(se3di_signal, force), index)) {
        return SE3D_ERR_IN_USE;
    }
    SE3DI_TRY(se3di_force_own(&model->allocator, &own));
    if (own.tyre) {
        memcpy(own.tyre->carrier, old->tyre->carrier, sizeof own.tyre->carrier);
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
    RESERVE(model, forces, force_capacity, count + 1, sizeof *model->forces);
    SE3DI_TRY(se3di_slots_reserve(&model->force_slots, &model->allocator));
    SE3DI_TRY(se3di_force_own(&model->allocator, &own));
    char *name;
    if (copy_name(model, &model->force_slots, force->name, &name) < 0) {
        se3di_force_release(&model->allocator, &own);
        return SE3D_ERR_NO_MEMORY;
    }
    model->forces[count] = own;
    model->forces[count].name = name;
    model->forces[count].users = 0;
    count_force_users(model, force, 1);
    *handle = add_named(&model->force_slots, 0, name);
    se3di_model_touch(model);
    return SE3D_OK;
}

se3d_status se3di_model_add_force_with_angle(se3di_model *model, const se3di_force *force,
                                             const se3di_angle *angle, se3di_handle *handle)
{
    se3di_force owner = *force;
    const uint32_t old = se3di_model_find_replaced(model, &model->force_slots, 0, force->name);
    const int is_new = old == SE3DI_NO_INDEX;
    RESERVE(model, angles, angle_capacity, model->angle_count + 1, sizeof *model->angles);
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
    close_gap(model->forces, model->force_slots.count, force, 1, sizeof *model->forces);
    remove_named(model, &model->force_slots, force, 0, name);
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        model->bodies[k].state -= model->bodies[k].state > (int32_t)force + 1;
    }
    lower_signals(model, offsetof(se3di_signal, force), force);
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        lower_signed(&model->forces[k].tyre_index, force);
    }
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        lower_signed(&model->wheels[k].spring, force);
    }
    if (own >= 0) {
        remove_angle(model, (uint32_t)own);
    }
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

void se3di_model_set_state_function(se3di_model *model, uint32_t force, int place, int32_t function)
{
    count_force_users(model, &model->forces[force], UINT32_MAX);
    model->forces[force].function[place] = function;
    count_force_users(model, &model->forces[force], 1);
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

static void count_wheel_users(se3di_model *model, const se3di_wheel *wheel, uint32_t by)
{
    model->bodies[wheel->body].users += by;
    model->bodies[wheel->chassis].users += by;
    if (wheel->travel >= 0) {
        model->constraints[wheel->travel].users += by;
    }
    if (wheel->steering >= 0) {
        model->constraints[wheel->steering].users += by;
    }
    if (wheel->spring >= 0) {
        model->forces[wheel->spring].users += by;
    }
}

/* Let the wheel across know, and any other that was across no longer. */
static void pair_wheel(se3di_model *model, uint32_t index)
{
    const int32_t opposite = model->wheels[index].opposite;
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        if (model->wheels[k].opposite == (int32_t)index && (int32_t)k != opposite) {
            model->wheels[k].opposite = -1;
        }
    }
    if (opposite >= 0) {
        model->wheels[opposite].opposite = (int32_t)index;
    }
}

static void replace_wheel(se3di_model *model, uint32_t index, const se3di_wheel *wheel)
{
    se3di_wheel *old = &model->wheels[index];
    char *name = old->name;
    count_wheel_users(model, old, UINT32_MAX);
    *old = *wheel;
    old->name = name;
    count_wheel_users(model, old, 1);
    pair_wheel(model, index);
}

se3d_status se3di_model_add_wheel(se3di_model *model, const se3di_wheel *wheel,
                                  se3di_handle *handle)
{
    size_t count = model->wheel_slots.count;
    char *name;
    const uint32_t old = se3di_model_find_replaced(model, &model->wheel_slots, 0, wheel->name);
    if (old != SE3DI_NO_INDEX) {
        replace_wheel(model, old, wheel);
        *handle = se3di_slots_handle(&model->wheel_slots, old);
        return SE3D_OK;
    }
    RESERVE(model, wheels, wheel_capacity, count + 1, sizeof *model->wheels);
    SE3DI_TRY(se3di_slots_reserve(&model->wheel_slots, &model->allocator));
    SE3DI_TRY(copy_name(model, &model->wheel_slots, wheel->name, &name));
    model->wheels[count] = *wheel;
    model->wheels[count].name = name;
    pair_wheel(model, (uint32_t)count);
    count_wheel_users(model, wheel, 1);
    *handle = add_named(&model->wheel_slots, 0, name);
    return SE3D_OK;
}

void se3di_model_remove_wheel(se3di_model *model, uint32_t wheel)
{
    count_wheel_users(model, &model->wheels[wheel], UINT32_MAX);
    char *name = model->wheels[wheel].name;
    close_gap(model->wheels, model->wheel_slots.count, wheel, 1, sizeof *model->wheels);
    remove_named(model, &model->wheel_slots, wheel, 0, name);
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        int32_t *opposite = &model->wheels[k].opposite;
        *opposite = *opposite == (int32_t)wheel ? -1 : *opposite;
        lower_signed(opposite, wheel);
    }
}

static void count_road_users(se3di_model *model, const se3di_road *road, uint32_t by)
{
    model->bodies[road->body].users += by;
    if (road->function >= 0) {
        model->functions[road->function].users += by;
    }
}

se3d_status se3di_model_add_road(se3di_model *model, const se3di_road *road, se3di_handle *handle)
{
    const size_t count = model->road_slots.count;
    se3di_road own = *road;
    RESERVE(model, roads, road_capacity, count + 1, sizeof *model->roads);
    SE3DI_TRY(se3di_slots_reserve(&model->road_slots, &model->allocator));
    SE3DI_TRY(se3di_road_own(&model->allocator, &own));
    const int is_mesh = own.kind == SE3DI_ROAD_MESH;
    if ((is_mesh && se3di_road_sort(&model->allocator, &own) < 0) ||
        copy_name(model, &model->road_slots, road->name, &own.name) < 0) {
        se3di_road_release(&model->allocator, &own);
        return SE3D_ERR_NO_MEMORY;
    }
    own.users = 0;
    model->roads[count] = own;
    count_road_users(model, road, 1);
    *handle = add_named(&model->road_slots, 0, own.name);
    return SE3D_OK;
}

void se3di_model_remove_road(se3di_model *model, uint32_t road)
{
    count_road_users(model, &model->roads[road], UINT32_MAX);
    char *name = model->roads[road].name;
    se3di_road_release(&model->allocator, &model->roads[road]);
    close_gap(model->roads, model->road_slots.count, road, 1, sizeof *model->roads);
    remove_named(model, &model->road_slots, road, 0, name);
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].tyre) {
            lower_signed(&model->forces[k].tyre->surface, road);
        }
    }
}
