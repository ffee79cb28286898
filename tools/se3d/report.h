/* SPDX-License-Identifier: BSD-3-Clause */
/* What the pages of reports are made of. */
#ifndef SE3D_TOOL_REPORT_H
#define SE3D_TOOL_REPORT_H

#include "chart.h"
#include "se3d/io.h"
#include "table.h"

enum { REPORT_LABEL_SIZE = 200 };

/* The numbers of a table, column by column. */
typedef struct sheet {
    table t;
    const se3d_model *model; /* whose channels were listed; NULL: none */
    size_t channels;
    double *columns; /* [t.count][rows] */
    /* of a run, each [t.count]: quantity and unit, and whether it is no more than rounding */
    char (*labels)[REPORT_LABEL_SIZE];
    char *zero;
    size_t rows, x; /* x: the column on the horizontal axis */
} sheet;

/* Of more than `most` rows, every so many are read. @return false: out of memory */
int sheet_read(sheet *s, size_t most);
const double *sheet_get_column(const sheet *s, size_t k);

void report_put_tag(FILE *page, const char *tag, const char *text);
/* A cell of a table, which is empty where there is no number. */
void report_put_number(FILE *page, double value);
/* @return false: it cannot be drawn */
int report_put_chart(FILE *page, const chart *c);

/* report_study.c: what came out of the samples of a study, of which `x` (NULL: all) is the one
 * parameter that curves are drawn over. @return false: out of memory */
int report_put_samples(FILE *page, sheet *s, const char *x);
/* The text of a table as it is, but for digits. @return false: it cannot be read */
int report_put_cells(FILE *page, const char *path);

#endif
