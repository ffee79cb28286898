/* SPDX-License-Identifier: BSD-3-Clause */
#include <expat.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

typedef struct reading {
    description *d;
    int in_outputs, in_unknowns, in_derivatives;
} reading;

static const char *find(const char **attributes, const char *name)
{
    for (; attributes[0]; attributes += 2) {
        if (strcmp(attributes[0], name) == 0) {
            return attributes[1];
        }
    }
    return NULL;
}

static void copy(char *out, size_t size, const char *text)
{
    snprintf(out, size, "%s", text ? text : "");
}

static void take_head(description *d, const char **a)
{
    const char *token = find(a, "guid");
    const char *indicators = find(a, "numberOfEventIndicators");
    copy(d->version, sizeof d->version, find(a, "fmiVersion"));
    d->indicator_count = indicators ? strtoul(indicators, NULL, 10) : 0;
    copy(d->model, sizeof d->model, find(a, "modelName"));
    copy(d->token, sizeof d->token, token ? token : find(a, "instantiationToken"));
}

static int is_true(const char *text)
{
    return text && strcmp(text, "true") == 0;
}

static void take_kind(description *d, const char **a)
{
    copy(d->identifier, sizeof d->identifier, find(a, "modelIdentifier"));
    d->can_save =
        is_true(find(a, "canGetAndSetFMUstate")) || is_true(find(a, "canGetAndSetFMUState"));
    d->can_serialize =
        is_true(find(a, "canSerializeFMUstate")) || is_true(find(a, "canSerializeFMUState"));
    d->has_derivatives = is_true(find(a, "providesDirectionalDerivative")) ||
                         is_true(find(a, "providesDirectionalDerivatives"));
}

static void take_type(description *d, const char **a)
{
    if (d->count > 0) {
        variable *v = &d->variables[d->count - 1];
        const char *start = find(a, "start");
        copy(v->unit, sizeof v->unit, find(a, "unit"));
        v->has_start = start != NULL;
        v->start = start ? strtod(start, NULL) : 0.0;
        const char *nominal = find(a, "nominal");
        const char *derivative = find(a, "derivative");
        v->nominal = nominal ? strtod(nominal, NULL) : 0.0;
        v->derivative = derivative ? strtoul(derivative, NULL, 10) + (d->version[0] == '3') : 0;
    }
}

static void take_variable(description *d, const char **a)
{
    if (d->count == VARIABLES_MAX) {
        d->malformed = 1;
        return;
    }
    variable *v = &d->variables[d->count++];
    const char *reference = find(a, "valueReference");
    copy(v->name, sizeof v->name, find(a, "name"));
    copy(v->causality, sizeof v->causality, find(a, "causality"));
    copy(v->variability, sizeof v->variability, find(a, "variability"));
    v->reference = reference ? (uint32_t)strtoul(reference, NULL, 10) : 0;
    d->malformed |= !reference;
}

/* The place of a variable of this reference. */
static size_t find_reference(description *d, const char *text)
{
    for (size_t k = 0; k < d->count && text; ++k) {
        if (d->variables[k].reference == (uint32_t)strtoul(text, NULL, 10)) {
            return k;
        }
    }
    d->malformed = 1;
    return 0;
}

static void take_unknown(description *d, size_t *list, size_t *count, size_t index)
{
    if (*count < VARIABLES_MAX && index < d->count) {
        list[(*count)++] = index;
    } else {
        d->malformed = 1;
    }
}

/* The one thing that a derivative is. */
static void take_derivative(description *d, const char **a, size_t index)
{
    const char *dependencies = find(a, "dependencies");
    const char *kind = find(a, "dependenciesKind");
    if (dependencies && kind && strcmp(kind, "constant") == 0 &&
        d->derivative_count < VARIABLES_MAX) {
        d->constants[d->derivative_count] =
            strtoul(dependencies, NULL, 10) + (d->version[0] == '3');
    }
    take_unknown(d, d->derivatives, &d->derivative_count, index);
}

static void take_index(reading *r, const char **a)
{
    description *d = r->d;
    const char *text = find(a, "index");
    const size_t index = text ? strtoul(text, NULL, 10) - 1 : VARIABLES_MAX;
    if (r->in_outputs) {
        take_unknown(d, d->outputs, &d->output_count, index);
    } else if (r->in_derivatives) {
        take_derivative(d, a, index);
    } else {
        take_unknown(d, d->unknowns, &d->unknown_count, index);
    }
    d->malformed |= r->in_outputs + r->in_unknowns + r->in_derivatives != 1;
}

static void take_named(description *d, const char *name, const char **a)
{
    const size_t index = find_reference(d, find(a, "valueReference"));
    if (strcmp(name, "Output") == 0) {
        take_unknown(d, d->outputs, &d->output_count, index);
    } else if (strcmp(name, "InitialUnknown") == 0) {
        take_unknown(d, d->unknowns, &d->unknown_count, index);
    } else if (strcmp(name, "ContinuousStateDerivative") == 0) {
        take_derivative(d, a, index);
    } else {
        take_unknown(d, d->indicators, &d->indicator_count, index);
    }
}

static void take_experiment(description *d, const char **a)
{
    const char *start = find(a, "startTime");
    const char *stop = find(a, "stopTime");
    d->start = start ? strtod(start, NULL) : 0.0;
    d->stop = stop ? strtod(stop, NULL) : 0.0;
}

static void XMLCALL begin(void *ctx, const char *name, const char **a)
{
    reading *r = ctx;
    description *d = r->d;
    if (strcmp(name, "fmiModelDescription") == 0) {
        take_head(d, a);
    } else if (strcmp(name, "CoSimulation") == 0) {
        take_kind(d, a);
    } else if (strcmp(name, "ModelExchange") == 0) {
        d->exchanges = 1;
    } else if (strcmp(name, "ScalarVariable") == 0) {
        take_variable(d, a);
    } else if (strcmp(name, "Real") == 0) {
        take_type(d, a);
    } else if (strcmp(name, "Float64") == 0) {
        take_variable(d, a);
        take_type(d, a);
    } else if (strcmp(name, "Unit") == 0 && d->unit_count < 100) {
        copy(d->units[d->unit_count++], sizeof d->units[0], find(a, "name"));
    } else if (strcmp(name, "Category") == 0) {
        ++d->category_count;
    } else if (strcmp(name, "DefaultExperiment") == 0) {
        take_experiment(d, a);
    } else if (strcmp(name, "Outputs") == 0) {
        r->in_outputs = 1;
    } else if (strcmp(name, "InitialUnknowns") == 0) {
        r->in_unknowns = 1;
    } else if (strcmp(name, "Derivatives") == 0) {
        r->in_derivatives = 1;
    } else if (strcmp(name, "Unknown") == 0) {
        take_index(r, a);
    } else if (strcmp(name, "Output") == 0 || strcmp(name, "InitialUnknown") == 0 ||
               strcmp(name, "ContinuousStateDerivative") == 0 ||
               strcmp(name, "EventIndicator") == 0) {
        take_named(d, name, a);
    }
}

static void XMLCALL end(void *ctx, const char *name)
{
    reading *r = ctx;
    if (strcmp(name, "Outputs") == 0) {
        r->in_outputs = 0;
    } else if (strcmp(name, "InitialUnknowns") == 0) {
        r->in_unknowns = 0;
    } else if (strcmp(name, "Derivatives") == 0) {
        r->in_derivatives = 0;
    }
}

int description_read(const char *path, description *d)
{
    char block[4096];
    reading r = {d, 0, 0, 0};
    FILE *file = fopen(path, "rb");
    XML_Parser parser = XML_ParserCreate(NULL);
    int good = file && parser;
    memset(d, 0, sizeof *d);
    if (good) {
        XML_SetUserData(parser, &r);
        XML_SetElementHandler(parser, begin, end);
    }
    while (good && !feof(file)) {
        const size_t used = fread(block, 1, sizeof block, file);
        good = XML_Parse(parser, block, (int)used, used < sizeof block) == XML_STATUS_OK;
    }
    if (file) {
        fclose(file);
    }
    if (parser) {
        XML_ParserFree(parser);
    }
    return good && !d->malformed;
}
