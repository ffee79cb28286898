/* SPDX-License-Identifier: BSD-3-Clause */
/* Life of a model: empty, destroyed, copied. */
#include "model/model.h"

#include "base/shelf.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "model/function.h"

#include <stddef.h>
#include <string.h>

/* A kind of elements: its slots and its array in the model, its names. */
typedef struct kind {
    size_t slots, elements; /* offsets in the model */
    size_t size, name;      /* of an element; where its name is in it */
    int has_name;
} kind;

#define NAMED(slots, elements, type)                                                               \
    {                                                                                              \
        offsetof(se3di_model, slots), offsetof(se3di_model, elements), sizeof(type),               \
            offsetof(type, name), 1                                                                \
    }
#define BARE(slots, elements, type)                                                                \
    {                                                                                              \
        offsetof(se3di_model, slots), offsetof(se3di_model, elements), sizeof(type), 0, 0          \
    }

/* Names of shapes belong to the shapes: the last kind, so that the others come first. */
static const kind kinds[] = {
    NAMED(body_slots, bodies, se3di_body),
    NAMED(marker_slots, markers, se3di_marker),
    NAMED(constraint_slots, constraints, se3di_constraint),
    NAMED(force_slots, forces, se3di_force),
    NAMED(wheel_slots, wheels, se3di_wheel),
    NAMED(road_slots, roads, se3di_road),
    BARE(function_slots, functions, se3di_function),
    NAMED(material_slots, materials, se3di_material),
    NAMED(shape_slots, shapes, se3di_shape),
};
enum { KINDS = sizeof kinds / sizeof *kinds, SHAPES = KINDS - 1 };

static se3di_slots *slots_of(se3di_model *model, int k)
{
    return (void *)((char *)model + kinds[k].slots);
}

/* The place of the name of an element; NULL: such elements have none. */
static char **name_of(se3di_model *model, int k, size_t index)
{
    char *elements;
    memcpy(&elements, (char *)model + kinds[k].elements, sizeof elements);
    return kinds[k].has_name ? (void *)(elements + index * kinds[k].size + kinds[k].name) : NULL;
}

se3d_status se3di_model_init(se3di_model *model, const se3d_allocator *allocator, uint32_t salt)
{
    memset(model, 0, sizeof *model);
    model->allocator = *allocator;
    model->gravity_function[0] = model->gravity_function[1] = model->gravity_function[2] = -1;
    for (int k = 0; k < KINDS; ++k) {
        se3di_slots_init(slots_of(model, k), salt);
    }
    model->contact.overlap_limit = 0.2;
    model->shelf = se3di_shelf_create(allocator);
    char name[] = "ground";
    se3di_body ground = {.name = name, .fixed = 1};
    se3di_frame frame = {.p = {1.0, 0.0, 0.0, 0.0}};
    se3di_frame_update(&frame);
    se3di_handle handle;
    se3d_status status =
        model->shelf ? se3di_model_add_body(model, &ground, &frame, &handle) : SE3D_ERR_NO_MEMORY;
    if (status < 0) {
        se3di_model_destroy(model);
    }
    return status;
}

static void destroy_names(se3di_model *model)
{
    for (int k = 0; k < SHAPES; ++k) {
        for (size_t i = 0; kinds[k].has_name && i < slots_of(model, k)->count; ++i) {
            se3di_text_free(&model->allocator, *name_of(model, k, i));
        }
    }
}

/* Every growing array of the model: where it is, its capacity and the size of an element. */
typedef struct model_array {
    void **data;
    size_t *capacity;
    size_t count, size;
} model_array;

#define MODEL_ARRAYS 27

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
        {(void **)&c->swept, &c->swept_capacity, 0, 4 * sizeof *c->swept},
        {(void **)&c->joints, &c->joints_capacity, 0, sizeof *c->joints},
        {(void **)&c->joint_begin, &c->begin_capacity, 0, sizeof *c->joint_begin},
        {&c->met, &c->met_bytes, 0, 1},
        {(void **)&m->history, &m->history_capacity, m->history_count, sizeof *m->history},
    };
    _Static_assert(sizeof arrays == MODEL_ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void destroy_slots(se3di_model *model)
{
    for (int k = 0; k < KINDS; ++k) {
        se3di_slots_destroy(slots_of(model, k), &model->allocator);
    }
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
    se3di_shelf_drop(model->shelf);
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
    for (int k = 0; k < KINDS; ++k) {
        se3di_slots_init(slots_of(copy, k), 0);
    }
    copy->sets = NULL;
    copy->pending = NULL;
    se3di_shelf_keep(copy->shelf);
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
    for (int k = 0; k < SHAPES; ++k) {
        for (size_t i = 0; kinds[k].has_name && i < slots_of(copy, k)->count; ++i) {
            status = copy_name(allocator, name_of(copy, k, i)) < 0 ? SE3D_ERR_NO_MEMORY : status;
        }
    }
    for (size_t k = 0; k < copy->force_slots.count; ++k) {
        status = se3di_force_own(allocator, &copy->forces[k]) < 0 ? SE3D_ERR_NO_MEMORY : status;
    }
    for (size_t k = 0; k < copy->road_slots.count; ++k) {
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

/* A copy has its names, and room to find them. */
static void list_names(se3di_model *copy)
{
    for (int k = 0; k < KINDS; ++k) {
        se3di_slots *slots = slots_of(copy, k);
        for (size_t i = 0; kinds[k].has_name && i < slots->count; ++i) {
            const char *name = *name_of(copy, k, i);
            const uint32_t owner =
                slots == &copy->marker_slots ? se3di_model_owner(copy, copy->markers[i].body) : 0;
            if (name) {
                se3di_slots_name(slots, (uint32_t)i, owner, name);
            }
        }
    }
}

static se3d_status clone_slots(se3di_model *model, se3di_model *copy)
{
    for (int k = 0; k < KINDS; ++k) {
        SE3DI_TRY(se3di_slots_clone(slots_of(model, k), &copy->allocator, slots_of(copy, k)));
    }
    return SE3D_OK;
}

static se3d_status clone_arrays(se3di_model *model, se3di_model *copy)
{
    model_array from[MODEL_ARRAYS];
    model_array to[MODEL_ARRAYS];
    list_arrays(model, from);
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
    se3di_model original = *model; /* of it only addresses of members are taken */
    se3di_model slots = *copy;     /* slot counts stay zero in `copy` until its arrays are filled */
    se3d_status status = clone_slots(&original, &slots);
    if (status == SE3D_OK) {
        status = clone_arrays(&original, copy);
    }
    if (status < 0) {
        destroy_slots(&slots);
        se3di_model_destroy(copy);
        return status;
    }
    for (int k = 0; k < KINDS; ++k) {
        *slots_of(copy, k) = *slots_of(&slots, k);
    }
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
