/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions of time and of force variables. */
#include "model/function.h"
#include "expression/expression.h"
#include "force/force.h"
#include "model/integral.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

#define PERIOD_AGREEMENT 1e-9 /* of the largest value: the ends of a table that repeats */

void se3d_function_def_init(se3d_function_def *def, size_t size)
{
    se3d_function_def defaults = {.struct_size = size, .variable_count = 1};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_kind(se3d_system *system, const se3d_function_def *def)
{
    int kinds = (def->expression != NULL) + (def->compiled != NULL) + (def->callback != NULL) +
                (def->table_x != NULL);
    if (kinds > 1) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "a function is an expression, a callback, or a table: %d are given",
                          kinds);
    }
    if (def->variable_count < 1 || def->variable_count > SE3D_FUNCTION_VARIABLES_MAX) {
        return SE3DI_FAIL_OF(system, "variable_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be between 1 and %d", def->variable_count,
                             SE3D_FUNCTION_VARIABLES_MAX);
    }
    if (def->variable_count > 1 && !def->variables && def->expression) {
        return SE3DI_FAIL(system, SE3D_ERR_NULL, "variables is NULL, must name %zu variables",
                          def->variable_count);
    }
    if (def->signal_count > def->variable_count) {
        return SE3DI_FAIL_OF(system, "signal_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be at most variable_count = %zu", def->signal_count,
                             def->variable_count);
    }
    if (def->compiled && se3di_expression_variable_count(def->compiled) != def->variable_count) {
        return SE3DI_FAIL_OF(system, "compiled", SE3D_ERR_INVALID_ARGUMENT,
                             " has %zu variables, must have variable_count = %zu",
                             se3di_expression_variable_count(def->compiled), def->variable_count);
    }
    return se3di_check_finite(system, "constant", def->constant);
}

static se3d_status check_integral(se3d_system *system, const se3d_function_def *def)
{
    if (def->integrate != 0 && def->integrate != 1) {
        return SE3DI_FAIL_OF(system, "integrate", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be 0 or 1", def->integrate);
    }
    if (def->integrate && (def->variable_count != 1 || def->signal_count > 0)) {
        return SE3DI_FAIL_OF(system, "integrate", SE3D_ERR_INVALID_ARGUMENT,
                             " = 1: the rate has %zu variables, must have one, the time",
                             def->variable_count);
    }
    SE3DI_TRY(se3di_check_finite(system, "start", def->start));
    return se3di_check_finite(system, "start_time", def->start_time);
}

static se3d_status make_expression(se3d_system *system, const se3d_function_def *def,
                                   se3di_function *function)
{
    static const char *const time[] = {"t"};
    se3d_expression_error error = {0};
    se3d_expression_def expression = se3d_expression_def_default();
    expression.text = def->expression;
    expression.variables = def->variables ? def->variables : time;
    expression.variable_count = def->variable_count;
    expression.symbols = def->symbols;
    expression.symbol_count = def->symbol_count;
    expression.allocator = &system->model.allocator;
    se3d_status status = se3d_expression_create(&expression, &function->expression, &error);
    if (status == SE3D_ERR_NO_MEMORY) {
        return SE3DI_FAIL(system, status, "no memory for an expression");
    }
    if (status < 0) {
        return SE3DI_FAIL(system, status, "expression \"%.120s\", column %zu: %s", def->expression,
                          error.column, error.message);
    }
    return SE3D_OK;
}

static se3d_status copy_expression(se3d_system *system, const se3d_function_def *def,
                                   se3di_function *function)
{
    const se3d_status status =
        se3di_expression_clone(def->compiled, &system->model.allocator, &function->expression);
    return status < 0 ? SE3DI_FAIL(system, status, "no memory for an expression") : status;
}

/* The ends of a period agree to rounding of the data. */
static se3d_status check_period(se3d_system *system, const se3d_function_def *def)
{
    const double first = def->table_y[0], last = def->table_y[def->table_count - 1];
    double size = 0.0;
    if (def->table_count < 3) {
        return SE3DI_FAIL_OF(system, "table_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be at least 3 for a table that repeats",
                             def->table_count);
    }
    for (size_t k = 0; k < def->table_count; ++k) {
        size = fmax(size, fabs(def->table_y[k]));
    }
    if (!(fabs(last - first) <= PERIOD_AGREEMENT * size)) {
        return SE3DI_FAIL_OF(system, "table_y", SE3D_ERR_INVALID_ARGUMENT,
                             " ends with %.9g, must end with %.9g, as it begins: the table repeats",
                             last, first);
    }
    return SE3D_OK;
}

static se3d_status check_table_kind(se3d_system *system, const se3d_function_def *def)
{
    if (def->table_kind < SE3D_TABLE_CUBIC || def->table_kind > SE3D_TABLE_AKIMA) {
        return SE3DI_FAIL_OF(system, "table_kind", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be an se3d_table_kind, 0 to %d", (int)def->table_kind,
                             (int)SE3D_TABLE_AKIMA);
    }
    if (def->table_periodic != 0 && def->table_periodic != 1) {
        return SE3DI_FAIL_OF(system, "table_periodic", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be 0 or 1", (int)def->table_periodic);
    }
    return def->table_periodic ? check_period(system, def) : SE3D_OK;
}

static se3d_status check_table(se3d_system *system, const se3d_function_def *def)
{
    SE3DI_TRY(se3di_check_pointer(system, "table_y", def->table_y));
    if (def->table_count < 2 || def->table_count > UINT32_MAX) {
        return SE3DI_FAIL_OF(system, "table_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be at least 2", def->table_count);
    }
    for (size_t k = 0; k < def->table_count; ++k) {
        if (!isfinite(def->table_x[k]) || !isfinite(def->table_y[k])) {
            return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                              "table point %zu = (%g, %g), must be finite", k, def->table_x[k],
                              def->table_y[k]);
        }
        if (k > 0 && !(def->table_x[k] > def->table_x[k - 1])) {
            return SE3DI_FAIL_OF(system, "table_x", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] = %g after %g, must increase", k, def->table_x[k],
                                 def->table_x[k - 1]);
        }
    }
    return check_table_kind(system, def);
}

static se3d_status make_table(se3d_system *system, const se3d_function_def *def,
                              se3di_function *function)
{
    size_t n = def->table_count;
    const se3d_allocator *allocator = &system->model.allocator;
    SE3DI_TRY(check_table(system, def));
    const size_t scratch_size = se3di_spline_scratch_size(n);
    double *table = se3di_alloc(allocator, 3 * n, sizeof *table);
    double *scratch = se3di_alloc(allocator, scratch_size, sizeof *scratch);
    if (!table || !scratch) {
        se3di_free(allocator, table, 3 * n, sizeof *table);
        se3di_free(allocator, scratch, scratch_size, sizeof *scratch);
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a table of %zu points", n);
    }
    memcpy(table, def->table_x, n * sizeof *table);
    memcpy(table + n, def->table_y, n * sizeof *table);
    table[2 * n - 1] = def->table_periodic ? table[n] : table[2 * n - 1];
    function->table = table;
    function->table_count = n;
    function->table_kind = def->table_kind;
    function->table_periodic = def->table_periodic;
    const se3di_spline view = se3di_function_table(function);
    se3di_spline_build(&view, table + 2 * n, scratch);
    se3di_free(allocator, scratch, scratch_size, sizeof *scratch);
    return SE3D_OK;
}

/* Numbers that a kind of signals has; 0: there is no such kind. */
static int32_t component_count(const se3d_signal *signal)
{
    switch (signal->kind) {
    case SE3D_SIGNAL_JOINT_COORDINATE:
    case SE3D_SIGNAL_JOINT_RATE:
        return 2;
    case SE3D_SIGNAL_FORCE_COORDINATE:
    case SE3D_SIGNAL_FORCE_RATE:
        return INT32_MAX;
    case SE3D_SIGNAL_POINT_POSITION:
    case SE3D_SIGNAL_POINT_VELOCITY:
    case SE3D_SIGNAL_ANGULAR_VELOCITY:
    case SE3D_SIGNAL_STATE:
        return 3;
    case SE3D_SIGNAL_ORIENTATION:
        return 4;
    default:
        return 0;
    }
}

static se3d_status take_joint(se3d_system *system, const se3d_signal *signal, se3di_signal *out)
{
    SE3DI_TRY(se3di_find_constraint(system, "signal joint", signal->joint, &out->joint));
    const se3di_constraint *joint = &system->model.constraints[out->joint];
    const int angle = signal->component == SE3D_JOINT_COORDINATE_ANGLE;
    if (angle ? joint->angle < 0 : !joint->has_displacement) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "signal joint %s is a %s, must have %s",
                          joint->name ? joint->name : "without a name", joint->type,
                          angle ? "an angle" : "a displacement");
    }
    return SE3D_OK;
}

static se3d_status take_force(se3d_system *system, const se3d_signal *signal, se3di_signal *out)
{
    SE3DI_TRY(se3di_find_force(system, "signal force", signal->force, &out->force));
    const se3di_force *force = &system->model.forces[out->force];
    if (!(se3di_force_class_of(force)->traits & SE3DI_FORCE_IS_SCALAR)) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "signal force is a %s, must be one along a coordinate: tsda, rsda, "
                          "friction, stop, effort",
                          se3di_force_class_of(force)->name);
    }
    return SE3D_OK;
}

static se3d_status take_signal(se3d_system *system, const se3d_signal *signal, se3di_signal *out)
{
    const int32_t count = component_count(signal);
    *out = (se3di_signal){.kind = signal->kind,
                          .component = signal->component,
                          .joint = SE3DI_NO_INDEX,
                          .force = SE3DI_NO_INDEX};
    if (count == 0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "signal kind = %d, must be an se3d_signal_kind, 1 to %d", signal->kind,
                          SE3D_SIGNAL_STATE);
    }
    if (count < INT32_MAX && (signal->component < 0 || signal->component >= count)) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "signal component = %d, must be from 0 to %d", signal->component,
                          count - 1);
    }
    if (signal->kind <= SE3D_SIGNAL_JOINT_RATE) {
        return take_joint(system, signal, out);
    }
    if (signal->kind <= SE3D_SIGNAL_FORCE_RATE) {
        return take_force(system, signal, out);
    }
    if (signal->kind == SE3D_SIGNAL_STATE) {
        SE3DI_TRY(se3di_find_state(system, "signal state", signal->state, &out->force));
        out->body = system->model.forces[out->force].body_j;
        return SE3D_OK;
    }
    memcpy(out->point, signal->point, sizeof out->point);
    SE3DI_TRY(se3di_find_body(system, "signal body", signal->body, &out->body));
    return se3di_check_finites(system, "signal point", signal->point, 3);
}

static se3d_status make_signals(se3d_system *system, const se3d_function_def *def,
                                se3di_function *function)
{
    if (def->signal_count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_pointer(system, "signals", def->signals));
    function->signals =
        se3di_alloc(&system->model.allocator, def->signal_count, sizeof *function->signals);
    if (!function->signals) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for %zu signals",
                          def->signal_count);
    }
    function->signal_count = (uint32_t)def->signal_count;
    for (size_t k = 0; k < def->signal_count; ++k) {
        SE3DI_TRY(take_signal(system, &def->signals[k], &function->signals[k]));
    }
    return SE3D_OK;
}

static se3d_status make_content(se3d_system *system, const se3d_function_def *def,
                                se3di_function *function)
{
    if (def->expression) {
        return make_expression(system, def, function);
    }
    if (def->compiled) {
        return copy_expression(system, def, function);
    }
    return def->table_x ? make_table(system, def, function) : SE3D_OK;
}

static se3d_status make_integral(se3d_system *system, const se3d_function_def *def,
                                 se3di_function *function)
{
    if (!def->integrate || se3di_integral_create(&system->model.allocator, function, def->start,
                                                 def->start_time) >= 0) {
        return SE3D_OK;
    }
    return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for an integral");
}

se3d_status se3d_function_create(se3d_system *system, const se3d_function_def *def,
                                 se3d_function *function)
{
    SE3DI_CREATE(system, function);
    se3d_function_def full = se3d_function_def_default();
    SE3DI_TRY(se3di_check_def(system, "function def", def, &full, sizeof full));
    SE3DI_TRY(check_kind(system, &full));
    SE3DI_TRY(check_integral(system, &full));
    se3di_function data = {.callback = full.callback,
                           .ctx = full.ctx,
                           .constant = full.constant,
                           .variable_count = (uint32_t)full.variable_count};
    se3d_status status = make_signals(system, &full, &data);
    if (status >= 0) {
        status = make_content(system, &full, &data);
    }
    if (status >= 0) {
        status = make_integral(system, &full, &data);
    }
    if (status < 0) {
        se3di_function_release(&system->model.allocator, &data);
        return status;
    }
    se3di_handle handle = {0, 0};
    const se3d_status added = se3di_model_add_function(&system->model, &data, &handle);
    if (added < 0) {
        se3di_function_release(&system->model.allocator, &data);
    }
    return se3di_give_created(system, added, "a function", handle, function);
}

se3d_status se3d_function_create_expression(se3d_system *system, const char *text,
                                            se3d_function *function)
{
    if (function) {
        *function = (se3d_function){0, 0};
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "text", text));
    se3d_function_def def = se3d_function_def_default();
    def.expression = text;
    return se3d_function_create(system, &def, function);
}

se3d_status se3d_function_destroy(se3d_system *system, se3d_function function)
{
    SE3DI_EDIT(system);
    uint32_t index =
        se3di_slots_find(&system->model.function_slots, function.index1, function.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3DI_FAIL(system, SE3D_ERR_STALE_HANDLE,
                          "function is null, was destroyed or belongs to another system");
    }
    if (system->model.functions[index].users > 0) {
        return SE3DI_FAIL(system, SE3D_ERR_IN_USE, "the function is used by %u elements",
                          system->model.functions[index].users);
    }
    se3di_model_remove_function(&system->model, index);
    return SE3D_OK;
}

/* Whether a function prescribes something. */
static int is_prescribed(const se3di_model *model, uint32_t function)
{
    for (size_t k = 0; k < model->row_count; ++k) {
        if (model->rows[k].function == (int32_t)function) {
            return 1;
        }
    }
    return 0;
}

/* Whether energies depend on it: gravity, curves of springs. */
static int holds_energy(const se3di_model *model, uint32_t function)
{
    int holds = 0;
    for (int c = 0; c < 3; ++c) {
        holds |= model->gravity_function[c] == (int32_t)function;
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        holds |= model->forces[k].function[3] == (int32_t)function;
    }
    return holds;
}

se3d_status se3d_function_set_constant(se3d_system *system, se3d_function handle, double value)
{
    SE3DI_SET(system);
    se3di_model *model = &system->model;
    const uint32_t index =
        se3di_slots_find(&model->function_slots, handle.index1, handle.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3DI_FAIL(system, SE3D_ERR_STALE_HANDLE,
                          "function is null, was destroyed or belongs to another system");
    }
    se3di_function *function = &model->functions[index];
    SE3DI_TRY(se3di_check_finite(system, "constant", value));
    if (function->expression || function->callback || function->table) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "the function is not a constant, its value cannot be set");
    }
    if (memcmp(&function->constant, &value, sizeof value) == 0) {
        return SE3D_OK;
    }
    const int holds = holds_energy(model, index);
    const double before = holds ? se3di_audit_forces(model) : 0.0;
    if (function->integral) {
        se3di_integral_move(function, model->time);
    }
    function->constant = value;
    if (holds) {
        se3di_audit_change(model, before);
    }
    if (is_prescribed(model, index)) {
        se3di_model_touch_values(model);
    } else if (function->users > 0) {
        se3di_model_touch_inputs(model);
    }
    return SE3D_OK;
}

se3d_status se3d_function_eval(const se3d_system *system, se3d_function function, const double *x,
                               double jet[3])
{
    if (!system || !x || !jet) {
        return SE3D_ERR_NULL;
    }
    uint32_t index =
        se3di_slots_find(&system->model.function_slots, function.index1, function.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    return se3di_read_end(&reading,
                          se3di_function_eval(&system->model.functions[index], x, jet, NULL));
}
