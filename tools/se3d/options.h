/* SPDX-License-Identifier: BSD-3-Clause */
/* The command line of the `se3d` program. */
#ifndef SE3D_TOOL_OPTIONS_H
#define SE3D_TOOL_OPTIONS_H

#include <stdint.h>

#include "command.h"
#include "se3d/io.h"

enum { EXIT_DONE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };
enum { SETTINGS_MAX = 256, CAPTIONS_MAX = 32 };

typedef struct options {
    const char *model;
    const char *directory; /* -o */
    const char *analysis;
    const char *formulation;
    const char *method;
    const char *step;
    const char *tolerance;
    const char *threads;
    const char *duration;
    const char *time;
    const char *speed;
    const char *view;
    const char *format;
    const char *fmi;
    const char *shard;
    const char *jobs;
    const char *checkpoint;
    const char *match;
    const char *kind;
    const char *port;
    const char *title;
    const char *hide;
    const char *with;
    const char *print;
    const char *captions[CAPTIONS_MAX];
    size_t caption_count;
    se3d_model_setting settings[SETTINGS_MAX];
    char names[SETTINGS_MAX][200];
    size_t setting_count;
    int quiet;
    int json;
    int json_lines;
    int csv;
    int check;
    int man;
    int partial;
    int merge_fixed;
    int free_base;
    int resume;
    int keep;
    int strict;
    int no_estimate;
    int merge;
    int server;
    int sensitivities;
    int optimize;
    int list;
    int unchecked;
    int version;
    int help; /* it was printed, or the version */
} options;

/* Read the words after the command by its table; with --help among them, print the command's help.
 * @return EXIT_DONE, or EXIT_USAGE after a message. */
int options_read(options *o, const command_entry *c, int count, char *const *words);

/* Take a word that is an option of all commands; *help becomes 1, or OPTIONS_VERSION. */
enum { OPTIONS_VERSION = 2 };
void options_take_common(const char *word, int *quiet, int *help);
/* Print the help of a command, or the version. */
void options_print_of(const command_entry *c, int version);

/* Not standard input. @return EXIT_DONE, or EXIT_USAGE after a message. */
int options_check_file(const options *o, const command_entry *c);
/* --json and another option, each of which asks for standard output. @return EXIT_USAGE */
int options_refuse_both(const command_entry *c, const char *name);
/* The model options that the command line asks for. */
se3d_model_options options_get_model(const options *o);

/* mistakes.c: all of standard input; free it. @return NULL: errno says why. */
char *options_read_input(size_t *length);
/* Read the model. @return EXIT_DONE, or EXIT_USAGE after its mistakes were shown. */
int options_read_model(const options *o, const se3d_model_options *how, se3d_model **model);

/* Tell at a terminal what to do next with the results in a folder. */
void report_next(const options *o, const char *folder);
/* Print a failure as text or, with --json, as an object. */
void report_failure(const options *o, const char *command, const char *message);
/* Say that a file cannot be written, and why: errno. @return EXIT_FAILED */
int report_unwritten(const options *o, const char *path);

/* Say that there is no such command, and which was probably meant. @return EXIT_USAGE */
int command_report_unknown(const char *name);

/* What `se3d plot` does with its words. */
int plot_files(int count, const char *const *words);
/* Run a model, results into results/<model>, and draw the plots it asks for. `csv`: where its first
 * results with channels are. @return the exit code, after a message if it failed. */
int run_for_plots(const char *model, int quiet, int draw, char *csv, size_t size);
/* The folder of results that `path` is; a model is run first, into results/<model>, which draws
 * nothing. @return the exit code, after a message if it failed. */
int run_for_view(const char *command, const char *path, int quiet, char *folder, size_t size);

/* Write a text as a JSON string, a number as JSON (null if it is not finite). */
void json_put_text(const char *text);
void json_put_number(double value);

/* Print "1 body" or "2 bodies"; `after` follows. */
void put_count(uint64_t count, const char *one, const char *many, const char *after);

/* How far a run is: a bar on standard error if that is a terminal, else a line every ten seconds.
 */
typedef struct progress {
    int is_quiet;
    int is_bar;
    int is_lines;    /* objects of JSON on standard output in place of them */
    int percent;     /* shown last; -1: none */
    size_t count;    /* of analyses */
    size_t analysis; /* the one at hand, from 0 */
    double time;     /* of the model [s] */
    double fraction; /* of the analysis */
    int64_t begun;   /* when the analysis was first heard of [s of the clock] */
    int64_t told;    /* the last line */
} progress;

void progress_begin(progress *p, int quiet, size_t count);
int progress_show(void *ctx, size_t analysis, double time, double fraction);
/* Nothing new, but it goes on. */
void progress_wait(progress *p);
void progress_end(progress *p);
/* Make its line free for a message. */
void progress_clear(void);

#endif
