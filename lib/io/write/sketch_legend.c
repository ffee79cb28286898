/* SPDX-License-Identifier: BSD-3-Clause */
/* The words beside a sketch. */
#include "io/write/sketch_sheet.h"

#include <stdarg.h>
#include <string.h>

enum { NAME_MAX_LENGTH = 28 };

void se3di_sketch_shorten(const char *name, char out[SE3DI_SKETCH_TEXT])
{
    size_t used = 0;
    for (int k = 0; k < NAME_MAX_LENGTH && *name; ++k) {
        const size_t length = se3d_text_get_character(name);
        const size_t taken = length > 0 ? length : 1;
        memcpy(out + used, name, taken);
        used += taken;
        name += taken;
    }
    snprintf(out + used, SE3DI_SKETCH_TEXT - used, "%s", *name ? "..." : "");
}

void se3di_sketch_add_line(se3di_sketch *s, const char *format, ...)
{
    va_list arguments;
    if (s->line_count == SE3DI_SKETCH_LINES) {
        ++s->lines_left_out;
        return;
    }
    va_start(arguments, format);
    vsnprintf(s->lines[s->line_count++], SE3DI_SKETCH_TEXT, format, arguments);
    va_end(arguments);
}

void se3di_sketch_put_legend(const se3di_sketch *s)
{
    double y = 28.0;
    double x = s->width + 10.0;
    for (size_t k = 0; k < s->line_count; ++k) {
        const bool is_head = s->lines[k][0] == '#';
        if (k > 0 && k % s->rows == 0) {
            y = 28.0;
            x += SE3DI_SKETCH_COLUMN;
        }
        y += is_head && k % s->rows > 0 ? 6.0 : 0.0;
        se3di_svg_text(s->file, is_head ? "head" : "small", (se3di_spot){x, y},
                       s->lines[k] + is_head);
        y += SE3DI_SKETCH_LINE;
    }
    if (s->lines_left_out > 0) {
        char rest[60];
        snprintf(rest, sizeof rest, "and %zu more", s->lines_left_out);
        se3di_svg_text(s->file, "small", (se3di_spot){x, y}, rest);
    }
}
