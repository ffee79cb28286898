/* SPDX-License-Identifier: BSD-3-Clause */
/* Bode plots: a file of transfer functions (`frequency`, then pairs <name>.real, <name>.imag) as
 * gain in decibels, 20 log10 |G|, and phase in degrees, without its jumps of 360. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "outcome.h"
#include "plot.h"

static const double pi = 3.14159265358979323846;

/* Length of a column's name before this ending; 0: it has another one. */
static size_t get_stem(const char *name, const char *ending)
{
    const size_t length = strlen(name), tail = strlen(ending);
    return length > tail && strcmp(name + length - tail, ending) == 0 ? length - tail : 0;
}

/* Whether all columns but the first are pairs. */
static int is_transfer(const table *t)
{
    if (strcmp(t->names[0], "frequency") != 0 || t->count < 3 || t->count % 2 == 0) {
        return 0;
    }
    for (size_t k = 1; k < t->count; k += 2) {
        const size_t stem = get_stem(t->names[k], ".real");
        if (stem == 0 || get_stem(t->names[k + 1], ".imag") != stem ||
            strncmp(t->names[k], t->names[k + 1], stem) != 0) {
            return 0;
        }
    }
    return 1;
}

/* Whether the user has named columns of the file as it is. */
static int is_asked(const plot *p, const table *t)
{
    for (size_t c = 0; c < p->channel_count; ++c) {
        if (table_find(t, p->channels[c]) < t->count) {
            return 1;
        }
    }
    return p->x != NULL && strcmp(p->x, "frequency") != 0;
}

/* In place: pairs become gain [dB] and phase [degrees]. */
static void convert(double *values, size_t rows, size_t count)
{
    for (size_t k = 1; k < count; k += 2) {
        double before = 0.0;
        for (size_t row = 0; row < rows; ++row) {
            double *at = values + row * count + k;
            const double size = hypot(at[0], at[1]);
            double phase = atan2(at[1], at[0]) * 180.0 / pi;
            if (row > 0 && isfinite(before)) {
                phase -= 360.0 * round((phase - before) / 360.0);
            }
            at[0] = size > 0.0 ? 20.0 * log10(size) : (double)NAN;
            at[1] = before = phase;
        }
    }
}

static int write_table(const table *t, const char *path, const double *values, size_t rows)
{
    FILE *file = se3di_partial_open(path);
    if (!file) {
        return 0;
    }
    fputs("frequency", file);
    for (size_t k = 1; k < t->count; ++k) {
        const int is_gain = k % 2 == 1;
        const size_t stem = get_stem(t->names[k], is_gain ? ".real" : ".imag");
        fprintf(file, ",%.*s%s", (int)stem, t->names[k], is_gain ? ".gain" : ".phase");
    }
    for (size_t row = 0; row < rows; ++row) {
        for (size_t k = 0; k < t->count; ++k) {
            fprintf(file, k == 0 ? "\n%.9g" : ",%.9g", values[row * t->count + k]);
        }
    }
    fputc('\n', file);
    return file_end(file, path, 1);
}

/* One file; `path` keeps where its gains and phases are. */
static int convert_table(plot *p, size_t k, char *path, size_t size)
{
    table *t = &p->tables[k];
    table made;
    snprintf(path, size, k == 0 ? "%s.bode.csv" : "%s.%zu.bode.csv", p->base, k + 1);
    double *values = malloc((t->rows + 1) * t->count * sizeof *values);
    const size_t rows = values ? table_read_rows(t, 1, values, t->rows + 1) : 0;
    errno = 0;
    if (values) {
        convert(values, rows, t->count);
    }
    const int good = values && write_table(t, path, values, rows);
    free(values);
    if (!good) {
        complain("se3d plot: %s: cannot be written: %s\n", path, strerror(errno ? errno : ENOMEM));
        return 0;
    }
    if (!table_read(&made, "plot", path)) {
        return 0;
    }
    table_destroy(t);
    *t = made;
    return 1;
}

int plot_make_bode(plot *p)
{
    if (p->fft || p->difference) {
        return 1; /* which are of the columns as they are */
    }
    for (size_t k = 0; k < p->file_count; ++k) {
        if (!is_transfer(&p->tables[k]) || is_asked(p, &p->tables[k])) {
            return 1;
        }
    }
    for (size_t k = 0; k < p->file_count; ++k) {
        if (!convert_table(p, k, p->spectra[k], sizeof p->spectra[k])) {
            return 0;
        }
    }
    p->bode = 1;
    return 1;
}
