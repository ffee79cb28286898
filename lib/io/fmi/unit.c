/* SPDX-License-Identifier: BSD-3-Clause */
/* The life of a unit. The model is read when an instance is made and whenever a parameter has
 * changed since; its analyses before the last one in which time passes are run whole when the
 * initialization ends, or an output is asked for in it. Between communication points the solver
 * runs as `se3d run` does between rows, so that both have the same bits.
 *
 * A state as bytes has what the caller has set, the snapshot of the system and what the solver
 * knows beside it. When it is put back, elements get their values first: a value that changes ends
 * the step under way, which the snapshot has. Of a driver with a rate they also have where its
 * coordinate was when the rate was set: it goes on from there. */
#include "io/fmi/exchange.h"

#include <float.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/coder.h"
#include "base/hash.h"
#include "io/channel/channel.h"
#include "io/channel/event.h"
#include "io/channel/output.h"
#include "io/channel/sample.h"
#include "io/document/document.h"
#include "io/fmi/before.h"
#include "io/fmi/recipe.h"
#include "io/fmi/states.h"
#include "io/model/settable.h"

enum { TEXT_SIZE = 1600, PATH_SIZE = 4096 };
#define STEP_MIN 1e-15 /* s */

bool se3di_fmi_fail(se3di_fmi_unit *u, const char *format, ...)
{
    char text[TEXT_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (u->tell) {
        u->tell(u->ctx, u->is_discarded ? SE3D_LOG_WARNING : SE3D_LOG_ERROR, text);
    }
    return false;
}

static bool fail_memory(se3di_fmi_unit *u)
{
    return se3di_fmi_fail(u, "out of memory");
}

/* With the system's message, or the text of the status. */
bool se3di_fmi_fail_system(se3di_fmi_unit *u, const char *what, se3d_status status)
{
    const char *why = u->model ? se3d_system_get_error(u->model->system) : "";
    return se3di_fmi_fail(u, "%s: %s", what, why[0] ? why : se3d_status_get_text(status));
}

/* What the system tells; its failures are told by those who meet them. */
static void forward(void *ctx, se3d_log_level level, se3d_log_kind kind, const char *message)
{
    const se3di_fmi_unit *u = ctx;
    if (kind != SE3D_LOG_FAILURE && u->tell && !u->is_quiet) {
        u->tell(u->ctx, level, message);
    }
}

/* ---- the model ------------------------------------------------------------------------------*/

static bool read_recipe(se3di_fmi_unit *u, const char *folder)
{
    char path[PATH_SIZE];
    char *text = NULL;
    size_t length = 0;
    const int used = snprintf(path, sizeof path, "%s/%s", folder, SE3DI_FMI_RECIPE_FILE);
    FILE *file = used > 0 && (size_t)used < sizeof path ? fopen(path, "rb") : NULL;
    if (!file) {
        return se3di_fmi_fail(u, "%.1000s: cannot be opened; the unit needs its resources", path);
    }
    const se3d_status status = se3di_document_read(&u->pool, file, &text, &length);
    fclose(file);
    if (status < 0 || strlen(text) != length ||
        !se3di_fmi_recipe_read(&u->recipe, text, &u->pool)) {
        return se3di_fmi_fail(u, "%.1000s: is not what the resources of this unit have", path);
    }
    const size_t size = strlen(folder) + strlen(u->recipe.model) + 2;
    char *model = se3di_iopool_alloc(&u->pool, size);
    if (!model) {
        return fail_memory(u);
    }
    snprintf(model, size, "%s/%s", folder, u->recipe.model);
    u->path = model;
    u->recipe.options.log = forward;
    u->recipe.options.log_ctx = u;
    return true;
}

static void drop_model(se3di_fmi_unit *u)
{
    se3di_fmi_exchange_drop(u);
    if (u->model) {
        se3di_sample_destroy(&u->sample);
    }
    se3d_solver_destroy(u->solver);
    se3d_model_destroy(u->model);
    u->solver = NULL;
    u->model = NULL;
}

static char *format_value(const se3di_fmi_unit *u, size_t k, se3di_iopool *pool)
{
    char text[SE3DI_FMI_VALUE_SIZE];
    const size_t used = se3di_fmi_format_value(&u->variables.list[k], u->values[k], text);
    return se3di_iopool_copy(pool, text, used);
}

/* The options of the recipe, and the parameters that were set. */
static bool make_options(const se3di_fmi_unit *u, se3di_iopool *pool, se3d_model_options *options)
{
    const size_t most = u->recipe.options.setting_count + u->variables.count;
    se3d_model_setting *settings = se3di_iopool_array(pool, most, sizeof *settings);
    *options = u->recipe.options;
    if (!settings) {
        return false;
    }
    for (size_t k = 0; k < options->setting_count; ++k) {
        settings[k] = options->settings[k];
    }
    options->settings = settings;
    for (size_t k = 0; k < u->variables.count; ++k) {
        if (u->given[k] && u->variables.list[k].role == SE3DI_FMI_PARAMETER) {
            se3d_model_setting *s = &settings[options->setting_count++];
            s->name = u->variables.list[k].parameter;
            s->value = format_value(u, k, pool);
            if (!s->value) {
                return false;
            }
        }
    }
    return true;
}

/* What there is instead of u->model, NULL after a message. */
static se3d_model *read_model(se3di_fmi_unit *u)
{
    se3di_iopool pool;
    se3d_model_options options;
    se3d_model_error error;
    se3d_model *model = NULL;
    se3di_iopool_init(&pool, NULL);
    if (!make_options(u, &pool, &options)) {
        fail_memory(u);
    } else if (SE3D_FAILED(se3d_model_read_file(u->path, &options, &model, &error))) {
        se3di_fmi_fail(u, "%s", error.message);
    }
    se3di_iopool_destroy(&pool);
    return model;
}

static void take_model(se3di_fmi_unit *u, se3d_model *model)
{
    drop_model(u);
    u->model = model;
    se3di_sample_init(&u->sample, model->system, &model->pool.allocator);
    u->shows_all = false;
    for (size_t k = 0; k < u->variables.count; ++k) {
        const se3di_fmi_variable *v = &u->variables.list[k];
        u->shows_all = u->shows_all ||
                       (v->role == SE3DI_FMI_OUTPUT &&
                        !se3di_channel_is_shown(&model->outputs[v->output].channels[v->channel]));
    }
}

/* The value of a variable that is not an output. */
double se3di_fmi_value_of(const se3di_fmi_unit *u, size_t k)
{
    return u->given[k] ? u->values[k] : u->variables.list[k].start;
}

/* Read the model again, with the parameters as they are now. */
static bool renew_model(se3di_fmi_unit *u)
{
    char problem[400];
    se3di_fmi_variables variables;
    se3d_model *model = read_model(u);
    if (!model) {
        return false;
    }
    const se3d_status status =
        se3di_fmi_variables_create(model, &variables, problem, sizeof problem);
    const bool alike = status >= 0 && se3di_fmi_variables_are_alike(&variables, &u->variables);
    if (!alike) {
        se3di_fmi_variables_destroy(&variables);
        se3d_model_destroy(model);
        return status < 0
                   ? se3di_fmi_fail(u, "%s", problem)
                   : se3di_fmi_fail(u,
                                    "with these parameters the model has other variables than the "
                                    "description of the unit lists");
    }
    se3di_fmi_variables_destroy(&u->variables);
    u->variables = variables;
    take_model(u, model);
    u->model_stale = false;
    return true;
}

/* ---- values ---------------------------------------------------------------------------------*/

static se3d_status apply_input(const se3di_fmi_unit *u, size_t k)
{
    return se3di_fmi_apply_input(u->model, &u->variables.list[k], se3di_fmi_value_of(u, k));
}

/* The function of an input that is a rate; null: it is none. */
static se3d_function rate_of(const se3di_fmi_unit *u, size_t k)
{
    const se3di_fmi_variable *v = &u->variables.list[k];
    return v->role == SE3DI_FMI_INPUT ? u->model->elements[v->element].rate : (se3d_function){0, 0};
}

/* Keep since when a rate is as it is, and what its integral was then. */
static se3d_status note_place(se3di_fmi_unit *u, size_t k)
{
    const se3d_function rate = rate_of(u, k);
    return rate.index1
               ? se3di_rate_get_place(u->model, rate, &u->places[2 * k], &u->places[2 * k + 1])
               : SE3D_OK;
}

/* Bring the integral of a rate to where it was. The state of the system is put back afterwards. */
static se3d_status put_place(const se3di_fmi_unit *u, size_t k)
{
    return se3di_rate_put_place(u->model, rate_of(u, k), u->places[2 * k], u->places[2 * k + 1],
                                se3di_fmi_value_of(u, k));
}

/* All inputs that were ever set. */
static bool apply_inputs(se3di_fmi_unit *u)
{
    for (size_t k = 0; k < u->variables.count; ++k) {
        if (u->variables.list[k].role == SE3DI_FMI_INPUT) {
            se3d_status status = u->given[k] ? apply_input(u, k) : SE3D_OK;
            status = status < 0 ? status : note_place(u, k);
            if (status < 0) {
                return se3di_fmi_fail_system(u, u->variables.list[k].name, status);
            }
        }
    }
    return true;
}

/* ---- running --------------------------------------------------------------------------------*/

static bool fail_run(se3di_fmi_unit *u, se3d_status status, const char *type)
{
    char what[200];
    double now = u->time;
    se3d_system_get_time(u->model->system, &now);
    snprintf(what, sizeof what, "the %.40s analysis failed at t = %.9g s", type, now);
    u->mode = SE3DI_FMI_FAILED;
    return se3di_fmi_fail_system(u, what, status);
}

/* The analyses before the one of the unit. */
static bool run_before(se3di_fmi_unit *u)
{
    size_t at = 0;
    double end = 0.0; /* the caller says when the unit begins */
    const se3d_status status = se3di_fmi_run_before(u->model, u->analysis, NULL, NULL, &end, &at);
    return status >= 0 || fail_run(u, status, u->model->analyses[at].analysis.type);
}

static double start_of(const se3di_fmi_unit *u)
{
    return isnan(u->start) ? se3di_fmi_get_start(u->model, u->analysis) : u->start;
}

static double end_of(const se3di_fmi_unit *u)
{
    return isnan(u->stop) ? start_of(u) + u->model->analyses[u->analysis].analysis.duration
                          : u->stop;
}

static bool make_solver(se3di_fmi_unit *u)
{
    const se3di_analysis_entry *entry = &u->model->analyses[u->analysis];
    se3d_solver_def def = entry->solver;
    const double end = end_of(u);
    def.horizon = fabs(end) > 0.0 ? end : DBL_MIN; /* 0 means none */
    if (!isnan(u->tolerance)) {
        def.tolerance = fmin(fmax(u->tolerance, 1e-14), 0.1);
    }
    se3d_solver_destroy(u->solver);
    u->solver = NULL;
    se3d_status status = se3d_solver_create(u->model->system, &def, &u->solver);
    if (status >= 0 && !u->exchange) { /* else the caller looks for events */
        status = se3di_events_create(u->model, u->solver, NULL, NULL);
    }
    return status < 0 ? fail_run(u, status, entry->analysis.type) : true;
}

/* To a time; what is not asked for is computed at the end only, as se3d_model_run does. */
static bool run_to(se3di_fmi_unit *u, double time)
{
    const bool all = u->shows_all || time >= end_of(u);
    se3d_status status = se3d_solver_set_shown(u->solver, all ? SE3D_SHOWN_ALL : SE3D_SHOWN_MOTION);
    status = status < 0 ? status : se3d_solver_run(u->solver, time);
    memset(&u->stats, 0, sizeof u->stats);
    se3d_solver_get_stats(u->solver, &u->stats);
    se3di_sample_renew(&u->sample, &u->stats);
    if (status < 0) {
        se3d_system_get_time(u->model->system, &u->time);
        return fail_run(u, status, u->model->analyses[u->analysis].analysis.type);
    }
    u->state_stale = false;
    u->time = time;
    if (status == SE3D_INFO_EVENT) {
        se3d_system_get_time(u->model->system, &u->time);
        u->mode = SE3DI_FMI_ENDED;
        if (u->tell) {
            u->tell(u->ctx, SE3D_LOG_INFO, "an event of the model has ended it");
        }
    }
    return true;
}

/* The state at the start, or with the inputs as they are now. */
bool se3di_fmi_refresh(se3di_fmi_unit *u)
{
    if (u->model_stale && !renew_model(u)) {
        return false;
    }
    if (u->solver && u->exchange && u->exchange->coordinates) {
        return se3di_fmi_exchange_update(u);
    }
    if (u->solver) {
        return !u->state_stale || run_to(u, u->time);
    }
    u->time = start_of(u);
    if (!apply_inputs(u) || !run_before(u)) {
        return false;
    }
    const se3d_status status = se3d_system_set_time(u->model->system, u->time);
    if (status < 0) {
        return fail_run(u, status, "first");
    }
    return make_solver(u) && run_to(u, u->time) && (!u->exchange || se3di_fmi_exchange_begin(u));
}

/* ---- life -----------------------------------------------------------------------------------*/

static bool begin_values(se3di_fmi_unit *u)
{
    u->values = se3di_iopool_array(&u->pool, u->variables.count, sizeof *u->values);
    u->given = se3di_iopool_array(&u->pool, u->variables.count, sizeof *u->given);
    u->places = se3di_iopool_array(&u->pool, u->variables.count, 2 * sizeof *u->places);
    return (u->values && u->given && u->places) || fail_memory(u);
}

static bool read_all(se3di_fmi_unit *u, const char *folder, const char *token)
{
    char problem[400];
    if (!read_recipe(u, folder)) {
        return false;
    }
    u->variables.count = 0;
    se3d_model *model = read_model(u);
    if (!model) {
        return false;
    }
    const se3d_status status =
        se3di_fmi_variables_create(model, &u->variables, problem, sizeof problem);
    take_model(u, model);
    if (status < 0) {
        return se3di_fmi_fail(u, "%s", problem);
    }
    se3di_fmi_find_analysis(model, &u->analysis);
    se3di_fmi_make_token(model, &u->variables, u->token);
    if (token && strcmp(token, u->token) != 0) {
        return se3di_fmi_fail(
            u,
            "the description has %.60s, the resources of the unit are of %s: they do not "
            "belong together",
            token, u->token);
    }
    return begin_values(u);
}

static void forget(se3di_fmi_unit *u)
{
    u->mode = SE3DI_FMI_INSTANTIATED;
    u->start = (double)NAN;
    u->stop = (double)NAN;
    u->tolerance = (double)NAN;
    u->state_stale = false;
}

se3di_fmi_unit *se3di_fmi_unit_create(const char *folder, const char *token, bool exchanges,
                                      se3di_fmi_tell tell, void *ctx)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    se3di_fmi_unit *u = se3di_iopool_alloc(&pool, sizeof *u);
    if (!u) {
        se3di_iopool_destroy(&pool);
        return NULL;
    }
    u->pool = pool;
    u->tell = tell;
    u->ctx = ctx;
    forget(u);
    if (!read_all(u, folder, token) || (exchanges && !se3di_fmi_exchange_create(u))) {
        se3di_fmi_unit_destroy(u);
        return NULL;
    }
    u->time = start_of(u);
    return u;
}

void se3di_fmi_unit_destroy(se3di_fmi_unit *unit)
{
    if (unit) {
        se3di_iopool pool = unit->pool;
        drop_model(unit);
        se3di_fmi_variables_destroy(&unit->variables);
        se3di_iopool_destroy(&pool);
    }
}

se3di_fmi_mode se3di_fmi_unit_get_mode(const se3di_fmi_unit *unit)
{
    return unit->mode;
}

double se3di_fmi_unit_get_time(const se3di_fmi_unit *unit)
{
    return unit->time;
}

bool se3di_fmi_is_in(se3di_fmi_unit *u, unsigned modes, const char *call)
{
    static const char *const names[SE3DI_FMI_MODES] = {"before the initialization",
                                                       "in the initialization",
                                                       "between steps",
                                                       "after the end",
                                                       "in an event",
                                                       "while time goes on",
                                                       "after a failed step",
                                                       "after it was terminated"};
    u->is_discarded = false;
    return modes >> u->mode & 1U || se3di_fmi_fail(u, "%s is not allowed %s", call, names[u->mode]);
}

bool se3di_fmi_unit_begin(se3di_fmi_unit *unit, double start, double stop, double tolerance)
{
    if (!se3di_fmi_is_in(unit, 1U << SE3DI_FMI_INSTANTIATED, "setting up the experiment")) {
        return false;
    }
    if (isinf(start) || isinf(stop) || (!isnan(stop) && !isnan(start) && !(stop >= start))) {
        return se3di_fmi_fail(unit,
                              "the experiment is from %g s to %g s, the end must not be before the "
                              "start, and both finite",
                              start, stop);
    }
    if (!isnan(tolerance) && !(tolerance > 0.0 && tolerance <= DBL_MAX)) {
        return se3di_fmi_fail(unit, "the tolerance is %g, must be finite and > 0", tolerance);
    }
    unit->start = start;
    unit->stop = stop;
    unit->tolerance = tolerance;
    unit->time = start_of(unit);
    return true;
}

bool se3di_fmi_unit_enter(se3di_fmi_unit *unit)
{
    if (!se3di_fmi_is_in(unit, 1U << SE3DI_FMI_INSTANTIATED, "entering the initialization")) {
        return false;
    }
    unit->mode = SE3DI_FMI_INITIALIZING;
    return true;
}

bool se3di_fmi_unit_start(se3di_fmi_unit *unit)
{
    if (!se3di_fmi_is_in(unit, 1U << SE3DI_FMI_INITIALIZING, "ending the initialization")) {
        return false;
    }
    unit->mode = unit->exchange ? SE3DI_FMI_EVENT : SE3DI_FMI_STEPPING;
    if (!se3di_fmi_refresh(unit)) {
        unit->mode = SE3DI_FMI_FAILED;
        return false;
    }
    return true;
}

bool se3di_fmi_unit_terminate(se3di_fmi_unit *unit)
{
    const unsigned modes = 1U << SE3DI_FMI_STEPPING | 1U << SE3DI_FMI_ENDED |
                           1U << SE3DI_FMI_EVENT | 1U << SE3DI_FMI_CONTINUOUS |
                           1U << SE3DI_FMI_FAILED;
    if (!se3di_fmi_is_in(unit, modes, "terminating")) {
        return false;
    }
    unit->mode = SE3DI_FMI_TERMINATED;
    return true;
}

bool se3di_fmi_unit_reset(se3di_fmi_unit *unit)
{
    forget(unit);
    memset(unit->given, 0, unit->variables.count * sizeof *unit->given);
    unit->model_stale = true;
    if (!renew_model(unit)) {
        unit->mode = SE3DI_FMI_FAILED;
        return false;
    }
    unit->time = start_of(unit);
    return true;
}

/* ---- variables ------------------------------------------------------------------------------*/

static bool get_output(se3di_fmi_unit *u, size_t reference, double *value)
{
    const unsigned modes = ~(1U << SE3DI_FMI_INSTANTIATED);
    double numbers[4];
    if (!se3di_fmi_is_in(u, modes, "getting an output")) {
        return false;
    }
    const unsigned runs = 1U << SE3DI_FMI_INITIALIZING | 1U << SE3DI_FMI_STEPPING |
                          1U << SE3DI_FMI_EVENT | 1U << SE3DI_FMI_CONTINUOUS;
    if ((runs >> u->mode & 1U) && !se3di_fmi_refresh(u)) {
        return false;
    }
    const se3di_fmi_variable *v = &u->variables.list[reference]; /* of the model as it is now */
    if (!u->solver) {
        return se3di_fmi_fail(u, "%s: there is no state that it could be of", v->name);
    }
    if (v->role != SE3DI_FMI_OUTPUT) {
        return u->exchange ? se3di_fmi_exchange_get(u, v, reference, value)
                           : se3di_fmi_fail(u, "%s is for model exchange", v->name);
    }
    const se3d_status status =
        se3di_channel_eval(&u->model->outputs[v->output].channels[v->channel], &u->sample, numbers);
    if (status < 0) {
        return se3di_fmi_fail_system(u, v->name, status);
    }
    *value = numbers[v->component];
    return true;
}

static bool check_reference(se3di_fmi_unit *u, size_t reference)
{
    return reference < u->variables.count ||
           se3di_fmi_fail(u, "the value reference %zu is unknown: there are 0 to %zu", reference,
                          u->variables.count - 1);
}

bool se3di_fmi_unit_get(se3di_fmi_unit *unit, size_t reference, double *value)
{
    unit->is_discarded = false;
    if (!check_reference(unit, reference)) {
        return false;
    }
    const se3di_fmi_variable *v = &unit->variables.list[reference];
    if (v->role >= SE3DI_FMI_OUTPUT) {
        return get_output(unit, reference, value);
    }
    const bool is_time = v->role == SE3DI_FMI_TIME;
    if (v->role == SE3DI_FMI_CALCULATED && unit->model_stale && !renew_model(unit)) {
        return false;
    }
    *value = is_time ? unit->time : se3di_fmi_value_of(unit, reference);
    return true;
}

static bool check_set(se3di_fmi_unit *u, size_t reference, double value)
{
    const unsigned before = 1U << SE3DI_FMI_INSTANTIATED | 1U << SE3DI_FMI_INITIALIZING;
    if (!check_reference(u, reference)) {
        return false;
    }
    const se3di_fmi_variable *v = &u->variables.list[reference];
    if (v->role != SE3DI_FMI_INPUT && v->role != SE3DI_FMI_PARAMETER) {
        return se3di_fmi_fail(u, "%s cannot be set: it is %s", v->name,
                              v->role == SE3DI_FMI_OUTPUT  ? "an output"
                              : v->role > SE3DI_FMI_OUTPUT ? "of the integration"
                              : v->role == SE3DI_FMI_TIME  ? "the time"
                                                           : "calculated from other parameters");
    }
    if (!isfinite(value)) {
        return se3di_fmi_fail(u, "%s is set to %g, must be finite", v->name, value);
    }
    if (v->role == SE3DI_FMI_PARAMETER) {
        return se3di_fmi_is_in(u, before, "setting a parameter");
    }
    const unsigned steps = before | 1U << SE3DI_FMI_STEPPING | 1U << SE3DI_FMI_EVENT;
    return se3di_fmi_is_in(u, v->jumps ? steps : steps | 1U << SE3DI_FMI_CONTINUOUS,
                           "setting an input");
}

bool se3di_fmi_unit_force(se3di_fmi_unit *u, size_t k, double value)
{
    const double old = se3di_fmi_value_of(u, k);
    const bool same = u->given[k] && memcmp(&old, &value, sizeof old) == 0;
    if (same) {
        return true;
    }
    u->values[k] = value;
    u->given[k] = true;
    const bool begins = u->solver && u->mode == SE3DI_FMI_INITIALIZING && old != value;
    if (u->variables.list[k].role == SE3DI_FMI_PARAMETER || begins) {
        u->model_stale = true; /* the analyses before see it, too */
        return true;
    }
    if (!u->solver || u->model_stale || !(old != value)) {
        return true; /* it is set when the model is */
    }
    se3d_status status = apply_input(u, k);
    status = status < 0 ? status : note_place(u, k);
    u->state_stale = true;
    if (u->exchange) {
        u->exchange->is_stale = true;
    }
    return status >= 0 || se3di_fmi_fail_system(u, u->variables.list[k].name, status);
}

bool se3di_fmi_unit_set(se3di_fmi_unit *unit, const uint32_t *references, size_t count,
                        const double *values)
{
    for (size_t k = 0; k < count; ++k) {
        if (!check_set(unit, references[k], values[k])) {
            return false;
        }
    }
    for (size_t k = 0; k < count; ++k) {
        if (!se3di_fmi_unit_force(unit, references[k], values[k])) {
            return false;
        }
    }
    return true;
}

/* ---- steps ----------------------------------------------------------------------------------*/

bool se3di_fmi_unit_step(se3di_fmi_unit *unit, double time, double h)
{
    if (!se3di_fmi_is_in(unit, 1U << SE3DI_FMI_STEPPING, "a step")) {
        return false;
    }
    if (!isfinite(time) || !(h >= STEP_MIN) || !isfinite(time + h)) {
        return se3di_fmi_fail(unit,
                              "the step is from %g s by %g s, must be finite and at least %g s",
                              time, h, STEP_MIN);
    }
    const double slack = 1e-9 * fmax(h, 1e-3 * fabs(time));
    if (!(fabs(time - unit->time) <= slack)) {
        return se3di_fmi_fail(unit,
                              "the step begins at t = %.17g s, but the unit is at t = %.17g s",
                              time, unit->time);
    }
    const double late = 1e-6 * h; /* of callers that add up steps */
    if (!isnan(unit->stop) && time + h > unit->stop + slack + late) {
        return se3di_fmi_fail(
            unit, "the step goes to t = %.17g s, beyond the end of the experiment, %.17g s",
            time + h, unit->stop);
    }
    if (!(time + h > unit->time)) {
        return se3di_fmi_fail(unit, "the step of %g s is too short to be seen at t = %.17g s", h,
                              time);
    }
    return se3di_fmi_refresh(unit) && (unit->mode != SE3DI_FMI_STEPPING || run_to(unit, time + h));
}

/* ---- states ---------------------------------------------------------------------------------*/

static const uint64_t state_mark = UINT64_C(0x32756d6664336573); /* "se3dfmu2" */

/* What a state has beside system and solver. */
typedef struct image {
    uint64_t mark, token;
    int32_t mode, started, stale, exchanges;
    double numbers[4]; /* start, stop, tolerance, time */
    size_t count, snapshot, solver;
} image;

static void code_image(se3di_coder *c, image *i)
{
    se3di_code_word(c, &i->mark);
    se3di_code_word(c, &i->token);
    se3di_code_int32(c, &i->mode);
    se3di_code_flag(c, &i->started);
    se3di_code_flag(c, &i->stale);
    se3di_code_flag(c, &i->exchanges);
    se3di_code_numbers(c, i->numbers, 4);
    se3di_code_size(c, &i->count);
    se3di_code_size(c, &i->snapshot);
    se3di_code_size(c, &i->solver);
}

static uint64_t hash_of_token(const se3di_fmi_unit *u)
{
    return se3di_hash_bytes(SE3DI_HASH_START, u->token, strlen(u->token));
}

static void code_values(se3di_coder *c, size_t count, double *values, double *places, bool *given)
{
    se3di_code_numbers(c, places, 2 * count);
    for (size_t k = 0; k < count; ++k) {
        int32_t flag = given[k];
        se3di_code_flag(c, &flag);
        se3di_code_numbers(c, values + k, 1);
        given[k] = flag != 0;
    }
}

/* `bytes` NULL: measure. */
static se3d_status write_state(se3di_fmi_unit *u, const se3d_snapshot *snapshot,
                               unsigned char *bytes, size_t *size)
{
    image i = {.mark = state_mark,
               .token = hash_of_token(u),
               .mode = (int32_t)u->mode,
               .started = u->solver && !u->model_stale,
               .stale = u->state_stale,
               .exchanges = u->exchange != NULL,
               .numbers = {u->start, u->stop, u->tolerance, u->time},
               .count = u->variables.count};
    se3di_coder c = {.out = bytes, .size = bytes ? *size : SIZE_MAX};
    se3d_status status = i.started ? se3d_snapshot_write(snapshot, NULL, 0, &i.snapshot) : SE3D_OK;
    status = status < 0 || !i.started ? status : se3d_solver_write(u->solver, NULL, 0, &i.solver);
    if (status < 0) {
        return status;
    }
    code_image(&c, &i);
    code_values(&c, i.count, u->values, u->places, u->given);
    if (u->exchange) {
        se3di_code_numbers(&c, u->exchange->x, u->variables.states);
        se3di_code_numbers(&c, u->exchange->signs, u->variables.indicators + u->variables.stops);
    }
    uint64_t sum = bytes && c.at <= *size ? se3di_hash_bytes(SE3DI_HASH_START, bytes, c.at) : 0;
    se3di_code_word(&c, &sum);
    const size_t whole = c.at + i.snapshot + i.solver;
    if (bytes && i.started) {
        status = *size < whole
                     ? SE3D_ERR_INVALID_ARGUMENT
                     : se3d_snapshot_write(snapshot, bytes + c.at, i.snapshot, &i.snapshot);
        status = status < 0
                     ? status
                     : se3d_solver_write(u->solver, bytes + c.at + i.snapshot, i.solver, &i.solver);
    } else if (bytes && *size < whole) {
        status = SE3D_ERR_INVALID_ARGUMENT;
    }
    *size = whole;
    return status;
}

bool se3di_fmi_unit_write(se3di_fmi_unit *unit, unsigned char *bytes, size_t *size)
{
    se3d_snapshot *snapshot = NULL;
    const se3d_snapshot *base = unit->exchange ? unit->exchange->base : NULL;
    se3d_status status =
        unit->solver && !base ? se3d_snapshot_create(unit->model->system, &snapshot) : SE3D_OK;
    status = status < 0 ? status : write_state(unit, base ? base : snapshot, bytes, size);
    se3d_snapshot_destroy(snapshot);
    return status < 0 ? se3di_fmi_fail_system(unit, "the state cannot be saved", status) : true;
}

/* Whether the parameters of a state are not those that the model has. */
static bool has_other_parameters(const se3di_fmi_unit *u, const double *values, const bool *given)
{
    bool other = u->model_stale;
    for (size_t k = 0; k < u->variables.count && !other; ++k) {
        other = u->variables.list[k].role == SE3DI_FMI_PARAMETER &&
                (given[k] != u->given[k] || (given[k] && values[k] != u->values[k]));
    }
    return other;
}

/* System and solver as they were; the model and the values of its elements are. */
static bool restore(se3di_fmi_unit *u, const image *i, const double *places,
                    const unsigned char *bytes)
{
    se3d_system *system = u->model->system;
    se3d_snapshot *snapshot = NULL;
    memcpy(u->places, places, 2 * i->count * sizeof *places);
    for (size_t k = 0; k < i->count; ++k) {
        if (rate_of(u, k).index1 && put_place(u, k) < 0) {
            return se3di_fmi_fail(u, "%s cannot be put back", u->variables.list[k].name);
        }
    }
    if (!make_solver(u)) {
        return false;
    }
    se3d_status status = se3d_snapshot_read(system, bytes, i->snapshot, &snapshot);
    status = status < 0 ? status : se3d_snapshot_restore(snapshot, system);
    status = status < 0 ? status : se3d_solver_read(u->solver, bytes + i->snapshot, i->solver);
    if (status >= 0 && u->exchange) {
        return se3di_fmi_exchange_resume(u, snapshot, places + 2 * i->count);
    }
    se3d_snapshot_destroy(snapshot);
    se3d_solver_get_stats(u->solver, &u->stats);
    se3di_sample_renew(&u->sample, &u->stats);
    u->state_stale = i->stale != 0;
    return status < 0 ? se3di_fmi_fail_system(u, "the state cannot be put back", status) : true;
}

/* Inputs that a state does not have are as in the model. */
static bool put_values(se3di_fmi_unit *u, const double *values, const bool *given)
{
    const bool renew = has_other_parameters(u, values, given);
    for (size_t k = 0; k < u->variables.count; ++k) {
        const bool was_given = u->given[k];
        u->given[k] = given[k];
        u->values[k] = values[k];
        if (!renew && was_given && !given[k] && u->variables.list[k].role == SE3DI_FMI_INPUT &&
            apply_input(u, k) < 0) {
            return se3di_fmi_fail(u, "%s cannot be put back", u->variables.list[k].name);
        }
    }
    return (!renew || renew_model(u)) && apply_inputs(u);
}

static bool take_state(se3di_fmi_unit *u, const image *i, const double *numbers, const bool *given,
                       const unsigned char *rest)
{
    u->mode = SE3DI_FMI_FAILED;
    u->start = i->numbers[0];
    u->stop = i->numbers[1];
    u->tolerance = i->numbers[2];
    if (!i->started) { /* positions are those of the file */
        u->model_stale = true;
        u->state_stale = false;
    }
    if (!put_values(u, numbers, given) ||
        (i->started && !restore(u, i, numbers + i->count, rest))) {
        return false;
    }
    u->time = i->numbers[3];
    u->mode = (se3di_fmi_mode)i->mode;
    return true;
}

bool se3di_fmi_unit_read(se3di_fmi_unit *unit, const unsigned char *bytes, size_t size)
{
    image i = {.mark = 0};
    se3di_coder c = {.in = bytes, .size = size};
    se3di_iopool pool;
    code_image(&c, &i);
    if (c.failed || i.mark != state_mark || i.token != hash_of_token(unit) ||
        i.count != unit->variables.count || i.mode < 0 || i.mode >= SE3DI_FMI_MODES ||
        (i.exchanges != 0) != (unit->exchange != NULL)) {
        return se3di_fmi_fail(unit, "these bytes are not a state of this unit");
    }
    const size_t more = unit->exchange ? se3di_fmi_exchange_count(unit) : 0;
    se3di_iopool_init(&pool, NULL);
    /* and the places, and those of the exchange */
    double *values = se3di_iopool_array(&pool, 3 * i.count + more, sizeof *values);
    bool *given = se3di_iopool_array(&pool, i.count, sizeof *given);
    bool good = values && given;
    if (!good) {
        fail_memory(unit);
    } else {
        code_values(&c, i.count, values, values + i.count, given);
        se3di_code_numbers(&c, values + 3 * i.count, more);
        const uint64_t sum = c.at <= size ? se3di_hash_bytes(SE3DI_HASH_START, bytes, c.at) : 0;
        uint64_t written = 0;
        se3di_code_word(&c, &written);
        c.failed |= written != sum;
        const size_t rest = c.at <= size ? size - c.at : 0;
        good = !c.failed && i.snapshot <= rest && i.solver == rest - i.snapshot;
        good = good ? take_state(unit, &i, values, given, bytes + c.at)
                    : se3di_fmi_fail(unit, "these bytes are not a whole state of this unit");
    }
    se3di_iopool_destroy(&pool);
    return good;
}
