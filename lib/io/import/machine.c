/* SPDX-License-Identifier: BSD-3-Clause */
/* What an importer fills: bodies, entries, names and notes. */
#include "io/import/machine.h"

#include <locale.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "io/document/document.h"
#include "io/import/scan.h"

enum { TEXT_SIZE = 65536, NOTES_MAX = 1000, NAME_MAX_LENGTH = 100 };

bool se3di_machine_fail_memory(se3di_machine *m)
{
    if (m->status >= 0) {
        m->status = SE3D_ERR_NO_MEMORY;
        se3di_document_report(m->error, "", 0, 0, m->file, "out of memory");
    }
    return false;
}

bool se3di_machine_fail(se3di_machine *m, size_t line, size_t column, const char *format, ...)
{
    char text[900];
    if (m->pool->is_short) {
        return se3di_machine_fail_memory(m);
    }
    if (m->status >= 0) {
        va_list list;
        va_start(list, format);
        vsnprintf(text, sizeof text, format, list);
        va_end(list);
        m->status = SE3D_ERR_MODEL;
        const char *file = m->part ? m->part : m->file;
        se3di_document_report(m->error, file, line, column, line > 0 ? "" : file, text);
    }
    return false;
}

SE3DI_IO_FORMAT(2, 0)
static const char *format_text(se3di_machine *m, const char *format, va_list list)
{
    va_list again;
    va_copy(again, list);
    const int length = vsnprintf(NULL, 0, format, again);
    va_end(again);
    char *text = NULL;
    if (length >= 0) {
        text = se3di_iopool_alloc(m->pool, (size_t)length + 1);
    }
    if (!text) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    vsnprintf(text, (size_t)length + 1, format, list);
    return text;
}

const char *se3di_machine_text(se3di_machine *m, const char *format, ...)
{
    va_list list;
    va_start(list, format);
    const char *text = format_text(m, format, list);
    va_end(list);
    return text;
}

void se3di_machine_clean(char *text)
{
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        if (length == 0) {
            *text++ = '?';
        } else {
            text += length;
        }
    }
}

void se3di_machine_note_of(se3di_machine *m, int32_t kind, size_t line, const char *format, ...)
{
    char text[900];
    va_list list;
    ++m->note_count;
    m->lost_count += kind == SE3D_IMPORT_LOST;
    if (m->note_count > NOTES_MAX) {
        return;
    }
    va_start(list, format);
    size_t used = 0;
    if (m->part && line > 0) {
        used = (size_t)snprintf(text, sizeof text, "%.400s:%zu: ", m->part, line);
        line = 0;
    }
    vsnprintf(text + used, sizeof text - used, format, list);
    va_end(list);
    se3di_machine_clean(text);
    se3di_machine_note *note = se3di_iopool_alloc(m->pool, sizeof *note);
    const char *copy = note ? se3di_iopool_copy(m->pool, text, strlen(text)) : NULL;
    if (!copy) {
        se3di_machine_fail_memory(m);
        return;
    }
    note->kind = kind;
    note->line = line;
    note->text = copy;
    if (m->last_note) {
        m->last_note->next = note;
    } else {
        m->notes = note;
    }
    m->last_note = note;
}

/* "%.15g" with a point. What units or a change of frames made too large for a model is refused. */
static void format_number(se3di_machine *m, double value, char text[40])
{
    const char *point = localeconv()->decimal_point;
    if (!(fabs(value) <= SE3DI_SCAN_LARGEST)) {
        se3di_machine_fail(
            m, 0, 0,
            "a number becomes %g in SI units and the model's frames, must be at most "
            "1e40 in magnitude",
            value);
    }
    snprintf(text, 40, "%.15g", value == 0.0 ? 0.0 : value);
    char *at = point[0] && strcmp(point, ".") != 0 ? strstr(text, point) : NULL;
    if (at) {
        const size_t length = strlen(point);
        *at = '.';
        memmove(at + 1, at + length, strlen(at + length) + 1);
    }
}

const char *se3di_machine_number(se3di_machine *m, double value)
{
    char text[40];
    format_number(m, value, text);
    return se3di_machine_text(m, "%s", text);
}

const char *se3di_machine_numbers(se3di_machine *m, const double *values, size_t count)
{
    char text[40 * 36 + 8] = "[";
    size_t used = 1;
    double largest = 0.0;
    for (size_t k = 0; k < count; ++k) {
        largest = fmax(largest, fabs(values[k]));
    }
    for (size_t k = 0; k < count && k < 36; ++k) {
        char number[40];
        format_number(m, fabs(values[k]) > 1e-15 * largest ? values[k] : 0.0, number);
        used +=
            (size_t)snprintf(text + used, sizeof text - used, "%s%s", k > 0 ? ", " : "", number);
    }
    return se3di_machine_text(m, "%s]", text);
}

const char *se3di_machine_turn_text(se3di_machine *m, const double A[9])
{
    double rpy[3];
    const char *part[3];
    se3di_turn_to_rpy(A, rpy);
    for (int k = 0; k < 3; ++k) {
        const double degrees = rpy[k] * 180.0 / 3.14159265358979323846;
        const double whole = nearbyint(degrees);
        if (fabs(degrees) < 1e-13) {
            part[k] = "0";
        } else if (fabs(degrees - whole) < 1e-13 * fabs(whole)) {
            part[k] = se3di_machine_text(m, "%.0f*deg", whole);
        } else {
            part[k] = se3di_machine_number(m, rpy[k]);
        }
        if (!part[k]) {
            return NULL;
        }
    }
    return se3di_machine_text(m, "{rpy: [%s, %s, %s]}", part[0], part[1], part[2]);
}

const char *se3di_machine_quote(se3di_machine *m, const char *text)
{
    static const char *const special[] = {"true", "false", "null", "yes", "no", "on", "off",
                                          "True", "False", "Null", "Yes", "No", "On", "Off",
                                          "TRUE", "FALSE", "NULL", "YES", "NO", "ON", "OFF"};
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
    static const char more[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789/-+.";
    bool plain = strspn(text, letters) > 0 && !text[strspn(text, more)];
    for (size_t k = 0; plain && k < sizeof special / sizeof *special; ++k) {
        plain = strcmp(text, special[k]) != 0;
    }
    if (plain) {
        return text;
    }
    /* in single quotes nothing is special but the quote itself */
    const size_t length = strlen(text);
    char *quoted = se3di_iopool_alloc(m->pool, 2 * length + 3);
    if (!quoted) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    char *to = quoted;
    *to++ = '\'';
    for (const char *from = text; *from; ++from) {
        *to++ = *from;
        if (*from == '\'') {
            *to++ = '\'';
        }
    }
    *to = '\'';
    return quoted;
}

/* A valid name: what the model file does not allow becomes '_'. */
static void make_valid(const char *text, char name[NAME_MAX_LENGTH + 1])
{
    size_t used = 0;
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        const size_t take = length > 0 ? length : 1;
        if (used + take > NAME_MAX_LENGTH) {
            break;
        }
        if (length == 0 || strchr(".,;\"'`[]{}\\", *text)) {
            name[used++] = '_';
        } else {
            memcpy(name + used, text, take);
            used += take;
        }
        text += take;
    }
    while (used > 0 && name[used - 1] == ' ') {
        --used;
    }
    name[used] = '\0';
    const size_t blanks = strspn(name, " ");
    memmove(name, name + blanks, used - blanks + 1);
    if (name[0] && strchr(SE3DI_FORMULA_SIGNS, name[0])) {
        name[0] = '_';
    }
}

static bool is_taken(const se3di_ionames *names, const char *name)
{
    size_t index;
    return se3di_ionames_find(names, name, &index);
}

const char *se3di_machine_extend(se3di_machine *m, const char *name, const char *end)
{
    const size_t room = NAME_MAX_LENGTH - strlen(end);
    size_t length = 0;
    while (name[length] && length < room) {
        const size_t size = se3d_text_get_character(name + length);
        if (length + (size > 0 ? size : 1) > room) {
            break;
        }
        length += size > 0 ? size : 1;
    }
    return se3di_machine_text(m, "%.*s%s", (int)length, name, end);
}

/* With a number that makes it another name. */
static const char *count_up(se3di_machine *m, const char *name, size_t number)
{
    char end[32];
    snprintf(end, sizeof end, "_%zu", number);
    return se3di_machine_extend(m, name, end);
}

/* `text` made valid, with a number at its end if it is taken. */
static const char *take_name(se3di_machine *m, se3di_ionames *names, const char *text,
                             const char *kind, size_t line)
{
    char valid[NAME_MAX_LENGTH + 1];
    make_valid(text ? text : "", valid);
    const char *name = se3di_machine_text(m, "%s", valid[0] ? valid : kind);
    size_t number = 2;
    if (name && !valid[0]) {
        number = 1;
        name = se3di_machine_text(m, "%s%zu", kind, ++m->counter);
    }
    while (name && is_taken(names, name)) {
        /* names that are made up grow with their number: the search does not begin anew */
        name = valid[0] && number < 20 ? count_up(m, valid, number++)
                                       : count_up(m, valid[0] ? valid : kind, ++m->counter);
    }
    if (!name || !se3di_ionames_add(names, m->pool, name, 0)) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    if (text && text[0] && strcmp(text, name) != 0) {
        se3di_machine_note_of(m, SE3D_IMPORT_NAMED, line, "the %s `%.200s` is called `%s`", kind,
                              text, name);
    }
    return name;
}

const char *se3di_machine_name_body(se3di_machine *m, const char *text, const char *kind,
                                    size_t line)
{
    /* the ground and the channels of the whole model */
    static const char *const words[] = {"ground",    "energy",     "work",
                                        "violation", "contacts",   "particles",
                                        "steps",     "iterations", "time"};
    for (size_t k = 0; k < sizeof words / sizeof *words; ++k) {
        if (!is_taken(&m->body_names, words[k]) &&
            !se3di_ionames_add(&m->body_names, m->pool, words[k], 0)) {
            se3di_machine_fail_memory(m);
            return NULL;
        }
    }
    return take_name(m, &m->body_names, text, kind, line);
}

const char *se3di_machine_name(se3di_machine *m, const char *text, const char *kind, size_t line)
{
    return take_name(m, &m->names, text, kind, line);
}

se3di_machine_body *se3di_machine_add_body(se3di_machine *m, const char *name)
{
    se3di_machine_body *grown =
        se3di_iopool_grow(m->pool, m->bodies, m->body_count, &m->body_room, sizeof *grown);
    if (!grown || !name) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    m->bodies = grown;
    se3di_machine_body *body = &m->bodies[m->body_count++];
    memset(body, 0, sizeof *body);
    body->name = name;
    body->frame = se3di_frame_identity();
    return body;
}

se3di_machine_body *se3di_machine_body_at(se3di_machine *m, size_t index)
{
    return index == SE3DI_GROUND ? &m->ground : &m->bodies[index];
}

const char *se3di_machine_body_name(se3di_machine *m, size_t index)
{
    return se3di_machine_body_at(m, index)->name;
}

se3di_machine_shape *se3di_parts_add_shape(se3di_machine *m, se3di_machine_parts *parts)
{
    se3di_machine_shape *shape = se3di_iopool_alloc(m->pool, sizeof *shape);
    if (!shape) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    shape->frame = se3di_frame_identity();
    shape->scale = 1.0;
    shape->color[0] = -1.0;
    if (parts->last_shape) {
        parts->last_shape->next = shape;
    } else {
        parts->shapes = shape;
    }
    parts->last_shape = shape;
    return shape;
}

se3di_machine_shape *se3di_machine_add_shape(se3di_machine *m, size_t body)
{
    return se3di_parts_add_shape(m, &se3di_machine_body_at(m, body)->parts);
}

se3di_machine_marker *se3di_parts_add_marker(se3di_machine *m, se3di_machine_parts *parts,
                                             const char *name, const se3di_frame *frame)
{
    se3di_machine_marker *marker = se3di_iopool_alloc(m->pool, sizeof *marker);
    if (!marker) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    marker->name = name;
    marker->frame = *frame;
    if (parts->last_marker) {
        parts->last_marker->next = marker;
    } else {
        parts->markers = marker;
    }
    parts->last_marker = marker;
    return marker;
}

/* Whether the body has a marker of this name, or what is called so on every body. */
static bool marker_is_taken(const se3di_machine_body *body, const char *name)
{
    static const char *const channels[] = {
        "position",         "orientation",          "velocity",     "acceleration",
        "angular_velocity", "angular_acceleration", "contact_force"};
    for (size_t k = 0; k < sizeof channels / sizeof *channels; ++k) {
        if (strcmp(channels[k], name) == 0) {
            return true;
        }
    }
    return is_taken(&body->marker_names, name);
}

se3di_machine_marker *se3di_machine_add_marker(se3di_machine *m, size_t body, const char *name,
                                               const se3di_frame *frame)
{
    se3di_machine_body *b = se3di_machine_body_at(m, body);
    char valid[NAME_MAX_LENGTH + 1];
    make_valid(name ? name : "", valid);
    const char *free_name = se3di_machine_text(m, "%s", valid[0] ? valid : "marker");
    while (free_name && marker_is_taken(b, free_name)) {
        free_name = count_up(m, valid[0] ? valid : "marker", ++m->counter);
    }
    if (!free_name || !se3di_ionames_add(&b->marker_names, m->pool, free_name, 0)) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    return se3di_parts_add_marker(m, &b->parts, free_name, frame);
}

se3di_entry *se3di_machine_add(se3di_machine *m, se3di_section section)
{
    se3di_entry *entry = se3di_iopool_alloc(m->pool, sizeof *entry);
    if (!entry) {
        se3di_machine_fail_memory(m);
        return NULL;
    }
    if (m->last_entries[section]) {
        m->last_entries[section]->next = entry;
    } else {
        m->entries[section] = entry;
    }
    m->last_entries[section] = entry;
    return entry;
}

se3di_entry *se3di_machine_add_force(se3di_machine *m, const char *name, const char *type)
{
    se3di_entry *entry = name ? se3di_machine_add(m, SE3DI_SECTION_FORCES) : NULL;
    if (entry) {
        se3di_entry_put_text(m, entry, "name", name);
        se3di_entry_put(m, entry, "type", type);
    }
    return entry;
}

static void append_pair(se3di_machine *m, const char *key, const char *value, se3di_pair **first,
                        se3di_pair **last)
{
    se3di_pair *pair = se3di_iopool_alloc(m->pool, sizeof *pair);
    if (!pair) {
        se3di_machine_fail_memory(m);
        return;
    }
    pair->key = key;
    pair->value = value;
    *(*last ? &(*last)->next : first) = pair;
    *last = pair;
}

void se3di_entry_put(se3di_machine *m, se3di_entry *entry, const char *key, const char *value)
{
    if (!entry || !value) {
        se3di_machine_fail_memory(m);
        return;
    }
    append_pair(m, key, value, &entry->first, &entry->last);
}

void se3di_entry_put_text(se3di_machine *m, se3di_entry *entry, const char *key, const char *text)
{
    se3di_entry_put(m, entry, key, text ? se3di_machine_quote(m, text) : NULL);
}

void se3di_entry_put_number(se3di_machine *m, se3di_entry *entry, const char *key, double value)
{
    se3di_entry_put(m, entry, key, se3di_machine_number(m, value));
}

void se3di_entry_put_vector(se3di_machine *m, se3di_entry *entry, const char *key,
                            const double v[3])
{
    se3di_entry_put(m, entry, key, se3di_machine_numbers(m, v, 3));
}

void se3di_machine_parameter(se3di_machine *m, const char *name, const char *value)
{
    for (const se3di_pair *at = m->parameters; at; at = at->next) {
        if (strcmp(at->key, name) == 0) {
            return;
        }
    }
    append_pair(m, name, value, &m->parameters, &m->last_parameter);
}
