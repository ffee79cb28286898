/* SPDX-License-Identifier: BSD-3-Clause */
/* The state of the free bodies as one vector, and what integrators of first-order form need:
 *
 *     y = (r, p, v, w) of every free body, 13 numbers each        y' = (v, 1/2 G(p)^T w, a, wdot)
 *
 * the same in both formulations, which differ in the equations that give a and wdot; and three last
 * numbers: the work dissipated, of actuators and of drivers, whose derivatives are powers. */
#ifndef SE3DI_STATE_H
#define SE3DI_STATE_H

#include "integrator/integrator.h"

#define SE3DI_STATE_SIZE 13 /* numbers per body */
#define SE3DI_STATE_WORK 3  /* after those of the bodies */

/* Characteristic sizes that errors are measured by. */
typedef struct se3di_state_scale {
    double length, speed, spin, energy; /* [m], [m/s], [rad/s], [J] */
} se3di_state_scale;

size_t se3di_state_count(const se3di_assembly *assembly);
/* r, p, v, w of one body. */
void se3di_state_pack(const se3di_frame *frame, double *y);
void se3di_state_get(const se3di_assembly *assembly, double *y);
/* Sets the frames; p is normalised on the way. */
void se3di_state_set(se3di_assembly *assembly, const double *y);
/* The accelerations of y' become those of the model: of a state that the model steps on from
 * without showing it, whatever it has shown last. */
void se3di_state_set_rates(se3di_assembly *assembly, const double *derivative);
/* y' at t from the frames, the accelerations `qddot` [unknowns] and the multipliers l [rows], which
 * become those of the model if powers depend on them. */
se3d_status se3di_state_derivative(se3di_assembly *assembly, double t, const double *qddot,
                                   const double *l, double *derivative);

/* The same where accelerations and multipliers were found last: elements without a memory tell
 * their powers with their wrenches. */
se3d_status se3di_state_derivative_of(se3di_equations *equations, double t, double *derivative);
/* Its last three numbers; l NULL: no power depends on multipliers. */
se3d_status se3di_state_powers(se3di_assembly *assembly, double t, const double *l,
                               double power[3]);

/* The same where power[0] and power[1] hold those of gravity and elements, and the loads were found
 * last. */
se3d_status se3di_state_complete_powers(se3di_assembly *assembly, double t, const double *l,
                                        double power[3]);

/* Before a series of evaluations: the mass if it is constant, and the linear solver's settings
 * for the regularisation `eps`; after it: the settings as they were. Near singular positions an
 * acceleration is then a smooth function of the state: eps and the two refinements act as a filter,
 * (eps / (eps + sigma^2))^3 of a constraint direction of relative size sigma is not enforced, if
 * its multiplier has no leverage anyway; errors are amplified by eps^(-1/2) at most. */
se3di_kkt_settings se3di_state_begin(se3di_equations *equations, double eps, double accuracy);
/* Before the evaluations of one step: what changes little within it (and must not depend on the
 * steps before) is kept. `redundant`: rows that have been dependent all along; if there are
 * more, the position is nearly singular. `wide`: they are so by geometry alone. */
void se3di_state_begin_step(se3di_equations *equations, double redundant, int wide);
void se3di_state_end(se3di_equations *equations, const se3di_kkt_settings *settings);
/* The same filter for the Newton matrices of implicit methods; @return the settings before.
 * Rounding and curvature contradict themselves in dependent rows: a smaller regularisation would
 * amplify that, and so would many refinements: one, and those of the Newton iteration itself, make
 * up for its size. A correction of relative size SE3DI_STATE_NOISE that does not fall any more is
 * such rounding. */
#define SE3DI_STATE_REGULARISATION 1e-5
#define SE3DI_STATE_NOISE          1e-8
se3di_kkt_settings se3di_state_regularise(const se3di_assembly *assembly, se3di_kkt *kkt,
                                          double eps);
/* Accelerations at the present frames into equations->x, multipliers into equations->l; without the
 * checks and records of se3di_acceleration_solve. */
se3d_status se3di_state_evaluate(se3di_equations *equations, double t);
/* Whether drivers prescribe rates that follow signals: rows of velocities alone. */
int se3di_state_has_rates(const se3di_equations *equations);
/* Fails with INCONSISTENT if they do not hold at the velocities of the model, projected, at t. */
se3d_status se3di_state_check_rates(se3di_equations *equations, double t,
                                    const se3di_state_scale *scale);
/* Positions and velocities onto their constraints at t, mass-weighted. `accuracy` is the relative
 * violation that does not matter. `is_factored`: the last evaluation was here, and its
 * factorisation serves. */
se3d_status se3di_state_project(se3di_equations *equations, double t,
                                const se3di_state_scale *scale, double accuracy, int is_factored);
/* *gap: the largest relative violation of constraints by the present positions and velocities at t,
 * measured as `accuracy` is. */
se3d_status se3di_state_measure_gap(se3di_equations *equations, double t,
                                    const se3di_state_scale *scale, double *gap);
/* The positions alone, where functions of time and (in r-omega) mass blocks are evaluated. */
se3d_status se3di_state_project_positions(se3di_equations *equations, double t,
                                          const se3di_state_scale *scale, double accuracy);

/* Force and torque (body frame) of a generalised force on a body with the orientation of
 * `frame`. */
void se3di_state_split_force(const se3di_assembly *assembly, const se3di_frame *frame,
                             const double *generalised, double force[3], double torque[3]);

#define SE3DI_STATE_TURN 2.0 /* rad */

/* A step of at most h in which no joint angle turns by more than SE3DI_STATE_TURN, which its
 * counter can follow and stages see, if rates grow by at most `growth` [rad/s^2]. */
double se3di_state_limit_turn(const se3di_model *model, double growth, double h);

/* Length of the mechanism's parts. */
double se3di_state_length(const se3di_model *model);
/* Grow speed, spin and energy to those of the present state with derivative `derivative`. */
void se3di_state_scale_grow(const se3di_assembly *assembly, const double *derivative,
                            se3di_state_scale *scale);
/* Speed and spin alone, by the largest squares of velocities, angular ones, and accelerations of
 * both. */
void se3di_state_scale_take(const double squares[4], se3di_state_scale *scale);

/* Whether free body k carries a user-defined state: of its six velocities the first is one, and its
 * position means nothing. */
int se3di_state_is_carrier(const se3di_assembly *assembly, size_t k);
/* A change (v, w) of the velocities of free body k, relative to the scales, or to the size of the
 * state that it carries. */
double se3di_state_part(const se3di_assembly *assembly, size_t k, const se3di_state_scale *scale,
                        const double change[6]);

/* Whether the frames of free bodies are finite. @return OK, NOT_FINITE */
se3d_status se3di_state_check(const se3di_equations *equations, double t);
/* The state at t is about to be accepted: all that can fail. What a callback computed last may have
 * failed without anybody asking yet. */
se3d_status se3di_state_prepare(se3di_equations *equations, double t);

/* A state to be shown: an accepted one, or an interpolated one, which is projected. */
typedef struct se3di_shown {
    const double *y;
    double t;
    const se3di_state_scale *scale;
    double
        rough; /* 0: with accelerations and multipliers, the constraints to rounding; else without
                     them, the constraints to this */
    int32_t project;
    int32_t reserved;
} se3di_shown;

/* Within which violation constraints are left in rows of the motion alone, of the tolerance. */
#define SE3DI_STATE_ROUGH 0.1

/* The `rough` of what a run shows in its present model, to `tolerance`: nothing that acts needs
 * multipliers, nothing else than the motion was asked for. */
double se3di_state_rough(const se3di_model *model, int shows_motion, double tolerance);

/* The model's state from y at t. */
se3d_status se3di_state_publish(se3di_equations *equations, const se3di_shown *shown);
/* The last part of it: frames, accelerations and multipliers are those at t already, joint angles
 * have been accepted. */
se3d_status se3di_state_conclude(se3di_equations *equations, const double *work, double t);
/* The same with the powers there, NULL: they follow. */
void se3di_state_conclude_step(se3di_equations *equations, const double *work, const double *power,
                               double t);
/* The same where there are frames only. */
se3d_status se3di_state_conclude_motion(se3di_equations *equations, const double *work, double t);
/* The same of frames that are known to be finite. */
void se3di_state_take_motion(se3di_model *model, const double *work, double t);

#endif
