/* SPDX-License-Identifier: BSD-3-Clause */
/* What ends a run before its time: the caller who wants no more, and too many steps.
 *
 * Steps are counted as they are tried. From time to time the number that the run will take is
 * foreseen, at the pace of the last half of them and at that of all: what is slow for a while only
 * is no reason to give up. */
#ifndef SE3DI_BASE_GUARD_H
#define SE3DI_BASE_GUARD_H

#include "se3d/base.h"

typedef struct se3di_guard {
    se3d_interrupt interrupt; /* NULL: nobody asks for an end */
    void *ctx;
    double most;       /* steps that a run may take */
    double begin, end; /* of the run [s] */
    double steps;      /* tried since */
    double half;       /* of them, when the time was `half_time` */
    double half_time;
    double next;   /* number of steps at which the pace is looked at */
    int32_t came;  /* the caller has asked for the end of this run */
    int32_t muted; /* not 0: what is under way is short and must be finished */
} se3di_guard;

/* How a run goes, if it takes too many steps. */
typedef struct se3di_guard_pace {
    double steps;    /* tried so far */
    double length;   /* of the last ones [s]; 0: the time stands still */
    double foreseen; /* of the whole run */
} se3di_guard_pace;

/* At the beginning of a call that is to come to `end`. */
void se3di_guard_begin(se3di_guard *guard, double begin, double end);
/* Whether the caller wants an end; `guard` may be NULL. */
int se3di_guard_ask(se3di_guard *guard);
/* A step from t is going to be tried. @return whether the run takes too many */
int se3di_guard_count(se3di_guard *guard, double t, se3di_guard_pace *pace);

#endif
