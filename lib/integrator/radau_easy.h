/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether a motion that `auto` has given to radau is stiff no more: an explicit method would be
 * stable in steps of the length that radau takes for the sake of accuracy. The fastest rate of the
 * motion on its constraints is that by which velocities grow under
 *
 *     (q, v) <- (v, M^-1 (-K q - D v))
 *
 * Of where bodies touch nothing is said: each touch is followed by any method, and radau does it in
 * fewer steps.  docs/theory/radau.md */
#ifndef SE3DI_RADAU_EASY_H
#define SE3DI_RADAU_EASY_H

#include "integrator/radau.h"

/* In the history. */
typedef struct se3di_radau_ease {
    double rate;    /* the fastest, where it was looked at last [1/s] */
    double until;   /* steps until the next look */
    double count;   /* steps in a row in which an explicit method would have been stable */
    double is_over; /* 1: there were enough of them */
} se3di_radau_ease;

/* After an accepted step, the frames at its end. */
void se3di_radau_watch_ease(se3di_radau *m, const se3di_adaptive_history *at,
                            se3di_radau_ease *ease);

#endif
