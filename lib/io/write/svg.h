/* SPDX-License-Identifier: BSD-3-Clause */
/* Drawings as SVG: what is written is well-formed whatever texts and numbers are. Lengths are
 * pixels, y downwards. */
#ifndef SE3D_IO_SVG_H
#define SE3D_IO_SVG_H

#include <stdbool.h>
#include <stdio.h>

/* A point of the drawing. */
typedef struct se3di_spot {
    double x, y;
} se3di_spot;

/* How a thing is drawn is said by a class of the style at the head of the file. */
void se3di_svg_begin(FILE *file, double width, double height, const char *title);
void se3di_svg_end(FILE *file);
/* What is drawn from here to the end of the group has a title, which is shown under a mouse. */
void se3di_svg_open(FILE *file, const char *kind, const char *title);
void se3di_svg_close(FILE *file);
void se3di_svg_line(FILE *file, const char *kind, se3di_spot a, se3di_spot b);
/* A line through `count` points, closed or not. */
void se3di_svg_path(FILE *file, const char *kind, const se3di_spot *points, size_t count,
                    bool closed);
void se3di_svg_circle(FILE *file, const char *kind, se3di_spot center, double radius);
void se3di_svg_text(FILE *file, const char *kind, se3di_spot at, const char *text);
/* A text without an element, for what is put together of several. */
void se3di_svg_put(FILE *file, const char *text);

#endif
