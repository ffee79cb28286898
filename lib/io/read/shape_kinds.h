/* SPDX-License-Identifier: BSD-3-Clause */
/* The kinds of shapes of a model file: what each of them needs, weighs and looks like. */
#ifndef SE3D_IO_SHAPE_KINDS_H
#define SE3D_IO_SHAPE_KINDS_H

#include "io/model/model.h"

/* What a shape is drawn with, in unit size: a box of edge 1, a sphere of radius 1, a cylinder of
 * radius and length 1. */
typedef enum se3di_look_unit {
    SE3DI_LOOK_BOX = 0,
    SE3DI_LOOK_SPHERE = 1,
    SE3DI_LOOK_CYLINDER = 2
} se3di_look_unit;

typedef struct se3di_look {
    se3di_look_unit unit;
    double z;        /* its place on the axis of the shape */
    double scale[3]; /* along the shape's axes */
    double opacity;
} se3di_look;

#define SE3DI_LOOKS 3 /* parts of a shape at the most */

/* Keys that a kind needs. */
#define SE3DI_SHAPE_NEEDS_RADIUS 1u
#define SE3DI_SHAPE_NEEDS_LENGTH 2u
#define SE3DI_SHAPE_NEEDS_SIZE   4u
#define SE3DI_SHAPE_NEEDS_FILE   8u  /* triangles: they weigh and look as they are */
#define SE3DI_SHAPE_HAS_NORMAL   16u /* may be given in place of an orientation */
#define SE3DI_SHAPE_HAS_HEIGHTS  32u /* a grid of them, in one of several ways */
#define SE3DI_SHAPE_NEEDS_ENDS   64u /* radii of both: a surface that is drawn as a mesh */
#define SE3DI_SHAPE_NEEDS_AXES   128u

typedef struct se3di_shape_row {
    se3d_status (*create)(se3d_system *system, const se3d_shape_def *def, se3d_shape *shape);
    uint32_t keys;
    /* Mass, and moments of inertia about the axes through the origin, its centre of mass. NULL: it
     * has no mass. */
    void (*weigh)(const se3d_model_shape *shape, double density, double *mass, double J[3]);
    /* Half the lengths of the box around it. NULL: it has no ends, or is a mesh. */
    void (*enclose)(const se3d_model_shape *shape, double half[3]);
    /* Its parts; `extent` is half the size of what is seen. Returns their number. NULL: a mesh. */
    int (*draw)(const se3d_model_shape *shape, double extent, se3di_look looks[SE3DI_LOOKS]);
} se3di_shape_row;

/* What a model file calls its kinds, NULL at the end; their se3d_shape_type. */
/* What a shape looks made of: se3di_style by its number, NULL at the end. */
extern const char *const se3di_shape_styles[];
extern const char *const se3di_shape_names[];
extern const int32_t se3di_shape_types[];
const se3di_shape_row *se3di_shape_row_of(const se3d_model_shape *shape);

#endif
