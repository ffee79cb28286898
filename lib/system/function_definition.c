/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: definitions of functions, as they can be given again. */
#include "model/function.h"
#include "model/integral.h"
#include "model/state.h"
#include "system/definition.h"

#include <string.h>

static se3d_status find(const se3d_system *system, se3d_function function, const void *out,
                        const se3di_function **data)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, function), SE3DI_HANDLE(function), out, &index));
    *data = &system->model.functions[index];
    return SE3D_OK;
}

se3d_status se3d_function_get_def(const se3d_system *system, se3d_function function,
                                  se3d_function_def *def)
{
    const se3di_function *data;
    SE3DI_TRY(find(system, function, def, &data));
    se3d_function_def full = se3d_function_def_default();
    full.struct_size = def->struct_size;
    full.variable_count = data->variable_count;
    full.compiled = data->expression;
    full.callback = data->callback;
    full.ctx = data->ctx;
    full.constant = data->constant;
    full.signal_count = data->signal_count;
    if (data->table) {
        full.table_x = data->table;
        full.table_y = data->table + data->table_count;
        full.table_count = data->table_count;
        full.table_kind = data->table_kind;
        full.table_periodic = data->table_periodic;
    }
    if (data->integral) {
        full.integrate = 1;
        full.start = data->integral->start;
        full.start_time = data->integral->origin;
    }
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_function_get_signal(const se3d_system *system, se3d_function function, size_t k,
                                     se3d_signal *signal)
{
    if (signal) {
        *signal = (se3d_signal){.kind = 0};
    }
    const se3di_function *data;
    SE3DI_TRY(find(system, function, signal, &data));
    if (k >= data->signal_count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_model *model = &system->model;
    const se3di_signal *from = &data->signals[k];
    signal->kind = from->kind;
    signal->component = from->component;
    if (from->kind == SE3D_SIGNAL_STATE) {
        const se3d_force state = se3di_force_handle(model, (int32_t)from->force);
        signal->state = (se3d_state){state.index1, state.generation};
        return SE3D_OK;
    }
    if (from->joint != SE3DI_NO_INDEX) {
        signal->joint = se3di_constraint_handle(model, (int32_t)from->joint);
        return SE3D_OK;
    }
    if (from->force != SE3DI_NO_INDEX) {
        signal->force = se3di_force_handle(model, (int32_t)from->force);
        return SE3D_OK;
    }
    signal->body = se3di_body_handle(model, from->body);
    memcpy(signal->point, from->point, sizeof signal->point);
    return SE3D_OK;
}

size_t se3d_system_count_functions(const se3d_system *system)
{
    return system ? system->model.function_slots.count : 0;
}

se3d_status se3d_system_get_function(const se3d_system *system, size_t index,
                                     se3d_function *function)
{
    return se3di_read_handle(SE3DI_SLOTS(system, function), index, function);
}
