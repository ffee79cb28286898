/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigid bodies and markers (points with a frame on a body).
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_BODY_H
#define SE3D_BODY_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The definition of a body. @since 0.1 */
typedef struct se3d_body_def {
    size_t struct_size;
    const char *name;   /* copied; NULL or unique in the system */
    double mass;        /* [kg] > 0; required unless fixed */
    double inertia[6];  /* about the centre of mass, body frame [kg m^2]: xx yy zz xy yz xz, where
                           xy is the matrix entry J(1,2) = -integral x y dm */
    double position[3]; /* centre of mass, ground frame [m] */
    double orientation[4];      /* Euler parameters, unit to 1e-6; normalised; default (1,0,0,0) */
    double velocity[3];         /* ground frame [m/s] */
    double angular_velocity[3]; /* body frame [rad/s] */
    int32_t fixed;              /* not 0: immovable, like the ground */
    int32_t reserved;           /* 0 */
} se3d_body_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_body_def_default. @since 0.1 */
SE3D_API void se3d_body_def_init(se3d_body_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_body_def se3d_body_def_default(void)
{
    se3d_body_def def;
    se3d_body_def_init(&def, sizeof def);
    return def;
}

/* Create a body. Its inertia must be positive definite, and no principal moment may exceed the
 * sum of the other two. Mass and inertia of a fixed body are ignored; its velocities must be
 * zero. @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_body_create(se3d_system *system, const se3d_body_def *def,
                                      se3d_body *body);

/* Get the definition of a body, with the state of now. Set def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_def(const se3d_system *system, se3d_body body,
                                       se3d_body_def *def);

/* Define a body again: it takes mass, inertia and state of the definition, and keeps its handle,
 * its name and what is attached to it. Joints and others that were made of its pose do not follow.
 * All that defines an element again is an edit as its creation is, fails as that does and changes
 * nothing then; def->name is not looked at.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of the ground).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_def(se3d_system *system, se3d_body body,
                                       const se3d_body_def *def);

/* Destroy a body. @return OK, NULL, STALE_HANDLE, IN_USE (an element is attached),
 * INVALID_ARGUMENT (the ground). @since 0.1 */
SE3D_API se3d_status se3d_body_destroy(se3d_system *system, se3d_body body);

/* Find a body by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_find(const se3d_system *system, const char *name, se3d_body *body);

/* Get the name of a body.
 * @param[out] name  "" if it has none; valid until the system is edited
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_name(const se3d_system *system, se3d_body body,
                                        const char **name);

/* Tell whether a body is fixed to the ground.
 * @param[out] fixed  not 0: it never moves
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_fixed(const se3d_system *system, se3d_body body, int32_t *fixed);

/* Hold a body, or stop to hold it (the default). The assembly analysis keeps the pose and velocity
 * of held bodies and moves the others.
 * @param[in] held  not 0: hold it
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_held(se3d_system *system, se3d_body body, int32_t held);

/* Tell whether a body is held: see se3d_body_set_held.
 * @param[out] held  not 0: it is held
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_held(const se3d_system *system, se3d_body body, int32_t *held);

/* Get the mass and the inertia of a body; one of the two may be NULL. Both are 0 for a fixed body.
 * @param[out] mass     [kg]
 * @param[out] inertia  about the centre of mass, body frame [kg m^2]: xx yy zz xy yz xz, as in the
 *                      definition
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_mass(const se3d_system *system, se3d_body body, double *mass,
                                        double inertia[6]);

/* Set the mass and the inertia of a body that is not fixed. The next step begins with them.
 * @param[in] mass     [kg] > 0
 * @param[in] inertia  about the centre of mass, body frame [kg m^2]: xx yy zz xy yz xz, as in the
 *                     definition
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_mass(se3d_system *system, se3d_body body, double mass,
                                        const double inertia[6]);

/* Get the position of the centre of mass.
 * @param[out] r  ground frame [m]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_position(const se3d_system *system, se3d_body body, double r[3]);

/* Set the position of the centre of mass. Setters of the state do not check the constraints: the
 * next analysis makes the state consistent.
 * @param[in] r  ground frame [m]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not finite, or the ground).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_position(se3d_system *system, se3d_body body, const double r[3]);

/* Get the orientation of a body.
 * @param[out] p  Euler parameters, body -> ground, scalar first
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_orientation(const se3d_system *system, se3d_body body,
                                               double p[4]);

/* Set the orientation of a body, as se3d_body_set_position sets its position.
 * @param[in] p  Euler parameters, body -> ground, scalar first, of unit length to 1e-6; normalised
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no unit length, or the ground).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_orientation(se3d_system *system, se3d_body body,
                                               const double p[4]);

/* Get the velocity of the centre of mass.
 * @param[out] v  ground frame [m/s]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_velocity(const se3d_system *system, se3d_body body, double v[3]);

/* Set the velocity of the centre of mass, as se3d_body_set_position sets its position.
 * @param[in] v  ground frame [m/s]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not finite, or a fixed body).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_velocity(se3d_system *system, se3d_body body, const double v[3]);

/* Get the angular velocity of a body.
 * @param[out] w  body frame [rad/s]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_angular_velocity(const se3d_system *system, se3d_body body,
                                                    double w[3]);

/* Set the angular velocity of a body, as se3d_body_set_position sets its position.
 * @param[in] w  body frame [rad/s]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not finite, or a fixed body).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_angular_velocity(se3d_system *system, se3d_body body,
                                                    const double w[3]);

/* Get the acceleration of the centre of mass that the last analysis computed.
 * @param[out] a  ground frame [m/s^2]
 * @return OK, NULL, STALE_HANDLE, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_acceleration(const se3d_system *system, se3d_body body,
                                                double a[3]);

/* Get the angular acceleration of a body that the last analysis computed.
 * @param[out] alpha  body frame [rad/s^2]
 * @return OK, NULL, STALE_HANDLE, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_angular_acceleration(const se3d_system *system, se3d_body body,
                                                        double alpha[3]);

/* Map a point of a body to the ground frame.
 * @param[in] local    the point, body frame [m]
 * @param[out] ground  the point, ground frame [m]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_point(const se3d_system *system, se3d_body body,
                                         const double local[3], double ground[3]);

/* The motion of a body, as callbacks of forces and constraints see it. @since 0.1 */
typedef struct se3d_body_motion {
    double r[3]; /* centre of mass, ground frame [m] */
    double p[4]; /* Euler parameters */
    double v[3]; /* ground frame [m/s] */
    double w[3]; /* body frame [rad/s] */
} se3d_body_motion;

/* Get the motion of a body as callbacks see it. @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_body_get_motion(const se3d_system *system, se3d_body body,
                                          se3d_body_motion *motion);

/* Get the rotation matrix of a motion.
 * @param[out] A  row-major [1], body -> ground: its columns are the axes of the body
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_motion_get_rotation(const se3d_body_motion *motion, double A[9]);

/* Get the motion of a point of a body. NULL arrays are skipped.
 * @param[in] local         the point, body frame [m]
 * @param[out] position     ground frame [m]
 * @param[out] velocity     ground frame [m/s]
 * @param[out] centripetal  its acceleration if those of the body are zero, ground frame [m/s^2]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_motion_get_point(const se3d_body_motion *motion, const double local[3],
                                           double position[3], double velocity[3],
                                           double centripetal[3]);

/* Get the derivatives of the position of a point of a body, as the Jacobians of callbacks have
 * them.
 * @param[in] local      the point, body frame [m]
 * @param[out] jacobian  [3 * 6], row-major: d position / d (dr, dtheta), ground frame [1, m]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_motion_get_jacobian(const se3d_body_motion *motion, const double local[3],
                                              double jacobian[18]);

/* Add a force at a point of a body to the wrench that a force callback gives for it: the force at
 * the centre of mass (ground frame), its torque about that (body frame).
 * @param[in] local   where it acts, body frame [m]
 * @param[in] force   ground frame [N]
 * @param[in] wrench  six of the numbers of the callback, for one body: ground and body frame
 *                    [N, N m]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_motion_add_force(const se3d_body_motion *motion, const double local[3],
                                           const double force[3], double wrench[6]);

/* Add a torque on a body to the wrench that a force callback gives for it.
 * @param[in] torque  ground frame [N m]
 * @param[in] wrench  as in se3d_motion_add_force: ground and body frame [N, N m]
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_motion_add_torque(const se3d_body_motion *motion, const double torque[3],
                                            double wrench[6]);

/* Get the states of all bodies in creation order, the ground first. Arrays that are NULL are
 * skipped.
 * @param[in] count  must be se3d_system_count_bodies
 * @param[out] r     [count * 3] centres of mass, ground frame [m]
 * @param[out] p     [count * 4] Euler parameters, body -> ground
 * @param[out] v     [count * 3] ground frame [m/s]
 * @param[out] w     [count * 3] body frames [rad/s]
 * @return OK, NULL, INVALID_ARGUMENT (count).
 * @since 0.1 */
SE3D_API se3d_status se3d_body_get_all(const se3d_system *system, size_t count, double *r,
                                       double *p, double *v, double *w);

/* Set the states of all bodies, as se3d_body_set_position does; fixed bodies are skipped. Arrays
 * that are NULL leave their quantity alone.
 * @param[in] count  must be se3d_system_count_bodies
 * @param[in] r      [count * 3] centres of mass, ground frame [m]
 * @param[in] p      [count * 4] Euler parameters, body -> ground, of unit length to 1e-6;
 *                   normalised
 * @param[in] v      [count * 3] ground frame [m/s]
 * @param[in] w      [count * 3] body frames [rad/s]
 * @return OK, NULL, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_all(se3d_system *system, size_t count, const double *r,
                                       const double *p, const double *v, const double *w);

/* The definition of a marker. @since 0.1 */
typedef struct se3d_marker_def {
    size_t struct_size;
    const char *name;      /* copied; unique on its body */
    se3d_body body;        /* that it is on */
    double position[3];    /* body frame [m] */
    double orientation[4]; /* marker -> body, Euler parameters; default (1,0,0,0) */
} se3d_marker_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_marker_def_default. @since 0.1 */
SE3D_API void se3d_marker_def_init(se3d_marker_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_marker_def se3d_marker_def_default(void)
{
    se3d_marker_def def;
    se3d_marker_def_init(&def, sizeof def);
    return def;
}

/* Create a marker. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_marker_create(se3d_system *system, const se3d_marker_def *def,
                                        se3d_marker *marker);

/* Get the definition of a marker. Set def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_get_def(const se3d_system *system, se3d_marker marker,
                                         se3d_marker_def *def);

/* Define a marker again, on its body: see se3d_body_set_def.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of another body).
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_set_def(se3d_system *system, se3d_marker marker,
                                         const se3d_marker_def *def);

/* Destroy a marker. @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_marker_destroy(se3d_system *system, se3d_marker marker);

/* Find a marker by its name.
 * @param[in] name  UTF-8, among the markers of the body
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_find(const se3d_system *system, se3d_body body, const char *name,
                                      se3d_marker *marker);

/* Get the name of a marker.
 * @param[out] name  "" if it has none; valid until the system is edited
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_get_name(const se3d_system *system, se3d_marker marker,
                                          const char **name);

/* Get the body that a marker is on. @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_marker_get_body(const se3d_system *system, se3d_marker marker,
                                          se3d_body *body);

/* Get the position of the origin of a marker.
 * @param[out] r  ground frame [m]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_get_position(const se3d_system *system, se3d_marker marker,
                                              double r[3]);

/* Get the velocity of the origin of a marker.
 * @param[out] v  ground frame [m/s]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_get_velocity(const se3d_system *system, se3d_marker marker,
                                              double v[3]);

/* Get the acceleration of the origin of a marker, by the accelerations that the last analysis
 * computed.
 * @param[out] a  ground frame [m/s^2]
 * @return OK, NULL, STALE_HANDLE, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_get_acceleration(const se3d_system *system, se3d_marker marker,
                                                  double a[3]);

/* Get the orientation of a marker.
 * @param[out] p  Euler parameters, marker -> ground, scalar first
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_marker_get_orientation(const se3d_system *system, se3d_marker marker,
                                                 double p[4]);

#ifdef __cplusplus
}
#endif
#endif
