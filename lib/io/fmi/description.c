/* SPDX-License-Identifier: BSD-3-Clause */
/* The same variables for both versions of the standard: 2.0 counts them from 1, 3.0 names them by
 * their value references. */
#include "io/fmi/description.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/base/number.h"
#include "io/channel/event.h"
#include "io/channel/output.h"

typedef struct writer {
    const se3di_fmi_description *d;
    char *text; /* NULL: measure only */
    size_t used, room;
} writer;

void se3di_fmi_make_identifier(const char *name, char identifier[SE3DI_FMI_IDENTIFIER_SIZE])
{
    size_t used = 0;
    if (!isalpha((unsigned char)name[0])) {
        identifier[used++] = 'm';
    }
    for (; *name && used + 1 < SE3DI_FMI_IDENTIFIER_SIZE; ++name) {
        const unsigned char c = (unsigned char)*name;
        identifier[used++] = (char)(c < 128 && isalnum(c) ? c : '_');
    }
    identifier[used] = '\0';
}

static void put_bytes(writer *w, const char *text, size_t length)
{
    if (w->text && w->used + length < w->room) {
        memcpy(w->text + w->used, text, length);
        w->text[w->used + length] = '\0';
    }
    w->used += length;
}

SE3DI_IO_FORMAT(2, 3)
static void put(writer *w, const char *format, ...)
{
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    put_bytes(w, text, length > 0 ? strlen(text) : 0);
}

/* ` name="text"`, whatever the text holds; what no XML may hold becomes '?'. */
static void put_text(writer *w, const char *name, const char *text)
{
    put(w, " %s=\"", name);
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        const char *mark = *text == '&'   ? "&amp;"
                           : *text == '<' ? "&lt;"
                           : *text == '>' ? "&gt;"
                           : *text == '"' ? "&quot;"
                                          : NULL;
        if (mark) {
            put(w, "%s", mark);
        } else if (length == 0) {
            put(w, "?");
        } else {
            put_bytes(w, text, length);
        }
        text += length > 0 ? length : 1;
    }
    put(w, "\"");
}

static void put_number(writer *w, const char *name, double value)
{
    char text[SE3DI_NUMBER_SIZE];
    se3di_number_format(value, text);
    put(w, " %s=\"%s\"", name, text);
}

/* ---- parts ----------------------------------------------------------------------------------*/

static bool can_end(const se3d_model *model)
{
    bool ends = false;
    for (size_t k = 0; k < model->event_count; ++k) {
        ends = ends || model->events[k].action == SE3D_EVENT_STOP;
    }
    return ends;
}

static void put_head(writer *w)
{
    const se3d_model *model = w->d->model;
    char token[SE3DI_FMI_TOKEN_SIZE];
    const bool new = w->d->version == 3;
    se3di_fmi_make_token(model, w->d->variables, token);
    put(w, "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<fmiModelDescription fmiVersion=\"%s\"",
        new ? "3.0" : "2.0");
    put_text(w, "modelName", model->name);
    put_text(w, new ? "instantiationToken" : "guid", token);
    if (model->title[0]) {
        put_text(w, "description", model->title);
    }
    put(w, " generationTool=\"se3d %s\" variableNamingConvention=\"flat\"",
        se3d_version_get_text());
    if (!new) {
        put(w, " numberOfEventIndicators=\"%zu\"", w->d->variables->indicators);
    }
    put(w, ">\n");
}

/* A kind of unit: its own attributes, and those of both. */
static void put_kind(writer *w, const char *kind, const char *own)
{
    const bool new = w->d->version == 3;
    put(w, "  <%s modelIdentifier=\"%s\"%s", kind, w->d->identifier, own);
    put(w, new ? " canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\" "
                 "providesDirectionalDerivatives=\"true\"/>\n"
               : " canGetAndSetFMUstate=\"true\" canSerializeFMUstate=\"true\" "
                 "providesDirectionalDerivative=\"true\" "
                 "canNotUseMemoryManagementFunctions=\"true\"/>\n");
}

static void put_kinds(writer *w)
{
    const bool new = w->d->version == 3;
    if (w->d->variables->states > 0) {
        put_kind(w, "ModelExchange", new ? " needsCompletedIntegratorStep=\"true\"" : "");
    }
    put_kind(w, "CoSimulation",
             new &&can_end(w->d->model) ? " canHandleVariableCommunicationStepSize=\"true\" "
                                          "mightReturnEarlyFromDoStep=\"true\""
                                        : " canHandleVariableCommunicationStepSize=\"true\"");
}

static void put_units(writer *w)
{
    const se3di_fmi_variables *v = w->d->variables;
    put(w, "  <UnitDefinitions>\n");
    for (size_t k = 0; k < v->count; ++k) {
        const se3di_dimension d = v->list[k].dimension;
        bool is_known = !v->list[k].has_unit;
        char name[60];
        for (size_t i = 0; i < k && !is_known; ++i) {
            is_known = v->list[i].has_unit && memcmp(&v->list[i].dimension, &d, sizeof d) == 0;
        }
        if (is_known) {
            continue;
        }
        se3di_fmi_format_unit(d, name, sizeof name);
        put(w, "    <Unit name=\"%s\"><BaseUnit kg=\"%d\" m=\"%d\" s=\"%d\" rad=\"%d\"/></Unit>\n",
            name, d.mass, d.length, d.time, d.angle);
    }
    put(w, "  </UnitDefinitions>\n");
}

static void put_log(writer *w)
{
    put(w, "  <LogCategories>\n"
           "    <Category name=\"logStatusError\" description=\"failures\"/>\n"
           "    <Category name=\"logStatusWarning\" description=\"warnings\"/>\n"
           "    <Category name=\"logEvents\" description=\"what happens\"/>\n"
           "    <Category name=\"logAll\" description=\"everything\"/>\n"
           "  </LogCategories>\n");
}

static void put_experiment(writer *w)
{
    const se3d_model *model = w->d->model;
    size_t index = 0;
    double every = 0.0;
    se3di_fmi_find_analysis(model, &index);
    const se3di_analysis_entry *entry = &model->analyses[index];
    const double start = se3di_fmi_get_start(model, index);
    put(w, "  <DefaultExperiment");
    put_number(w, "startTime", start);
    put_number(w, "stopTime", start + entry->analysis.duration);
    if (entry->solver.tolerance > 0.0) {
        put_number(w, "tolerance", entry->solver.tolerance);
    }
    if (model->output_count > 0) {
        se3di_output_count_rows(&model->outputs[0], entry, &every);
    }
    if (every > 0.0) {
        put_number(w, "stepSize", every);
    }
    put(w, "/>\n");
}

static const char *describe(const se3di_fmi_variable *v)
{
    switch (v->role) {
    case SE3DI_FMI_TIME:
        return "time";
    case SE3DI_FMI_INPUT:
        return "what the element is set to";
    case SE3DI_FMI_OUTPUT:
        return "channel of the model";
    case SE3DI_FMI_STATE:
        return "joint coordinate, its rate, or state of the model";
    case SE3DI_FMI_DERIVATIVE:
        return "derivative of a state";
    case SE3DI_FMI_INDICATOR:
        return "changes its sign at an event or at the end of a stop";
    default:
        return "parameter of the model";
    }
}

/* Causality and variability of the standard; a start where it wants one. */
static void put_role(writer *w, const se3di_fmi_variable *v)
{
    static const char *const roles[] = {" causality=\"independent\" variability=\"continuous\"",
                                        " causality=\"input\" variability=\"continuous\"",
                                        " causality=\"parameter\" variability=\"fixed\"",
                                        " causality=\"calculatedParameter\" variability=\"fixed\"",
                                        " causality=\"output\" variability=\"continuous\"",
                                        " causality=\"local\" variability=\"continuous\"",
                                        " causality=\"local\" variability=\"continuous\"",
                                        " causality=\"local\" variability=\"continuous\""};
    put(w, "%s", v->jumps ? " causality=\"input\" variability=\"discrete\"" : roles[v->role]);
}

static void put_variable(writer *w, size_t k)
{
    const se3di_fmi_variable *v = &w->d->variables->list[k];
    const bool new = w->d->version == 3;
    char unit[60];
    put(w, new ? "    <Float64" : "    <ScalarVariable");
    put_text(w, "name", v->name);
    put(w, " valueReference=\"%zu\"", k);
    put_text(w, "description", describe(v));
    put_role(w, v);
    put(w, new ? "" : "><Real");
    if (v->has_unit) {
        se3di_fmi_format_unit(v->dimension, unit, sizeof unit);
        put_text(w, "unit", unit);
    }
    if (v->role == SE3DI_FMI_INPUT || v->role == SE3DI_FMI_PARAMETER) {
        put_number(w, "start", v->start);
    } else if (v->role == SE3DI_FMI_STATE) {
        put_number(w, "nominal", v->nominal);
    } else if (v->role == SE3DI_FMI_DERIVATIVE) {
        put(w, " derivative=\"%zu\"", w->d->variables->state + v->element + (new ? 0 : 1));
    }
    put(w, new ? "/>\n" : "/></ScalarVariable>\n");
}

/* ---- structure ------------------------------------------------------------------------------*/

/* What is calculated: after which sections of the standard. */
typedef enum section { OUTPUTS, DERIVATIVES, INITIAL, INDICATORS } section;

static bool belongs(se3di_fmi_role role, section which)
{
    return role == SE3DI_FMI_OUTPUT       ? which == OUTPUTS || which == INITIAL
           : role == SE3DI_FMI_DERIVATIVE ? which == DERIVATIVES || which == INITIAL
           : role == SE3DI_FMI_INDICATOR
               ? which == INDICATORS
               : which == INITIAL && (role == SE3DI_FMI_CALCULATED || role == SE3DI_FMI_STATE);
}

/* The number of variable k. */
static void put_place(writer *w, size_t k, bool *is_first)
{
    put(w, "%s%zu", *is_first ? "" : " ", k + (w->d->version == 3 ? 0 : 1));
    *is_first = false;
}

/* Outputs that follow from the motion depend on no effort or load; without states to be told they
 * are left to depend on everything. */
static bool follows_from_motion(const writer *w, const se3di_fmi_variable *v)
{
    return v->role == SE3DI_FMI_OUTPUT && w->d->variables->states > 0 &&
           se3di_channel_is_of_motion(&w->d->model->outputs[v->output].channels[v->channel]);
}

/* What an unknown depends on, as far as it is not everything. */
static void put_dependencies(writer *w, section which, size_t k)
{
    const se3di_fmi_variables *all = w->d->variables;
    const se3di_fmi_variable *v = &all->list[k];
    bool is_first = true;
    if (which == DERIVATIVES && !all->projects && v->component > 0) {
        put(w, " dependencies=\"");
        put_place(w, all->state + v->component - 1, &is_first);
        put(w, "\" dependenciesKind=\"constant\"");
    } else if (which == OUTPUTS && follows_from_motion(w, v)) {
        put(w, " dependencies=\"");
        for (size_t i = 0; i < all->count; ++i) {
            const se3di_fmi_variable *known = &all->list[i];
            if (known->role == SE3DI_FMI_TIME || known->role == SE3DI_FMI_STATE || known->jumps) {
                put_place(w, i, &is_first);
            }
        }
        put(w, "\"");
    }
}

/* 2.0 has them in lists, 3.0 by their names. */
static void put_unknowns(writer *w, section which)
{
    static const char *const lists[] = {"Outputs", "Derivatives", "InitialUnknowns"};
    static const char *const names[] = {"Output", "ContinuousStateDerivative", "InitialUnknown",
                                        "EventIndicator"};
    const se3di_fmi_variables *v = w->d->variables;
    const bool new = w->d->version == 3;
    bool is_open = false;
    for (size_t k = 0; k < v->count && (new || which != INDICATORS); ++k) {
        if (!belongs(v->list[k].role, which)) {
            continue;
        }
        if (!is_open && !new) {
            put(w, "    <%s>\n", lists[which]);
        }
        is_open = true;
        if (new) {
            put(w, "    <%s valueReference=\"%zu\"", names[which], k);
        } else {
            put(w, "      <Unknown index=\"%zu\"", k + 1);
        }
        put_dependencies(w, which, k);
        put(w, "/>\n");
    }
    if (is_open && !new) {
        put(w, "    </%s>\n", lists[which]);
    }
}

static void put_all(writer *w)
{
    put_head(w);
    put_kinds(w);
    put_units(w);
    put_log(w);
    put_experiment(w);
    put(w, "  <ModelVariables>\n");
    for (size_t k = 0; k < w->d->variables->count; ++k) {
        put_variable(w, k);
    }
    put(w, "  </ModelVariables>\n  <ModelStructure>\n");
    for (section which = OUTPUTS; which <= INDICATORS; ++which) {
        put_unknowns(w, which);
    }
    put(w, "  </ModelStructure>\n</fmiModelDescription>\n");
}

char *se3di_fmi_description_write(const se3di_fmi_description *description, se3di_iopool *pool,
                                  size_t *size)
{
    writer w = {.d = description};
    put_all(&w);
    w.room = w.used + 1;
    w.text = se3di_iopool_alloc(pool, w.room);
    w.used = 0;
    if (w.text) {
        put_all(&w);
        *size = w.used;
    }
    return w.text;
}
