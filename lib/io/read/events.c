/* SPDX-License-Identifier: BSD-3-Clause */
/* `events`: reading them, and their values from channels. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/channel/event.h"
#include "io/channel/output.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/sections.h"

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
    if (!se3di_event_source_find(model, event->channel, &event->source, problem, sizeof problem)) {
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
