/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of radau: the stage equations and their Newton iteration (radau_stages.c); the step, its
 * error and its control (radau.c). docs/theory/radau.md */
#ifndef SE3DI_RADAU_H
#define SE3DI_RADAU_H

#include "integrator/radau_rule.h"
#include "integrator/relax.h"

#define SE3DI_RADAU_STAGES 3

/* Of the rows of stages that are projected, which are consistent. */
#define SE3DI_RADAU_REGULARISATION 1e-9

typedef struct se3di_radau {
    se3di_integration *integration;
    se3di_equations *equations;
    se3di_assembly *assembly;
    se3di_state_scale scale;
    size_t count;     /* numbers of a state */
    double t, h;      /* of the step */
    double tolerance; /* of the iteration: relative size of what may be missing */
    double accuracy;  /* of the projection of stages */
    double inner;     /* the tolerance of the estimate; 0: errors are not controlled */
    double *y0;       /* the state at t */
    double *f0;       /* its derivative */
    double *lambda0;  /* its multipliers [rows] */
    double *d;        /* h f0 less what the stages' polynomial has there */
    /* Of the stages, three of each: */
    double *Y;      /* states [count] */
    double *lambda; /* [rows] */
    double *shift;  /* onto the constraints of positions [6 a body] */
    double *b;      /* minus the residual of the equations of motion [unknowns] */
    double *g;      /* Phi_q qdot - nu [rows] */
    double *gap;    /* -Phi [rows] */
    double *u, *uq; /* corrections of velocities and positions, transformed [unknowns] */
    double *ul;     /* of multipliers, transformed [rows] */
    double *C1;     /* constraints of the Newton matrix */
    double *vdot, *none, *sum, *sum_q;
    double *relaxation; /* [2 * unknowns + rows] */
    double *normal;     /* what is projected away of a correction; 0 if stages are not */
    double *lines;      /* of stiff forces: radau_lines.h */
    double fraction;    /* of the step, that a turn of friction asks for; 0: none does */
    se3di_fastness fast;
    double size;    /* of the last correction, relative to the tolerance, */
    double past[3]; /* and of those before, newest first: they fall in turns of three */
    int iterations, iterations_max;
    int is_stiff;    /* d is filtered */
    int has_changed; /* friction its modes, at the end of the step */
    int has_lines;   /* some force is stiff */
    int projects;    /* not 0: accelerations of stages are those of the states projected onto the
                     constraints, each with rows of its own: where bodies and joints make loops,
                     rows may be dependent */
} se3di_radau;

size_t se3di_radau_work_count(const se3di_assembly *assembly);
/* Point into integration->work; history is the caller's. */
void se3di_radau_begin(se3di_radau *m, se3di_integration *integration);

/* f0. The frames are set. */
se3d_status se3di_radau_prepare(se3di_radau *m);
/* The stages, from the predictions of Y (velocities) and lambda. */
se3d_status se3di_radau_solve(se3di_radau *m);
/* The error estimate of the solved step, filtered by the Newton matrix, from d = h f_0 - h u'(0):
 * relative to the scales. If stiff forces at the start make nearly all of d, which the motion does
 * not follow, d is what the filter has left. */
se3d_status se3di_radau_filter(se3di_radau *m, double *d, double *error);

/* Put the end of the solved step onto the constraints of positions along the Newton matrix: the
 * projection, which knows masses only, would stretch stiff springs by what is open. */
se3d_status se3di_radau_close(se3di_radau *m);

/* Accelerations of a stage [unknowns]. */
void se3di_radau_get_acceleration(const se3di_radau *m, int stage, double *vdot);

/* The state in which a single step begins. */
typedef struct se3di_radau_begin_state {
    double *y; /* not changed */
    double t;
    const se3di_state_scale *scale;
} se3di_radau_begin_state;

/* A step of h without error control, solved to rounding, for methods of several steps to begin
 * with: its end, not projected, in y1 and the frames, its accelerations, and its multipliers in the
 * model. integration->work holds se3di_radau_work_count numbers. */
se3d_status se3di_radau_make_step(se3di_integration *integration,
                                  const se3di_radau_begin_state *from, double h, double *y1,
                                  double *acceleration);

#endif
