/* SPDX-License-Identifier: BSD-3-Clause */
/* A study, and one run of its model. */
#ifndef SE3D_IO_STUDY_STUDY_H
#define SE3D_IO_STUDY_STUDY_H

#include <stdbool.h>

#include "base/floats.h"
#include "io/base/pool.h"
#include "io/channel/channel.h"
#include "io/channel/study.h"
#include "io/model/model.h"
#include "io/study/tally.h"
#include "se3d/modes.h"
#include "se3d/study.h"

/* Room for one number and its comma. */
enum { SE3DI_STUDY_CELL = 48, SE3DI_STUDY_REASON = 400 };

struct se3d_study {
    se3di_iopool pool; /* of the study itself and all below */
    se3d_model *model; /* as it was read, with the tree of its file */
    const se3di_study_entry *entry;
    size_t analysis;      /* index of that which is measured */
    se3di_tally *tallies; /* [measure_count] */
    double *parameters;   /* of a sample */
    double *measures;
    se3di_named *values; /* of the parameters, for the reader */
    se3d_interrupt interrupt;
    void *interrupt_ctx;
    bool is_running; /* a sample: what it calls back may neither begin another nor destroy it */
    bool rebuilds;   /* every sample reads the model anew: for tests */
    struct se3di_prototype *prototype; /* inplace.c; NULL: none */
    bool is_sharp;    /* runs are as exact as methods can: their differences count */
    const char *head; /* first lines of its tables, without the shard */
    char *row;
    size_t row_size;
    se3di_iopool reply_pool; /* of the last answer */
};

/* What is told of the solver that has come to the state of a row, before it is taken. */
typedef struct se3di_row_listener {
    se3d_status (*reach)(void *ctx, se3d_solver *solver, double time);
    /* As in se3di_watch. */
    se3d_status (*settle)(void *ctx, se3d_solver *solver);
    se3d_status (*linearise)(void *ctx, const se3d_modes *modes);
    void *ctx; /* of all */
} se3di_row_listener;

enum { SE3DI_STUDY_LEVELS = 9 };

/* The place where a derivative is taken, and with respect to what. */
typedef struct se3di_study_point {
    se3di_named *values; /* [count] of parameters; one of them is changed and put back */
    size_t count, which;
    double step;           /* the first one; those behind it are halves */
    double follow_step;    /* of the only pair of models that follow; 0: they take `step`, too */
    double bounds[2];      /* nothing outside of them is run */
    double *const *beside; /* [2 levels] the measures below and above p at each step, as they are
                            * known already; NULL: by runs */
    size_t levels;         /* how many steps, 1 to SE3DI_STUDY_LEVELS: two runs each, and more steps
                       * if there are values on one side only */
    double *derivatives;   /* [measure_count] out; NaN: there is none */
    double *errors;        /* [measure_count] out, estimates; NULL: not wanted */
} se3di_study_point;

/* Work on samples: what it calls back may neither begin other work nor destroy the study, and the
 * processor rounds as the library wants it. May be nested. */
typedef struct se3di_study_work {
    se3di_floats host;
    bool was_running;
} se3di_study_work;
se3di_study_work se3di_study_begin(se3d_study *study);
void se3di_study_end(se3d_study *study, se3di_study_work work);
/* How its models are run. */
se3d_run_options se3di_study_get_options(const se3d_study *study);

/* Run the model with some parameters of it. @return as se3d_study_eval. */
se3d_status se3di_study_run(se3d_study *study, const se3di_named *values, size_t count,
                            double *measures, se3d_model_error *error);
/* The same, with somebody who is told of its rows; NULL: nobody. */
se3d_status se3di_study_run_with(se3d_study *study, const se3di_named *values, size_t count,
                                 const se3di_row_listener *listener, double *measures,
                                 se3d_model_error *error);
/* Read the model with some parameters of it; the caller destroys what was made, also if it failed.
 * @return OK, or why not: `error` says it */
se3d_status se3di_study_read(se3d_study *study, const se3di_named *values, size_t count,
                             se3d_model **model, se3d_model_error *error);
/* Take derivatives of all measures, by runs beside the point; `centre`: the measures there.
 * @return OK, NO_MEMORY, INTERRUPTED */
se3d_status se3di_study_differentiate(se3d_study *study, const se3di_study_point *point,
                                      const double *centre);
/* The first step of a point: a power of two. */
double se3di_study_first_step(const se3di_study_point *point);
/* A first step for derivatives with respect to a parameter that has this value. */
double se3di_study_get_step(const se3d_study *study, const char *name, double value);
/* "# se3d study ...": what all tables of the study begin with, then the rest of the first line and
 * the names of the columns. */
const char *se3di_study_get_columns(const se3d_study *study);

#endif
