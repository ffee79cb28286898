/* SPDX-License-Identifier: BSD-3-Clause */
/* Extremes are those of the rows. */
#include "io/write/summary.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/channel/channel.h"
#include "io/channel/rows.h"

se3di_summary *se3di_summary_create(se3di_iopool *pool, const se3di_output_entry *entry)
{
    se3di_summary *s = se3di_iopool_alloc(pool, sizeof *s);
    size_t count = 0;
    for (size_t k = 0; k < entry->count; ++k) {
        count += se3di_channel_get_width(&entry->channels[k]);
    }
    if (!s) {
        return NULL;
    }
    s->columns = se3di_iopool_array(pool, count + 1, sizeof *s->columns);
    s->last = se3di_iopool_array(pool, count + 1, sizeof *s->last);
    for (size_t k = 0; k < entry->count && s->columns && s->last; ++k) {
        const size_t width = se3di_channel_get_width(&entry->channels[k]);
        for (size_t i = 0; i < width; ++i) {
            char name[800];
            se3di_channel_format_column(&entry->channels[k], i, name, sizeof name);
            se3d_run_summary *column = &s->columns[s->count++];
            column->file = entry->file;
            column->channel = se3di_iopool_copy(pool, name, strlen(name));
            if (!column->channel) {
                return NULL;
            }
        }
    }
    return s->columns && s->last ? s : NULL;
}

static void add_value(se3d_run_summary *c, double time, double value, double last, double h)
{
    if (value < c->min) {
        c->min = value;
        c->min_time = time;
    }
    if (value > c->max) {
        c->max = value;
        c->max_time = time;
    }
    c->integral += se3di_rows_integral(h, last, value);
    c->rms += se3di_rows_squares(h, last, value); /* squares until the end */
}

void se3di_summary_add(se3di_summary *summary, double time, const double *values)
{
    const double h = summary->begun && time > summary->time ? time - summary->time : 0.0;
    for (size_t k = 0; k < summary->count; ++k) {
        se3d_run_summary *c = &summary->columns[k];
        if (!summary->begun) {
            c->min = c->max = c->mean = values[k];
            c->min_time = c->max_time = time;
            summary->last[k] = values[k];
        }
        add_value(c, time, values[k], summary->last[k], h);
        c->last = summary->last[k] = values[k];
    }
    summary->begun = true;
    summary->time = time;
    summary->span += h;
}

void se3di_summary_pack(se3di_summary *summary, se3di_coder *coder)
{
    size_t count = summary->count;
    se3di_code_size(coder, &count);
    coder->failed = coder->failed || count != summary->count;
    se3di_code_numbers(coder, summary->last, summary->count);
    se3di_code_numbers(coder, &summary->time, 1);
    se3di_code_numbers(coder, &summary->span, 1);
    se3di_pack_flag(coder, &summary->begun);
    for (size_t k = 0; k < summary->count; ++k) {
        se3d_run_summary *c = &summary->columns[k];
        double *const numbers[] = {&c->min,  &c->min_time, &c->max,      &c->max_time,
                                   &c->mean, &c->rms,      &c->integral, &c->last};
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
            se3di_code_numbers(coder, numbers[i], 1);
        }
    }
}

void se3di_summary_finish(se3di_summary *summary)
{
    for (size_t k = 0; k < summary->count; ++k) {
        se3d_run_summary *c = &summary->columns[k];
        const bool lasts = summary->span > 0.0;
        c->mean = lasts ? c->integral / summary->span : summary->last[k];
        c->rms = lasts ? sqrt(c->rms / summary->span) : fabs(summary->last[k]);
    }
}

const char *se3di_summary_get_column(size_t k)
{
    static const char *const names[SE3DI_SUMMARY_COLUMNS] = {
        "channel", "min", "min_time", "max", "max_time", "mean", "rms", "integral", "last"};
    return names[k];
}

void se3di_summary_write(const se3di_summary *summary, se3di_csv *csv)
{
    for (size_t k = 0; k < summary->count && summary->begun; ++k) {
        const se3d_run_summary *c = &summary->columns[k];
        const se3di_csv_cell cells[SE3DI_SUMMARY_COLUMNS] = {
            {c->channel, 0.0}, {NULL, c->min},      {NULL, c->min_time},
            {NULL, c->max},    {NULL, c->max_time}, {NULL, c->mean},
            {NULL, c->rms},    {NULL, c->integral}, {NULL, c->last}};
        se3di_csv_put_cells(csv, cells, SE3DI_SUMMARY_COLUMNS);
    }
}
