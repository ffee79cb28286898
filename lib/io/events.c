/* SPDX-License-Identifier: BSD-3-Clause */
/* `events`: reading them, and their values from channels. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/reader.h"
#include "io/run_events.h"
#include "io/sized.h"

static se3d_status eval_source(void *ctx, const se3d_system *system, double *value)
{
    const se3di_event_source *source = ctx;
    double numbers[4];
    const se3d_status status = se3di_channel_eval(&source->channel, system, NULL, numbers);
    *value = numbers[source->component];
    return status;
}

static bool find_source(se3d_model *model, const char *channel, se3di_event_source *source,
                        char *problem, size_t size)
{
    source->model = model;
    if (strlen(channel) > 310) {
        snprintf(problem, size, "is longer than any channel's name");
        return false;
    }
    if (!se3di_channel_find_number(model, channel, &source->channel, &source->component, problem,
                                   size)) {
        return false;
    }
    if (!se3di_channel_is_continuous(&source->channel)) {
        snprintf(problem, size,
                 "`%.200s` changes by jumps, an event needs what changes continuously", channel);
        return false;
    }
    return true;
}

/* Nearer to the level a number is rounding; that of accelerations and forces is larger, as it is
 * what solving for them leaves. */
static double default_hysteresis(const se3di_event_source *source)
{
    const double share = se3di_channel_is_of_motion(&source->channel) ? 1e-10 : 1e-8;
    return share * se3di_channel_get_scale(&source->channel, source->model->system);
}

static se3d_status create_event(se3d_solver *solver, se3di_event_source *source,
                                const se3d_event_def *def, se3d_event *out)
{
    se3d_event_def used = *def;
    used.value = eval_source;
    used.ctx = source;
    used.motion_only = se3di_channel_is_of_motion(&source->channel);
    if (!(fabs(def->hysteresis) > 0.0)) {
        used.hysteresis = default_hysteresis(source);
    }
    return se3d_event_create(solver, &used, out);
}

static se3d_status report(se3d_model_error *error, const se3d_model *model, const char *text,
                          se3d_status status)
{
    se3di_document_report(error, model ? model->file : "", 0, 0, "", text);
    return status;
}

se3d_status se3d_model_create_event(se3d_model *model, se3d_solver *solver, const char *channel,
                                    const se3d_event_def *def, se3d_event *out,
                                    se3d_model_error *error)
{
    char problem[480] = "";
    if (error) {
        memset(error, 0, sizeof *error);
    }
    if (out) {
        *out = (se3d_event){0, 0};
    }
    if (!model || !solver || !channel || !def || !out) {
        return report(error, model, "model, solver, channel, def or out is NULL", SE3D_ERR_NULL);
    }
    se3d_event_def full = se3d_event_def_default();
    if (!se3di_io_take(def, &full, sizeof full)) {
        return report(error, model, "def: " SE3DI_IO_SIZE_TEXT, SE3D_ERR_INVALID_ARGUMENT);
    }
    full.struct_size = sizeof full;
    se3di_event_source *source = se3di_iopool_alloc(&model->pool, sizeof *source);
    const char *name = se3di_iopool_copy(&model->pool, channel, strlen(channel));
    if (!source || !name) {
        return report(error, model, "out of memory", SE3D_ERR_NO_MEMORY);
    }
    if (!find_source(model, name, source, problem, sizeof problem)) {
        return report(error, model, problem, SE3D_ERR_INVALID_ARGUMENT);
    }
    const se3d_status status = create_event(solver, source, &full, out);
    return status < 0 ? report(error, model, se3d_system_get_error(model->system), status) : status;
}

se3d_status se3di_events_create(const se3d_model *model, se3d_solver *solver)
{
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < model->event_count && status >= 0; ++k) {
        se3di_event_entry *entry = &model->events[k];
        se3d_event_def def = se3d_event_def_default();
        se3d_event event;
        def.name = entry->name;
        def.level = entry->level;
        def.hysteresis = entry->hysteresis;
        def.direction = entry->direction;
        def.action = entry->action;
        status = create_event(solver, &entry->source, &def, &event);
    }
    return status;
}

static bool read_choices(se3di_reader *reader, const se3di_node *node, se3di_event_entry *event)
{
    static const char *const directions[] = {"any", "rising", "falling", NULL};
    static const char *const actions[] = {"record", "stop", NULL};
    static const int32_t values[] = {SE3D_EVENT_ANY, SE3D_EVENT_RISING, SE3D_EVENT_FALLING};
    const se3di_node *direction = se3di_node_get(node, "direction");
    const se3di_node *action = se3di_node_get(node, "action");
    size_t which = 0;
    size_t what = SE3D_EVENT_RECORD;
    if ((direction && !se3di_read_word(reader, direction, directions, &which)) ||
        (action && !se3di_read_word(reader, action, actions, &what))) {
        return false;
    }
    event->direction = values[which];
    event->action = (int32_t)what;
    return true;
}

static bool read_event(se3di_reader *reader, const se3di_node *node, se3di_event_entry *event)
{
    se3d_model *model = reader->model;
    char problem[480] = "";
    if (!se3di_read_keys(reader, node, SE3DI_OBJECT_EVENT)) {
        return false;
    }
    const se3di_node *name = se3di_node_get(node, "name");
    const se3di_node *channel = se3di_node_get(node, "channel");
    if (!name) {
        return se3di_reader_fail_key(reader, node, "name", "is missing");
    }
    if (!channel) {
        return se3di_reader_fail_key(reader, node, "channel",
                                     "is missing, must be a channel such as pin.angle");
    }
    if (!se3di_read_name(reader, name, &event->name) ||
        !se3di_read_text(reader, channel, &event->channel)) {
        return false;
    }
    for (size_t k = 0; k < model->event_count; ++k) {
        if (strcmp(model->events[k].name, event->name) == 0) {
            return se3di_reader_fail(reader, name, "there is an event named `%s` already",
                                     event->name);
        }
    }
    if (!find_source(model, event->channel, &event->source, problem, sizeof problem)) {
        return se3di_reader_fail(reader, channel, "%s", problem);
    }
    return se3di_read_key_number(reader, node, "value", SE3DI_ANY, &event->level) &&
           se3di_read_key_number(reader, node, "hysteresis", SE3DI_POSITIVE, &event->hysteresis) &&
           read_choices(reader, node, event);
}

/* The file of the events is not another one's. */
static bool check_file(se3di_reader *reader, const se3di_node *list)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; k < model->output_count; ++k) {
        if (strcmp(model->outputs[k].file, se3di_events_file) == 0) {
            return se3di_reader_fail(reader, list, "are written to `%s`, which is also an output",
                                     se3di_events_file);
        }
    }
    return true;
}

/* Events of a model in which nothing ever moves. What --analysis asks for may have none. */
static bool check_motion(se3di_reader *reader, const se3di_node *list)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; k < model->analysis_count; ++k) {
        if (se3di_analysis_has_motion(&model->analyses[k])) {
            return true;
        }
    }
    return model->analysis_count == 0 || reader->options->analysis ||
           se3di_reader_fail(reader, list,
                             "need an `analysis` with a motion (kinematics, inverse_dynamics, "
                             "dynamics): %s has none",
                             model->analyses[0].analysis.type);
}

bool se3di_read_events(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "events", &list)) {
        return false;
    }
    const size_t count = list ? list->count : 0;
    if (count == 0) {
        return true;
    }
    model->events = se3di_iopool_array(&model->pool, count, sizeof *model->events);
    if (!model->events) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *node = list->first; node; node = node->next) {
        if (!read_event(reader, node, &model->events[model->event_count])) {
            return false;
        }
        ++model->event_count;
    }
    return check_file(reader, list) && check_motion(reader, list);
}
