/* SPDX-License-Identifier: BSD-3-Clause */
/* Functions that are the integral of what they are given as: F(t) = start + integral of f from
 * `origin` to t.  docs/theory/functions.md */
#ifndef SE3DI_MODEL_INTEGRAL_H
#define SE3DI_MODEL_INTEGRAL_H

#include "math/sum.h"
#include "model/model.h"

/* The sums over whole panels on one side of the origin. */
typedef struct se3di_panel_sums {
    se3di_sum *sums; /* [capacity]; entry k: over the panels 0 ... k */
    size_t count, capacity;
} se3di_panel_sums;

typedef struct se3di_integral {
    double start, origin;
    double *knots; /* [table_count] of a spline: the integral from its first point to each */
    size_t knot_count;
    se3di_panel_sums side[2]; /* after the origin, before it; not of splines and constants */
} se3di_integral;

/* Make the integral of `function`, whose content is made. */
se3d_status se3di_integral_create(const se3d_allocator *allocator, se3di_function *function,
                                  double start, double origin);
void se3di_integral_release(const se3d_allocator *allocator, se3di_integral *integral);

/* A copy that knows no sums. */
se3d_status se3di_integral_clone(const se3d_allocator *allocator, const se3di_integral *integral,
                                 se3di_integral **out);

/* F(t), the same bits whatever is remembered. Returns 0 if f is not finite somewhere,
 * or if t is more than 1e6 s from the origin and F has no closed form. */
int se3di_integral_eval(const se3di_function *function, double t, double *value);

/* Let the integral of a constant begin at `t`, with the same value. */
void se3di_integral_move(se3di_function *function, double t);

/* Room for the sums up to `t`, so that se3di_integrals_advance needs no memory. */
se3d_status se3di_integrals_reserve(se3di_model *model, double t);

/* Remember the sums up to `t`: later evaluations near it are short. Steps call it; readers, who may
 * be several at a time, do not. */
void se3di_integrals_advance(se3di_model *model, double t);

/* What is integrated, f: a view of `function` without its integral. It owns nothing. */
se3di_function se3di_integral_rate(const se3di_function *function);

#endif
