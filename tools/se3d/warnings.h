/* SPDX-License-Identifier: BSD-3-Clause */
/* What the library warns of while a model runs: shown at once, each once, and kept for the JSON
 * report. */
#ifndef SE3D_TOOL_WARNINGS_H
#define SE3D_TOOL_WARNINGS_H

#include "options.h"

enum { WARNINGS_MAX = 40, WARNING_SIZE = 520 };

typedef struct warnings {
    const options *o;
    size_t count;
    size_t more; /* that found no room */
    char text[WARNINGS_MAX][WARNING_SIZE];
} warnings;

/* A se3d_log_callback; ctx: the warnings. */
void warnings_add(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message);
/* After the run, how many were not shown. */
void warnings_conclude(const warnings *w);
/* What --strict says of them, without the name of the model: "" if there is nothing to say.
 * @return text */
const char *warnings_get_verdict(const warnings *w, char text[WARNING_SIZE]);
/* With --strict, a command that would end well fails if anything was warned of, after a message.
 * @return the exit code */
int warnings_forbid(const warnings *w, int code);
/* "warnings": [...] */
void warnings_put_json(const warnings *w);

#endif
