/* SPDX-License-Identifier: BSD-3-Clause */
/* `fmus`: which units of other programs run beside the model, and what goes to and fro. */
#include <string.h>

#include "io/base/pool.h"
#include "io/channel/combine.h"
#include "io/channel/guest.h"
#include "io/document/attachment.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/reader.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

/* clang-format off */
static const se3di_key fmu_input_keys[] = {
    {"variable", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_guest_input, variable), .required = true,
     .text = "an input of the unit"},
    {"channel", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_guest_input, channel), .required = true,
     .text = "a [channel](#output) of one number, a component, or an expression of them"},
    {.key = NULL}};
const se3di_object se3di_object_fmu_input = {
    "fmu_input", "What a unit is told.", fmu_input_keys, NULL, NULL};

static const se3di_key fmu_output_keys[] = {
    {"variable", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_guest_output, variable), .required = true,
     .text = "an output of the unit"},
    {"element", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_guest_output, element), .required = true,
     .text = "an effort, a driver, or a component of a force or torque (push.x), whose value is a "
         "number"},
    {.key = NULL}};
const se3di_object se3di_object_fmu_output = {
    "fmu_output", "What a unit says.", fmu_output_keys, NULL, NULL};

static const se3di_key fmu_parameter_keys[] = {
    {"variable", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_guest_parameter, variable), .required = true,
     .text = "a parameter of the unit"},
    {"value", SE3DI_KIND_NUMBER, SE3DI_INTO(se3di_guest_parameter, value), .required = true,
     .text = "in the unit's own unit of measure"},
    {.key = NULL}};
const se3di_object se3di_object_fmu_parameter = {
    "fmu_parameter", "A parameter of a unit.", fmu_parameter_keys, NULL, NULL};

static const se3di_key fmu_keys[] = {
    {"name", SE3DI_KIND_NAME, SE3DI_INTO(se3di_guest_entry, name), .required = true,
     .text = "unique among the units"},
    {"file", SE3DI_KIND_TEXT, SE3DI_INTO(se3di_guest_entry, file), .required = true,
     .text = "the unit (.fmu), or its unpacked folder, relative to the model file; it is a "
         "program, which a run loads and runs"},
    {"step", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_guest_entry, step),
     .required = true, .text = "from one communication point to the next [s]"},
    {"inputs", SE3DI_KIND_LIST, .object = "fmu_input", .text = "what it is told at each point"},
    {"outputs", SE3DI_KIND_LIST, .object = "fmu_output",
     .text = "what acts on the model from there to the next point"},
    {"parameters", SE3DI_KIND_LIST, .object = "fmu_parameter", .text = "set at the beginning"},
    {.key = NULL}};
const se3di_object se3di_object_fmu = {
    "fmu",
    "A mock-up unit for co-simulation (FMI 2.0 or 3.0) as force or controller.",
    fmu_keys, NULL,
    NULL};
/* clang-format on */

static bool read_input(se3di_reader *reader, const se3di_node *node, se3di_guest_input *input)
{
    char problem[480] = "";
    const se3di_node *channel = se3di_node_get(node, "channel");
    reader->alternative = -1;
    if (!channel || !se3di_read_fields(reader, node, &se3di_object_fmu_input, NULL,
                                       "se3di_guest_input", input)) {
        return channel ? false : se3di_reader_fail_key(reader, node, "channel", "is missing");
    }
    if (se3di_text_is_combination(reader->model, input->channel) &&
        !se3di_combination_read(reader, channel, input->channel, &input->source.channel)) {
        return false;
    }
    return se3di_event_source_find(reader->model, input->channel, &input->source, problem,
                                   sizeof problem) ||
           se3di_reader_fail(reader, channel, "%s", problem);
}

/* "push.x" is a component of `push`. */
static bool find_element(se3di_reader *reader, se3di_guest_output *output)
{
    const size_t length = strlen(output->element);
    if (se3di_reader_find(reader, &reader->model->element_names, output->element, &output->index)) {
        return true;
    }
    const char last = length > 2 ? output->element[length - 1] : '\0';
    if (last < 'x' || last > 'z' || output->element[length - 2] != '.') {
        return false;
    }
    const char *name = se3di_iopool_copy(reader->pool, output->element, length - 2);
    output->component = (size_t)(last - 'x');
    return name && se3di_reader_find(reader, &reader->model->element_names, name, &output->index);
}

static bool read_output(se3di_reader *reader, const se3di_node *node, se3di_guest_output *output)
{
    const se3di_node *element = se3di_node_get(node, "element");
    if (!element || !se3di_read_fields(reader, node, &se3di_object_fmu_output, NULL,
                                       "se3di_guest_output", output)) {
        return element ? false : se3di_reader_fail_key(reader, node, "element", "is missing");
    }
    if (!find_element(reader, output)) {
        return se3di_reader_fail(reader, element,
                                 "is `%.100s`, there is no such element; must be an effort, a "
                                 "driver, or a component of a force or torque, such as push.x",
                                 output->element);
    }
    const se3di_element_entry *e = &reader->model->elements[output->index];
    return e->settable >> output->component & 1U ||
           se3di_reader_fail(reader, element,
                             "is `%.100s`, which has no such number: an effort, a driver, or a "
                             "component of a force or torque must have a number as its value",
                             output->element);
}

static bool read_parameter(se3di_reader *reader, const se3di_node *node,
                           se3di_guest_parameter *parameter)
{
    reader->alternative = -1;
    return se3di_read_fields(reader, node, &se3di_object_fmu_parameter, NULL,
                             "se3di_guest_parameter", parameter);
}

/* A list, its keys checked; *count is 0 if there is none. */
static bool begin_list(se3di_reader *reader, const se3di_node *node, const char *key,
                       const se3di_object *object, const se3di_node **first, size_t *count)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, node, key, &list)) {
        return false;
    }
    *first = list ? list->first : NULL;
    *count = list ? list->count : 0;
    for (const se3di_node *n = *first; n; n = n->next) {
        if (!se3di_read_keys(reader, n, object)) {
            return false;
        }
    }
    return true;
}

/* One of the three lists. */
#define READ_LIST(function, key, object, type, list, total, read)                                  \
    static bool function(se3di_reader *reader, const se3di_node *node, se3di_guest_entry *guest)   \
    {                                                                                              \
        const se3di_node *first = NULL;                                                            \
        size_t count = 0;                                                                          \
        if (!begin_list(reader, node, key, object, &first, &count)) {                              \
            return false;                                                                          \
        }                                                                                          \
        guest->list = se3di_iopool_array(reader->pool, count + 1, sizeof(type));                   \
        if (!guest->list) {                                                                        \
            return se3di_reader_fail_memory(reader);                                               \
        }                                                                                          \
        for (const se3di_node *n = first; n; n = n->next) {                                        \
            if (!read(reader, n, &guest->list[guest->total++])) {                                  \
                return false;                                                                      \
            }                                                                                      \
        }                                                                                          \
        return true;                                                                               \
    }
READ_LIST(read_inputs, "inputs", &se3di_object_fmu_input, se3di_guest_input, inputs, input_count,
          read_input)
READ_LIST(read_outputs, "outputs", &se3di_object_fmu_output, se3di_guest_output, outputs,
          output_count, read_output)
READ_LIST(read_parameters, "parameters", &se3di_object_fmu_parameter, se3di_guest_parameter,
          parameters, parameter_count, read_parameter)

static bool read_guest(se3di_reader *reader, const se3di_node *node, se3di_guest_entry *guest)
{
    const se3d_model *model = reader->model;
    if (!se3di_read_keys(reader, node, &se3di_object_fmu) ||
        !se3di_read_fields(reader, node, &se3di_object_fmu, NULL, "se3di_guest_entry", guest)) {
        return false;
    }
    for (size_t k = 0; k < model->guest_count; ++k) {
        if (strcmp(model->guests[k].name, guest->name) == 0) {
            return se3di_reader_fail_key(reader, node, "name", "there is a unit named `%s` already",
                                         guest->name);
        }
    }
    guest->path = se3di_find_attachment(reader, reader->pool, guest->file);
    if (!guest->path) {
        return se3di_reader_fail_memory(reader);
    }
    return read_inputs(reader, node, guest) && read_outputs(reader, node, guest) &&
           read_parameters(reader, node, guest);
}

bool se3di_read_guests(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "fmus", &list)) {
        return false;
    }
    if (!list) {
        return true;
    }
    model->guests = se3di_iopool_array(&model->pool, list->count, sizeof *model->guests);
    if (!model->guests) {
        return se3di_reader_fail_memory(reader);
    }
    for (const se3di_node *node = list->first; node; node = node->next) {
        if (!read_guest(reader, node, &model->guests[model->guest_count])) {
            return false;
        }
        ++model->guest_count;
    }
    return true;
}
