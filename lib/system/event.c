/* SPDX-License-Identifier: BSD-3-Clause */
/* Events: validation and delegation to the run. */
#include "se3d/event.h"

#include "system/solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

void se3d_event_def_init(se3d_event_def *def, size_t size)
{
    const se3d_event_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_numbers(se3d_system *system, const se3d_event_def *def)
{
    SE3DI_TRY(se3di_check_finite(system, "level", def->level));
    SE3DI_TRY(se3di_check_range(system, "hysteresis", def->hysteresis, 0.0, DBL_MAX));
    if (def->direction < SE3D_EVENT_FALLING || def->direction > SE3D_EVENT_RISING) {
        return SE3DI_FAIL_OF(system, "direction", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be one of se3d_event_direction", (int)def->direction);
    }
    if (def->action < SE3D_EVENT_RECORD || def->action > SE3D_EVENT_STOP) {
        return SE3DI_FAIL_OF(system, "action", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be SE3D_EVENT_RECORD or _STOP", (int)def->action);
    }
    return SE3D_OK;
}

static se3d_status check_name(const se3d_solver *solver, const char *name)
{
    const se3di_events *events = &solver->run.events;
    if (!name) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_name(solver->system, name));
    for (size_t k = 0; k < events->slots.count; ++k) {
        if (events->list[k].name && strcmp(events->list[k].name, name) == 0) {
            return SE3DI_FAIL(solver->system, SE3D_ERR_INVALID_ARGUMENT,
                              "name: there is an event named '%.64s' already", name);
        }
    }
    return SE3D_OK;
}

static se3d_status check_analysis(const se3d_solver *solver)
{
    const int32_t analysis = solver->run.analysis;
    if (!se3di_analysis_is(analysis, SE3DI_ANALYSIS_HAS_MOTION)) {
        return SE3DI_FAIL_OF(solver->system, "analysis", SE3D_ERR_UNSUPPORTED,
                             " = %d has no motion, and so no events", (int)analysis);
    }
    return SE3D_OK;
}

se3d_status se3d_event_create(se3d_solver *solver, const se3d_event_def *def, se3d_event *out)
{
    if (out) {
        *out = (se3d_event){0, 0};
    }
    SE3DI_EDIT_OF(solver);
    se3d_system *system = solver->system;
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    se3d_event_def full = se3d_event_def_default();
    SE3DI_TRY(se3di_check_def(system, "event def", def, &full, sizeof full));
    if (!full.value) {
        return SE3DI_FAIL_OF(system, "value", SE3D_ERR_NULL, " is NULL, must compute the quantity");
    }
    SE3DI_TRY(check_numbers(system, &full));
    SE3DI_TRY(check_name(solver, full.name));
    SE3DI_TRY(check_analysis(solver));
    const se3di_event event = {.value = full.value,
                               .ctx = full.ctx,
                               .callback = full.callback,
                               .callback_ctx = full.callback_ctx,
                               .level = full.level,
                               .hysteresis = full.hysteresis,
                               .direction = full.direction,
                               .action = full.action,
                               .motion_only = full.motion_only != 0};
    se3di_handle handle;
    if (se3di_events_add(&solver->run.events, full.name, &event, &handle) < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for an event");
    }
    *out = (se3d_event){handle.index1, handle.generation};
    return SE3D_OK;
}

static se3d_status find(const se3d_solver *solver, se3d_event event, uint32_t *index)
{
    *index = se3di_slots_find(&solver->run.events.slots, event.index1, event.generation);
    if (*index == SE3DI_NO_INDEX) {
        return SE3DI_FAIL(solver->system, SE3D_ERR_STALE_HANDLE,
                          "event {%u, %u} is not one of this solver", (unsigned)event.index1,
                          (unsigned)event.generation);
    }
    return SE3D_OK;
}

se3d_status se3d_event_destroy(se3d_solver *solver, se3d_event event)
{
    uint32_t index;
    SE3DI_EDIT_OF(solver);
    SE3DI_TRY(find(solver, event, &index));
    se3di_events_remove(&solver->run.events, index);
    return SE3D_OK;
}

se3d_status se3d_event_get_name(se3d_solver *solver, se3d_event event, const char **name)
{
    uint32_t index;
    if (name) {
        *name = "";
    }
    SE3DI_OWNED(solver);
    SE3DI_TRY(se3di_check_pointer(solver->system, "name", name));
    SE3DI_TRY(find(solver, event, &index));
    const char *given = solver->run.events.list[index].name;
    *name = given ? given : "";
    return SE3D_OK;
}

se3d_status se3d_event_get_def(se3d_solver *solver, se3d_event event, se3d_event_def *def)
{
    uint32_t index;
    SE3DI_OWNED(solver);
    SE3DI_TRY(se3di_check_pointer(solver->system, "def", def));
    SE3DI_TRY(find(solver, event, &index));
    const se3di_event *data = &solver->run.events.list[index];
    se3d_event_def full = se3d_event_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.value = data->value;
    full.ctx = data->ctx;
    full.callback = data->callback;
    full.callback_ctx = data->callback_ctx;
    full.level = data->level;
    full.direction = data->direction;
    full.action = data->action;
    full.motion_only = data->motion_only;
    full.hysteresis = data->hysteresis;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

size_t se3d_solver_count_events(const se3d_solver *solver)
{
    return solver && solver->system ? solver->run.events.slots.count : 0;
}

se3d_status se3d_solver_get_event(const se3d_solver *solver, size_t index, se3d_event *event)
{
    if (event) {
        *event = (se3d_event){0, 0};
    }
    SE3DI_OWNED(solver);
    return se3di_read_handle(&solver->run.events.slots, index, event);
}

size_t se3d_solver_count_event_records(const se3d_solver *solver)
{
    return solver && solver->system ? solver->run.events.record_count : 0;
}

se3d_status se3d_solver_get_event_record_sized(se3d_solver *solver, size_t index,
                                               se3d_event_record *record, size_t size)
{
    SE3DI_OWNED(solver);
    SE3DI_TRY(se3di_check_pointer(solver->system, "record", record));
    const se3di_events *events = &solver->run.events;
    if (index >= events->record_count) {
        return SE3DI_FAIL_OF(solver->system, "index", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be below the number of records, %zu", index,
                             events->record_count);
    }
    return se3di_sized_give(record, size, &events->records[index], sizeof *record);
}

se3d_status se3d_solver_clear_event_records(se3d_solver *solver)
{
    SE3DI_EDIT_OF(solver);
    se3di_events_clear(&solver->run.events);
    return SE3D_OK;
}
