/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d study MODEL --sensitivities: derivatives of all measures, as a table and as a file. */
#include "study_derive.h"

#include "outcome.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "interrupt.h"
#include "study_jobs.h"
#include "text.h"

enum { PATH_SIZE = 4200 };

/* The derivatives of one study. */
typedef struct derivation {
    const options *o;
    se3d_study *study;
    size_t measures, parameters;
    double *values;               /* [measures] */
    double *at;                   /* [parameters] */
    double *derivatives, *errors; /* [parameters][measures] */
    size_t missing;               /* cells without a derivative */
    size_t jobs;                  /* processes */
    char path[PATH_SIZE];
    se3d_status status; /* of the last runs */
    se3d_model_error error;
} derivation;

static int fail(const derivation *d, const char *message)
{
    report_failure(d->o, "", message);
    return EXIT_FAILED;
}

static int is_over(void *ctx)
{
    (void)ctx;
    return interrupt_came();
}

static int goes_on(se3d_status status)
{
    return !SE3D_FAILED(status) || status == SE3D_ERR_NOT_FINITE;
}

static void show(const derivation *d, size_t index)
{
    if (!d->o->quiet && !d->o->json) {
        fprintf(stderr, "study: derivatives by %s, %zu of %zu\n",
                se3d_study_get_sensitivity_name(d->study, index), index + 1, d->parameters);
    }
}

static void derive_one(derivation *d, size_t index)
{
    const size_t at = index * d->measures;
    d->status = se3d_study_eval_sensitivity(d->study, index, &d->at[index], d->derivatives + at,
                                            d->errors + at, &d->error);
}

/* In a process of its own: the numbers go to a pipe. */
static int work(void *ctx, size_t index, FILE *to)
{
    derivation *d = ctx;
    const size_t at = index * d->measures;
    derive_one(d, index);
    return fwrite(&d->status, sizeof d->status, 1, to) == 1 &&
           fwrite(&d->error, sizeof d->error, 1, to) == 1 &&
           fwrite(&d->at[index], sizeof *d->at, 1, to) == 1 &&
           fwrite(d->derivatives + at, sizeof *d->derivatives, d->measures, to) == d->measures &&
           fwrite(d->errors + at, sizeof *d->errors, d->measures, to) == d->measures;
}

static int take(void *ctx, size_t index, FILE *from)
{
    derivation *d = ctx;
    const size_t at = index * d->measures;
    const int good =
        fread(&d->status, sizeof d->status, 1, from) == 1 &&
        fread(&d->error, sizeof d->error, 1, from) == 1 &&
        fread(&d->at[index], sizeof *d->at, 1, from) == 1 &&
        fread(d->derivatives + at, sizeof *d->derivatives, d->measures, from) == d->measures &&
        fread(d->errors + at, sizeof *d->errors, d->measures, from) == d->measures;
    if (good) {
        show(d, index);
    }
    return good && goes_on(d->status);
}

/* By each parameter, in this process or in several. @return false: *why says why not all. */
static int derive_all(derivation *d, const char **why)
{
    const study_tasks tasks = {d->parameters, work, take, d};
    if (d->jobs > 1 && d->parameters > 1) {
        return study_run_tasks(&tasks, d->jobs, why);
    }
    for (size_t k = 0; k < d->parameters && goes_on(d->status); ++k) {
        show(d, k);
        derive_one(d, k);
    }
    return 1;
}

static int compute(derivation *d)
{
    const char *why = "";
    d->status = se3d_study_eval_nominal(d->study, d->values, &d->error);
    if (goes_on(d->status) && !derive_all(d, &why) && goes_on(d->status)) {
        return fail(d, why[0] ? why : "ended by the user");
    }
    size_t valued = 0;
    for (size_t k = 0; k < d->measures; ++k) {
        valued += isfinite(d->values[k]) ? 1 : 0;
    }
    for (size_t k = 0; k < d->measures * d->parameters; ++k) {
        d->missing += isfinite(d->derivatives[k]) ? 0 : 1;
    }
    if (d->status == SE3D_ERR_NOT_FINITE && valued > 0) {
        return EXIT_DONE; /* the others have theirs */
    }
    return SE3D_FAILED(d->status) ? fail(d, d->error.message) : EXIT_DONE;
}

/* Say why cells are empty: what a measure without a value lacks, else where they are. */
static int fail_for_missing(const derivation *d)
{
    enum { NAMED_MAX = 8 };
    char text[NAMED_MAX * 200 + 60] = "";
    size_t used = 0;
    size_t named = 0;
    for (size_t k = 0; k < d->measures; ++k) {
        if (!isfinite(d->values[k])) {
            return fail(d, d->error.message);
        }
    }
    for (size_t k = 0; k < d->measures * d->parameters && named < NAMED_MAX; ++k) {
        const char *name = se3d_study_get_sensitivity_name(d->study, k / d->measures);
        if (!isfinite(d->derivatives[k])) {
            used += (size_t)snprintf(text + used, sizeof text - used,
                                     "%s `%.50s` by `%.50s` at %.50s = %.9g",
                                     named++ > 0 ? "; of" : "no derivative of",
                                     se3d_study_get_measure_name(d->study, k % d->measures), name,
                                     name, d->at[k / d->measures]);
        }
    }
    if (d->missing > named) {
        snprintf(text + used, sizeof text - used, "; and of %zu more", d->missing - named);
    }
    return fail(d, text);
}

/* A cell: empty if there is no number. */
static void put_cell(FILE *file, double value)
{
    if (isfinite(value)) {
        fprintf(file, ",%.17g", value);
    } else {
        fputc(',', file);
    }
}

/* By how many per cent a measure changes when the parameter does by one. */
static double get_relative(const derivation *d, size_t p, size_t m)
{
    const double value = d->values[m];
    return fabs(value) > 0.0 ? d->derivatives[p * d->measures + m] * d->at[p] / value : (double)NAN;
}

static void put_rows(const derivation *d, FILE *file)
{
    fputs("measure,parameter,measured,value,derivative,error,relative\n", file);
    for (size_t m = 0; m < d->measures; ++m) {
        for (size_t p = 0; p < d->parameters; ++p) {
            const size_t at = p * d->measures + m;
            fprintf(file, "%s,%s", se3d_study_get_measure_name(d->study, m),
                    se3d_study_get_sensitivity_name(d->study, p));
            put_cell(file, d->values[m]);
            put_cell(file, d->at[p]);
            put_cell(file, d->derivatives[at]);
            put_cell(file, d->errors[at]);
            put_cell(file, get_relative(d, p, m));
            fputc('\n', file);
        }
    }
}

static int write_rows(const derivation *d)
{
    char message[PATH_SIZE + 200];
    FILE *file = se3di_file_make_folders(d->path) ? se3di_partial_open(d->path) : NULL;
    if (file) {
        put_rows(d, file);
    }
    if (file && file_end(file, d->path, !ferror(file))) {
        return EXIT_DONE;
    }
    snprintf(message, sizeof message, "%s: cannot be written: %s", d->path, strerror(errno));
    return fail(d, message);
}

static void print_table(const derivation *d)
{
    printf("%-24s %-24s %16s %9s %9s\n", "measure", "parameter", "derivative", "+/-", "relative");
    for (size_t m = 0; m < d->measures; ++m) {
        for (size_t p = 0; p < d->parameters; ++p) {
            const size_t at = p * d->measures + m;
            printf("%-24s %-24s %16.9g %9.1g %9.3g\n", se3d_study_get_measure_name(d->study, m),
                   se3d_study_get_sensitivity_name(d->study, p), d->derivatives[at], d->errors[at],
                   get_relative(d, p, m));
        }
    }
}

static void print_end(const derivation *d)
{
    if (d->o->json) {
        outcome_tell();
        printf("{\"status\": \"%s\", \"file\": ", d->missing > 0 ? "failed" : "done");
        json_put_text(d->path);
        printf(", \"measures\": %zu, \"parameters\": %zu}\n", d->measures, d->parameters);
    } else if (!d->o->quiet) {
        print_table(d);
        fputs("wrote ", stdout);
        text_put_plain(stdout, d->path);
        fputc('\n', stdout);
    }
}

static int run(derivation *d)
{
    int code = compute(d);
    code = code == EXIT_DONE ? write_rows(d) : code;
    if (code == EXIT_DONE) {
        print_end(d);
    }
    if (code == EXIT_DONE && d->missing > 0) {
        return fail_for_missing(d);
    }
    return code;
}

int study_derive(const options *o, se3d_study *study, size_t jobs, const char *folder)
{
    derivation d = {.o = o,
                    .study = study,
                    .jobs = jobs,
                    .measures = se3d_study_count_measures(study),
                    .parameters = se3d_study_count_sensitivities(study)};
    const size_t cells = d.measures * d.parameters;
    double *memory = calloc(d.measures + d.parameters + 2 * cells + 1, sizeof *memory);
    int code = EXIT_FAILED;
    if (memory) {
        d.values = memory;
        d.at = memory + d.measures;
        d.derivatives = d.at + d.parameters;
        d.errors = d.derivatives + cells;
    }
    const int length = snprintf(d.path, sizeof d.path, "%s/sensitivities.csv", folder);
    if (!memory) {
        code = fail(&d, "out of memory");
    } else if (length < 0 || (size_t)length >= sizeof d.path) {
        code = fail(&d, "the path of the results is too long");
    } else {
        interrupt_begin();
        se3d_study_set_interrupt(study, is_over, NULL);
        code = run(&d);
    }
    free(memory);
    return code;
}
