/* SPDX-License-Identifier: BSD-3-Clause */
#include "system/coordinate.h"

#include "joint/equation.h"

se3d_status se3di_check_coordinate(se3d_system *system, const char *what, uint32_t joint,
                                   int32_t coordinate, se3di_term *term)
{
    if (coordinate != SE3D_JOINT_COORDINATE_ANGLE &&
        coordinate != SE3D_JOINT_COORDINATE_DISPLACEMENT) {
        return SE3DI_FAIL_OF(
            system, what, SE3D_ERR_INVALID_ARGUMENT,
            " = %d, must be SE3D_JOINT_COORDINATE_ANGLE or SE3D_JOINT_COORDINATE_DISPLACEMENT",
            (int)coordinate);
    }
    if (se3di_coordinate_term(&system->model, joint, coordinate, term)) {
        return SE3D_OK;
    }
    static const char *const allowed[4] = {
        "must be a coordinate that the joint has", "must be SE3D_JOINT_COORDINATE_ANGLE (0)",
        "must be SE3D_JOINT_COORDINATE_DISPLACEMENT (1)", "must be one of the two"};
    const se3di_constraint *constraint = &system->model.constraints[joint];
    int which = (constraint->angle >= 0) + 2 * (constraint->has_displacement != 0);
    return SE3DI_FAIL_OF(
        system, what, SE3D_ERR_INVALID_ARGUMENT, " = %d: '%.64s' (%s) has no %s, %s",
        (int)coordinate, constraint->name ? constraint->name : "", constraint->type,
        coordinate == SE3D_JOINT_COORDINATE_ANGLE ? "angle" : "displacement", allowed[which]);
}

se3d_status se3di_check_distinct(se3d_system *system, const uint32_t bodies[2])
{
    if (bodies[0] != bodies[1]) {
        return SE3D_OK;
    }
    const char *name = system->model.bodies[bodies[0]].name;
    return SE3DI_FAIL_OF(system, "body_i", SE3D_ERR_INVALID_ARGUMENT,
                         " and body_j are the same body '%.64s', must be two bodies",
                         name ? name : "");
}

se3d_status se3di_check_prescribed(se3d_system *system, double value, int32_t function)
{
    const se3di_function *f = function >= 0 ? &system->model.functions[function] : NULL;
    if (f && f->table && f->table_kind == SE3D_TABLE_LINEAR && !f->integral) {
        return SE3DI_FAIL_OF(system, "function", SE3D_ERR_INVALID_ARGUMENT,
                             " is a linear table, whose rate jumps at its points: give a cubic or "
                             "Akima table, or a linear one of its rate");
    }
    return f ? SE3D_OK : se3di_check_finite(system, "value", value);
}

se3d_status se3di_constraint_add(se3d_system *system, const se3di_draft *draft,
                                 se3d_constraint *constraint)
{
    se3di_handle handle;
    se3d_status status = se3di_model_add_constraint(&system->model, draft, &handle);
    if (status < 0) {
        return se3di_fail_added(system, status, draft->constraint.type);
    }
    *constraint = (se3d_constraint){handle.index1, handle.generation};
    return SE3D_OK;
}
