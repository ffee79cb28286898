/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/live/session.h"

#include <math.h>
#include <string.h>

#include "io/channel/event.h"
#include "io/fmi/before.h"
#include "io/model/settable.h"
#include "io/model/tagged.h"

enum { COLUMNS_MAX = 1000 };

static bool say(char *message, const char *text)
{
    snprintf(message, SE3DI_LIVE_MESSAGE_SIZE, "%s", text);
    return false;
}

static bool say_memory(char *message)
{
    return say(message, "out of memory");
}

/* "WHAT: why", with the message of the system if it has one. */
bool se3di_session_say(char *message, const se3di_session *s, const char *what, se3d_status status)
{
    const char *why = se3d_system_get_error(s->model->system);
    snprintf(message, SE3DI_LIVE_MESSAGE_SIZE, "%.200s: %.1000s", what,
             why[0] ? why : se3d_status_get_text(status));
    return false;
}

/* ---- reading --------------------------------------------------------------------------------*/

void se3di_session_destroy(se3di_session *s)
{
    if (!s) {
        return;
    }
    se3di_iopool pool = s->pool; /* the session itself lies in it */
    se3d_solver_destroy(s->solver);
    if (s->is_prepared) {
        se3di_sample_destroy(&s->sample);
        se3di_fmi_variables_destroy(&s->variables);
    }
    se3d_model_destroy(s->model);
    se3di_iopool_destroy(&pool);
}

/* The mistakes of a file, one a line. */
static void collect(void *ctx, const se3d_model_error *error)
{
    char *message = ctx;
    const size_t used = strlen(message);
    snprintf(message + used, SE3DI_LIVE_MESSAGE_SIZE - used, "%s%s", used > 0 ? "\n" : "",
             error->message);
}

/* The options with the parameters that were set in `before` (NULL: none). */
static bool make_options(const se3di_session_source *from, const se3di_session *before,
                         se3di_iopool *pool, se3d_model_options *options)
{
    *options = *from->options;
    const size_t count = before ? before->slider_count : 0;
    se3d_model_setting *settings =
        se3di_iopool_array(pool, options->setting_count + count + 1, sizeof *settings);
    if (!settings) {
        return false;
    }
    for (size_t k = 0; k < options->setting_count; ++k) {
        settings[k] = options->settings[k];
    }
    options->settings = settings;
    for (size_t k = 0; k < count; ++k) {
        const se3di_fmi_variable *v = &before->variables.list[before->slider_variables[k]];
        char text[SE3DI_FMI_VALUE_SIZE];
        if (!before->is_set[k] || v->role != SE3DI_FMI_PARAMETER) {
            continue;
        }
        const size_t length = se3di_fmi_format_value(v, before->sliders[k].value, text);
        se3d_model_setting *s = &settings[options->setting_count++];
        s->name = v->parameter;
        s->value = se3di_iopool_copy(pool, text, length);
        if (!s->value) {
            return false;
        }
    }
    return true;
}

/* Read the model, or say why it cannot be. */
static bool read_model(const se3di_session_source *from, const se3di_session *before,
                       se3di_session *s, char *message)
{
    se3di_iopool pool;
    se3d_model_options options;
    se3d_model_error error;
    se3di_iopool_init(&pool, NULL);
    message[0] = '\0';
    bool good = make_options(from, before, &pool, &options);
    if (!good) {
        say_memory(message);
    } else {
        options.report = collect;
        options.report_ctx = message;
        options.log = NULL;
        good = se3d_model_read_file(from->path, &options, &s->model, &error) >= 0;
        if (!good && !message[0]) {
            say(message, error.message);
        }
    }
    se3di_iopool_destroy(&pool);
    return good;
}

static bool list_sliders(se3di_session *s)
{
    const size_t most = s->variables.count + 1;
    s->sliders = se3di_iopool_array(&s->pool, most, sizeof *s->sliders);
    s->slider_variables = se3di_iopool_array(&s->pool, most, sizeof *s->slider_variables);
    s->is_set = se3di_iopool_array(&s->pool, most, sizeof *s->is_set);
    s->held = se3di_iopool_array(&s->pool, most, sizeof *s->held);
    s->held_is_set = se3di_iopool_array(&s->pool, most, sizeof *s->held_is_set);
    if (!s->sliders || !s->slider_variables || !s->is_set || !s->held || !s->held_is_set) {
        return false;
    }
    for (size_t k = 0; k < s->variables.count; ++k) {
        const se3di_fmi_variable *v = &s->variables.list[k];
        const bool is_parameter = v->role == SE3DI_FMI_PARAMETER;
        if (!is_parameter && v->role != SE3DI_FMI_INPUT) {
            continue;
        }
        se3di_live_slider *slider = &s->sliders[s->slider_count];
        slider->name = is_parameter ? v->parameter : v->name;
        slider->start = v->start;
        slider->value = v->start;
        slider->is_parameter = is_parameter;
        s->held[s->slider_count] = v->start;
        if (v->has_unit) {
            se3di_fmi_format_unit(v->dimension, slider->unit, sizeof slider->unit);
        }
        s->slider_variables[s->slider_count++] = k;
    }
    return true;
}

static bool add_column(se3di_session *s, const se3di_channel *channel, size_t component)
{
    char name[400];
    se3di_channel_format_column(channel, component, name, sizeof name);
    s->columns[s->column_count] = se3di_iopool_copy(&s->pool, name, strlen(name));
    return s->columns[s->column_count++] != NULL;
}

/* The channels of the first output that has some. */
static bool list_columns(se3di_session *s)
{
    const se3d_model *model = s->model;
    for (size_t k = 0; k < model->output_count && !s->output; ++k) {
        s->output = model->outputs[k].count > 0 ? &model->outputs[k] : NULL;
    }
    s->columns = se3di_iopool_array(&s->pool, COLUMNS_MAX + 4, sizeof *s->columns);
    if (!s->columns) {
        return false;
    }
    for (size_t i = 0; s->output && i < s->output->count && s->column_count < COLUMNS_MAX; ++i) {
        const se3di_channel *channel = &s->output->channels[i];
        s->shows_all = s->shows_all || !se3di_channel_is_shown(channel);
        for (size_t j = 0; j < se3di_channel_get_width(channel); ++j) {
            if (!add_column(s, channel, j)) {
                return false;
            }
        }
    }
    return true;
}

bool se3di_session_get_particles(const se3di_session *s, double *numbers)
{
    const se3d_particles *set = s->model->particles->set;
    const size_t n = se3d_particles_count(set);
    return se3d_particles_get_radii(set, n, numbers) >= 0 &&
           se3d_particles_get_all(set, n, numbers + n, numbers + 4 * n, numbers + 7 * n) >= 0;
}

/* The box around the particles. */
static bool measure_particles(se3di_session *s)
{
    const size_t n = s->model->particles ? se3d_particles_count(s->model->particles->set) : 0;
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    double *numbers = se3di_iopool_array(&pool, 10 * n + 1, sizeof *numbers);
    const bool good = numbers && (n == 0 || se3di_session_get_particles(s, numbers));
    for (size_t i = 0; i < 3; ++i) {
        s->particle_box[0][i] = HUGE_VAL;
        s->particle_box[1][i] = -HUGE_VAL;
        for (size_t k = 0; good && k < n; ++k) {
            const double at = numbers[n + 3 * k + i];
            s->particle_box[0][i] = fmin(s->particle_box[0][i], at - numbers[k]);
            s->particle_box[1][i] = fmax(s->particle_box[1][i], at + numbers[k]);
        }
    }
    se3di_iopool_destroy(&pool);
    return good;
}

/* Poses and sizes as the scene has them, which is drawn where the bodies are now, or were in `like`
 * (NULL: none). */
static bool measure(const se3di_session *like, se3di_session *s)
{
    const se3d_model *model = s->model;
    s->start.bodies = model->body_count;
    s->start.count = 1;
    s->start.values = se3di_iopool_array(&s->pool, model->body_count, SE3DI_POSE * sizeof(double));
    s->poses = se3di_iopool_array(&s->pool, model->body_count, SE3DI_POSE * sizeof(double));
    if (!s->start.values || !s->poses) {
        return false;
    }
    s->start.times = &s->start_time;
    s->rise_count = se3di_drawing_count_rises(model);
    s->rises = se3di_iopool_array(&s->pool, s->rise_count + 1, sizeof *s->rises);
    if (!s->rises) {
        return false;
    }
    (void)se3d_system_get_time(model->system, &s->start_time);
    if (like) {
        memcpy(s->particle_box, like->particle_box, sizeof s->particle_box);
        s->start_time = like->start_time;
        memcpy(s->start.values, like->start.values,
               model->body_count * SE3DI_POSE * sizeof(double));
    } else if (!measure_particles(s) ||
               se3di_drawing_get_poses(model, s->start.values) != SE3D_OK) {
        return false;
    }
    se3di_drawing_measure(model, &s->start, &s->sizes);
    se3di_drawing_list_rises(model, &s->sizes, &s->start, s->rises);
    for (size_t e = 0; e < model->element_count; ++e) {
        s->between_count += se3di_drawing_count_between(&model->elements[e]);
    }
    return true;
}

/* ---- starting -------------------------------------------------------------------------------*/

/* To the state that the analysis `index` begins with, and the time. */
static bool run_before(const se3di_session_source *from, se3di_session *s, size_t index,
                       char *message)
{
    size_t failed = 0;
    double start = 0.0;
    se3d_status status =
        se3di_fmi_run_before(s->model, index, from->interrupt, from->ctx, &start, &failed);
    if (status < 0) {
        char what[100];
        snprintf(what, sizeof what, "the %.40s analysis failed",
                 s->model->analyses[failed].analysis.type);
        return se3di_session_say(message, s, what, status);
    }
    status = se3d_system_set_time(s->model->system, start);
    return status >= 0 || se3di_session_say(message, s, "the model cannot start", status);
}

static const se3di_element_entry *find_element(const se3d_model *model, const char *name)
{
    size_t index = 0;
    return se3di_ionames_find(&model->element_names, name, &index) ? &model->elements[index] : NULL;
}

static void move_body(const se3di_session *from, const se3di_body_entry *entry, se3d_system *to)
{
    double r[3];
    double p[4];
    double v[3];
    double w[3];
    size_t index = 0;
    int32_t fixed = 0;
    if (!se3di_ionames_find(&from->model->body_names, entry->name, &index)) {
        return;
    }
    const se3d_system *system = from->model->system;
    const se3d_body body = from->model->bodies[index].body;
    const bool is_fixed = se3d_body_get_fixed(to, entry->body, &fixed) < 0 || fixed;
    if (is_fixed || se3d_body_get_position(system, body, r) < 0 ||
        se3d_body_get_orientation(system, body, p) < 0 ||
        se3d_body_get_velocity(system, body, v) < 0 ||
        se3d_body_get_angular_velocity(system, body, w) < 0) {
        return;
    }
    (void)se3d_body_set_position(to, entry->body, r);
    (void)se3d_body_set_orientation(to, entry->body, p);
    (void)se3d_body_set_velocity(to, entry->body, v);
    (void)se3d_body_set_angular_velocity(to, entry->body, w);
}

/* A driver with a rate goes on from where it has come to. */
static se3d_status move_rates(const se3di_session *from, se3di_session *to)
{
    double time = 0.0;
    se3d_status status = se3d_system_get_time(from->model->system, &time);
    for (size_t k = 0; k < to->slider_count && status >= 0; ++k) {
        const se3di_fmi_variable *v = &to->variables.list[to->slider_variables[k]];
        if (v->role != SE3DI_FMI_INPUT || !to->model->elements[v->element].rate.index1) {
            continue;
        }
        const se3di_element_entry *e = &to->model->elements[v->element];
        const se3di_element_entry *old = find_element(from->model, e->name);
        double jet[3] = {0.0, 0.0, 0.0};
        if (old && old->rate.index1) {
            status = se3d_function_eval(from->model->system, old->rate, &time, jet);
            status = status < 0 ? status
                                : se3di_rate_put_place(to->model, e->rate, time, jet[0],
                                                       to->sliders[k].value);
        }
    }
    return status;
}

/* Bodies and states of `to` take what those of the same names in `from` have. */
static se3d_status move_state(const se3di_session *from, se3di_session *to)
{
    const se3d_model *model = to->model;
    double time = 0.0;
    double value = 0.0;
    const se3d_status status = move_rates(from, to);
    for (size_t k = 1; k < model->body_count; ++k) {
        move_body(from, &model->bodies[k], model->system);
    }
    for (size_t k = 0; k < model->element_count; ++k) {
        const se3di_element_entry *e = &model->elements[k];
        const se3di_element_entry *old =
            e->kind == SE3DI_ELEMENT_STATE ? find_element(from->model, e->name) : NULL;
        for (size_t i = 0; old && old->kind == e->kind && i < e->order && i < old->order; ++i) {
            if (se3d_state_get_value(from->model->system, old->states[i], SE3D_STATE_VALUE,
                                     &value) >= 0) {
                (void)se3d_state_set_value(model->system, e->states[i], value);
            }
        }
    }
    se3d_system_get_time(from->model->system, &time);
    return status < 0 ? status : se3d_system_set_time(model->system, time);
}

/* ---- going on -------------------------------------------------------------------------------*/

/* Whether all has the same names in the same order. */
static bool is_alike(const se3d_model *a, const se3d_model *b)
{
    if (a->body_count != b->body_count || a->element_count != b->element_count) {
        return false;
    }
    for (size_t k = 1; k < a->body_count; ++k) {
        if (strcmp(a->bodies[k].name, b->bodies[k].name) != 0) {
            return false;
        }
    }
    for (size_t k = 0; k < a->element_count; ++k) {
        const se3di_element_entry *e = &a->elements[k];
        if (e->kind != b->elements[k].kind || strcmp(e->name, b->elements[k].name) != 0) {
            return false;
        }
    }
    return true;
}

/* Bodies that are fixed stand where the model has them now. */
static void keep_fixed(const se3d_model *model, const double *poses, const double *now)
{
    for (size_t k = 1; k < model->body_count; ++k) {
        const se3d_body body = model->bodies[k].body;
        int32_t fixed = 0;
        if (se3d_body_get_fixed(model->system, body, &fixed) >= 0 && fixed &&
            memcmp(poses + SE3DI_POSE * k, now + SE3DI_POSE * k, SE3DI_POSE * sizeof *poses) != 0) {
            (void)se3d_body_set_position(model->system, body, poses + SE3DI_POSE * k);
            (void)se3d_body_set_orientation(model->system, body, poses + SE3DI_POSE * k + 3);
        }
    }
}

static se3d_status copy_snapshot(const se3d_system *from, se3d_system *to, se3di_iopool *pool,
                                 se3d_snapshot **copy)
{
    se3d_snapshot *old = NULL;
    size_t size = 0;
    se3d_status status = se3d_snapshot_create(from, &old);
    status = status < 0 ? status : se3d_snapshot_write(old, NULL, 0, &size);
    if (status >= 0) {
        unsigned char *bytes = se3di_iopool_array(pool, size, 1);
        status = bytes ? se3d_snapshot_write(old, bytes, size, &size) : SE3D_ERR_NO_MEMORY;
        status = status < 0 ? status : se3d_snapshot_read(to, bytes, size, copy);
    }
    se3d_snapshot_destroy(old);
    return status;
}

/* Put `to` where the snapshot is, but for what is fixed. */
static se3d_status put_state(const se3di_session *from, se3di_session *to,
                             const se3d_snapshot *snapshot, const double *poses, double *now)
{
    se3d_status status = move_rates(from, to);
    status = status < 0 ? status : se3d_snapshot_restore(snapshot, to->model->system);
    if (status >= 0) {
        (void)se3di_drawing_get_poses(to->model, now);
        keep_fixed(to->model, poses, now);
        (void)se3d_system_touch(to->model->system); /* other numbers act from now on */
    }
    return status;
}

/* All that the state of `from` has, turns of joints and what forces remember, too. @return < 0:
 * nothing is moved, for want of memory, or as the models are not of the same structure. */
static se3d_status copy_state(const se3di_session *from, se3di_session *to)
{
    se3d_snapshot *snapshot = NULL;
    const size_t numbers = SE3DI_POSE * to->model->body_count;
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    double *poses = se3di_iopool_array(&pool, numbers, 2 * sizeof *poses);
    se3d_status status = !poses                             ? SE3D_ERR_NO_MEMORY
                         : is_alike(from->model, to->model) ? SE3D_OK
                                                            : SE3D_ERR_STATE;
    status = status < 0 ? status : se3di_drawing_get_poses(to->model, poses);
    if (status >= 0) {
        status = copy_snapshot(from->model->system, to->model->system, &pool, &snapshot);
    }
    status = status < 0 ? status : put_state(from, to, snapshot, poses, poses + numbers);
    se3d_snapshot_destroy(snapshot);
    se3di_iopool_destroy(&pool);
    return status;
}

/* Numbers that were set in `before` are set in `s`, if it has them. */
static se3d_status take_values(const se3di_session *before, se3di_session *s)
{
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < s->slider_count; ++k) {
        for (size_t i = 0; before && i < before->slider_count && status >= 0; ++i) {
            if (before->is_set[i] && strcmp(before->sliders[i].name, s->sliders[k].name) == 0) {
                s->is_set[k] = true;
                s->sliders[k].value = before->sliders[i].value;
                s->sliders[k].start = before->sliders[i].start;
                s->held[k] = s->sliders[k].value;
                s->held_is_set[k] = true;
                if (!s->sliders[k].is_parameter) {
                    status = se3di_fmi_apply_input(
                        s->model, &s->variables.list[s->slider_variables[k]], s->sliders[k].value);
                }
            }
        }
    }
    return status;
}

void se3di_session_renew(se3di_session *s)
{
    memset(&s->stats, 0, sizeof s->stats);
    if (s->solver) {
        (void)se3d_solver_get_stats(s->solver, &s->stats);
    }
    se3di_sample_renew(&s->sample, &s->stats);
}

/* Run to where it is: to a state that fits. */
static bool settle(se3di_session *s, const char *what, char *message)
{
    double time = 0.0;
    se3d_system_get_time(s->model->system, &time);
    const se3d_status status = se3d_solver_run(s->solver, time);
    se3di_session_renew(s);
    return status >= 0 || se3di_session_say(message, s, what, status);
}

/* The solver, at a state that fits. */
static bool make_solver(const se3di_session_source *from, se3di_session *s, size_t index,
                        const char *what, char *message)
{
    se3d_solver_def def = s->model->analyses[index].solver;
    def.interrupt = from->interrupt;
    def.interrupt_ctx = from->ctx;
    se3d_status status = se3d_solver_create(s->model->system, &def, &s->solver);
    status = status < 0 ? status : se3di_events_create(s->model, s->solver, NULL, NULL);
    return status < 0 ? se3di_session_say(message, s, what, status) : settle(s, what, message);
}

/* What a model is shown with: everything that is made of it once. */
static bool prepare(const se3di_session *before, se3di_session *s, char *message)
{
    char problem[500];
    se3d_status status = se3di_fmi_variables_list(s->model, &s->variables, problem, sizeof problem);
    se3di_sample_init(&s->sample, s->model->system, &s->model->pool.allocator);
    s->is_prepared = true;
    if (s->model->guest_count > 0) {
        return say(message, "the model has `fmus`, which `se3d run` alone steps");
    }
    if (status == SE3D_ERR_NO_MEMORY || !list_sliders(s) || !list_columns(s)) {
        return say_memory(message);
    }
    status = take_values(before, s);
    return status >= 0 ||
           se3di_session_say(message, s, "a number that was set cannot be set again", status);
}

/* Bring a model that was read to where it begins. `before` NULL: all is as in the file. */
static bool start(const se3di_session_source *from, const se3di_session *before, bool goes_on,
                  se3di_session *s, char *message)
{
    static const char goes_not[] = "the model cannot go on";
    size_t index = 0;
    if (!prepare(before, s, message)) {
        return false;
    }
    const bool moves = se3di_fmi_find_analysis(s->model, &index);
    const size_t count = moves ? index : s->model->analysis_count;
    s->analysis = index;
    goes_on = goes_on && moves && before->solver;
    const se3d_status copied = goes_on ? copy_state(before, s) : SE3D_ERR_STATE;
    const bool is_copied = copied >= 0;
    if (copied == SE3D_ERR_NO_MEMORY) {
        return say_memory(message);
    }
    if ((!is_copied && !run_before(from, s, count, message)) ||
        (moves &&
         !make_solver(from, s, index, is_copied ? goes_not : "the model cannot start", message))) {
        return false;
    }
    se3di_session_renew(s);
    if (!measure(is_copied ? before : NULL, s)) {
        return say_memory(message);
    }
    if (goes_on && !is_copied) {
        const se3d_status moved = move_state(before, s);
        return moved < 0 ? se3di_session_say(message, s, goes_not, moved)
                         : settle(s, goes_not, message);
    }
    return true;
}

static se3di_session *create_session(char *message)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, NULL);
    se3di_session *s = se3di_iopool_alloc(&pool, sizeof *s);
    if (s) {
        s->pool = pool;
        return s;
    }
    se3di_iopool_destroy(&pool);
    say_memory(message);
    return NULL;
}

se3di_session *se3di_session_make(const se3di_session_source *from, se3di_session *now,
                                  se3di_live_beginning beginning, char *message)
{
    const bool anew = beginning == SE3DI_LIVE_ANEW || beginning == SE3DI_LIVE_CHANGED;
    const se3di_session *before = anew ? NULL : now;
    se3di_session *s = create_session(message);
    if (!s || !read_model(from, before, s, message)) {
        se3di_session_destroy(s);
        return NULL;
    }
    if (beginning == SE3DI_LIVE_CHANGED && s->model->content == now->model->content) {
        se3di_session_destroy(s);
        return now;
    }
    if (!start(from, before, beginning == SE3DI_LIVE_GOING_ON, s, message)) {
        se3di_session_destroy(s);
        return NULL;
    }
    return s;
}
