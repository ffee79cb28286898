/* SPDX-License-Identifier: BSD-3-Clause */
/* What two runs differ by: the curves of the second file less those of the first, row by row, at
 * times that both have. Nothing is interpolated, as that would differ, too. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "outcome.h"
#include "plot.h"

static int fail(const table *t, const char *why, const char *name)
{
    complain("se3d plot: %s %s%s\n", t->path, why, name);
    return 0;
}

/* The first column and the curves of a table: values[column * rows + row]. */
static int read_curves(const plot *p, const table *t, double *values, size_t rows)
{
    size_t column = 1;
    int good = table_read_column(t, 0, 1, values, rows) == rows;
    for (size_t k = 0; k < p->panel_count; ++k) {
        for (size_t i = 0; i < p->panels[k].count && good; ++i, ++column) {
            const size_t at = table_find(t, p->panels[k].names[i]);
            if (at == t->count) {
                return fail(t, "has no channel ", p->panels[k].names[i]);
            }
            good = table_read_column(t, at, 1, values + column * rows, rows) == rows;
        }
    }
    return good || fail(t, "was changed by another program", "");
}

/* Whether two columns of times are the same but for rounding. */
static int is_same(const double *a, const double *b, size_t rows)
{
    const double small = 1e-9 * fabs(a[rows - 1] - a[0]);
    int same = 1;
    for (size_t row = 0; row < rows; ++row) {
        same = same && fabs(a[row] - b[row]) <= small;
    }
    return same;
}

/* As far as both go. */
static int write_difference(plot *p, double *a, double *b, size_t rows)
{
    const table *t = p->tables;
    const size_t count = plot_count_curves(p) * rows;
    if (!read_curves(p, &t[0], a, rows) || !read_curves(p, &t[1], b, rows)) {
        return 0;
    }
    if (strcmp(t[0].names[0], t[1].names[0]) != 0 || !is_same(a, b, rows)) {
        return fail(&t[1], "has rows at other times than ", t[0].path);
    }
    for (size_t k = rows; k < rows + count; ++k) {
        b[k] -= a[k];
    }
    const plot_curves made = {t[0].names[0], a, b + rows, rows, rows, 15};
    snprintf(p->spectra[0], sizeof p->spectra[0], "%s.difference.csv", p->base);
    errno = 0;
    if (!plot_write_curves(p, &made, p->spectra[0])) {
        complain("se3d plot: %s: cannot be written: %s\n", p->spectra[0], strerror(errno));
        return 0;
    }
    return 1;
}

int plot_subtract(plot *p)
{
    const size_t rows = p->tables[p->tables[1].rows < p->tables[0].rows].rows;
    const size_t size = (plot_count_curves(p) + 1) * rows;
    double *values = malloc(2 * size * sizeof *values);
    if (!values) {
        complain("se3d plot: out of memory\n");
        return 0;
    }
    const int good = write_difference(p, values, values + size, rows);
    free(values);
    if (!good) {
        return 0;
    }
    table_destroy(&p->tables[1]);
    p->file_count = 1;
    if (!plot_take_files(p, "difference")) {
        return 0;
    }
    p->x = p->tables[0].names[0];
    return 1;
}
