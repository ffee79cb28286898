/* SPDX-License-Identifier: BSD-3-Clause */
/* UTF-8, and strings of other languages. */
#include "text.h"

#include <string.h>

/* The code of the character at `text` and its bytes, by RFC 3629. @return 0 bytes: not UTF-8. */
static size_t decode(const char *text, unsigned long *code)
{
    static const unsigned long least[5] = {0, 0, 0x80, 0x800, 0x10000};
    const unsigned char first = (unsigned char)text[0];
    const size_t length = first < 0x80   ? 1
                          : first < 0xC2 ? 0
                          : first < 0xE0 ? 2
                          : first < 0xF0 ? 3
                          : first < 0xF5 ? 4
                                         : 0;
    *code = length < 2 ? first : first & (0x7FU >> length);
    for (size_t k = 1; k < length; ++k) {
        const unsigned char next = (unsigned char)text[k];
        if ((next & 0xC0) != 0x80) {
            return 0;
        }
        *code = *code << 6 | (next & 0x3FU);
    }
    const int surrogate = *code >= 0xD800 && *code <= 0xDFFF;
    return *code < least[length] || *code > 0x10FFFF || surrogate ? 0 : length;
}

static int is_shown(unsigned long code)
{
    const int control = code < 0x20 || (code >= 0x7F && code < 0xA0);
    const int line = code == 0x2028 || code == 0x2029;
    const int turn = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    return !control && !line && !turn && (code & 0xFFFE) != 0xFFFE && code != 0xFEFF;
}

size_t text_get_length(const char *text)
{
    unsigned long code = 0;
    const size_t length = decode(text, &code);
    return is_shown(code) ? length : 0;
}

int text_is_plain(const char *text)
{
    while (*text && text_get_length(text) > 0) {
        text += text_get_length(text);
    }
    return *text == '\0';
}

void text_clean(char *text)
{
    while (*text) {
        const size_t length = text_get_length(text);
        *text = length > 0 ? *text : '?';
        text += length > 0 ? length : 1;
    }
}

/* `special`: characters that are written by their code, beside quotes and backslashes. */
static void put_string(FILE *file, const char *text, const char *special)
{
    fputc('"', file);
    while (*text) {
        unsigned long code = 0;
        const size_t length = decode(text, &code);
        if (length == 0) {
            fputs("\\ufffd", file);
        } else if (*text == '"' || *text == '\\') {
            fprintf(file, "\\%c", *text);
        } else if (!is_shown(code) || (code < 0x80 && strchr(special, *text))) {
            fprintf(file, code < 0x10000 ? "\\u%04lx" : "\\ufffd", code);
        } else {
            fwrite(text, 1, length, file);
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
        const size_t length = text_get_length(text);
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
