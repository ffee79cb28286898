/* SPDX-License-Identifier: BSD-3-Clause */
/* What explicit methods integrate: the state as a vector y with y' = f(t, y), its three last
 * numbers the works. Behind one table:
 *
 *     bodies   y = (r, p, v, w) of every free body, see state.h; projected after every step
 *     joints   y = (q, qdot) of the tree (tree/tree.h); on it constraints hold by themselves
 *
 * Whatever the state, force elements, events and outputs see the frames of the model. */
#ifndef SE3DI_MOTION_H
#define SE3DI_MOTION_H

#include "integrator/state.h"

typedef struct se3di_motion {
    /* Numbers of a state, at most se3di_state_count. */
    size_t (*count)(const se3di_equations *equations);
    /* The state of the model. */
    void (*get)(se3di_equations *equations, double *y);
    /* y becomes the state of the model's frames; what follows is evaluated there. */
    void (*set)(se3di_equations *equations, const double *y);
    /* The same after a step that has ended there: nothing is placed where it is already. */
    void (*set_again)(se3di_equations *equations, const double *y);
    /* y becomes the state of the model's frames, and another one is set before any evaluation.
     * @return whether the frames are finite, as far as that is known without looking at each */
    int (*set_frames)(se3di_equations *equations, const double *y);
    /* y' of the state that was set last in the places of state.h, (a, wdot) at least; `out`
     * [se3di_state_count] may not be needed. */
    const double *(*get_rates)(se3di_equations *equations, const double *derivative, double *out);
    /* y' at t of the state that was set last. */
    se3d_status (*evaluate)(se3di_equations *equations, double t, double *derivative);
    /* y becomes the state, and the same there; the model's frames may stay behind. */
    se3d_status (*evaluate_at)(se3di_equations *equations, double t, const double *y,
                               double *derivative);
    /* The same from accelerations in equations->x and multipliers l [rows]. */
    se3d_status (*derive)(se3di_equations *equations, double t, const double *l,
                          double *derivative);
    /* The rates of positions of a state y, in their places of `derivative`; the rest stays. */
    void (*move)(const se3di_equations *equations, const double *y, double *derivative);
    /* What a small change of y, at the state that was set last, is for the bodies: (dr, turn / 2
     * as of p, dv, dw) in the places of state.h; `out` [se3di_state_count] may not be needed. */
    const double *(*spread)(se3di_equations *equations, const double *change, double *out);
    /* The same of two changes: the largest squares over all bodies, and changes of states (see
     * se3di_tree_measure); `room` has 2 se3di_state_count. NULL: one by one. */
    void (*measure)(const se3di_equations *equations, const double *const change[2], double *room,
                    double parts[2][4], double states[2]);
    /* The state that was set onto its constraints at t, see se3di_state_project. */
    se3d_status (*project)(se3di_equations *equations, double t, const se3di_state_scale *scale,
                           double accuracy, int is_factored);
    /* How far it is off, see se3di_state_measure_gap. */
    se3d_status (*measure_gap)(se3di_equations *equations, double t, const se3di_state_scale *scale,
                               double *gap);
    /* y becomes the state that was set last; nothing is placed. NULL: it always is. */
    void (*take)(se3di_equations *equations, const double *y);
    /* That state as a vector: all but the works. */
    void (*keep)(se3di_equations *equations, double *y);
    /* The frames of the model are at y, as kept: it becomes the state that was set last. */
    void (*stand)(se3di_equations *equations, const double *y);
    /* The velocities of the frames were changed: those of the state that was set last are. */
    void (*follow)(se3di_equations *equations);
    /* That state is accepted: turns are counted from its angles. */
    void (*accept_angles)(se3di_equations *equations);
    /* y in the places of state.h; the model is left alone. */
    void (*show)(se3di_equations *equations, const double *y, double *bodies);
    /* Whether `evaluate` finds all that a model shows of its accelerations and multipliers: at
     * every state, or at most of them; whether nothing acts on an open tree but force elements
     * without functions and memory, and constant gravity; and whether it can do so later, when only
     * efforts have changed and nobody's code is called, */
    int (*finds_all)(const se3di_equations *equations);
    int (*may_report)(const se3di_equations *equations);
    int (*are_all_plain)(const se3di_equations *equations);
    int (*can_wait)(const se3di_equations *equations);
    /* and then: those of the last evaluation become the model's (0: at that state it has not found
     * them, the model's stay); `evaluate` with the efforts of the last evaluation, whatever they
     * are by now; what it needs to do so after other evaluations is kept, and comes back. NULL: it
     * never does. */
    int (*report)(se3di_equations *equations);
    se3d_status (*evaluate_again)(se3di_equations *equations, double t, double *derivative);
    void (*keep_efforts)(se3di_equations *equations);
    void (*come_back)(se3di_equations *equations);
    /* Rows that were dependent in the last evaluation. */
    double (*count_dependent)(const se3di_equations *equations);
} se3di_motion;

extern const se3di_motion se3di_motion_bodies, se3di_motion_joints;

/* Of the model as it is: joints if the formulation has a tree and no row is left out of it. */
const se3di_motion *se3di_motion_find(const se3di_equations *equations);

#endif
