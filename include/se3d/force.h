/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: springs, dampers, actuators, applied forces and torques. */
#ifndef SE3D_FORCE_H
#define SE3D_FORCE_H

#include "se3d/body.h" /* se3d_body_motion */
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
    double k;             /* [N/m] */
    double c;             /* [N s/m] */
    double l0;            /* free length [m], >= 0 */
    se3d_function h;      /* actuator of (t, l, ldot) [N], or null */
    se3d_function spring; /* one variable: elastic force [N] of l - l0, added to k; or null */
    se3d_function damper; /* one variable: damping force [N] of ldot, added to c; or null */
    double preload;       /* f at l = l0 and rest [N]: with l0 the installed length, its load */
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

/* Rotational spring-damper-actuator about the axis of a joint with an angle, or (joint null) about
 * axes on two bodies: n = k (theta - theta0) + c thetadot + h(t, theta, thetadot), acts on j as -n
 * about the axis; theta counts turns. @since 0.1 */
typedef struct se3d_rsda_def {
    size_t struct_size;
    const char *name;
    se3d_constraint joint; /* a joint with an angle, or null: the fields after h */
    double k;              /* [N m/rad] */
    double c;              /* [N m s/rad] */
    double theta0;         /* [rad] */
    se3d_function h;       /* actuator of (t, theta, thetadot) [N m], or null */
    se3d_function spring;  /* one variable: elastic torque [N m] of theta - theta0; or null */
    se3d_function damper;  /* one variable: damping torque [N m] of thetadot; or null */
    double preload;        /* n at theta = theta0 and rest [N m] */
    se3d_body body_i;      /* without a joint: the bodies, */
    se3d_body body_j;
    double axis_i[3]; /* the axis, frame of body i, */
    double ref_i[3];  /* where the angle counts from, frame of body i; 0: chosen, */
    double ref_j[3];  /* and to, frame of body j; 0: so that the angle is angle0 now */
    double angle0;    /* [rad] at creation; given ref_j: the nearest whole turns */
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

/* Elastic and viscous connection of two frames (a rubber mount). With u the displacement of point j
 * from point i and theta the rotation vector of frame j from frame i, both in frame i, the
 * potential is 1/2 z^T K z, z = (u, theta), and the force on it -(K z + C zdot). |theta| < pi.
 * @since 0.1 */
typedef struct se3d_bushing_def {
    size_t struct_size;
    const char *name;
    se3d_body body_i;
    se3d_body body_j;
    double point_i[3]; /* body frames [m] */
    double point_j[3];
    double orientation_i[4]; /* frame -> body, Euler parameters; default the body's */
    double orientation_j[4];
    double K[36]; /* row-major, symmetric, [N/m, N, N m/rad] */
    double C[36]; /* row-major, [N s/m, N s, N m s/rad] */
} se3d_bushing_def;

SE3D_API void se3d_bushing_def_init(se3d_bushing_def *def, size_t size);

static inline se3d_bushing_def se3d_bushing_def_default(void)
{
    se3d_bushing_def def;
    se3d_bushing_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_force_create_bushing(se3d_system *system, const se3d_bushing_def *def,
                                               se3d_force *force);

/* Friction on a coordinate of a joint: sliding against the rate with mu N + limit, plus viscous
 * times the rate; sticking by a spring that gives at most `presliding`. N is the joint's reaction
 * perpendicular to its axis; on an angle the moment is mu (radius N + thrust_radius |F_axial|) +
 * limit. With a `length` N also has the moment of the reaction: two places at +-length/2 about the
 * joint point carry both. With a `width` of a guide, N has 2 |M_axial| / width more: two rails
 * carry the moment about the axis. docs/theory/friction.md. @since 0.1 */
typedef struct se3d_friction_def {
    size_t struct_size;
    const char *name;
    se3d_constraint joint;
    int32_t coordinate; /* se3d_joint_coordinate */
    int32_t reserved;
    double mu;         /* of sliding, >= 0 */
    double mu_static;  /* of sticking, >= mu; 0: mu */
    double radius;     /* of the bearing, on an angle [m] */
    double limit;      /* friction without load [N, N m] */
    double viscous;    /* [N s/m, N m s/rad] */
    double presliding; /* [m, rad]; 0: 1e-9 */
    double length; /* between the places that carry the load, along the axis [m]; 0: one place */
    double width;  /* on a displacement: between its rails [m]; 0: no moment about the axis */
    double thrust_radius; /* on an angle: of the shoulder that carries the axial force [m] */
} se3d_friction_def;

SE3D_API void se3d_friction_def_init(se3d_friction_def *def, size_t size);

static inline se3d_friction_def se3d_friction_def_default(void)
{
    se3d_friction_def def;
    se3d_friction_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_force_create_friction(se3d_system *system, const se3d_friction_def *def,
                                                se3d_force *force);

/* One-sided spring-damper at the ends of the range of a joint coordinate, or (joint null) of the
 * distance of two points; it pushes only. The damping gives the coefficient of restitution at every
 * impact speed above 1 mm/s (or mrad/s). @since 0.1 */
typedef struct se3d_stop_def {
    size_t struct_size;
    const char *name;
    se3d_constraint joint; /* or null: the two points */
    int32_t coordinate;    /* se3d_joint_coordinate */
    int32_t reserved;
    se3d_body body_i;
    se3d_body body_j;
    double point_i[3]; /* body frames [m] */
    double point_j[3];
    double lower;       /* default -infinity: none */
    double upper;       /* default +infinity: none */
    double k;           /* > 0 [N/m, N m/rad] */
    double restitution; /* 0.01 .. 1, default 1 */
} se3d_stop_def;

SE3D_API void se3d_stop_def_init(se3d_stop_def *def, size_t size);

static inline se3d_stop_def se3d_stop_def_default(void)
{
    se3d_stop_def def;
    se3d_stop_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_force_create_stop(se3d_system *system, const se3d_stop_def *def,
                                            se3d_force *force);

/* Compute what an element of the user's does to its bodies i and j: wrench = {force on i (ground
 * frame, at the centre of mass), torque on i (body frame), force on j, torque on j}. K and D are
 * NULL, or [144], row-major and zeroed: the derivatives of wrench to (dr_i, dtheta_i, dr_j,
 * dtheta_j), dtheta virtual rotations in the body frame, and to (v_i, w_i, v_j, w_j). Must be a
 * pure function of its arguments: methods keep and interpolate what it gave. What changes between
 * steps is the value of an element (se3d_force_set_value, se3d_function_set_constant, ...); where
 * it cannot be, call se3d_system_touch after every change. Return OK, or a negative status to stop
 * the analysis. @since 0.1 */
typedef se3d_status (*se3d_force_callback)(void *ctx, double t, const se3d_body_motion motion[2],
                                           double wrench[12], double *K, double *D);

typedef struct se3d_force_callback_def {
    size_t struct_size;
    const char *name;
    se3d_body body_i; /* the ground where there is only one body */
    se3d_body body_j;
    se3d_force_callback callback;
    void *ctx;
    int32_t has_jacobian; /* not 0: the callback fills K and D; else differences are used */
    int32_t reserved;
} se3d_force_callback_def;

SE3D_API void se3d_force_callback_def_init(se3d_force_callback_def *def, size_t size);

static inline se3d_force_callback_def se3d_force_callback_def_default(void)
{
    se3d_force_callback_def def;
    se3d_force_callback_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_force_create_callback(se3d_system *system,
                                                const se3d_force_callback_def *def,
                                                se3d_force *force);

/* ---- Values that change between steps. The handle stays, and so does what the element remembers.
 * The next step begins with the new value, and queries that evaluate elements see it at once;
 * accelerations and multipliers stay those of the last analysis until the next step or
 * se3d_solver_run to the present time. ---- */

/* Set, get the components of a force or torque [N, N m] where they are no functions.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT. Exclusive; Reader. @since 0.1 */
SE3D_API se3d_status se3d_force_set_value(se3d_system *system, se3d_force force,
                                          const double value[3]);
SE3D_API se3d_status se3d_force_get_value(const se3d_system *system, se3d_force force,
                                          double value[3]);

/* A number that a force element has, with the units and the range of its definition. */
typedef enum se3d_force_parameter {
    SE3D_FORCE_PARAMETER_K = 0,           /* tsda, rsda, stop */
    SE3D_FORCE_PARAMETER_C = 1,           /* tsda, rsda */
    SE3D_FORCE_PARAMETER_REST = 2,        /* tsda: l0, rsda: theta0 */
    SE3D_FORCE_PARAMETER_PRELOAD = 3,     /* tsda, rsda: also the value of a constant actuator */
    SE3D_FORCE_PARAMETER_LOWER = 4,       /* stop */
    SE3D_FORCE_PARAMETER_UPPER = 5,       /* stop */
    SE3D_FORCE_PARAMETER_RESTITUTION = 6, /* stop */
    SE3D_FORCE_PARAMETER_MU = 7,          /* friction; mu_static goes along where it is the same */
    SE3D_FORCE_PARAMETER_MU_STATIC = 8,   /* friction; 0: mu */
    SE3D_FORCE_PARAMETER_RADIUS = 9,      /* friction */
    SE3D_FORCE_PARAMETER_LIMIT = 10,      /* friction */
    SE3D_FORCE_PARAMETER_VISCOUS = 11,    /* friction */
    SE3D_FORCE_PARAMETER_PRESLIDING = 12  /* friction */
} se3d_force_parameter;

/* Set, get a number of a tsda, rsda, stop or friction element. What the change makes of the energy
 * that is stored counts as work of actuators.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT. Exclusive; Reader. @since 0.1 */
SE3D_API se3d_status se3d_force_set_parameter(se3d_system *system, se3d_force force,
                                              int32_t parameter, double value);
SE3D_API se3d_status se3d_force_get_parameter(const se3d_system *system, se3d_force force,
                                              int32_t parameter, double *value);
/* The same of the matrices of a bushing. @since 0.1 */
SE3D_API se3d_status se3d_force_set_bushing(se3d_system *system, se3d_force force,
                                            const double K[36], const double C[36]);
SE3D_API se3d_status se3d_force_get_bushing(const se3d_system *system, se3d_force force,
                                            double K[36], double C[36]);

/* Get what an element does to its body i (side 0) or j (side 1): force at the centre of mass and
 * torque about it, ground frame. Reader. @since 0.1 */
SE3D_API se3d_status se3d_force_get_wrench(const se3d_system *system, se3d_force force, size_t side,
                                           double wrench[6]);
/* Get potential energy [J], dissipated power and power fed in by an actuator, a load or a callback
 * [W] at the present state. Reader. @since 0.1 */
SE3D_API se3d_status se3d_force_get_power(const se3d_system *system, se3d_force force,
                                          double *potential, double *dissipated, double *actuator);

SE3D_API se3d_status se3d_force_destroy(se3d_system *system, se3d_force force);
SE3D_API se3d_status se3d_force_find(const se3d_system *system, const char *name,
                                     se3d_force *force);
SE3D_API se3d_status se3d_force_get_name(const se3d_system *system, se3d_force force,
                                         const char **name);
/* Get the type as in the model file: "tsda", "rsda", "force", "torque", "bushing", "friction",
 * "stop", "callback". Reader. @since 0.1 */
SE3D_API se3d_status se3d_force_get_type(const se3d_system *system, se3d_force force,
                                         const char **type);
/* Get the coordinate (length, angle, displacement), its rate and the force f or torque n against it
 * of a tsda, rsda, friction or stop. Reader. @since 0.1 */
SE3D_API se3d_status se3d_force_get_state(const se3d_system *system, se3d_force force,
                                          double *coordinate, double *rate, double *value);

#ifdef __cplusplus
}
#endif
#endif
