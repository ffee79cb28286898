/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves of a report: one frame with axes, as SVG. */
#ifndef SE3D_TOOL_CHART_H
#define SE3D_TOOL_CHART_H

#include <stdio.h>

enum { CHART_CURVES_MAX = 7 };

typedef struct chart {
    const char *title;
    char x_label[200], y_label[200];
    const double *x; /* [count] */
    const double *y[CHART_CURVES_MAX];
    const char *names[CHART_CURVES_MAX];
    const char *briefs[CHART_CURVES_MAX]; /* in the legend; NULL: the name */
    size_t curves, count;
    int is_spots; /* not 0: rows are spots, which nothing joins */
} chart;

/* Write it to a file that is open. Rows with a number that is not finite are left out. */
void chart_put(const chart *c, FILE *file);

#endif
