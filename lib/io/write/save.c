/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/write/save.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/shortest.h"

enum { WIDTH = 110 };

void se3di_save_put(se3di_save *s, const char *text)
{
    if (s->status >= 0 && (!text || !se3di_iotext_put(&s->out, &s->pool, text))) {
        s->status = SE3D_ERR_NO_MEMORY;
    }
}

void se3di_save_line(se3di_save *s, const char *text)
{
    se3di_save_put(s, text);
    se3di_save_put(s, "\n");
}

void se3di_save_comment(se3di_save *s, const char *indent, const char *text)
{
    while (*text) {
        const size_t room = WIDTH - strlen(indent) - 2;
        size_t length = strlen(text);
        if (length > room) {
            length = room;
            while (length > 0 && text[length] != ' ') {
                --length;
            }
            length = length > 0 ? length : strcspn(text, " ");
        }
        se3di_save_put(s, indent);
        se3di_save_put(s, "# ");
        se3di_save_line(s, se3di_iopool_copy(&s->pool, text, length));
        text += length + strspn(text + length, " ");
    }
}

/* Whether a scalar without quotes is read as this text, in braces, too, and never as a number or a
 * word of YAML. */
static bool is_plain(const char *text)
{
    static const char letters[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_";
    static const char more[] =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ_0123456789-./ ";
    static const char *const words[] = {"true", "false", "yes", "no", "on",
                                        "off",  "null",  "y",   "n"};
    bool good = text[0] && strchr(letters, text[0]) && strspn(text, more) == strlen(text) &&
                text[strlen(text) - 1] != ' ';
    for (size_t k = 0; good && k < sizeof words / sizeof *words; ++k) {
        size_t same = 0;
        while (text[same] && (text[same] | 32) == words[k][same]) {
            ++same;
        }
        good = text[same] || words[k][same];
    }
    return good;
}

void se3di_save_put_text(se3di_save *s, const char *text)
{
    if (is_plain(text)) {
        se3di_save_put(s, text);
    } else {
        se3di_save_put_quoted(s, text);
    }
}

/* A character that YAML takes for a line break, or that a file must not have: 0x80 ... 0x9F, two
 * line breaks and the mark of the byte order. @return how many bytes it has; 0: it is none */
static size_t find_unseen(const char *text, unsigned *code)
{
    const unsigned char *c = (const unsigned char *)text;
    if (c[0] == 0xC2 && c[1] >= 0x80 && c[1] <= 0x9F) {
        *code = c[1];
        return 2;
    }
    if (c[0] == 0xE2 && c[1] == 0x80 && (c[2] == 0xA8 || c[2] == 0xA9)) {
        *code = 0x2000U + (c[2] & 0x3FU);
        return 3;
    }
    *code = 0xFEFF;
    return c[0] == 0xEF && c[1] == 0xBB && c[2] == 0xBF ? 3 : 0;
}

void se3di_save_put_quoted(se3di_save *s, const char *text)
{
    char piece[8] = "";
    unsigned code = 0;
    se3di_save_put(s, "\"");
    for (const char *c = text; *c; ++c) {
        const unsigned char byte = (unsigned char)*c;
        const size_t unseen = find_unseen(c, &code);
        if (unseen > 0) {
            snprintf(piece, sizeof piece, "\\u%04x", code & 0xFFFFU);
            c += unseen - 1;
        } else if (byte < 32 || byte == 127) {
            snprintf(piece, sizeof piece, "\\x%02x", byte);
        } else {
            snprintf(piece, sizeof piece, "%s%c", *c == '"' || *c == '\\' ? "\\" : "", *c);
        }
        se3di_save_put(s, piece);
    }
    se3di_save_put(s, "\"");
}

/* Break the line before a pair or a number that would go beyond its end. */
static void make_room(se3di_save *s, size_t length)
{
    if (s->out.column + length > WIDTH) {
        se3di_save_put(s, "\n");
        se3di_save_put(s, s->indent);
    } else {
        se3di_save_put(s, " ");
    }
}

static void put_key(se3di_save *s, const char *key, size_t value_length)
{
    if (!s->is_first) {
        se3di_save_put(s, ",");
        make_room(s, strlen(key) + value_length + 4);
    }
    s->is_first = false;
    se3di_save_put(s, key);
    se3di_save_put(s, ": ");
}

void se3di_save_word(se3di_save *s, const char *key, const char *word)
{
    put_key(s, key, strlen(word));
    se3di_save_put(s, word);
}

void se3di_save_text(se3di_save *s, const char *key, const char *text)
{
    if (!text) { /* the name of an element that is left out */
        se3di_save_refuse(s, "`%s` is an element that cannot be written", key);
        return;
    }
    put_key(s, key, strlen(text));
    se3di_save_put_text(s, text);
}

void se3di_save_number(se3di_save *s, const char *key, double value)
{
    char text[SE3DI_SHORTEST_SIZE];
    (void)se3di_shortest_format(value, text);
    se3di_save_word(s, key, text);
}

void se3di_save_put_numbers(se3di_save *s, const double *values, size_t count)
{
    char text[SE3DI_SHORTEST_SIZE];
    for (size_t k = 0; k < count; ++k) {
        (void)se3di_shortest_format(values[k], text);
        if (k > 0) {
            se3di_save_put(s, ",");
            make_room(s, strlen(text) + 2);
        }
        se3di_save_put(s, text);
    }
}

void se3di_save_put_row(se3di_save *s, const double *values, size_t count)
{
    se3di_save_put(s, "[");
    se3di_save_put_numbers(s, values, count);
    se3di_save_put(s, "]");
}

void se3di_save_vector(se3di_save *s, const char *key, const double *values, size_t count)
{
    put_key(s, key, 20);
    se3di_save_put_row(s, values, count);
}

void se3di_save_orientation(se3di_save *s, const char *key, const double p[4])
{
    static const double none[4] = {1.0, 0.0, 0.0, 0.0};
    if (memcmp(p, none, sizeof none) != 0) {
        put_key(s, key, 40);
        se3di_save_put(s, "{euler_parameters: [");
        se3di_save_put_numbers(s, p, 4);
        se3di_save_put(s, "]}");
    }
}

void se3di_save_number_but(se3di_save *s, const char *key, double value, double standard)
{
    if (memcmp(&value, &standard, sizeof value) != 0) {
        se3di_save_number(s, key, value);
    }
}

bool se3di_save_is_zero(const double *values, size_t count)
{
    static const double zero = 0.0;
    bool is_zero = true;
    for (size_t k = 0; k < count; ++k) {
        is_zero = is_zero && memcmp(&values[k], &zero, sizeof zero) == 0;
    }
    return is_zero;
}

void se3di_save_vector_but_zero(se3di_save *s, const char *key, const double *values, size_t count)
{
    if (!se3di_save_is_zero(values, count)) {
        se3di_save_vector(s, key, values, count);
    }
}

void se3di_save_begin_section(se3di_save *s, const char *title)
{
    s->section = title;
    s->indent = "     ";
}

se3di_save_entry se3di_save_open(se3di_save *s)
{
    const se3di_save_entry entry = {s->out.used, s->out.column, s->section};
    if (s->section) {
        se3di_save_put(s, "\n");
        se3di_save_put(s, s->section);
        se3di_save_put(s, ":\n");
        s->section = NULL;
    }
    se3di_save_put(s, "  - {");
    s->is_first = true;
    return entry;
}

bool se3di_save_close(se3di_save *s, const se3di_save_entry *entry)
{
    if (!s->problem[0]) {
        se3di_save_line(s, "}");
        return s->status >= 0;
    }
    if (!s->partial && s->status >= 0) {
        s->status = SE3D_ERR_UNSUPPORTED;
    }
    if (s->status >= 0) {
        s->out.used = entry->used;
        s->out.column = entry->column;
        s->section = entry->section;
        se3di_save_comment(s, "", "Left out:");
        se3di_save_comment(s, "", s->problem);
        s->problem[0] = '\0';
    }
    return false;
}

void se3di_save_refuse(se3di_save *s, const char *format, ...)
{
    va_list arguments;
    if (s->problem[0] || s->status < 0) {
        return; /* the first one counts */
    }
    va_start(arguments, format);
    vsnprintf(s->problem, sizeof s->problem, format, arguments);
    va_end(arguments);
}
