/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: user-defined states. */
#include "se3d/state.h"

#include "force/driver_rate.h"
#include "force/signal.h"
#include "model/state.h"
#include "system/definition.h"
#include "system/force_internal.h"

#include <math.h>

#define SIZE 1e-3 /* of a state that nothing is said of */

void se3d_state_def_init(se3d_state_def *def, size_t size)
{
    se3d_state_def defaults = {.struct_size = size, .size = SIZE};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

se3d_status se3di_find_state(se3d_system *system, const char *what, se3d_state handle,
                             uint32_t *index)
{
    const se3di_slots *slots = &system->model.force_slots;
    *index = se3di_slots_find(slots, handle.index1, handle.generation);
    if (*index == SE3DI_NO_INDEX || system->model.forces[*index].type != SE3DI_FORCE_STATE) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_STALE_HANDLE, " %s",
                             handle.index1 == 0 ? "is the null handle"
                                                : "was destroyed or belongs to another system");
    }
    return SE3D_OK;
}

static se3d_status check_size(se3d_system *system, double size)
{
    if (!(isfinite(size) && size > 0.0)) {
        return SE3DI_FAIL_OF(system, "size", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be finite and > 0", size);
    }
    return SE3D_OK;
}

se3d_status se3d_state_create(se3d_system *system, const se3d_state_def *def, se3d_state *state)
{
    SE3DI_CREATE(system, state);
    se3d_state_def full = se3d_state_def_default();
    SE3DI_TRY(se3di_check_def(system, "state def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_new_name(system, &system->model.force_slots, 0, "state or force element",
                                   full.name));
    se3di_force data = se3di_force_blank(SE3DI_FORCE_STATE, full.name);
    SE3DI_TRY(se3di_find_law(system, "rate", full.rate, 1, &data.function[0]));
    SE3DI_TRY(se3di_find_law(system, "output", full.output, 1, &data.function[SE3DI_FORCE_OUTPUT]));
    SE3DI_TRY(
        se3di_find_law(system, "input", full.input, 1, &data.function[SE3DI_FORCE_OUTPUT + 1]));
    SE3DI_TRY(se3di_check_finite(system, "initial", full.initial));
    SE3DI_TRY(check_size(system, full.size));
    data.rest = full.size;
    se3di_handle handle = {0, 0};
    const se3d_status added = se3di_model_add_state(&system->model, &data, full.initial, &handle);
    return se3di_give_created(system, added, "a state", handle, state);
}

/* Whether a function asks at once for the output or input (place) of a state. */
static int asks_for(const se3di_model *model, const se3di_function *function, uint32_t state,
                    int place)
{
    for (uint32_t s = 0; s < function->signal_count; ++s) {
        const se3di_signal *signal = &function->signals[s];
        const se3di_function *inner = se3di_signal_function(model, signal);
        const int is_part =
            signal->kind == SE3D_SIGNAL_STATE && signal->component != SE3D_STATE_VALUE;
        if (is_part && signal->force == state &&
            signal->component + SE3DI_FORCE_OUTPUT - SE3D_STATE_OUTPUT == place) {
            return 1;
        }
        if (inner && asks_for(model, inner, state, place)) {
            return 1;
        }
    }
    return 0;
}

/* The rows of drivers whose rates take an output are made of what it depends on. */
static se3d_status check_rates(se3d_system *system, const char *what, uint32_t state, int place)
{
    const se3di_model *model = &system->model;
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *driver = &model->constraints[k];
        if (se3di_is_driver_rate(driver) &&
            asks_for(model, &model->functions[driver->law], state, place)) {
            return SE3DI_FAIL_OF(system, what, SE3D_ERR_IN_USE,
                                 " of the state is what the rate of driver %.80s depends on",
                                 driver->name ? driver->name : "without a name");
        }
    }
    return SE3D_OK;
}

static se3d_status set_function(se3d_system *system, se3d_state state, const char *what, int place,
                                se3d_function handle)
{
    SE3DI_EDIT(system);
    uint32_t index;
    int32_t function;
    SE3DI_TRY(se3di_find_state(system, "state", state, &index));
    SE3DI_TRY(se3di_find_law(system, what, handle, 1, &function));
    if (function >= 0 && place != 0 &&
        asks_for(&system->model, &system->model.functions[function], index, place)) {
        const char *name = system->model.forces[index].name;
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                             " of state %s depends on itself without a state between: an algebraic "
                             "loop",
                             name ? name : "without a name");
    }
    SE3DI_TRY(check_rates(system, what, index, place));
    se3di_model_set_state_function(&system->model, index, place, function);
    return SE3D_OK;
}

se3d_status se3d_state_set_rate(se3d_system *system, se3d_state state, se3d_function rate)
{
    return set_function(system, state, "rate", 0, rate);
}

se3d_status se3d_state_set_output(se3d_system *system, se3d_state state, se3d_function output)
{
    return set_function(system, state, "output", SE3DI_FORCE_OUTPUT, output);
}

se3d_status se3d_state_set_input(se3d_system *system, se3d_state state, se3d_function input)
{
    return set_function(system, state, "input", SE3DI_FORCE_OUTPUT + 1, input);
}

se3d_status se3d_state_set_size(se3d_system *system, se3d_state state, double size)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_state(system, "state", state, &index));
    SE3DI_TRY(check_size(system, size));
    system->model.forces[index].rest = size;
    se3di_model_touch(&system->model);
    return SE3D_OK;
}

se3d_status se3d_state_destroy(se3d_system *system, se3d_state state)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_state(system, "state", state, &index));
    const se3di_force *found = &system->model.forces[index];
    if (found->users > 0) {
        return SE3DI_FAIL(system, SE3D_ERR_IN_USE, "state %s is used by %u signals of functions",
                          found->name ? found->name : "without a name", found->users);
    }
    se3di_model_remove_state(&system->model, index);
    return SE3D_OK;
}

se3d_status se3d_state_find(const se3d_system *system, const char *name, se3d_state *state)
{
    SE3DI_TRY(se3di_read_named(SE3DI_SLOTS(system, force), name, state));
    const uint32_t index =
        se3di_slots_find(&system->model.force_slots, state->index1, state->generation);
    if (system->model.forces[index].type != SE3DI_FORCE_STATE) {
        *state = (se3d_state){0, 0};
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    return SE3D_OK;
}

size_t se3d_system_count_states(const se3d_system *system)
{
    return system ? system->model.state_count : 0;
}

se3d_status se3d_state_set_value(se3d_system *system, se3d_state state, double value)
{
    uint32_t index;
    SE3DI_SET(system);
    SE3DI_TRY(se3di_find_state(system, "state", state, &index));
    SE3DI_TRY(se3di_check_finite(system, "value", value));
    system->model.frames[system->model.forces[index].body_j].v[0] = value;
    se3di_model_touch_state(&system->model);
    return SE3D_OK;
}

/* The state of a reader. */
static se3d_status find_reader(const se3d_system *system, se3d_state state, const void *out,
                               uint32_t *index)
{
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, force), SE3DI_HANDLE(state), out, index));
    return system->model.forces[*index].type == SE3DI_FORCE_STATE ? SE3D_OK : SE3D_ERR_STALE_HANDLE;
}

se3d_status se3d_state_get_value(const se3d_system *system, se3d_state state, int32_t part,
                                 double *value)
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, state, value, &index));
    if (part < SE3D_STATE_VALUE || part > SE3D_STATE_INPUT) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_model *model = &system->model;
    const se3di_signal signal = {.kind = SE3D_SIGNAL_STATE,
                                 .component = part,
                                 .body = model->forces[index].body_j,
                                 .joint = SE3DI_NO_INDEX,
                                 .force = index};
    se3di_signal_value found;
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    SE3DI_TRY(se3di_read_end(&reading, se3di_signal_eval(model, &signal, model->time, 0, &found)));
    *value = found.value;
    return SE3D_OK;
}

se3d_status se3d_state_get_rate(const se3d_system *system, se3d_state state, double *rate)
{
    uint32_t index;
    se3di_effect effect = {.wants_derivative = 0};
    se3di_reading reading;
    SE3DI_TRY(find_reader(system, state, rate, &index));
    const se3di_model *model = &system->model;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    SE3DI_TRY(se3di_read_end(&reading,
                             se3di_force_eval(model, &model->forces[index], model->time, &effect)));
    *rate = effect.value;
    return SE3D_OK;
}

se3d_status se3d_system_get_state(const se3d_system *system, size_t index, se3d_state *state)
{
    size_t dense = 0, seen = 0;
    const size_t count = system ? system->model.force_slots.count : 0;
    while (dense < count) {
        const se3di_force *force = &system->model.forces[dense];
        if (force->type == SE3DI_FORCE_STATE && seen++ == index) {
            break;
        }
        ++dense;
    }
    return se3di_read_handle(SE3DI_SLOTS(system, force), dense, state);
}

se3d_status se3d_state_get_name(const se3d_system *system, se3d_state state, const char **name)
{
    uint32_t index;
    const se3d_status status = find_reader(system, state, name, &index);
    return se3di_give_name(status, status < 0 ? NULL : system->model.forces[index].name, name);
}

se3d_status se3d_state_get_def(const se3d_system *system, se3d_state state, se3d_state_def *def)
{
    uint32_t index;
    SE3DI_TRY(find_reader(system, state, def, &index));
    if (system->model.forces[index].tyre_index >= 0) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3di_model *model = &system->model;
    const se3di_force *data = &model->forces[index];
    se3d_state_def full = se3d_state_def_default();
    full.struct_size = def->struct_size;
    full.name = data->name;
    full.rate = se3di_function_handle(model, data->function[0]);
    full.output = se3di_function_handle(model, data->function[SE3DI_FORCE_OUTPUT]);
    full.input = se3di_function_handle(model, data->function[SE3DI_FORCE_OUTPUT + 1]);
    full.initial = se3di_state_value(model, data);
    full.size = data->rest;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}
