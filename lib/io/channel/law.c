/* SPDX-License-Identifier: BSD-3-Clause */
/* Laws that depend on channels: each channel becomes a signal of the function. */
#include "io/channel/law.h"

#include <string.h>

#include "io/base/pool.h"
#include "io/channel/combine.h"
#include "io/document/amount.h"
#include "io/document/document.h"
#include "io/document/function.h"
#include "io/document/value.h"
#include "io/model/model.h"

static bool take_marker(const se3d_model *model, const se3di_channel *channel, se3d_signal *signal)
{
    for (size_t k = 0; k < model->marker_count; ++k) {
        const se3di_marker_entry *entry = &model->markers[k];
        if (entry->marker.index1 == channel->marker.index1 &&
            entry->marker.generation == channel->marker.generation) {
            signal->body = model->bodies[entry->body].body;
            memcpy(signal->point, entry->position, sizeof signal->point);
            return true;
        }
    }
    return false;
}

/* @return false: the number does not follow from positions and velocities alone */
static bool take_signal(const se3d_model *model, const se3di_channel *channel, size_t component,
                        se3d_signal *signal)
{
    static const struct {
        se3di_quantity quantity;
        int32_t kind, coordinate; /* negative: the component of the channel */
    } kinds[] = {
        {SE3DI_JOINT_ANGLE, SE3D_SIGNAL_JOINT_COORDINATE, SE3D_JOINT_COORDINATE_ANGLE},
        {SE3DI_JOINT_ANGLE_RATE, SE3D_SIGNAL_JOINT_RATE, SE3D_JOINT_COORDINATE_ANGLE},
        {SE3DI_JOINT_DISPLACEMENT, SE3D_SIGNAL_JOINT_COORDINATE,
         SE3D_JOINT_COORDINATE_DISPLACEMENT},
        {SE3DI_JOINT_DISPLACEMENT_RATE, SE3D_SIGNAL_JOINT_RATE, SE3D_JOINT_COORDINATE_DISPLACEMENT},
        {SE3DI_FORCE_COORDINATE, SE3D_SIGNAL_FORCE_COORDINATE, 0},
        {SE3DI_FORCE_RATE, SE3D_SIGNAL_FORCE_RATE, 0},
        {SE3DI_STATE_VALUE, SE3D_SIGNAL_STATE, SE3D_STATE_OUTPUT},
        {SE3DI_STATE_INPUT, SE3D_SIGNAL_STATE, SE3D_STATE_INPUT},
        {SE3DI_STATE_ITSELF, SE3D_SIGNAL_STATE, SE3D_STATE_VALUE},
        {SE3DI_BODY_POSITION, SE3D_SIGNAL_POINT_POSITION, -1},
        {SE3DI_BODY_VELOCITY, SE3D_SIGNAL_POINT_VELOCITY, -1},
        {SE3DI_BODY_ANGULAR_VELOCITY, SE3D_SIGNAL_ANGULAR_VELOCITY, -1},
        {SE3DI_BODY_ORIENTATION, SE3D_SIGNAL_ORIENTATION, -1},
        {SE3DI_MARKER_POSITION, SE3D_SIGNAL_POINT_POSITION, -1},
        {SE3DI_MARKER_VELOCITY, SE3D_SIGNAL_POINT_VELOCITY, -1}};
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
        if (kinds[k].quantity != channel->quantity) {
            continue;
        }
        *signal = (se3d_signal){.kind = kinds[k].kind,
                                .component = kinds[k].coordinate < 0 ? (int32_t)component
                                                                     : kinds[k].coordinate,
                                .body = channel->body,
                                .joint = channel->constraint,
                                .force = channel->force,
                                .state = channel->state};
        const bool marker = channel->quantity == SE3DI_MARKER_POSITION ||
                            channel->quantity == SE3DI_MARKER_VELOCITY;
        return !marker || take_marker(model, channel, signal);
    }
    return false;
}

/* What the part of another side would say with a sign. */
static bool is_same_mirrored(const se3di_channel *channel)
{
    if (channel->quantity == SE3DI_STATE_VALUE || channel->quantity == SE3DI_STATE_INPUT ||
        channel->quantity == SE3DI_STATE_ITSELF) {
        return true; /* what it is fed by is checked where it is */
    }
    return (channel->quantity == SE3DI_FORCE_COORDINATE || channel->quantity == SE3DI_FORCE_RATE) &&
           channel->motion == SE3DI_TRANSLATION;
}

static bool take_signals(se3di_reader *reader, const se3di_node *node, const se3di_mentions *m,
                         size_t own, se3d_signal *signals)
{
    for (size_t k = own; k < m->count; ++k) {
        const se3di_channel *channel = &m->channels[k];
        if (channel->reference.given) {
            return se3di_reader_fail(
                reader, node,
                "`%.100s` is relative to a frame that moves, which a law "
                "cannot depend on: use a joint's coordinate, or a length or angle "
                "of a spring without stiffness",
                channel->name);
        }
        if (!take_signal(reader->model, channel, m->components[k], &signals[k - own])) {
            return se3di_reader_fail(reader, node,
                                     "`%.100s` is known only when the motion has been solved for: "
                                     "a law may depend on positions, angles, lengths and their "
                                     "rates",
                                     channel->name);
        }
        if (se3di_component_is_mirrored(reader->part) && !is_same_mirrored(channel)) {
            return se3di_reader_fail(reader, node,
                                     "`%.100s` changes its sign or frame in a mirrored part, where "
                                     "a law may depend on lengths of springs and their rates only",
                                     channel->name);
        }
    }
    return true;
}

/* The text in the unit of its key. */
static bool convert(se3di_reader *reader, const se3di_node *node, const se3di_mentions *m,
                    const char **text)
{
    se3di_amount q;
    se3di_node plain = *node;
    plain.text = m->text;
    if (!se3di_amount_is_needed(reader, m->text)) {
        *text = m->text;
        return true;
    }
    if (!se3di_mentions_eval(reader, node, m, &plain, &q) ||
        !se3di_amount_take(reader, node, node, &q)) {
        return false;
    }
    if (!q.text[0]) {
        return se3di_reader_fail(reader, node, "`%.120s` does not depend on its channels",
                                 node->text);
    }
    *text = q.text[0];
    return true;
}

/* What a coordinate that is prescribed may follow. */
static bool check_position(se3di_reader *reader, const se3di_node *node, const char *name,
                           const se3d_signal *signal)
{
    switch (signal->kind) {
    case SE3D_SIGNAL_JOINT_COORDINATE:
    case SE3D_SIGNAL_FORCE_COORDINATE:
    case SE3D_SIGNAL_POINT_POSITION:
    case SE3D_SIGNAL_ORIENTATION:
        return true;
    case SE3D_SIGNAL_STATE:
        return se3di_reader_fail(reader, node,
                                 "`%.100s` is integrated with the motion: the value of a driver "
                                 "may depend on t, positions, angles and lengths; its `rate` may "
                                 "follow any channel, and what a controller moves is moved by an "
                                 "`effort`",
                                 name);
    default:
        return se3di_reader_fail(
            reader, node,
            "`%.100s` is a velocity: the value of a driver may depend on t, "
            "positions, angles and lengths; its `rate` may follow any channel, "
            "and what reacts to velocities is an `effort` or another force",
            name);
    }
}

static bool create(se3di_reader *reader, const se3di_node *node, const se3di_mentions *m,
                   size_t own, bool prescribes, se3d_function *function)
{
    se3d_signal signals[SE3D_FUNCTION_VARIABLES_MAX];
    se3d_expression_def def = se3d_expression_def_default();
    se3d_function_def law = se3d_function_def_default();
    se3d_expression *expression = NULL;
    if (!take_signals(reader, node, m, own, signals) || !convert(reader, node, m, &def.text)) {
        return false;
    }
    for (size_t k = own; prescribes && k < m->count; ++k) {
        if (!check_position(reader, node, m->channels[k].name, &signals[k - own])) {
            return false;
        }
    }
    def.variables = m->variables;
    def.variable_count = m->count;
    if (!se3di_read_compile(reader, node, &def, &expression)) {
        return false;
    }
    law.compiled = expression;
    law.variable_count = m->count;
    law.signals = signals;
    law.signal_count = m->count - own;
    const se3d_status status = se3d_function_create(reader->system, &law, function);
    se3d_expression_destroy(expression);
    return se3di_reader_check(reader, node, status);
}

bool se3di_read_law(se3di_reader *reader, const se3di_node *node, const char *const *variables,
                    double *value, se3d_function *function)
{
    size_t own = 0;
    if (node->kind != SE3DI_NODE_SCALAR || se3di_node_is_null(node) || !strchr(node->text, '.')) {
        return se3di_read_function(reader, node, variables, value, function);
    }
    se3di_mentions *m = se3di_iopool_alloc(reader->pool, sizeof *m);
    if (!m) {
        return se3di_reader_fail_memory(reader);
    }
    if (!se3di_mentions_read(reader, node, variables, m)) {
        return false;
    }
    while (variables[own]) {
        ++own;
    }
    return m->count == own ? se3di_read_function(reader, node, variables, value, function)
                           : create(reader, node, m, own, false, function);
}

static const char *const time_only[] = {"t", NULL};

bool se3di_check_of_time(se3di_reader *reader, const se3di_node *node)
{
    if (node->kind != SE3DI_NODE_SCALAR || se3di_node_is_null(node) || !strchr(node->text, '.')) {
        return true;
    }
    se3di_mentions *m = se3di_iopool_alloc(reader->pool, sizeof *m);
    if (!m) {
        return se3di_reader_fail_memory(reader);
    }
    if (!se3di_mentions_read(reader, node, time_only, m)) {
        return false;
    }
    if (m->count == 1) {
        return true;
    }
    return se3di_reader_fail(reader, node,
                             "depends on `%.80s`: it must be a function of t alone. The `value` of "
                             "a driver may follow positions; a `coupler` ties coordinates of "
                             "joints to each other; what reacts to the motion is an `effort` or "
                             "another force, such as kp*(%.80s - q)",
                             m->channels[1].name, m->channels[1].name);
}

bool se3di_read_prescribed(se3di_reader *reader, const se3di_node *node, double *value,
                           se3d_function *function)
{
    return se3di_check_of_time(reader, node) &&
           se3di_read_function(reader, node, time_only, value, function);
}

bool se3di_is_followed(const se3di_reader *reader, const se3di_node *node)
{
    return node && node->kind == SE3DI_NODE_SCALAR && !se3di_node_is_null(node) &&
           se3di_text_has_mention(reader->part, node->text);
}

static bool read_followed(se3di_reader *reader, const se3di_node *node, bool is_position,
                          se3d_function *function)
{
    se3di_mentions *m = se3di_iopool_alloc(reader->pool, sizeof *m);
    if (!m) {
        return se3di_reader_fail_memory(reader);
    }
    return se3di_mentions_read(reader, node, time_only, m) &&
           create(reader, node, m, 1, is_position, function);
}

bool se3di_read_followed(se3di_reader *reader, const se3di_node *node, se3d_function *function)
{
    return read_followed(reader, node, true, function);
}

bool se3di_read_followed_rate(se3di_reader *reader, const se3di_node *node, se3d_function *function)
{
    return read_followed(reader, node, false, function);
}
