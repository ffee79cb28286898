/* SPDX-License-Identifier: BSD-3-Clause */
/* `events`: reading them, and their values from channels. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/channel/combine.h"
#include "io/channel/event.h"
#include "io/channel/output.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

static const char *const directions[] = {"any", "rising", "falling", NULL};
static const int32_t direction_values[] = {SE3D_EVENT_ANY, SE3D_EVENT_RISING, SE3D_EVENT_FALLING};
static const char *const actions[] = {
    [SE3D_EVENT_RECORD] = "record", [SE3D_EVENT_STOP] = "stop", NULL};

/* clang-format off */
static const se3di_key event_keys[] = {
    {"name", SE3DI_KIND_NAME, SE3DI_INTO(se3di_event_entry, name), .required = true,
     .text = "unique among the events"},
    {"channel", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_event_entry, channel), .required = true,
     .text = "a [channel](#output) of one number, a component (.x .y .z, .e0 ... .e3), such as "
         "pin.angle or bar.tip.position.z, or an expression of them; not channels of particles, "
         "nor counts"},
    {"value", SE3DI_KIND_NUMBER, SE3DI_INTO(se3di_event_entry, level), .standard = "0",
     .text = "the level"},
    {"direction", SE3DI_KIND_WORD, SE3DI_INTO(se3di_event_entry, direction), .words = directions,
     .standard = "any", .text = "rising: from below, falling: from above"},
    {"action", SE3DI_KIND_WORD, SE3DI_INTO(se3di_event_entry, action), .words = actions,
     .standard = "record",
     .text = "stop: the analysis ends there, with exit code 0; the next one in a list begins "
         "there"},
    {"hysteresis", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_event_entry, hysteresis),
     .standard = "rounding in a model of this size, 1e-10 (reactions, accelerations, "
         "contacts and forces: 1e-8) of its length, velocity, mass and so on "
         "([theory](../theory/events.md#sides))",
     .text = "in the unit of the channel: a crossing counts if the value has been further "
         "than this from the level, on the side it comes from, since it last crossed"},
    {.key = NULL}};
const se3di_object se3di_object_event = {
    "event",
    "A crossing of a level by a number of a channel.",
    event_keys, NULL,
    NULL};
/* clang-format on */

static bool read_event(se3di_reader *reader, const se3di_node *node, se3di_event_entry *event)
{
    se3d_model *model = reader->model;
    char problem[480] = "";
    if (!se3di_read_keys(reader, node, &se3di_object_event)) {
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
    reader->alternative = -1; /* the channel's, whatever that is */
    if (!se3di_read_fields(reader, node, &se3di_object_event, NULL, "se3di_event_entry", event)) {
        return false;
    }
    for (size_t k = 0; k < model->event_count; ++k) {
        if (strcmp(model->events[k].name, event->name) == 0) {
            return se3di_reader_fail(reader, name, "there is an event named `%s` already",
                                     event->name);
        }
    }
    event->direction = direction_values[event->direction];
    if (se3di_text_is_combination(model, event->channel) &&
        !se3di_combination_read(reader, channel, event->channel, &event->source.channel)) {
        return false;
    }
    if (!se3di_event_source_find(model, event->channel, &event->source, problem, sizeof problem)) {
        return se3di_reader_fail(reader, channel, "%s", problem);
    }
    return true;
}

/* No output has the same file as the events. */
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

/* Events need an analysis with a motion. One that was chosen by --analysis may have none. */
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
