/* SPDX-License-Identifier: BSD-3-Clause */
/* Signals: numbers of the state that laws of force elements are functions of.
 * docs/theory/signals.md */
#ifndef SE3DI_FORCE_SIGNAL_H
#define SE3DI_FORCE_SIGNAL_H

#include "force/measure.h"

/* A signal with its derivatives to the displacements (dr, dtheta) and the velocities (v, w) of two
 * bodies. */
typedef struct se3di_signal_value {
    double value;
    uint32_t bodies[2];
    double q[12]; /* d value / d (dr, dtheta) of both */
    double u[12]; /* d value / d (v, w) */
} se3di_signal_value;

/* The bodies that it depends on. */
void se3di_signal_bodies(const se3di_model *model, const se3di_signal *signal, uint32_t bodies[2]);
/* Evaluate one; wants_derivative 0: the value only. @return OK, SINGULAR: the points of a length
 * coincide */
se3d_status se3di_signal_eval(const se3di_model *model, const se3di_signal *signal, double t,
                              int wants_derivative, se3di_signal_value *out);
/* The function that an output or input of a state is; NULL: it is none. */
const se3di_function *se3di_signal_function(const se3di_model *model, const se3di_signal *signal);
/* The signals that a function depends on in the end, and their number. */
uint32_t se3di_law_count_leaves(const se3di_model *model, const se3di_function *function);
const se3di_signal *se3di_law_get_leaf(const se3di_model *model, const se3di_function *function,
                                       uint32_t k);
/* A function at `own`, the variables that its element gives, and at its signals; jet and gradient
 * [SE3D_FUNCTION_VARIABLES_MAX] (or NULL) as those of se3di_function_eval, own variables first.
 * Of a function of signals without a gradient: the value alone. `notes`: of what is evaluated at
 * this state, NULL: none. */
se3d_status se3di_law_eval(const se3di_model *model, const se3di_function *function,
                           const double *own, se3di_law_notes *notes, double jet[3],
                           double *gradient);
/* Whether the law of an element is the user's code, or depends on such a function. */
int se3di_law_has_callback(const se3di_model *model, const se3di_force *force);
/* Slopes to the three own variables: those to signals, which may stand there, become zero. */
void se3di_law_keep_own(const se3di_function *function, double *gradient);
/* d wrench / d (value of its function c), c = 0, 1, 2. */
void se3di_force_gain(const se3di_model *model, const se3di_force *force, int c, double gain[12]);

/* What a leaf of function c adds to the derivatives of the wrench: rows of body k of the element,
 * columns of body m of the signal are block 2 k + m of K, D [4][6][12], of which six columns are
 * used. */
se3d_status se3di_signal_tangent(const se3di_model *model, const se3di_force *force, int c,
                                 uint32_t leaf, double t, uint32_t bodies[2], double K[288],
                                 double D[288]);

#endif
