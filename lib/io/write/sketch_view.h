/* SPDX-License-Identifier: BSD-3-Clause */
/* The plane of a sketch, and the symbols that are drawn in it. */
#ifndef SE3D_IO_SKETCH_VIEW_H
#define SE3D_IO_SKETCH_VIEW_H

#include "io/model/model.h"
#include "io/write/drawing_part.h"
#include "io/write/svg.h"

typedef struct se3di_sketch_view {
    double right[3], up[3], toward[3]; /* of the eye, ground frame */
    double scale;                      /* [px/m] */
    se3di_spot origin;                 /* of the ground frame [px] */
} se3di_sketch_view;

/* A joint as it is drawn: its point, the direction of its axis, and how much of that is seen. */
typedef struct se3di_symbol {
    FILE *file;
    se3di_spot at;
    se3di_spot along; /* unit */
    double seen;      /* 0: the axis points to the eye; 1: it lies in the plane */
} se3di_symbol;

/* The axis of a joint in the ground frame, of length 1; zero: it has none. */
void se3di_sketch_get_axis(const se3d_model *model, const double *poses,
                           const se3di_element_entry *entry, double axis[3]);
/* Turn to a view; `angles` NULL: choose it. The scale is left. */
void se3di_sketch_turn(se3di_sketch_view *view, const double angles[2], const se3d_model *model,
                       const double *poses);
se3di_spot se3di_sketch_project(const se3di_sketch_view *view, const double r[3]);

/* The outline of a given shape on a body that is at `pose`; `file` NULL: nothing is drawn. Widens
 * the box from `low` to `high` around it. @return false: out of memory. */
bool se3di_sketch_put_shape(FILE *file, const se3di_sketch_view *view, const double *pose,
                            const se3di_part *part, se3di_iopool *pool, double low[2],
                            double high[2]);

void se3di_symbol_put_joint(const se3di_symbol *s, se3di_joint_look look);
void se3di_symbol_put_ground(FILE *file, se3di_spot at);
void se3di_symbol_put_driver(FILE *file, se3di_spot at);
/* Beside the line from a to b by so many pixels. */
void se3di_symbol_put_spring(FILE *file, se3di_spot a, se3di_spot b, double beside);
void se3di_symbol_put_damper(FILE *file, se3di_spot a, se3di_spot b, double beside);

#endif
