/* SPDX-License-Identifier: BSD-3-Clause */
/* What the program says of its commands: one table for each, from which its help, its page of the
 * manual and the completion of shells are made, and by which its command line is read. */
#ifndef SE3D_TOOL_COMMAND_H
#define SE3D_TOOL_COMMAND_H

#include <stddef.h>
#include <stdio.h>

/* An option. Every command has --quiet, --json, --version and --help beside those of its table. */
typedef struct command_option {
    const char *name;  /* with its dashes; NULL ends a table */
    const char *alias; /* another name; NULL: none */
    const char *value; /* what follows it; NULL: nothing */
    const char *text;  /* what it does; "{methods}" and the like stand for the names of a list */
} command_option;

/* Options that several commands have in common. */
#define COMMAND_OPTION_SET                                                                         \
    {                                                                                              \
        "--set", NULL, "NAME=VALUE",                                                               \
            "replace a parameter, or anything by its path, as in bodies.bar.mass; VALUE is what "  \
            "the file could say there; may be repeated"                                            \
    }
#define COMMAND_OPTION_STRICT                                                                      \
    {                                                                                              \
        "--strict", NULL, NULL, "a model that is warned of has failed"                             \
    }
#define COMMAND_OPTIONS_OF_SOLVERS                                                                 \
    {"--formulation", NULL, "F", "{formulations}"}, {"--method", NULL, "M", "{methods}"},          \
        {"--step", NULL, "H", "step [s]"},                                                         \
        {"--tolerance", NULL, "E", "relative error of methods that control it"},                   \
    {                                                                                              \
        "--duration", NULL, "T", "duration [s]"                                                    \
    }

typedef struct command_example {
    const char *words; /* after "se3d "; NULL ends a table */
    const char *text;
} command_example;

typedef struct command_entry {
    const char *name;
    int (*run)(int count, char *const *words); /* the words after the name; the exit code */
    const char *operands;                      /* MODEL, DIR ... */
    const char *files;                         /* their endings, for completion: "yaml yml json" */
    const char *summary;                       /* a phrase */
    const char *text;                          /* paragraphs with an empty line between them */
    const command_option *options;
    const command_example *examples;
    const char *exits; /* what the exit codes mean */
    int prints;        /* 1: without -o it writes to standard output; COMMAND_PRINTS_GIVEN */
    int only_prints; /* 1: text for others (a script) to standard output, nothing else: no --json */
} command_entry;

enum { COMMAND_PRINTS_GIVEN = 2 }; /* with -o - it writes to standard output */

extern const command_entry new_entry, fmt_entry, channels_entry, run_entry, check_entry,
    evaluate_entry, plot_entry, report_entry, sketch_entry, view_entry, live_entry, video_entry,
    import_entry, write_entry, fmu_entry, study_entry, replay_entry, explain_entry,
    completion_entry, help_entry;

/* The k-th command, NULL behind the last. */
const command_entry *command_get(size_t k);
/* The command of a name, NULL: there is none. */
const command_entry *command_find(const char *name);
/* The option of a command that has this name, NULL: there is none. */
const command_option *command_find_option(const command_entry *c, const char *name);
/* The k-th option that a command has, those that all have behind its own; NULL behind the last. */
const command_option *command_get_option(const command_entry *c, size_t k);
/* The option of that name that all commands have, NULL: there is none. */
const command_option *command_find_common(const char *name);

/* command_help.c: the text of `se3d COMMAND --help`, and that of `se3d --help`. */
void command_print_help(const command_entry *c);
void command_print_overview(FILE *file);
/* The text of an option with the names of lists in the place of "{methods}" and the like. */
void command_expand(const char *text, char *out, size_t size);

/* manual.c: the pages se3d(1) and se3d-model(5). */
void manual_print_program(void);
void manual_print_model(void);

#endif
