/* SPDX-License-Identifier: BSD-3-Clause */
/* `analysis` of type modes: its file, inputs, outputs and frequencies. */
#include "io/read/modes.h"
#include "io/read/objects.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bodies.h"

static const char *const quantities[] = {"position", "velocity",         "acceleration",
                                         "rotation", "angular_velocity", "angular_acceleration",
                                         NULL};

/* clang-format off */
static const se3di_key modes_input_keys[] = {
    {"body", SE3DI_KIND_BODY, .required = true, .text = ""},
    {"point", SE3DI_KIND_POINT, .standard = "the centre of mass",
     .text = "where a force acts, body frame [m]"},
    {"direction", SE3DI_KIND_DIRECTION, .required = true, .text = "ground frame"},
    {"torque", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_modes_input, is_torque), .standard = "false",
     .text = "a torque about the direction, not a force along it"},
    {.key = NULL}};
const se3di_object se3di_object_modes_input = {
    "modes_input",
    "A force or a torque on a body.",
    modes_input_keys, NULL,
    NULL};
/* clang-format on */

/* clang-format off */
static const se3di_key modes_output_keys[] = {
    {"body", SE3DI_KIND_BODY, .required = true, .text = ""},
    {"point", SE3DI_KIND_POINT, .standard = "the centre of mass", .text = "body frame [m]"},
    {"direction", SE3DI_KIND_DIRECTION, .required = true, .text = "ground frame"},
    {"quantity", SE3DI_KIND_WORD, SE3DI_INTO(se3d_modes_output, quantity), .words = quantities,
     .standard = "position", .text = "what is observed"},
    {.key = NULL}};
const se3di_object se3di_object_modes_output = {
    "modes_output",
    "A component of the motion of a body.",
    modes_output_keys, NULL,
    NULL};
/* clang-format on */

/* clang-format off */
static const se3di_key frequencies_keys[] = {
    {"from", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_modes_entry, from),
     .required = true, .text = "[Hz]"},
    {"to", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_modes_entry, to), .required = true,
     .text = "[Hz], > from"},
    {"count", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .standard = "200",
     .text = "a whole number from 2 to 1000000"},
    {.key = NULL}};
const se3di_object se3di_object_frequencies = {
    "frequencies",
    "Of the transfer functions, in a geometric progression.",
    frequencies_keys, NULL,
    NULL};
/* clang-format on */

/* A direction must be given: no default would be right. */
static bool read_direction(se3di_reader *reader, const se3di_node *node, double direction[3])
{
    if (!se3di_node_get(node, "direction")) {
        return se3di_reader_fail_key(reader, node, "direction",
                                     "is missing, must be [x, y, z] in the ground frame");
    }
    return se3di_read_key_direction(reader, node, "direction", direction);
}

static bool read_input(se3di_reader *reader, const se3di_node *node, se3d_modes_input *input)
{
    const se3di_body_entry *body = NULL;
    if (!se3di_read_keys(reader, node, &se3di_object_modes_input) ||
        !se3di_read_key_body(reader, node, "body", &body) ||
        !se3di_read_key_point(reader, node, "point", body, input->point)) {
        return false;
    }
    input->body = body->body;
    return se3di_read_fields(reader, node, &se3di_object_modes_input, NULL, "se3d_modes_input",
                             input) &&
           read_direction(reader, node, input->direction);
}

static bool read_output(se3di_reader *reader, const se3di_node *node, se3d_modes_output *output)
{
    const se3di_body_entry *body = NULL;
    if (!se3di_read_keys(reader, node, &se3di_object_modes_output) ||
        !se3di_read_key_body(reader, node, "body", &body) ||
        !se3di_read_key_point(reader, node, "point", body, output->point)) {
        return false;
    }
    output->body = body->body;
    return se3di_read_fields(reader, node, &se3di_object_modes_output, NULL, "se3d_modes_output",
                             output) &&
           read_direction(reader, node, output->direction);
}

static bool read_lists(se3di_reader *reader, const se3di_node *node, se3di_modes_entry *modes)
{
    se3di_iopool *pool = reader->pool;
    const se3di_node *inputs = NULL;
    const se3di_node *outputs = NULL;
    if (!se3di_read_list(reader, node, "inputs", &inputs) ||
        !se3di_read_list(reader, node, "outputs", &outputs)) {
        return false;
    }
    modes->inputs = se3di_iopool_array(pool, inputs ? inputs->count : 1, sizeof *modes->inputs);
    modes->outputs = se3di_iopool_array(pool, outputs ? outputs->count : 1, sizeof *modes->outputs);
    if (!modes->inputs || !modes->outputs) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *child = inputs ? inputs->first : NULL; child; child = child->next) {
        if (!read_input(reader, child, &modes->inputs[modes->input_count++])) {
            return false;
        }
    }
    for (const se3di_node *child = outputs ? outputs->first : NULL; child; child = child->next) {
        if (!read_output(reader, child, &modes->outputs[modes->output_count++])) {
            return false;
        }
    }
    return true;
}

static bool read_frequencies(se3di_reader *reader, const se3di_node *node, se3di_modes_entry *modes)
{
    const se3di_node *map = se3di_node_get(node, "frequencies");
    double count = 200.0;
    if (!map) {
        return true;
    }
    if (modes->input_count == 0 || modes->output_count == 0) {
        return se3di_reader_fail(reader, map,
                                 "need `inputs` and `outputs`: transfer functions are "
                                 "from each input to each output");
    }
    if (!se3di_read_keys(reader, map, &se3di_object_frequencies) ||
        !se3di_read_fields(reader, map, &se3di_object_frequencies, NULL, "se3di_modes_entry",
                           modes) ||
        !se3di_read_key(reader, map, &se3di_object_frequencies, NULL, "count", &count)) {
        return false;
    }
    if (!(modes->from > 0.0) || !(modes->to > modes->from)) {
        return se3di_reader_fail(reader, map, "must have `from` > 0 and `to` > `from` [Hz]");
    }
    if (count < 2.0 || count > 1e6 || floor(count) < count) {
        return se3di_reader_fail_key(reader, map, "count",
                                     "is %g, must be a whole number from 2 to 1000000", count);
    }
    modes->frequency_count = (size_t)count;
    return true;
}

static bool read_file(se3di_reader *reader, const se3di_node *node, se3di_modes_entry *modes)
{
    const se3d_model *model = reader->model;
    const se3di_node *file = se3di_node_get(node, "file");
    modes->file = "modes.csv";
    if (file && !se3di_read_file_name(reader, file, &modes->file)) {
        return false;
    }
    for (size_t k = 0; k < model->analysis_count; ++k) {
        const char *other = model->analyses[k].modes.file;
        if (other && strcmp(other, modes->file) == 0) {
            return se3di_reader_fail_key(reader, node, "file",
                                         "`%.60s` is written by two analyses: give each its own",
                                         modes->file);
        }
    }
    return true;
}

/* `count`: a few modes of a large model. */
static bool read_count(se3di_reader *reader, const se3di_node *node, se3di_modes_entry *modes)
{
    if (!se3di_node_get(node, "count")) {
        return true;
    }
    if (!se3di_read_key(reader, node, &se3di_object_analysis, NULL, "count", &modes->count)) {
        return false;
    }
    if (modes->count < 1.0 || modes->count > 1e6 || floor(modes->count) < modes->count) {
        return se3di_reader_fail_key(
            reader, node, "count", "is %g, must be a whole number from 1 to 1000000", modes->count);
    }
    return modes->input_count + modes->output_count == 0 ||
           se3di_reader_fail_key(reader, node, "count",
                                 "does not go with `inputs` and `outputs`, which need all modes");
}

bool se3di_read_modes(se3di_reader *reader, const se3di_node *node, se3di_analysis_entry *entry)
{
    if (strcmp(entry->analysis.type, "modes") == 0) {
        if (!node) { /* asked for by an option, in a model without analysis */
            entry->modes.file = "modes.csv";
            return true;
        }
        return read_file(reader, node, &entry->modes) && read_lists(reader, node, &entry->modes) &&
               read_frequencies(reader, node, &entry->modes) &&
               read_count(reader, node, &entry->modes);
    }
    for (const se3di_node *child = node ? node->first : NULL; child; child = child->next) {
        if (!reader->options->analysis &&
            se3di_keys_contain(" file inputs outputs frequencies count ", child->key)) {
            return se3di_reader_fail(reader, child, "is only for an analysis of type modes");
        }
    }
    return true;
}
