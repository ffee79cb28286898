/* SPDX-License-Identifier: BSD-3-Clause */
/* Joint coordinates of a system: a spanning tree of its joints from the ground, and what follows
 * from them without a step: accelerations, efforts, mass matrix, Jacobians, momentum.
 *
 *     M qddot + h = effort + J_loop^T (...)
 *
 * Every moving body hangs on the ground or on another body by one joint of the tree, or by six
 * freedoms where no joint reaches it. The state stays that of the bodies: nothing is kept from one
 * call to the next that could be seen. Matrices are row-major; q has position_count numbers,
 * everything else along the coordinates count of them.
 *
 *     joint                q                        velocities
 *     fixed                -                        -
 *     revolute, screw      angle                    its rate
 *     prismatic            displacement             its rate
 *     cylindrical          angle, displacement      their rates
 *     universal            turn about the parent's axis, about the own one; rates
 *     planar               two displacements along the parent's directions, angle; rates
 *     spherical            unit quaternion (4)      relative angular velocity, child's frame (3)
 *     none (free)          r, p (7)                 v (ground frame), w (body frame) (6)
 *
 * Angles and displacements are those of se3d_joint_get_coordinate.
 * docs/theory/joint_coordinates.md
 *
 * Threads: the rule of se3d/se3d.h; these functions need exclusive access to the system. */
#ifndef SE3D_COORDINATES_H
#define SE3D_COORDINATES_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Build the tree of a system, with all memory that the functions below need. It is for the system's
 * present structure: after an element came, went or was changed, make it anew (functions return
 * STATE until then). @return OK, NULL, STATE, NO_MEMORY, UNSUPPORTED (armatures on all joints of a
 * loop). @since 0.1 */
SE3D_API se3d_status se3d_coordinates_create(se3d_system *system, se3d_coordinates **coordinates);

/* Destroy joint coordinates, before or after their system; NULL is fine. @since 0.1 */
SE3D_API void se3d_coordinates_destroy(se3d_coordinates *coordinates);

/* Count the velocities. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_coordinates_count(const se3d_coordinates *coordinates);

/* Count the positions. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_coordinates_count_positions(const se3d_coordinates *coordinates);

/* Count the equations that the tree leaves: of joints that close loops, primitives, couplers and
 * others. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_coordinates_count_loop_rows(const se3d_coordinates *coordinates);

/* Tell what a velocity belongs to. NULL ones are skipped.
 * @param[in] index       of the velocity
 * @param[out] joint      null: the body is free
 * @param[out] body       that the joint moves relative to its parent
 * @param[out] parent     the other side
 * @param[out] component  of the joint's velocities, from 0
 * @param[out] position   the joint's first position
 * @return OK, NULL, STATE, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_get_entry(se3d_coordinates *coordinates, size_t index,
                                                se3d_constraint *joint, se3d_body *body,
                                                se3d_body *parent, size_t *component,
                                                size_t *position);

/* Get the coordinates of the present state. NULL ones are skipped.
 * @param[out] q     [positions]
 * @param[out] qdot  [velocities]
 * @return OK, NULL, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_get(se3d_coordinates *coordinates, double *q, double *qdot);

/* Set poses and velocities of all moving bodies from coordinates. Quaternions are made unit ones,
 * angles keep their turns; equations of loops are not solved (an analysis does). NULL ones stay as
 * they are: with q NULL no body moves, also where poses violate joints of the tree.
 * @param[in] q     [positions] [rad, m]
 * @param[in] qdot  [velocities] [rad/s, m/s]
 * @return OK, NULL, STATE, NOT_FINITE (also of what follows for the bodies), INVALID_ARGUMENT (a
 * quaternion of zero, or too long); nothing is set then.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_set(se3d_coordinates *coordinates, const double *q,
                                          const double *qdot);

/* Move positions by velocities times a time.
 * @param[in] q     [positions]
 * @param[in] dq    [velocities] displacement; of quaternions: rotation vector, child's frame
 * @param[out] out  [positions]; may be q
 * @return OK, NULL, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_move(se3d_coordinates *coordinates, const double *q,
                                           const double *dq, double *out);

/* Compute accelerations at the present state: articulated bodies, equations of loops and drivers
 * included, forces of the elements included; friction is what the last analysis left of it.
 * @param[in] effort  [velocities] that act along the coordinates besides [N, N m]; NULL: none
 * @param[out] qddot  [velocities]
 * @return OK, INFO_REDUNDANT, NULL, STATE, SINGULAR, NOT_FINITE, NO_CONVERGENCE, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_accelerations(se3d_coordinates *coordinates,
                                                            const double *effort, double *qddot);

/* Compute the efforts that give accelerations, against inertia and all force elements: inverse
 * dynamics of the tree. Of a free body, they are the force on its centre of mass (ground frame) and
 * the torque (body frame). Loops and drivers take no part: they may give any of J_loop^T lambda.
 * @param[in] qddot    [velocities]; NULL: zero, which gives the bias h
 * @param[out] effort  [velocities]
 * @return OK, NULL, STATE, SINGULAR, NOT_FINITE, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_efforts(se3d_coordinates *coordinates,
                                                      const double *qddot, double *effort);

/* Compute the efforts that hold the weights of all bodies.
 * @param[out] effort  [velocities]
 * @return OK, NULL, STATE, NOT_FINITE, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_gravity(se3d_coordinates *coordinates,
                                                      double *effort);

/* Compute the mass matrix of the tree.
 * @param[out] M  [velocities x velocities]
 * @return OK, NULL, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_mass_matrix(se3d_coordinates *coordinates, double *M);

/* Compute M x without the matrix.
 * @param[in] x     [velocities]
 * @param[out] out  [velocities]
 * @return OK, NULL, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_multiply_mass(se3d_coordinates *coordinates, const double *x,
                                                    double *out);

/* Solve M out = x without the matrix, drivers and loops left aside.
 * @param[in] x     [velocities]
 * @param[out] out  [velocities]
 * @return OK, NULL, STATE, SINGULAR.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_solve_mass(se3d_coordinates *coordinates, const double *x,
                                                 double *out);

/* Compute the Jacobian of a marker's motion, and its rate. NULL ones are skipped.
 * @param[out] J     [6 x velocities]: angular velocity, velocity of the origin; ground frame
 * @param[out] rate  [6 x velocities]: dJ/dt [1/s]
 * @return OK, NULL, STATE, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_jacobian(se3d_coordinates *coordinates,
                                                       se3d_marker marker, double *J, double *rate);

/* Compute what a wrench at a marker does along the coordinates, J^T (torque, force).
 * @param[in] wrench   torque [N m], force [N]; ground frame
 * @param[out] effort  [velocities]
 * @return OK, NULL, STATE, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_transposed(se3d_coordinates *coordinates,
                                                         se3d_marker marker, const double wrench[6],
                                                         double *effort);

/* Compute the momentum about the common centre of mass, and its matrix. NULL ones are skipped.
 * @param[out] momentum  angular [N m s], linear [N s]; ground frame
 * @param[out] H         [6 x velocities]: momentum = H qdot
 * @return OK, NULL, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_momentum(se3d_coordinates *coordinates,
                                                       double momentum[6], double *H);

/* Compute the Jacobian of the equations that the tree leaves.
 * @param[out] G  [loop rows x velocities]
 * @return OK, NULL, STATE, CALLBACK, NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_loop_jacobian(se3d_coordinates *coordinates,
                                                            double *G);

/* Compute an orthonormal basis of the velocities that loops and drivers leave. Takes memory of its
 * own while it works.
 * @param[out] N         [freedoms x velocities]; room for velocities x velocities
 * @param[out] freedoms  rows of N
 * @return OK, NULL, STATE, NO_MEMORY, CALLBACK, NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_coordinates_compute_null_space(se3d_coordinates *coordinates, double *N,
                                                         size_t *freedoms);

#ifdef __cplusplus
}
#endif
#endif
