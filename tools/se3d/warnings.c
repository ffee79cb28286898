/* SPDX-License-Identifier: BSD-3-Clause */
#include "warnings.h"
#include "outcome.h"

#include <stdio.h>
#include <string.h>

/* The report shows these, too, with more of them: as the outcome of an analysis or below it. */
static int is_reported(se3d_log_kind kind)
{
    return kind == SE3D_LOG_REDUNDANT || kind == SE3D_LOG_START || kind == SE3D_LOG_TOLERANCE;
}

/* Without the time at which it was said. */
static const char *sentence_of(const char *message)
{
    const char *after = strncmp(message, "t = ", 4) == 0 ? strstr(message, " s: ") : NULL;
    return after ? after : message;
}

static int is_known(const warnings *w, const char *message)
{
    for (size_t k = 0; k < w->count; ++k) {
        if (strcmp(sentence_of(w->text[k]), sentence_of(message)) == 0) {
            return 1;
        }
    }
    return 0;
}

void warnings_add(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    warnings *w = ctx;
    if (level != SE3D_LOG_WARNING || is_known(w, message)) {
        return; /* failures end the run, and are told then; the report has the rest */
    }
    if (w->count == WARNINGS_MAX) {
        ++w->more;
        return;
    }
    snprintf(w->text[w->count++], WARNING_SIZE, "%s", message);
    if (!w->o->quiet && !w->o->json && !is_reported(kind)) {
        progress_clear();
        if (kind == SE3D_LOG_MODEL) { /* it begins with its place */
            warn("warning: %s\n", message);
        } else {
            warn("%s: warning: %s\n", w->o->model, message);
        }
    }
}

void warnings_conclude(const warnings *w)
{
    if (w->more > 0 && !w->o->quiet && !w->o->json) {
        warn("%s: warning: %zu more warnings like these\n", w->o->model, w->more);
    }
}

const char *warnings_get_verdict(const warnings *w, char text[WARNING_SIZE])
{
    const size_t count = w->count + w->more;
    text[0] = '\0';
    if (w->o->strict && count > 0) {
        snprintf(text, WARNING_SIZE, "--strict: %zu warning%s, must be none", count,
                 count == 1 ? "" : "s");
    }
    return text;
}

int warnings_forbid(const warnings *w, int code)
{
    char text[WARNING_SIZE];
    if (code != EXIT_DONE || !*warnings_get_verdict(w, text)) {
        return code;
    }
    complain("%s: %s\n", w->o->model, text);
    return EXIT_FAILED;
}

void warnings_put_json(const warnings *w)
{
    fputs("\"warnings\": [", stdout);
    for (size_t k = 0; k < w->count; ++k) {
        fputs(k > 0 ? ", " : "", stdout);
        json_put_text(w->text[k]);
    }
    fputs("]", stdout);
}
