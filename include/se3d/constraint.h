/* SPDX-License-Identifier: BSD-3-Clause */
/* Constraints: the primitives, and what primitives, joints and drivers have in common.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_CONSTRAINT_H
#define SE3D_CONSTRAINT_H

#include "se3d/body.h" /* se3d_body_motion */
#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The formulations; all give the same motion. @since 0.1 */
typedef enum se3d_formulation {
    SE3D_FORMULATION_ROMEGA = 0, /* unknowns: position and virtual rotation (angular velocity) */
    SE3D_FORMULATION_RP = 1,     /* unknowns: position and Euler parameters with p.p - 1 = 0 */
    SE3D_FORMULATION_JOINT = 2,  /* the coordinates of a tree of joints are integrated (dop853,
                                    gauss, rk45, rk4); elsewhere as ROMEGA */
    SE3D_FORMULATION_AUTO = 3    /* of solvers: JOINT where a method above integrates joints, no
                                    friction needs the load of one and loops leave a freedom;
                                    else ROMEGA */
} se3d_formulation;

/* The primitives, with d_ij = r_j + A_j s_j - r_i - A_i s_i, directions a_i and a_j in body frames,
 * c in the ground frame. @since 0.1 */
typedef enum se3d_primitive_type {
    SE3D_PRIMITIVE_DP1 = 0, /* Phi = (A_i a_i).(A_j a_j) - f */
    SE3D_PRIMITIVE_DP2 = 1, /* Phi = (A_i a_i).d_ij - f */
    SE3D_PRIMITIVE_D = 2,   /* Phi = d_ij.d_ij - f */
    SE3D_PRIMITIVE_CD = 3   /* Phi = c.d_ij - f */
} se3d_primitive_type;

/* The definition of a primitive constraint. @since 0.1 */
typedef struct se3d_primitive_def {
    size_t struct_size;
    const char *name;       /* copied; NULL or unique among constraints */
    int32_t type;           /* se3d_primitive_type */
    int32_t reserved;       /* 0 */
    se3d_body body_i;       /* the reference */
    se3d_body body_j;       /* moves relative to body i */
    double a_i[3];          /* DP1, DP2: direction, body frame, not zero */
    double a_j[3];          /* DP1: direction, body frame, not zero */
    double point_i[3];      /* DP2, D, CD: s_i, body frame [m] */
    double point_j[3];      /* DP2, D, CD: s_j, body frame [m] */
    double c[3];            /* CD: direction, ground frame, not zero */
    double value;           /* f if `function` is null [m; D: m^2, > 0; DP1: 1] */
    se3d_function function; /* f(t), or null */
} se3d_primitive_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_primitive_def_default. @since 0.1 */
SE3D_API void se3d_primitive_def_init(se3d_primitive_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_primitive_def se3d_primitive_def_default(void)
{
    se3d_primitive_def def;
    se3d_primitive_def_init(&def, sizeof def);
    return def;
}

/* Create a constraint of one primitive. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT,
 * NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_primitive_create(se3d_system *system, const se3d_primitive_def *def,
                                           se3d_constraint *constraint);

/* Get the definition of a primitive. Set def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (another constraint, struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_primitive_get_def(const se3d_system *system, se3d_constraint primitive,
                                            se3d_primitive_def *def);

/* Define a primitive again, of the same type: see se3d_body_set_def.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of another constraint or type).
 * @since 0.1 */
SE3D_API se3d_status se3d_primitive_set_def(se3d_system *system, se3d_constraint primitive,
                                            const se3d_primitive_def *def);

/* ---- User-defined constraints. ---- */

/* The most bodies and equations of a user-defined constraint. @since 0.1 */
#define SE3D_USER_BODIES_MAX    4
#define SE3D_USER_EQUATIONS_MAX 6

/* Compute the equations Phi(q, t) = 0 of a constraint at the time t [s] and the motion of its
 * bodies:
 *
 *     phi       [equations] Phi
 *     jacobian  [equations * bodies * 6], row-major: the derivatives of an equation with respect to
 *               r (ground frame) and to the virtual rotation in the body frame,
 *               A -> A exp(tilde(dtheta)), of each body in the order of the definition:
 *               the rate of Phi is jacobian (v, w) + Phi_t
 *     nu        [equations] -Phi_t: jacobian (v, w) = nu
 *     gamma     [equations] jacobian (a, wdot) = gamma: minus all terms of the second derivative
 *               of Phi that have no acceleration
 *
 * Arrays that are not wanted are NULL, the others are zeroed. phi, jacobian and nu must not depend
 * on velocities. It must be a pure function of its arguments: methods keep what it gave. If what it
 * computes has to change between steps, call se3d_system_touch after every change. Numbers that are
 * not finite end the analysis with NOT_FINITE, unless a shorter step avoids them.
 * @return OK, or a negative status: the analysis ends with CALLBACK.
 * @since 0.1 */
typedef se3d_status (*se3d_constraint_callback)(void *ctx, double t, const se3d_body_motion *bodies,
                                                double *phi, double *jacobian, double *nu,
                                                double *gamma);

/* The definition of a user-defined constraint. With one body, body i is the ground and the body is
 * j; else bodies[0] is i and bodies[1] is j. Reactions are reported at the centre of body j.
 * Methods that need the second derivative of Phi (generalized_alpha, hht, modes, equilibria) take
 * central differences of `jacobian`. @since 0.1 */
typedef struct se3d_user_constraint_def {
    size_t struct_size;
    const char *name;                       /* copied; NULL or unique among constraints */
    se3d_constraint_callback callback;      /* required */
    void *ctx;                              /* of `callback` */
    se3d_body bodies[SE3D_USER_BODIES_MAX]; /* different ones, not only the ground */
    int32_t body_count;                     /* 1 to SE3D_USER_BODIES_MAX, default 1 */
    int32_t equation_count;                 /* 1 to SE3D_USER_EQUATIONS_MAX, default 1 */
} se3d_user_constraint_def;

/* Fill `def`, of `size` bytes, with the defaults: see
 * se3d_user_constraint_def_default. @since 0.1 */
SE3D_API void se3d_user_constraint_def_init(se3d_user_constraint_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_user_constraint_def se3d_user_constraint_def_default(void)
{
    se3d_user_constraint_def def;
    se3d_user_constraint_def_init(&def, sizeof def);
    return def;
}

/* Create a constraint whose equations a callback computes. Its type is "user", its equations are
 * named "user_0", "user_1", ... @return OK, NULL, INVALID_ARGUMENT, STALE_HANDLE, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_user_constraint_create(se3d_system *system,
                                                 const se3d_user_constraint_def *def,
                                                 se3d_constraint *constraint);

/* Get the definition of a user-defined constraint. Set def->struct_size before the call.
 * @param[out] def  its name is valid until the system is edited; NULL: none
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (another constraint, struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_user_constraint_get_def(const se3d_system *system,
                                                  se3d_constraint constraint,
                                                  se3d_user_constraint_def *def);

/* Define a user-defined constraint again, with as many equations: see se3d_body_set_def.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (also of another constraint).
 * @since 0.1 */
SE3D_API se3d_status se3d_user_constraint_set_def(se3d_system *system, se3d_constraint constraint,
                                                  const se3d_user_constraint_def *def);

/* Set the prescribed value of a driver, primitive or coupler that was made without a function. The
 * next step begins with a state that meets the new value, with the same velocities: a jump.
 * @param[in] value  f of its equation: of an angle [rad], a displacement, DP2 or CD [m], D [m^2] >
 *                   0, DP1 [1]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_set_value(se3d_system *system, se3d_constraint constraint,
                                               double value);

/* Destroy a constraint of any type. @return OK, NULL, STALE_HANDLE, IN_USE (a driver, coupler or
 * force element refers to it). @since 0.1 */
SE3D_API se3d_status se3d_constraint_destroy(se3d_system *system, se3d_constraint constraint);

/* Find a constraint by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_find(const se3d_system *system, const char *name,
                                          se3d_constraint *constraint);

/* Get the name of a constraint.
 * @param[out] name  "" if it has none; valid until the system is edited
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_name(const se3d_system *system, se3d_constraint constraint,
                                              const char **name);

/* Get the type of a constraint as in the model file.
 * @param[out] type  "dp1", "revolute", "driver", ...; static
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_type(const se3d_system *system, se3d_constraint constraint,
                                              const char **type);

/* Count the scalar equations of a constraint.
 * @param[out] count  their number
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_count_equations(const se3d_system *system,
                                                     se3d_constraint constraint, size_t *count);

/* Get the name of an equation within its constraint.
 * @param[in] k      which one, from 0
 * @param[out] name  "cd_x", "dp1_a", ...; static
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (k).
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_equation_name(const se3d_system *system,
                                                       se3d_constraint constraint, size_t k,
                                                       const char **name);

/* Count the bodies that take part in a constraint: at least 2; couplers and user-defined
 * constraints may have more.
 * @param[out] count  their number
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_count_bodies(const se3d_system *system,
                                                  se3d_constraint constraint, size_t *count);

/* Get a body that takes part in a constraint.
 * @param[in] slot  0: body i, 1: body j, below se3d_constraint_count_bodies
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (slot).
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_body(const se3d_system *system, se3d_constraint constraint,
                                              size_t slot, se3d_body *body);

/* Evaluate the equations of a constraint at the present state and time. Arrays have
 * se3d_constraint_count_equations numbers, in the units of the equations, or are NULL.
 * @param[in] formulation  on which gamma depends, as the unknown accelerations do
 * @param[out] phi         [equations] Phi
 * @param[out] nu          [equations] of Phi_q qdot = nu
 * @param[out] gamma       [equations] of Phi_q qddot = gamma
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (formulation), NOT_FINITE, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_eval(const se3d_system *system, se3d_constraint constraint,
                                          se3d_formulation formulation, double *phi, double *nu,
                                          double *gamma);

/* Evaluate the Jacobian of the equations with respect to the coordinates of one body, at the
 * present state. Matrices are row-major; NULL ones are skipped.
 * @param[in] formulation    of `phi_rotation`
 * @param[in] slot           the body, as in se3d_constraint_get_body
 * @param[out] phi_r         [equations * 3] d Phi / d r, r in the ground frame
 * @param[out] phi_rotation  [equations * 4] d Phi / d p in r-p; [equations * 3] in r-omega: with
 *                           respect to the virtual rotation in the body frame (Phi_pi)
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (formulation, slot), NOT_FINITE, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_eval_jacobian(const se3d_system *system,
                                                   se3d_constraint constraint,
                                                   se3d_formulation formulation, size_t slot,
                                                   double *phi_r, double *phi_rotation);

/* Get the multipliers of the last analysis. The generalised force of the constraint on the bodies
 * is -Phi_q^T lambda.
 * @param[out] lambda  [equations] in N or N m over the unit of d Phi / d q
 * @return OK, NULL, STALE_HANDLE, STATE.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_multipliers(const se3d_system *system,
                                                     se3d_constraint constraint, double *lambda);

/* Get the reaction of the last analysis on body j at its joint point. NULL arrays are skipped.
 * @param[out] force   ground frame [N]
 * @param[out] torque  about the joint point, ground frame [N m]
 * @return OK, NULL, STALE_HANDLE, STATE, NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_reaction(const se3d_system *system,
                                                  se3d_constraint constraint, double force[3],
                                                  double torque[3]);

/* Get the reaction of the last analysis on any body of a constraint, about any point, in any frame.
 * @param[in] slot     the body, as in se3d_constraint_get_body
 * @param[in] point    about which the torque is taken, ground frame [m]
 * @param[in] marker   in whose frame the result is; null: the ground frame
 * @param[out] wrench  force [N] and torque [N m], in the frame of `marker`
 * @return OK, NULL, STALE_HANDLE, STATE, INVALID_ARGUMENT (slot, point), NOT_FINITE.
 * @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_reaction_at(const se3d_system *system,
                                                     se3d_constraint constraint, size_t slot,
                                                     const double point[3], se3d_marker marker,
                                                     double wrench[6]);

#ifdef __cplusplus
}
#endif
#endif
