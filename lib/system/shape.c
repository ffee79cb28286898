/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes: creation and queries. */
#include "contact/shape/shape.h"

#include "math/quaternion.h"
#include "math/vec3.h"
#include "particles/energy.h"
#include "system/definition.h"
#include "system/particles.h"

#include <math.h>
#include <string.h>

void se3d_shape_def_init(se3d_shape_def *def, size_t size)
{
    se3d_shape_def defaults = {
        .struct_size = size, .orientation = {1.0, 0.0, 0.0, 0.0}, .group = 1, .mask = UINT32_MAX};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

/* What all kinds have: body, material, name, pose. */
static se3d_status read_common(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    double p[4];
    if (def->body.index1 != 0 || def->body.generation != 0) {
        SE3DI_TRY(se3di_find_body(system, "body", def->body, &shape->body));
    }
    shape->material = -1;
    if (def->material.index1 != 0 || def->material.generation != 0) {
        uint32_t material;
        SE3DI_TRY(se3di_find_material(system, "material", def->material, &material));
        shape->material = (int32_t)material;
    }
    SE3DI_TRY(se3di_check_new_name(system, &system->model.shape_slots, 0, "shape", def->name));
    SE3DI_TRY(se3di_check_finites(system, "position", def->position, 3));
    SE3DI_TRY(se3di_check_finites(system, "surface_velocity", def->surface_velocity, 3));
    SE3DI_TRY(se3di_check_finites(system, "surface_spin", def->surface_spin, 3));
    se3di_copy(def->surface_velocity, shape->surface_velocity);
    se3di_copy(def->surface_spin, shape->surface_spin);
    SE3DI_TRY(se3di_check_orientation(system, "orientation", def->orientation, p));
    memcpy(&shape->name, &def->name, sizeof shape->name); /* copied by the model */
    se3di_copy(def->position, shape->x);
    se3di_quat_to_matrix(p, shape->A);
    memcpy(shape->p, p, sizeof shape->p);
    shape->group = def->group;
    shape->mask = def->mask;
    return SE3D_OK;
}

static se3d_status create(se3d_system *system, const char *function, const se3d_shape_def *def,
                          se3di_shape_kind kind, se3d_shape *out)
{
    if (out) {
        *out = (se3d_shape){0, 0};
    }
    SE3DI_TRY(se3di_enter(system, SE3DI_BUSY_FREE, function));
    SE3DI_TRY(se3di_check_pointer(system, "shape", out));
    se3d_shape_def full = se3d_shape_def_default();
    se3di_shape shape = {.kind = (int32_t)kind};
    SE3DI_TRY(se3di_check_def(system, "shape def", def, &full, sizeof full));
    SE3DI_TRY(read_common(system, &full, &shape));
    se3d_status status =
        se3di_shape_define(&full, &system->model.allocator, &shape, &system->error);
    if (status < 0) {
        return se3di_log_error(&system->error, status);
    }
    se3di_handle handle = {0, 0};
    status = se3di_model_add_shape(&system->model, &shape, &handle);
    shape.name = NULL; /* the caller's */
    se3di_shape_release(&system->model.allocator, &shape);
    return se3di_give_created(system, status, "a shape", handle, out);
}

#define CREATE(KIND, name, traits)                                                                 \
    se3d_status se3d_shape_create_##name(se3d_system *system, const se3d_shape_def *def,           \
                                         se3d_shape *shape)                                        \
    {                                                                                              \
        return create(system, __func__, def, SE3DI_SHAPE_##KIND, shape);                           \
    }
SE3DI_SHAPE_LIST(CREATE)
#undef CREATE

static se3d_status find_shape(se3d_system *system, se3d_shape shape, uint32_t *index)
{
    *index = se3di_slots_find(&system->model.shape_slots, shape.index1, shape.generation);
    if (*index == SE3DI_NO_INDEX) {
        return SE3DI_FAIL(system, SE3D_ERR_STALE_HANDLE, "shape %s",
                          shape.index1 == 0 ? "is the null handle"
                                            : "was destroyed or belongs to another system");
    }
    return SE3D_OK;
}

se3d_status se3d_shape_destroy(se3d_system *system, se3d_shape shape)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(find_shape(system, shape, &index));
    se3di_model_remove_shape(&system->model, index);
    return SE3D_OK;
}

se3d_status se3d_shape_set_surface_motion(se3d_system *system, se3d_shape shape,
                                          const double velocity[3], const double spin[3])
{
    SE3DI_SET(system);
    uint32_t index;
    SE3DI_TRY(find_shape(system, shape, &index));
    SE3DI_TRY(se3di_check_pointer(system, "velocity", velocity));
    SE3DI_TRY(se3di_check_pointer(system, "spin", spin));
    SE3DI_TRY(se3di_check_finites(system, "velocity", velocity, 3));
    SE3DI_TRY(se3di_check_finites(system, "spin", spin, 3));
    se3di_copy(velocity, system->model.shapes[index].surface_velocity);
    se3di_copy(spin, system->model.shapes[index].surface_spin);
    se3di_model_touch_contact(&system->model);
    return SE3D_OK;
}

se3d_status se3d_shape_set_material(se3d_system *system, se3d_shape shape, se3d_material material)
{
    SE3DI_EDIT(system);
    uint32_t index, other = 0;
    const int is_null = material.index1 == 0 && material.generation == 0;
    SE3DI_TRY(find_shape(system, shape, &index));
    SE3DI_TRY(is_null ? SE3D_OK : se3di_find_material(system, "material", material, &other));
    se3di_model_set_shape_material(&system->model, index, is_null ? -1 : (int32_t)other);
    return SE3D_OK;
}

se3d_status se3d_shape_set_filter(se3d_system *system, se3d_shape shape, uint32_t group,
                                  uint32_t mask)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(find_shape(system, shape, &index));
    system->model.shapes[index].group = group;
    system->model.shapes[index].mask = mask;
    se3di_model_touch(&system->model);
    return SE3D_OK;
}

static se3d_status find_reader(const se3d_system *system, se3d_shape shape, const void *out,
                               const se3di_shape **data)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, shape), SE3DI_HANDLE(shape), out, &index));
    *data = &system->model.shapes[index];
    return SE3D_OK;
}

se3d_status se3d_shape_get_surface_motion(const se3d_system *system, se3d_shape shape,
                                          double velocity[3], double spin[3])
{
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, velocity ? spin : NULL, &data));
    se3di_copy(data->surface_velocity, velocity);
    se3di_copy(data->surface_spin, spin);
    return SE3D_OK;
}

se3d_status se3d_shape_find(const se3d_system *system, const char *name, se3d_shape *shape)
{
    return se3di_read_named(SE3DI_SLOTS(system, shape), name, shape);
}

se3d_status se3d_shape_get_name(const se3d_system *system, se3d_shape shape, const char **name)
{
    const se3di_shape *data = NULL;
    const se3d_status status = find_reader(system, shape, name, &data);
    return se3di_give_name(status, data ? data->name : NULL, name);
}

se3d_status se3d_shape_get_body(const se3d_system *system, se3d_shape shape, se3d_body *body)
{
    if (body) {
        *body = (se3d_body){0, 0};
    }
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, body, &data));
    return se3d_system_get_body(system, data->body, body);
}

/* Of the particles of all sets. */
static void add_particles(const se3d_system *system, se3d_shape shape, double force[3],
                          double torque[3])
{
    const se3di_handle handle = {shape.index1, shape.generation};
    for (const se3di_particles *set = system->model.sets; set; set = set->next) {
        se3di_particles_push_shape(set, handle, force, torque);
    }
}

se3d_status se3d_shape_get_wrench(const se3d_system *system, se3d_shape shape, double force[3],
                                  double torque[3])
{
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, torque ? force : NULL, &data));
    se3di_copy(data->force, force);
    se3di_copy(data->torque, torque);
    add_particles(system, shape, force, torque);
    return SE3D_OK;
}

se3d_status se3d_body_get_contact_wrench(const se3d_system *system, se3d_body body, double force[3],
                                         double torque[3])
{
    if (!system || !force || !torque) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    uint32_t index = se3di_slots_find(&model->body_slots, body.index1, body.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    memset(force, 0, 3 * sizeof *force);
    memset(torque, 0, 3 * sizeof *torque);
    for (uint32_t k = 0; k < model->shape_slots.count; ++k) {
        if (model->shapes[k].body == index) {
            se3di_handle handle = se3di_slots_handle(&model->shape_slots, k);
            se3di_add(force, model->shapes[k].force, force);
            se3di_add(torque, model->shapes[k].torque, torque);
            add_particles(system, (se3d_shape){handle.index1, handle.generation}, force, torque);
        }
    }
    return SE3D_OK;
}

se3d_status se3d_shape_get_nearest(const se3d_system *system, se3d_shape shape,
                                   const double position[3], double point[3], double normal[3],
                                   double *distance)
{
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, position && point && normal ? distance : NULL, &data));
    if (!se3di_is_finite(position, 3)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_floats host = se3di_floats_set();
    se3di_shape_pose pose;
    se3di_shape_place(data, &system->model.frames[data->body], &pose);
    double d[3], local[3], n[3], at[3];
    se3di_sub(position, pose.x, d);
    se3di_mul_transposed(pose.R, d, local);
    se3di_shape_nearest(data, local, at, n, distance);
    se3di_mul(pose.R, n, normal);
    se3di_mul(pose.R, at, point);
    se3di_add(pose.x, point, point);
    se3di_floats_restore(host);
    return SE3D_OK;
}

size_t se3d_system_count_shapes(const se3d_system *system)
{
    return system ? system->model.shape_slots.count : 0;
}

se3d_status se3d_system_get_shape(const se3d_system *system, size_t index, se3d_shape *shape)
{
    return se3di_read_handle(SE3DI_SLOTS(system, shape), index, shape);
}

se3d_status se3d_shape_get_type(const se3d_system *system, se3d_shape shape, int32_t *type)
{
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, type, &data));
    *type = data->kind;
    return SE3D_OK;
}

static void give_lengths(const se3di_shape *data, se3d_shape_def *def)
{
    def->length = 2.0 * data->half_length;
    if (data->kind == SE3DI_SHAPE_ELLIPSOID) {
        se3di_copy(data->half, def->semi_axes);
        return;
    }
    se3di_scale(2.0, data->half, def->size);
    if (data->kind == SE3DI_SHAPE_FUNNEL) {
        def->bottom_radius = data->radius;
        def->top_radius = data->top_radius;
    } else {
        def->radius = data->radius;
    }
}

se3d_status se3d_shape_get_def(const se3d_system *system, se3d_shape shape, se3d_shape_def *def)
{
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, def, &data));
    const se3di_model *model = &system->model;
    se3d_shape_def full = se3d_shape_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.body = se3di_body_handle(model, data->body);
    full.material = se3di_material_handle(model, data->material);
    se3di_copy(data->x, full.position);
    if (se3di_is_unit(data->p, 4)) {
        memcpy(full.orientation, data->p, sizeof full.orientation);
    } else { /* a plane that was given its normal */
        full.normal[0] = data->A[2];
        full.normal[1] = data->A[5];
        full.normal[2] = data->A[8];
    }
    give_lengths(data, &full);
    full.group = data->group;
    full.mask = data->mask;
    full.row_count = data->rows;
    full.column_count = data->columns;
    memcpy(full.spacing, data->spacing, sizeof full.spacing);
    se3di_copy(data->surface_velocity, full.surface_velocity);
    se3di_copy(data->surface_spin, full.surface_spin);
    if (data->kind != SE3DI_SHAPE_FUNNEL) { /* whose facets follow from its radii */
        full.vertices = data->vertices;
        full.vertex_count = data->vertex_count;
    }
    if (data->kind == SE3DI_SHAPE_MESH) { /* those of a hull follow from its vertices */
        full.triangles = data->triangles;
        full.triangle_count = data->triangle_count;
    }
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}
