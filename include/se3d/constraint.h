/* SPDX-License-Identifier: BSD-3-Clause */
/* Constraints: the primitives, and what primitives, joints and drivers have in common. */
#ifndef SE3D_CONSTRAINT_H
#define SE3D_CONSTRAINT_H

#include "se3d/body.h" /* se3d_body_motion */
#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The two formulations; both give the same motion. */
typedef enum se3d_formulation {
    SE3D_FORMULATION_ROMEGA = 0, /* unknowns: position and virtual rotation (angular velocity) */
    SE3D_FORMULATION_RP = 1      /* unknowns: position and Euler parameters with p.p - 1 = 0 */
} se3d_formulation;

/* d_ij = r_j + A_j s_j - r_i - A_i s_i; directions a_i, a_j in body frames, c in the ground frame.
 */
typedef enum se3d_primitive_type {
    SE3D_PRIMITIVE_DP1 = 0, /* Phi = (A_i a_i).(A_j a_j) - f */
    SE3D_PRIMITIVE_DP2 = 1, /* Phi = (A_i a_i).d_ij - f */
    SE3D_PRIMITIVE_D = 2,   /* Phi = d_ij.d_ij - f */
    SE3D_PRIMITIVE_CD = 3   /* Phi = c.d_ij - f */
} se3d_primitive_type;

/* What a primitive constraint is made with. @since 0.1 */
typedef struct se3d_primitive_def {
    size_t struct_size;
    const char *name; /* copied; NULL or unique among constraints */
    int32_t type;     /* se3d_primitive_type */
    int32_t reserved; /* 0 */
    se3d_body body_i;
    se3d_body body_j;
    double a_i[3];          /* DP1, DP2: direction, not zero */
    double a_j[3];          /* DP1: direction, not zero */
    double point_i[3];      /* DP2, D, CD: s_i, body frame [m] */
    double point_j[3];      /* DP2, D, CD: s_j, body frame [m] */
    double c[3];            /* CD: direction, ground frame, not zero */
    double value;           /* f where `function` is null; D: > 0 */
    se3d_function function; /* f(t), or null */
} se3d_primitive_def;

SE3D_API void se3d_primitive_def_init(se3d_primitive_def *def, size_t size);

static inline se3d_primitive_def se3d_primitive_def_default(void)
{
    se3d_primitive_def def;
    se3d_primitive_def_init(&def, sizeof def);
    return def;
}

SE3D_API se3d_status se3d_primitive_create(se3d_system *system, const se3d_primitive_def *def,
                                           se3d_constraint *constraint);

/* ---- Constraints of the user's. ---- */

#define SE3D_USER_BODIES_MAX    4
#define SE3D_USER_EQUATIONS_MAX 6

/* Compute the equations Phi(q, t) = 0 of a constraint at time t and the motion of its bodies:
 *
 *     phi       Phi [equations]
 *     jacobian  [equations * bodies * 6], row-major: the derivatives of an equation to r (ground
 *               frame) and to the virtual rotation in the body frame, A -> A exp(tilde(dtheta)), of
 *               each body in the order of the def: the rate of Phi is jacobian (v, w) + Phi_t
 *     nu        -Phi_t [equations]: jacobian (v, w) = nu
 *     gamma     [equations]: jacobian (a, wdot) = gamma, minus all terms of the second derivative
 * of Phi that have no acceleration
 *
 * Arrays that are not wanted are NULL, the others are zeroed. phi, jacobian and nu must not depend
 * on velocities. Must be a pure function of its arguments: methods keep what it gave. Where what it
 * computes has to change between steps, call se3d_system_touch after every change. Return OK, or a
 * negative status to stop the analysis with CALLBACK; numbers that are not finite end it with
 * NOT_FINITE, unless a shorter step avoids them. @since 0.1 */
typedef se3d_status (*se3d_constraint_callback)(void *ctx, double t, const se3d_body_motion *bodies,
                                                double *phi, double *jacobian, double *nu,
                                                double *gamma);

/* With one body, body i is the ground and the body is j; else bodies[0] is i and bodies[1] is j.
 * Reactions are reported at the centre of body j. Methods that need the second derivative of Phi
 * (generalized_alpha, hht, modes, equilibria) take central differences of `jacobian`.
 * @since 0.1 */
typedef struct se3d_user_constraint_def {
    size_t struct_size;
    const char *name;
    se3d_constraint_callback callback;
    void *ctx;
    se3d_body bodies[SE3D_USER_BODIES_MAX]; /* different ones, not only the ground */
    int32_t body_count;                     /* 1 to SE3D_USER_BODIES_MAX, default 1 */
    int32_t equation_count;                 /* 1 to SE3D_USER_EQUATIONS_MAX, default 1 */
} se3d_user_constraint_def;

SE3D_API void se3d_user_constraint_def_init(se3d_user_constraint_def *def, size_t size);

static inline se3d_user_constraint_def se3d_user_constraint_def_default(void)
{
    se3d_user_constraint_def def;
    se3d_user_constraint_def_init(&def, sizeof def);
    return def;
}

/* Create a constraint whose equations a callback computes; its type is "user", its equations are
 * named "user_0", "user_1", ... @return OK, NULL, INVALID_ARGUMENT, STALE_HANDLE, NO_MEMORY.
 * Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_user_constraint_create(se3d_system *system,
                                                 const se3d_user_constraint_def *def,
                                                 se3d_constraint *constraint);

/* Set the prescribed value of a driver, primitive or coupler that was made without a function. The
 * state is made to follow before the next step, with the same velocities: a jump.
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_constraint_set_value(se3d_system *system, se3d_constraint constraint,
                                               double value);

/* Destroy a primitive, joint or driver. @return OK, STALE_HANDLE, IN_USE. Exclusive. @since 0.1 */
SE3D_API se3d_status se3d_constraint_destroy(se3d_system *system, se3d_constraint constraint);

SE3D_API se3d_status se3d_constraint_find(const se3d_system *system, const char *name,
                                          se3d_constraint *constraint);
SE3D_API se3d_status se3d_constraint_get_name(const se3d_system *system, se3d_constraint constraint,
                                              const char **name);
/* Get the type as in the model file: "dp1", "revolute", "driver", ... Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_type(const se3d_system *system, se3d_constraint constraint,
                                              const char **type);
/* Count the scalar equations. Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_count_equations(const se3d_system *system,
                                                     se3d_constraint constraint, size_t *count);
/* Get the name of equation k within the constraint: "cd_x", "dp1_a", ... Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_equation_name(const se3d_system *system,
                                                       se3d_constraint constraint, size_t k,
                                                       const char **name);
/* Count the bodies that take part (at least 2), and get one of them: 0 is body i, 1 is body j;
 * couplers have more. Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_count_bodies(const se3d_system *system,
                                                  se3d_constraint constraint, size_t *count);
SE3D_API se3d_status se3d_constraint_get_body(const se3d_system *system, se3d_constraint constraint,
                                              size_t slot, se3d_body *body);

/* Evaluate at the present state and time; arrays of se3d_constraint_count_equations numbers, or
 * NULL. Phi; nu of Phi_q qdot = nu; gamma of Phi_q qddot = gamma (it depends on the formulation,
 * because the unknown accelerations do). @return OK, NOT_FINITE. Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_eval(const se3d_system *system, se3d_constraint constraint,
                                          se3d_formulation formulation, double *phi, double *nu,
                                          double *gamma);

/* Evaluate the Jacobian with respect to the body in `slot`: phi_r [equations * 3], d Phi/d r;
 * phi_rotation [equations * 4] d Phi/d p in the r-p formulation, [equations * 3] with respect to
 * the virtual rotation in the body frame (Phi_pi) in r-omega; row-major; NULL arrays are skipped.
 * Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_eval_jacobian(const se3d_system *system,
                                                   se3d_constraint constraint,
                                                   se3d_formulation formulation, size_t slot,
                                                   double *phi_r, double *phi_rotation);

/* Get the multipliers of the last analysis [equations]: the force of the constraint on the bodies
 * is -Phi_q^T lambda. Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_multipliers(const se3d_system *system,
                                                     se3d_constraint constraint, double *lambda);

/* Get the reaction on body j at its joint point, ground frame: force [N] and torque [N m].
 * Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_reaction(const se3d_system *system,
                                                  se3d_constraint constraint, double force[3],
                                                  double torque[3]);

/* Get the reaction on the body in `slot`, its torque about `point` (ground frame [m]), both in the
 * frame of `marker` (null handle: the ground frame). Reader. @since 0.1 */
SE3D_API se3d_status se3d_constraint_get_reaction_at(const se3d_system *system,
                                                     se3d_constraint constraint, size_t slot,
                                                     const double point[3], se3d_marker marker,
                                                     double wrench[6]);

#ifdef __cplusplus
}
#endif
#endif
