/* SPDX-License-Identifier: BSD-3-Clause */
/* Samples of a study on a page: what the measures are over all samples, how they go with the
 * parameters, and curves of each measure over each parameter. If the samples are a sweep or a
 * grid of few lines these are joined; else they are spots. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "io/write/svg.h"
#include "report.h"

enum { CHARTS_MAX = 120, ACROSS_MAX = 20, LINE_SIZE = 2000, NAME_SIZE = 120 };

/* Which columns are what: the number of the sample, parameters, measures, the status. */
typedef struct samples {
    FILE *page;
    sheet *s;
    size_t parameters;
    double *room; /* [rows] */
    size_t charts;
} samples;

static size_t count_measures(const samples *a)
{
    return a->s->t.count - 2 - a->parameters;
}

static void put_names(const samples *a, size_t from, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        fputs("<th>", a->page);
        se3di_svg_put(a->page, a->s->t.names[from + k]);
        fputs("</th>", a->page);
    }
}

static void begin_row(const samples *a, size_t column)
{
    fputs("<tr><td>", a->page);
    se3di_svg_put(a->page, a->s->t.names[column]);
    fputs("</td>", a->page);
}

/* ---- tables ----------------------------------------------------------------------------------*/

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Between the two values beside it. */
static double get_quantile(const double *sorted, size_t count, double share)
{
    const double at = share * (double)(count - 1);
    const size_t k = (size_t)at;
    const double rest = at - (double)k;
    return k + 1 < count ? sorted[k] + rest * (sorted[k + 1] - sorted[k]) : sorted[k];
}

static void put_statistics_row(const samples *a, size_t column)
{
    const double *y = sheet_get_column(a->s, column);
    double sum = 0.0;
    double square = 0.0;
    size_t count = 0;
    for (size_t i = 0; i < a->s->rows; ++i) {
        if (isfinite(y[i])) {
            a->room[count++] = y[i];
            sum += y[i];
        }
    }
    begin_row(a, column);
    fprintf(a->page, "<td>%zu</td>", count);
    const double mean = sum / (double)count;
    for (size_t i = 0; i < count; ++i) {
        square += (a->room[i] - mean) * (a->room[i] - mean);
    }
    report_put_number(a->page, mean);
    report_put_number(a->page, count > 1 ? sqrt(square / (double)(count - 1)) : (double)NAN);
    if (count > 0) {
        static const double shares[] = {0.0, 0.05, 0.5, 0.95, 1.0};
        qsort(a->room, count, sizeof *a->room, compare_numbers);
        for (size_t k = 0; k < sizeof shares / sizeof *shares; ++k) {
            report_put_number(a->page, get_quantile(a->room, count, shares[k]));
        }
    }
    fputs("</tr>\n", a->page);
}

static void put_statistics(const samples *a)
{
    fputs("<table><tr><th>of all samples</th><th>values</th><th>mean</th><th>deviation</th>"
          "<th>least</th><th>5 %</th><th>median</th><th>95 %</th><th>most</th></tr>\n",
          a->page);
    for (size_t k = 1; k + 1 < a->s->t.count; ++k) {
        put_statistics_row(a, k);
    }
    fputs("</table>\n", a->page);
}

/* Pearson's; NaN where one of them does not vary. */
static double get_correlation(const sheet *s, size_t one, size_t other)
{
    const double *x = sheet_get_column(s, one);
    const double *y = sheet_get_column(s, other);
    double mean[2] = {0.0, 0.0};
    double sum[3] = {0.0, 0.0, 0.0};
    size_t count = 0;
    for (size_t i = 0; i < s->rows; ++i) {
        if (isfinite(x[i]) && isfinite(y[i])) {
            mean[0] += x[i];
            mean[1] += y[i];
            ++count;
        }
    }
    for (size_t i = 0; i < s->rows; ++i) {
        if (isfinite(x[i]) && isfinite(y[i])) {
            const double a = x[i] - mean[0] / (double)count;
            const double b = y[i] - mean[1] / (double)count;
            sum[0] += a * a;
            sum[1] += b * b;
            sum[2] += a * b;
        }
    }
    return sum[0] > 0.0 && sum[1] > 0.0 ? sum[2] / sqrt(sum[0] * sum[1]) : (double)NAN;
}

static void put_correlations(const samples *a)
{
    if (a->parameters > ACROSS_MAX || a->s->rows < 3) {
        return;
    }
    fputs("<table><tr><th>correlation with</th>", a->page);
    put_names(a, 1, a->parameters);
    fputs("</tr>\n", a->page);
    for (size_t m = 0; m < count_measures(a); ++m) {
        begin_row(a, 1 + a->parameters + m);
        for (size_t p = 0; p < a->parameters; ++p) {
            const double r = get_correlation(a->s, 1 + a->parameters + m, 1 + p);
            fprintf(a->page, isfinite(r) ? "<td>%.2f</td>" : "<td></td>",
                    fabs(r) < 0.005 ? 0.0 : r);
        }
        fputs("</tr>\n", a->page);
    }
    fputs("</table>\n", a->page);
}

/* ---- curves ----------------------------------------------------------------------------------*/

/* Samples that differ in one parameter alone, as lines over it. */
typedef struct family {
    size_t first[CHART_CURVES_MAX]; /* row of each line */
    size_t count, length;           /* lines, and samples of each */
    double *x, *y;                  /* [length], [count][length] */
    char names[CHART_CURVES_MAX][NAME_SIZE];
} family;

static int is_same_line(const samples *a, size_t p, size_t i, size_t j)
{
    for (size_t k = 0; k < a->parameters; ++k) {
        const double *value = sheet_get_column(a->s, 1 + k);
        if (k != p && (value[i] < value[j] || value[i] > value[j])) {
            return 0;
        }
    }
    return 1;
}

/* The lines of the samples. @return false: they are too many, or of different lengths. */
static int find_lines(const samples *a, size_t p, family *f)
{
    size_t lengths[CHART_CURVES_MAX] = {0};
    f->count = 0;
    for (size_t i = 0; i < a->s->rows; ++i) {
        size_t k = 0;
        while (k < f->count && !is_same_line(a, p, f->first[k], i)) {
            ++k;
        }
        if (k == CHART_CURVES_MAX) {
            return 0;
        }
        if (k == f->count) {
            f->first[f->count++] = i;
        }
        ++lengths[k];
    }
    f->length = lengths[0];
    for (size_t k = 1; k < f->count; ++k) {
        if (lengths[k] != f->length) {
            return 0;
        }
    }
    return f->length > 1;
}

typedef struct spot {
    double x, y;
} spot;

static int compare_spots(const void *a, const void *b)
{
    return compare_numbers(&((const spot *)a)->x, &((const spot *)b)->x);
}

/* One line in ascending order. @return false: its x are not those of the first line */
static int take_line(const samples *a, size_t p, size_t column, family *f, size_t k, spot *spots)
{
    const double *x = sheet_get_column(a->s, 1 + p);
    const double *y = sheet_get_column(a->s, column);
    size_t count = 0;
    for (size_t i = 0; i < a->s->rows; ++i) {
        if (is_same_line(a, p, f->first[k], i)) {
            spots[count++] = (spot){x[i], y[i]};
        }
    }
    qsort(spots, count, sizeof *spots, compare_spots);
    for (size_t i = 0; i < count; ++i) {
        if (k > 0 && (spots[i].x < f->x[i] || spots[i].x > f->x[i])) {
            return 0;
        }
        f->x[i] = spots[i].x;
        f->y[k * f->length + i] = spots[i].y;
    }
    return 1;
}

/* "c = 8, k = 2", or the measure if there is one line. */
static void name_line(const samples *a, size_t p, size_t column, family *f, size_t k)
{
    char *name = f->names[k];
    size_t used = 0;
    name[0] = '\0';
    for (size_t i = 0; i < a->parameters; ++i) {
        const double value = sheet_get_column(a->s, 1 + i)[f->first[k]];
        if (i != p && f->count > 1 && used + 1 < NAME_SIZE) {
            used += (size_t)snprintf(name + used, NAME_SIZE - used, "%s%.30s = %.4g",
                                     used > 0 ? ", " : "", a->s->t.names[1 + i], value);
        }
    }
    if (!name[0]) {
        snprintf(name, NAME_SIZE, "%.100s", a->s->t.names[column]);
    }
}

/* The lines of a grid. @return false: there are none, or no memory */
static int take_family(const samples *a, size_t p, size_t column, family *f, chart *c)
{
    spot *spots = NULL;
    if (!find_lines(a, p, f)) {
        return 0;
    }
    spots = calloc(f->length, sizeof *spots);
    f->x = calloc(f->length, sizeof *f->x);
    f->y = calloc(f->length * f->count, sizeof *f->y);
    int good = spots && f->x && f->y;
    for (size_t k = 0; k < f->count && good; ++k) {
        good = take_line(a, p, column, f, k, spots);
        name_line(a, p, column, f, k);
        c->y[k] = f->y + k * f->length;
        c->names[k] = f->names[k];
    }
    free(spots);
    c->x = f->x;
    c->curves = f->count;
    c->count = f->length;
    return good;
}

static int put_curves(samples *a, size_t p, size_t column)
{
    family f = {.count = 0};
    chart c = {.x = NULL};
    snprintf(c.y_label, sizeof c.y_label, "%.150s", a->s->t.names[column]);
    snprintf(c.x_label, sizeof c.x_label, "%.150s", a->s->t.names[1 + p]);
    c.title = c.y_label;
    if (!take_family(a, p, column, &f, &c)) {
        c.x = sheet_get_column(a->s, 1 + p);
        c.y[0] = sheet_get_column(a->s, column);
        c.names[0] = a->s->t.names[column];
        c.curves = 1;
        c.count = a->s->rows;
        c.is_spots = 1;
    }
    const int good = report_put_chart(a->page, &c);
    free(f.x);
    free(f.y);
    ++a->charts;
    return good;
}

static int put_all_curves(samples *a, const char *x)
{
    const size_t asked = x ? table_find(&a->s->t, x) : 0;
    int good = 1;
    for (size_t m = 0; m < count_measures(a) && good; ++m) {
        for (size_t p = 0; p < a->parameters && good && a->charts < CHARTS_MAX; ++p) {
            if (asked == 0 || asked > a->parameters || asked == 1 + p) {
                good = put_curves(a, p, 1 + a->parameters + m);
            }
        }
    }
    return good;
}

/* ---- files -----------------------------------------------------------------------------------*/

/* "# se3d study 1, ..., 3 parameters, 70 samples" */
static size_t read_parameters(const char *remark)
{
    static const char word[] = " parameters,";
    const char *end = strstr(remark, word);
    while (end && end > remark && end[-1] >= '0' && end[-1] <= '9') {
        --end;
    }
    return end ? (size_t)strtoul(end, NULL, 10) : 0;
}

int report_put_samples(FILE *page, sheet *s, const char *x)
{
    samples a = {.page = page, .s = s, .parameters = read_parameters(s->t.remark)};
    report_put_tag(page, "p", s->t.remark + strspn(s->t.remark, "# "));
    if (a.parameters + 2 > s->t.count || s->rows == 0) {
        return 1; /* it is no such table */
    }
    a.room = calloc(s->rows, sizeof *a.room);
    if (!a.room) {
        return 0;
    }
    put_statistics(&a);
    put_correlations(&a);
    const int good = s->rows < 2 || put_all_curves(&a, x);
    free(a.room);
    return good;
}

/* A cell as it is, or with fewer digits. */
static void put_cell(FILE *page, const char *cell, const char *tag)
{
    char *end = NULL;
    const double value = strtod(cell, &end);
    fprintf(page, "<%s>", tag);
    if (cell[0] && *end == '\0' && isfinite(value)) {
        fprintf(page, "%.6g", value);
    } else {
        se3di_svg_put(page, cell);
    }
    fprintf(page, "</%s>", tag);
}

int report_put_cells(FILE *page, const char *path)
{
    char line[LINE_SIZE];
    const char *tag = "th";
    FILE *file = se3di_file_open(path);
    if (!file) {
        return 0;
    }
    fputs("<table>", page);
    while (fgets(line, sizeof line, file)) {
        line[strcspn(line, "\r\n")] = '\0';
        fputs("<tr>", page);
        for (char *at = line, *comma = line; comma; at = comma + 1) {
            comma = strchr(at, ',');
            if (comma) {
                *comma = '\0';
            }
            put_cell(page, at, tag);
        }
        fputs("</tr>\n", page);
        tag = "td";
    }
    fputs("</table>\n", page);
    fclose(file);
    return 1;
}
