/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers as the shortest text that is read as the same number, with a point in every locale. */
#ifndef SE3DI_BASE_SHORTEST_H
#define SE3DI_BASE_SHORTEST_H

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SE3DI_SHORTEST_SIZE 48 /* bytes of a text */

/* The digits of a finite number without a point, and the exponent of the first one. printf and
 * strtod take the decimal point of the host program, the same one. */
static inline int se3di_shortest_digits(double value, char digits[20])
{
    char text[48];
    int used = 0;
    for (int precision = 0; precision < 17; ++precision) { /* unreached: 17 digits always do */
        snprintf(text, sizeof text, "%.*e", precision, value);
        if (strtod(text, NULL) == value) {
            break;
        }
    }
    const char *exponent = strchr(text, 'e');
    for (const char *c = text; c < exponent; ++c) {
        if (isdigit((unsigned char)*c)) {
            digits[used++] = *c;
        }
    }
    digits[used] = '\0';
    return (int)strtol(exponent + 1, NULL, 10);
}

/* Write a finite number. @return its length */
static inline size_t se3di_shortest_format(double value, char text[SE3DI_SHORTEST_SIZE])
{
    char digits[20];
    const int exponent = se3di_shortest_digits(fabs(value), digits);
    const int count = (int)strlen(digits);
    const char *const sign = signbit(value) ? "-" : "";
    int length;
    if (exponent < -4 || exponent > 16) {
        length = snprintf(text, SE3DI_SHORTEST_SIZE, "%s%c%s%se%d", sign, digits[0],
                          count > 1 ? "." : "", digits + 1, exponent);
    } else if (exponent < 0) {
        length =
            snprintf(text, SE3DI_SHORTEST_SIZE, "%s0.%.*s%s", sign, -exponent - 1, "0000", digits);
    } else if (count <= exponent + 1) {
        length = snprintf(text, SE3DI_SHORTEST_SIZE, "%s%s%.*s", sign, digits, exponent + 1 - count,
                          "0000000000000000");
    } else {
        length = snprintf(text, SE3DI_SHORTEST_SIZE, "%s%.*s.%s", sign, exponent + 1, digits,
                          digits + exponent + 1);
    }
    return (size_t)length;
}

#endif
