/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: creation of bushings, friction, stops and callbacks. */
#include "force/force.h"
#include "math/vec3.h"
#include "system/coordinate.h"
#include "system/force_internal.h"

#include <math.h>
#include <string.h>

void se3d_bushing_def_init(se3d_bushing_def *def, size_t size)
{
    se3d_bushing_def defaults = {.struct_size = size,
                                 .orientation_i = {1.0, 0.0, 0.0, 0.0},
                                 .orientation_j = {1.0, 0.0, 0.0, 0.0}};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_friction_def_init(se3d_friction_def *def, size_t size)
{
    se3d_friction_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_stop_def_init(se3d_stop_def *def, size_t size)
{
    se3d_stop_def defaults = {.struct_size = size,
                              .lower = -(double)INFINITY,
                              .upper = (double)INFINITY,
                              .restitution = 1.0};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

void se3d_force_callback_def_init(se3d_force_callback_def *def, size_t size)
{
    se3d_force_callback_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status find_pair(se3d_system *system, se3d_body i, se3d_body j, se3di_force *data)
{
    SE3DI_TRY(se3di_find_body(system, "body_i", i, &data->body_i));
    SE3DI_TRY(se3di_find_body(system, "body_j", j, &data->body_j));
    return se3di_force_check_pair(system, data);
}

se3d_status se3d_force_create_bushing(se3d_system *system, const se3d_bushing_def *def,
                                      se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_bushing_def, "bushing def", SE3DI_FORCE_BUSHING);
    SE3DI_TRY(find_pair(system, full.body_i, full.body_j, &data));
    SE3DI_TRY(se3di_check_finites(system, "point_i", full.point_i, 3));
    SE3DI_TRY(se3di_check_finites(system, "point_j", full.point_j, 3));
    SE3DI_TRY(se3di_check_orientation(system, "orientation_i", full.orientation_i, data.p_i));
    SE3DI_TRY(se3di_check_orientation(system, "orientation_j", full.orientation_j, data.p_j));
    SE3DI_TRY(se3di_force_take_bushing(system, full.K, full.C, &data));
    se3di_copy(full.point_i, data.s_i);
    se3di_copy(full.point_j, data.s_j);
    return se3di_force_add(system, &data, force);
}

/* The joint whose coordinate an element acts on. */
static se3d_status find_coordinate(se3d_system *system, se3d_constraint handle, int32_t coordinate,
                                   se3di_force *data)
{
    uint32_t joint;
    se3di_term term;
    SE3DI_TRY(se3di_find_constraint(system, "joint", handle, &joint));
    SE3DI_TRY(se3di_check_coordinate(system, "coordinate", joint, coordinate, &term));
    const se3di_constraint *constraint = &system->model.constraints[joint];
    data->joint = (int32_t)joint;
    data->angle = constraint->angle;
    data->coordinate = coordinate;
    data->body_i = constraint->bodies[0];
    data->body_j = constraint->bodies[1];
    return SE3D_OK;
}

se3d_status se3d_force_create_friction(se3d_system *system, const se3d_friction_def *def,
                                       se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_friction_def, "friction def", SE3DI_FORCE_FRICTION);
    SE3DI_TRY(find_coordinate(system, full.joint, full.coordinate, &data));
    data.mu = full.mu;
    data.mu_static = full.mu_static;
    data.radius = full.radius;
    data.limit = full.limit;
    data.viscous = full.viscous;
    data.presliding = full.presliding;
    data.length = full.length;
    data.width = full.width;
    data.thrust_radius = full.thrust_radius;
    SE3DI_TRY(se3di_force_check_values(system, &data));
    return se3di_force_add(system, &data, force);
}

se3d_status se3d_force_create_stop(se3d_system *system, const se3d_stop_def *def, se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_stop_def, "stop def", SE3DI_FORCE_STOP);
    if (full.joint.index1 == 0 && full.joint.generation == 0 && full.body_j.index1 != 0) {
        data.coordinate = SE3DI_FORCE_LENGTH;
        SE3DI_TRY(find_pair(system, full.body_i, full.body_j, &data));
        SE3DI_TRY(se3di_check_finites(system, "point_i", full.point_i, 3));
        SE3DI_TRY(se3di_check_finites(system, "point_j", full.point_j, 3));
        se3di_copy(full.point_i, data.s_i);
        se3di_copy(full.point_j, data.s_j);
    } else {
        SE3DI_TRY(find_coordinate(system, full.joint, full.coordinate, &data));
    }
    data.low = full.lower;
    data.high = full.upper;
    data.k = full.k;
    data.restitution = full.restitution;
    SE3DI_TRY(se3di_force_check_values(system, &data));
    return se3di_force_add(system, &data, force);
}

void se3d_effort_def_init(se3d_effort_def *def, size_t size)
{
    se3d_effort_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

se3d_status se3d_force_create_effort(se3d_system *system, const se3d_effort_def *def,
                                     se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_effort_def, "effort def", SE3DI_FORCE_EFFORT);
    SE3DI_TRY(find_coordinate(system, full.joint, full.coordinate, &data));
    SE3DI_TRY(se3di_check_finite(system, "value", full.value));
    SE3DI_TRY(se3di_find_law(system, "function", full.function, 3, &data.function[0]));
    data.value[0] = full.value;
    return se3di_force_add(system, &data, force);
}

void se3d_armature_def_init(se3d_armature_def *def, size_t size)
{
    se3d_armature_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

/* A screw has one freedom: its displacement goes with the angle. */
static se3d_status check_screw(se3d_system *system, const se3di_force *data)
{
    const se3di_constraint *joint = &system->model.constraints[data->joint];
    if (strcmp(joint->type, "screw") == 0 && data->coordinate != SE3D_JOINT_COORDINATE_ANGLE) {
        return SE3DI_FAIL_OF(system, "coordinate", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be SE3D_JOINT_COORDINATE_ANGLE (%d) on a screw",
                             (int)data->coordinate, (int)SE3D_JOINT_COORDINATE_ANGLE);
    }
    return SE3D_OK;
}

se3d_status se3d_force_create_armature(se3d_system *system, const se3d_armature_def *def,
                                       se3d_force *force)
{
    SE3DI_TRY(se3di_force_begin(system, force));
    se3d_armature_def full = se3d_armature_def_default();
    SE3DI_TRY(se3di_check_def(system, "armature def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_new_name(system, &system->model.force_slots, 0, "force", full.name));
    se3di_force data = se3di_force_blank(SE3DI_FORCE_ARMATURE, full.name);
    SE3DI_TRY(find_coordinate(system, full.joint, full.coordinate, &data));
    SE3DI_TRY(check_screw(system, &data));
    data.value[0] = full.inertia;
    SE3DI_TRY(se3di_force_check_values(system, &data));
    return se3di_force_add(system, &data, force);
}

se3d_status se3d_force_create_callback(se3d_system *system, const se3d_force_callback_def *def,
                                       se3d_force *force)
{
    SE3DI_FORCE_BEGIN(se3d_force_callback_def, "callback def", SE3DI_FORCE_CALLBACK);
    SE3DI_TRY(find_pair(system, full.body_i, full.body_j, &data));
    if (!full.callback) {
        return SE3DI_FAIL(system, SE3D_ERR_NULL, "callback is NULL");
    }
    data.callback = full.callback;
    data.ctx = full.ctx;
    data.has_jacobian = full.has_jacobian != 0;
    data.energy = full.energy;
    return se3di_force_add(system, &data, force);
}
