/* SPDX-License-Identifier: BSD-3-Clause */
/* Explicit methods with step control and dense output, on index 1: accelerations from the
 * equations of motion, then, after every accepted step, projection of positions and velocities onto
 * their constraints. What a method does within a step is a table; all else is here.
 *
 * The method keeps its own forward state (t_1, y_1, y'_1) in the model's history, up to one step
 * ahead of the model's time: outputs are interpolated, projected and given consistent
 * accelerations, and never change the steps.
 * docs/theory/explicit-runge-kutta.md, docs/theory/gauss.md */
#ifndef SE3DI_EXPLICIT_STEP_H
#define SE3DI_EXPLICIT_STEP_H

#include "integrator/adaptive.h"
#include "integrator/crowd_watch.h"
#include "integrator/motion.h"
#include "integrator/sums.h"

#define SE3DI_EXPLICIT_ROWS  17 /* vectors of work: stages and what a method needs beside them */
#define SE3DI_EXPLICIT_FORMS 11 /* vectors of history: what it interpolates by */

/* The history begins with this, then y_1 (at at.time), y'_1, y_0 (at at.begin) and what the method
 * keeps for its interpolation. */
typedef struct se3di_explicit_past {
    se3di_adaptive_history at;
    se3di_state_scale scale;
    double balance[2];   /* of forces that balance: [m/s^2, rad/s^2], whose rounding moves */
    double energy_least; /* what the potential at the start says of the size of energies */
    double dense;        /* 1: the interpolation is ready */
    double forced;       /* steps that only a jump of the accelerations explained */
    double redundant;    /* the fewest dependent rows so far */
    double held;         /* signs in a row that stability limits the steps */
    double free;         /* signs against it since */
    double since;        /* steps since the last look */
    union {
        struct {
            double stages;      /* gauss: of the last step, which the next one continues; 0: none */
            double contraction; /* of the iterations of the last step */
            double lost;        /* 1: rows were dependent at its end that are not all along */
        };
        se3di_crowd_watch watch; /* Runge-Kutta */
    };
    double length;   /* Runge-Kutta: of the last step, as its stages were made */
    double unscaled; /* 1: steps without error control have not grown the scale */
    double gap;      /* what the interpolation violates constraints by, < 0: not measured */
    double wide;     /* 1: redundant rows are so by geometry alone (linsol/kkt.h) */
    double narrow;   /* how often it was tried whether they are, in vain */
} se3di_explicit_past;
_Static_assert(sizeof(se3di_explicit_past) == 28 * sizeof(double),
               "it is an array of double in the model");

typedef struct se3di_explicit se3di_explicit;
typedef struct se3di_explicit_class se3di_explicit_class;

struct se3di_explicit_class {
    /* The stages of a step of h from (t_1, y_1, y'_1); *error, 0 before the call, may be raised. Of
     * the history only y_0 and what the method has for itself may change. */
    se3d_status (*make_stages)(se3di_explicit *m, double h, double *error);
    /* y at the end, to m->y. */
    void (*arrive)(se3di_explicit *m, double h);
    /* Whether steps of this call are made without the frames of the model, which nobody looks at
     * between them; then the derivative at m->y at t, to the end, and how fast bodies move there,
     * to m->squares: 0 if something is not finite. NULL: never. */
    int (*is_bare)(const se3di_explicit *m);
    int (*find_end)(se3di_explicit *m, double t);
    /* The error of the step, with the derivative at its end; `error`: that from the stages. */
    double (*estimate_end)(se3di_explicit *m, double h, double error);
    /* The step of h is about to be accepted: m->y1, m->f1 are still those before. NULL: nothing. */
    void (*accept)(se3di_explicit *m, double h);
    /* The next step, if errors alone decide. */
    double (*next_step)(const se3di_explicit *m, double h, double error);
    /* The first step, of the h that derivatives suggest. NULL: h. */
    double (*shorten_first)(const se3di_explicit *m, double h);
    /* As of se3di_adaptive_class. */
    double (*shrink)(const se3di_explicit *m, se3d_status status, double error);
    /* After a step: whether stability holds them short (past->held, past->free). */
    void (*watch_stability)(se3di_explicit *m, double h);
    se3d_status (*build_dense)(se3di_explicit *m);
    /* Within the last step. */
    void (*interpolate)(const se3di_explicit *m, double t, double *y);
    /* The root of the error of a step; the vector of work for the derivative at its end. */
    int (*get_order)(const se3di_explicit *m);
    int (*get_end)(const se3di_explicit *m);
    int is_watched; /* not 0: stability is watched although the method is not left for it */
    int keeps_end;  /* not 0: `accept` takes the derivative at the end, which cannot wait */
};

struct se3di_explicit {
    se3di_adaptive step; /* first, so that it is found from the loop's */
    const se3di_explicit_class *methods;
    const se3di_sums *sums;
    const struct se3di_rk_tableau *tableau;
    const se3di_motion *motion;
    se3di_equations *equations;
    se3di_assembly *assembly;
    size_t count; /* numbers of a state */
    se3di_explicit_past *past;
    double *y1, *f1, *y0, *forms;
    double *K;          /* [SE3DI_EXPLICIT_ROWS][count] */
    double *y;          /* state of a stage */
    double *sum, *sum3; /* error estimates */
    double *memory;     /* [forces * SE3DI_FORCE_STATES] */
    double *bodies[2];  /* a change of the state as the bodies see it */
    double *next;       /* derivative that the next step begins with */
    double tolerance;
    double h;           /* of the step that is tried; 0: none yet */
    double contraction; /* gauss: of the iterations of this step; 0: unknown */
    double squares[4];  /* of a bare step: as of se3di_state_scale_take */
    double turns[2];    /* the largest angular velocity and acceleration of a body at y_1 */
    double remembered;  /* the least error that the choice of the next step counts with */
    int stages;         /* gauss: of this step */
    int laid_out;       /* gauss: the stages that lanes are laid out for; 0: none yet */
    int is_closed;      /* gauss: its stages are closed, and so is its end before all else */
    int is_bare;        /* no frames are made between steps */
    int is_plain;       /* gauss, dop853: an open tree with plain forces */
    int is_met;         /* gauss: a stage or the end is too near to a singular position */
    int knows_turns;    /* `turns`: y_1 is the end of a bare step of this call */
    int stands;         /* the frames are at y_1: a step of this call has ended there */
    int has_rates;      /* the accelerations of the model are those at y_1 */
    int has_stages;     /* K is that of the last step: it was made in this call */
    int leaves_scale;   /* the scale grows when errors are measured again */
    int waits;          /* y'_1, and what the model shows of it, is computed when it is needed */
    se3di_kkt_settings kkt; /* of the model's linear solver, to come back to */
};

#define SE3DI_HELD_MIN 15.0 /* signs that are enough, */
#define SE3DI_FREE_MIN 6.0  /* and signs against that take them back */

/* out = base + h sum_k coefficients_k rows_k over the first `limit` vectors; base may be NULL. */
void se3di_explicit_combine(const se3di_explicit *m, const double *rows, const double *base,
                            double h, const double *coefficients, int limit, double *out);
/* The largest part of an error vector, relative to the scales; and to the tolerance. */
double se3di_explicit_size(const se3di_explicit *m, const double *error);
/* The same of two. */
void se3di_explicit_sizes(const se3di_explicit *m, const double *const error[2], double size[2]);
/* What they are relative to in this step. */
se3di_state_scale se3di_explicit_measure_both_by(const se3di_explicit *m);
double se3di_explicit_measure(const se3di_explicit *m, const double *error);
/* Derivative at t at the state y; the model's frames may stay behind. */
se3d_status se3di_explicit_evaluate(se3di_explicit *m, double t, const double *y,
                                    double *derivative);
/* The vector of work for the derivative at the end of the step. */
double *se3di_explicit_end(const se3di_explicit *m);
/* One more sign that stability limits the steps, or one against it. */
void se3di_explicit_count_sign(se3di_explicit *m, int is_held);
/* Whether the accepted state is one to leave. */
void se3di_explicit_watch_crowd(se3di_explicit *m);

/* For the table of a method, see integrator.h. */
size_t se3di_explicit_history_count(const se3di_assembly *assembly);
size_t se3di_explicit_work_count(const se3di_assembly *assembly);
double se3di_gauss_get_reach(const se3di_integration *integration, const se3di_model *model);
se3d_status se3di_explicit_start(se3di_integration *integration, double h);
se3d_status se3di_explicit_renew(se3di_integration *integration);
int se3di_explicit_renews_all(const se3di_integration *integration);
/* What the last step has left to be computed (base/pending.h) is not computed unless the state
 * comes back to its end; it does, and is. */
void se3di_explicit_put_off(se3di_integration *integration);
void se3di_explicit_come_back(se3di_integration *integration);
/* One step of length h without error control. */
se3d_status se3di_explicit_step(se3di_integration *integration, double h);
/* To t_end with step control. */
se3d_status se3di_explicit_run(se3di_integration *integration, double t_end);
/* Whether t is within the last step, whose motion is shown by an interpolation that is ready. */
int se3di_explicit_is_within(const se3di_integration *integration, double t);
/* Counts in the history are counts, whoever wrote it. */
int se3di_explicit_is_sound(const double *history, size_t count);
se3d_status se3di_explicit_advance(se3di_integration *integration, double t_end);
void se3di_explicit_interpolate(const se3di_integration *integration, double t, double *y);
int se3di_explicit_is_held(const se3di_integration *integration);
int se3di_explicit_leaves_crowd(const se3di_model *model);
void se3di_explicit_stay(se3di_model *model);

/* Local errors are a part of the tolerance, and no smaller than rounding allows. */
#define SE3DI_EXPLICIT_PART  0.03
#define SE3DI_EXPLICIT_LOOSE 3e-4 /* a tolerance: beyond it dop853 takes a larger part */
#define SE3DI_EXPLICIT_LEAST 2e-13
#define SE3DI_EXPLICIT_REACH (SE3DI_EXPLICIT_LEAST / SE3DI_EXPLICIT_PART)

/* What the entries of all of them in the table of methods have; with more work. */
#define SE3DI_EXPLICIT_METHOD SE3DI_EXPLICIT_METHOD_WITH(se3di_explicit_work_count)
#define SE3DI_EXPLICIT_METHOD_WITH(count)                                                          \
    .history_count = se3di_explicit_history_count, .work_count = (count),                          \
    .start = se3di_explicit_start, .renew = se3di_explicit_renew,                                  \
    .renews_all = se3di_explicit_renews_all, .step = se3di_explicit_step,                          \
    .run = se3di_explicit_run, .advance = se3di_explicit_advance,                                  \
    .interpolate = se3di_explicit_interpolate, .is_sound = se3di_explicit_is_sound,                \
    .is_explicit = 1, .reach = SE3DI_EXPLICIT_REACH

#endif
