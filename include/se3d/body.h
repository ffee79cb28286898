/* SPDX-License-Identifier: BSD-3-Clause */
/* Rigid bodies and markers (points with a frame on a body). */
#ifndef SE3D_BODY_H
#define SE3D_BODY_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What a body is made with. @since 0.1 */
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

SE3D_API void se3d_body_def_init(se3d_body_def *def, size_t size);

static inline se3d_body_def se3d_body_def_default(void)
{
    se3d_body_def def;
    se3d_body_def_init(&def, sizeof def);
    return def;
}

/* Create a body. Inertia must be positive definite, its principal moments must satisfy the triangle
 * inequality; mass and inertia of a fixed body are ignored.
 * @return OK, NULL, INVALID_ARGUMENT, NO_MEMORY. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_body_create(se3d_system *system, const se3d_body_def *def,
                                      se3d_body *body);
/* Destroy a body. @return OK, STALE_HANDLE, IN_USE (an element is attached), INVALID_ARGUMENT (the
 * ground). Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_body_destroy(se3d_system *system, se3d_body body);

/* Find a body by name. @return OK, INVALID_ARGUMENT (no such name). Reader. @since 0.1 */
SE3D_API se3d_status se3d_body_find(const se3d_system *system, const char *name, se3d_body *body);
/* Get the name, "" where there is none; valid until the system is edited. Reader. @since 0.1 */
SE3D_API se3d_status se3d_body_get_name(const se3d_system *system, se3d_body body,
                                        const char **name);
SE3D_API se3d_status se3d_body_get_fixed(const se3d_system *system, se3d_body body, int32_t *fixed);
/* Hold a body (not 0) or not (0, the default): the assembly analysis leaves the pose and velocity
 * of held bodies as they are and moves the others. @return OK, NULL, STALE_HANDLE. Exclusive.
 * @since 0.1 */
SE3D_API se3d_status se3d_body_set_held(se3d_system *system, se3d_body body, int32_t held);
SE3D_API se3d_status se3d_body_get_held(const se3d_system *system, se3d_body body, int32_t *held);
SE3D_API se3d_status se3d_body_get_mass(const se3d_system *system, se3d_body body, double *mass,
                                        double inertia[6]);
SE3D_API se3d_status se3d_body_set_mass(se3d_system *system, se3d_body body, double mass,
                                        const double inertia[6]);

/* State of a body. Positions, velocities and accelerations of the centre of mass in the ground
 * frame [m, m/s, m/s^2]; orientation: Euler parameters; angular quantities in the body frame
 * [rad/s, rad/s^2]. The setters do not check the constraints (see the assembly analysis). @since
 * 0.1 */
SE3D_API se3d_status se3d_body_get_position(const se3d_system *system, se3d_body body, double r[3]);
SE3D_API se3d_status se3d_body_set_position(se3d_system *system, se3d_body body, const double r[3]);
SE3D_API se3d_status se3d_body_get_orientation(const se3d_system *system, se3d_body body,
                                               double p[4]);
SE3D_API se3d_status se3d_body_set_orientation(se3d_system *system, se3d_body body,
                                               const double p[4]);
SE3D_API se3d_status se3d_body_get_velocity(const se3d_system *system, se3d_body body, double v[3]);
SE3D_API se3d_status se3d_body_set_velocity(se3d_system *system, se3d_body body, const double v[3]);
SE3D_API se3d_status se3d_body_get_angular_velocity(const se3d_system *system, se3d_body body,
                                                    double w[3]);
SE3D_API se3d_status se3d_body_set_angular_velocity(se3d_system *system, se3d_body body,
                                                    const double w[3]);
SE3D_API se3d_status se3d_body_get_acceleration(const se3d_system *system, se3d_body body,
                                                double a[3]);
SE3D_API se3d_status se3d_body_get_angular_acceleration(const se3d_system *system, se3d_body body,
                                                        double alpha[3]);

/* Map a point of the body frame to the ground frame [m]. Reader. @since 0.1 */
SE3D_API se3d_status se3d_body_get_point(const se3d_system *system, se3d_body body,
                                         const double local[3], double ground[3]);

/* The motion of a body, as callbacks of forces and constraints see it. @since 0.1 */
typedef struct se3d_body_motion {
    double r[3]; /* centre of mass, ground frame [m] */
    double p[4]; /* Euler parameters */
    double v[3]; /* ground frame [m/s] */
    double w[3]; /* body frame [rad/s] */
} se3d_body_motion;

/* Bulk access: arrays of `count` bodies in creation order, the ground first (count must be
 * se3d_system_count_bodies): r [count * 3], p [count * 4], v [count * 3], w [count * 3]; NULL
 * arrays are skipped. Setting skips fixed bodies. @since 0.1 */
SE3D_API se3d_status se3d_body_get_all(const se3d_system *system, size_t count, double *r,
                                       double *p, double *v, double *w);
SE3D_API se3d_status se3d_body_set_all(se3d_system *system, size_t count, const double *r,
                                       const double *p, const double *v, const double *w);

/* What a marker is made with. @since 0.1 */
typedef struct se3d_marker_def {
    size_t struct_size;
    const char *name; /* copied; unique on its body */
    se3d_body body;
    double position[3];    /* body frame [m] */
    double orientation[4]; /* marker -> body, Euler parameters; default (1,0,0,0) */
} se3d_marker_def;

SE3D_API void se3d_marker_def_init(se3d_marker_def *def, size_t size);

static inline se3d_marker_def se3d_marker_def_default(void)
{
    se3d_marker_def def;
    se3d_marker_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_marker_create(se3d_system *system, const se3d_marker_def *def,
                                        se3d_marker *marker);
SE3D_API se3d_status se3d_marker_destroy(se3d_system *system, se3d_marker marker);
SE3D_API se3d_status se3d_marker_get_name(const se3d_system *system, se3d_marker marker,
                                          const char **name);
SE3D_API se3d_status se3d_marker_get_body(const se3d_system *system, se3d_marker marker,
                                          se3d_body *body);
/* Position, velocity, acceleration of the marker's origin, ground frame. Reader. @since 0.1 */
SE3D_API se3d_status se3d_marker_get_position(const se3d_system *system, se3d_marker marker,
                                              double r[3]);
SE3D_API se3d_status se3d_marker_get_velocity(const se3d_system *system, se3d_marker marker,
                                              double v[3]);
SE3D_API se3d_status se3d_marker_get_acceleration(const se3d_system *system, se3d_marker marker,
                                                  double a[3]);
/* Orientation marker -> ground, Euler parameters. Reader. @since 0.1 */
SE3D_API se3d_status se3d_marker_get_orientation(const se3d_system *system, se3d_marker marker,
                                                 double p[4]);

#ifdef __cplusplus
}
#endif
#endif
