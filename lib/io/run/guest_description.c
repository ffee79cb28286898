/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/run/guest_description.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/base/file.h"

#if defined(SE3D_HAS_EXPAT)
#include <expat.h>

enum { BLOCK = 4096, VARIABLES_MAX = 1000000 };

typedef struct reading {
    se3di_guest_description *d;
    se3di_iopool *pool;
    XML_Parser parser;
    bool is_short; /* no memory, or far too much */
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

/* NULL stays. */
static const char *copy(reading *r, const char *text)
{
    const char *made = text ? se3di_iopool_copy(r->pool, text, strlen(text)) : NULL;
    r->is_short = r->is_short || (text && !made);
    return made;
}

static void take_variable(reading *r, const char *type, const char **a)
{
    se3di_guest_description *d = r->d;
    const char *name = find(a, "name");
    const char *reference = find(a, "valueReference");
    const char *causality = find(a, "causality");
    if (!name || !reference) {
        return;
    }
    se3di_guest_variable *grown =
        d->count < VARIABLES_MAX
            ? se3di_iopool_grow(r->pool, d->variables, d->count, &d->capacity, sizeof *grown)
            : NULL;
    if (!grown) {
        r->is_short = true;
        return;
    }
    d->variables = grown;
    grown[d->count++] =
        (se3di_guest_variable){.name = copy(r, name),
                               .causality = copy(r, causality ? causality : "local"),
                               .type = copy(r, type),
                               .reference = (uint32_t)strtoul(reference, NULL, 10)};
}

static bool is(const char *a, const char *b)
{
    return strcmp(a, b) == 0;
}

static void take_head(reading *r, const char **a)
{
    const char *version = find(a, "fmiVersion");
    const char *token = find(a, "guid");
    r->d->version = !version ? 0 : version[0] == '2' ? 2 : version[0] == '3' ? 3 : 0;
    r->d->token = copy(r, token ? token : find(a, "instantiationToken"));
}

static bool is_true(const char **attributes, const char *name)
{
    const char *value = find(attributes, name);
    return value && (is(value, "true") || is(value, "1"));
}

static void take_kind(reading *r, const char **a)
{
    const bool old = r->d->version == 2;
    r->d->identifier = copy(r, find(a, "modelIdentifier"));
    r->d->is_single = is_true(a, "canBeInstantiatedOnlyOncePerProcess");
    r->d->has_states = is_true(a, old ? "canGetAndSetFMUstate" : "canGetAndSetFMUState") &&
                       is_true(a, old ? "canSerializeFMUstate" : "canSerializeFMUState");
}

static void XMLCALL begin(void *ctx, const char *name, const char **a)
{
    static const char *const types[] = {"Float64", "Float32", "Int64",  "UInt64",      "Int32",
                                        "UInt32",  "Int16",   "UInt16", "Int8",        "UInt8",
                                        "Boolean", "String",  "Binary", "Enumeration", "Clock"};
    reading *r = ctx;
    if (is(name, "fmiModelDescription")) {
        take_head(r, a);
    } else if (is(name, "CoSimulation")) {
        take_kind(r, a);
    } else if (is(name, "ScalarVariable")) {
        take_variable(r, "", a);
    } else if (r->d->version == 3 && r->d->count > 0 && is(name, "Dimension")) {
        r->d->variables[r->d->count - 1].type = "array";
    } else if (r->d->version == 2 && r->d->count > 0 && !r->d->variables[r->d->count - 1].type[0]) {
        r->d->variables[r->d->count - 1].type = copy(r, name);
    }
    for (size_t k = 0; k < sizeof types / sizeof *types && r->d->version == 3; ++k) {
        if (is(name, types[k]) && find(a, "valueReference")) {
            take_variable(r, name, a);
        }
    }
    if (r->is_short) {
        XML_StopParser(r->parser, XML_FALSE);
    }
}

static se3d_status parse(reading *r, FILE *file, char *problem, size_t size)
{
    char block[BLOCK];
    bool good = true;
    for (bool ends = false; good && !ends;) {
        const size_t used = fread(block, 1, sizeof block, file);
        ends = used < sizeof block;
        good = XML_Parse(r->parser, block, (int)used, ends) == XML_STATUS_OK;
    }
    if (r->is_short) {
        snprintf(problem, size, "out of memory, or far too many variables");
        return SE3D_ERR_NO_MEMORY;
    }
    if (!good) {
        snprintf(problem, size, "line %lu: %s", (unsigned long)XML_GetCurrentLineNumber(r->parser),
                 XML_ErrorString(XML_GetErrorCode(r->parser)));
        return SE3D_ERR_IO;
    }
    return SE3D_OK;
}

se3d_status se3di_guest_describe(const char *path, se3di_iopool *pool,
                                 se3di_guest_description *description, char *problem, size_t size)
{
    reading r = {.d = description, .pool = pool};
    FILE *file = se3di_file_open(path);
    memset(description, 0, sizeof *description);
    if (!file) {
        snprintf(problem, size, "%s", strerror(errno));
        return SE3D_ERR_IO;
    }
    r.parser = XML_ParserCreate(NULL);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    snprintf(problem, size, "out of memory");
    if (r.parser) {
        XML_SetUserData(r.parser, &r);
        XML_SetStartElementHandler(r.parser, begin);
        status = parse(&r, file, problem, size);
        XML_ParserFree(r.parser);
    }
    fclose(file);
    if (status >= 0 && (!description->version || !description->token || !description->identifier)) {
        snprintf(problem, size, "is no description of a unit of FMI 2.0 or 3.0 for co-simulation");
        return SE3D_ERR_UNSUPPORTED;
    }
    return status;
}
#else
se3d_status se3di_guest_describe(const char *path, se3di_iopool *pool,
                                 se3di_guest_description *description, char *problem, size_t size)
{
    (void)path;
    (void)pool;
    memset(description, 0, sizeof *description);
    snprintf(problem, size, "cannot be read: this program was built without expat");
    return SE3D_ERR_UNSUPPORTED;
}
#endif
