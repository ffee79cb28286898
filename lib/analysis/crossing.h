/* SPDX-License-Identifier: BSD-3-Clause */
/* The times at which a function reaches zero within one step: numbers only, no mechanics.
 *
 * The function is known in two ways: `rough` values, cheap, of the nodes and of points between
 * them, and `exact` ones, which count. docs/theory/events.md */
#ifndef SE3DI_CROSSING_H
#define SE3DI_CROSSING_H

#include "se3d/base.h"

#include <stdint.h>

#define SE3DI_CROSSING_NODES 8
#define SE3DI_CROSSINGS_MAX  (2 * SE3DI_CROSSING_NODES)

typedef se3d_status (*se3di_crossing_eval)(void *ctx, double t, double *value);

typedef struct se3di_crossing_function {
    se3di_crossing_eval rough, exact;
    void *ctx;
    const double *t;   /* nodes, ascending: from the beginning to the end of the step */
    const double *g;   /* rough values there */
    int count;         /* of nodes */
    double band;       /* >= 0: this near to zero no side can be told */
    int32_t direction; /* +1: rising, -1: falling, 0: both */
    int32_t side;      /* of the beginning if that is in the band: -1, +1, or 0 for none */
} se3di_crossing_function;

typedef struct se3di_crossing {
    double t;          /* the first time, to rounding, at which zero is reached or passed */
    int32_t direction; /* +1: from below */
    int32_t reserved;
} se3di_crossing;

typedef struct se3di_crossings {
    se3di_crossing list[SE3DI_CROSSINGS_MAX]; /* in order of time */
    int32_t count;
    int32_t side; /* on which the function was last seen beyond the band without a crossing since;
                     only known (not 0) where it ends in the band */
} se3di_crossings;

/* All crossings after the beginning of the step. A crossing is one of zero from a side on which the
 * function has been beyond the band. What begins at zero has not crossed it; what ends at zero
 * has. */
se3d_status se3di_crossings_find(const se3di_crossing_function *function, se3di_crossings *found);

#endif
