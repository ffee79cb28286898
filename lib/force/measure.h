/* SPDX-License-Identifier: BSD-3-Clause */
/* A scalar coordinate x of two bodies (length, angle, displacement) with its derivatives, and what
 * a force n against it does:
 *
 *     wrench = -n g,  g = dx/dq       K = -g (n_x g + n_xdot u^T H) - n H       D = -n_xdot g g^T
 *
 * with H = dg/dq and u the velocities (xdot = g . u).  docs/theory/springs.md */
#ifndef SE3DI_FORCE_MEASURE_H
#define SE3DI_FORCE_MEASURE_H

#include "force/force.h"

typedef struct se3di_measure {
    double value, rate;
    double g[12];
    double u[12];  /* v, w of i and j */
    double H[144]; /* if wanted */
} se3di_measure;

/* A force law at one state: n and its slopes. */
typedef struct se3di_law {
    double n, n_x, n_rate;
} se3di_law;

/* Evaluate the coordinate of a term. */
void se3di_measure_term(const se3di_model *model, const se3di_term *term, int wants_H,
                        se3di_measure *measure);
/* The distance of two points. Returns 0 if they coincide: g is then zero, the value exact. */
int se3di_measure_length(const se3di_model *model, const se3di_force *force, int wants_H,
                         se3di_measure *measure);
/* The term whose value is the coordinate of a joint that an element acts on. */
void se3di_measure_begin(const se3di_model *model, const se3di_force *force, se3di_term *term);
/* Only g, u and the rate of the coordinate of a joint, which cost no angle. */
void se3di_measure_gradient(const se3di_model *model, const se3di_force *force,
                            se3di_measure *measure);
/* The coordinate that a friction, stop, effort or rsda acts on. Returns 0 as above. */
int se3di_measure_force(const se3di_model *model, const se3di_force *force, int wants_H,
                        se3di_measure *measure);

/* Its value alone, without which direction it changes in. Returns 0 as above. */
int se3di_measure_value(const se3di_model *model, const se3di_force *force, double *value);

/* The coordinate of a joint (se3d_joint_coordinate). */
void se3di_measure_joint(const se3di_model *model, uint32_t joint, int32_t coordinate, int wants_H,
                         se3di_measure *measure);

/* Second derivative of the coordinate of a friction or stop on a joint, at the accelerations of the
 * model. */
double se3di_measure_acceleration(const se3di_model *model, const se3di_force *force);

/* Its part that does not depend on accelerations. */
double se3di_measure_curve(const se3di_model *model, const se3di_force *force);

/* Velocities of bodies i and j. */
void se3di_velocity_pair(const se3di_model *model, const se3di_force *force, double u[12]);

/* Add what the law does to the effect; also sets coordinate, rate and value. */
void se3di_effect_add(se3di_effect *effect, const se3di_measure *measure, const se3di_law *law);

/* The D primitive between the points of an element. */
void se3di_length_term(const se3di_force *force, se3di_term *term);

/* The spring law k x + preload + spring(x) + c xdot + damper(xdot) + h(t, value, rate), x = value -
 * rest; fills potential and power of the effect too. */
se3d_status se3di_spring_law(const se3di_model *model, const se3di_force *force, double t,
                             const se3di_measure *measure, se3di_effect *effect, se3di_law *law);
/* The potential where it is that of preload and stiffness alone, as se3di_force_class has it. */
se3d_status se3di_spring_find_potential(const se3di_model *model, const se3di_force *force,
                                        double t, double *potential);

#endif
