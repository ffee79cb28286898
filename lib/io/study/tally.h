/* SPDX-License-Identifier: BSD-3-Clause */
/* Measures of one run, made of its rows and events on the way. */
#ifndef SE3D_IO_STUDY_TALLY_H
#define SE3D_IO_STUDY_TALLY_H

#include <stdbool.h>

#include "io/base/pool.h"
#include "io/channel/study.h"

typedef struct se3di_tally {
    const se3di_study_measure *measure;
    double start, time, last; /* of the first row, and of the last one with its number */
    double first, most, least;
    double sum, squares; /* integrals so far */
    double found;        /* AT, TIME_OF */
    double outside;      /* SETTLING: when it was last outside of the band, going in from there */
    bool has_row, has_found, is_in;
    double *times, *values; /* SETTLING to the last value: all rows */
    size_t count, time_capacity, value_capacity;
} se3di_tally;

/* Begin a run; what the tally has of memory stays for it. */
void se3di_tally_begin(se3di_tally *tally, const se3di_study_measure *measure);
/* The wanted value at x: straight lines between the points of a MISFIT, and beyond them. */
double se3di_tally_get_wanted(const se3di_study_measure *measure, double x);
/* Take the number of a row. @return false: out of memory. */
bool se3di_tally_add(se3di_tally *tally, se3di_iopool *pool, double time, double value);
/* Take what is found at the event of the measure; only the first time counts. */
void se3di_tally_find(se3di_tally *tally, double value);
/* The measure at the end of the run, NaN if it has none; then *problem says why. */
double se3di_tally_get(const se3di_tally *tally, const char **problem);

#endif
