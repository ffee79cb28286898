/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/error.h"

#include <ctype.h>
#include <locale.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"

/* printf writes the host program's decimal separator; messages always have a point. */
static void restore_decimal_point(char *text)
{
    const char *separator = localeconv()->decimal_point;
    /* unreached: a separator of several bytes, which few locales have */
    if (strlen(separator) != 1 || separator[0] == '.') {
        return;
    }
    for (char *c = text; *c; ++c) {
        int before = c > text && isdigit((unsigned char)c[-1]);
        if (*c == separator[0] && before && isdigit((unsigned char)c[1])) {
            *c = '.';
        }
    }
}

void se3di_error_format(char *text, size_t size, const char *format, va_list arguments)
{
    vsnprintf(text, size, format, arguments);
    restore_decimal_point(text);
    se3di_text_make_plain(text); /* a name may have been cut in a character */
}

se3d_status se3di_error_set(se3di_error *error, se3d_status status, const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        se3di_error_format(error->message, sizeof error->message, format, arguments);
        error->status = status;
        va_end(arguments);
        error->field[0] = '\0';
        error->cause = SE3DI_CAUSE_OTHER;
    }
    return status;
}

se3d_status se3di_error_set_of(se3di_error *error, const char *field, se3d_status status,
                               const char *format, ...)
{
    if (error) {
        va_list arguments;
        snprintf(error->message, sizeof error->message, "%s", field);
        snprintf(error->field, sizeof error->field, "%.*s", (int)strcspn(field, "[."), field);
        const size_t used = strlen(error->message);
        va_start(arguments, format);
        se3di_error_format(error->message + used, sizeof error->message - used, format, arguments);
        va_end(arguments);
        error->status = status;
        error->cause = SE3DI_CAUSE_OTHER;
    }
    return status;
}

void se3di_error_append(se3di_error *error, const char *format, ...)
{
    const size_t used = strlen(error->message);
    va_list arguments;
    va_start(arguments, format);
    se3di_error_format(error->message + used, sizeof error->message - used, format, arguments);
    va_end(arguments);
}

void se3di_error_wrap(se3di_error *error, const char *before, const char *after)
{
    char inner[SE3DI_ERROR_SIZE];
    const size_t size = sizeof inner, around = strlen(before) + strlen(after);
    const size_t room = around < size - 1 ? size - 1 - around : 0;
    memcpy(inner, error->message, size);
    snprintf(error->message, size, "%s%.*s%s", before, (int)room, inner, after);
    se3di_text_make_plain(error->message); /* the message may have been cut in a character */
}

void se3di_error_clear(se3di_error *error)
{
    error->status = SE3D_OK;
    error->message[0] = '\0';
    error->field[0] = '\0';
    error->cause = SE3DI_CAUSE_OTHER;
}
