/* SPDX-License-Identifier: BSD-3-Clause */
/* Iterations of gauss whose stages are the lanes of registers: for trees of joints on which nothing
 * but gravity acts, open or with loops whose rows come from the links alone.
 *
 * Open trees have the same bits one stage after the other, which is done where the processor has no
 * lanes. With loops the stages' accelerations are those of the states that their loops' closing
 * leads to, at positions and velocities, so that they do not depend on how far a stage is off its
 * constraints; every processor computes them here, by as many lanes as it has.
 *                                              docs/theory/gauss.md, docs/theory/lanes.md */
#ifndef SE3DI_GAUSS_LANES_H
#define SE3DI_GAUSS_LANES_H

#include "integrator/explicit_step.h"
#include "integrator/gauss_rule.h"
#include "tree/lanes.h"

/* A group of stages: w of them, one in each lane. */
typedef struct se3di_gauss_group {
    se3di_lanes lanes;
    double *Y;       /* [positions + velocities][w] states */
    double *closed;  /* the same with their loops closed */
    double *next;    /* derivatives there */
    double *change;  /* times h, of the derivatives */
    double *A;       /* [stages][w] a_ij, of stage i in its lane; */
    double *weights; /* h times these */
    double *values;  /* [stages][w] of the forms of the step, of form i in its lane */
    double *forms;   /* [SE3DI_GAUSS_FORMS][w] of the prediction */
    double *gravity; /* [3][w] */
    double *sizes;   /* [w] of the changes */
    double *verdict; /* [w] */
    double *squares; /* [4][w] */
} se3di_gauss_group;

typedef struct se3di_gauss_lanes {
    const se3di_lane_core *core;
    size_t positions, velocities, stages, width;
    int has_loops;
    double scale[3]; /* that changes are measured by in this step: of length, speed, spin */
    double *K;       /* [positions + velocities][stages] derivatives of the stages */
    se3di_gauss_group groups[SE3DI_GAUSS_MAX];
} se3di_gauss_lanes;

/* Doubles of work of the method, what is here included. */
size_t se3di_gauss_work_count(const se3di_assembly *assembly);

/* Whether auto takes gauss: nothing but constant gravity acts, and then, with these equations, the
 * stages are computed here as long as it does. */
int se3di_gauss_lanes_suit_model(const se3di_model *model);
int se3di_gauss_lanes_suit_equations(const se3di_equations *equations);
/* Whether loops can be computed here, by what changes only with a rebuild. */
int se3di_gauss_lanes_suit_loops(const se3di_equations *equations);
/* Whether they are in the next step: not where functions change gravity. */
int se3di_gauss_lanes_take_loops(const se3di_explicit *m);
/* Whether stages are: where they are loops or the open tree are so on every processor. */
int se3di_gauss_lanes_suit(const se3di_explicit *m);
/* @return what the stages of the step are computed by, in the work of the method; NULL: they cannot
 * be computed so */
se3di_gauss_lanes *se3di_gauss_lanes_find(se3di_explicit *m, const se3di_gauss_rule *rule);
/* The derivatives of the stages are those of the prediction. */
void se3di_gauss_lanes_begin(se3di_gauss_lanes *g, const se3di_explicit *m, double h,
                             const se3di_gauss_prediction *prediction);
/* Iteration k; *change, relative to the scales, of a step by the derivatives. @return whether all
 * are finite: they are not where rows of loops are not clear of each other */
int se3di_gauss_lanes_sweep(se3di_gauss_lanes *g, se3di_explicit *m, const se3di_gauss_rule *rule,
                            int k, double h, double *change);
/* Whether steps are made here from end to end, and nobody looks at what is between them. */
int se3di_gauss_lanes_are_bare(const se3di_explicit *m);
/* The derivative at m->y; `squares`: how fast bodies move there, as survey() of the lanes has it.
 * @return whether all is finite */
int se3di_gauss_lanes_differentiate(se3di_gauss_lanes *g, se3di_explicit *m, double t,
                                    double *derivative, double squares[4]);
/* The sizes of two changes at the state that was differentiated last. */
void se3di_gauss_lanes_sizes(const se3di_gauss_lanes *g, const double *const change[2],
                             double size[2]);
/* The forms of the polynomial through the derivatives, those of positions at the velocities of the
 * last iteration: `forms` [stages][m->count]. */
void se3di_gauss_lanes_end(se3di_gauss_lanes *g, const se3di_explicit *m, double *forms);

#endif
