/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding and removing constraints with their rows and terms. */
#include "model/edit.h"

#include <stddef.h>
#include <string.h>

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

static int is_made_of(const se3di_constraint *constraint, uint32_t joint)
{
    for (int j = 0; j < SE3D_COUPLER_TERMS_MAX; ++j) {
        if (constraint->joints[j] == (int32_t)joint) {
            return 1;
        }
    }
    return 0;
}

/* Drivers and couplers have copies of the frames of their joints, and follow when they are defined
 * again, too. */
static void make_stale(se3di_model *model, uint32_t joint)
{
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        se3di_constraint *other = &model->constraints[k];
        other->is_stale |= is_made_of(other, joint);
    }
}

static int is_at_another_place(const se3di_constraint *a, const se3di_constraint *b)
{
    return memcmp(&a->frames, &b->frames, sizeof a->frames) != 0 ||
           memcmp(&a->angle0, &b->angle0, sizeof a->angle0) != 0;
}

/* Drivers, couplers and force elements on a joint, and laws that it goes into, have copies of which
 * bodies it joins. */
static int is_tied(const se3di_model *model, uint32_t joint)
{
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        if (is_made_of(&model->constraints[k], joint)) {
            return 1;
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (model->forces[k].joint == (int32_t)joint) {
            return 1;
        }
    }
    return se3di_model_is_signalled(model, offsetof(se3di_signal, joint), joint);
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
    if (!has_same_bodies(&old, &draft->constraint) && is_tied(model, index)) {
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
    se3di_constraint_leave_out(model, constraint, is_broken);
    count_constraint_users(model, constraint, 1);
    if (is_at_another_place(&old, constraint)) {
        make_stale(model, index);
    }
    se3di_model_touch(model);
    return SE3D_OK;
}

se3d_status se3di_model_check_stale(const se3di_model *model, se3di_error *error)
{
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        if (c->is_stale) {
            return se3di_error_set(
                error, SE3D_ERR_STATE,
                "%s '%.64s' is made of a joint that was defined again at another "
                "place since; define it again, too, or destroy it",
                c->type, c->name ? c->name : "");
        }
    }
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
    SE3DI_RESERVE(model, constraints, constraint_capacity, count + 1, sizeof *model->constraints);
    SE3DI_RESERVE(model, rows, row_capacity, rows, sizeof *model->rows);
    SE3DI_RESERVE(model, lambda, lambda_capacity, rows, sizeof *model->lambda);
    SE3DI_RESERVE(model, terms, term_capacity, model->term_count + draft->term_count,
                  sizeof *model->terms);
    SE3DI_RESERVE(model, angles, angle_capacity, model->angle_count + 1, sizeof *model->angles);
    SE3DI_TRY(se3di_slots_reserve(&model->constraint_slots, &model->allocator));
    SE3DI_TRY(
        se3di_model_copy_name(model, &model->constraint_slots, draft->constraint.name, &name));
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
    *handle = se3di_model_add_named(&model->constraint_slots, 0, name);
    se3di_model_touch(model);
    return SE3D_OK;
}

void se3di_model_remove_constraint(se3di_model *model, uint32_t index)
{
    se3di_constraint gone = model->constraints[index];
    count_constraint_users(model, &gone, UINT32_MAX);
    se3di_array_close_gap(model->rows, model->row_count, gone.row_begin, gone.row_count,
                          sizeof *model->rows);
    se3di_array_close_gap(model->lambda, model->row_count, gone.row_begin, gone.row_count,
                          sizeof *model->lambda);
    se3di_array_close_gap(model->terms, model->term_count, gone.term_begin, gone.term_count,
                          sizeof *model->terms);
    se3di_array_close_gap(model->constraints, model->constraint_slots.count, index, 1,
                          sizeof *model->constraints);
    se3di_model_remove_named(model, &model->constraint_slots, index, 0, gone.name);
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
            se3di_index_lower_signed(&model->constraints[k].joints[j], index);
        }
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_index_lower_signed(&model->forces[k].joint, index);
    }
    se3di_model_lower_signals(model, offsetof(se3di_signal, joint), index);
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        se3di_index_lower_signed(&model->wheels[k].travel, index);
        se3di_index_lower_signed(&model->wheels[k].steering, index);
    }
    if (gone.angle >= 0) {
        se3di_model_remove_angle(model, (uint32_t)gone.angle);
    }
    se3di_model_touch(model);
}
