/* SPDX-License-Identifier: BSD-3-Clause */
/* Amplitude spectra: a column is taken at equal steps of time (linear in between), without its
 * mean, under a Hann window, and transformed; a sine of amplitude a gives a peak of height a. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "outcome.h"
#include "plot.h"

enum { SAMPLES_MAX = 1 << 18 };

static const double pi = 3.14159265358979323846;

/* Radix-2 transform in place, n a power of two. */
static void transform(double *re, double *im, size_t n)
{
    for (size_t i = 1, j = 0; i < n; ++i) {
        size_t bit = n >> 1;
        for (; j & bit; bit >>= 1) {
            j ^= bit;
        }
        j ^= bit;
        if (i < j) {
            const double a = re[i];
            const double b = im[i];
            re[i] = re[j];
            im[i] = im[j];
            re[j] = a;
            im[j] = b;
        }
    }
    for (size_t half = 1; half < n; half *= 2) {
        for (size_t k = 0; k < half; ++k) {
            const double c = cos(pi * (double)k / (double)half);
            const double s = -sin(pi * (double)k / (double)half);
            for (size_t i = k; i < n; i += 2 * half) {
                const size_t j = i + half;
                const double a = re[j] * c - im[j] * s;
                const double b = re[j] * s + im[j] * c;
                re[j] = re[i] - a;
                im[j] = im[i] - b;
                re[i] += a;
                im[i] += b;
            }
        }
    }
}

/* `n` values at equal steps of time from `rows` values at times that do not decrease. */
static void resample(const double *time, const double *value, size_t rows, double *out, size_t n)
{
    const double step = (time[rows - 1] - time[0]) / (double)(n - 1);
    size_t k = 0;
    for (size_t i = 0; i < n; ++i) {
        const double at = time[0] + step * (double)i;
        while (k + 2 < rows && time[k + 1] <= at) {
            ++k;
        }
        const double width = time[k + 1] - time[k];
        const double part = width > 0.0 ? (at - time[k]) / width : 0.0;
        out[i] = value[k] + part * (value[k + 1] - value[k]);
    }
}

static void get_amplitudes(double *re, double *im, size_t n)
{
    double mean = 0.0;
    for (size_t i = 0; i < n; ++i) {
        mean += re[i] / (double)n;
    }
    for (size_t i = 0; i < n; ++i) {
        re[i] = (re[i] - mean) * (0.5 - 0.5 * cos(2.0 * pi * (double)i / (double)n));
        im[i] = 0.0;
    }
    transform(re, im, n);
    for (size_t i = 0; i < n / 2; ++i) {
        re[i] = 4.0 * sqrt(re[i] * re[i] + im[i] * im[i]) / (double)n; /* Hann halves the mean */
    }
}

size_t plot_count_curves(const plot *p)
{
    size_t count = 0;
    for (size_t k = 0; k < p->panel_count; ++k) {
        count += p->panels[k].count;
    }
    return count;
}

/* values[curve * n + i]: amplitude at frequency i / duration. */
static int compute(const plot *p, const table *t, double *values, size_t n, double *duration)
{
    const size_t room = t->rows;
    double *work = malloc((2 * room + n) * sizeof *work);
    size_t curve = 0;
    int good = work != NULL;
    const size_t rows = good ? table_read_column(t, 0, 1, work, room) : 0;
    *duration = good && rows > 2 ? work[rows - 1] - work[0] : 0.0;
    good = good && *duration > 0.0;
    for (size_t k = 0; k < p->panel_count && good; ++k) {
        for (size_t i = 0; i < p->panels[k].count; ++i, ++curve) {
            const size_t column = table_find(t, p->panels[k].names[i]);
            double *out = values + curve * n;
            memset(out, 0, n * sizeof *out);
            if (column < t->count && table_read_column(t, column, 1, work + room, room) == rows) {
                resample(work, work + room, rows, out, n);
                get_amplitudes(out, work + 2 * room, n);
            }
        }
    }
    free(work);
    return good;
}

int plot_write_curves(const plot *p, const plot_curves *c, const char *path)
{
    const size_t curves = plot_count_curves(p);
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return 0;
    }
    fputs(c->first_name, file);
    for (size_t k = 0; k < p->panel_count; ++k) {
        for (size_t i = 0; i < p->panels[k].count; ++i) {
            fprintf(file, ",%s", p->panels[k].names[i]);
        }
    }
    fputc('\n', file);
    for (size_t i = 0; i < c->rows; ++i) {
        fprintf(file, "%.*g", c->digits, c->first[i]);
        for (size_t k = 0; k < curves; ++k) {
            fprintf(file, ",%.*g", c->digits, c->values[k * c->stride + i]);
        }
        fputc('\n', file);
    }
    return file_end(file, path, 1);
}

/* One file; `names` keeps the path of the spectrum. */
static int transform_table(plot *p, size_t k, char *path, size_t size)
{
    table *t = &p->tables[k];
    double duration = 0.0;
    size_t n = 4;
    while (n < t->rows && n < SAMPLES_MAX) {
        n *= 2;
    }
    snprintf(path, size, k == 0 ? "%s.fft.csv" : "%s.%zu.fft.csv", p->base, k + 1);
    const size_t curves = plot_count_curves(p);
    double *values = malloc((curves + 1) * n * sizeof *values); /* frequencies are the last */
    const int good = values && compute(p, t, values, n, &duration);
    for (size_t i = 0; good && i < n / 2; ++i) {
        values[curves * n + i] = (double)i * (double)(n - 1) / (double)n / duration;
    }
    const plot_curves made = {
        "frequency", values ? values + curves * n : NULL, values, n, n / 2, 9};
    errno = 0;
    if (!good || !plot_write_curves(p, &made, path)) {
        complain("se3d plot: %s: %s\n", good ? path : t->path,
                 good     ? strerror(errno)
                 : values ? "a spectrum needs at least three rows of increasing time"
                          : "out of memory");
        free(values);
        return 0;
    }
    free(values);
    t->rows = n / 2;
    return 1;
}

/* The names of the curves: the columns of the spectrum, in the order in which they were written. */
static int take_names(plot *p, const table *spectrum)
{
    size_t column = 1;
    if (spectrum->count != plot_count_curves(p) + 1) {
        return 0;
    }
    for (size_t k = 0; k < p->panel_count; ++k) {
        for (size_t c = 0; c < p->panels[k].count; ++c) {
            p->panels[k].names[c] = spectrum->names[column++];
        }
    }
    return 1;
}

int plot_take_files(plot *p, const char *what)
{
    for (size_t k = 0; k < p->panel_count; ++k) {
        char rest[160];
        snprintf(rest, sizeof rest, "%s", p->panels[k].title);
        snprintf(p->panels[k].title, sizeof p->panels[k].title, "%.15s of %.140s", what, rest);
    }
    for (size_t k = 0; k < p->file_count; ++k) {
        table spectrum;
        if (!table_read(&spectrum, "plot", p->spectra[k])) {
            return 0;
        }
        if (k == 0 && !take_names(p, &spectrum)) {
            complain("se3d plot: %s: was changed by another program\n", p->spectra[k]);
            table_destroy(&spectrum);
            return 0;
        }
        table_destroy(&p->tables[k]);
        p->tables[k] = spectrum;
    }
    return 1;
}

/* The tables keep the names of their columns; their files and orders of columns are replaced. */
int plot_transform(plot *p)
{
    for (size_t k = 0; k < p->file_count; ++k) {
        if (!transform_table(p, k, p->spectra[k], sizeof p->spectra[k])) {
            return 0;
        }
    }
    if (!plot_take_files(p, "amplitude")) {
        return 0;
    }
    p->x = "frequency";
    strcpy(p->x_title, "frequency [Hz]");
    return 1;
}
