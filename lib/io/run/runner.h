/* SPDX-License-Identifier: BSD-3-Clause */
/* A run that is under way. */
#ifndef SE3D_IO_RUNNER_H
#define SE3D_IO_RUNNER_H

#include <time.h>

#include "io/channel/output.h"
#include "io/channel/sample.h"
#include "io/model/model.h"
#include "io/run/run_events.h"
#include "io/run/watch.h"
#include "io/write/average.h"
#include "io/write/csv.h"
#include "io/write/summary.h"
#include "io/write/vtk.h"

typedef struct se3di_output_file {
    const se3di_output_entry *entry;
    se3di_csv csv;
    const char *made; /* what the CSV file becomes, which is then taken away; NULL: it stays */
    se3di_vtk *vtk;   /* NULL: it is a CSV file */
    se3di_summary *summary;     /* NULL: it has rows, */
    se3di_average_sum *average; /* unless it is one of fields or a wall */
    double *row;
    double every; /* in this analysis */
    double count; /* number of the last row, the one at the end */
    double next;  /* number of the next row */
    bool is_made; /* `made` is there, whole */
    bool solves;  /* its rows need accelerations or multipliers */
} se3di_output_file;

struct se3d_run {
    se3di_iopool pool;
    se3d_run_analysis *analyses;
    size_t analysis_count;
    se3d_run_file *files;
    size_t file_count, file_capacity;
    se3d_run_particles *particles;
    size_t particles_count;
    se3di_event_list events;
    se3d_run_summary *summaries;
    size_t summary_count, summary_capacity;
};

struct se3di_resume;
struct se3di_told;
struct se3di_guests;
typedef struct se3di_estimate se3di_estimate;

typedef struct se3di_runner {
    se3d_model *model;
    const se3di_watch *watch; /* gets the rows in place of files; NULL: there are files */
    size_t settled;           /* the analysis whose end it is told of; SIZE_MAX: none */
    size_t analysis;          /* that runs */
    const se3d_run_options *options;
    se3d_run *run;
    se3d_model_error *error;
    se3di_output_file *files;
    size_t file_count; /* open ones */
    se3d_solver *solver;
    struct se3di_guests *guests; /* units beside the analysis; NULL: none */
    se3di_estimate *estimate;    /* of the error of equal steps; NULL: none */
    se3di_sample sample;         /* what the rows of one time ask for */
    se3d_solver_stats stats;
    double time;                 /* where the analysis before ended */
    struct se3di_resume *resume; /* a checkpoint that the run goes on from; NULL: none, or done */
    struct se3di_told *told;     /* warnings of the run, for checkpoints */
    double saved;                /* when the last checkpoint was written, by the clock [s] */
    double cpu_before;           /* of the analysis that runs, in the programs before [s] */
    clock_t begin;               /* of that in this one */
    double flushed; /* when the rows so far were last written to the disk, by the clock [s] */
    bool stopped;
    bool kept; /* the checkpoint that stays is written */
} se3di_runner;

/* Whether files may have to be gone on with later. */
static inline bool se3di_runner_has_checkpoints(const se3di_runner *r)
{
    return r->options->checkpoint > 0.0 || r->options->resume || r->options->keep;
}

#endif
