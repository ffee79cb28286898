/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: definitions of bodies, markers, roads and constraints, as they can be given again.
 * What a definition left to be chosen (reference directions, a distance, the value of a gear) is
 * what it became. */
#include "system/definition.h"

#include "force/driver_rate.h"
#include "joint/equation.h"
#include "joint/joint.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <string.h>

#define TWO_PI 6.283185307179586476925286766559

se3d_body se3di_body_handle(const se3di_model *model, uint32_t body)
{
    const se3di_handle handle = se3di_slots_handle(&model->body_slots, body);
    return (se3d_body){handle.index1, handle.generation};
}

#define HANDLE_OF(element)                                                                         \
    se3d_##element se3di_##element##_handle(const se3di_model *model, int32_t element)             \
    {                                                                                              \
        se3di_handle handle = {0, 0};                                                              \
        if (element >= 0) {                                                                        \
            handle = se3di_slots_handle(&model->element##_slots, (uint32_t)element);               \
        }                                                                                          \
        return (se3d_##element){handle.index1, handle.generation};                                 \
    }

HANDLE_OF(constraint)
HANDLE_OF(force)
HANDLE_OF(function)
HANDLE_OF(material)
HANDLE_OF(road)
HANDLE_OF(wheel)
#undef HANDLE_OF

double se3di_angle_origin(const se3di_model *model, uint32_t angle)
{
    const se3di_angle *counter = &model->angles[angle];
    const double principal = se3di_term_value(model, &counter->term); /* in (-pi, pi] */
    const double past = se3di_angle_value(model, angle) - counter->offset - principal;
    const double turns = se3di_nearest(past / TWO_PI);
    return turns == 0.0 ? counter->offset : counter->offset + TWO_PI * turns;
}

se3d_status se3d_marker_get_def(const se3d_system *system, se3d_marker marker, se3d_marker_def *def)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, marker), SE3DI_HANDLE(marker), def, &index));
    const se3di_marker *data = &system->model.markers[index];
    se3d_marker_def full = se3d_marker_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.body = se3di_body_handle(&system->model, data->body);
    memcpy(full.position, data->s, sizeof full.position);
    memcpy(full.orientation, data->p, sizeof full.orientation);
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

/* The constraint of a reader. */
static se3d_status find(const se3d_system *system, se3d_constraint handle, const void *def,
                        const se3di_constraint **constraint)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, constraint), SE3DI_HANDLE(handle), def, &index));
    *constraint = &system->model.constraints[index];
    return SE3D_OK;
}

int se3di_is_joint_type(const char *type)
{
    int found = 0;
    for (int k = 0; k < SE3DI_JOINT_TYPE_COUNT; ++k) {
        found |= strcmp(se3di_joint_types[k].name, type) == 0;
    }
    return found;
}

se3d_status se3d_joint_get_def(const se3d_system *system, se3d_constraint joint,
                               se3d_joint_def *def)
{
    const se3di_constraint *data;
    SE3DI_TRY(find(system, joint, def, &data));
    if (!se3di_is_joint_type(data->type)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_model *model = &system->model;
    const se3di_joint_frames *f = &data->frames;
    se3d_joint_def full = se3d_joint_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.body_i = se3di_body_handle(model, data->bodies[0]);
    full.body_j = se3di_body_handle(model, data->bodies[1]);
    se3di_copy(f->point_i, full.point_i);
    se3di_copy(f->point_j, full.point_j);
    se3di_copy(f->axis_i, full.axis_i);
    se3di_copy(f->axis_j, full.axis_j);
    se3di_copy(f->ref_i, full.ref_i);
    se3di_copy(f->ref_j, full.ref_j);
    full.angle0 = data->angle >= 0 ? se3di_angle_origin(model, (uint32_t)data->angle) : 0.0;
    full.pitch = data->pitch;
    full.distance = data->distance;
    full.break_force = data->break_limit[0];
    full.break_moment = data->break_limit[1];
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

static int32_t coordinate_of(const se3di_term *term)
{
    return term->type == SE3DI_PRIMITIVE_ANGLE ? SE3D_JOINT_COORDINATE_ANGLE
                                               : SE3D_JOINT_COORDINATE_DISPLACEMENT;
}

se3d_status se3d_coupler_get_def(const se3d_system *system, se3d_constraint coupler,
                                 se3d_coupler_def *def)
{
    const se3di_constraint *data;
    SE3DI_TRY(find(system, coupler, def, &data));
    if (strcmp(data->type, "coupler") != 0 && strcmp(data->type, "gear") != 0 &&
        strcmp(data->type, "rack_pinion") != 0) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_model *model = &system->model;
    const se3di_row *row = &model->rows[data->row_begin];
    se3d_coupler_def full = se3d_coupler_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.count = row->term_count;
    full.value = row->value;
    full.function = se3di_function_handle(model, row->function);
    for (uint32_t k = 0; k < row->term_count; ++k) {
        const se3di_term *term = &model->terms[row->term_begin + k];
        full.joint[k] = se3di_constraint_handle(model, data->joints[k]);
        full.coordinate[k] = coordinate_of(term);
        full.ratio[k] = term->coefficient;
    }
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_driver_get_def(const se3d_system *system, se3d_constraint driver,
                                se3d_driver_def *def)
{
    const se3di_constraint *data;
    SE3DI_TRY(find(system, driver, def, &data));
    if (strcmp(data->type, "driver") != 0) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_model *model = &system->model;
    const se3di_row *row = &model->rows[data->row_begin];
    se3d_driver_def full = se3d_driver_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.joint = se3di_constraint_handle(model, data->joints[0]);
    full.coordinate =
        data->law >= 0 ? data->coordinate : coordinate_of(&model->terms[row->term_begin]);
    full.value = row->value;
    full.function = se3di_function_handle(model, data->law >= 0 ? data->law : row->function);
    full.is_rate = se3di_is_driver_rate(data);
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

static int32_t primitive_of(const char *type)
{
    static const char *const names[] = {"dp1", "dp2", "d", "cd"};
    for (int32_t k = SE3D_PRIMITIVE_DP1; k <= SE3D_PRIMITIVE_CD; ++k) {
        if (strcmp(names[k], type) == 0) {
            return k;
        }
    }
    return -1;
}

se3d_status se3d_primitive_get_def(const se3d_system *system, se3d_constraint primitive,
                                   se3d_primitive_def *def)
{
    const se3di_constraint *data;
    SE3DI_TRY(find(system, primitive, def, &data));
    const int32_t type = primitive_of(data->type);
    if (type < 0) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_model *model = &system->model;
    const se3di_row *row = &model->rows[data->row_begin];
    const se3di_term *term = &model->terms[row->term_begin];
    se3d_primitive_def full = se3d_primitive_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.type = type;
    full.body_i = se3di_body_handle(model, data->bodies[0]);
    full.body_j = se3di_body_handle(model, data->bodies[1]);
    se3di_copy(term->a_i, full.a_i);
    se3di_copy(term->a_j, full.a_j);
    se3di_copy(term->s_i, full.point_i);
    se3di_copy(term->s_j, full.point_j);
    se3di_copy(term->c, full.c);
    full.value = row->value;
    full.function = se3di_function_handle(model, row->function);
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_user_constraint_get_def(const se3d_system *system, se3d_constraint constraint,
                                         se3d_user_constraint_def *def)
{
    const se3di_constraint *data;
    SE3DI_TRY(find(system, constraint, def, &data));
    if (!data->callback) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3d_user_constraint_def full = se3d_user_constraint_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.callback = data->callback;
    full.ctx = data->ctx;
    full.body_count = (int32_t)(data->body_count - data->user_first);
    full.equation_count = (int32_t)data->row_count;
    for (uint32_t k = 0; k < data->body_count - data->user_first; ++k) {
        full.bodies[k] = se3di_body_handle(&system->model, data->bodies[data->user_first + k]);
    }
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_body_get_def(const se3d_system *system, se3d_body body, se3d_body_def *def)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, body), SE3DI_HANDLE(body), def, &index));
    const se3di_body *data = &system->model.bodies[index];
    const se3di_frame *frame = &system->model.frames[index];
    se3d_body_def full = se3d_body_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.mass = data->mass;
    memcpy(full.inertia, data->J, sizeof full.inertia);
    se3di_copy(frame->r, full.position);
    memcpy(full.orientation, frame->p, sizeof full.orientation);
    se3di_copy(frame->v, full.velocity);
    se3di_copy(frame->w, full.angular_velocity);
    full.fixed = data->fixed;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_road_get_def(const se3d_system *system, se3d_road road, se3d_road_def *def)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, road), SE3DI_HANDLE(road), def, &index));
    const se3di_road *data = &system->model.roads[index];
    se3d_road_def full = se3d_road_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.body = se3di_body_handle(&system->model, data->body);
    se3di_copy(data->point, full.point);
    se3di_copy(data->axes + 6, full.normal);
    se3di_copy(data->axes, full.forward);
    full.height = se3di_function_handle(&system->model, data->function);
    full.heights = data->heights;
    full.row_count = data->rows;
    full.column_count = data->columns;
    memcpy(full.spacing, data->cell, sizeof full.spacing);
    full.vertices = data->points;
    full.vertex_count = data->point_count;
    full.triangles = data->triangles;
    full.triangle_count = data->triangle_count;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}
