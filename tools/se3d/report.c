/* SPDX-License-Identifier: BSD-3-Clause */
/* Failures, JSON and the progress bar. */
#if !defined(_WIN32)
#define _POSIX_C_SOURCE 200809L
#endif

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "options.h"
#include "outcome.h"
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

enum { TELL_EVERY = 10 /* s */ };

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

void report_next(const options *o, const char *folder)
{
    if (!o->quiet && !o->json && is_terminal()) {
        fflush(stdout);
        fprintf(stderr, "%snext:%s se3d view ", colour_get(COLOUR_NEXT), colour_get(COLOUR_NONE));
        text_put_plain(stderr, folder);
        fputs("\n", stderr);
    }
}

void report_failure(const options *o, const char *command, const char *message)
{
    complain("%s%s%s\n", command, command[0] ? ": " : "", message);
    if (o->json) {
        outcome_tell();
        char text[2000];
        snprintf(text, sizeof text, "%s%s%s", command, command[0] ? ": " : "", message);
        fputs("{\"status\": \"error\", \"message\": ", stdout);
        json_put_text(text);
        fputs("}\n", stdout);
    }
}

int report_unwritten(const options *o, const char *path)
{
    char text[200];
    snprintf(text, sizeof text, "cannot be written: %.150s", strerror(errno));
    report_failure(o, path, text);
    return EXIT_FAILED;
}

void progress_begin(progress *p, int quiet, size_t count)
{
    const int64_t now = (int64_t)time(NULL);
    *p = (progress){.is_quiet = quiet,
                    .is_bar = !quiet && is_terminal(),
                    .percent = -1,
                    .count = count,
                    .begun = now,
                    .told = now};
}

static void show_bar(progress *p)
{
    enum { WIDTH = 40 };
    const int percent = (int)(100.0 * p->fraction);
    if (percent == p->percent) {
        return;
    }
    p->percent = percent;
    fprintf(stderr, "\r%zu/%zu [", p->analysis + 1, p->count);
    for (int k = 0; k < WIDTH; ++k) {
        fputc(k * 100 < percent * WIDTH ? '#' : ' ', stderr);
    }
    fprintf(stderr, "] %3d %%  t = %-10.4g", percent, p->time);
    fflush(stderr);
}

/* {"analysis": 0, "time": 1.25, "fraction": 0.34}, once a percent. */
static void put_line(progress *p)
{
    const int percent = (int)(100.0 * p->fraction);
    if (percent == p->percent) {
        return;
    }
    p->percent = percent;
    printf("{\"analysis\": %zu, \"time\": ", p->analysis);
    json_put_number(p->time);
    printf(", \"fraction\": ");
    json_put_number(p->fraction);
    fputs("}\n", stdout);
    fflush(stdout);
}

/* "1/2: 34 %, t = 1.25 s, about 50 s left" */
static void tell(progress *p)
{
    const int64_t now = (int64_t)time(NULL);
    const double passed = (double)(now - p->begun);
    if (now - p->told < TELL_EVERY && now >= p->told) {
        return;
    }
    p->told = now;
    fprintf(stderr, "%zu/%zu: %.0f %%, t = %.4g s", p->analysis + 1, p->count, 100.0 * p->fraction,
            p->time);
    if (p->fraction > 0.0 && passed >= 1.0) {
        const double left = passed * (1.0 - p->fraction) / p->fraction;
        fprintf(stderr, left < 120.0 ? ", about %.0f s left" : ", about %.0f min left",
                left < 120.0 ? left : left / 60.0);
    }
    fputc('\n', stderr);
    fflush(stderr);
}

int progress_show(void *ctx, size_t analysis, double time_now, double fraction)
{
    progress *p = ctx;
    if (analysis != p->analysis) {
        p->begun = (int64_t)time(NULL);
    }
    p->analysis = analysis;
    p->time = time_now;
    p->fraction = fraction;
    if (p->is_lines) {
        put_line(p);
    } else if (p->is_bar) {
        show_bar(p);
    } else {
        progress_wait(p);
    }
    return 0;
}

void progress_wait(progress *p)
{
    if (!p->is_quiet && !p->is_bar) {
        tell(p);
    }
}

void progress_clear(void)
{
    if (is_terminal()) {
        fprintf(stderr, "\r%75s\r", "");
    }
}

void progress_end(progress *p)
{
    if (p->is_bar && p->percent >= 0) {
        progress_clear();
    }
}
