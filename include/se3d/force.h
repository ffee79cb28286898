/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements: springs, dampers, actuators, applied forces and torques.
 *
 * Threads: the rule of se3d/se3d.h. */
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
    const char *name;     /* copied; NULL or unique among force elements */
    se3d_body body_i;     /* of one end */
    se3d_body body_j;     /* of the other end */
    double point_i[3];    /* frame of body i [m] */
    double point_j[3];    /* frame of body j [m] */
    double k;             /* [N/m] */
    double c;             /* [N s/m] */
    double l0;            /* free length [m], >= 0 */
    se3d_function h;      /* actuator of (t, l, ldot) [N], or null */
    se3d_function spring; /* one variable: elastic force [N] of l - l0, added to k; or null */
    se3d_function damper; /* one variable: damping force [N] of ldot, added to c; or null */
    double preload;       /* f at l = l0 and rest [N]: with l0 the installed length, its load */
} se3d_tsda_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_tsda_def_default. @since 0.1 */
SE3D_API void se3d_tsda_def_init(se3d_tsda_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_tsda_def se3d_tsda_def_default(void)
{
    se3d_tsda_def def;
    se3d_tsda_def_init(&def, sizeof def);
    return def;
}

/* Create a translational spring-damper-actuator. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_tsda(se3d_system *system, const se3d_tsda_def *def,
                                            se3d_force *force);

/* Rotational spring-damper-actuator about the axis of a joint with an angle, or (joint null) about
 * axes on two bodies: n = k (theta - theta0) + c thetadot + h(t, theta, thetadot), acts on j as -n
 * about the axis; theta counts turns. @since 0.1 */
typedef struct se3d_rsda_def {
    size_t struct_size;
    const char *name;      /* copied; NULL or unique among force elements */
    se3d_constraint joint; /* a joint with an angle, or null: the fields after h */
    double k;              /* [N m/rad] */
    double c;              /* [N m s/rad] */
    double theta0;         /* [rad] */
    se3d_function h;       /* actuator of (t, theta, thetadot) [N m], or null */
    se3d_function spring;  /* one variable: elastic torque [N m] of theta - theta0; or null */
    se3d_function damper;  /* one variable: damping torque [N m] of thetadot; or null */
    double preload;        /* n at theta = theta0 and rest [N m] */
    se3d_body body_i;      /* without a joint: the bodies, */
    se3d_body body_j;      /* they must differ */
    double axis_i[3];      /* the axis, a direction in the frame of body i, */
    double ref_i[3];       /* the direction the angle counts from, frame of body i; 0: chosen, */
    double ref_j[3]; /* and the direction to, frame of body j; 0: so that the angle is angle0 now */
    double angle0;   /* [rad] at creation; given ref_j: the nearest whole turns */
} se3d_rsda_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_rsda_def_default. @since 0.1 */
SE3D_API void se3d_rsda_def_init(se3d_rsda_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_rsda_def se3d_rsda_def_default(void)
{
    se3d_rsda_def def;
    se3d_rsda_def_init(&def, sizeof def);
    return def;
}

/* Create a rotational spring-damper-actuator. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT,
 * NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_rsda(se3d_system *system, const se3d_rsda_def *def,
                                            se3d_force *force);

/* A force at a point, or a torque, on a body: constant or functions of time. @since 0.1 */
typedef struct se3d_load_def {
    size_t struct_size;
    const char *name;          /* copied; NULL or unique among force elements */
    se3d_body body;            /* that it acts on */
    double point[3];           /* force: where it acts, body frame [m] */
    double value[3];           /* if the function is null [N, N m] */
    se3d_function function[3]; /* of t, or null */
    int32_t in_body_frame;     /* not 0: components in the body frame, else in the ground frame */
    int32_t reserved;
} se3d_load_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_load_def_default. @since 0.1 */
SE3D_API void se3d_load_def_init(se3d_load_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_load_def se3d_load_def_default(void)
{
    se3d_load_def def;
    se3d_load_def_init(&def, sizeof def);
    return def;
}

/* Create a force at a point of a body. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT,
 * NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_load(se3d_system *system, const se3d_load_def *def,
                                            se3d_force *force);

/* Create a torque on a body; def->point is ignored. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_torque(se3d_system *system, const se3d_load_def *def,
                                              se3d_force *force);

/* Elastic and viscous connection of two frames (a rubber mount). With u the displacement of point j
 * from point i and theta the rotation vector of frame j from frame i, both in frame i, the
 * potential is 1/2 z^T K z, z = (u, theta), and the force on it -(K z + C zdot). |theta| < pi.
 * @since 0.1 */
typedef struct se3d_bushing_def {
    size_t struct_size;
    const char *name;        /* copied; NULL or unique among force elements */
    se3d_body body_i;        /* the reference */
    se3d_body body_j;        /* moves relative to body i */
    double point_i[3];       /* frame of body i [m] */
    double point_j[3];       /* frame of body j [m] */
    double orientation_i[4]; /* frame i -> body i, Euler parameters; default (1,0,0,0) */
    double orientation_j[4]; /* frame j -> body j, Euler parameters; default (1,0,0,0) */
    double K[36];            /* row-major, symmetric, frame i [N/m, N, N m/rad] */
    double C[36];            /* row-major, frame i [N s/m, N s, N m s/rad] */
} se3d_bushing_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_bushing_def_default. @since 0.1 */
SE3D_API void se3d_bushing_def_init(se3d_bushing_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_bushing_def se3d_bushing_def_default(void)
{
    se3d_bushing_def def;
    se3d_bushing_def_init(&def, sizeof def);
    return def;
}

/* Create a bushing. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_bushing(se3d_system *system, const se3d_bushing_def *def,
                                               se3d_force *force);

/* Friction on a coordinate of a joint: sliding against the rate with mu N + limit, plus viscous
 * times the rate; sticking by a spring that gives at most `presliding` and, if that is below 1e-7,
 * a damper by which it settles and which the limit does not hold for. N is the joint's reaction
 * perpendicular to its axis; on an angle the moment is mu (radius N + thrust_radius |F_axial|) +
 * limit. With a `length` N also has the moment of the reaction: two places at +-length/2 about the
 * joint point carry both. With a `width` of a guide, N has 2 |M_axial| / width more: two rails
 * carry the moment about the axis. docs/theory/friction.md. @since 0.1 */
typedef struct se3d_friction_def {
    size_t struct_size;
    const char *name;      /* copied; NULL or unique among force elements */
    se3d_constraint joint; /* with that coordinate */
    int32_t coordinate;    /* se3d_joint_coordinate */
    int32_t reserved;
    double mu;         /* of sliding, >= 0 */
    double mu_static;  /* of sticking, >= mu [1]; 0: mu */
    double radius;     /* of the bearing, on an angle [m] */
    double limit;      /* friction without load [N, N m] */
    double viscous;    /* [N s/m, N m s/rad] */
    double presliding; /* [m, rad]; 0: 1e-9 */
    double length; /* between the places that carry the load, along the axis [m]; 0: one place */
    double width;  /* on a displacement: between its rails [m]; 0: no moment about the axis */
    double thrust_radius; /* on an angle: of the shoulder that carries the axial force [m] */
} se3d_friction_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_friction_def_default. @since 0.1 */
SE3D_API void se3d_friction_def_init(se3d_friction_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_friction_def se3d_friction_def_default(void)
{
    se3d_friction_def def;
    se3d_friction_def_init(&def, sizeof def);
    return def;
}

/* Create friction on a joint coordinate. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT,
 * NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_friction(se3d_system *system, const se3d_friction_def *def,
                                                se3d_force *force);

/* One-sided spring-damper at the ends of the range of a joint coordinate, or (joint null) of the
 * distance of two points; it pushes only. The damping gives the coefficient of restitution at every
 * impact speed above 1 mm/s (or mrad/s); by convex, what arrives no faster than twice what a step
 * makes it comes to rest. @since 0.1 */
typedef struct se3d_stop_def {
    size_t struct_size;
    const char *name;      /* copied; NULL or unique among force elements */
    se3d_constraint joint; /* or null: the two points */
    int32_t coordinate;    /* se3d_joint_coordinate */
    int32_t reserved;
    se3d_body body_i;   /* without a joint: of one point */
    se3d_body body_j;   /* without a joint: of the other point */
    double point_i[3];  /* frame of body i [m] */
    double point_j[3];  /* frame of body j [m] */
    double lower;       /* [m, rad]; default -infinity: none */
    double upper;       /* [m, rad]; default +infinity: none */
    double k;           /* > 0 [N/m, N m/rad] */
    double restitution; /* 0.01 .. 1, default 1 */
} se3d_stop_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_stop_def_default. @since 0.1 */
SE3D_API void se3d_stop_def_init(se3d_stop_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_stop_def se3d_stop_def_default(void)
{
    se3d_stop_def def;
    se3d_stop_def_init(&def, sizeof def);
    return def;
}

/* Create a stop. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_stop(se3d_system *system, const se3d_stop_def *def,
                                            se3d_force *force);

/* Effort: a generalised force along a coordinate of a joint, positive as it drives the coordinate
 * up: a torque [N m] about the axis on j and its opposite on i, or a force [N]. Its value is a
 * number that se3d_effort_set changes between steps, or a function. @since 0.1 */
typedef struct se3d_effort_def {
    size_t struct_size;
    const char *name;      /* copied; NULL or unique among force elements */
    se3d_constraint joint; /* required: a joint with the coordinate */
    int32_t coordinate;    /* se3d_joint_coordinate */
    int32_t reserved;
    double value;           /* [N m, N]; default 0 */
    se3d_function function; /* of (t, coordinate, rate), or null: `value` */
} se3d_effort_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_effort_def_default. @since 0.1 */
SE3D_API void se3d_effort_def_init(se3d_effort_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_effort_def se3d_effort_def_default(void)
{
    se3d_effort_def def;
    se3d_effort_def_init(&def, sizeof def);
    return def;
}

/* Create an effort on a joint coordinate. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT,
 * NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_effort(se3d_system *system, const se3d_effort_def *def,
                                              se3d_force *force);

/* Compute what a user-defined element does to its bodies i and j at the time t [s]:
 *
 *     wrench  force on i [N] (ground frame, at the centre of mass), torque on i [N m] (body frame),
 *             force on j, torque on j
 *     K       NULL, or [144], row-major and zeroed: the derivatives of wrench with respect to
 *             (dr_i, dtheta_i, dr_j, dtheta_j), dtheta virtual rotations in the body frame
 *     D       NULL, or [144]: the same with respect to (v_i, w_i, v_j, w_j)
 *
 * It must be a pure function of its arguments: methods keep and interpolate what it gave. What
 * changes between steps is the value of an element (se3d_force_set_value,
 * se3d_function_set_constant, ...); if it cannot be, call se3d_system_touch after every change.
 * Numbers that are not finite end the analysis with NOT_FINITE, unless a shorter step avoids them.
 * @return OK, or a negative status: the analysis ends with CALLBACK.
 * @since 0.1 */
typedef se3d_status (*se3d_force_callback)(void *ctx, double t, const se3d_body_motion motion[2],
                                           double wrench[12], double *K, double *D);

/* Compute the energy that a user-defined element stores, and the power that it dissipates, at the
 * time t [s] and the motion of its bodies i and j. Both come zeroed. Energies of systems, elements
 * and results count them; what the wrench does beside them counts as work of an actuator. The
 * potential must depend on time and poses alone. A pure function, as se3d_force_callback is.
 * @return OK, or a negative status: the call ends with CALLBACK.
 * @since 0.1 */
typedef se3d_status (*se3d_force_energy_callback)(void *ctx, double t,
                                                  const se3d_body_motion motion[2],
                                                  double *potential, double *dissipated);

/* The definition of an element with a callback. @since 0.1 */
typedef struct se3d_force_callback_def {
    size_t struct_size;
    const char *name;             /* copied; NULL or unique among force elements */
    se3d_body body_i;             /* the ground if there is only one body */
    se3d_body body_j;             /* the other one */
    se3d_force_callback callback; /* required */
    void *ctx;                    /* of `callback` */
    int32_t has_jacobian;         /* not 0: the callback fills K and D; else differences are used */
    int32_t reserved;
    se3d_force_energy_callback energy; /* NULL: all that it does is work of an actuator */
} se3d_force_callback_def;

/* Fill `def`, of `size` bytes, with the defaults: see
 * se3d_force_callback_def_default. @since 0.1 */
SE3D_API void se3d_force_callback_def_init(se3d_force_callback_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_force_callback_def se3d_force_callback_def_default(void)
{
    se3d_force_callback_def def;
    se3d_force_callback_def_init(&def, sizeof def);
    return def;
}

/* Create an element whose forces a callback computes. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_callback(se3d_system *system,
                                                const se3d_force_callback_def *def,
                                                se3d_force *force);

/* ---- Values that change between steps. The handle stays, and so does what the element remembers.
 * The next step begins with the new value, and queries that evaluate elements see it at once;
 * accelerations and multipliers stay those of the last analysis until the next step or
 * se3d_solver_run to the present time. ---- */

/* Set the components of a force or torque; those given by functions stay with their functions.
 * @param[in] value  in the frame of the definition [N, N m]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not finite, or neither force nor torque).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_set_value(se3d_system *system, se3d_force force,
                                          const double value[3]);

/* Get the components of a force or torque, as they were set.
 * @param[out] value  in the frame of the definition [N, N m]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (neither force nor torque).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_value(const se3d_system *system, se3d_force force,
                                          double value[3]);

/* Set the value of an effort; one that has a function stays with its function. It acts from the
 * very start of the next step on.
 * @param[in] value  along the coordinate [N m, N]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (not finite, or no effort).
 * @since 0.1 */
SE3D_API se3d_status se3d_effort_set(se3d_system *system, se3d_force force, double value);

/* Get the value of an effort, as it was set.
 * @param[out] value  along the coordinate [N m, N]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no effort).
 * @since 0.1 */
SE3D_API se3d_status se3d_effort_get(const se3d_system *system, se3d_force force, double *value);

/* Count the efforts of a system.
 * @param[out] count  of force elements of this type
 * @return OK, NULL.
 * @since 0.1 */
SE3D_API se3d_status se3d_effort_count(const se3d_system *system, size_t *count);

/* Set the values of all efforts as se3d_effort_set does, in one call; all or none is set.
 * @param[in] count   as se3d_effort_count has it
 * @param[in] values  [count], in the order in which the elements were created [N m, N]
 * @return OK, NULL, INVALID_ARGUMENT (another count, a value is not finite).
 * @since 0.1 */
SE3D_API se3d_status se3d_effort_set_all(se3d_system *system, size_t count, const double *values);

/* Armature: the inertia of what turns with a coordinate of a joint beside its bodies, a rotor
 * behind a gear: kinetic energy 1/2 inertia rate^2, no weight, no momentum of its own. For a rotor
 * of inertia J behind a gear of ratio n it is n^2 J. It is a part of the mass matrix in all
 * formulations; the methods verlet, rattle and convex, which need bodies alone in it, refuse it.
 * docs/theory/armature.md @since 0.1 */
typedef struct se3d_armature_def {
    size_t struct_size;
    const char *name;      /* copied; NULL or unique among force elements */
    se3d_constraint joint; /* required: a joint with the coordinate */
    int32_t coordinate;    /* se3d_joint_coordinate; of a screw the angle */
    int32_t reserved;
    double inertia; /* >= 0: of an angle [kg m^2], of a displacement [kg] */
} se3d_armature_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_armature_def_default. @since 0.1 */
SE3D_API void se3d_armature_def_init(se3d_armature_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_armature_def se3d_armature_def_default(void)
{
    se3d_armature_def def;
    se3d_armature_def_init(&def, sizeof def);
    return def;
}

/* Create an armature on a joint coordinate. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT,
 * NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_force_create_armature(se3d_system *system, const se3d_armature_def *def,
                                                se3d_force *force);

/* ---- Definitions as they would be given again, with the values of now. Set def->struct_size
 * before the call; the name (NULL: none) is valid until the system is edited. ---- */

/* Get the definition of a tsda. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_tsda(const se3d_system *system, se3d_force force,
                                         se3d_tsda_def *def);

/* Get the definition of an rsda. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_rsda(const se3d_system *system, se3d_force force,
                                         se3d_rsda_def *def);

/* Get the definition of a force or torque. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_load(const se3d_system *system, se3d_force force,
                                         se3d_load_def *def);

/* Get the definition of a bushing. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_bushing_def(const se3d_system *system, se3d_force force,
                                                se3d_bushing_def *def);

/* Get the definition of a friction element. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_friction(const se3d_system *system, se3d_force force,
                                             se3d_friction_def *def);

/* Get the definition of a stop. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_stop(const se3d_system *system, se3d_force force,
                                         se3d_stop_def *def);

/* Get the definition of an effort. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_effort(const se3d_system *system, se3d_force force,
                                           se3d_effort_def *def);

/* Get the definition of an armature. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (an
 * element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_armature(const se3d_system *system, se3d_force force,
                                             se3d_armature_def *def);

/* Get the definition of an element with a callback. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT (an element of another type, struct_size). @since 0.1 */
SE3D_API se3d_status se3d_force_get_callback(const se3d_system *system, se3d_force force,
                                             se3d_force_callback_def *def);

/* ---- Elements that are defined again, with other points, functions, bodies, by what the readers
 * above give: see se3d_body_set_def. What an element remembers (sticking, an impact) begins anew.
 * As long as a function has a signal of an element its bodies cannot be other ones (IN_USE).
 * ---- */

/* Define a tsda again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an element of
 * another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_tsda(se3d_system *system, se3d_force force,
                                         const se3d_tsda_def *def);

/* Define an rsda, on a joint or about an axis of its own as it was, again. @return OK, NULL,
 * STALE_HANDLE, INVALID_ARGUMENT (also of an element of another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_rsda(se3d_system *system, se3d_force force,
                                         const se3d_rsda_def *def);

/* Define a force or torque again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an
 * element of another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_load(se3d_system *system, se3d_force force,
                                         const se3d_load_def *def);

/* Define a bushing again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an element
 * of another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_bushing_def(se3d_system *system, se3d_force force,
                                                const se3d_bushing_def *def);

/* Define a friction element again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an
 * element of another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_friction(se3d_system *system, se3d_force force,
                                             const se3d_friction_def *def);

/* Define a stop again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an element of
 * another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_stop(se3d_system *system, se3d_force force,
                                         const se3d_stop_def *def);

/* Define an effort again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an element
 * of another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_effort(se3d_system *system, se3d_force force,
                                           const se3d_effort_def *def);

/* Define an armature again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of an element
 * of another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_armature(se3d_system *system, se3d_force force,
                                             const se3d_armature_def *def);

/* Define an element with a callback again. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT
 * (also of an element of another type). @since 0.1 */
SE3D_API se3d_status se3d_force_set_callback(se3d_system *system, se3d_force force,
                                             const se3d_force_callback_def *def);

/* A number that a force element has, with the unit and the range of its definition. @since 0.1 */
typedef enum se3d_force_parameter {
    SE3D_FORCE_PARAMETER_K = 0,           /* tsda, rsda, stop, tyre */
    SE3D_FORCE_PARAMETER_C = 1,           /* tsda, rsda, tyre */
    SE3D_FORCE_PARAMETER_REST = 2,        /* tsda: l0, rsda: theta0 */
    SE3D_FORCE_PARAMETER_PRELOAD = 3,     /* tsda, rsda: also the value of a constant actuator */
    SE3D_FORCE_PARAMETER_LOWER = 4,       /* stop */
    SE3D_FORCE_PARAMETER_UPPER = 5,       /* stop */
    SE3D_FORCE_PARAMETER_RESTITUTION = 6, /* stop */
    SE3D_FORCE_PARAMETER_MU = 7,        /* tyre; friction, mu_static goes along if it is the same */
    SE3D_FORCE_PARAMETER_MU_STATIC = 8, /* friction; 0: mu */
    SE3D_FORCE_PARAMETER_RADIUS = 9,    /* friction */
    SE3D_FORCE_PARAMETER_LIMIT = 10,    /* friction */
    SE3D_FORCE_PARAMETER_VISCOUS = 11,  /* friction */
    SE3D_FORCE_PARAMETER_PRESLIDING = 12, /* friction */
    SE3D_FORCE_PARAMETER_INERTIA = 13,    /* armature */
    /* stop: the speed of the impact that it is in, or of one that would begin now, >= 0 [m/s,
     * rad/s]; 0: not known. A part of the state: to go on from one that was kept elsewhere, set it
     * after positions and velocities. */
    SE3D_FORCE_PARAMETER_IMPACT = 14,
    SE3D_FORCE_PARAMETER_LENGTH = 15,       /* friction */
    SE3D_FORCE_PARAMETER_WIDTH = 16,        /* friction */
    SE3D_FORCE_PARAMETER_THRUST_RADIUS = 17 /* friction */
} se3d_force_parameter;

/* Set a number of a tsda, rsda, stop, friction, tyre or armature element. What the change makes of
 * the stored energy counts as work of actuators.
 * @param[in] parameter  se3d_force_parameter
 * @param[in] value      with the unit and the range of the definition [N, m, s, rad]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_force_set_parameter(se3d_system *system, se3d_force force,
                                              int32_t parameter, double value);

/* Get a number of a tsda, rsda, stop, friction or tyre element.
 * @param[in] parameter  se3d_force_parameter
 * @param[out] value     with the unit of the definition [N, m, s, rad]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (the element has no such parameter).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_parameter(const se3d_system *system, se3d_force force,
                                              int32_t parameter, double *value);

/* Set the matrices of a bushing. What the change makes of the stored energy counts as work of
 * actuators.
 * @param[in] K  row-major, symmetric, frame i of the bushing [N/m, N, N m/rad]
 * @param[in] C  row-major, frame i of the bushing [N s/m, N s, N m s/rad]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_force_set_bushing(se3d_system *system, se3d_force force,
                                            const double K[36], const double C[36]);

/* Get the matrices of a bushing.
 * @param[out] K  row-major, frame i of the bushing [N/m, N, N m/rad]
 * @param[out] C  row-major, frame i of the bushing [N s/m, N s, N m s/rad]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no bushing).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_bushing(const se3d_system *system, se3d_force force,
                                            double K[36], double C[36]);

/* Get what an element does to one of its bodies at the present state.
 * @param[in] side     0: body i, 1: body j
 * @param[out] wrench  force [N] and torque about the centre of mass [N m], ground frame
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (side), CALLBACK, NOT_FINITE, SINGULAR (the
 *         points coincide, so that a tsda or stop has no direction).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_wrench(const se3d_system *system, se3d_force force, size_t side,
                                           double wrench[6]);

/* Get the energy and the powers of an element at the present state. NULL ones are skipped.
 * @param[out] potential   stored energy [J]
 * @param[out] dissipated  power [W]
 * @param[out] actuator    power fed in by an actuator, a load or a callback [W]
 * @return OK, NULL, STALE_HANDLE, CALLBACK, NOT_FINITE, SINGULAR (as se3d_force_get_wrench).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_power(const se3d_system *system, se3d_force force,
                                          double *potential, double *dissipated, double *actuator);

/* Destroy a force element. @return OK, NULL, STALE_HANDLE, IN_USE (by a wheel or a signal).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_destroy(se3d_system *system, se3d_force force);

/* Find a force element by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_find(const se3d_system *system, const char *name,
                                     se3d_force *force);

/* Get the name of a force element.
 * @param[out] name  "" if it has none; valid until the system is edited
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_name(const se3d_system *system, se3d_force force,
                                         const char **name);

/* Get the type of a force element as in the model file.
 * @param[out] type  "tsda", "rsda", "force", "torque", "bushing", "friction", "stop", "callback",
 *                   "effort", "tyre", "armature"; static
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_type(const se3d_system *system, se3d_force force,
                                         const char **type);

/* Get the coordinate of a tsda, rsda, friction or stop and what acts against it, or of an effort
 * or armature and what acts along it, at the present state. NULL ones are skipped.
 * @param[out] coordinate  length or displacement [m], angle [rad]
 * @param[out] rate        of the coordinate [m/s, rad/s]
 * @param[out] value       force f [N] or torque n [N m]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (no such element), CALLBACK, NOT_FINITE,
 *         SINGULAR (as se3d_force_get_wrench).
 * @since 0.1 */
SE3D_API se3d_status se3d_force_get_state(const se3d_system *system, se3d_force force,
                                          double *coordinate, double *rate, double *value);

#ifdef __cplusplus
}
#endif
#endif
