/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbering and pattern of the equations. */
#include "assembly/assembly.h"

#include "assembly/armature.h"
#include "assembly/fused.h"
#include "model/state.h"
#include "primitive/scale.h"
#include "primitive/user.h"

#include <stdio.h>
#include <string.h>

/* Dense body indices of a term; both are counted even if they are the same. */
static int32_t free_of(const se3di_assembly *assembly, uint32_t dense)
{
    return assembly->free_index[dense];
}

static void number_bodies(se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->dense_count; ++k) {
        assembly->free_index[k] = -1;
        if (se3di_body_moves(&assembly->model->bodies[k], assembly->moves_states)) {
            assembly->free_index[k] = (int32_t)assembly->body_count;
            assembly->free_body[assembly->body_count++] = k;
        }
    }
}

/* Block of `free` within the joint that begins at `begin`; appended if it is new. */
static int32_t place_body(se3di_assembly *assembly, uint32_t begin, int32_t free)
{
    if (free < 0) {
        return -1;
    }
    for (uint32_t k = begin; k < assembly->joint_body_count; ++k) {
        if (assembly->joint_body[k] == free) {
            return (int32_t)(k - begin);
        }
    }
    assembly->joint_body[assembly->joint_body_count++] = free;
    return (int32_t)(assembly->joint_body_count - 1 - begin);
}

static void build_pattern(se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        const se3di_constraint *constraint = &model->constraints[k];
        uint32_t begin = assembly->joint_body_count;
        assembly->joint_rows[k] = (int32_t)constraint->row_count;
        assembly->joint_begin[k] = (int32_t)begin;
        for (uint32_t t = 0; t < constraint->term_count; ++t) {
            const se3di_term *term = &model->terms[constraint->term_begin + t];
            se3di_term_place *place = &assembly->places[constraint->term_begin + t];
            place->slot_i = place_body(assembly, begin, free_of(assembly, term->body_i));
            place->slot_j = place_body(assembly, begin, free_of(assembly, term->body_j));
        }
        for (uint32_t b = constraint->user_first;
             se3di_is_user(constraint) && b < constraint->body_count; ++b) {
            (void)place_body(assembly, begin, free_of(assembly, constraint->bodies[b]));
        }
    }
    assembly->joint_begin[assembly->constraint_count] = (int32_t)assembly->joint_body_count;
}

/* C is stored joint by joint, one block of rows x block for each body of the joint. */
static void place_blocks(se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        for (int32_t b = assembly->joint_begin[k]; b < assembly->joint_begin[k + 1]; ++b) {
            assembly->block_offset[b] = assembly->joint_value_count;
            assembly->joint_value_count +=
                (size_t)(assembly->joint_rows[k] * assembly->formulation->block);
        }
    }
}

#define STRUCTURE_ARRAYS 11
#define VALUE_ARRAYS     5

static void list_structure(se3di_assembly *a, se3di_array list[STRUCTURE_ARRAYS])
{
    const se3di_array arrays[] = {
        {(void **)&a->free_body, a->dense_count, sizeof *a->free_body},
        {(void **)&a->free_index, a->dense_count, sizeof *a->free_index},
        {(void **)&a->joint_rows, a->constraint_count, sizeof *a->joint_rows},
        {(void **)&a->joint_begin, a->constraint_count + 1, sizeof *a->joint_begin},
        {(void **)&a->joint_body, 2 * (size_t)a->place_count, sizeof *a->joint_body},
        {(void **)&a->places, a->place_count, sizeof *a->places},
        {(void **)&a->block_offset, 2 * (size_t)a->place_count, sizeof *a->block_offset},
        {(void **)&a->is_fused, a->constraint_count, sizeof *a->is_fused},
        {(void **)&a->timed_rows, a->row_count, sizeof *a->timed_rows},
        {(void **)&a->armature, a->armature_count, sizeof *a->armature},
        {(void **)&a->armature_pair, 2 * (size_t)a->armature_count, sizeof *a->armature_pair},
    };
    _Static_assert(sizeof arrays == STRUCTURE_ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void list_values(se3di_assembly *a, se3di_array list[VALUE_ARRAYS])
{
    size_t block = (size_t)a->formulation->block;
    const se3di_array arrays[] = {
        {(void **)&a->H, a->body_count * block * block, sizeof *a->H},
        {(void **)&a->H_pair, a->armature_count * block * block, sizeof *a->H_pair},
        {(void **)&a->C, a->joint_value_count, sizeof *a->C},
        {(void **)&a->f, 3 * (size_t)a->row_count, sizeof *a->f},
        {(void **)&a->wrench, 6 * (size_t)a->dense_count, sizeof *a->wrench},
    };
    _Static_assert(sizeof arrays == VALUE_ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

void se3di_assembly_take_values(se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        assembly->f[3 * (size_t)k] = assembly->model->rows[k].value;
    }
}

/* Rows that change with time, the values of the others, and joints that are evaluated as one. */
static void sort_rows(se3di_assembly *assembly)
{
    se3di_assembly_take_values(assembly);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        const se3di_row *row = &assembly->model->rows[k];
        if (row->function >= 0 && !(row->left_out & SE3DI_ROW_BROKEN)) {
            assembly->timed_rows[assembly->timed_count++] = k;
        }
    }
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        assembly->is_fused[k] = (int8_t)se3di_fused_fits(assembly, k);
    }
}

/* Room for the bodies of a user constraint is counted in places, two bodies each. */
static void count_users(se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->constraint_count; ++k) {
        assembly->user_count += (uint32_t)se3di_is_user(&assembly->model->constraints[k]);
    }
    assembly->place_count += assembly->user_count * (SE3DI_NODE_BODIES_MAX / 2);
}

static se3d_status build(se3di_assembly *assembly)
{
    const se3d_allocator *allocator = &assembly->model->allocator;
    se3di_array structure[STRUCTURE_ARRAYS];
    se3di_array values[VALUE_ARRAYS];
    count_users(assembly);
    se3di_armatures_count(assembly);
    list_structure(assembly, structure);
    SE3DI_TRY(se3di_arrays_alloc(allocator, structure, STRUCTURE_ARRAYS));
    number_bodies(assembly);
    build_pattern(assembly);
    se3di_armatures_list(assembly);
    assembly->unknown_count = assembly->body_count * (uint32_t)assembly->formulation->block;
    place_blocks(assembly);
    list_values(assembly, values);
    SE3DI_TRY(se3di_arrays_alloc(allocator, values, VALUE_ARRAYS));
    sort_rows(assembly);
    return SE3D_OK;
}

se3d_status se3di_assembly_init(se3di_assembly *assembly, se3di_model *model,
                                const se3di_formulation *formulation, int moves_states,
                                se3di_error *error)
{
    *assembly = (se3di_assembly){
        .model = model,
        .moves_states = moves_states,
        .formulation = formulation,
        .topology_version = model->topology_version,
        .break_version = model->break_version,
        .row_count = (uint32_t)model->row_count,
        .constraint_count = (uint32_t)model->constraint_slots.count,
        .place_count = (uint32_t)model->term_count,
        .dense_count = (uint32_t)model->body_slots.count,
        .time = model->time,
    };
    model->user_failure = (se3di_user_failure){0};
    se3d_status status = build(assembly);
    if (status < 0) {
        se3di_assembly_destroy(assembly);
        se3di_error_set(error, status, "no memory for the equations of %zu bodies",
                        model->body_slots.count);
    }
    return status;
}

void se3di_assembly_destroy(se3di_assembly *assembly)
{
    if (!assembly->model) {
        return;
    }
    const se3d_allocator *allocator = &assembly->model->allocator;
    se3di_array structure[STRUCTURE_ARRAYS];
    se3di_array values[VALUE_ARRAYS];
    list_values(assembly, values);
    se3di_arrays_free(allocator, values, VALUE_ARRAYS);
    list_structure(assembly, structure);
    se3di_arrays_free(allocator, structure, STRUCTURE_ARRAYS);
    memset(assembly, 0, sizeof *assembly);
}

void se3di_row_name(const se3di_model *model, uint32_t row, char *text, size_t size)
{
    uint32_t k = se3di_row_get_owner(model, row);
    const se3di_constraint *constraint = &model->constraints[k];
    if (constraint->name) {
        snprintf(text, size, "%.80s.%s", constraint->name, model->rows[row].name);
    } else {
        snprintf(text, size, "%s %u.%s", constraint->type, k, model->rows[row].name);
    }
}
