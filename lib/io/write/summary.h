/* SPDX-License-Identifier: BSD-3-Clause */
/* Extremes, means and integrals of the columns of a run, from its rows. */
#ifndef SE3D_IO_SUMMARY_H
#define SE3D_IO_SUMMARY_H

#include "io/channel/output.h"
#include "io/write/csv.h"

enum { SE3DI_SUMMARY_COLUMNS = 9 };

typedef struct se3di_summary {
    se3d_run_summary *columns; /* [count] what is known so far */
    double *last;              /* [count] of the last row */
    size_t count;
    double time, span; /* of the last row, of all [s] */
    bool begun;
} se3di_summary;

/* A summary of the channels of an output. @return NULL: out of memory */
se3di_summary *se3di_summary_create(se3di_iopool *pool, const se3di_output_entry *entry);
/* One more row, [count] values. A row before the last in time begins anew. */
void se3di_summary_add(se3di_summary *summary, double time, const double *values);
/* What is known so far. */
void se3di_summary_pack(se3di_summary *summary, se3di_coder *coder);
/* Means of what has been added. */
void se3di_summary_finish(se3di_summary *summary);
/* The name of a column of the file. */
const char *se3di_summary_get_column(size_t k);
/* Write a row for each channel. */
void se3di_summary_write(const se3di_summary *summary, se3di_csv *csv);

#endif
