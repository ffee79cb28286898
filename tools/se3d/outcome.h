/* SPDX-License-Identifier: BSD-3-Clause */
/* What a command says of its end: messages on standard error, with colours on a terminal, files
 * that it wrote, and with --json all of it as one object on standard output. */
#ifndef SE3D_TOOL_OUTCOME_H
#define SE3D_TOOL_OUTCOME_H

#include <stdio.h>

/* Print a message, or several, of which each ends with "\n". What may not be shown of texts in them
 * is '?'. A place ("file:3:7:") or name before the first ": " stands out. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void
complain(const char *format, ...);
/* How many there were. */
size_t outcome_count_complaints(void);
/* The same of what is no failure; `warning:` in it stands out. It is not a part of the outcome. */
#if defined(__GNUC__)
__attribute__((format(printf, 1, 2)))
#endif
void
warn(const char *format, ...);

/* A file was written: "wrote PATH" unless `quiet`. @return whether it was said, so that more may
 * follow; `end` follows it */
int outcome_add_file(const char *path, int quiet, const char *end);

/* With --json: the object is printed by the command itself, or at the end. */
void outcome_want_json(void);
int outcome_wants_json(void);
/* The command has printed it. */
void outcome_tell(void);
/* Print it, if it is wanted and was not yet. */
void outcome_end(const char *command, int code);

/* What stands out on standard error: "" where that is no terminal, NO_COLOR is set, or TERM names
 * none that has colours. */
typedef enum colour { COLOUR_NONE, COLOUR_ERROR, COLOUR_WARNING, COLOUR_MARK, COLOUR_NEXT } colour;
const char *colour_get(colour which);

#endif
