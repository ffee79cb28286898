/* SPDX-License-Identifier: BSD-3-Clause */
/* The few rotations that reading a file needs; libse3d-io sees libse3d's public interface only.
 * p = (e0, e1, e2, e3), scalar first; A row-major; both map body to ground. */
#ifndef SE3D_IO_ROTATION_H
#define SE3D_IO_ROTATION_H

/* The largest entry of |A^T A - I|. */
double se3di_rotation_matrix_error(const double A[9]);
double se3di_rotation_matrix_determinant(const double A[9]);
void se3di_rotation_from_matrix(const double A[9], double p[4]);
/* A turn by `angle` about `axis` (any length but zero). */
void se3di_rotation_from_axis(const double axis[3], double angle, double p[4]);
/* Roll about x, then pitch about y, then yaw about z, all fixed axes: A = Rz(yaw) Ry Rx. */
void se3di_rotation_from_rpy(const double angles[3], double p[4]);
void se3di_rotation_to_matrix(const double p[4], double A[9]);
/* v in the body frame of a vector u in the ground frame: v = A^T u. */
void se3di_rotation_apply_inverse(const double p[4], const double u[3], double v[3]);

#endif
