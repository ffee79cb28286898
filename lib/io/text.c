/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/text.h"

size_t se3di_text_decode(const char *text, uint32_t *code)
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
    const bool surrogate = *code >= 0xD800 && *code <= 0xDFFF;
    return *code < least[length] || *code > 0x10FFFF || surrogate ? 0 : length;
}

bool se3di_text_is_shown(uint32_t code)
{
    const bool control = code < 0x20 || (code >= 0x7F && code < 0xA0);
    const bool line = code == 0x2028 || code == 0x2029;
    const bool turn = (code >= 0x202A && code <= 0x202E) || (code >= 0x2066 && code <= 0x2069);
    return !control && !line && !turn && (code & 0xFFFE) != 0xFFFE && code != 0xFEFF;
}

bool se3di_text_is_plain(const char *text)
{
    while (*text) {
        uint32_t code = 0;
        const size_t length = se3di_text_decode(text, &code);
        if (length == 0 || !se3di_text_is_shown(code)) {
            return false;
        }
        text += length;
    }
    return true;
}
