/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers and words in texts of other formats. */
#include "io/import/scan.h"

#include <locale.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SMALLEST 1e-40 /* what is closer to 0 is 0 */

static const char digits[] = "0123456789";

/* The length of a decimal number, with its sign. */
static size_t measure(const char *text, bool fortran)
{
    size_t at = text[0] == '+' || text[0] == '-';
    size_t count = strspn(text + at, digits);
    at += count;
    if (text[at] == '.') {
        const size_t after = strspn(text + at + 1, digits);
        at += 1 + after;
        count += after;
    }
    if (count == 0) {
        return 0;
    }
    if (text[at] && strchr(fortran ? "eEdD" : "eE", text[at])) {
        size_t exponent = at + 1;
        exponent += text[exponent] == '+' || text[exponent] == '-';
        const size_t more = strspn(text + exponent, digits);
        at = more > 0 ? exponent + more : at;
    }
    return at;
}

size_t se3di_scan_number(const char *text, bool fortran, double *value)
{
    char copy[512];
    const char *point = localeconv()->decimal_point;
    const size_t length = measure(text, fortran);
    size_t used = 0;
    for (size_t k = 0; k < length; ++k) {
        const char c = text[k];
        const char *put = c == '.' ? point : NULL;
        const size_t size = put ? strlen(put) : 1;
        if (used + size >= sizeof copy) {
            return 0;
        }
        const char one = c == 'd' || c == 'D' ? 'e' : c;
        memcpy(copy + used, put ? put : &one, size);
        used += size;
    }
    copy[used] = '\0';
    *value = length > 0 ? strtod(copy, NULL) : 0.0;
    *value = fabs(*value) < SMALLEST ? 0.0 : *value;
    return length > 0 && fabs(*value) <= SE3DI_SCAN_LARGEST ? length : 0;
}

int se3di_scan_numbers(const char *text, double *values, int room)
{
    static const char blanks[] = " \t\r\n";
    int count = 0;
    for (;;) {
        text += strspn(text, blanks);
        if (!*text) {
            return count;
        }
        const size_t length = count < room ? se3di_scan_number(text, false, &values[count]) : 0;
        if (length == 0 || (text[length] && !strchr(blanks, text[length]))) {
            return -1;
        }
        text += length;
        ++count;
    }
}

static char lower(char c)
{
    return c >= 'A' && c <= 'Z' ? (char)(c - 'A' + 'a') : c;
}

bool se3di_scan_equal_part(const char *a, size_t length, const char *b)
{
    size_t k = 0;
    while (k < length && b[k] && lower(a[k]) == lower(b[k])) {
        ++k;
    }
    return k == length && !b[k];
}

bool se3di_scan_equal(const char *a, const char *b)
{
    return se3di_scan_equal_part(a, strlen(a), b);
}

bool se3di_scan_begins(const char *text, const char *part)
{
    while (*part && lower(*text) == lower(*part)) {
        ++text;
        ++part;
    }
    return !*part;
}

bool se3di_scan_numeric(const char *text)
{
    return *text && !text[strspn(text, "0123456789+-.,eEdD \t")];
}
