/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/write/svg.h"

#include <math.h>
#include <stdlib.h>

#include "se3d/base.h"

#define LARGEST 1e6 /* px */

/* Two digits behind a point in every locale, of numbers only. */
static void put_amount(FILE *file, double value)
{
    const double kept = value > -LARGEST && value < LARGEST ? value : 0.0;
    const long hundredths = lround(100.0 * kept);
    fprintf(file, "%s%ld.%02ld", hundredths < 0 ? "-" : "", labs(hundredths) / 100,
            labs(hundredths) % 100);
}

static void put_number(FILE *file, const char *name, double value)
{
    fprintf(file, " %s=\"", name);
    put_amount(file, value);
    fputs("\"", file);
}

void se3di_svg_put(FILE *file, const char *text)
{
    while (*text) {
        const size_t length = se3d_text_get_character(text);
        if (*text == '<' || *text == '>' || *text == '&' || *text == '"' || *text == '\'') {
            fprintf(file, "&#%d;", *text);
        } else if (length > 0) {
            fwrite(text, 1, length, file);
        } else {
            fputs("&#xfffd;", file);
        }
        text += length > 0 ? length : 1;
    }
}

void se3di_svg_begin(FILE *file, double width, double height, const char *title)
{
    static const char style[] =
        "text{font:12px sans-serif;fill:#1c2730}.title{font-weight:bold;font-size:15px}"
        ".head{font-weight:bold}.small{font-size:11px}.number{text-anchor:middle;font-size:11px}."
        "letter{font-weight:bold;"
        "fill:#a03010}"
        ".thin,.thick,.axis,.link,.hatch{fill:none;stroke:#1c2730;stroke-linecap:round;"
        "stroke-linejoin:round}.thin{stroke-width:1.2}.thick{stroke-width:2}"
        ".spot{fill:none;stroke-width:1.2}"
        ".outline{fill:none;stroke:#a8b4bf;stroke-width:1;stroke-linejoin:round}"
        ".grid{stroke:#d3dae0;stroke-width:1}"
        ".axis{stroke-width:.8;stroke-dasharray:8 3 2 3}.link{stroke-width:3.5}"
        ".hatch{stroke-width:1}.open{fill:#fff;stroke:#1c2730;stroke-width:1.4;"
        "stroke-linejoin:round}.full{fill:#1c2730}.x{stroke:#c0392b}.y{stroke:#1e8449}"
        ".z{stroke:#1f4fb4}.b0{stroke:#0072b2}.b1{stroke:#d55e00}.b2{stroke:#009e73}"
        ".b3{stroke:#b07800}.b4{stroke:#cc79a7}.b5{stroke:#3a9ad0}.b6{stroke:#8a8000}";
    fputs("<svg xmlns=\"http://www.w3.org/2000/svg\"", file);
    put_number(file, "width", width);
    put_number(file, "height", height);
    fprintf(file, " viewBox=\"0 0 %.0f %.0f\">\n<title>", width, height);
    se3di_svg_put(file, title);
    fprintf(file, "</title>\n<style>%s</style>\n<rect", style);
    put_number(file, "width", width);
    put_number(file, "height", height);
    fputs(" fill=\"#fff\"/>\n", file);
}

void se3di_svg_end(FILE *file)
{
    fputs("</svg>\n", file);
}

void se3di_svg_open(FILE *file, const char *kind, const char *title)
{
    fprintf(file, "<g class=\"%s\"><title>", kind);
    se3di_svg_put(file, title);
    fputs("</title>\n", file);
}

void se3di_svg_close(FILE *file)
{
    fputs("</g>\n", file);
}

void se3di_svg_line(FILE *file, const char *kind, se3di_spot a, se3di_spot b)
{
    fprintf(file, "<line class=\"%s\"", kind);
    put_number(file, "x1", a.x);
    put_number(file, "y1", a.y);
    put_number(file, "x2", b.x);
    put_number(file, "y2", b.y);
    fputs("/>\n", file);
}

void se3di_svg_path(FILE *file, const char *kind, const se3di_spot *points, size_t count,
                    bool closed)
{
    fprintf(file, "<path class=\"%s\"%s d=\"", kind, closed ? "" : " fill=\"none\"");
    for (size_t k = 0; k < count; ++k) {
        fputc(k > 0 ? 'L' : 'M', file);
        put_amount(file, points[k].x);
        fputc(' ', file);
        put_amount(file, points[k].y);
    }
    fputs(closed ? "Z\"/>\n" : "\"/>\n", file);
}

void se3di_svg_circle(FILE *file, const char *kind, se3di_spot center, double radius)
{
    fprintf(file, "<circle class=\"%s\"", kind);
    put_number(file, "cx", center.x);
    put_number(file, "cy", center.y);
    put_number(file, "r", radius);
    fputs("/>\n", file);
}

void se3di_svg_text(FILE *file, const char *kind, se3di_spot at, const char *text)
{
    fprintf(file, "<text class=\"%s\"", kind);
    put_number(file, "x", at.x);
    put_number(file, "y", at.y);
    fputs(">", file);
    se3di_svg_put(file, text);
    fputs("</text>\n", file);
}
