/* SPDX-License-Identifier: BSD-3-Clause */
/* Failures, JSON and the progress bar. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "options.h"
#include "text.h"

#if defined(_WIN32)
#include <io.h>
static int is_terminal(void)
{
    return _isatty(2);
}
#else
#include <unistd.h>
static int is_terminal(void)
{
    return isatty(2);
}
#endif

void json_put_text(const char *text)
{
    text_put_json(stdout, text);
}

void json_put_number(double value)
{
    if (isfinite(value)) {
        printf("%.17g", value);
    } else {
        fputs("null", stdout);
    }
}

void put_count(uint64_t count, const char *one, const char *many, const char *after)
{
    printf("%" PRIu64 " %s%s", count, count == 1 ? one : many, after);
}

void report_failure(const options *o, const char *command, const char *message)
{
    fprintf(stderr, "%s%s%s\n", command, command[0] ? ": " : "", message);
    if (o->json) {
        fputs("{\"status\": \"error\", \"message\": ", stdout);
        json_put_text(message);
        fputs("}\n", stdout);
    }
}

void progress_begin(progress *p, int quiet, size_t count)
{
    p->active = !quiet && is_terminal();
    p->percent = -1;
    p->count = count;
}

int progress_show(void *ctx, size_t analysis, double time, double fraction)
{
    enum { WIDTH = 40 };
    progress *p = ctx;
    const int percent = (int)(100.0 * fraction);
    if (!p->active || percent == p->percent) {
        return 0;
    }
    p->percent = percent;
    fprintf(stderr, "\r%zu/%zu [", analysis + 1, p->count);
    for (int k = 0; k < WIDTH; ++k) {
        fputc(k * 100 < percent * WIDTH ? '#' : ' ', stderr);
    }
    fprintf(stderr, "] %3d %%  t = %-10.4g", percent, time);
    fflush(stderr);
    return 0;
}

void progress_clear(void)
{
    if (is_terminal()) {
        fprintf(stderr, "\r%75s\r", "");
    }
}

void progress_end(progress *p)
{
    if (p->active && p->percent >= 0) {
        progress_clear();
    }
}
