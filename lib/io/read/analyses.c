/* SPDX-License-Identifier: BSD-3-Clause */
/* `analysis`. */
#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/modes.h"
#include "io/read/sections.h"

static const char *const types[] = {
    "assembly", "kinematics", "inverse_dynamics", "dynamics", "equilibrium", "modes", NULL};
#define STEP_MIN       1e-15 /* s */
#define STEP_DEFAULT   1e-3  /* s, of methods with fixed steps */
#define STEPS_MAX      1e9   /* where the file says nothing */
#define STEPS_MAX_MOST 1e15
#define TIME_MAX       1e9 /* s, thirty years */
#define WORDS_MOST     32

enum { TYPE_MODES = 5 }; /* the others are se3d_analysis */

/* A value that an option of the command line gives, in place of the file's. */
static const se3di_node *replaced(se3di_reader *reader, const se3di_node *node, const char *option,
                                  const char *text)
{
    if (!text) {
        return node;
    }
    se3di_node *made = se3di_iopool_alloc(reader->pool, sizeof *made);
    if (made) {
        made->kind = SE3DI_NODE_SCALAR;
        made->key = option;
        made->text = text;
    }
    return made;
}

/* The words of a list in the core, by number, with a NULL behind the last. */
static void list_words(const char *(*name_of)(int32_t), const char *words[WORDS_MOST + 1])
{
    int32_t count = 0;
    for (; count < WORDS_MOST && *name_of(count); ++count) {
        words[count] = name_of(count);
    }
    words[count] = NULL;
}

static bool read_words(se3di_reader *reader, const se3di_node *node, se3di_analysis_entry *entry,
                       int32_t *chosen)
{
    se3d_solver_def *solver = &entry->solver;
    const se3d_model_options *options = reader->options;
    const se3di_node *type =
        replaced(reader, se3di_node_get(node, "type"), "--analysis", options->analysis);
    const se3di_node *formulation = replaced(reader, se3di_node_get(node, "formulation"),
                                             "--formulation", options->formulation);
    const se3di_node *method =
        replaced(reader, se3di_node_get(node, "method"), "--method", options->method);
    const char *words[WORDS_MOST + 1];
    size_t word = SE3D_ANALYSIS_DYNAMICS;
    if (node && !type) {
        return se3di_reader_fail_key(reader, node, "type",
                                     "is missing, must be one of: assembly, kinematics, "
                                     "inverse_dynamics, dynamics, equilibrium, modes");
    }
    if (type && !se3di_read_word(reader, type, types, &word)) {
        return false;
    }
    entry->analysis.type = types[word];
    solver->analysis = word == TYPE_MODES ? SE3D_ANALYSIS_EQUILIBRIUM : (int32_t)word;
    word = SE3D_FORMULATION_ROMEGA;
    list_words(se3d_formulation_get_name, words);
    if (formulation && !se3di_read_word(reader, formulation, words, &word)) {
        return false;
    }
    solver->formulation = (int32_t)word;
    word = SE3D_METHOD_AUTO;
    list_words(se3d_method_get_name, words);
    if (method && !se3di_read_word(reader, method, words, &word)) {
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
    tried.method = method;
    const se3d_status status = se3d_solver_create(reader->system, &tried, &made);
    se3d_solver_destroy(made);
    if (status < 0 && node) {
        return se3di_reader_fail_system(reader, node, status);
    }
    return status >= 0 || se3di_reader_fail(reader, reader->model->root, "%s",
                                            se3d_system_get_error(reader->system));
}

static bool read_numbers(se3di_reader *reader, const se3di_node *node, se3d_solver_def *solver)
{
    const se3di_node *step =
        replaced(reader, se3di_node_get(node, "step"), "--step", reader->options->step);
    const se3di_node *tolerance = replaced(reader, se3di_node_get(node, "tolerance"), "--tolerance",
                                           reader->options->tolerance);
    double order = 0.0;
    double iterations = 25.0;
    double steps = STEPS_MAX;
    if ((step && !se3di_read_number(reader, step, SE3DI_POSITIVE, &solver->step)) ||
        (tolerance && !se3di_read_number(reader, tolerance, SE3DI_POSITIVE, &solver->tolerance)) ||
        !se3di_read_key_number(reader, node, "spectral_radius", SE3DI_ANY,
                               &solver->spectral_radius) ||
        !se3di_read_key_number(reader, node, "alpha", SE3DI_ANY, &solver->alpha) ||
        !se3di_read_key_count(reader, node, "order", 20.0, &order) ||
        !se3di_read_key_count(reader, node, "iterations_max", 1e6, &iterations) ||
        !se3di_read_key_count(reader, node, "steps_max", STEPS_MAX_MOST, &steps)) {
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
    if (step && solver->step < STEP_MIN) {
        return se3di_reader_fail(reader, step, "is %g, must be at least %g [s]", solver->step,
                                 STEP_MIN);
    }
    solver->order = reader->options->method ? 0 : (int32_t)order; /* the order of another method */
    solver->iterations_max = (size_t)iterations;
    solver->steps_max = (uint64_t)steps;
    return true;
}

static bool has_fixed_steps(int32_t method)
{
    return method == SE3D_METHOD_GENERALIZED_ALPHA || method == SE3D_METHOD_HHT ||
           method == SE3D_METHOD_RATTLE || method == SE3D_METHOD_VERLET;
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
        return se3di_reader_fail_key(reader, node ? node : reader->model->root, "step",
                                     "is %g s, which does not move the time %g s on", step, end);
    }
    return true;
}

static bool read_times(se3di_reader *reader, const se3di_node *node, se3di_analysis_entry *entry)
{
    const se3di_node *duration =
        replaced(reader, se3di_node_get(node, "duration"), "--duration", reader->options->duration);
    entry->analysis.start = (double)NAN;
    if (!se3di_read_key_number(reader, node, "start", SE3DI_ANY, &entry->analysis.start)) {
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
    if ((node && !se3di_read_keys(reader, node, SE3DI_OBJECT_ANALYSIS)) ||
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
