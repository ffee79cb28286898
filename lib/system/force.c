/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: creation and queries. */
#include "force/measure.h"

#include "joint/joint.h"
#include "math/vec3.h"
#include "model/state.h"
#include "system/force_internal.h"

#include <string.h>

void se3d_tsda_def_init(se3d_tsda_def *def, size_t size)
{
    se3d_tsda_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_rsda_def_init(se3d_rsda_def *def, size_t size)
{
    se3d_rsda_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_load_def_init(se3d_load_def *def, size_t size)
{
    se3d_load_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

/* What every creation starts with. */
se3d_status se3di_force_begin(se3d_system *system, se3d_force *force)
{
    if (force) {
        *force = (se3d_force){0, 0};
    }
    SE3DI_TRY(se3di_enter(system, SE3DI_BUSY_FREE, "the creation of a force element"));
    return se3di_check_pointer(system, "force", force);
}

se3di_force se3di_force_blank(int32_t type, const char *name)
{
    se3di_force data = {
        .type = type, .function = {-1, -1, -1, -1, -1}, .joint = -1, .angle = -1, .tyre_index = -1};
    memcpy(&data.name, &name, sizeof data.name); /* copied by the model */
    return data;
}

se3d_status se3di_force_add(se3d_system *system, const se3di_force *data, se3d_force *force)
{
    se3di_handle handle = {0, 0};
    const se3d_status added = se3di_model_add_force(&system->model, data, &handle);
    return se3di_give_created(system, added, "a force element", handle, force);
}

se3d_status se3d_force_create_tsda(se3d_system *system, const se3d_tsda_def *def, se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_tsda_def, "tsda def", SE3DI_FORCE_TSDA);
    SE3DI_TRY(se3di_find_body(system, "body_i", full.body_i, &data.body_i));
    SE3DI_TRY(se3di_find_body(system, "body_j", full.body_j, &data.body_j));
    SE3DI_TRY(se3di_check_finites(system, "point_i", full.point_i, 3));
    SE3DI_TRY(se3di_check_finites(system, "point_j", full.point_j, 3));
    SE3DI_TRY(se3di_find_law(system, "h", full.h, 3, &data.function[0]));
    SE3DI_TRY(se3di_find_function(system, "spring", full.spring, 1, &data.function[3]));
    SE3DI_TRY(se3di_find_function(system, "damper", full.damper, 1, &data.function[4]));
    data.preload = full.preload;
    data.coordinate = SE3DI_FORCE_LENGTH;
    data.k = full.k;
    data.c = full.c;
    data.rest = full.l0;
    SE3DI_TRY(se3di_force_check_values(system, &data));
    SE3DI_TRY(se3di_force_check_pair(system, &data));
    se3di_copy(full.point_i, data.s_i);
    se3di_copy(full.point_j, data.s_j);
    return se3di_force_add(system, &data, force);
}

/* The axes and the turn counter of an rsda without a joint. */
static se3d_status make_angle(se3d_system *system, const se3d_rsda_def *def, se3di_force *data,
                              se3di_angle *angle)
{
    se3di_joint_frames frames = {.point_i = {0.0, 0.0, 0.0}};
    const double none[3] = {0.0, 0.0, 0.0};
    SE3DI_TRY(se3di_find_body(system, "body_i", def->body_i, &data->body_i));
    SE3DI_TRY(se3di_find_body(system, "body_j", def->body_j, &data->body_j));
    SE3DI_TRY(se3di_force_check_pair(system, data));
    SE3DI_TRY(se3di_check_direction(system, "axis_i", def->axis_i, frames.axis_i));
    SE3DI_TRY(se3di_check_finites(system, "ref_i", def->ref_i, 3));
    SE3DI_TRY(se3di_check_finites(system, "ref_j", def->ref_j, 3));
    SE3DI_TRY(se3di_check_finite(system, "angle0", def->angle0));
    int chosen = memcmp(def->ref_i, none, sizeof none) == 0;
    if (!se3di_joint_triad_take(frames.axis_i, chosen ? NULL : def->ref_i, frames.ref_i,
                                frames.third_i)) {
        return SE3DI_FAIL_OF(system, "ref_i", SE3D_ERR_INVALID_ARGUMENT,
                             " = [%g, %g, %g] is parallel to axis_i, must not be", def->ref_i[0],
                             def->ref_i[1], def->ref_i[2]);
    }
    const se3di_frame *i = &system->model.frames[data->body_i];
    const se3di_frame *j = &system->model.frames[data->body_j];
    double axis[3];
    se3di_mul(i->A, frames.axis_i, axis);
    se3di_mul_transposed(j->A, axis, frames.axis_j);
    if (memcmp(def->ref_j, none, sizeof none) == 0) {
        se3di_joint_ref_match(&frames, def->angle0, i, j, frames.ref_j);
    } else {
        SE3DI_TRY(se3di_check_direction(system, "ref_j", def->ref_j, frames.ref_j));
    }
    const uint32_t bodies[2] = {data->body_i, data->body_j};
    se3di_joint_angle_init(&frames, bodies, 0.0, angle);
    angle->theta = se3di_joint_angle_start(angle, i, j, def->angle0);
    return SE3D_OK;
}

/* The joint of an rsda. */
static se3d_status use_angle(se3d_system *system, const se3d_rsda_def *def, se3di_force *data)
{
    uint32_t joint;
    SE3DI_TRY(se3di_find_constraint(system, "joint", def->joint, &joint));
    const se3di_constraint *constraint = &system->model.constraints[joint];
    if (constraint->angle < 0) {
        return SE3DI_FAIL_OF(system, "joint", SE3D_ERR_INVALID_ARGUMENT,
                             " %s is a %s joint, must be one with an angle",
                             constraint->name ? constraint->name : "without a name",
                             constraint->type);
    }
    data->joint = (int32_t)joint;
    data->angle = constraint->angle;
    data->body_i = constraint->bodies[0];
    data->body_j = constraint->bodies[1];
    return SE3D_OK;
}

static se3d_status add_with_angle(se3d_system *system, const se3di_force *data,
                                  const se3di_angle *angle, se3d_force *force)
{
    se3di_handle handle = {0, 0};
    const se3d_status added =
        se3di_model_add_force_with_angle(&system->model, data, angle, &handle);
    return se3di_give_created(system, added, "a force element", handle, force);
}

se3d_status se3d_force_create_rsda(se3d_system *system, const se3d_rsda_def *def, se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_rsda_def, "rsda def", SE3DI_FORCE_RSDA);
    se3di_angle angle;
    SE3DI_TRY(se3di_find_law(system, "h", full.h, 3, &data.function[0]));
    SE3DI_TRY(se3di_find_function(system, "spring", full.spring, 1, &data.function[3]));
    SE3DI_TRY(se3di_find_function(system, "damper", full.damper, 1, &data.function[4]));
    data.k = full.k;
    data.c = full.c;
    data.rest = full.theta0;
    data.preload = full.preload;
    SE3DI_TRY(se3di_force_check_values(system, &data));
    if (full.joint.index1 == 0 && full.joint.generation == 0 && full.body_j.index1 != 0) {
        SE3DI_TRY(make_angle(system, &full, &data, &angle));
        return add_with_angle(system, &data, &angle, force);
    }
    SE3DI_TRY(use_angle(system, &full, &data));
    return se3di_force_add(system, &data, force);
}

static se3d_status create_load(se3d_system *system, const se3d_load_def *def, int32_t type,
                               se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_load_def, "load def", type);
    SE3DI_TRY(se3di_find_body(system, "body", full.body, &data.body_j));
    SE3DI_TRY(se3di_check_finites(system, "point", full.point, 3));
    SE3DI_TRY(se3di_check_finites(system, "value", full.value, 3));
    for (int c = 0; c < 3; ++c) {
        SE3DI_TRY(se3di_find_law(system, "function", full.function[c], 1, &data.function[c]));
    }
    data.body_i = 0;
    data.in_body_frame = full.in_body_frame != 0;
    se3di_copy(full.point, data.s_j);
    se3di_copy(full.value, data.value);
    return se3di_force_add(system, &data, force);
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
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_force(system, "force", force, &index));
    const se3di_force *found = &system->model.forces[index];
    if (found->users > 0) {
        return SE3DI_FAIL(system, SE3D_ERR_IN_USE,
                          "'%.64s' is used by %u wheels or signals of functions",
                          found->name ? found->name : "", found->users);
    }
    se3di_model_remove_tyre(&system->model, index); /* with what only tyres have */
    return SE3D_OK;
}

se3d_status se3d_force_find(const se3d_system *system, const char *name, se3d_force *force)
{
    const se3di_force *data;
    SE3DI_TRY(se3di_read_named(SE3DI_SLOTS(system, force), name, force));
    if (se3di_force_find_reader(system, *force, force, &data) < 0) {
        *force = (se3d_force){0, 0};
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    return SE3D_OK;
}

se3d_status se3d_force_get_name(const se3d_system *system, se3d_force force, const char **name)
{
    const se3di_force *data = NULL;
    const se3d_status status = se3di_force_find_reader(system, force, name, &data);
    return se3di_give_name(status, data ? data->name : NULL, name);
}

se3d_status se3d_force_get_type(const se3d_system *system, se3d_force force, const char **type)
{
    if (type) {
        *type = NULL;
    }
    const se3di_force *data;
    SE3DI_TRY(se3di_force_find_reader(system, force, type, &data));
    *type = se3di_force_class_of(data)->name;
    return SE3D_OK;
}

/* The element at the present state. */
static se3d_status eval_reader(const se3d_system *system, se3d_force force, const void *out,
                               se3di_effect *effect)
{
    const se3di_force *data;
    SE3DI_TRY(se3di_force_find_reader(system, force, out, &data));
    effect->wants_derivative = 0;
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    return se3di_read_end(&reading,
                          se3di_force_eval(&system->model, data, system->model.time, effect));
}

/* Of an effort, which does not need its coordinate, and of an armature, which needs nothing. */
static se3d_status measure(const se3d_system *system, const se3di_force *data, int wants_value,
                           se3di_effect *effect)
{
    se3di_measure measure;
    (void)se3di_measure_force(&system->model, data, 0, &measure);
    effect->coordinate = measure.value;
    effect->rate = measure.rate;
    if (data->type == SE3DI_FORCE_ARMATURE && wants_value) {
        SE3DI_TRY(se3di_check_solved(system));
        effect->value = -data->value[0] * se3di_measure_acceleration(&system->model, data);
    }
    return SE3D_OK;
}

se3d_status se3d_force_get_state(const se3d_system *system, se3d_force force, double *coordinate,
                                 double *rate, double *value)
{
    const se3di_force *data;
    se3di_effect effect;
    SE3DI_TRY(se3di_force_find_reader(system, force, system, &data));
    if (!(se3di_force_class_of(data)->traits & SE3DI_FORCE_IS_SCALAR)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    SE3DI_TRY(eval_reader(system, force, system, &effect));
    if (data->type == SE3DI_FORCE_EFFORT || data->type == SE3DI_FORCE_ARMATURE) {
        SE3DI_TRY(measure(system, data, value != NULL, &effect));
    }
    if (coordinate) {
        *coordinate = effect.coordinate;
    }
    if (rate) {
        *rate = effect.rate;
    }
    if (value) {
        *value = effect.value;
    }
    return SE3D_OK;
}

se3d_status se3d_force_get_wrench(const se3d_system *system, se3d_force force, size_t side,
                                  double wrench[6])
{
    const se3di_force *data;
    se3di_effect effect;
    for (int k = 0; wrench && k < 6; ++k) {
        wrench[k] = 0.0;
    }
    SE3DI_TRY(se3di_force_find_reader(system, force, wrench, &data));
    if (side > 1) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    SE3DI_TRY(eval_reader(system, force, wrench, &effect));
    uint32_t body = side == 0 ? data->body_i : data->body_j;
    se3di_copy(effect.wrench + 6 * side, wrench);
    const se3di_floats host = se3di_floats_set();
    se3di_mul(system->model.frames[body].A, effect.wrench + 6 * side + 3, wrench + 3);
    se3di_floats_restore(host);
    return SE3D_OK;
}

se3d_status se3d_force_get_power(const se3d_system *system, se3d_force force, double *potential,
                                 double *dissipated, double *actuator)
{
    const se3di_force *data;
    se3di_effect effect;
    double rate = 0.0; /* of the energy of a callback */
    se3di_reading reading;
    SE3DI_TRY(eval_reader(system, force, system, &effect));
    SE3DI_TRY(se3di_force_find_reader(system, force, system, &data));
    if (actuator && data->energy) {
        SE3DI_TRY(se3di_read_begin(system, &reading));
        SE3DI_TRY(se3di_read_end(
            &reading, se3di_callback_energy_rate(&system->model, data, system->model.time, &rate)));
    }
    if (potential) {
        *potential = effect.potential;
    }
    if (dissipated) {
        *dissipated = effect.power[0];
    }
    if (actuator) {
        *actuator = effect.power[1] + rate;
    }
    return SE3D_OK;
}
