/* SPDX-License-Identifier: BSD-3-Clause */
/* What the sources of a sketch share: what is drawn, where it stands on the sheet, the legend. */
#ifndef SE3D_IO_SKETCH_SHEET_H
#define SE3D_IO_SKETCH_SHEET_H

#include <stdio.h>

#include "io/base/pool.h"
#include "io/write/drawing.h"
#include "io/write/sketch_view.h"

enum { SE3DI_SKETCH_TEXT = 300, SE3DI_SKETCH_LINES = 240 };
/* [px] of the legend: the width of a column, the height of a line */
#define SE3DI_SKETCH_COLUMN 330.0
#define SE3DI_SKETCH_LINE   16.0

/* What is drawn of a body: links, and given shapes with ends. */
typedef struct se3di_drawn {
    se3di_parts links, shapes;
} se3di_drawn;

typedef struct se3di_sketch {
    const se3d_model *model;
    FILE *file;
    se3di_iopool pool;
    double *poses;
    se3di_drawn *looks; /* [body_count] */
    se3di_sizes sizes;
    se3di_sketch_view view;
    double width, height; /* of the picture without its legend [px] */
    size_t rows;          /* of a column of the legend */
    se3di_spot *joints;   /* [joint_count] where letters stand */
    size_t joint_count;
    char (*lines)[SE3DI_SKETCH_TEXT]; /* of the legend; one that begins with # is a heading */
    size_t line_count, lines_left_out;
    bool failed; /* out of memory */
} se3di_sketch;

/* ---- the legend (sketch_legend.c) ------------------------------------------------------------*/

/* A name that is cut if it is long. */
void se3di_sketch_shorten(const char *name, char out[SE3DI_SKETCH_TEXT]);
SE3DI_IO_FORMAT(2, 3)
void se3di_sketch_add_line(se3di_sketch *s, const char *format, ...);
void se3di_sketch_put_legend(const se3di_sketch *s);

/* ---- places (sketch_places.c) ---------------------------------------------------------------*/

/* What is drawn of each body. Of one with shapes no bars lead to markers, which may be anywhere. */
void se3di_sketch_list_looks(se3di_sketch *s);
/* Let all that is drawn fill its part of the sheet. */
void se3di_sketch_fit(se3di_sketch *s);
/* The point of an element on body i, or j. */
se3di_spot se3di_sketch_spot_of(const se3di_sketch *s, const se3di_element_entry *entry, bool is_j);
/* End 0 or 1 of a link, which is a cylinder. */
void se3di_sketch_get_link_end(const se3di_sketch *s, size_t body, const se3di_part *part, int end,
                               double r[3]);
/* The outlines of the shapes of a body, which are drawn or only widen a box. */
void se3di_sketch_put_shapes(se3di_sketch *s, size_t body, FILE *file, double low[2],
                             double high[2]);

/* ---- what is drawn --------------------------------------------------------------------------*/

void se3di_sketch_put_bodies(se3di_sketch *s);   /* sketch_bodies.c */
void se3di_sketch_put_elements(se3di_sketch *s); /* sketch_elements.c: springs, and all in words */
void se3di_sketch_put_joints(se3di_sketch *s);   /* and joints, above them */

#endif
