/* SPDX-License-Identifier: BSD-3-Clause */
/* Iterations of gauss whose stages are the lanes of registers: for trees of joints on which nothing
 * but gravity acts, where the processor has as many lanes as there are stages. The same bits as one
 * stage after the other.                       docs/theory/gauss.md, docs/theory/lanes.md */
#ifndef SE3DI_GAUSS_LANES_H
#define SE3DI_GAUSS_LANES_H

#include "integrator/explicit_step.h"
#include "integrator/gauss_rule.h"
#include "tree/lanes.h"

typedef struct se3di_gauss_lanes {
    se3di_lanes lanes;
    size_t positions, velocities;
    double *K;       /* [positions + velocities][stages] derivatives of the stages */
    double *Y;       /* their states */
    double *next;    /* derivatives there */
    double *change;  /* times h, of the derivatives */
    double *weights; /* [stages][stages] h a_ij, of stage i in lane i */
    double *gravity; /* [3][stages] */
    double *parts;   /* [4][stages] */
    double *verdict; /* [stages] */
} se3di_gauss_lanes;

/* Doubles of work of the method, what is here included. */
size_t se3di_gauss_work_count(const se3di_assembly *assembly);

/* @return whether the stages of the step can be computed so */
int se3di_gauss_lanes_init(se3di_gauss_lanes *g, se3di_explicit *m, const se3di_gauss_rule *rule);
/* Take the derivatives of the stages in m->K. */
void se3di_gauss_lanes_begin(se3di_gauss_lanes *g, const se3di_explicit *m,
                             const se3di_gauss_rule *rule, double h);
/* One iteration; *change, relative to the scales, of a step by the derivatives. @return whether all
 * are finite */
int se3di_gauss_lanes_sweep(se3di_gauss_lanes *g, se3di_explicit *m, const se3di_gauss_rule *rule,
                            double h, double *change);
/* Give the derivatives back, those of positions at the velocities of the last iteration. */
void se3di_gauss_lanes_end(se3di_gauss_lanes *g, se3di_explicit *m);

#endif
