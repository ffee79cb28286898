/* SPDX-License-Identifier: BSD-3-Clause */
/* The Newmark family (generalized_alpha, hht) on index 2, stabilised (Arnold, Bruels, Cardona
 * 2015), at steps of any lengths; orientations move on the group in both formulations:
 *
 *     x   = h v_n + h^2 (1/2 - beta) a_n + h^2 beta a      q = q_n moved by x, then by z
 *     v   = v_n + h (1 - gamma) a_n + h gamma a
 *     (1 - alpha_m) a + alpha_m a_n = (1 - alpha_f) vdot + alpha_f vdot_n
 *     M vdot + Phi_q^T lambda = Q + velocity terms,   Phi_q v = nu(t),   Phi(q, t) = 0
 *
 * at t = t_n + h; lambda holds the velocities on their constraints, z the positions. a is an
 * approximation of vdot at t + delta h, delta = alpha_m - alpha_f of equal steps; a_n keeps the
 * place d_n that it was made for, and alpha_m, beta, gamma of a step follow from it.
 * docs/theory/newmark.md */
#ifndef SE3DI_NEWMARK_H
#define SE3DI_NEWMARK_H

#include "integrator/state.h"

/* Below it rounding of velocities, over the cube of the step, is what differences show. */
#define SE3DI_NEWMARK_REACH 1e-11

/* Of equal steps. */
typedef struct se3di_newmark {
    double alpha_m, alpha_f;
} se3di_newmark;

/* The history: this header, then the arrays of se3di_newmark_history. Of `at`, the time is that of
 * the accepted state as runs were asked for it. */
typedef struct se3di_newmark_header {
    se3di_adaptive_history at;
    se3di_state_scale scale;
    double end;                           /* of the last step, as it was computed */
    double origin;                        /* where equal steps began */
    double count;                         /* of equal steps since then, */
    double equal;                         /* so long [s] */
    double place;                         /* of a, relative to the accepted state [s] */
    double last;                          /* the last step [s], 0: none */
    double redundant;                     /* rows are dependent */
    double power[SE3DI_STATE_WORK];       /* of the accepted state */
    double power_begin[SE3DI_STATE_WORK]; /* at the beginning of the last step */
} se3di_newmark_header;

#define SE3DI_NEWMARK_HEADER (sizeof(se3di_newmark_header) / sizeof(double))
_Static_assert(sizeof(se3di_newmark_header) == (18 + 2 * SE3DI_STATE_WORK) * sizeof(double),
               "it is an array of double in the model");

typedef struct se3di_newmark_history {
    se3di_newmark_header *header;
    double *y, *y_begin;           /* the accepted state, that at the beginning of the last step */
    double *a;                     /* [unknowns] */
    double *vdot, *vdot_begin;     /* [unknowns] */
    double *lambda, *lambda_begin; /* [rows] */
} se3di_newmark_history;

/* A step that is being solved. */
typedef struct se3di_newmark_step {
    se3di_integration *integration;
    se3di_equations *equations;
    se3di_assembly *assembly;
    double h, t;
    double alpha_m, alpha_f, beta, gamma; /* of this step */
    double velocity, position;            /* d v / d vdot, d x / d vdot */
    double length;                        /* of the mechanism [m] */
    const double *a_n, *vdot_n;           /* [unknowns] */
    double *v_n, *vdot, *a, *x, *z;       /* [unknowns] */
    double *b, *dz;                       /* [unknowns] */
    double *lambda, *c;                   /* [rows] */
    double correction, previous;          /* size of the last two Newton corrections of vdot */
    double gap;                           /* of positions before the last one, relative */
    int opens;                            /* there is a gap to close */
    int is_finite;                        /* the last correction */
    int exact;                            /* the Newton matrix has stiffness, damping, curvature */
    int settles;                          /* friction changes its modes at the end of the step */
} se3di_newmark_step;

size_t se3di_newmark_history_count(const se3di_assembly *assembly);
size_t se3di_newmark_work_count(const se3di_assembly *assembly);
se3di_newmark_history se3di_newmark_get_history(const se3di_assembly *assembly);

/* A first guess: vdot goes on as in the last step. */
void se3di_newmark_predict(se3di_newmark_step *step);
/* From a first guess of vdot and lambda. On success the frames are those of the end of the step. */
se3d_status se3di_newmark_solve(se3di_newmark_step *step);

/* Factor the Newton matrix at the state of the model, whose Jacobian is in the assembly. */
se3d_status se3di_newmark_factor(se3di_newmark_step *step);

/* The largest velocities of the model's state, or what its accelerations make on the way of its
 * length and a turn of 1 rad: [0] of translation, [1] of rotation. */
void se3di_newmark_find_scales(const se3di_assembly *assembly, const double *vdot, double scale[2]);

/* The displacement z over the motion of the step: of the size h^2, but large if a step has met its
 * constraints on another branch of the motion, near a singular position. NaN if z is. Motion that
 * begins in the step (a driver t^3 from rest) has such a z, too: a_n = 0 makes x = beta/gamma h v
 * of it, whatever it was. Step control makes such steps shorter; where lengths are given it
 * `bears_growth`, that part of the speed that has been gained is left out, and accelerations at
 * the end, which may be of any size on another branch, say nothing. */
double se3di_newmark_measure_shift(const se3di_newmark_step *step, int bears_growth);
/* *error of the solved step, relative to the tolerance; 0 if any is accepted (`most` 0). */
se3d_status se3di_newmark_estimate(se3di_newmark_step *step, double most, double *error);

#define SE3DI_NEWMARK_SAME_TIME 1e-9 /* of a step: two times are one */

/* Functions of the table of methods. */
se3d_status se3di_newmark_start(se3di_integration *integration, double h);
se3d_status se3di_newmark_renew(se3di_integration *integration);
/* From the model's state, by h. */
se3d_status se3di_newmark_make_step(se3di_integration *integration, double h);
/* The next step of the run, of the length asked for or with control of its error; none if the
 * last one has ended at t_end but for rounding. */
se3d_status se3di_newmark_advance(se3di_integration *integration, double t_end);
/* Steps past t_end, where the model gets the state. */
se3d_status se3di_newmark_run(se3di_integration *integration, double t_end);
void se3di_newmark_interpolate(const se3di_integration *integration, double t, double *y);
/* Give the model the state at t, within the last step or at its end. */
se3d_status se3di_newmark_publish(se3di_integration *integration, double t);

/* What the entries of the family in the table of methods have, beside their own `newmark`. */
#define SE3DI_NEWMARK_METHOD                                                                       \
    .history_count = se3di_newmark_history_count, .work_count = se3di_newmark_work_count,          \
    .start = se3di_newmark_start, .renew = se3di_newmark_renew, .step = se3di_newmark_make_step,   \
    .run = se3di_newmark_run, .advance = se3di_newmark_advance,                                    \
    .interpolate = se3di_newmark_interpolate, .is_implicit = 1, .is_reduced = 1,                   \
    .orders = 1u << 2, .reach = SE3DI_NEWMARK_REACH, .fixes_step = 1

#endif
