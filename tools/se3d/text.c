/* SPDX-License-Identifier: BSD-3-Clause */
/* Strings of other languages. */
#include "text.h"

#include <string.h>

#include "se3d/base.h"

int text_is_plain(const char *text)
{
    while (*text && se3d_text_get_character(text) > 0) {
        text += se3d_text_get_character(text);
    }
    return *text == '\0';
}

void text_clean(char *text)
{
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        *text = length > 0 ? *text : '?';
        text += length > 0 ? length : 1;
    }
}

void text_put_plain(FILE *file, const char *text)
{
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        fwrite(length > 0 ? text : "?", 1, length > 0 ? length : 1, file);
        text += length > 0 ? length : 1;
    }
}

/* `special`: characters that are written by their code, beside quotes and backslashes. */
static void put_string(FILE *file, const char *text, const char *special)
{
    fputc('"', file);
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        if (*text == '"' || *text == '\\') {
            fprintf(file, "\\%c", *text);
        } else if (length > 0 && !strchr(special, *text)) {
            fwrite(text, 1, length, file);
        } else if ((unsigned char)*text < 0x80) {
            fprintf(file, "\\u%04x", (unsigned)*text);
        } else {
            fputs("\\ufffd", file);
        }
        text += length > 0 ? length : 1;
    }
    fputc('"', file);
}

void text_put_json(FILE *file, const char *text)
{
    put_string(file, text, "");
}

void text_put_script(FILE *file, const char *text)
{
    put_string(file, text, "<>&'");
}

void text_put_gnuplot(FILE *file, const char *text)
{
    fputc('\'', file);
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        if (length == 0) {
            fputc('?', file);
        } else if (*text == '\'') {
            fputs("''", file);
        } else {
            fwrite(text, 1, length, file);
        }
        text += length > 0 ? length : 1;
    }
    fputc('\'', file);
}
