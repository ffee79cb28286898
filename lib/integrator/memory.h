/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction under methods with error control: within a step it keeps its mode, at the end it may
 * change. docs/theory/friction.md */
#ifndef SE3DI_MEMORY_H
#define SE3DI_MEMORY_H

#include "integrator/state.h"

typedef struct se3di_memory_end {
    double error;    /* of the step, by modes that it should have changed within, relative to the
                        tolerance */
    double fraction; /* of the step that ends where the first of them does; 0: unknown */
    int32_t has_changed; /* modes, and with them accelerations (equations->x, l are the new ones) */
    int32_t has_moved;   /* velocities in the frames: what sticks stands still */
    double power[SE3DI_STATE_WORK]; /* before that, if modes have changed: the step ends with it */
} se3di_memory_end;

typedef struct se3di_memory_step {
    double t, h; /* its end and length */
    double tolerance;
    const double *begin;  /* the state that it begins with, as bodies have it (state.h) */
    const double *lambda; /* [rows] at the end */
    const se3di_state_scale *scale;
    double *memory; /* [forces * SE3DI_FORCE_STATES]: takes that of before, to be restored if the
                       step is not taken */
    double *work;   /* [unknowns] */
    double blur;    /* of the length: ways within the step that velocities do not make */
} se3di_memory_step;

/* What the speeds of impacts on stops that begin within a step of h differ from those that are
 * remembered, relative to the scales and the tolerance; above 1, *fraction is the part of the step
 * that ends where the first of them begins. */
double se3di_memory_review_stops(const se3di_model *model, double h, double tolerance,
                                 const se3di_state_scale *scale, double *fraction);

/* Whether some stop is touched, or left, within the step that ends at the state of the model: its
 * force has a kink there. */
int se3di_memory_meets_stop(const se3di_model *model);

/* What contacts remember of the end of a step is made of the beginning and the end alone: what
 * slips and sticks again on the way, or begins to touch, is forgotten. The frames are those at
 * `within`, half way; the ones of the end, in equations->saved, come back. *error is what the
 * forces at the end would be otherwise, if contacts had been accepted at `within`, too, times h,
 * relative to the scales and the tolerance. Of the step: t, h, tolerance, begin, scale. */
se3d_status se3di_memory_review_contacts(se3di_equations *equations, const se3di_memory_step *step,
                                         double within, double *error);
/* Of the tolerance of a run, for implicit methods: what one step forgets adds up. */
#define SE3DI_MEMORY_PART 0.03
/* The part of a step with such an error, above 1, that is tried next: it falls with the square. */
double se3di_memory_get_fraction(double error);

/* At the end of a step, at the state of the model: let the force elements remember it. What slips
 * and has turned comes to a stand, or slips on the other way: what it went against its direction is
 * error, relative to the scales and the tolerance; and so is what an element that breaks loose
 * changes of the accelerations, times h. */
se3d_status se3di_memory_settle(se3di_equations *equations, const se3di_memory_step *step,
                                se3di_memory_end *end);

#endif
