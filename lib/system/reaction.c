/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: reactions of constraints on their bodies. */
#include "joint/equation.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/system_internal.h"

se3d_status se3d_constraint_get_reaction(const se3d_system *system, se3d_constraint constraint,
                                         double force[3], double torque[3])
{
    const double zero[3] = {0.0, 0.0, 0.0};
    double wrench[6];
    if (force) {
        se3di_copy(zero, force);
    }
    if (torque) {
        se3di_copy(zero, torque);
    }
    if (!system) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    uint32_t index =
        se3di_slots_find(&model->constraint_slots, constraint.index1, constraint.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    SE3DI_TRY(se3di_check_solved(system));
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    se3di_constraint_reaction(model, &model->constraints[index], 1, NULL, wrench);
    se3di_busy_unread(&reading);
    if (!se3di_is_finite(wrench, 6)) {
        return SE3D_ERR_NOT_FINITE;
    }
    if (force) {
        se3di_copy(wrench, force);
    }
    if (torque) {
        se3di_copy(wrench + 3, torque);
    }
    return SE3D_OK;
}

/* Rotate both halves of a wrench from the ground frame into the frame of a marker. */
static void wrench_rotate(const se3di_model *model, uint32_t marker, double wrench[6])
{
    const se3di_marker *m = &model->markers[marker];
    double A[9], local[3];
    se3di_quat_to_matrix(m->p, A);
    for (int half = 0; half < 2; ++half) {
        se3di_mul_transposed(model->frames[m->body].A, wrench + 3 * half, local);
        se3di_mul_transposed(A, local, wrench + 3 * half);
    }
}

se3d_status se3d_constraint_get_reaction_at(const se3d_system *system, se3d_constraint constraint,
                                            size_t slot, const double point[3], se3d_marker marker,
                                            double wrench[6])
{
    for (int k = 0; wrench && k < 6; ++k) {
        wrench[k] = 0.0;
    }
    if (!system || !point || !wrench) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    uint32_t index =
        se3di_slots_find(&model->constraint_slots, constraint.index1, constraint.generation);
    int in_ground = marker.index1 == 0 && marker.generation == 0;
    uint32_t frame = se3di_slots_find(&model->marker_slots, marker.index1, marker.generation);
    if (index == SE3DI_NO_INDEX || (!in_ground && frame == SE3DI_NO_INDEX)) {
        return SE3D_ERR_STALE_HANDLE;
    }
    if (slot >= model->constraints[index].body_count || !se3di_is_finite(point, 3)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    SE3DI_TRY(se3di_check_solved(system));
    double result[6];
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    se3di_constraint_reaction(model, &model->constraints[index], slot, point, result);
    se3di_busy_unread(&reading);
    if (!in_ground) {
        wrench_rotate(model, frame, result);
    }
    if (!se3di_is_finite(result, 6)) {
        return SE3D_ERR_NOT_FINITE;
    }
    for (int k = 0; k < 6; ++k) {
        wrench[k] = result[k];
    }
    return SE3D_OK;
}
