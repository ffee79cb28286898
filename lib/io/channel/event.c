/* SPDX-License-Identifier: BSD-3-Clause */
/* Events of a model: their values from channels, on a solver. */
#include "io/channel/event.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/base/sized.h"
#include "io/channel/channel.h"
#include "io/channel/combine.h"
#include "io/channel/sample.h"
#include "io/document/document.h"
#include "io/model/model.h"

const char se3di_events_file[] = "events.csv";

static se3d_status eval_source(void *ctx, const se3d_system *system, double *value)
{
    const se3di_event_source *source = ctx;
    double numbers[4];
    se3di_sample sample;
    se3di_sample_init(&sample, system, &source->model->pool.allocator);
    const se3d_status status = se3di_channel_eval(&source->channel, &sample, numbers);
    *value = numbers[source->component];
    se3di_sample_destroy(&sample);
    return status;
}

bool se3di_event_source_find(se3d_model *model, const char *channel, se3di_event_source *source,
                             char *problem, size_t size)
{
    source->model = model;
    if (strlen(channel) > 310) {
        snprintf(problem, size, "is longer than any channel's name");
        return false;
    }
    if (source->channel.combination) {
        source->component = 0;
    } else if (se3di_text_is_combination(model, channel)) {
        if (!se3di_combination_find(model, channel, &source->channel, problem, size)) {
            return false;
        }
    } else if (!se3di_channel_find_number(model, channel, &source->channel, &source->component,
                                          problem, size)) {
        return false;
    }
    if (!se3di_channel_is_continuous(&source->channel)) {
        snprintf(problem, size,
                 "`%.200s` changes in jumps, an event needs a channel that changes continuously",
                 channel);
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
    if (!se3di_event_source_find(model, name, source, problem, sizeof problem)) {
        return report(error, model, problem, SE3D_ERR_INVALID_ARGUMENT);
    }
    const se3d_status status = create_event(solver, source, &full, out);
    return status < 0 ? report(error, model, se3d_system_get_error(model->system), status) : status;
}

se3d_status se3di_events_create(const se3d_model *model, se3d_solver *solver,
                                se3d_event_callback callback, void *ctx)
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
        def.callback = callback;
        def.callback_ctx = ctx;
        status = create_event(solver, &entry->source, &def, &event);
    }
    return status;
}
