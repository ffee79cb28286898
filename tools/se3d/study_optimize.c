/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d study MODEL --optimize. The methods see parameters that go from 0 to 1, and an aim and
 * limits that are about 1 in size; what is written is in the units of the study. */
#include "study_optimize.h"

#include "outcome.h"

#include <stdio.h>

#if !defined(SE3D_HAS_NLOPT)

int study_optimize(const options *o, se3d_study *study, size_t jobs, const char *folder)
{
    (void)study;
    (void)jobs;
    (void)folder;
    report_failure(o, "",
                   "this se3d was built without NLopt, whose methods `optimize` takes (Debian: "
                   "libnlopt-dev)");
    return EXIT_FAILED;
}

#else

#include <errno.h>
#include <float.h>
#include <math.h>
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "interrupt.h"
#include "io/study/derive.h"
#include "study_jobs.h"
#include "text.h"

enum { PATH_SIZE = 4200, VALUE_SIZE = 120 };
#define FEASIBLE   1e-6 /* of the size of a limit: it holds */
#define FIRST_STEP 0.1  /* of from ... to */

/* One side of a limit, or an equality. */
typedef struct side {
    struct search *search;
    size_t measure;
    double sign, bound, size; /* sign (measure - bound) / size <= 0, or = 0 */
} side;

/* What was found at one point. */
typedef struct found {
    double *values, *measures; /* of the parameters, and there */
    double aim, violation;     /* aim: least is best; HUGE_VAL: the run failed */
    uint64_t evaluation;
} found;

/* How the run of a process has ended. */
typedef struct reply {
    se3d_status status;
    se3d_model_error error;
} reply;

typedef struct search {
    const options *o;
    se3d_study *study;
    se3d_study_goal goal;
    size_t unknowns, measures, side_count;
    size_t parts; /* of the parameters, each for a process; at most 1: this one takes all */
    double *from, *width;
    double *derivatives; /* [unknowns][measures] at the present point */
    double *point;       /* in 0 ... 1, of what is known */
    int has_point, has_derivatives;
    found now, best, first;
    double size;          /* of the aim */
    double worst, better; /* aims so far */
    side *sides;
    size_t equal_count; /* the first ones of `sides` */
    uint64_t evaluations;
    FILE *file;
    nlopt_opt opt;
    char path[PATH_SIZE];
    se3d_model_error error; /* of the first run */
    se3d_status status;     /* that ended the search */
    reply told;             /* by the processes: the first failure, if there is one */
    char missing[400];      /* a derivative, which ended it */
} search;

static int fail(const search *s, const char *message)
{
    report_failure(s->o, "", message);
    return EXIT_FAILED;
}

static int is_over(void *ctx)
{
    (void)ctx;
    return interrupt_came();
}

/* ---- one point -------------------------------------------------------------------------------*/

/* How much of its size the worst limit is passed by. */
static double get_violation(const search *s, const double *measures)
{
    double most = 0.0;
    for (size_t k = 0; k < s->side_count; ++k) {
        const side *limit = &s->sides[k];
        const double over = limit->sign * (measures[limit->measure] - limit->bound) / limit->size;
        most = fmax(most, k < s->equal_count ? fabs(over) : over);
        most = isfinite(over) ? most : HUGE_VAL;
    }
    return most;
}

static void put_row(search *s, const char *reason)
{
    fprintf(s->file, "%llu", (unsigned long long)s->evaluations);
    for (size_t k = 0; k < s->unknowns; ++k) {
        fprintf(s->file, ",%.17g", s->now.values[k]);
    }
    for (size_t k = 0; k < s->measures; ++k) {
        fprintf(s->file, isfinite(s->now.measures[k]) ? ",%.17g" : ",", s->now.measures[k]);
    }
    fprintf(s->file, isfinite(s->now.violation) ? ",%.6g," : ",,", s->now.violation);
    if (reason[0]) {
        fputc('"', s->file);
        for (const char *c = reason; *c; ++c) {
            fprintf(s->file, *c == '"' ? "\"\"" : "%c", (unsigned char)*c < 0x20 ? ' ' : *c);
        }
        fputs("\"\n", s->file);
    } else {
        fputs("ok\n", s->file);
    }
}

static void keep(found *to, const found *from, size_t unknowns, size_t measures)
{
    memcpy(to->values, from->values, unknowns * sizeof *to->values);
    memcpy(to->measures, from->measures, measures * sizeof *to->measures);
    to->aim = from->aim;
    to->violation = from->violation;
    to->evaluation = from->evaluation;
}

static int is_better(const found *a, const found *b)
{
    const int a_holds = a->violation <= FEASIBLE;
    const int b_holds = b->violation <= FEASIBLE;
    if (a_holds && b_holds) {
        return a->aim < b->aim;
    }
    return a_holds != b_holds ? a_holds : a->violation < b->violation;
}

static void show(const search *s)
{
    if (s->o->quiet || s->o->json) {
        return;
    }
    fprintf(stderr, "study: evaluation %llu: %s = %.9g", (unsigned long long)s->evaluations,
            se3d_study_get_measure_name(s->study, s->goal.measure),
            s->now.measures[s->goal.measure]);
    fputs(s->now.violation <= FEASIBLE ? "\n" : ", beyond limits\n", stderr);
}

/* Take a point that was run. */
static void record(search *s, const char *reason)
{
    const double aim = s->now.measures[s->goal.measure];
    const int has_aim = isfinite(aim);
    s->now.evaluation = s->evaluations;
    s->now.violation = get_violation(s, s->now.measures);
    s->now.aim = !has_aim ? HUGE_VAL : s->goal.maximizes ? -aim : aim;
    put_row(s, reason);
    if (has_aim) {
        s->worst = fmax(s->worst, s->now.aim);
        s->better = fmin(s->better, s->now.aim);
    }
    if (has_aim && isfinite(s->now.violation) &&
        (s->best.evaluation == 0 || is_better(&s->now, &s->best))) {
        keep(&s->best, &s->now, s->unknowns, s->measures);
        show(s);
    }
}

static void end(search *s, se3d_status status)
{
    s->status = status;
    nlopt_force_stop(s->opt);
}

/* The parameters that one of several processes has. */
static se3di_study_part get_part(const search *s, size_t index)
{
    const size_t first = index * s->unknowns / s->parts;
    const se3di_study_part part = {first, (index + 1) * s->unknowns / s->parts - first};
    return part;
}

/* The measures, and the derivatives by a part of the parameters, in a process of its own: one run
 * for all of the part, if models can follow it. */
static int work(void *ctx, size_t index, FILE *to)
{
    search *s = ctx;
    const se3di_study_part part = get_part(s, index);
    double *slopes = s->derivatives + part.first * s->measures;
    reply r;
    memset(&r, 0, sizeof r);
    r.status =
        se3di_study_eval_part(s->study, part, s->now.values, s->now.measures, slopes, &r.error);
    return fwrite(&r, sizeof r, 1, to) == 1 &&
           fwrite(s->now.measures, sizeof *slopes, s->measures, to) == s->measures &&
           fwrite(slopes, sizeof *slopes, part.count * s->measures, to) == part.count * s->measures;
}

/* All processes tell the same measures. */
static int take(void *ctx, size_t index, FILE *from)
{
    search *s = ctx;
    const se3di_study_part part = get_part(s, index);
    const size_t count = part.count * s->measures;
    double *slopes = s->derivatives + part.first * s->measures;
    reply r;
    if (fread(&r, sizeof r, 1, from) != 1 ||
        fread(s->now.measures, sizeof *slopes, s->measures, from) != s->measures ||
        fread(slopes, sizeof *slopes, count, from) != count) {
        return 0;
    }
    if (s->told.status >= 0) {
        s->told = r;
    }
    return r.status != SE3D_ERR_NO_MEMORY && r.status != SE3D_ERR_INTERRUPTED;
}

/* The measures at s->now.values, and the derivatives if they are wanted. */
static se3d_status eval_now(search *s, int with_derivatives, se3d_model_error *error)
{
    const study_tasks tasks = {s->parts, work, take, s};
    const char *why = "";
    if (!with_derivatives || s->parts < 2) {
        return se3d_study_eval_unknowns(s->study, s->now.values, s->now.measures,
                                        with_derivatives ? s->derivatives : NULL, error);
    }
    memset(&s->told, 0, sizeof s->told);
    if (!study_run_tasks(&tasks, s->parts, &why) && s->told.status != SE3D_ERR_NO_MEMORY) {
        snprintf(s->missing, sizeof s->missing, "%s", why); /* a process has ended, by itself */
        return SE3D_ERR_INTERRUPTED;
    }
    *error = s->told.error;
    return s->told.status;
}

/* Run the model at a point, unless that was the last one. */
static void go_to(search *s, const double *u, int with_derivatives)
{
    se3d_model_error error = {.message = ""};
    const int same = s->has_point && memcmp(u, s->point, s->unknowns * sizeof *u) == 0;
    if (same && (s->has_derivatives || !with_derivatives)) {
        return;
    }
    memcpy(s->point, u, s->unknowns * sizeof *u);
    for (size_t k = 0; k < s->unknowns; ++k) {
        s->now.values[k] = s->from[k] + fmin(fmax(u[k], 0.0), 1.0) * s->width[k];
    }
    const se3d_status status = eval_now(s, with_derivatives, &error);
    s->has_point = 1;
    s->has_derivatives = with_derivatives;
    if (status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED || interrupt_came()) {
        end(s, status == SE3D_ERR_NO_MEMORY ? status : SE3D_ERR_INTERRUPTED);
        return;
    }
    if (!same) {
        ++s->evaluations;
        record(s, SE3D_FAILED(status) ? error.message : "");
    }
}

/* A method would take a derivative that is not there as 0, and the present point as the best. */
static void end_without_derivative(search *s, size_t measure, size_t unknown)
{
    char value[VALUE_SIZE];
    const char *name = se3d_study_get_unknown_name(s->study, unknown);
    se3d_study_write_unknown(s->study, unknown, s->now.values[unknown], value, sizeof value);
    snprintf(s->missing, sizeof s->missing, "no derivative of `%.60s` by `%.60s` at %.60s = %s",
             se3d_study_get_measure_name(s->study, measure), name, name, value);
    end(s, SE3D_ERR_NOT_FINITE);
}

/* d measure / d u; 0 where the measure has no value: no method goes on from there. */
static void put_gradient(search *s, size_t measure, double factor, double *gradient)
{
    const int has_value = isfinite(s->now.measures[measure]);
    for (size_t k = 0; k < s->unknowns; ++k) {
        const double slope = s->derivatives[k * s->measures + measure] * s->width[k] * factor;
        gradient[k] = isfinite(slope) ? slope : 0.0;
        if (has_value && !isfinite(slope) && s->status >= 0) {
            end_without_derivative(s, measure, k);
        }
    }
}

static double get_aim(unsigned count, const double *u, double *gradient, void *ctx)
{
    search *s = ctx;
    (void)count;
    go_to(s, u, gradient != NULL);
    if (gradient) {
        put_gradient(s, s->goal.measure, (s->goal.maximizes ? -1.0 : 1.0) / s->size, gradient);
    }
    /* a run that failed is worse than all that did not */
    return (isfinite(s->now.aim) ? s->now.aim : 2.0 * s->worst - s->better + s->size) / s->size;
}

static double get_limit(unsigned count, const double *u, double *gradient, void *ctx)
{
    const side *limit = ctx;
    search *s = limit->search;
    (void)count;
    go_to(s, u, gradient != NULL);
    if (gradient) {
        put_gradient(s, limit->measure, limit->sign / limit->size, gradient);
    }
    const double over =
        limit->sign * (s->now.measures[limit->measure] - limit->bound) / limit->size;
    return isfinite(over) ? over : 1.0;
}

/* ---- the method ------------------------------------------------------------------------------*/

static nlopt_algorithm find_method(const char *name)
{
    static const struct {
        const char *name;
        nlopt_algorithm method;
    } table[] = {{"cobyla", NLOPT_LN_COBYLA}, {"bobyqa", NLOPT_LN_BOBYQA},
                 {"slsqp", NLOPT_LD_SLSQP},   {"mma", NLOPT_LD_MMA},
                 {"crs", NLOPT_GN_CRS2_LM},   {"direct", NLOPT_GN_DIRECT_L},
                 {"isres", NLOPT_GN_ISRES}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(table[k].name, name) == 0) {
            return table[k].method;
        }
    }
    return NLOPT_NUM_ALGORITHMS;
}

static void add_side(search *s, size_t measure, double sign, double bound)
{
    const double size = fabs(bound) > 0.0 ? fabs(bound) : fabs(s->first.measures[measure]);
    s->sides[s->side_count++] =
        (side){s, measure, sign, bound, size > 0.0 && isfinite(size) ? size : 1.0};
}

/* Equalities first. */
static void list_sides(search *s)
{
    const size_t count = se3d_study_count_limits(s->study);
    for (int equal = 1; equal >= 0; --equal) {
        for (size_t k = 0; k < count; ++k) {
            size_t measure = 0;
            double bounds[2];
            se3d_study_get_limit(s->study, k, &measure, bounds);
            if (equal != !(bounds[0] < bounds[1])) {
                continue;
            }
            if (isfinite(bounds[0])) {
                add_side(s, measure, equal ? 1.0 : -1.0, bounds[0]);
            }
            if (isfinite(bounds[1]) && !equal) {
                add_side(s, measure, 1.0, bounds[1]);
            }
        }
        s->equal_count = equal ? s->side_count : s->equal_count;
    }
}

/* @return false: NLopt refused something. */
static int set_up(search *s)
{
    int good = s->opt != NULL && nlopt_set_min_objective(s->opt, get_aim, s) > 0 &&
               nlopt_set_lower_bounds1(s->opt, 0.0) > 0 &&
               nlopt_set_upper_bounds1(s->opt, 1.0) > 0 &&
               nlopt_set_initial_step1(s->opt, FIRST_STEP) > 0 &&
               nlopt_set_xtol_abs1(s->opt, s->goal.tolerance) > 0 &&
               nlopt_set_maxeval(s->opt, (int)s->goal.evaluations) > 0;
    for (size_t k = 0; k < s->side_count && good; ++k) {
        side *limit = &s->sides[k];
        const double slack = 0.1 * FEASIBLE;
        good = (k < s->equal_count
                    ? nlopt_add_equality_constraint(s->opt, get_limit, limit, slack)
                    : nlopt_add_inequality_constraint(s->opt, get_limit, limit, slack)) > 0;
    }
    return good;
}

static const char *say_end(const search *s, nlopt_result result)
{
    if (s->status == SE3D_ERR_INTERRUPTED) {
        return "ended by the user";
    }
    switch (result) {
    case NLOPT_MAXEVAL_REACHED:
        return "all evaluations were used";
    case NLOPT_ROUNDOFF_LIMITED:
        return "rounding allows no further step";
    default:
        return "converged";
    }
}

/* ---- what is written -------------------------------------------------------------------------*/

static void put_head(const search *s)
{
    fputs("evaluation", s->file);
    for (size_t k = 0; k < s->unknowns; ++k) {
        fprintf(s->file, ",%s", se3d_study_get_unknown_name(s->study, k));
    }
    for (size_t k = 0; k < s->measures; ++k) {
        fprintf(s->file, ",%s", se3d_study_get_measure_name(s->study, k));
    }
    fputs(",violation,status\n", s->file);
}

static void put_quoted(const char *text)
{
    for (const char *c = text; *c; ++c) {
        const char one[2] = {*c, '\0'};
        if (*c == '\'') {
            fputs("'\\''", stdout);
        } else if ((unsigned char)*c >= 0x20 && (unsigned char)*c != 0x7f) {
            fputs(one, stdout);
        } else {
            putchar('?');
        }
    }
}

/* A word of a shell, of three parts. */
static void put_word(const char *first, const char *second, const char *third)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_./=+-";
    const char *const parts[] = {first, second, third};
    const char *quote = "";
    for (size_t k = 0; k < 3; ++k) {
        quote = parts[k][strspn(parts[k], plain)] ? "'" : quote;
    }
    fputs(quote, stdout);
    for (size_t k = 0; k < 3; ++k) {
        put_quoted(parts[k]);
    }
    fputs(quote, stdout);
}

static void put_setting(const char *name, const char *value)
{
    fputs(" --set ", stdout);
    put_word(name, "=", value);
}

static int is_sought(const search *s, const char *name)
{
    for (size_t k = 0; k < s->unknowns; ++k) {
        if (strcmp(se3d_study_get_unknown_name(s->study, k), name) == 0) {
            return 1;
        }
    }
    return 0;
}

static void put_options(const options *o)
{
    const struct {
        const char *name, *value;
    } table[] = {{"--analysis", o->analysis},   {"--formulation", o->formulation},
                 {"--method", o->method},       {"--step", o->step},
                 {"--tolerance", o->tolerance}, {"--duration", o->duration}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (table[k].value) {
            putchar(' ');
            put_word(table[k].name, "=", table[k].value);
        }
    }
}

/* What runs the best one: what was given, and what was found. */
static void print_command(const search *s)
{
    char value[VALUE_SIZE];
    fputs("se3d run ", stdout);
    put_word(s->o->model[0] == '-' ? "./" : "", s->o->model, ""); /* no option */
    put_options(s->o);
    for (size_t k = 0; k < s->o->setting_count; ++k) {
        if (!is_sought(s, s->o->settings[k].name)) {
            put_setting(s->o->settings[k].name, s->o->settings[k].value);
        }
    }
    for (size_t k = 0; k < s->unknowns; ++k) {
        se3d_study_write_unknown(s->study, k, s->best.values[k], value, sizeof value);
        put_setting(se3d_study_get_unknown_name(s->study, k), value);
    }
    putchar('\n');
}

static void print_text(const search *s, const char *how)
{
    printf("%s after %llu evaluations; the best is number %llu%s\n", how,
           (unsigned long long)s->evaluations, (unsigned long long)s->best.evaluation,
           s->best.violation <= FEASIBLE ? "" : ", and it passes limits");
    printf("%-24s %16s %16s\n", "", "start", "best");
    for (size_t k = 0; k < s->unknowns; ++k) {
        printf("%-24s %16.9g %16.9g\n", se3d_study_get_unknown_name(s->study, k),
               s->first.values[k], s->best.values[k]);
    }
    for (size_t k = 0; k < s->measures; ++k) {
        printf("%-24s %16.9g %16.9g\n", se3d_study_get_measure_name(s->study, k),
               s->first.measures[k], s->best.measures[k]);
    }
    print_command(s);
    fputs("wrote ", stdout);
    text_put_plain(stdout, s->path);
    putchar('\n');
}

static void print_json(const search *s, const char *how, int code)
{
    char value[VALUE_SIZE];
    printf("{\"status\": \"%s\", \"end\": \"%s\", \"evaluations\": %llu, \"best\": %llu, "
           "\"limits\": %s, \"parameters\": {",
           code == EXIT_DONE ? "done" : "failed", how, (unsigned long long)s->evaluations,
           (unsigned long long)s->best.evaluation,
           s->best.violation <= FEASIBLE ? "true" : "false");
    for (size_t k = 0; k < s->unknowns; ++k) {
        se3d_study_write_unknown(s->study, k, s->best.values[k], value, sizeof value);
        printf("%s\"%s\": \"%s\"", k > 0 ? ", " : "", se3d_study_get_unknown_name(s->study, k),
               value);
    }
    fputs("}, \"measures\": {", stdout);
    for (size_t k = 0; k < s->measures; ++k) {
        printf("%s\"%s\": ", k > 0 ? ", " : "", se3d_study_get_measure_name(s->study, k));
        json_put_number(s->best.measures[k]);
    }
    fputs("}, \"file\": ", stdout);
    json_put_text(s->path);
    fputs("}\n", stdout);
}

/* ---- the search ------------------------------------------------------------------------------*/

/* The start, in 0 ... 1. Its run must not fail. */
static int begin(search *s, double *u)
{
    for (size_t k = 0; k < s->unknowns; ++k) {
        double bounds[2], start;
        se3d_study_get_unknown(s->study, k, bounds, &start);
        s->from[k] = bounds[0];
        s->width[k] = bounds[1] - bounds[0];
        u[k] = (start - bounds[0]) / s->width[k];
        s->first.values[k] = start;
    }
    const se3d_status status =
        se3d_study_eval_unknowns(s->study, s->first.values, s->first.measures, NULL, &s->error);
    const double aim = s->first.measures[s->goal.measure];
    if (SE3D_FAILED(status) && (status != SE3D_ERR_NOT_FINITE || !isfinite(aim))) {
        return fail(s, s->error.message);
    }
    s->size = fabs(aim) > 0.0 ? fabs(aim) : 1.0;
    s->worst = s->better = s->goal.maximizes ? -aim : aim;
    list_sides(s);
    return EXIT_DONE;
}

static int run(search *s, double *u)
{
    double least = 0.0;
    int code = begin(s, u);
    if (code != EXIT_DONE) {
        return code;
    }
    nlopt_srand((unsigned long)s->goal.seed);
    s->opt = nlopt_create(find_method(s->goal.method), (unsigned)s->unknowns);
    if (!set_up(s)) {
        code = fail(s, "NLopt cannot do this: its version may be too old");
    } else {
        const nlopt_result result = nlopt_optimize(s->opt, u, &least);
        const int stopped =
            s->status == SE3D_ERR_NO_MEMORY || s->missing[0] || s->best.evaluation == 0 ||
            (result < 0 && result != NLOPT_ROUNDOFF_LIMITED && result != NLOPT_FORCED_STOP);
        const char *how = say_end(s, result);
        code = stopped || s->status == SE3D_ERR_INTERRUPTED || s->best.violation > FEASIBLE
                   ? EXIT_FAILED
                   : EXIT_DONE;
        if (stopped) {
            code = fail(s, s->status == SE3D_ERR_NO_MEMORY ? "out of memory"
                           : s->missing[0]                 ? s->missing
                           : s->status < 0                 ? how
                           : nlopt_get_errmsg(s->opt)      ? nlopt_get_errmsg(s->opt)
                                                           : "the method has failed");
        } else if (s->o->json) {
            outcome_tell();
            print_json(s, how, code);
        } else if (!s->o->quiet) {
            print_text(s, how);
        }
    }
    nlopt_destroy(s->opt);
    return code;
}

static int run_with_file(search *s, double *u)
{
    char message[PATH_SIZE + 200];
    int code = EXIT_FAILED;
    s->file = se3di_file_make_folders(s->path) ? se3di_partial_open(s->path) : NULL;
    if (s->file) {
        put_head(s);
        interrupt_begin();
        se3d_study_set_interrupt(s->study, is_over, NULL);
        code = run(s, u);
    }
    if (s->file && file_end(s->file, s->path, !ferror(s->file) && s->evaluations > 0)) {
        return code;
    }
    if (s->file && s->evaluations == 0) {
        return code; /* that the start failed was told */
    }
    snprintf(message, sizeof message, "%s: cannot be written: %s", s->path, strerror(errno));
    return fail(s, message);
}

/* Give the arrays their places. @return false: out of memory. */
static int make_room(search *s, double **memory, double **u)
{
    const size_t point = s->unknowns + s->measures;
    const size_t count = 4 * s->unknowns + s->unknowns * s->measures + 3 * point;
    double *at = *memory = calloc(count + 1, sizeof *at);
    s->sides = calloc(2 * se3d_study_count_limits(s->study) + 1, sizeof *s->sides);
    if (!at || !s->sides) {
        return 0;
    }
    double **const places[] = {u, &s->from, &s->width, &s->point};
    for (size_t k = 0; k < sizeof places / sizeof *places; ++k, at += s->unknowns) {
        *places[k] = at;
    }
    found *const points[] = {&s->now, &s->best, &s->first};
    for (size_t k = 0; k < sizeof points / sizeof *points; ++k, at += point) {
        points[k]->values = at;
        points[k]->measures = at + s->unknowns;
    }
    s->derivatives = at;
    return 1;
}

int study_optimize(const options *o, se3d_study *study, size_t jobs, const char *folder)
{
    search s = {.o = o,
                .study = study,
                .unknowns = se3d_study_count_unknowns(study),
                .measures = se3d_study_count_measures(study)};
    double *memory = NULL;
    double *u = NULL;
    int code = EXIT_FAILED;
    if (se3d_study_get_goal(study, &s.goal) != SE3D_OK) {
        report_failure(o, "",
                       "the study has no `optimize`: which parameters are sought, and what "
                       "for?");
        return EXIT_USAGE;
    }
    s.parts = jobs < s.unknowns ? jobs : s.unknowns;
    const int length = snprintf(s.path, sizeof s.path, "%s/optimize.csv", folder);
    if (length < 0 || (size_t)length >= sizeof s.path) {
        code = fail(&s, "the path of the results is too long");
    } else if (!make_room(&s, &memory, &u)) {
        code = fail(&s, "out of memory");
    } else {
        code = run_with_file(&s, u);
    }
    free(s.sides);
    free(memory);
    return code;
}

#endif
