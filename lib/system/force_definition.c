/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: definitions of force elements, as they can be given again. */
#include "math/vec3.h"
#include "system/definition.h"
#include "system/force_internal.h"

#include <string.h>

/* The element of a reader, of one of two types. */
static se3d_status find(const se3d_system *system, se3d_force force, const void *def, int32_t type,
                        const se3di_force **data)
{
    SE3DI_TRY(se3di_force_find_reader(system, force, def, data));
    return (*data)->type == type ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

/* What every reader of a definition begins with: declares `model`, `data`, the element, and `full`,
 * a definition with its name. */
#define BEGIN(definition, type)                                                                    \
    const se3di_force *data;                                                                       \
    SE3DI_TRY(find(system, force, def, type, &data));                                              \
    const se3di_model *model = &system->model;                                                     \
    definition full = definition##_default();                                                      \
    full.struct_size = def->struct_size;                                                           \
    full.name = data->name

static se3d_function law(const se3di_model *model, const se3di_force *data, int place)
{
    return se3di_function_handle(model, data->function[place]);
}

se3d_status se3d_force_get_tsda(const se3d_system *system, se3d_force force, se3d_tsda_def *def)
{
    BEGIN(se3d_tsda_def, SE3DI_FORCE_TSDA);
    full.body_i = se3di_body_handle(model, data->body_i);
    full.body_j = se3di_body_handle(model, data->body_j);
    se3di_copy(data->s_i, full.point_i);
    se3di_copy(data->s_j, full.point_j);
    full.k = data->k;
    full.c = data->c;
    full.l0 = data->rest;
    full.preload = data->preload;
    full.h = law(model, data, 0);
    full.spring = law(model, data, 3);
    full.damper = law(model, data, 4);
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_rsda(const se3d_system *system, se3d_force force, se3d_rsda_def *def)
{
    BEGIN(se3d_rsda_def, SE3DI_FORCE_RSDA);
    full.joint = se3di_constraint_handle(model, data->joint);
    full.k = data->k;
    full.c = data->c;
    full.theta0 = data->rest;
    full.preload = data->preload;
    full.h = law(model, data, 0);
    full.spring = law(model, data, 3);
    full.damper = law(model, data, 4);
    if (data->joint < 0) {
        const se3di_term *angle = &model->angles[data->angle].term;
        full.body_i = se3di_body_handle(model, data->body_i);
        full.body_j = se3di_body_handle(model, data->body_j);
        se3di_copy(angle->b_i, full.axis_i);
        se3di_copy(angle->a_i, full.ref_i);
        se3di_copy(angle->a_j, full.ref_j);
        full.angle0 = se3di_angle_origin(model, (uint32_t)data->angle);
    }
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_load(const se3d_system *system, se3d_force force, se3d_load_def *def)
{
    const se3di_force *either;
    SE3DI_TRY(se3di_force_find_reader(system, force, def, &either));
    BEGIN(se3d_load_def,
          either->type == SE3DI_FORCE_TORQUE ? SE3DI_FORCE_TORQUE : SE3DI_FORCE_LOAD);
    full.body = se3di_body_handle(model, data->body_j);
    se3di_copy(data->s_j, full.point);
    se3di_copy(data->value, full.value);
    for (int k = 0; k < 3; ++k) {
        full.function[k] = law(model, data, k);
    }
    full.in_body_frame = data->in_body_frame;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_bushing_def(const se3d_system *system, se3d_force force,
                                       se3d_bushing_def *def)
{
    BEGIN(se3d_bushing_def, SE3DI_FORCE_BUSHING);
    full.body_i = se3di_body_handle(model, data->body_i);
    full.body_j = se3di_body_handle(model, data->body_j);
    se3di_copy(data->s_i, full.point_i);
    se3di_copy(data->s_j, full.point_j);
    memcpy(full.orientation_i, data->p_i, sizeof full.orientation_i);
    memcpy(full.orientation_j, data->p_j, sizeof full.orientation_j);
    memcpy(full.K, data->K, sizeof full.K);
    memcpy(full.C, data->C, sizeof full.C);
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_friction(const se3d_system *system, se3d_force force,
                                    se3d_friction_def *def)
{
    BEGIN(se3d_friction_def, SE3DI_FORCE_FRICTION);
    full.joint = se3di_constraint_handle(model, data->joint);
    full.coordinate = data->coordinate;
    full.mu = data->mu;
    full.mu_static = data->mu_static;
    full.radius = data->radius;
    full.limit = data->limit;
    full.viscous = data->viscous;
    full.presliding = data->presliding;
    full.length = data->length;
    full.width = data->width;
    full.thrust_radius = data->thrust_radius;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_stop(const se3d_system *system, se3d_force force, se3d_stop_def *def)
{
    BEGIN(se3d_stop_def, SE3DI_FORCE_STOP);
    full.joint = se3di_constraint_handle(model, data->joint);
    if (data->joint < 0) {
        full.body_i = se3di_body_handle(model, data->body_i);
        full.body_j = se3di_body_handle(model, data->body_j);
        se3di_copy(data->s_i, full.point_i);
        se3di_copy(data->s_j, full.point_j);
    } else {
        full.coordinate = data->coordinate;
    }
    full.lower = data->low;
    full.upper = data->high;
    full.k = data->k;
    full.restitution = data->restitution;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_effort(const se3d_system *system, se3d_force force, se3d_effort_def *def)
{
    BEGIN(se3d_effort_def, SE3DI_FORCE_EFFORT);
    full.joint = se3di_constraint_handle(model, data->joint);
    full.coordinate = data->coordinate;
    full.value = data->value[0];
    full.function = law(model, data, 0);
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_armature(const se3d_system *system, se3d_force force,
                                    se3d_armature_def *def)
{
    BEGIN(se3d_armature_def, SE3DI_FORCE_ARMATURE);
    full.joint = se3di_constraint_handle(model, data->joint);
    full.coordinate = data->coordinate;
    full.inertia = data->value[0];
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

/* Coefficients of a formula that has none are not given. */
se3d_status se3d_force_get_tyre(const se3d_system *system, se3d_force force, se3d_tyre_def *def)
{
    BEGIN(se3d_tyre_def, SE3DI_FORCE_TYRE);
    const se3di_tyre *tyre = data->tyre;
    const int is_magic = tyre->law == SE3D_TYRE_MF52 || tyre->law == SE3D_TYRE_MF61;
    full.road = se3di_body_handle(model, data->body_i);
    full.wheel = se3di_body_handle(model, data->body_j);
    se3di_copy(data->s_i, full.point);
    se3di_copy(tyre->normal, full.normal);
    se3di_copy(data->s_j, full.center);
    se3di_scale(tyre->side == SE3D_TYRE_RIGHT ? -1.0 : 1.0, tyre->axis, full.axis);
    full.side = tyre->side;
    full.measured_side = tyre->mirrored ? SE3D_TYRE_RIGHT - tyre->side : tyre->side;
    full.law = tyre->law;
    full.radius = data->rest;
    full.k = data->k;
    full.c = data->c;
    full.mu = data->mu;
    full.mu_min = tyre->mu_min;
    full.slip_stiffness = tyre->slip_stiffness;
    full.cornering_stiffness = tyre->cornering_stiffness;
    full.patch_length = tyre->patch_length;
    full.rolling_resistance = tyre->rolling_resistance;
    full.rolling_radius = tyre->rolling_radius;
    full.low_speed = tyre->low_speed;
    full.surface = se3di_road_handle(model, tyre->surface);
    full.envelope_length = tyre->envelope[0];
    full.envelope_width = tyre->envelope[1];
    full.coefficients = is_magic ? tyre->coefficients : NULL;
    full.coefficient_count = is_magic ? SE3D_TYRE_COEFFICIENTS : 0;
    full.has_turn_slip = tyre->has_turn_slip;
    full.relaxation_x = tyre->relaxation[0];
    full.relaxation_y = tyre->relaxation[1];
    full.is_transient = (tyre->lags[0] && !(tyre->relaxation[0] > 0.0)) ||
                        (tyre->lags[1] && !(tyre->relaxation[1] > 0.0));
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}

se3d_status se3d_force_get_callback(const se3d_system *system, se3d_force force,
                                    se3d_force_callback_def *def)
{
    BEGIN(se3d_force_callback_def, SE3DI_FORCE_CALLBACK);
    full.body_i = se3di_body_handle(model, data->body_i);
    full.body_j = se3di_body_handle(model, data->body_j);
    full.callback = data->callback;
    full.ctx = data->ctx;
    full.has_jacobian = data->has_jacobian;
    full.energy = data->energy;
    return se3di_sized_give(def, def->struct_size, &full, sizeof full);
}
