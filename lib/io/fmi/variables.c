/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/fmi/variables.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "io/base/number.h"
#include "io/channel/channel.h"
#include "io/channel/output.h"
#include "io/document/amount.h"
#include "io/model/settable.h"

/* A model and the list that grows. */
typedef struct collector {
    se3d_model *model;
    se3di_fmi_variables *v;
    char *problem;
    size_t problem_size;
} collector;

bool se3di_fmi_find_analysis(const se3d_model *model, size_t *index)
{
    bool found = false;
    for (size_t k = 0; k < model->analysis_count; ++k) {
        if (se3di_analysis_has_motion(&model->analyses[k])) {
            *index = k;
            found = true;
        }
    }
    return found;
}

double se3di_fmi_get_start(const se3d_model *model, size_t index)
{
    double time = 0.0;
    for (size_t k = 0; k <= index; ++k) {
        const se3d_model_analysis *a = &model->analyses[k].analysis;
        time = isnan(a->start) ? time : a->start;
        time += k < index ? a->duration : 0.0;
    }
    return time;
}

static se3d_status refuse(char *problem, size_t size, const char *name, const char *what)
{
    snprintf(problem, size, "%.200s%s", name, what);
    return SE3D_ERR_UNSUPPORTED;
}

se3d_status se3di_fmi_variables_add(se3di_fmi_variables *variables, const se3di_fmi_variable *made,
                                    char *problem, size_t problem_size)
{
    se3di_fmi_variables *v = variables;
    size_t index = 0;
    if (se3di_ionames_find(&v->names, made->name, &index)) {
        const bool same = made->role == SE3DI_FMI_OUTPUT && v->list[index].role == SE3DI_FMI_OUTPUT;
        return same ? SE3D_OK
                    : refuse(problem, problem_size, made->name,
                             ": two variables of the unit would have this name; rename an element "
                             "or a parameter");
    }
    se3di_fmi_variable *grown =
        se3di_iopool_grow(&v->pool, v->list, v->count, &v->capacity, sizeof *grown);
    const char *name = se3di_iopool_copy(&v->pool, made->name, strlen(made->name));
    if (!grown || !name) {
        return SE3D_ERR_NO_MEMORY;
    }
    v->list = grown;
    v->list[v->count] = *made;
    v->list[v->count].name = name;
    return se3di_ionames_add(&v->names, &v->pool, name, v->count++) ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

static se3d_status add(collector *c, const se3di_fmi_variable *made)
{
    return se3di_fmi_variables_add(c->v, made, c->problem, c->problem_size);
}

/* The unit of what an element is set to. */
static se3di_dimension dimension_of(const se3d_model *model, const se3di_element_entry *e)
{
    const se3di_dimension force = {1, 1, -2, 0};
    const se3di_dimension torque = {2, 1, -2, 0};
    const bool is_angle = e->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    const char *type = "";
    if (e->kind == SE3DI_ELEMENT_DRIVER) {
        const int8_t rate = e->rate.index1 ? -1 : 0;
        return is_angle ? (se3di_dimension){0, 0, rate, 1} : (se3di_dimension){1, 0, rate, 0};
    }
    if (e->body.index1 == 0) { /* an effort */
        return is_angle ? torque : force;
    }
    se3d_force_get_type(model->system, e->force, &type);
    return strcmp(type, "torque") == 0 ? torque : force;
}

static se3d_status add_inputs(collector *c)
{
    const se3d_model *model = c->model;
    char name[400];
    for (size_t k = 0; k < model->element_count; ++k) {
        const se3di_element_entry *e = &model->elements[k];
        const bool is_load = e->kind == SE3DI_ELEMENT_FORCE && e->body.index1 != 0;
        for (size_t i = 0; i < 3; ++i) {
            if (!(e->settable >> i & 1U)) {
                continue;
            }
            snprintf(name, sizeof name, is_load ? "%.300s.input.%c" : "%.300s.input", e->name,
                     "xyz"[i]);
            const se3d_status status =
                add(c, &(se3di_fmi_variable){.name = name,
                                             .role = SE3DI_FMI_INPUT,
                                             .start = e->value[i],
                                             .dimension = dimension_of(model, e),
                                             .has_unit = true,
                                             .jumps = e->kind == SE3DI_ELEMENT_DRIVER,
                                             .element = k,
                                             .component = i});
            if (status < 0) {
                return status;
            }
        }
    }
    return SE3D_OK;
}

/* Whether a text mentions parameters or points. */
static bool depends(const se3di_scope *scope, const char *text)
{
    char word[64];
    size_t length = 0;
    const char *at = se3di_amount_next_name(text, &length);
    for (; at; at = se3di_amount_next_name(at + length, &length)) {
        if (length < sizeof word) {
            memcpy(word, at, length);
            word[length] = '\0';
            if (se3di_scope_find(scope, word)) {
                return true;
            }
        }
    }
    return false;
}

static se3d_status add_parameters(collector *c)
{
    const se3di_node *map = se3di_node_get(c->model->root, "parameters");
    char name[400];
    for (const se3di_node *node = map ? map->first : NULL; node; node = node->next) {
        const se3di_amount *value = se3di_scope_find(c->model->scope, node->key);
        if (!value || value->rank != 1 || !node->text) {
            continue; /* vectors stay as they are */
        }
        const bool follows = depends(c->model->scope, node->text);
        snprintf(name, sizeof name, "parameters.%.300s", node->key);
        const se3d_status status = add(
            c, &(se3di_fmi_variable){.name = name,
                                     .role = follows ? SE3DI_FMI_CALCULATED : SE3DI_FMI_PARAMETER,
                                     .start = value->v[0],
                                     .dimension = value->dimension,
                                     .has_unit = value->hard,
                                     .parameter = node->key});
        if (status < 0) {
            return status;
        }
    }
    return SE3D_OK;
}

static se3di_dimension dimension_of_channel(const se3di_channel *channel)
{
    const se3di_combination *made = channel->combination;
    return !made               ? se3di_channel_get_dimension(channel)
           : !made->expression ? se3di_channel_get_dimension(&made->parts[0])
                               : (se3di_dimension){0, 0, 0, 0};
}

static se3d_status add_outputs(collector *c)
{
    char name[400];
    for (size_t k = 0; k < c->model->output_count; ++k) {
        const se3di_output_entry *output = &c->model->outputs[k];
        for (size_t i = 0; i < output->count; ++i) {
            const se3di_channel *channel = &output->channels[i];
            const se3di_dimension dimension = dimension_of_channel(channel);
            for (size_t j = 0; j < se3di_channel_get_width(channel); ++j) {
                se3di_channel_format_column(channel, j, name, sizeof name);
                const se3d_status status =
                    add(c, &(se3di_fmi_variable){.name = name,
                                                 .role = SE3DI_FMI_OUTPUT,
                                                 .dimension = dimension,
                                                 .has_unit = !se3di_dimension_is_none(dimension),
                                                 .component = j,
                                                 .output = k,
                                                 .channel = i});
                if (status < 0) {
                    return status;
                }
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_fmi_variables_list(se3d_model *model, se3di_fmi_variables *variables,
                                     char *problem, size_t problem_size)
{
    collector c = {model, variables, problem, problem_size};
    size_t index = 0;
    memset(variables, 0, sizeof *variables);
    se3di_iopool_init(&variables->pool, &model->pool.allocator);
    snprintf(problem, problem_size, "out of memory");
    const bool moves = se3di_fmi_find_analysis(model, &index);
    const se3di_fmi_variable time = {.name = "time",
                                     .role = SE3DI_FMI_TIME,
                                     .start = moves ? se3di_fmi_get_start(model, index) : 0.0,
                                     .dimension = {0, 0, 1, 0},
                                     .has_unit = true};
    se3d_status status = add(&c, &time);
    status = status < 0 ? status : add_inputs(&c);
    status = status < 0 ? status : add_parameters(&c);
    return status < 0 ? status : add_outputs(&c);
}

se3d_status se3di_fmi_apply_input(const se3d_model *model, const se3di_fmi_variable *input,
                                  double value)
{
    return se3di_element_set(model, input->element, input->component, value);
}

/* Units of model files have no negative exponents: "kg/s^2", and "s/s^2" where nothing is above. */
size_t se3di_fmi_format_value(const se3di_fmi_variable *parameter, double value,
                              char text[SE3DI_FMI_VALUE_SIZE])
{
    static const char *const names[4] = {"m", "kg", "s", "rad"};
    const se3di_dimension d = parameter->dimension;
    int over[4] = {d.length, d.mass, d.time, d.angle};
    int under[4] = {0, 0, 0, 0};
    bool has_over = false;
    size_t used = se3di_number_format(value, text);
    const char *mark = " ";
    for (size_t i = 0; i < 4; ++i) {
        under[i] = over[i] < 0 ? -over[i] : 0;
        over[i] += under[i];
        has_over = has_over || over[i] > 0;
    }
    for (size_t i = 0; i < 4 && !has_over; ++i) {
        has_over = under[i] > 0;
        over[i] = under[i] > 0;
        under[i] += over[i];
    }
    for (size_t i = 0; i < 8 && parameter->has_unit; ++i) {
        const int exponent = i < 4 ? over[i] : under[i - 4];
        if (exponent > 0) {
            used += (size_t)snprintf(text + used, SE3DI_FMI_VALUE_SIZE - used, "%s%s^%d",
                                     i < 4 ? mark : "/", names[i % 4], exponent);
            mark = "*";
        }
    }
    return used;
}

void se3di_fmi_variables_destroy(se3di_fmi_variables *variables)
{
    se3di_iopool_destroy(&variables->pool);
    memset(variables, 0, sizeof *variables);
}

bool se3di_fmi_variables_are_alike(const se3di_fmi_variables *a, const se3di_fmi_variables *b)
{
    bool alike = a->count == b->count;
    for (size_t k = 0; k < a->count && alike; ++k) {
        alike = strcmp(a->list[k].name, b->list[k].name) == 0 && a->list[k].role == b->list[k].role;
    }
    return alike;
}

void se3di_fmi_format_unit(se3di_dimension d, char *text, size_t size)
{
    static const char *const bases[] = {"kg", "m", "s", "rad"};
    const int exponents[] = {d.mass, d.length, d.time, d.angle};
    size_t used = 0;
    snprintf(text, size, "1");
    for (size_t k = 0; k < 4; ++k) {
        char exponent[12] = "";
        if (exponents[k] == 0 || used >= size) {
            continue;
        }
        if (exponents[k] != 1) {
            snprintf(exponent, sizeof exponent, "%d", exponents[k]);
        }
        snprintf(text + used, size - used, "%s%s%s", used > 0 ? "." : "", bases[k], exponent);
        used += strlen(text + used);
    }
}

void se3di_fmi_make_token(const se3d_model *model, const se3di_fmi_variables *variables,
                          char token[SE3DI_FMI_TOKEN_SIZE])
{
    const char *version = se3d_version_get_text();
    uint64_t names = se3di_hash_bytes(SE3DI_HASH_START, version, strlen(version) + 1);
    for (size_t k = 0; k < variables->count; ++k) {
        const se3di_fmi_variable *v = &variables->list[k];
        const unsigned char role = (unsigned char)v->role;
        names = se3di_hash_bytes(names, v->name, strlen(v->name) + 1);
        names = se3di_hash_bytes(names, &role, 1);
    }
    names = se3di_hash_bytes(names, &model->asked, sizeof model->asked);
    const uint64_t files = se3di_hash_bytes(model->content, &names, sizeof names);
    snprintf(token, SE3DI_FMI_TOKEN_SIZE, "{%08x-%04x-%04x-%04x-%04x%08x}", (unsigned)(files >> 32),
             (unsigned)(files >> 16 & 0xffff), (unsigned)(files & 0xffff), (unsigned)(names >> 48),
             (unsigned)(names >> 32 & 0xffff), (unsigned)names);
}
