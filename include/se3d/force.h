/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: springs, dampers, actuators, applied forces and torques. */
#ifndef SE3D_FORCE_H
#define SE3D_FORCE_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Translational spring-damper-actuator between two points:
 * f = k (l - l0) + c ldot + h(t, l, ldot), positive pulls the points together. @since 0.1 */
typedef struct se3d_tsda_def {
    size_t struct_size;
    const char *name;
    se3d_body body_i;
    se3d_body body_j;
    double point_i[3]; /* body frames [m] */
    double point_j[3];
    double k;        /* [N/m] */
    double c;        /* [N s/m] */
    double l0;       /* free length [m], >= 0 */
    se3d_function h; /* actuator of (t, l, ldot) [N], or null */
} se3d_tsda_def;

SE3D_API void se3d_tsda_def_init(se3d_tsda_def *def, size_t size);

static inline se3d_tsda_def se3d_tsda_def_default(void)
{
    se3d_tsda_def def;
    se3d_tsda_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_force_create_tsda(se3d_system *system, const se3d_tsda_def *def,
                                            se3d_force *force);

/* Rotational spring-damper-actuator about the axis of a joint with an angle:
 * n = k (theta - theta0) + c thetadot + h(t, theta, thetadot), acts on j as -n about the axis.
 * @since 0.1 */
typedef struct se3d_rsda_def {
    size_t struct_size;
    const char *name;
    se3d_constraint joint; /* a joint with an angle */
    double k;              /* [N m/rad] */
    double c;              /* [N m s/rad] */
    double theta0;         /* [rad] */
    se3d_function h;       /* actuator of (t, theta, thetadot) [N m], or null */
} se3d_rsda_def;

SE3D_API void se3d_rsda_def_init(se3d_rsda_def *def, size_t size);

static inline se3d_rsda_def se3d_rsda_def_default(void)
{
    se3d_rsda_def def;
    se3d_rsda_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_force_create_rsda(se3d_system *system, const se3d_rsda_def *def,
                                            se3d_force *force);

/* A force at a point, or a torque, on a body: constant or functions of time. @since 0.1 */
typedef struct se3d_load_def {
    size_t struct_size;
    const char *name;
    se3d_body body;
    double point[3];           /* force: where it acts, body frame [m] */
    double value[3];           /* where the function is null [N, N m] */
    se3d_function function[3]; /* of t, or null */
    int32_t in_body_frame;     /* not 0: components in the body frame, else in the ground frame */
    int32_t reserved;
} se3d_load_def;

SE3D_API void se3d_load_def_init(se3d_load_def *def, size_t size);

static inline se3d_load_def se3d_load_def_default(void)
{
    se3d_load_def def;
    se3d_load_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_force_create_load(se3d_system *system, const se3d_load_def *def,
                                            se3d_force *force);
SE3D_API se3d_status se3d_force_create_torque(se3d_system *system, const se3d_load_def *def,
                                              se3d_force *force);

SE3D_API se3d_status se3d_force_destroy(se3d_system *system, se3d_force force);
SE3D_API se3d_status se3d_force_find(const se3d_system *system, const char *name,
                                     se3d_force *force);
SE3D_API se3d_status se3d_force_get_name(const se3d_system *system, se3d_force force,
                                         const char **name);
/* Get the type as in the model file: "tsda", "rsda", "force", "torque". Reader. @since 0.1 */
SE3D_API se3d_status se3d_force_get_type(const se3d_system *system, se3d_force force,
                                         const char **type);
/* Get length or angle, its rate and the force f or torque n of a tsda or rsda. Reader. @since 0.1
 */
SE3D_API se3d_status se3d_force_get_state(const se3d_system *system, se3d_force force,
                                          double *coordinate, double *rate, double *value);

#ifdef __cplusplus
}
#endif
#endif
