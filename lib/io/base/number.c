/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/base/number.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/base/digits.h"

size_t se3di_number_format(double value, char *text)
{
    const size_t done = se3di_digits_format(value, text);
    if (done > 0) {
        return done;
    }
    if (!isfinite(value)) {
        strcpy(text, isnan(value) ? "nan" : value < 0.0 ? "-inf" : "inf");
        return strlen(text);
    }
    const int length = snprintf(text, SE3DI_NUMBER_SIZE, "%.17g", value);
    const size_t head = strspn(text, "-0123456789");
    const size_t point = strcspn(text + head, "0123456789e"); /* bytes of the decimal point */
    if (text[head] == 'e' || text[head] == '\0') {
        return (size_t)length;
    }
    text[head] = '.';
    memmove(text + head + 1, text + head + point, (size_t)length - head - point + 1);
    return (size_t)length - point + 1;
}

/* strtod alone takes the decimal point of the host program. */
bool se3di_number_parse(const char *text, double *value)
{
    enum { TEXT_MAX = 100 };
    char copy[TEXT_MAX + 20];
    const char *point = localeconv()->decimal_point;
    size_t length = 0;
    if (strspn(text, "+-.0123456789eE") != strlen(text)) {
        return false;
    }
    for (const char *c = text; *c; ++c) {
        const char *part = *c == '.' ? point : c;
        const size_t size = *c == '.' ? strlen(point) : 1;
        if (length + size > TEXT_MAX) {
            return false;
        }
        memcpy(copy + length, part, size);
        length += size;
    }
    copy[length] = '\0';
    char *end = copy;
    *value = strtod(copy, &end);
    return length > 0 && *end == '\0' && isfinite(*value);
}
