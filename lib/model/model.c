/* SPDX-License-Identifier: BSD-3-Clause */
/* Life of a model: empty, destroyed, copied. */
#include "model/model.h"

#include "math/quaternion.h"
#include "math/vec3.h"
#include "model/function.h"

#include <string.h>

se3d_status se3di_model_init(se3di_model *model, const se3d_allocator *allocator, uint32_t salt)
{
    memset(model, 0, sizeof *model);
    model->allocator = *allocator;
    model->gravity_function[0] = model->gravity_function[1] = model->gravity_function[2] = -1;
    se3di_slots *slots[] = {&model->body_slots,       &model->marker_slots, &model->function_slots,
                            &model->constraint_slots, &model->force_slots,  &model->material_slots,
                            &model->shape_slots,      &model->wheel_slots,  &model->road_slots};
    for (size_t k = 0; k < sizeof slots / sizeof slots[0]; ++k) {
        se3di_slots_init(slots[k], salt);
    }
    model->contact.overlap_limit = 0.2;
    char name[] = "ground";
    se3di_body ground = {.name = name, .fixed = 1};
    se3di_frame frame = {.p = {1.0, 0.0, 0.0, 0.0}};
    se3di_frame_update(&frame);
    se3di_handle handle;
    se3d_status status = se3di_model_add_body(model, &ground, &frame, &handle);
    if (status < 0) {
        se3di_model_destroy(model);
    }
    return status;
}

static void destroy_names(se3di_model *model)
{
    const se3d_allocator *allocator = &model->allocator;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        se3di_text_free(allocator, model->bodies[k].name);
    }
    for (size_t k = 0; k < model->marker_slots.count; ++k) {
        se3di_text_free(allocator, model->markers[k].name);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        se3di_text_free(allocator, model->constraints[k].name);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_text_free(allocator, model->forces[k].name);
    }
    for (size_t k = 0; k < model->wheel_slots.count; ++k) {
        se3di_text_free(allocator, model->wheels[k].name);
    }
    for (size_t k = 0; k < model->road_slots.count; ++k) {
        se3di_text_free(allocator, model->roads[k].name);
    }
}

/* Every growing array of the model: where it is, its capacity and the size of an element. */
typedef struct model_array {
    void **data;
    size_t *capacity;
    size_t count, size;
} model_array;

#define MODEL_ARRAYS 23

static void list_arrays(se3di_model *m, model_array list[MODEL_ARRAYS])
{
    size_t bodies = m->body_slots.count;
    se3di_body_contacts *c = &m->contacts;
    size_t materials = m->material_slots.count;
    const size_t listed = c->version == m->topology_version ? m->shape_slots.count : 0;
    model_array arrays[] = {
        {(void **)&m->bodies, &m->body_capacity, bodies, sizeof *m->bodies},
        {(void **)&m->frames, &m->frame_capacity, bodies, sizeof *m->frames},
        {(void **)&m->acceleration, &m->acceleration_capacity, bodies, 6 * sizeof *m->acceleration},
        {(void **)&m->markers, &m->marker_capacity, m->marker_slots.count, sizeof *m->markers},
        {(void **)&m->functions, &m->function_capacity, m->function_slots.count,
         sizeof *m->functions},
        {(void **)&m->constraints, &m->constraint_capacity, m->constraint_slots.count,
         sizeof *m->constraints},
        {(void **)&m->rows, &m->row_capacity, m->row_count, sizeof *m->rows},
        {(void **)&m->terms, &m->term_capacity, m->term_count, sizeof *m->terms},
        {(void **)&m->angles, &m->angle_capacity, m->angle_count, sizeof *m->angles},
        {(void **)&m->lambda, &m->lambda_capacity, m->row_count, sizeof *m->lambda},
        {(void **)&m->forces, &m->force_capacity, m->force_slots.count, sizeof *m->forces},
        {(void **)&m->materials, &m->material_capacity, materials, sizeof *m->materials},
        {(void **)&m->overrides, &m->override_capacity, materials * materials,
         sizeof *m->overrides},
        {(void **)&m->pairs, &m->pair_capacity, materials * materials, sizeof *m->pairs},
        {(void **)&m->shapes, &m->shape_capacity, m->shape_slots.count, sizeof *m->shapes},
        {(void **)&m->wheels, &m->wheel_capacity, m->wheel_slots.count, sizeof *m->wheels},
        {(void **)&m->roads, &m->road_capacity, m->road_slots.count, sizeof *m->roads},
        {(void **)&c->list, &c->capacity, c->count, sizeof *c->list},
        {(void **)&c->next, &c->next_capacity, 0, sizeof *c->next},
        {(void **)&c->pairs, &c->pair_capacity, listed > 0 ? c->pair_count : 0,
         2 * sizeof *c->pairs},
        {(void **)&c->reference, &c->reference_capacity, listed, 3 * sizeof *c->reference},
        {(void **)&c->order, &c->order_capacity, listed, sizeof *c->order},
        {(void **)&m->history, &m->history_capacity, m->history_count, sizeof *m->history},
    };
    _Static_assert(sizeof arrays == MODEL_ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void destroy_slots(se3di_model *model)
{
    se3di_slots_destroy(&model->body_slots, &model->allocator);
    se3di_slots_destroy(&model->marker_slots, &model->allocator);
    se3di_slots_destroy(&model->function_slots, &model->allocator);
    se3di_slots_destroy(&model->constraint_slots, &model->allocator);
    se3di_slots_destroy(&model->force_slots, &model->allocator);
    se3di_slots_destroy(&model->material_slots, &model->allocator);
    se3di_slots_destroy(&model->shape_slots, &model->allocator);
    se3di_slots_destroy(&model->wheel_slots, &model->allocator);
    se3di_slots_destroy(&model->road_slots, &model->allocator);
}

void se3di_model_destroy(se3di_model *model)
{
    const se3d_allocator *allocator = &model->allocator;
    destroy_names(model);
    for (size_t k = 0; k < model->function_slots.count; ++k) {
        se3di_function_release(allocator, &model->functions[k]);
    }
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        se3di_shape_release(allocator, &model->shapes[k]);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        se3di_force_release(allocator, &model->forces[k]);
    }
    for (size_t k = 0; k < model->road_slots.count; ++k) {
        se3di_road_release(allocator, &model->roads[k]);
    }
    model_array arrays[MODEL_ARRAYS];
    list_arrays(model, arrays);
    for (int k = 0; k < MODEL_ARRAYS; ++k) {
        se3di_free(allocator, *arrays[k].data, *arrays[k].capacity, arrays[k].size);
    }
    destroy_slots(model);
    se3d_allocator kept = model->allocator;
    memset(model, 0, sizeof *model);
    model->allocator = kept;
}

/* Forget what a copied structure does not own yet, so that destroying it is safe at any moment. */
static void disown(se3di_model *copy)
{
    model_array arrays[MODEL_ARRAYS];
    list_arrays(copy, arrays);
    for (int k = 0; k < MODEL_ARRAYS; ++k) {
        *arrays[k].data = NULL;
        *arrays[k].capacity = 0;
    }
    se3di_slots_init(&copy->body_slots, 0);
    se3di_slots_init(&copy->marker_slots, 0);
    se3di_slots_init(&copy->function_slots, 0);
    se3di_slots_init(&copy->constraint_slots, 0);
    se3di_slots_init(&copy->force_slots, 0);
    se3di_slots_init(&copy->material_slots, 0);
    se3di_slots_init(&copy->shape_slots, 0);
    se3di_slots_init(&copy->wheel_slots, 0);
    se3di_slots_init(&copy->road_slots, 0);
    copy->sets = NULL;
    copy->pending = NULL;
    copy->row_count = copy->term_count = copy->angle_count = copy->history_count = 0;
    copy->contacts.count = copy->contacts.pair_count = 0;
    copy->contacts.version = 0;
}

static se3d_status copy_name(const se3d_allocator *allocator, char **name)
{
    const char *original = *name;
    *name = NULL;
    if (original) {
        *name = se3di_text_copy(allocator, original);
    }
    return original && !*name ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}

/* The arrays hold the original's names: replace each by a copy; those not reached become NULL. */
static se3d_status copy_names(se3di_model *copy)
{
    const se3d_allocator *allocator = &copy->allocator;
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < copy->body_slots.count; ++k) {
        status = copy_name(allocator, &copy->bodies[k].name) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->marker_slots.count; ++k) {
        status = copy_name(allocator, &copy->markers[k].name) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->constraint_slots.count; ++k) {
        status = copy_name(allocator, &copy->constraints[k].name) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->force_slots.count; ++k) {
        status = copy_name(allocator, &copy->forces[k].name) < 0 ? SE3D_ERR_NO_MEMORY : status;
        status = se3di_force_own(allocator, &copy->forces[k]) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->wheel_slots.count; ++k) {
        status = copy_name(allocator, &copy->wheels[k].name) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->road_slots.count; ++k) {
        status = copy_name(allocator, &copy->roads[k].name) < 0 ? SE3D_ERR_NO_MEMORY : status;
        status = se3di_road_own(allocator, &copy->roads[k]) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->function_slots.count; ++k) {
        status =
            se3di_function_own(allocator, &copy->functions[k]) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->shape_slots.count; ++k) {
        status = se3di_shape_own(allocator, &copy->shapes[k]) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    return status;
}

static void list_name(se3di_slots *slots, size_t dense, uint32_t owner, const char *name)
{
    if (name) {
        se3di_slots_name(slots, (uint32_t)dense, owner, name);
    }
}

/* A copy has its names, and room to find them. */
static void list_names(se3di_model *copy)
{
    for (size_t k = 0; k < copy->body_slots.count; ++k) {
        list_name(&copy->body_slots, k, 0, copy->bodies[k].name);
    }
    for (size_t k = 0; k < copy->marker_slots.count; ++k) {
        list_name(&copy->marker_slots, k, se3di_model_owner(copy, copy->markers[k].body),
                  copy->markers[k].name);
    }
    for (size_t k = 0; k < copy->constraint_slots.count; ++k) {
        list_name(&copy->constraint_slots, k, 0, copy->constraints[k].name);
    }
    for (size_t k = 0; k < copy->force_slots.count; ++k) {
        list_name(&copy->force_slots, k, 0, copy->forces[k].name);
    }
    for (size_t k = 0; k < copy->shape_slots.count; ++k) {
        list_name(&copy->shape_slots, k, 0, copy->shapes[k].name);
    }
    for (size_t k = 0; k < copy->wheel_slots.count; ++k) {
        list_name(&copy->wheel_slots, k, 0, copy->wheels[k].name);
    }
    for (size_t k = 0; k < copy->road_slots.count; ++k) {
        list_name(&copy->road_slots, k, 0, copy->roads[k].name);
    }
}

static se3d_status clone_slots(const se3di_model *model, se3di_model *copy)
{
    const se3d_allocator *allocator = &copy->allocator;
    SE3DI_TRY(se3di_slots_clone(&model->body_slots, allocator, &copy->body_slots));
    SE3DI_TRY(se3di_slots_clone(&model->marker_slots, allocator, &copy->marker_slots));
    SE3DI_TRY(se3di_slots_clone(&model->function_slots, allocator, &copy->function_slots));
    SE3DI_TRY(se3di_slots_clone(&model->constraint_slots, allocator, &copy->constraint_slots));
    SE3DI_TRY(se3di_slots_clone(&model->force_slots, allocator, &copy->force_slots));
    SE3DI_TRY(se3di_slots_clone(&model->material_slots, allocator, &copy->material_slots));
    SE3DI_TRY(se3di_slots_clone(&model->shape_slots, allocator, &copy->shape_slots));
    SE3DI_TRY(se3di_slots_clone(&model->wheel_slots, allocator, &copy->wheel_slots));
    SE3DI_TRY(se3di_slots_clone(&model->road_slots, allocator, &copy->road_slots));
    return SE3D_OK;
}

static se3d_status clone_arrays(const se3di_model *model, se3di_model *copy)
{
    se3di_model original = *model; /* list_arrays only takes addresses of its members */
    model_array from[MODEL_ARRAYS];
    model_array to[MODEL_ARRAYS];
    list_arrays(&original, from);
    list_arrays(copy, to);
    for (int k = 0; k < MODEL_ARRAYS; ++k) {
        SE3DI_TRY(se3di_array_reserve(&copy->allocator, to[k].data, to[k].capacity, from[k].count,
                                      from[k].size));
    }
    for (int k = 0; k < MODEL_ARRAYS; ++k) {
        if (from[k].count > 0) {
            memcpy(*to[k].data, *from[k].data, from[k].count * from[k].size);
        }
    }
    copy->row_count = model->row_count;
    copy->term_count = model->term_count;
    copy->angle_count = model->angle_count;
    copy->history_count = model->history_count;
    copy->contacts.count = model->contacts.count;
    if (model->contacts.version == model->topology_version) {
        copy->contacts.pair_count = model->contacts.pair_count;
        copy->contacts.version = model->contacts.version;
    }
    return SE3D_OK;
}

se3d_status se3di_model_clone(const se3di_model *model, se3di_model *copy)
{
    *copy = *model;
    copy->replaces = 0;
    copy->target = 0;
    disown(copy);
    se3di_model slots = *copy; /* slot counts stay zero in `copy` until its arrays are filled */
    se3d_status status = clone_slots(model, &slots);
    if (status == SE3D_OK) {
        status = clone_arrays(model, copy);
    }
    if (status < 0) {
        destroy_slots(&slots);
        se3di_model_destroy(copy);
        return status;
    }
    copy->body_slots = slots.body_slots;
    copy->marker_slots = slots.marker_slots;
    copy->function_slots = slots.function_slots;
    copy->constraint_slots = slots.constraint_slots;
    copy->force_slots = slots.force_slots;
    copy->material_slots = slots.material_slots;
    copy->shape_slots = slots.shape_slots;
    copy->wheel_slots = slots.wheel_slots;
    copy->road_slots = slots.road_slots;
    status = copy_names(copy);
    if (status < 0) {
        se3di_model_destroy(copy);
        return status;
    }
    list_names(copy);
    return SE3D_OK;
}

void se3di_model_save_memory(const se3di_model *model, double *memory)
{
    for (size_t k = 0; k < model->force_slots.count; ++k, memory += SE3DI_FORCE_STATES) {
        memcpy(memory, model->forces[k].state, sizeof model->forces[k].state);
    }
}

void se3di_model_restore_memory(se3di_model *model, const double *memory)
{
    for (size_t k = 0; k < model->force_slots.count; ++k, memory += SE3DI_FORCE_STATES) {
        memcpy(model->forces[k].state, memory, sizeof model->forces[k].state);
    }
}
