/* SPDX-License-Identifier: BSD-3-Clause */
#include "instance.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void say(fmi_instance *i, int status, const char *category, const char *message)
{
    const bool before = i->is_telling;
    i->is_telling = true;
    i->say(i, status, category, message);
    i->is_telling = before;
}

static void tell(void *ctx, se3d_log_level level, const char *message)
{
    fmi_instance *i = ctx;
    if (level == SE3D_LOG_ERROR) {
        say(i, FMI_ERROR, "logStatusError", message);
    } else if (level == SE3D_LOG_WARNING && i->logs_warnings) {
        say(i, FMI_WARNING, "logStatusWarning", message);
    } else if (level == SE3D_LOG_INFO && i->logs_events) {
        say(i, FMI_OK, "logEvents", message);
    }
}

static int digit(char c)
{
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
}

/* "file:///a%20b" as "/a b"; what is no URI stays. Without the slash at its end. */
static char *make_path(const char *text)
{
    const bool is_uri = strncmp(text, "file:", 5) == 0;
    char *path = malloc(strlen(text) + 1);
    char *out = path;
    if (!path) {
        return NULL;
    }
    if (is_uri) {
        text += 5;
        if (strncmp(text, "//", 2) == 0) { /* the host, which is this one */
            text += 2;
            text += strcspn(text, "/");
        }
    }
    for (; *text; ++text) {
        const int high = is_uri && *text == '%' ? digit(text[1]) : -1;
        const int low = high >= 0 ? digit(text[2]) : -1;
        *out++ = (char)(low >= 0 ? 16 * high + low : *text);
        text += low >= 0 ? 2 : 0;
    }
    while (out > path + 1 && out[-1] == '/') {
        --out;
    }
    *out = '\0';
    return path;
}

static char *copy_text(const char *text)
{
    char *copy = malloc(strlen(text) + 1);
    return copy ? strcpy(copy, text) : NULL;
}

fmi_instance *fmi_create(const fmi_instance *model, const char *name, const char *token,
                         const char *folder, bool exchanges)
{
    fmi_instance *i = malloc(sizeof *i);
    if (!i) {
        return NULL;
    }
    *i = *model;
    i->name = name ? copy_text(name) : NULL;
    char *path = folder ? make_path(folder) : NULL;
    i->unit = NULL;
    if (!name || !name[0]) {
        fmi_refuse(i, "instantiate", "the name of the instance is missing");
    } else if (!token) {
        fmi_refuse(i, "instantiate", "the token of the description is missing");
    } else if (!folder) {
        fmi_refuse(i, "instantiate", "the place of the resources is missing");
    } else if (!i->name || !path) {
        fmi_refuse(i, "instantiate", "out of memory");
    } else {
        i->unit = se3di_fmi_unit_create(path, token, exchanges, tell, i);
    }
    free(path);
    if (!i->unit) {
        fmi_destroy(i);
        return NULL;
    }
    return i;
}

void fmi_destroy(fmi_instance *instance)
{
    if (instance && !instance->is_telling) {
        se3di_fmi_unit_destroy(instance->unit);
        free(instance->name);
        free(instance);
    }
}

int fmi_done(const fmi_instance *instance, bool good)
{
    return good ? FMI_OK : se3di_fmi_unit_discards(instance->unit) ? FMI_DISCARD : FMI_ERROR;
}

int fmi_refuse(fmi_instance *instance, const char *call, const char *why)
{
    char text[300];
    snprintf(text, sizeof text, "%s: %s", call, why);
    say(instance, FMI_ERROR, "logStatusError", text);
    return FMI_ERROR;
}

int fmi_set_logging(fmi_instance *instance, bool on, size_t count, const char *const *categories)
{
    if (count > 0 && !categories) {
        return fmi_refuse(instance, "SetDebugLogging", "the categories are NULL");
    }
    bool known = true;
    for (size_t k = 0; k < count && known; ++k) {
        known = categories[k] &&
                (strcmp(categories[k], "logStatusError") == 0 ||
                 strcmp(categories[k], "logStatusWarning") == 0 ||
                 strcmp(categories[k], "logEvents") == 0 || strcmp(categories[k], "logAll") == 0);
    }
    if (!known) {
        return fmi_refuse(instance, "SetDebugLogging",
                          "unknown category, there are logStatusError, logStatusWarning, "
                          "logEvents, logAll");
    }
    for (size_t k = 0; k < count || (k == 0 && count == 0); ++k) {
        const char *category = count > 0 ? categories[k] : "logAll";
        const bool all = strcmp(category, "logAll") == 0;
        instance->logs_events =
            all || strcmp(category, "logEvents") == 0 ? on : instance->logs_events;
        instance->logs_warnings =
            all || strcmp(category, "logStatusWarning") == 0 ? on : instance->logs_warnings;
    }
    return FMI_OK;
}

/* ---- variables ------------------------------------------------------------------------------*/

static int check_arrays(fmi_instance *instance, const char *call, const void *references,
                        size_t count, const void *values, size_t value_count)
{
    if (count > 0 && (!references || !values)) {
        return fmi_refuse(instance, call, "value references or values are NULL");
    }
    return count == value_count
               ? FMI_OK
               : fmi_refuse(instance, call, "must be as many values as value references");
}

int fmi_get(fmi_instance *instance, const uint32_t *references, size_t count, double *values,
            size_t value_count)
{
    int status = check_arrays(instance, "get", references, count, values, value_count);
    for (size_t k = 0; k < count && status == FMI_OK; ++k) {
        status = fmi_done(instance, se3di_fmi_unit_get(instance->unit, references[k], &values[k]));
    }
    return status;
}

int fmi_set(fmi_instance *instance, const uint32_t *references, size_t count, const double *values,
            size_t value_count)
{
    const int status = check_arrays(instance, "set", references, count, values, value_count);
    if (status != FMI_OK) {
        return status;
    }
    return se3di_fmi_unit_set(instance->unit, references, count, values) ? FMI_OK : FMI_ERROR;
}

int fmi_derive(fmi_instance *instance, const fmi_direction *d)
{
    static const char call[] = "directional derivative";
    int status = check_arrays(instance, call, d->unknowns, d->unknown_count, d->out, d->out_count);
    if (status == FMI_OK) {
        status = check_arrays(instance, call, d->knowns, d->known_count, d->seed, d->seed_count);
    }
    return status != FMI_OK
               ? status
               : fmi_done(instance,
                          se3di_fmi_unit_derive(instance->unit, d->unknowns, d->unknown_count,
                                                d->knowns, d->known_count, d->seed, d->out));
}

int fmi_refuse_type(fmi_instance *instance, size_t count, const char *type)
{
    if (count == 0) {
        return FMI_OK;
    }
    char text[200];
    snprintf(text, sizeof text, "the unit has no variables of the type %s, all are real numbers",
             type);
    return fmi_refuse(instance, "get or set", text);
}

/* ---- states ---------------------------------------------------------------------------------*/

/* Room for `size` bytes in *state, made if it is NULL. */
static fmi_state *make_room(void **state, size_t size)
{
    fmi_state *s = *state ? *state : calloc(1, sizeof *s);
    unsigned char *bytes = s && (s->size < size || !s->bytes) ? realloc(s->bytes, size) : NULL;
    if (!s) {
        return NULL;
    }
    if (bytes) {
        s->bytes = bytes;
    } else if (s->size < size || !s->bytes) {
        if (!*state) {
            free(s);
        }
        return NULL;
    }
    s->size = size;
    *state = s;
    return s;
}

int fmi_get_state(fmi_instance *instance, void **state)
{
    size_t size = 0;
    if (!state) {
        return fmi_refuse(instance, "GetFMUState", "the place for the state is NULL");
    }
    if (!se3di_fmi_unit_write(instance->unit, NULL, &size)) {
        return FMI_ERROR;
    }
    fmi_state *s = make_room(state, size);
    if (!s) {
        return fmi_refuse(instance, "GetFMUState", "out of memory");
    }
    return se3di_fmi_unit_write(instance->unit, s->bytes, &size) ? FMI_OK : FMI_ERROR;
}

int fmi_set_state(fmi_instance *instance, const void *state)
{
    const fmi_state *s = state;
    if (!s) {
        return fmi_refuse(instance, "SetFMUState", "the state is NULL");
    }
    return se3di_fmi_unit_read(instance->unit, s->bytes, s->size) ? FMI_OK : FMI_ERROR;
}

int fmi_free_state(void **state)
{
    fmi_state *s = state ? *state : NULL;
    if (s) {
        free(s->bytes);
        free(s);
        *state = NULL;
    }
    return FMI_OK;
}

int fmi_get_state_size(fmi_instance *instance, const void *state, size_t *size)
{
    if (!state || !size) {
        return fmi_refuse(instance, "SerializedFMUStateSize",
                          "the state or the place for the size is NULL");
    }
    *size = ((const fmi_state *)state)->size;
    return FMI_OK;
}

int fmi_write_state(fmi_instance *instance, const void *state, void *bytes, size_t size)
{
    const fmi_state *s = state;
    if (!s || !bytes) {
        return fmi_refuse(instance, "SerializeFMUState", "the state or the place for it is NULL");
    }
    if (size < s->size) {
        return fmi_refuse(instance, "SerializeFMUState", "the place for the state is too small");
    }
    memcpy(bytes, s->bytes, s->size);
    return FMI_OK;
}

int fmi_read_state(fmi_instance *instance, const void *bytes, size_t size, void **state)
{
    if (!state || !bytes || size == 0) {
        return fmi_refuse(instance, "DeserializeFMUState", "the bytes or the state are missing");
    }
    fmi_state *s = make_room(state, size);
    if (!s) {
        return fmi_refuse(instance, "DeserializeFMUState", "out of memory");
    }
    memcpy(s->bytes, bytes, size);
    return FMI_OK;
}
