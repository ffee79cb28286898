/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: reactions of constraints on their bodies.
 *
 *     F   = -Phi_r^T lambda                 force on the body, ground frame
 *     n   = -Phi_pi^T lambda                moment about its centre of mass, body frame
 *     T_P = A n + (r - P) x F               torque about the point P, ground frame
 *
 * docs/theory/reactions.md */
#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/coordinate.h"
#include "system/system_internal.h"

/* Force on the body in `slot` and its torque about `point` (NULL: the joint point on body j). */
static void wrench_at(const se3di_model *model, const se3di_constraint *constraint, size_t slot,
                      const double *point, double force[3], double torque[3])
{
    uint32_t body = constraint->bodies[slot];
    double P[3], arm[3], moment[3];
    if (point) {
        se3di_copy(point, P);
    } else {
        const se3di_frame *j = &model->frames[constraint->bodies[1]];
        se3di_mul(j->A, constraint->frames.point_j, P);
        se3di_add(P, j->r, P);
    }
    se3di_constraint_wrench(model, constraint, body, force, torque);
    se3di_sub(model->frames[body].r, P, arm);
    se3di_cross(arm, force, moment);
    se3di_add(torque, moment, torque);
}

se3d_status se3d_constraint_get_reaction(const se3d_system *system, se3d_constraint constraint,
                                         double force[3], double torque[3])
{
    const double zero[3] = {0.0, 0.0, 0.0};
    double F[3], T[3];
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
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    wrench_at(model, &model->constraints[index], 1, NULL, F, T);
    se3di_busy_unread(&reading);
    if (!se3di_is_finite(F, 3) || !se3di_is_finite(T, 3)) {
        return SE3D_ERR_NOT_FINITE;
    }
    if (force) {
        se3di_copy(F, force);
    }
    if (torque) {
        se3di_copy(T, torque);
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
    double result[6];
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    wrench_at(model, &model->constraints[index], slot, point, result, result + 3);
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
