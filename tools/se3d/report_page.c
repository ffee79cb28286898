/* SPDX-License-Identifier: BSD-3-Clause */
/* se3d report MODEL...: models are run, and one page shows what they are and what came out: a
 * sketch, parameters, curves, tables. Nothing of it is fetched from elsewhere, and names are texts
 * wherever they stand. */
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "file.h"
#include "interrupt.h"
#include "io/write/sketch.h"
#include "io/write/svg.h"
#include "options.h"
#include "outcome.h"
#include "process.h"
#include "report.h"
#include "se3d/study.h"
#include "snapshots.h"
#include "text.h"

enum {
    PATH_SIZE = 4200,
    BELOW_SIZE = 300,
    MODELS_MAX = 64,
    WORDS_MAX = 2 * SETTINGS_MAX + 12,
    ROWS_MAX = 20000,
    SAMPLES_MAX = 200000
};

typedef struct report {
    char *models[MODELS_MAX];
    char below[MODELS_MAX][BELOW_SIZE]; /* the folder of its results, "" or "name/" */
    size_t count;
    const char *folder; /* -o; NULL: the usual one */
    const char *x;      /* -x; NULL: chosen */
    char *jobs;         /* --jobs; NULL: one */
    char *settings[SETTINGS_MAX];
    size_t setting_count;
    int has_x; /* a file of results has it */
    int quiet, help;
    char place[PATH_SIZE]; /* of the page */
    FILE *page;
} report;

static int usage(const char *what, const char *word)
{
    complain("se3d report: %s `%s`; see `se3d help report`\n", what, word);
    return EXIT_USAGE;
}

/* ---- the page --------------------------------------------------------------------------------*/

void report_put_tag(FILE *page, const char *tag, const char *text)
{
    fprintf(page, "<%s>", tag);
    se3di_svg_put(page, text);
    fprintf(page, "</%s>\n", tag);
}

void report_put_number(FILE *page, double value)
{
    if (isfinite(value)) {
        fprintf(page, "<td>%.6g</td>", value);
    } else {
        fputs("<td></td>", page);
    }
}

/* What was drawn, as a picture that has a style of its own. @return false: it cannot be read */
static int put_picture(FILE *page, FILE *drawing, const char *text)
{
    const long size = fflush(drawing) == 0 ? ftell(drawing) : -1;
    char *data = size > 0 ? malloc((size_t)size) : NULL;
    rewind(drawing);
    const int good = data && fread(data, 1, (size_t)size, drawing) == (size_t)size;
    if (good) {
        fputs("<img alt=\"", page);
        se3di_svg_put(page, text);
        fputs("\" src=\"data:image/svg+xml;base64,", page);
        base64_put(page, data, (size_t)size);
        fputs("\">\n", page);
    }
    free(data);
    return good;
}

static int put_sketch(FILE *page, se3d_model *model)
{
    FILE *drawing = tmpfile();
    int good = drawing != NULL;
    if (good && !SE3D_FAILED(se3di_sketch_put(model, NULL, drawing))) {
        good = put_picture(page, drawing, "sketch");
    }
    if (drawing) {
        fclose(drawing);
    }
    return good;
}

static void put_parameters(FILE *page, const se3d_model *model)
{
    const size_t count = se3d_model_count_parameters(model);
    if (count == 0) {
        return;
    }
    fputs("<h3>Parameters</h3>\n<table><tr><th>name</th><th>in the file</th><th>value</th></tr>\n",
          page);
    for (size_t k = 0; k < count; ++k) {
        double value = (double)NAN;
        const char *name = se3d_model_get_parameter_name(model, k);
        se3d_model_get_parameter(model, name, &value);
        fputs("<tr><td>", page);
        se3di_svg_put(page, name);
        fputs("</td><td>", page);
        se3di_svg_put(page, se3d_model_get_parameter_text(model, k));
        fputs("</td>", page);
        report_put_number(page, value);
        fputs("</tr>\n", page);
    }
    fputs("</table>\n", page);
}

/* ---- one file of results ---------------------------------------------------------------------*/

const double *sheet_get_column(const sheet *s, size_t k)
{
    return s->columns + k * s->rows;
}

int sheet_read(sheet *s, size_t most)
{
    const size_t stride = s->t.rows / most + 1;
    const size_t room = s->t.rows / stride + 2;
    double *rows = calloc(room * s->t.count, sizeof *rows);
    s->rows = rows ? table_read_rows(&s->t, stride, rows, room) : 0;
    s->columns = calloc(s->rows * s->t.count + 1, sizeof *s->columns);
    for (size_t i = 0; rows && s->columns && i < s->rows; ++i) {
        for (size_t k = 0; k < s->t.count; ++k) {
            s->columns[k * s->rows + i] = rows[i * s->t.count + k];
        }
    }
    free(rows);
    return rows && s->columns;
}

/* The unit of a column: of its channel, or of that whose component it is; else by its name. */
static const char *get_unit(const sheet *s, const char *column, char *buffer, size_t size)
{
    const char *dot = strrchr(column, '.');
    for (size_t k = 0; k < s->channels; ++k) {
        se3d_model_channel channel;
        if (SE3D_FAILED(se3d_model_get_listed_channel(s->model, k, &channel))) {
            break;
        }
        const size_t length = strlen(channel.name);
        const int is_part = dot && column + length == dot && channel.width > 1;
        if (strncmp(column, channel.name, length) == 0 && (column[length] == '\0' || is_part)) {
            return channel.unit;
        }
    }
    return table_get_unit(&s->t, column, buffer, size);
}

/* A name with its unit. */
static void make_label(const sheet *s, const char *quantity, const char *column, char *label,
                       size_t size)
{
    char unit[60];
    const char *text = get_unit(s, column, unit, sizeof unit);
    snprintf(label, size, text[0] ? "%.120s [%.40s]" : "%.120s", quantity, text);
}

int report_put_chart(FILE *page, const chart *c)
{
    FILE *drawing = tmpfile();
    int good = drawing != NULL;
    if (good) {
        chart_put(c, drawing);
        good = put_picture(page, drawing, c->title);
        fclose(drawing);
    }
    return good;
}

/* A column of texts has none. */
static int has_numbers(const sheet *s, size_t k)
{
    const double *y = sheet_get_column(s, k);
    size_t i = 0;
    while (i < s->rows && !isfinite(y[i])) {
        ++i;
    }
    return i < s->rows;
}

/* What stays below 1e-9 of the largest of its quantity is rounding. @return false: out of memory */
static int look_at_columns(sheet *s)
{
    const size_t count = s->t.count;
    double *most = calloc(count + 1, sizeof *most);
    s->zero = calloc(count + 1, 1);
    s->labels = calloc(count + 1, sizeof *s->labels);
    const int good = most && s->zero && s->labels;
    for (size_t k = 0; good && k < count; ++k) {
        char quantity[400];
        const double *y = sheet_get_column(s, k);
        table_get_quantity(s->t.names[k], quantity, sizeof quantity);
        make_label(s, quantity, s->t.names[k], s->labels[k], sizeof s->labels[k]);
        for (size_t i = 0; i < s->rows; ++i) {
            most[k] = isfinite(y[i]) ? fmax(most[k], fabs(y[i])) : most[k];
        }
    }
    for (size_t k = 1; good && k < count; ++k) {
        double largest = most[k];
        for (size_t i = 1; i < count; ++i) {
            largest = strcmp(s->labels[k], s->labels[i]) == 0 ? fmax(largest, most[i]) : largest;
        }
        s->zero[k] = k != s->x && most[k] <= 1e-9 * largest && has_numbers(s, k);
    }
    free(most);
    return good;
}

/* "bar y" of bar.position.y: what the title of a frame does not say. */
static void make_brief(const char *column, char *brief, size_t size)
{
    char quantity[400];
    table_get_quantity(column, quantity, sizeof quantity);
    const size_t length = strlen(quantity);
    const char *at = length > 0 ? column : NULL;
    while (at && (at = strstr(at, quantity)) != NULL &&
           !(at > column && at[-1] == '.' && (at[length] == '.' || !at[length]))) {
        ++at;
    }
    if (at) {
        snprintf(brief, size, "%.*s%s%.90s", (int)(at - column - 1 < 90 ? at - column - 1 : 90),
                 column, at[length] ? " " : "", at + length + (at[length] == '.'));
    } else {
        snprintf(brief, size, "%.190s", column);
    }
}

/* Curves of one quantity and unit share a frame, as far as it has room. */
static int put_charts(FILE *page, const sheet *s)
{
    char *done = calloc(s->t.count + 1, 1);
    int good = done != NULL;
    fputs("<div>\n", page);
    for (size_t k = 1; k < s->t.count && good; ++k) {
        char briefs[CHART_CURVES_MAX][200];
        chart c = {.x = sheet_get_column(s, s->x), .count = s->rows};
        if (done[k] || k == s->x || s->zero[k] || !has_numbers(s, k)) {
            continue;
        }
        strcpy(c.y_label, s->labels[k]);
        make_label(s, s->t.names[s->x], s->t.names[s->x], c.x_label, sizeof c.x_label);
        c.title = c.y_label;
        for (size_t i = k; i < s->t.count && c.curves < CHART_CURVES_MAX; ++i) {
            if (!done[i] && i != s->x && !s->zero[i] && strcmp(s->labels[i], s->labels[k]) == 0 &&
                has_numbers(s, i)) {
                done[i] = 1;
                make_brief(s->t.names[i], briefs[c.curves], sizeof briefs[0]);
                c.names[c.curves] = s->t.names[i];
                c.briefs[c.curves] = briefs[c.curves];
                c.y[c.curves++] = sheet_get_column(s, i);
            }
        }
        good = report_put_chart(page, &c);
    }
    fputs("</div>\n", page);
    free(done);
    return good;
}

/* dy/dx where |x| is the least, from the rows beside it. */
static double get_slope(const sheet *s, size_t k)
{
    const double *x = sheet_get_column(s, s->x);
    const double *y = sheet_get_column(s, k);
    size_t at = 0;
    for (size_t i = 1; i < s->rows; ++i) {
        at = fabs(x[i]) < fabs(x[at]) ? i : at;
    }
    const size_t before = at > 0 ? at - 1 : at;
    const size_t after = at + 1 < s->rows ? at + 1 : at;
    const double apart = x[after] - x[before];
    return fabs(apart) > 0.0 ? (y[after] - y[before]) / apart : (double)NAN;
}

static void put_row(FILE *page, const sheet *s, size_t k)
{
    char unit[60];
    const double *x = sheet_get_column(s, s->x);
    const double *y = sheet_get_column(s, k);
    size_t least = 0;
    size_t most = 0;
    for (size_t i = 1; i < s->rows; ++i) {
        least = y[i] < y[least] ? i : least;
        most = y[i] > y[most] ? i : most;
    }
    fputs("<tr><td>", page);
    se3di_svg_put(page, s->t.names[k]);
    fputs("</td><td>", page);
    se3di_svg_put(page, get_unit(s, s->t.names[k], unit, sizeof unit));
    fputs("</td>", page);
    const double cells[] = {y[0], y[least], x[least], y[most], x[most], y[s->rows - 1]};
    for (size_t i = 0; i < sizeof cells / sizeof *cells; ++i) {
        report_put_number(page, cells[i]);
    }
    if (s->x > 0) {
        report_put_number(page, get_slope(s, k));
    }
    fputs("</tr>\n", page);
}

static void put_table(FILE *page, const sheet *s)
{
    fputs("<table><tr><th>channel</th><th>unit</th><th>first</th><th>least</th><th>at</th>"
          "<th>most</th><th>at</th><th>last</th>",
          page);
    if (s->x > 0) {
        fputs("<th>slope at 0</th>", page);
    }
    fputs("</tr>\n", page);
    for (size_t k = 1; k < s->t.count; ++k) {
        if (k != s->x && has_numbers(s, k) && !s->zero[k]) {
            put_row(page, s, k);
        }
    }
    fputs("</table>\n", page);
    size_t zeros = 0;
    for (size_t k = 1; k < s->t.count; ++k) {
        if (s->zero[k]) {
            fputs(zeros++ > 0 ? ", " : "<p class=\"small\">Zero all the time: ", page);
            se3di_svg_put(page, s->t.names[k]);
        }
    }
    fputs(zeros > 0 ? "</p>\n" : "", page);
}

/* A link to a file below the page: every other character as its number. */
static void put_link(FILE *page, const char *path)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789"
                                "_./-";
    fputs("<p><a href=\"./", page);
    for (const char *c = path; *c; ++c) {
        fprintf(page, strchr(plain, *c) ? "%c" : "%%%02X", (unsigned char)*c);
    }
    fputs("\">", page);
    se3di_svg_put(page, path);
    fputs("</a></p>\n", page);
}

/* Whether nothing but kinematics is run. */
static int is_still(const se3d_model *model)
{
    int still = model != NULL;
    for (size_t k = 0; model && k < se3d_model_count_analyses(model); ++k) {
        se3d_model_analysis analysis;
        still =
            still && !SE3D_FAILED(se3d_model_get_analysis(model, k, &analysis)) &&
            (strcmp(analysis.type, "kinematics") == 0 || strcmp(analysis.type, "assembly") == 0);
    }
    return still;
}

/* What stands on the horizontal axis: as asked; the first channel of kinematics; else the time. */
static size_t choose_x(report *r, const se3d_model *model, const table *t)
{
    const size_t asked = r->x ? table_find(t, r->x) : t->count;
    r->has_x = r->has_x || asked < t->count;
    return asked < t->count ? asked : is_still(model) && t->count > 2 ? 1 : 0;
}

/* One file: samples of a study, its derivatives, or rows of a run (`model`: of which, NULL: not
 * known). */
static int put_file(report *r, se3d_model *model, const char *path)
{
    sheet s = {.model = model};
    if (!table_read(&s.t, "report", path)) {
        return 0;
    }
    const int is_study = s.t.remark && strncmp(s.t.remark, "# se3d study ", 13) == 0;
    int good = 1;
    s.x = choose_x(r, is_study ? NULL : model, &s.t);
    if (strcmp(s.t.names[0], "measure") == 0) {
        good = report_put_cells(r->page, path);
    } else if (is_study) {
        good = sheet_read(&s, SAMPLES_MAX) && report_put_samples(r->page, &s, r->x);
    } else {
        good = (!model || !SE3D_FAILED(se3d_model_list_channels(model, &s.channels))) &&
               sheet_read(&s, ROWS_MAX) && look_at_columns(&s);
        if (good && s.rows > 0) {
            put_table(r->page, &s);
            good = s.rows < 2 || put_charts(r->page, &s);
        }
    }
    free(s.zero);
    free(s.labels);
    free(s.columns);
    table_destroy(&s.t);
    return good;
}

static int put_results(report *r, se3d_model *model, const char *folder, const char *below,
                       const char *file)
{
    char path[2 * PATH_SIZE];
    char link[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, file);
    snprintf(link, sizeof link, "%s%s", below, file);
    report_put_tag(r->page, "h3", file);
    put_link(r->page, link);
    return put_file(r, model, path);
}

/* ---- one model -------------------------------------------------------------------------------*/

/* The words for another command: the settings, then the model, which may begin with a dash. */
static int add_words(const report *r, char *model, char *set, char *end, char **words)
{
    int count = 0;
    for (size_t k = 0; k < r->setting_count; ++k) {
        words[count++] = set;
        words[count++] = r->settings[k];
    }
    words[count++] = end;
    words[count++] = model;
    return count;
}

/* `se3d run` with the settings of the report. */
static int run_one(const report *r, char *model, char *folder)
{
    char set[] = "--set", end[] = "--", output[] = "-o", quiet[] = "-q";
    char *words[WORDS_MAX] = {quiet, output, folder};
    return run_entry.run(3 + add_words(r, model, set, end, words + 3), words);
}

/* The file that a study writes if nothing else is asked; NULL: none. */
static const char *get_study_file(const se3d_study *study)
{
#if defined(SE3D_HAS_NLOPT)
    const int seeks = se3d_study_count_unknowns(study) > 0;
#else
    const int seeks = 0;
#endif
    return se3d_study_count_samples(study) > 0         ? "study.csv"
           : seeks                                     ? "optimize.csv"
           : se3d_study_count_sensitivities(study) > 0 ? "sensitivities.csv"
                                                       : NULL;
}

/* Whether a table has all samples, some of which may have failed. */
static int has_samples(se3d_study *study, const char *path)
{
    se3d_study_table_def def = se3d_study_table_def_default();
    se3d_study_table *samples = NULL;
    def.path = path;
    def.resume = 1;
    if (SE3D_FAILED(se3d_study_table_open(study, &def, &samples, NULL))) {
        return 0;
    }
    uint64_t k = 0;
    while (k < se3d_study_count_samples(study) && se3d_study_table_has(samples, k)) {
        ++k;
    }
    se3d_study_table_close(samples);
    return k == se3d_study_count_samples(study);
}

/* `se3d study` with the settings of the report; samples that are there already are not run again.
 */
static int run_samples(const report *r, char *model, se3d_study *study, char *folder,
                       const char *file)
{
    char set[] = "--set", end[] = "--", output[] = "-o", quiet[] = "-q", jobs[] = "--jobs",
         resume[] = "--resume", sensitivities[] = "--sensitivities";
    char *words[WORDS_MAX] = {quiet, output, folder};
    char path[2 * PATH_SIZE];
    int count = 3;
    const int has_rows = se3d_study_count_samples(study) > 0;
    snprintf(path, sizeof path, "%s/%s", folder, file);
    if (has_rows) {
        words[count++] = resume;
    } else {
        remove(path);
    }
    if (strcmp(file, "sensitivities.csv") == 0) {
        words[count++] = sensitivities;
    }
    if (r->jobs) {
        words[count++] = jobs;
        words[count++] = r->jobs;
    }
    const int code = study_entry.run(count + add_words(r, model, set, end, words + count), words);
    const int is_there = has_rows ? has_samples(study, path) : !file_is_missing(path);
    return code == EXIT_FAILED && is_there && !interrupt_came() ? EXIT_DONE : code;
}

/* Run the study of a model, if it has one: *file is what it wrote, or NULL. */
static int run_study(const report *r, char *path, se3d_model *model, char *folder,
                     const char **file)
{
    se3d_study *study = NULL;
    int code = EXIT_DONE;
    *file = NULL;
    if (SE3D_FAILED(se3d_study_create(model, &study, NULL))) {
        return EXIT_DONE;
    }
    *file = get_study_file(study);
    if (*file) {
        code = run_samples(r, path, study, folder, *file);
    }
    se3d_study_destroy(study);
    return code;
}

static int put_model(report *r, se3d_model *model, const char *path, const char *folder,
                     const char *below, const char *study)
{
    const char *title = se3d_model_get_title(model);
    int good = 1;
    report_put_tag(r->page, "h2", title[0] ? title : se3d_model_get_name(model));
    report_put_tag(r->page, "p", path);
    for (size_t k = 0; k < r->setting_count; ++k) {
        report_put_tag(r->page, "p", r->settings[k]);
    }
    good = put_sketch(r->page, model);
    put_parameters(r->page, model);
    for (size_t k = 0; k < se3d_model_count_outputs(model) && good; ++k) {
        se3d_model_output output;
        se3d_model_get_output(model, k, &output);
        if (output.channel_count > 0 && !se3di_file_is_hdf5(output.file)) {
            good = put_results(r, model, folder, below, output.file);
        }
    }
    return good && (!study || put_results(r, model, folder, below, study));
}

static int read_model(const report *r, char *path, se3d_model **model)
{
    char set[] = "--set", end[] = "--";
    char *words[WORDS_MAX];
    options o;
    int code = options_read(&o, &report_entry, add_words(r, path, set, end, words), words);
    if (code == EXIT_DONE) {
        const se3d_model_options how = options_get_model(&o);
        code = options_read_model(&o, &how, model);
    }
    return code;
}

static int is_taken(const report *r, size_t count, const char *below)
{
    for (size_t k = 0; k < count; ++k) {
        if (strcmp(r->below[k], below) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Models of one name have folders of their own: m, m-2, m-3. */
static void choose_below(report *r, size_t index, const char *name)
{
    char *below = r->below[index];
    snprintf(below, BELOW_SIZE, "%.250s/", name);
    for (size_t k = 2; is_taken(r, index, below); ++k) {
        snprintf(below, BELOW_SIZE, "%.250s-%zu/", name, k);
    }
}

/* A part of the page is missing: the reason, unless complaints beyond `told` say it. */
static int fail_page(size_t told)
{
    if (outcome_count_complaints() == told) {
        complain("se3d report: out of memory, or of room for temporary files\n");
    }
    return EXIT_FAILED;
}

/* Run a model into its folder and put it on the page. */
static int report_model(report *r, size_t index)
{
    char folder[PATH_SIZE + BELOW_SIZE];
    char *path = r->models[index];
    const char *below = r->below[index];
    const char *study = NULL;
    se3d_model *model = NULL;
    int code = read_model(r, path, &model);
    if (code == EXIT_DONE && se3d_model_count_analyses(model) == 0) {
        complain("se3d report: %s: there is nothing to run\n", path);
        code = EXIT_USAGE;
    }
    if (code == EXIT_DONE) {
        if (r->count > 1) {
            choose_below(r, index, se3d_model_get_name(model));
        }
        snprintf(folder, sizeof folder, "%s%s%s", r->place, r->count > 1 ? "/" : "", below);
        code = run_one(r, path, folder);
        code = code == EXIT_DONE ? run_study(r, path, model, folder, &study) : code;
    }
    const size_t told = outcome_count_complaints();
    if (code == EXIT_DONE && !put_model(r, model, path, folder, below, study)) {
        code = fail_page(told);
    }
    se3d_model_destroy(model);
    return code;
}

static int is_results(const char *path)
{
    const size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".csv") == 0;
}

/* A file of results by itself, which is linked if it lies beside the page. */
static int report_file(report *r, const char *path)
{
    char folder[PATH_SIZE];
    report_put_tag(r->page, "h2", path);
    if (path_get_folder(path, folder, sizeof folder) && strcmp(folder, r->place) == 0) {
        put_link(r->page, path_get_name(path));
    }
    const size_t told = outcome_count_complaints();
    return put_file(r, NULL, path) ? EXIT_DONE : fail_page(told);
}

/* ---- the command -----------------------------------------------------------------------------*/

/* The folder of the page, by the first model. */
static int find_place(report *r)
{
    se3d_model *model = NULL;
    int length = -1;
    if (r->folder) {
        length = snprintf(r->place, sizeof r->place, "%s", r->folder);
    } else if (r->count > 1) {
        length = snprintf(r->place, sizeof r->place, "results/report");
    } else if (is_results(r->models[0])) {
        length =
            path_get_folder(r->models[0], r->place, sizeof r->place) ? (int)strlen(r->place) : -1;
    } else {
        const int code = read_model(r, r->models[0], &model);
        if (code != EXIT_DONE) {
            return code;
        }
        length = snprintf(r->place, sizeof r->place, "results/%s", se3d_model_get_name(model));
        se3d_model_destroy(model);
    }
    return length > 0 && (size_t)length < sizeof r->place
               ? EXIT_DONE
               : usage("the path is too long:", r->folder ? r->folder : r->models[0]);
}

static int write_page(report *r)
{
    static const char head[] =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
        "img-src data:; style-src 'unsafe-inline'\">\n<title>Report</title>\n<style>"
        "body{font:15px sans-serif;color:#1c2730;max-width:84em;margin:2em auto;padding:0 1em}"
        "table{border-collapse:collapse;margin:1em 0}"
        "td,th{border:1px solid #c8d0d6;padding:.2em .6em;text-align:right}"
        "td:first-child,th:first-child{text-align:left}img{max-width:100%;margin:.3em}"
        "div{display:flex;flex-wrap:wrap}div img{width:calc(50% - .6em)}.small{font-size:85%}"
        "@media(max-width:50em){div img{width:100%}}"
        "</style></head><body>\n<h1>Report</h1>\n";
    char path[PATH_SIZE + 20];
    int code = EXIT_DONE;
    snprintf(path, sizeof path, "%s/report.html", r->place);
    r->page = se3di_file_make_folders(path) ? se3di_partial_open(path) : NULL;
    if (r->page) {
        fputs(head, r->page);
        for (size_t k = 0; k < r->count && code == EXIT_DONE; ++k) {
            code = is_results(r->models[k]) ? report_file(r, r->models[k]) : report_model(r, k);
        }
        if (code == EXIT_DONE && r->x && !r->has_x) {
            code = usage("no file of results has the channel of -x,", r->x);
        }
        fputs("</body></html>\n", r->page);
    }
    const int good = r->page && file_end(r->page, path, code == EXIT_DONE && !ferror(r->page));
    if (!good && code == EXIT_DONE) {
        complain("se3d report: %s: cannot be written: %s\n", path, strerror(errno));
        code = EXIT_FAILED;
    }
    if (code == EXIT_DONE) {
        outcome_add_file(path, r->quiet, "\n");
    }
    return code;
}

static int take_value(report *r, const char *name, char *value)
{
    if (!value || !value[0]) {
        return usage("a value is missing after", name);
    }
    if (strcmp(name, "--set") == 0) {
        if (r->setting_count == SETTINGS_MAX) {
            return usage("too many --set, no room for", value);
        }
        r->settings[r->setting_count++] = value;
    } else if (strcmp(name, "-x") == 0) {
        r->x = value;
    } else if (strcmp(name, "--jobs") == 0) {
        r->jobs = value;
    } else {
        r->folder = value;
    }
    return EXIT_DONE;
}

static int add_model(report *r, char *word)
{
    if (r->count == MODELS_MAX) {
        return usage("too many models, no room for", word);
    }
    if (strcmp(word, "-") == 0) {
        return usage("a model must be a file, which is run by itself, not", word);
    }
    r->models[r->count++] = word;
    return EXIT_DONE;
}

static int takes_value(const char *word)
{
    static const char *const names[] = {"--set", "-x", "--jobs", "-o", "--output"};
    for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
        if (strcmp(word, names[k]) == 0) {
            return 1;
        }
    }
    return 0;
}

static int read_flag(report *r, const char *word)
{
    if (command_find_common(word)) {
        options_take_common(word, &r->quiet, &r->help);
    } else {
        return usage("unknown option", word);
    }
    return EXIT_DONE;
}

static int read_words(report *r, int count, char *const *words)
{
    int names = 0; /* after "--" no word is an option */
    for (int k = 0; k < count; ++k) {
        int code = EXIT_DONE;
        if (names || words[k][0] != '-' || !words[k][1]) {
            code = add_model(r, words[k]);
        } else if (strcmp(words[k], "--") == 0) {
            names = 1;
        } else if (takes_value(words[k])) {
            code = take_value(r, words[k], k + 1 < count ? words[k + 1] : NULL);
            ++k;
        } else {
            code = read_flag(r, words[k]);
        }
        if (code != EXIT_DONE) {
            return code;
        }
    }
    if (r->count == 0 && !r->help) {
        complain("se3d report: which model? Give a file; see `se3d help report`\n");
        return EXIT_USAGE;
    }
    return EXIT_DONE;
}

static int command_report(int count, char *const *words)
{
    report *r = calloc(1, sizeof *r);
    if (!r) {
        complain("se3d report: out of memory\n");
        return EXIT_FAILED;
    }
    interrupt_begin();
    int code = read_words(r, count, words);
    if (code == EXIT_DONE && r->help) {
        options_print_of(&report_entry, r->help == OPTIONS_VERSION);
    } else if (code == EXIT_DONE) {
        r->quiet = r->quiet || outcome_wants_json();
        code = find_place(r);
        code = code == EXIT_DONE ? write_page(r) : code;
    }
    free(r);
    return code;
}

const command_entry report_entry = {
    .name = "report",
    .run = command_report,
    .operands = "MODEL...",
    .files = "yaml yml json csv",
    .summary = "run models and write one page of curves and tables",
    .text = "Runs the models and writes report.html: of each a sketch, its parameters, and for "
            "every CSV file of results a table and curves, one frame for each quantity. Curves of "
            "kinematics are drawn over their first channel (the travel of a wheel, the angle of "
            "the hand wheel), the others over time. The CSV files lie beside the page, which "
            "needs no network.\n\n"
            "What `se3d study` makes of `study` of a model is run, too, and shown: tables of the "
            "samples and curves of measures over parameters. In place of a model, a CSV file is "
            "shown as it is: study.csv, sensitivities.csv or rows of a run.",
    .options =
        (const command_option[]){
            {"--output", "-o", "DIR",
             "folder for the page and the results (default: results/<model>, of several models "
             "results/report)"},
            {"-x", NULL, "CHANNEL",
             "horizontal axis of the files that have it; of a study, the parameter"},
            {"--jobs", NULL, "N", "run studies by this many processes, or `all`"},
            COMMAND_OPTION_SET,
            {0}},
    .examples =
        (const command_example[]){
            {"report travel.yaml roll.yaml steer.yaml", "kinematics of a suspension on one page"},
            {"report corner.yaml --set rack_z=152", "with another hardpoint"},
            {"report results/damper/study.csv", "samples that were run"},
            {0}},
    .exits = "0 done; 1 a run or a file failed; 2 bad usage or model.",
};
