/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: wheels. */
#include "se3d/wheel.h"

#include "analysis/wheel.h"
#include "math/vec3.h"
#include "system/definition.h"
#include "system/system_internal.h"

#include <string.h>

void se3d_wheel_def_init(se3d_wheel_def *def, size_t size)
{
    se3d_wheel_def defaults = {.struct_size = size,
                               .axis = {0.0, 1.0, 0.0},
                               .forward = {1.0, 0.0, 0.0},
                               .up = {0.0, 0.0, 1.0}};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static int is_null(uint32_t index1, uint32_t generation)
{
    return index1 == 0 && generation == 0;
}

/* Constraints, spring and opposite wheel, which may be null. */
static se3d_status take_relations(se3d_system *system, const se3d_wheel_def *def,
                                  se3di_wheel *wheel)
{
    uint32_t index;
    const uint32_t replaced =
        se3di_model_find_replaced(&system->model, &system->model.wheel_slots, 0, def->name);
    wheel->travel = wheel->steering = wheel->spring = wheel->opposite = -1;
    if (!is_null(def->travel.index1, def->travel.generation)) {
        SE3DI_TRY(se3di_find_constraint(system, "travel", def->travel, &index));
        wheel->travel = (int32_t)index;
    }
    if (!is_null(def->steering.index1, def->steering.generation)) {
        SE3DI_TRY(se3di_find_constraint(system, "steering", def->steering, &index));
        wheel->steering = (int32_t)index;
    }
    if (!is_null(def->spring.index1, def->spring.generation)) {
        SE3DI_TRY(se3di_find_force(system, "spring", def->spring, &index));
        if (system->model.forces[index].type != SE3DI_FORCE_TSDA) {
            return SE3DI_FAIL_OF(system, "spring", SE3D_ERR_INVALID_ARGUMENT, " must be a tsda");
        }
        wheel->spring = (int32_t)index;
    }
    if (!is_null(def->opposite.index1, def->opposite.generation)) {
        SE3DI_TRY(se3di_find_wheel(system, "opposite", def->opposite, &index));
        if (index == replaced) {
            return SE3DI_FAIL_OF(system, "opposite", SE3D_ERR_INVALID_ARGUMENT,
                                 " is the wheel itself, must be another one");
        }
        const int32_t across = system->model.wheels[index].opposite;
        if (across >= 0 && (uint32_t)across != replaced) {
            return SE3DI_FAIL_OF(system, "opposite", SE3D_ERR_INVALID_ARGUMENT,
                                 " has an opposite wheel already, must be another one");
        }
        if (system->model.wheels[index].chassis != wheel->chassis) {
            return SE3DI_FAIL_OF(system, "opposite", SE3D_ERR_INVALID_ARGUMENT,
                                 " must be on the same chassis");
        }
        wheel->opposite = (int32_t)index;
    }
    return SE3D_OK;
}

/* Vehicle axes in the frame of the chassis. */
static se3d_status take_vehicle(se3d_system *system, const se3d_wheel_def *def, se3di_wheel *wheel)
{
    SE3DI_TRY(se3di_check_axes(system, def->forward, "up", def->up, wheel->vehicle));
    se3di_mul(system->model.frames[wheel->chassis].A, wheel->vehicle + 6, wheel->road);
    return SE3D_OK;
}

static se3d_status take_numbers(se3d_system *system, const se3d_wheel_def *def, se3di_wheel *wheel)
{
    const double large = 1e40;
    SE3DI_TRY(se3di_check_finites(system, "center", def->center, 3));
    SE3DI_TRY(se3di_check_finites(system, "steer_lower", def->steer_lower, 3));
    SE3DI_TRY(se3di_check_finites(system, "steer_upper", def->steer_upper, 3));
    SE3DI_TRY(se3di_check_range(system, "radius", def->radius, 1e-40, large));
    SE3DI_TRY(se3di_check_range(system, "width", def->width, 0.0, large));
    SE3DI_TRY(se3di_check_range(system, "wheelbase", def->wheelbase, 0.0, large));
    SE3DI_TRY(se3di_check_range(system, "cg_height", def->cg_height, 0.0, large));
    SE3DI_TRY(se3di_check_range(system, "brake_share", def->brake_share, 0.0, 1.0));
    SE3DI_TRY(se3di_check_range(system, "drive_share", def->drive_share, 0.0, 1.0));
    SE3DI_TRY(se3di_check_direction(system, "axis", def->axis, wheel->axis));
    se3di_copy(def->center, wheel->center);
    se3di_copy(def->steer_lower, wheel->lower);
    se3di_copy(def->steer_upper, wheel->upper);
    wheel->radius = def->radius;
    wheel->width = def->width;
    wheel->wheelbase = def->wheelbase;
    wheel->cg_height = def->cg_height;
    wheel->brake_share = def->brake_share;
    wheel->drive_share = def->drive_share;
    return SE3D_OK;
}

/* The axis lies across the vehicle, not upright. */
static se3d_status check_axis(se3d_system *system, const double given[3], const se3di_wheel *wheel)
{
    double axis[3];
    double along[3];
    se3di_mul(system->model.frames[wheel->body].A, wheel->axis, axis);
    se3di_mul(system->model.frames[wheel->chassis].A, wheel->vehicle + 3, along);
    if (se3di_dot(axis, along) * se3di_dot(axis, along) < 1e-6) {
        return SE3DI_FAIL_OF(
            system, "axis", SE3D_ERR_INVALID_ARGUMENT,
            " = (%g, %g, %g) is perpendicular to the vehicle's left, must point out "
            "of the vehicle: to the left on a left wheel",
            given[0], given[1], given[2]);
    }
    return SE3D_OK;
}

se3d_status se3d_wheel_create(se3d_system *system, const se3d_wheel_def *def, se3d_wheel *wheel)
{
    SE3DI_CREATE(system, wheel);
    se3d_wheel_def full = se3d_wheel_def_default();
    se3di_wheel data = {0};
    SE3DI_TRY(se3di_check_def(system, "wheel def", def, &full, sizeof full));
    SE3DI_TRY(se3di_find_body(system, "body", full.body, &data.body));
    SE3DI_TRY(se3di_find_body(system, "chassis", full.chassis, &data.chassis));
    if (data.body == data.chassis) {
        return SE3DI_FAIL_OF(system, "chassis", SE3D_ERR_INVALID_ARGUMENT,
                             " is the wheel's own body, must be another one");
    }
    SE3DI_TRY(se3di_check_new_name(system, &system->model.wheel_slots, 0, "wheel", full.name));
    SE3DI_TRY(take_numbers(system, &full, &data));
    SE3DI_TRY(take_vehicle(system, &full, &data));
    SE3DI_TRY(check_axis(system, full.axis, &data));
    SE3DI_TRY(take_relations(system, &full, &data));
    se3di_wheel_place(&system->model, &data, data.center0, data.contact0);
    memcpy(&data.name, &full.name, sizeof data.name); /* copied by the model */
    se3di_handle handle = {0, 0};
    const se3d_status added = se3di_model_add_wheel(&system->model, &data, &handle);
    return se3di_give_created(system, added, "a wheel", handle, wheel);
}

se3d_status se3d_wheel_destroy(se3d_system *system, se3d_wheel wheel)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_wheel(system, "wheel", wheel, &index));
    se3di_model_remove_wheel(&system->model, index);
    return SE3D_OK;
}

se3d_status se3d_wheel_get_name(const se3d_system *system, se3d_wheel wheel, const char **name)
{
    uint32_t index;
    const se3d_status status =
        se3di_read_index(SE3DI_SLOTS(system, wheel), SE3DI_HANDLE(wheel), name, &index);
    return se3di_give_name(status, status < 0 ? NULL : system->model.wheels[index].name, name);
}

se3d_status se3d_wheel_find(const se3d_system *system, const char *name, se3d_wheel *wheel)
{
    return se3di_read_named(SE3DI_SLOTS(system, wheel), name, wheel);
}

se3d_status se3d_wheel_get_measures(const se3d_system *system, se3d_wheel wheel, size_t first,
                                    size_t count, double *values)
{
    uint32_t index;
    double all[SE3D_WHEEL_MEASURES] = {0.0};
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, wheel), SE3DI_HANDLE(wheel), values, &index));
    if (count == 0 || first >= SE3D_WHEEL_MEASURES || count > SE3D_WHEEL_MEASURES - first) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    memset(values, 0, count * sizeof *values);
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    SE3DI_TRY(
        se3di_read_end(&reading, se3di_wheel_measure(&system->model, index, first, count, all)));
    memcpy(values, all + first, count * sizeof *values);
    return SE3D_OK;
}

size_t se3d_system_count_wheels(const se3d_system *system)
{
    return system ? system->model.wheel_slots.count : 0;
}

se3d_status se3d_system_get_wheel(const se3d_system *system, size_t index, se3d_wheel *wheel)
{
    return se3di_read_handle(SE3DI_SLOTS(system, wheel), index, wheel);
}

se3d_status se3d_wheel_get_def(const se3d_system *system, se3d_wheel wheel, se3d_wheel_def *def)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, wheel), SE3DI_HANDLE(wheel), def, &index));
    const se3di_model *model = &system->model;
    const se3di_wheel *data = &model->wheels[index];
    se3d_wheel_def full = se3d_wheel_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.body = se3di_body_handle(model, data->body);
    full.chassis = se3di_body_handle(model, data->chassis);
    se3di_copy(data->center, full.center);
    se3di_copy(data->axis, full.axis);
    se3di_copy(data->vehicle, full.forward);
    se3di_copy(data->vehicle + 6, full.up);
    full.radius = data->radius;
    full.width = data->width;
    se3di_copy(data->lower, full.steer_lower);
    se3di_copy(data->upper, full.steer_upper);
    full.travel = se3di_constraint_handle(model, data->travel);
    full.steering = se3di_constraint_handle(model, data->steering);
    full.spring = se3di_force_handle(model, data->spring);
    full.opposite = se3di_wheel_handle(model, data->opposite);
    full.wheelbase = data->wheelbase;
    full.cg_height = data->cg_height;
    full.brake_share = data->brake_share;
    full.drive_share = data->drive_share;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}
