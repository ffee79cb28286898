/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: drivers, coordinate of a joint = f(t). One row of one term: the joint's angle (Phi
 * is taken modulo 2 pi: regular at every angle, no constraint is ever exchanged) or displacement.
 * The effort is -lambda, because the driver's virtual work on body j is -lambda per unit of the
 * coordinate. If the value is a function of signals, too, the row is that of force/driver_law.h; if
 * its rate is one, that of force/driver_rate.h.
 *                                              docs/theory/reactions.md, docs/theory/signals.md */
#include "expression/expression.h"
#include "force/driver_law.h"
#include "force/driver_rate.h"
#include "force/signal.h"
#include "joint/draft.h"
#include "joint/equation.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

void se3d_driver_def_init(se3d_driver_def *def, size_t size)
{
    se3d_driver_def full = {.struct_size = size};
    se3di_def_init(def, size, &full, sizeof full);
}

/* A signal that a prescribed coordinate may follow: one of positions, and not the coordinate. */
static se3d_status check_signal(se3d_system *system, const se3di_signal *signal, uint32_t joint,
                                int32_t coordinate)
{
    if (signal->kind == SE3D_SIGNAL_STATE) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function depends on a state, which is integrated: the value of a driver "
                          "may depend on the time, coordinates, positions and orientations");
    }
    if (signal->kind == SE3D_SIGNAL_JOINT_RATE || signal->kind == SE3D_SIGNAL_FORCE_RATE ||
        signal->kind == SE3D_SIGNAL_POINT_VELOCITY ||
        signal->kind == SE3D_SIGNAL_ANGULAR_VELOCITY) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function depends on a velocity: the value of a driver may depend on the "
                          "time, coordinates, positions and orientations");
    }
    if (signal->kind == SE3D_SIGNAL_JOINT_COORDINATE && signal->joint == joint &&
        signal->component == coordinate) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function depends on the coordinate that the driver prescribes");
    }
    return SE3D_OK;
}

/* Functions that a rate depends on have derivatives along directions. */
static int is_differentiable(const se3di_model *model, const se3di_function *function)
{
    int is_good = function->signal_count == 0 ||
                  (function->expression && function->variable_count == function->signal_count + 1);
    for (uint32_t k = 0; k < function->signal_count && is_good; ++k) {
        const se3di_function *inner = se3di_signal_function(model, &function->signals[k]);
        is_good = !inner || is_differentiable(model, inner);
    }
    return is_good;
}

/* The search for jumps knows functions of the time alone, and a velocity that jumps within a step
 * is not in its accelerations. */
static int is_continuous(const se3di_model *model, const se3di_function *function)
{
    int is_good = !function->expression || se3di_expression_is_continuous(function->expression);
    for (uint32_t k = 0; k < function->signal_count && is_good; ++k) {
        const se3di_function *inner = se3di_signal_function(model, &function->signals[k]);
        is_good = !inner || is_continuous(model, inner);
    }
    return is_good;
}

/* A rate may depend on anything but itself. */
static se3d_status check_leaves(se3d_system *system, const se3di_function *law, uint32_t joint,
                                int32_t coordinate)
{
    const se3di_model *model = &system->model;
    const uint32_t leaves = se3di_law_count_leaves(model, law);
    if (leaves > SE3DI_RATE_LEAVES_MAX) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function depends on %u signals with those of the outputs of states, a "
                          "rate may on at most %d",
                          leaves, SE3DI_RATE_LEAVES_MAX);
    }
    for (uint32_t k = 0; k < leaves; ++k) {
        const se3di_signal *signal = se3di_law_get_leaf(model, law, k);
        if (signal->kind == SE3D_SIGNAL_JOINT_RATE && signal->joint == joint &&
            signal->component == coordinate) {
            return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                              "function depends on the rate that the driver prescribes");
        }
    }
    return SE3D_OK;
}

static se3d_status check_drafted(se3d_system *system, int is_drafted)
{
    if (!is_drafted) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function has signals of too many bodies, with those of the joint at "
                          "most %d",
                          SE3DI_NODE_BODIES_MAX);
    }
    return SE3D_OK;
}

static se3d_status draft_rate(se3d_system *system, const se3d_driver_def *def, uint32_t joint,
                              int32_t function, se3di_draft *draft)
{
    const se3di_function *law = function >= 0 ? &system->model.functions[function] : NULL;
    if (!law || law->signal_count == 0) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "is_rate = %d, must be 0 for a function without signals: let it be one "
                          "with `integrate`",
                          (int)def->is_rate);
    }
    if (!is_differentiable(&system->model, law)) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function and outputs of states that it takes must be expressions of the "
                          "time and of signals: their derivatives are needed");
    }
    if (!is_continuous(&system->model, law)) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function may jump, which a rate of signals must not: instead of if, "
                          "comparisons, sign, floor, ceil, round and mod, use step, min, max or "
                          "abs");
    }
    SE3DI_TRY(check_leaves(system, law, joint, def->coordinate));
    return check_drafted(system, se3di_driver_rate_draft(&system->model, joint, def->coordinate,
                                                         function, def->name, draft));
}

static se3d_status draft_law(se3d_system *system, const se3d_driver_def *def, uint32_t joint,
                             int32_t function, se3di_draft *draft)
{
    const se3di_function *law = &system->model.functions[function];
    if (!law->expression || law->variable_count != law->signal_count + 1) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "function with signals must be an expression of the time and of them: "
                          "its second derivatives are needed");
    }
    for (uint32_t k = 0; k < law->signal_count; ++k) {
        SE3DI_TRY(check_signal(system, &law->signals[k], joint, def->coordinate));
    }
    return check_drafted(system, se3di_driver_law_draft(&system->model, joint, def->coordinate,
                                                        function, def->name, draft));
}

se3d_status se3d_driver_create(se3d_system *system, const se3d_driver_def *user,
                               se3d_constraint *driver)
{
    SE3DI_CREATE(system, driver);
    se3d_driver_def def = se3d_driver_def_default();
    uint32_t joint;
    se3di_term term;
    int32_t function;
    SE3DI_TRY(se3di_check_def(system, "def", user, &def, sizeof def));
    SE3DI_TRY(
        se3di_check_new_name(system, &system->model.constraint_slots, 0, "constraint", def.name));
    SE3DI_TRY(se3di_find_constraint(system, "joint", def.joint, &joint));
    SE3DI_TRY(se3di_check_coordinate(system, "coordinate", joint, def.coordinate, &term));
    SE3DI_TRY(se3di_find_law(system, "function", def.function, 1, &function));
    SE3DI_TRY(se3di_check_prescribed(system, def.value, function));
    se3di_draft draft;
    if (def.is_rate) {
        SE3DI_TRY(draft_rate(system, &def, joint, function, &draft));
        return se3di_constraint_add(system, &draft, driver);
    }
    if (function >= 0 && system->model.functions[function].signal_count > 0) {
        SE3DI_TRY(draft_law(system, &def, joint, function, &draft));
        return se3di_constraint_add(system, &draft, driver);
    }
    se3di_driver_draft(&system->model, joint, def.coordinate, def.name,
                       (se3di_prescribed){def.value, function}, &draft);
    return se3di_constraint_add(system, &draft, driver);
}

/* A constraint of a single row. */
static se3d_status find_single(const se3d_system *system, se3d_constraint driver,
                               const double *output, const se3di_constraint **found)
{
    if (!system || !output) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    uint32_t index = se3di_slots_find(&model->constraint_slots, driver.index1, driver.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    *found = &model->constraints[index];
    return (*found)->row_count == 1 ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3d_driver_get_value(const se3d_system *system, se3d_constraint driver, double *value)
{
    if (value) {
        *value = 0.0;
    }
    const se3di_constraint *found;
    SE3DI_TRY(find_single(system, driver, value, &found));
    const se3di_model *model = &system->model;
    double jet[3];
    se3di_reading reading;
    if (se3di_is_driver_rate(found)) {
        const se3di_floats host = se3di_floats_set();
        *value = se3di_driver_rate_coordinate(model, found);
        se3di_floats_restore(host);
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_read_begin(system, &reading));
    SE3DI_TRY(se3di_read_end(
        &reading, found->law >= 0
                      ? se3di_driver_law_value(model, found, jet)
                      : se3di_row_prescribed(model, &model->rows[found->row_begin], jet)));
    *value = jet[0];
    return SE3D_OK;
}

se3d_status se3d_driver_get_effort(const se3d_system *system, se3d_constraint driver,
                                   double *effort)
{
    if (effort) {
        *effort = 0.0;
    }
    const se3di_constraint *found;
    SE3DI_TRY(find_single(system, driver, effort, &found));
    SE3DI_TRY(se3di_check_solved(system));
    *effort = -system->model.lambda[found->row_begin];
    return SE3D_OK;
}
