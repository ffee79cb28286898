/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: creation and queries. */
#include "force/force.h"

#include "math/vec3.h"
#include "system/system_internal.h"

#include <string.h>

void se3d_tsda_def_init(se3d_tsda_def *def, size_t size)
{
    se3d_tsda_def defaults = {.struct_size = size};
    if (def && size >= sizeof size) {
        memset(def, 0, size);
        memcpy(def, &defaults, size < sizeof defaults ? size : sizeof defaults);
    }
}

void se3d_rsda_def_init(se3d_rsda_def *def, size_t size)
{
    se3d_rsda_def defaults = {.struct_size = size};
    if (def && size >= sizeof size) {
        memset(def, 0, size);
        memcpy(def, &defaults, size < sizeof defaults ? size : sizeof defaults);
    }
}

void se3d_load_def_init(se3d_load_def *def, size_t size)
{
    se3d_load_def defaults = {.struct_size = size};
    if (def && size >= sizeof size) {
        memset(def, 0, size);
        memcpy(def, &defaults, size < sizeof defaults ? size : sizeof defaults);
    }
}

/* What every creation starts with. */
static se3d_status begin(se3d_system *system, se3d_force *force)
{
    if (force) {
        *force = (se3d_force){0, 0};
    }
    return system ? se3di_check_pointer(system, "force", force) : SE3D_ERR_NULL;
}

static se3di_force blank(int32_t type, const char *name)
{
    se3di_force data = {.type = type, .function = {-1, -1, -1}, .joint = -1, .angle = -1};
    memcpy(&data.name, &name, sizeof data.name); /* copied by the model */
    return data;
}

static se3d_status add(se3d_system *system, const se3di_force *data, se3d_force *force)
{
    se3di_handle handle;
    if (se3di_model_add_force(&system->model, data, &handle) < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a force element");
    }
    *force = (se3d_force){handle.index1, handle.generation};
    return SE3D_OK;
}

se3d_status se3d_force_create_tsda(se3d_system *system, const se3d_tsda_def *def, se3d_force *force)
{
    SE3DI_TRY(begin(system, force));
    se3d_tsda_def full = se3d_tsda_def_default();
    SE3DI_TRY(se3di_check_def(system, "tsda def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_force_name(system, full.name));
    se3di_force data = blank(SE3DI_FORCE_TSDA, full.name);
    SE3DI_TRY(se3di_find_body(system, "body_i", full.body_i, &data.body_i));
    SE3DI_TRY(se3di_find_body(system, "body_j", full.body_j, &data.body_j));
    SE3DI_TRY(se3di_check_finites(system, "point_i", full.point_i, 3));
    SE3DI_TRY(se3di_check_finites(system, "point_j", full.point_j, 3));
    SE3DI_TRY(se3di_check_finite(system, "k", full.k));
    SE3DI_TRY(se3di_check_finite(system, "c", full.c));
    SE3DI_TRY(se3di_check_finite(system, "l0", full.l0));
    SE3DI_TRY(se3di_find_function(system, "h", full.h, 3, &data.function[0]));
    if (full.l0 < 0.0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT, "l0 = %g m, must be >= 0", full.l0);
    }
    if (data.body_i == data.body_j) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "body_i and body_j are the same body, must differ");
    }
    data.k = full.k;
    data.c = full.c;
    data.rest = full.l0;
    se3di_copy(full.point_i, data.s_i);
    se3di_copy(full.point_j, data.s_j);
    return add(system, &data, force);
}

se3d_status se3d_force_create_rsda(se3d_system *system, const se3d_rsda_def *def, se3d_force *force)
{
    SE3DI_TRY(begin(system, force));
    se3d_rsda_def full = se3d_rsda_def_default();
    SE3DI_TRY(se3di_check_def(system, "rsda def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_force_name(system, full.name));
    se3di_force data = blank(SE3DI_FORCE_RSDA, full.name);
    uint32_t joint;
    SE3DI_TRY(se3di_find_constraint(system, "joint", full.joint, &joint));
    SE3DI_TRY(se3di_check_finite(system, "k", full.k));
    SE3DI_TRY(se3di_check_finite(system, "c", full.c));
    SE3DI_TRY(se3di_check_finite(system, "theta0", full.theta0));
    SE3DI_TRY(se3di_find_function(system, "h", full.h, 3, &data.function[0]));
    const se3di_constraint *constraint = &system->model.constraints[joint];
    if (constraint->angle < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "joint %s is a %s joint, must be one with an angle",
                          constraint->name ? constraint->name : "without a name", constraint->type);
    }
    data.joint = (int32_t)joint;
    data.angle = constraint->angle;
    data.body_i = constraint->bodies[0];
    data.body_j = constraint->bodies[1];
    data.k = full.k;
    data.c = full.c;
    data.rest = full.theta0;
    return add(system, &data, force);
}

static se3d_status create_load(se3d_system *system, const se3d_load_def *def, int32_t type,
                               se3d_force *force)
{
    SE3DI_TRY(begin(system, force));
    se3d_load_def full = se3d_load_def_default();
    SE3DI_TRY(se3di_check_def(system, "load def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_force_name(system, full.name));
    se3di_force data = blank(type, full.name);
    SE3DI_TRY(se3di_find_body(system, "body", full.body, &data.body_j));
    SE3DI_TRY(se3di_check_finites(system, "point", full.point, 3));
    SE3DI_TRY(se3di_check_finites(system, "value", full.value, 3));
    for (int c = 0; c < 3; ++c) {
        SE3DI_TRY(se3di_find_function(system, "function", full.function[c], 1, &data.function[c]));
    }
    data.body_i = 0;
    data.in_body_frame = full.in_body_frame != 0;
    se3di_copy(full.point, data.s_j);
    se3di_copy(full.value, data.value);
    return add(system, &data, force);
}

se3d_status se3d_force_create_load(se3d_system *system, const se3d_load_def *def, se3d_force *force)
{
    return create_load(system, def, SE3DI_FORCE_LOAD, force);
}

se3d_status se3d_force_create_torque(se3d_system *system, const se3d_load_def *def,
                                     se3d_force *force)
{
    return create_load(system, def, SE3DI_FORCE_TORQUE, force);
}

se3d_status se3d_force_destroy(se3d_system *system, se3d_force force)
{
    if (!system) {
        return SE3D_ERR_NULL;
    }
    uint32_t index;
    SE3DI_TRY(se3di_find_force(system, "force", force, &index));
    se3di_model_remove_force(&system->model, index);
    return SE3D_OK;
}

se3d_status se3d_force_find(const se3d_system *system, const char *name, se3d_force *force)
{
    if (force) {
        *force = (se3d_force){0, 0};
    }
    if (!system || !name || !force) {
        return SE3D_ERR_NULL;
    }
    for (size_t k = 0; k < system->model.force_slots.count; ++k) {
        const char *other = system->model.forces[k].name;
        if (other && strcmp(other, name) == 0) {
            return se3d_system_get_force(system, k, force);
        }
    }
    return SE3D_ERR_INVALID_ARGUMENT;
}

static se3d_status find_reader(const se3d_system *system, se3d_force force, const void *out,
                               const se3di_force **data)
{
    if (!system || !out) {
        return SE3D_ERR_NULL;
    }
    uint32_t index = se3di_slots_find(&system->model.force_slots, force.index1, force.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    *data = &system->model.forces[index];
    return SE3D_OK;
}

se3d_status se3d_force_get_name(const se3d_system *system, se3d_force force, const char **name)
{
    if (name) {
        *name = NULL;
    }
    const se3di_force *data;
    SE3DI_TRY(find_reader(system, force, name, &data));
    *name = data->name ? data->name : "";
    return SE3D_OK;
}

se3d_status se3d_force_get_type(const se3d_system *system, se3d_force force, const char **type)
{
    if (type) {
        *type = NULL;
    }
    const se3di_force *data;
    SE3DI_TRY(find_reader(system, force, type, &data));
    *type = se3di_force_type_name(data->type);
    return SE3D_OK;
}

se3d_status se3d_force_get_state(const se3d_system *system, se3d_force force, double *coordinate,
                                 double *rate, double *value)
{
    const se3di_force *data;
    se3di_spring_state state;
    SE3DI_TRY(find_reader(system, force, system, &data));
    const se3di_model *model = &system->model;
    if (data->type == SE3DI_FORCE_TSDA) {
        SE3DI_TRY(se3di_tsda_state(model, data, model->time, &state));
    } else if (data->type == SE3DI_FORCE_RSDA) {
        SE3DI_TRY(se3di_rsda_state(model, data, model->time, &state));
    } else {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    if (coordinate) {
        *coordinate = state.coordinate;
    }
    if (rate) {
        *rate = state.rate;
    }
    if (value) {
        *value = state.value;
    }
    return SE3D_OK;
}
