/* SPDX-License-Identifier: BSD-3-Clause */
/* Adding and removing materials and shapes. */
#include "model/edit.h"

#include <string.h>

static se3d_status own_block(const se3d_allocator *allocator, const void *original, size_t count,
                             size_t size, void **copy)
{
    *copy = NULL;
    if (count == 0) {
        return SE3D_OK;
    }
    *copy = se3di_alloc(allocator, count, size);
    if (!*copy) {
        return SE3D_ERR_NO_MEMORY;
    }
    memcpy(*copy, original, count * size);
    return SE3D_OK;
}

void se3di_shape_release(const se3d_allocator *allocator, se3di_shape *shape)
{
    for (size_t k = 0; k < shape->piece_count; ++k) { /* which have no pieces themselves */
        se3di_shape_release(allocator, &shape->pieces[k]);
    }
    se3di_free(allocator, shape->pieces, shape->piece_count, sizeof *shape->pieces);
    shape->pieces = NULL;
    shape->piece_count = 0;
    se3di_text_free(allocator, shape->name);
    se3di_free(allocator, shape->vertices, 3 * shape->vertex_count, sizeof(double));
    se3di_free(allocator, shape->triangles, 3 * shape->triangle_count, sizeof(uint32_t));
    se3di_free(allocator, shape->planes, shape->planes ? 4 * shape->triangle_count : 0,
               sizeof(double));
    se3di_free(allocator, shape->tree, shape->tree_bytes, 1);
    shape->name = NULL;
    shape->vertices = NULL;
    shape->triangles = NULL;
    shape->planes = NULL;
    shape->tree = NULL;
    shape->vertex_count = shape->triangle_count = shape->tree_bytes = 0;
}

static se3d_status own_pieces(const se3d_allocator *allocator, const se3di_shape *from,
                              se3di_shape *shape)
{
    shape->pieces = NULL;
    shape->piece_count = 0;
    if (from->piece_count == 0) {
        return SE3D_OK;
    }
    shape->pieces = se3di_alloc(allocator, from->piece_count, sizeof *shape->pieces);
    if (!shape->pieces) {
        return SE3D_ERR_NO_MEMORY;
    }
    shape->piece_count = from->piece_count;
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < from->piece_count && status >= 0; ++k) {
        shape->pieces[k] = from->pieces[k];
        status = se3di_shape_own(allocator, &shape->pieces[k]);
    }
    return status;
}

se3d_status se3di_shape_own(const se3d_allocator *allocator, se3di_shape *shape)
{
    const se3di_shape from = *shape;
    void *vertices, *triangles, *planes, *tree;
    shape->name = from.name ? se3di_text_copy(allocator, from.name) : NULL;
    se3d_status status = from.name && !shape->name ? SE3D_ERR_NO_MEMORY : SE3D_OK;
    /* every pointer is written, so that a release is safe */
    if (own_block(allocator, from.vertices, 3 * from.vertex_count, sizeof(double), &vertices) < 0 ||
        status < 0) {
        status = SE3D_ERR_NO_MEMORY;
    }
    if (own_block(allocator, from.triangles, 3 * from.triangle_count, sizeof(uint32_t),
                  &triangles) < 0) {
        status = SE3D_ERR_NO_MEMORY;
    }
    if (own_block(allocator, from.planes, from.planes ? 4 * from.triangle_count : 0, sizeof(double),
                  &planes) < 0) {
        status = SE3D_ERR_NO_MEMORY;
    }
    if (own_block(allocator, from.tree, from.tree_bytes, 1, &tree) < 0) {
        status = SE3D_ERR_NO_MEMORY;
    }
    shape->vertices = vertices;
    shape->triangles = triangles;
    shape->planes = planes;
    shape->tree = tree;
    if (own_pieces(allocator, &from, shape) < 0) {
        status = SE3D_ERR_NO_MEMORY;
    }
    if (status < 0) {
        se3di_shape_release(allocator, shape);
    }
    return status;
}

se3d_status se3di_model_add_shape(se3di_model *model, const se3di_shape *shape,
                                  se3di_handle *handle)
{
    size_t count = model->shape_slots.count;
    SE3DI_RESERVE(model, shapes, shape_capacity, count + 1, sizeof *model->shapes);
    SE3DI_TRY(se3di_slots_reserve(&model->shape_slots, &model->allocator));
    SE3DI_TRY(se3di_names_reserve(&model->shape_slots.names, &model->allocator, count + 1));
    se3di_shape copy = *shape;
    SE3DI_TRY(se3di_shape_own(&model->allocator, &copy));
    copy.users = 0;
    model->shapes[count] = copy;
    ++model->bodies[copy.body].users;
    if (copy.material >= 0) {
        ++model->materials[copy.material].users;
    }
    *handle = se3di_slots_add(&model->shape_slots);
    if (copy.name) {
        se3di_slots_name(&model->shape_slots, (uint32_t)count, 0, copy.name);
    }
    se3di_model_touch(model);
    return SE3D_OK;
}

void se3di_model_remove_shape(se3di_model *model, uint32_t shape)
{
    se3di_shape *gone = &model->shapes[shape];
    --model->bodies[gone->body].users;
    if (gone->material >= 0) {
        --model->materials[gone->material].users;
    }
    if (gone->name) {
        se3di_names_remove(&model->shape_slots.names, 0, gone->name);
    }
    se3di_shape_release(&model->allocator, gone);
    se3di_array_close_gap(model->shapes, model->shape_slots.count, shape, 1, sizeof *gone);
    se3di_slots_remove(&model->shape_slots, shape);
    se3di_model_touch(model);
}

void se3di_model_set_shape_material(se3di_model *model, uint32_t shape, int32_t material)
{
    const int32_t before = model->shapes[shape].material;
    if (before >= 0) {
        --model->materials[before].users;
    }
    if (material >= 0) {
        ++model->materials[material].users;
    }
    model->shapes[shape].material = material;
    se3di_model_touch(model);
}

se3d_status se3di_model_add_material(se3di_model *model, const se3di_material *material,
                                     se3di_handle *handle)
{
    static const se3di_override none = SE3DI_OVERRIDE_NONE;
    size_t n = model->material_slots.count;
    size_t m = n + 1;
    char *name;
    SE3DI_RESERVE(model, materials, material_capacity, m, sizeof *model->materials);
    SE3DI_RESERVE(model, overrides, override_capacity, m * m, sizeof *model->overrides);
    SE3DI_RESERVE(model, pairs, pair_capacity, m * m, sizeof *model->pairs);
    SE3DI_TRY(se3di_slots_reserve(&model->material_slots, &model->allocator));
    SE3DI_TRY(se3di_model_copy_name(model, &model->material_slots, material->name, &name));
    for (size_t k = m * m; k-- > 0;) { /* rows become longer, from the last one on */
        size_t row = k / m;
        size_t column = k % m;
        model->overrides[k] = row < n && column < n ? model->overrides[row * n + column] : none;
    }
    model->materials[n] = *material;
    model->materials[n].name = name;
    model->materials[n].users = 0;
    *handle = se3di_model_add_named(&model->material_slots, 0, name);
    return SE3D_OK;
}

void se3di_model_remove_material(se3di_model *model, uint32_t material)
{
    size_t n = model->material_slots.count;
    size_t to = 0;
    char *name = model->materials[material].name;
    for (size_t k = 0; k < n * n; ++k) {
        if (k / n != material && k % n != material) {
            model->overrides[to++] = model->overrides[k];
        }
    }
    se3di_array_close_gap(model->materials, n, material, 1, sizeof *model->materials);
    se3di_model_remove_named(model, &model->material_slots, material, 0, name);
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        se3di_index_lower_signed(&model->shapes[k].material, material);
    }
}

void se3di_model_set_override(se3di_model *model, uint32_t a, uint32_t b,
                              const se3di_override *over)
{
    size_t n = model->material_slots.count;
    model->overrides[a * n + b] = *over;
    model->overrides[b * n + a] = *over;
    se3di_model_touch_contact(model);
}

void se3di_model_set_contact(se3di_model *model, const se3di_contact_settings *settings)
{
    model->contact = *settings;
    se3di_model_touch_contact(model);
}
