/* SPDX-License-Identifier: BSD-3-Clause */
/* Characters: UTF-8 by RFC 3629. */
#include "base/text.h"

#include <stdint.h>

/* The code of the character at `text`. @return its bytes, 0 if they are not UTF-8. */
static size_t decode(const char *text, uint32_t *code)
{
    static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
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

size_t se3d_text_get_character(const char *text)
{
    uint32_t code = 0;
    const size_t length = text ? decode(text, &code) : 0;
    const int control = code < 0x20 || (code >= 0x7F && code < 0xA0);
    const int line = code == 0x2028 || code == 0x2029;
    const int turn = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    const int none = (code & 0xFFFE) == 0xFFFE || code == 0xFEFF;
    return control || line || turn || none ? 0 : length;
}

int se3di_text_is_plain(const char *text)
{
    size_t length = 0;
    while ((length = se3d_text_get_character(text)) > 0) {
        text += length;
    }
    return *text == '\0';
}

void se3di_text_make_plain(char *text)
{
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        *text = length > 0 ? *text : '?';
        text += length > 0 ? length : 1;
    }
}
