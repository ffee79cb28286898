/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps with control of their error: the loop that all methods share. A step is tried, and again
 * with shorter ones until its error meets the tolerance; what it has learnt is kept only if one
 * does.
 *
 * The history of such a method begins with se3di_adaptive_history. */
#ifndef SE3DI_ADAPTIVE_H
#define SE3DI_ADAPTIVE_H

#include "integrator/integrator.h"

typedef struct se3di_adaptive se3di_adaptive;

/* What a method does within the loop. */
typedef struct se3di_adaptive_class {
    /* The longest step from the accepted state that motion and contacts allow, at most h. */
    double (*pace)(se3di_adaptive *step, double h);
    /* Try a step of h: *error is relative to the tolerance. Above 1, or on failure, nothing is
     * remembered of it. */
    se3d_status (*attempt)(se3di_adaptive *step, double h, double *error);
    /* Take the step that was tried; it ends at step->t. The next one and the error go to the
     * history; on failure it is rejected. */
    se3d_status (*accept)(se3di_adaptive *step, double h, double error);
    /* The factor for the step after one of h that was rejected, or has failed with `status`. */
    double (*shrink)(se3di_adaptive *step, double h, se3d_status status, double error);
    /* No step is short enough: the last one was h. @return the failure, or OK if a step was taken
     * by other means */
    se3d_status (*surrender)(se3di_adaptive *step, double h, se3d_status status, double error);
    double least; /* a step is not shorter than this part of the time */
} se3di_adaptive_class;

/* The first member of what a method knows of its step. */
struct se3di_adaptive {
    const se3di_adaptive_class *methods;
    se3di_integration *integration;
    se3di_adaptive_history *at;
    double
        fraction;   /* of the step that was tried, that a turn of friction asks for; 0: none does */
    double resumed; /* the length that the next step takes up after one that a change of contact has
                       cut short; 0: none has */
    double t;       /* the end of the step that is tried: time + h but for rounding */
    int32_t tries;  /* of this step, from 1 */
    int32_t ends;   /* it may not go past the end of the run */
};

/* Whether a step has failed because a callback reports a failure at a time beyond t_end, where it
 * need not be defined: one that ends at t_end does without. The failure is forgotten then, and the
 * message is `told` again, the one of before the step. */
int se3di_adaptive_may_cut(se3di_equations *equations, se3d_status status, double t_end,
                           const se3di_error *told);

/* One accepted step; towards t_end, not past it if step->ends, or if a callback fails there; none
 * at a kink (integrator/kink_step.h). */
se3d_status se3di_adaptive_advance(se3di_adaptive *step, double t_end);

/* Whether a shorter step may do what one that failed did not; a callback that returns a failure
 * ends the run, one that writes a number that is not finite asks for a shorter step. */
int se3di_adaptive_may_shrink(se3d_status status);

/* Whether the next step may not go past the end of the run: what acts has changed and may soon do
 * so again; or shapes touch or are near, where forces and accelerations follow from what contacts
 * remember of the end of a step, and cannot be told within it. */
int se3di_adaptive_ends(const se3di_integration *integration, const se3di_adaptive_history *at);

/* A pace of methods that need no more: no step over a contact that begins, nor of more than an
 * angle's counter can follow. */
double se3di_adaptive_pace(se3di_adaptive *step, double h);

/* No step from t is shorter. */
double se3di_adaptive_least(const se3di_adaptive *step, double t);

/* h, or settings.step if that is less. */
double se3di_adaptive_limit(const se3di_integration *integration, double h);

/* The failure of a method whose steps have become too short: its own, or that the tolerance cannot
 * be met at t. The frames are those of the accepted state. */
se3d_status se3di_adaptive_blame(const se3di_integration *integration, double t, double h,
                                 se3d_status cause);

#endif
