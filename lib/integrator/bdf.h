/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of bdf: the accepted states and the polynomials through them (bdf_history.c); the equations
 * of a step and their Newton iteration (bdf_newton.c); the step, its error and its control (bdf.c).
 * docs/theory/bdf.md */
#ifndef SE3DI_BDF_H
#define SE3DI_BDF_H

#include "integrator/relax.h"

#define SE3DI_BDF_REACH      1e-11 /* smallest tolerance of a run */
#define SE3DI_BDF_ORDER_MAX  5
#define SE3DI_BDF_POINTS_MAX (SE3DI_BDF_ORDER_MAX + 2)

/* The history: this header and the accepted states, newest first. */
typedef struct se3di_bdf_past {
    se3di_adaptive_history at;
    se3di_state_scale scale;
    double order;  /* of the next step */
    double used;   /* degree of the polynomial over the last step */
    double since;  /* steps since the order changed */
    double starts; /* 1: no step was rejected and no order found too high yet */
    double count;  /* states that there are, */
    double c;      /* the weight of the last step, */
    se3di_fastness fast;
    double times[SE3DI_BDF_POINTS_MAX];
} se3di_bdf_past;

#define SE3DI_BDF_PAST (sizeof(se3di_bdf_past) / sizeof(double))
_Static_assert(sizeof(se3di_bdf_past) == (19 + SE3DI_BDF_POINTS_MAX) * sizeof(double),
               "it is an array of double in the model");

typedef struct se3di_bdf {
    se3di_integration *integration;
    se3di_equations *equations;
    se3di_assembly *assembly;
    size_t count; /* numbers of a state */
    se3di_bdf_past *past;
    double *times, *points;
    double *base;      /* of y_1 = base + c y'_1 */
    double *predicted; /* y_P */
    double *y;         /* y_1 */
    double *difference;
    double *acceleration; /* a, wdot of each free body [6] */
    double *work;         /* [unknowns] */
    double *lambda;       /* [rows] */
    double tolerance;     /* of the local error */
    double fraction;      /* of the step, that a turn of friction asks for; 0: none does */
    double accuracy;      /* violation of constraints that does not matter: near a singular position
                             velocities magnify it by the square of the inverse distance */
    double t, h, c;       /* the end of the step, its length, its weight */
    double *relaxation;   /* [2 * unknowns + rows] */
    se3di_fastness fast;
    double power[SE3DI_STATE_WORK]; /* at the end of the step, */
    int32_t has_power;              /* once it is known */
    int32_t iterations_max;
    int32_t is_controlled; /* shorter steps find where contact begins */
} se3di_bdf;

/* ---- bdf_history.c ---- */

/* The newest state is y at t. */
void se3di_bdf_push(se3di_bdf *m, const double *y, double t);
/* Forget the states at t and after. */
void se3di_bdf_drop_from(se3di_bdf *m, double t);
/* Whether steps of this order are stable and accurate on the times of the states with the next step
 * h. */
int se3di_bdf_is_even(const se3di_bdf *m, int order, double h);
/* Prepare the step from the newest state by m->h at the order: y_P, base, c, accelerations. */
void se3di_bdf_predict(se3di_bdf *m, int order);
/* The local error that a step of this order would have made, from y_1: in m->difference. */
void se3di_bdf_get_error(se3di_bdf *m, int order);
/* The polynomial of the last step at t, and its derivative. */
void se3di_bdf_eval(const se3di_bdf *m, double t, double *y);
void se3di_bdf_eval_rate(const se3di_bdf *m, double t, double *rate);
/* m->y, with the derivative m->difference, at the time s later (or before) on a parabola. */
void se3di_bdf_extend(const se3di_bdf *m, double s, double *y);
/* The accelerations and powers jump by those in `jump` (like y'), the works by `work`: move the
 * states before the newest one to where they would have been with the new ones. */
void se3di_bdf_bend(se3di_bdf *m, const double *jump, const double work[SE3DI_STATE_WORK]);

/* ---- bdf_newton.c ---- */

/* y_1 and the multipliers of a prepared step. */
se3d_status se3di_bdf_solve(se3di_bdf *m);

/* Put its positions onto their constraints along the Newton matrix, if springs are far faster than
 * it: the projection, which knows masses only, would stretch them by what is open. */
se3d_status se3di_bdf_close(se3di_bdf *m);

#endif
