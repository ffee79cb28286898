/* SPDX-License-Identifier: BSD-3-Clause */
/* `analysis`. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/modes.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

#define STEP_MIN       1e-15 /* s */
#define TOLERANCE_MIN  1e-14 /* as of se3d_solver_def, */
#define TOLERANCE_MAX  0.1   /* but for 0, which asks for the default */
#define STEP_DEFAULT   1e-3  /* s, of methods with fixed steps */
#define STEPS_MAX      1e9   /* if the file says nothing */
#define STEPS_MAX_MOST 1e15
#define TIME_MAX       1e9 /* s, thirty years */

static const char modes[] = "modes";

/* What is behind the last analysis of the library: those about an equilibrium. */
static const char *const others[] = {modes, NULL};

/* clang-format off */
static const se3di_key analysis_keys[] = {
    {"type", SE3DI_KIND_WORD, .name_of = se3d_analysis_get_name, .words = others,
     .required = true, .text = ""},
    {"formulation", SE3DI_KIND_WORD, .name_of = se3d_formulation_get_name, .standard = "auto",
     .text = "what describes the motion: angular velocities, Euler parameters, or coordinates of "
         "joints (dop853, gauss, rk45, rk4; elsewhere as romega); auto: joint where a method above "
         "integrates joints, no friction needs the load of one and loops leave a freedom, else "
         "romega"},
    {"method", SE3DI_KIND_WORD, .name_of = se3d_method_get_name, .standard = "auto",
     .text = "of dynamics; convex: for many bodies that touch, at steps of 0.001 to 0.005; "
         "gauss: smooth motions, to tight tolerances; "
         "auto: verlet with particles, convex from where ten free bodies or more are at others, if "
         "nothing else acts on them but constant gravity, no tolerance is given and no step above "
         "0.005, radau if a damper's decay is 20000 times faster than the motion (and 1000 times "
         "as joints hold its bodies), gauss where nothing but constant gravity acts on an open "
         "tree of joints or on loops of plane pins and balls, else dop853; both are left for radau "
         "if stability limits their steps, radau for them where steps of its length would be "
         "stable and nothing touches, dop853 and radau for convex if three free bodies or more, "
         "or some on a mesh, may touch and contacts alone limit the steps to below 5e-5 "
         "(2e-4 of many bodies), or by radau to so short ones that it is several times slower than "
         "what happens (docs/theory/convex.md)"},
    {"order", SE3DI_KIND_COUNT, .most = 20.0, .standard = "chosen",
     .text = "of bdf (1 to 5), rattle (2, 4) and gauss (8, 16)"},
    {"step", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     .standard = "chosen by the error; rattle and verlet choose equal steps; convex: 0.001, or by "
         "the error if there is a tolerance",
     .text = "the fixed step of generalized_alpha, hht, rattle, verlet, convex, or the largest one "
         "[s]"},
    {"tolerance", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     .text = "relative error, 1e-14 to 0.1, replaced by --tolerance; a method works at the least "
         "tolerance that it can reach: dop853, gauss, rk45, rk4 7e-12, bdf 1e-11, radau 1e-13 "
         "(1e-10 with redundant equations), generalized_alpha, hht 1e-11, rattle, verlet 1e-10 "
         "(rattle of order 4: 1e-11), convex 1e-6, and the report says so"},
    {"duration", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     .text = "[s], at most 1e9; required in kinematics, inverse_dynamics and dynamics"},
    {"start", SE3DI_KIND_NUMBER, .standard = "the end of the analysis before, 0 for the first",
     .text = "[s], -1e9 to 1e9"},
    {"spectral_radius", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_solver_def, spectral_radius),
     .text = "of generalized_alpha: at infinite frequency, 0 to 1"},
    {"alpha", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_solver_def, alpha), .text = "of hht: -1/3 to 0"},
    {"sleep", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_solver_def, sleep), .standard = "false",
     .text = "of convex: bodies that have been at rest for .25 s with all that they touch cost "
         "nothing until something touches them"},
    {"iterations_max", SE3DI_KIND_COUNT, .most = 1e6, .standard = "25",
     .text = "Newton iterations a step, 1 to 1000000"},
    {"steps_max", SE3DI_KIND_COUNT, .most = STEPS_MAX_MOST, .standard = "1e9",
     .text = "steps that it may take, 1 to 1e15: fixed steps are counted beforehand; any "
         "method is given up, with a message, as soon as its pace shows that it would take more"},
    {"file", SE3DI_KIND_FILE, .standard = "modes.csv",
     .text = "of modes: where they are written"},
    {"inputs", SE3DI_KIND_LIST, .object = "modes_input",
     .text = "of modes: forces and torques, for the matrices and transfer functions"},
    {"outputs", SE3DI_KIND_LIST, .object = "modes_output",
     .text = "of modes: components of the motion"},
    {"frequencies", SE3DI_KIND_OBJECT, .object = "frequencies",
     .text = "of modes: of the transfer functions"},
    {"count", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .standard = "all",
     .text = "of modes: only so many of the lowest frequencies, without `inputs` and `outputs`"},
    {.key = NULL}};
const se3di_object se3di_object_analysis = {
    "analysis",
    "One analysis.",
    analysis_keys, NULL,
    NULL};
/* clang-format on */

/* The text that an option of the command line gives in place of a key of the file, and the option;
 * NULL: none is given, or can be. */
static const char *option_text(const se3d_model_options *o, const char *key, const char **option)
{
    const struct {
        const char *key, *option, *text;
    } table[] = {
        {"type", "--analysis", o->analysis},
        {"formulation", "--formulation", o->formulation},
        {"method", "--method", o->method},
        {"step", "--step", o->step},
        {"tolerance", "--tolerance", o->tolerance},
        {"duration", "--duration", o->duration},
    };
    for (size_t k = 0; k < sizeof table / sizeof *table; ++k) {
        if (strcmp(table[k].key, key) == 0) {
            *option = table[k].option;
            return table[k].text;
        }
    }
    return NULL;
}

/* *value: of an option, else of the file; NULL: not given. */
static bool get_value(se3di_reader *reader, const se3di_node *node, const char *key,
                      const se3di_node **value)
{
    const char *option = NULL;
    const char *text = option_text(reader->options, key, &option);
    *value = text ? se3di_node_of_text(reader->pool, option, text) : se3di_node_get(node, key);
    return !text || *value || se3di_reader_fail_memory(reader);
}

/* Blames the option or the key that says it, or the place where the key is missing. */
static bool fail_value(se3di_reader *reader, const se3di_node *node, const char *key,
                       const char *text)
{
    const se3di_node *value;
    if (!get_value(reader, node, key, &value)) {
        return false;
    }
    return value
               ? se3di_reader_fail(reader, value, "%s", text)
               : se3di_reader_fail_key(reader, node ? node : reader->model->root, key, "%s", text);
}

static void list_words(const char *key, const char *words[SE3DI_WORDS_MAX + 1])
{
    se3di_key_list_words(se3di_object_find(&se3di_object_analysis, NULL, key), words);
}

/* A word of a row, wherever it stands. */
static bool read_word(se3di_reader *reader, const se3di_node *node, const char *key, size_t *word)
{
    const char *words[SE3DI_WORDS_MAX + 1];
    list_words(key, words);
    return se3di_read_word(reader, node, words, word);
}

static bool fail_missing_type(se3di_reader *reader, const se3di_node *node)
{
    const char *words[SE3DI_WORDS_MAX + 1];
    char list[256] = "";
    size_t used = 0;
    list_words("type", words);
    for (size_t k = 0; words[k] && used < sizeof list; ++k) {
        used +=
            (size_t)snprintf(list + used, sizeof list - used, "%s%s", k > 0 ? ", " : "", words[k]);
    }
    return se3di_reader_fail_key(reader, node, "type", "is missing, must be one of: %s", list);
}

static bool read_words(se3di_reader *reader, const se3di_node *node, se3di_analysis_entry *entry,
                       int32_t *chosen)
{
    se3d_solver_def *solver = &entry->solver;
    const se3di_node *type, *formulation, *method;
    size_t word = SE3D_ANALYSIS_DYNAMICS;
    if (!get_value(reader, node, "type", &type) ||
        !get_value(reader, node, "formulation", &formulation) ||
        !get_value(reader, node, "method", &method)) {
        return false;
    }
    if (node && !type) {
        return fail_missing_type(reader, node);
    }
    if (type && !read_word(reader, type, "type", &word)) {
        return false;
    }
    const char *const name = se3d_analysis_get_name((int32_t)word);
    entry->analysis.type = *name ? name : modes;
    solver->analysis = entry->analysis.type == modes ? SE3D_ANALYSIS_EQUILIBRIUM : (int32_t)word;
    word = SE3D_FORMULATION_AUTO;
    if (formulation && !read_word(reader, formulation, "formulation", &word)) {
        return false;
    }
    solver->formulation = (int32_t)word;
    word = SE3D_METHOD_AUTO;
    if (method && !read_word(reader, method, "method", &word)) {
        return false;
    }
    *chosen = (int32_t)word;
    solver->method =
        solver->analysis == SE3D_ANALYSIS_DYNAMICS ? (int32_t)word : (int32_t)SE3D_METHOD_AUTO;
    return true;
}

/* What the library says of the settings; `method` is the one of the file or of an option, which
 * analyses other than dynamics do not use. */
static bool check_solver(se3di_reader *reader, const se3di_node *node,
                         const se3d_solver_def *solver, int32_t method)
{
    se3d_solver_def tried = *solver;
    se3d_solver *made = NULL;
    const char *option;
    tried.method = method;
    const se3d_status status = se3d_solver_create(reader->system, &tried, &made);
    se3d_solver_destroy(made);
    if (status >= 0) {
        return true;
    }
    const char *message = se3d_system_get_error(reader->system);
    const char *field = se3d_system_get_error_field(reader->system);
    const size_t length = strlen(field);
    if (status == SE3D_ERR_NO_MEMORY) {
        return se3di_reader_fail_memory(reader);
    }
    if (option_text(reader->options, field, &option) && strncmp(message + length, " = ", 3) == 0) {
        char text[300];
        snprintf(text, sizeof text, "is %s", message + length + 3);
        return fail_value(reader, node, field, text);
    }
    return node ? se3di_reader_fail_system(reader, node, status)
                : se3di_reader_fail(reader, reader->model->root, "%s", message);
}

static bool read_step(se3di_reader *reader, const se3di_node *node, double *value)
{
    const se3di_node *step;
    if (!get_value(reader, node, "step", &step) ||
        (step && !se3di_read_number(reader, step, SE3DI_POSITIVE, value))) {
        return false;
    }
    return !step || *value >= STEP_MIN ||
           se3di_reader_fail(reader, step, "is %g, must be at least %g [s]", *value, STEP_MIN);
}

static bool read_tolerance(se3di_reader *reader, const se3di_node *node, double *value)
{
    const se3di_node *tolerance;
    if (!get_value(reader, node, "tolerance", &tolerance) ||
        (tolerance && !se3di_read_number(reader, tolerance, SE3DI_ANY, value))) {
        return false;
    }
    return !tolerance || (*value >= TOLERANCE_MIN && *value <= TOLERANCE_MAX) ||
           se3di_reader_fail(reader, tolerance, "is %g, must be from %g to %g", *value,
                             TOLERANCE_MIN, TOLERANCE_MAX);
}

static bool read_numbers(se3di_reader *reader, const se3di_node *node, se3d_solver_def *solver)
{
    const se3di_object *object = &se3di_object_analysis;
    double order = 0.0;
    double iterations = 25.0;
    double steps = STEPS_MAX;
    if (!read_step(reader, node, &solver->step) ||
        !read_tolerance(reader, node, &solver->tolerance) ||
        !se3di_read_fields(reader, node, object, NULL, "se3d_solver_def", solver) ||
        !se3di_read_key(reader, node, object, NULL, "order", &order) ||
        !se3di_read_key(reader, node, object, NULL, "iterations_max", &iterations) ||
        !se3di_read_key(reader, node, object, NULL, "steps_max", &steps)) {
        return false;
    }
    if (steps < 1.0) {
        return se3di_reader_fail_key(reader, node, "steps_max",
                                     "is 0, must be a whole number from 1 to 1e15");
    }
    if (iterations < 1.0) {
        return se3di_reader_fail_key(reader, node, "iterations_max",
                                     "is 0, must be a whole number from 1 to 1000000");
    }
    solver->order = reader->options->method ? 0 : (int32_t)order; /* the order of another method */
    solver->iterations_max = (size_t)iterations;
    solver->steps_max = (uint64_t)steps;
    return true;
}

static bool has_fixed_steps(int32_t method)
{
    return method == SE3D_METHOD_GENERALIZED_ALPHA || method == SE3D_METHOD_HHT ||
           method == SE3D_METHOD_RATTLE || method == SE3D_METHOD_VERLET ||
           method == SE3D_METHOD_CONVEX;
}

/* Times that are too long, too fine or too many. */
static bool check_times(se3di_reader *reader, const se3di_node *node, const se3di_node *duration,
                        const se3di_analysis_entry *entry)
{
    const double length = entry->analysis.duration;
    const double step = entry->solver.step > 0.0                ? entry->solver.step
                        : has_fixed_steps(entry->solver.method) ? STEP_DEFAULT
                                                                : 0.0;
    const double end = length + (isnan(entry->analysis.start) ? 0.0 : entry->analysis.start);
    if (length > 0.0 && length < STEP_MIN) {
        return se3di_reader_fail(reader, duration, "is %g, must be 0 or at least %g [s]", length,
                                 STEP_MIN);
    }
    if (length > TIME_MAX) {
        return se3di_reader_fail(reader, duration, "is %g, must be at most %g [s]", length,
                                 TIME_MAX);
    }
    const double most = (double)entry->solver.steps_max;
    if (step > 0.0 && length / step > most) {
        return se3di_reader_fail(reader, duration,
                                 "is %g s, which takes %.3g steps of %g s, must take at most %g: "
                                 "choose a larger `step` or `steps_max`",
                                 length, length / step, step, most);
    }
    if (length > 0.0 && length < 1e-14 * fabs(end)) {
        return se3di_reader_fail(reader, duration, "is %g s, which does not move the time %g s on",
                                 length, end);
    }
    if (length > 0.0 && step > 0.0 && step < 1e-14 * fabs(end)) {
        char text[100];
        snprintf(text, sizeof text, "is %g s, which does not move the time %g s on", step, end);
        return fail_value(reader, node, "step", text);
    }
    return true;
}

static bool read_times(se3di_reader *reader, const se3di_node *node, se3di_analysis_entry *entry)
{
    const se3di_node *duration;
    entry->analysis.start = (double)NAN;
    if (!get_value(reader, node, "duration", &duration) ||
        !se3di_read_key(reader, node, &se3di_object_analysis, NULL, "start",
                        &entry->analysis.start)) {
        return false;
    }
    if (fabs(entry->analysis.start) > TIME_MAX) {
        return se3di_reader_fail_key(reader, node, "start", "is %g, must be from %g to %g [s]",
                                     entry->analysis.start, -TIME_MAX, TIME_MAX);
    }
    if (!duration && se3di_solver_takes_time(&entry->solver)) {
        return se3di_reader_fail_key(reader, node ? node : reader->model->root, "duration",
                                     "is missing, must be finite and >= 0 [s]");
    }
    if (duration &&
        !se3di_read_number(reader, duration, SE3DI_NOT_NEGATIVE, &entry->analysis.duration)) {
        return false;
    }
    if (!se3di_solver_takes_time(&entry->solver)) {
        entry->analysis.duration = 0.0;
    }
    return check_times(reader, node, duration, entry);
}

static bool read_analysis(se3di_reader *reader, const se3di_node *node)
{
    se3di_analysis_entry entry = {.node = node};
    int32_t method = SE3D_METHOD_AUTO;
    entry.solver = se3d_solver_def_default();
    if ((node && !se3di_read_keys(reader, node, &se3di_object_analysis)) ||
        !read_words(reader, node, &entry, &method) || !read_numbers(reader, node, &entry.solver) ||
        !check_solver(reader, node, &entry.solver, method) || !read_times(reader, node, &entry) ||
        !se3di_read_modes(reader, node, &entry)) {
        return false;
    }
    reader->model->analyses[reader->model->analysis_count++] = entry;
    return true;
}

/* With --analysis only entries of that type are run; if there is none, the last one is run as
 * that type. */
static bool is_wanted(const se3di_reader *reader, const se3di_node *list, const se3di_node *node)
{
    const char *wanted = reader->options->analysis;
    bool found = false;
    if (!wanted) {
        return true;
    }
    for (const se3di_node *other = list->first; other; other = other->next) {
        const se3di_node *type = se3di_node_get(other, "type");
        const bool same = type && type->text && strcmp(type->text, wanted) == 0;
        if (other == node && same) {
            return true;
        }
        found = found || same;
    }
    return !found && node == list->last;
}

bool se3di_read_analyses(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *node = se3di_node_get(root, "analysis");
    if (node && se3di_node_is_null(node)) {
        node = NULL;
    }
    const size_t count = node && node->kind == SE3DI_NODE_LIST ? node->count : 1;
    model->analyses = se3di_iopool_array(&model->pool, count, sizeof *model->analyses);
    if (!model->analyses) {
        return se3di_reader_fail_memory(reader);
    }
    if (!node) {
        return !reader->options->analysis || read_analysis(reader, NULL);
    }
    if (node->kind != SE3DI_NODE_LIST) {
        return read_analysis(reader, node);
    }
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (is_wanted(reader, node, child) && !read_analysis(reader, child)) {
            return false;
        }
    }
    return true;
}
