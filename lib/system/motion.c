/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: what callbacks of forces and constraints make of the motion of a body. */
#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/system_internal.h"

se3d_status se3d_body_get_motion(const se3d_system *system, se3d_body body,
                                 se3d_body_motion *motion)
{
    uint32_t index;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, body), SE3DI_HANDLE(body), motion, &index));
    se3di_frame_get_motion(&system->model.frames[index], motion);
    return SE3D_OK;
}

se3d_status se3d_motion_get_rotation(const se3d_body_motion *motion, double A[9])
{
    if (!motion || !A) {
        return SE3D_ERR_NULL;
    }
    se3di_quat_to_matrix(motion->p, A);
    return SE3D_OK;
}

/* r + A s, v + A (w x s), A (w x (w x s)) */
se3d_status se3d_motion_get_point(const se3d_body_motion *motion, const double local[3],
                                  double position[3], double velocity[3], double centripetal[3])
{
    double A[9], turning[3], inward[3];
    if (!motion || !local) {
        return SE3D_ERR_NULL;
    }
    se3di_quat_to_matrix(motion->p, A);
    se3di_cross(motion->w, local, turning);
    se3di_cross(motion->w, turning, inward);
    if (position) {
        se3di_mul(A, local, position);
        se3di_add(motion->r, position, position);
    }
    if (velocity) {
        se3di_mul(A, turning, velocity);
        se3di_add(motion->v, velocity, velocity);
    }
    if (centripetal) {
        se3di_mul(A, inward, centripetal);
    }
    return SE3D_OK;
}

/* [I, -A tilde(s)] */
se3d_status se3d_motion_get_jacobian(const se3d_body_motion *motion, const double local[3],
                                     double jacobian[18])
{
    double A[9], tilde[9], arm[9];
    if (!motion || !local || !jacobian) {
        return SE3D_ERR_NULL;
    }
    se3di_quat_to_matrix(motion->p, A);
    se3di_tilde(local, tilde);
    se3di_mat_mul(A, tilde, arm);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            jacobian[6 * r + c] = r == c ? 1.0 : 0.0;
            jacobian[6 * r + 3 + c] = 0.0 - arm[3 * r + c];
        }
    }
    return SE3D_OK;
}

/* The wrench of a callback has its torque in the body frame. */
se3d_status se3d_motion_add_force(const se3d_body_motion *motion, const double local[3],
                                  const double force[3], double wrench[6])
{
    double A[9], turned[3], torque[3];
    if (!motion || !local || !force || !wrench) {
        return SE3D_ERR_NULL;
    }
    se3di_quat_to_matrix(motion->p, A);
    se3di_mul_transposed(A, force, turned);
    se3di_cross(local, turned, torque);
    se3di_add(wrench, force, wrench);
    se3di_add(wrench + 3, torque, wrench + 3);
    return SE3D_OK;
}

se3d_status se3d_motion_add_torque(const se3d_body_motion *motion, const double torque[3],
                                   double wrench[6])
{
    double A[9], turned[3];
    if (!motion || !torque || !wrench) {
        return SE3D_ERR_NULL;
    }
    se3di_quat_to_matrix(motion->p, A);
    se3di_mul_transposed(A, torque, turned);
    se3di_add(wrench + 3, turned, wrench + 3);
    return SE3D_OK;
}
