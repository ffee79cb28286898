/* SPDX-License-Identifier: BSD-3-Clause */
/* `study`: how samples are laid out, and what is measured of each run. */
#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/channel/combine.h"
#include "io/channel/event.h"
#include "io/channel/study.h"
#include "io/document/curve.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/guess.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/objects.h"
#include "io/read/sections.h"
#include "io/read/study_goal.h"
#include "io/read/study_values.h"

#define SAMPLES_MAX 1e8
#define SEED_MAX    9007199254740992.0 /* 2^53 */
#define MODES_MAX   1e5
enum { SOBOL_PARAMETERS_MAX = 21 };

static const char *const methods[] = {[SE3DI_STUDY_GRID] = "grid",
                                      [SE3DI_STUDY_MONTE_CARLO] = "monte_carlo",
                                      [SE3DI_STUDY_LATIN_HYPERCUBE] = "latin_hypercube",
                                      [SE3DI_STUDY_SOBOL] = "sobol",
                                      NULL};

/* clang-format off */
static const se3di_key study_keys[] = {
    {"parameters", SE3DI_KIND_VARIED, .object = "varied",
     .text = "which parameters of the model vary: {from, to, count}, a list of values, or a "
         "distribution such as normal(2, 0.1)"},
    {"table", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_study_entry, table),
     .text = "CSV file with a column for each parameter and a row for each sample, relative to the "
         "model file; in place of parameters"},
    {"sensitivities", SE3DI_KIND_NAMES, .standard = "those that vary",
     .text = "parameters of which `se3d study --sensitivities` takes derivatives"},
    {"optimize", SE3DI_KIND_OBJECT, .object = "goal",
     .text = "which parameters `se3d study --optimize` seeks, so that a measure is the least or "
         "the greatest"},
    {"method", SE3DI_KIND_WORD, SE3DI_INTO(se3di_study_entry, method), .words = methods,
     .standard = "grid; with `samples`, monte_carlo", .text = "how the samples are laid out"},
    {"samples", SE3DI_KIND_COUNT, .most = SAMPLES_MAX,
     .text = "how many, but for a grid or a table, which have their own number"},
    {"seed", SE3DI_KIND_COUNT, .most = SEED_MAX, .standard = "0",
     .text = "another one gives other samples"},
    {"measures", SE3DI_KIND_MEASURES, .object = "measure", .required = true,
     .text = "names, and what is measured: {max: bar.position.z}, or an expression over the "
         "measures above it and the parameters"},
    {"analysis", SE3DI_KIND_COUNT, .most = 1000, .standard = "the last",
     .text = "number of the analysis that is measured, from 1"},
    {"every", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_study_entry, every),
     .standard = "the step; without one a 500th of the duration",
     .text = "time between the rows that measures are made of [s]"},
    {.key = NULL}};
const se3di_object se3di_object_study = {
    "study",
    "Many runs of the model with other parameters.",
    study_keys, NULL,
    "\"anyOf\": [{\"required\": [\"parameters\"]}, {\"required\": [\"table\"]}, {\"required\": "
    "[\"sensitivities\"]}, {\"required\": [\"optimize\"]}]"};

#define CHANNEL "a [channel](#output) of one number or an [expression](#expressions-of-channels): "
static const se3di_key measure_keys[] = {
    {"max", SE3DI_KIND_TEXT, .text = CHANNEL "its largest row"},
    {"min", SE3DI_KIND_TEXT, .text = CHANNEL "its smallest row"},
    {"range", SE3DI_KIND_TEXT, .text = CHANNEL "max - min"},
    {"mean", SE3DI_KIND_TEXT, .text = CHANNEL "mean over time, trapezoids between rows"},
    {"rms", SE3DI_KIND_TEXT, .text = CHANNEL "root of the mean square over time"},
    {"integral", SE3DI_KIND_TEXT, .text = CHANNEL "integral over time"},
    {"initial", SE3DI_KIND_TEXT, .text = CHANNEL "at the beginning of the analysis"},
    {"final", SE3DI_KIND_TEXT, .text = CHANNEL "at the end"},
    {"at", SE3DI_KIND_TEXT, .text = CHANNEL "at a `time` or an `event`"},
    {"settling", SE3DI_KIND_TEXT,
     .text = CHANNEL "time from the beginning until it stays within `band` of `target`"},
    {"time_of", SE3DI_KIND_TEXT, .text = "an [event](#events): when it happens first"},
    {"frequency", SE3DI_KIND_COUNT, .most = MODES_MAX,
     .text = "number of a [mode](#modes), from 1, of the analysis `modes`: its undamped frequency "
         "[Hz]"},
    {"damping", SE3DI_KIND_COUNT, .most = MODES_MAX, .text = "the same: its damping ratio"},
    {"misfit", SE3DI_KIND_TEXT,
     .text = CHANNEL "root of the mean square over time of how far it is off a `curve`"},
    {"along", SE3DI_KIND_TEXT, .standard = "the time since the beginning of the analysis",
     .text = "of `misfit`, the channel that x of the curve is"},
    {"curve", SE3DI_KIND_OBJECT, .object = "spline",
     .text = "of `misfit`, the wanted values: {linear: [[x, y], ...]} or {linear: wanted.csv}, in "
         "the units of the channels"},
    {"time", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3di_study_measure, time),
     .text = "of `at`, since the beginning of the analysis; between two rows a straight line [s]"},
    {"event", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_study_measure, event),
     .text = "of `at`, the first time that it happens"},
    {"band", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_study_measure, band),
     .text = "of `settling`, in the unit of the channel"},
    {"target", SE3DI_KIND_NUMBER, SE3DI_INTO(se3di_study_measure, target),
     .standard = "the last value", .text = "of `settling`, in the unit of the channel"},
    {.key = NULL}};
const se3di_object se3di_object_measure = {
    "measure",
    "A number that is made of a run: exactly one of max ... misfit, with what belongs to it.",
    measure_keys, NULL,
    NULL};
/* clang-format on */

/* ---- measures --------------------------------------------------------------------------------*/

static bool check_event(se3di_reader *reader, const se3di_node *node, const char *name)
{
    const se3d_model *model = reader->model;
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; k < model->event_count; ++k) {
        if (strcmp(model->events[k].name, name) == 0) {
            return true;
        }
        se3di_guess_offer(&guess, model->events[k].name);
    }
    const char *meant = se3di_guess_get(&guess);
    return se3di_reader_fail(reader, node, "no event is named `%.60s`%s%s%s", name,
                             meant ? ", did you mean `" : "; list it under `events`",
                             meant ? meant : "", meant ? "`?" : "");
}

/* The number that a text stands for: a channel, a component of one, or an expression of some. */
static bool read_number_of(se3di_reader *reader, const se3di_node *node, se3di_study_channel *to)
{
    const char *name = node->text;
    char problem[480] = "is longer than any channel's name";
    if (se3di_text_is_combination(reader->model, name)) {
        return se3di_combination_read(reader, node, name, &to->channel);
    }
    if (strlen(name) <= 310 && se3di_channel_find_number(reader->model, name, &to->channel,
                                                         &to->component, problem, sizeof problem)) {
        return true;
    }
    return se3di_reader_fail(reader, node, "%s", problem);
}

/* The points that a channel is to go through. */
static bool read_points(se3di_reader *reader, const se3di_node *curve, se3di_study_measure *m)
{
    se3d_function_def def = se3d_function_def_default();
    const int alternative = reader->alternative;
    reader->alternative = -1; /* the units of the channels, whatever they are */
    const bool good = se3di_read_curve(reader, curve, "x", &def);
    reader->alternative = alternative;
    if (!good) {
        return false;
    }
    m->point_count = def.table_count;
    m->x = se3di_iopool_array(reader->pool, 2 * def.table_count, sizeof *m->x);
    if (!m->x) {
        return se3di_reader_fail_memory(reader);
    }
    m->y = m->x + def.table_count;
    for (size_t k = 0; k < def.table_count; ++k) {
        m->x[k] = def.table_x[k];
        m->y[k] = def.table_y[k];
    }
    return true;
}

/* Its numbers, with the parameters of this reading. */
static bool read_numbers(se3di_reader *reader, se3di_study_measure *m)
{
    const bool is_mode =
        m->reduction == SE3DI_REDUCE_FREQUENCY || m->reduction == SE3DI_REDUCE_DAMPING;
    if (is_mode) {
        return se3di_read_key(reader, m->map, &se3di_object_measure, NULL,
                              measure_keys[m->reduction].key, &m->mode);
    }
    const int alternative = reader->alternative;
    reader->alternative = -1; /* the unit of the channel, whatever that is */
    const bool good =
        se3di_read_fields(reader, m->map, &se3di_object_measure, NULL, "se3di_study_measure", m);
    reader->alternative = alternative;
    return good;
}

/* The measures of a model that is read for a sample. Points of a file stay. */
static bool read_again(se3di_reader *reader, se3di_study_measure *m)
{
    const se3di_node *curve = m->map ? se3di_node_get(m->map, "curve") : NULL;
    const se3di_node *points = curve ? se3di_node_get(curve, "linear") : NULL;
    if (m->map && !read_numbers(reader, m)) {
        return false;
    }
    return !points || points->kind == SE3DI_NODE_SCALAR || read_points(reader, curve, m);
}

bool se3di_read_measured(se3di_reader *reader, const se3di_study_entry *study)
{
    se3d_model *model = reader->model;
    const size_t sources = study->source_count, measures = study->measure_count;
    model->measured = se3di_iopool_array(&model->pool, sources, sizeof *model->measured);
    model->measures = se3di_iopool_array(&model->pool, measures, sizeof *model->measures);
    if (!model->measured || !model->measures) {
        return se3di_reader_fail_memory(reader);
    }
    for (size_t k = 0; k < sources; ++k) {
        if (!read_number_of(reader, study->sources[k], &model->measured[k])) {
            return false;
        }
    }
    for (size_t k = 0; k < measures; ++k) {
        model->measures[k] = study->measures[k];
        if (reader->study && !read_again(reader, &model->measures[k])) {
            return false;
        }
    }
    return true;
}

/* A source, once however many measures are made of it. */
static size_t add_source(se3di_study_entry *entry, const se3di_node *node)
{
    size_t k = 0;
    while (k < entry->source_count && strcmp(entry->sources[k]->text, node->text) != 0) {
        ++k;
    }
    entry->sources[k] = node;
    entry->source_count += k == entry->source_count;
    return k;
}

/* The key that says which measure it is: exactly one. */
static bool find_reduction(se3di_reader *reader, const se3di_node *node, se3di_study_measure *m,
                           const se3di_node **found)
{
    *found = NULL;
    for (size_t k = 0; k < SE3DI_REDUCE_EXPRESSION; ++k) {
        const se3di_node *child = se3di_node_get(node, measure_keys[k].key);
        if (child && *found) {
            return se3di_reader_fail(reader, child, "`%s` is there already, one measure has one",
                                     (*found)->key);
        }
        if (child) {
            *found = child;
            m->reduction = (se3di_reduction)k;
        }
    }
    return *found || se3di_reader_fail(reader, node,
                                       "must have one of max, min, range, mean, rms, integral, "
                                       "initial, final, at, settling, time_of, frequency, "
                                       "damping, misfit");
}

/* Keys that belong to one reduction only. */
static bool check_belongings(se3di_reader *reader, const se3di_node *node,
                             const se3di_study_measure *m)
{
    static const struct {
        const char *key;
        se3di_reduction of;
    } table[] = {{"time", SE3DI_REDUCE_AT},       {"event", SE3DI_REDUCE_AT},
                 {"band", SE3DI_REDUCE_SETTLING}, {"target", SE3DI_REDUCE_SETTLING},
                 {"along", SE3DI_REDUCE_MISFIT},  {"curve", SE3DI_REDUCE_MISFIT}};
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        const se3di_node *child = se3di_node_get(node, table[k].key);
        if (child && m->reduction != table[k].of) {
            return se3di_reader_fail(reader, child, "belongs to `%s`, not to `%s`",
                                     measure_keys[table[k].of].key, measure_keys[m->reduction].key);
        }
    }
    const bool timed = se3di_node_get(node, "time") != NULL;
    if (m->reduction == SE3DI_REDUCE_AT && timed == (m->event != NULL)) {
        return se3di_reader_fail(reader, node, "`at` needs `time` or `event`, one of them");
    }
    return m->reduction != SE3DI_REDUCE_SETTLING || se3di_node_get(node, "band") ||
           se3di_reader_fail_key(reader, node, "band", "is missing, `settling` needs it");
}

/* The curve that a channel is to follow, and what its x is. */
static bool read_wanted(se3di_reader *reader, const se3di_node *node, se3di_study_entry *entry,
                        se3di_study_measure *m)
{
    const se3di_node *curve = se3di_node_get(node, "curve");
    const se3di_node *along = se3di_node_get(node, "along");
    const char *text = NULL;
    if (!curve) {
        return se3di_reader_fail_key(reader, node, "curve", "is missing, `misfit` needs it");
    }
    if (curve->kind != SE3DI_NODE_MAP || !se3di_node_get(curve, "linear")) {
        return se3di_reader_fail(reader, curve,
                                 "must be {linear: [[x, y], ...]} or {linear: a.csv}");
    }
    if (!read_points(reader, curve, m) || (along && !se3di_read_text(reader, along, &text))) {
        return false;
    }
    m->along = along ? add_source(entry, along) : SE3DI_STUDY_NO_SOURCE;
    return true;
}

/* The number of a mode: that of the measured analysis is known later. */
static bool read_mode(se3di_reader *reader, const se3di_node *node, const se3di_node *what,
                      se3di_study_measure *m)
{
    m->node = what;
    return read_numbers(reader, m) && check_belongings(reader, node, m) &&
           (m->mode > 0.0 || se3di_reader_fail(reader, what, "is 0, modes are counted from 1"));
}

static bool read_reduction(se3di_reader *reader, const se3di_node *node, se3di_study_entry *entry,
                           se3di_study_measure *m)
{
    const se3di_node *what = NULL;
    const char *text = NULL;
    if (!se3di_read_keys(reader, node, &se3di_object_measure) ||
        !find_reduction(reader, node, m, &what)) {
        return false;
    }
    if (m->reduction == SE3DI_REDUCE_FREQUENCY || m->reduction == SE3DI_REDUCE_DAMPING) {
        return read_mode(reader, node, what, m);
    }
    if (!se3di_read_text(reader, what, &text) || !read_numbers(reader, m) ||
        !check_belongings(reader, node, m)) {
        return false;
    }
    m->has_target = se3di_node_get(node, "target") != NULL;
    if (m->reduction == SE3DI_REDUCE_MISFIT && !read_wanted(reader, node, entry, m)) {
        return false;
    }
    if (m->reduction == SE3DI_REDUCE_TIME_OF) {
        m->event = text;
        return check_event(reader, what, text);
    }
    m->source = add_source(entry, what);
    return !m->event || check_event(reader, se3di_node_get(node, "event"), m->event);
}

/* Compile once with other numbers in the place of the measures above it. */
static bool read_expression(se3di_reader *reader, const se3di_node *node,
                            const se3di_study_entry *entry, se3di_study_measure *m)
{
    const se3di_scope *scope = reader->scope;
    const size_t count = entry->measure_count + scope->symbol_count;
    se3d_expression_symbol *symbols = se3di_iopool_array(reader->pool, count, sizeof *symbols);
    se3d_expression_def def = se3d_expression_def_default();
    se3d_expression *expression = NULL;
    if (!symbols) {
        return se3di_reader_fail_memory(reader);
    }
    for (size_t k = 0; k < entry->measure_count; ++k) {
        symbols[k] = (se3d_expression_symbol){entry->measures[k].name, 0.7 + (double)k};
    }
    for (size_t k = 0; k < scope->symbol_count; ++k) {
        symbols[entry->measure_count + k] = scope->symbols[k];
    }
    def.symbols = symbols;
    def.symbol_count = count;
    m->reduction = SE3DI_REDUCE_EXPRESSION;
    m->node = node;
    const bool good = se3di_read_compile(reader, node, &def, &expression);
    se3d_expression_destroy(expression);
    return good;
}

/* A name that expressions and the table of samples can have. */
static bool check_name(se3di_reader *reader, const se3di_node *node)
{
    bool good = false;
    if (!se3di_reader_try_symbol(reader, node->key, &good)) {
        return false;
    }
    if (!good || strcmp(node->key, "sample") == 0 || strcmp(node->key, "status") == 0) {
        return se3di_reader_fail(reader, node,
                                 "the name is not allowed: letters, digits and _, not beginning "
                                 "with a digit, and not sample, status, or the name of a constant "
                                 "or function");
    }
    return !se3di_scope_find(reader->scope, node->key) ||
           se3di_reader_fail(reader, node,
                             "is also a parameter or point of the model, a measure "
                             "needs a name of its own");
}

static bool read_measures(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry)
{
    if (map->kind != SE3DI_NODE_MAP || map->count == 0 || map->count > SE3DI_STUDY_MEASURES_MAX) {
        return se3di_reader_fail(reader, map,
                                 "is %s, must be a map of 1 to %d measures such as "
                                 "{top: {max: bar.position.z}}",
                                 map->kind != SE3DI_NODE_MAP ? se3di_node_describe(map)
                                 : map->count == 0           ? "empty"
                                                             : "too long",
                                 (int)SE3DI_STUDY_MEASURES_MAX);
    }
    entry->measures = se3di_iopool_array(reader->pool, map->count, sizeof *entry->measures);
    entry->sources = se3di_iopool_array(reader->pool, 2 * map->count, sizeof *entry->sources);
    if (!entry->measures || !entry->sources) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *node = map->first; node; node = node->next) {
        se3di_study_measure *m = &entry->measures[entry->measure_count];
        m->name = node->key;
        m->map = node->kind == SE3DI_NODE_MAP ? node : NULL;
        m->source = SE3DI_STUDY_NO_SOURCE;
        if (!check_name(reader, node) ||
            !(node->kind == SE3DI_NODE_MAP ? read_reduction(reader, node, entry, m)
                                           : read_expression(reader, node, entry, m))) {
            return false;
        }
        ++entry->measure_count;
    }
    return se3di_read_measured(reader, entry);
}

/* ---- samples ---------------------------------------------------------------------------------*/

/* All combinations of lists and ranges. */
static bool count_grid(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry)
{
    const se3di_node *node = se3di_node_get(map, "parameters");
    entry->samples = 1.0;
    if (se3di_node_get(map, "samples")) {
        return se3di_reader_fail_key(reader, map, "samples",
                                     "is not for a grid, whose parameters say how many: give "
                                     "`method: monte_carlo`, latin_hypercube or sobol");
    }
    node = node->first;
    for (size_t k = 0; k < entry->variable_count; ++k, node = node->next) {
        const se3di_study_variable *v = &entry->variables[k];
        if (v->distribution > SE3DI_DISTRIBUTION_RANGE || v->count == 0) {
            return se3di_reader_fail(reader, node,
                                     "a grid needs {from, to, count} or a list of values; a "
                                     "distribution needs `samples`");
        }
        entry->samples *= (double)v->count;
    }
    return entry->samples <= SAMPLES_MAX ||
           se3di_reader_fail(reader, map, "has %g samples, at most %g are allowed", entry->samples,
                             SAMPLES_MAX);
}

static bool count_samples(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry)
{
    const se3di_node *node = se3di_node_get(map, "samples");
    if (node && !(entry->samples > 0.0)) {
        return se3di_reader_fail(reader, node, "is 0, must be at least 1");
    }
    if (!se3di_node_get(map, "method") && node) {
        entry->method = SE3DI_STUDY_MONTE_CARLO;
    }
    if (entry->method == SE3DI_STUDY_GRID) {
        return count_grid(reader, map, entry);
    }
    if (!node) {
        return se3di_reader_fail_key(reader, map, "samples", "is missing: how many samples are %s?",
                                     methods[entry->method]);
    }
    return entry->method != SE3DI_STUDY_SOBOL || entry->variable_count <= SOBOL_PARAMETERS_MAX ||
           se3di_reader_fail_key(reader, map, "method",
                                 "is sobol with %zu parameters, at most %d are allowed: give "
                                 "latin_hypercube",
                                 entry->variable_count, (int)SOBOL_PARAMETERS_MAX);
}

/* What lays out samples is for nothing. */
static bool check_no_samples(se3di_reader *reader, const se3di_node *map)
{
    static const char *const others[] = {"method", "samples", NULL};
    for (size_t k = 0; others[k]; ++k) {
        if (se3di_node_get(map, others[k])) {
            return se3di_reader_fail_key(reader, map, others[k],
                                         "is for `parameters` that vary, and there are none");
        }
    }
    return true;
}

static bool read_samples(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry)
{
    const se3di_node *parameters = se3di_node_get(map, "parameters");
    static const char *const others[] = {"parameters", "method", "samples", NULL};
    const bool is_other = se3di_node_get(map, "sensitivities") || se3di_node_get(map, "optimize");
    if (!parameters && !entry->table && is_other) {
        return check_no_samples(reader, map);
    }
    if (!parameters && !entry->table) {
        return se3di_reader_fail_key(reader, map, "parameters",
                                     "is missing: which parameters vary? {m: [1, 2, 3]}");
    }
    if (!entry->table) {
        return se3di_read_study_variables(reader, parameters, entry) &&
               count_samples(reader, map, entry);
    }
    for (size_t k = 0; others[k]; ++k) {
        if (se3di_node_get(map, others[k])) {
            return se3di_reader_fail_key(reader, map, others[k],
                                         "is not for a `table`, which has the samples");
        }
    }
    entry->method = SE3DI_STUDY_TABLE;
    return se3di_read_study_table(reader, map, entry);
}

/* ---- the whole -------------------------------------------------------------------------------*/

static bool check_analysis(se3di_reader *reader, const se3di_node *map, se3di_study_entry *entry)
{
    const se3d_model *model = reader->model;
    const se3di_node *node = se3di_node_get(map, "analysis");
    const size_t number = (size_t)entry->analysis;
    if (node && (number == 0 || number > model->analysis_count)) {
        return se3di_reader_fail(reader, node, "is %s, must be from 1 to %zu", node->text,
                                 model->analysis_count);
    }
    return true;
}

/* Frequencies are those of an analysis of modes. */
static bool check_modes(se3di_reader *reader, const se3di_study_entry *entry)
{
    const se3d_model *model = reader->model;
    const size_t number = entry->analysis > 0.0 ? (size_t)entry->analysis : model->analysis_count;
    const bool has_modes = number > 0 && model->analyses[number - 1].modes.file;
    for (size_t k = 0; k < entry->measure_count && !has_modes; ++k) {
        const se3di_study_measure *m = &entry->measures[k];
        if (m->mode > 0.0) {
            return se3di_reader_fail(reader, m->node,
                                     "the analysis that is measured must be of type modes; "
                                     "`analysis` of the study names one by its number");
        }
    }
    return true;
}

static const char *copy_text(se3di_reader *reader, const char *text, bool *good)
{
    const char *copy = text ? se3di_iopool_copy(reader->pool, text, strlen(text)) : NULL;
    *good = *good && (copy || !text);
    return copy;
}

/* The options, for the readings of the samples. */
static bool copy_options(se3di_reader *reader, se3d_model_options *to)
{
    const se3d_model_options *from = reader->options;
    bool good = true;
    *to = *from;
    to->allocator = NULL;
    to->report = NULL;
    to->log = NULL;
    to->analysis = copy_text(reader, from->analysis, &good);
    to->formulation = copy_text(reader, from->formulation, &good);
    to->method = copy_text(reader, from->method, &good);
    to->step = copy_text(reader, from->step, &good);
    to->duration = copy_text(reader, from->duration, &good);
    to->tolerance = copy_text(reader, from->tolerance, &good);
    se3d_model_setting *settings =
        se3di_iopool_array(reader->pool, from->setting_count, sizeof *settings);
    to->settings = settings;
    for (size_t k = 0; k < from->setting_count && settings; ++k) {
        settings[k].name = copy_text(reader, from->settings[k].name, &good);
        settings[k].value = copy_text(reader, from->settings[k].value, &good);
    }
    return (good && settings) || se3di_reader_fail_memory(reader);
}

bool se3di_read_study(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *map = se3di_node_get(root, "study");
    if (!map || se3di_node_is_null(map)) {
        return true;
    }
    se3di_study_entry *entry = se3di_iopool_alloc(reader->pool, sizeof *entry);
    if (!entry) {
        return se3di_reader_fail_memory(reader);
    }
    const se3di_object *object = &se3di_object_study;
    if (!se3di_read_keys(reader, map, object) ||
        !se3di_read_fields(reader, map, object, NULL, "se3di_study_entry", entry) ||
        !se3di_read_key(reader, map, object, NULL, "samples", &entry->samples) ||
        !se3di_read_key(reader, map, object, NULL, "seed", &entry->seed) ||
        !se3di_read_key(reader, map, object, NULL, "analysis", &entry->analysis) ||
        !read_samples(reader, map, entry) || !check_analysis(reader, map, entry)) {
        return false;
    }
    const se3di_node *measures = se3di_node_get(map, "measures");
    if (!measures) {
        return se3di_reader_fail_key(reader, map, "measures",
                                     "is missing: what is measured? {top: {max: bar.position.z}}");
    }
    if (!read_measures(reader, measures, entry) || !check_modes(reader, entry) ||
        !se3di_read_study_goal(reader, se3di_node_get(map, "optimize"), entry) ||
        !se3di_read_study_sensitivities(reader, se3di_node_get(map, "sensitivities"), entry) ||
        !copy_options(reader, &entry->options)) {
        return false;
    }
    reader->model->study = entry;
    return true;
}
