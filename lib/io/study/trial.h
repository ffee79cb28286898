/* SPDX-License-Identifier: BSD-3-Clause */
/* One model of a study that is measured: how its rows become measures. */
#ifndef SE3D_IO_STUDY_TRIAL_H
#define SE3D_IO_STUDY_TRIAL_H

#include "io/channel/output.h"
#include "io/study/study.h"

typedef struct se3di_trial {
    se3d_study *study;
    se3d_model *model;
    se3di_tally *tallies;            /* [measure_count] */
    se3di_iopool *tally_pool;        /* of the rows they keep; lasts as long as they do */
    bool is_set;                     /* the model is that of the study's prototype */
    se3di_iopool pool;               /* of this sample */
    size_t *places;                  /* [source_count] in a row */
    se3d_expression_symbol *symbols; /* [symbol_count] parameters of this sample */
    size_t symbol_count;
    const se3di_row_listener *listener; /* NULL: none */
    se3d_model_error *error;
} se3di_trial;

/* Make the model with these parameters: set in that of the study's prototype, or read.
 * @return OK, or why not: t->error says it */
se3d_status se3di_trial_make_model(se3di_trial *t, const se3di_named *values, size_t count);
/* What a row is made of. @return OK, NO_MEMORY */
se3d_status se3di_trial_find_channels(se3di_trial *t, se3di_output_entry *output);
void se3di_trial_begin(se3di_trial *t);
/* Take a row: the time, then the numbers of the channels. @return OK, NO_MEMORY */
se3d_status se3di_trial_take_row(se3di_trial *t, const double *row);
/* Take what is measured at an event; ctx: the trial. */
se3d_status se3di_trial_take_event(void *ctx, se3d_system *system, const se3d_event_record *record);
/* Take a mode; ctx: the trial. */
void se3di_trial_take_mode(void *ctx, size_t index, const se3d_eigenvalue *eigenvalue);
/* All measures at the end of the run, NaN: none. @return OK, NOT_FINITE, NO_MEMORY */
se3d_status se3di_trial_conclude(se3di_trial *t, double *measures);
/* Let methods of high order hold their errors near rounding, if the study wants it. */
void se3di_trial_sharpen(const se3di_trial *t);

#endif
