/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that are said by their points: bars from point to point, arms of two bars, flat plates. */
#ifndef SE3D_IO_BARS_H
#define SE3D_IO_BARS_H

#include "io/document/reader.h"

enum { SE3DI_BAR_LEGS = 2, SE3DI_PLATE_CORNERS_MAX = 64 };

/* As said in the part, ground frame. */
typedef struct se3di_bar {
    size_t leg_count; /* bars from their points to a common one */
    double from[SE3DI_BAR_LEGS][3];
    double to[3];
    double radius, wall;     /* round section; wall 0: solid */
    double width, thickness; /* flat section, along x and y of a leg, whose z goes to `to` */
    double across[3];        /* in the plane of x and z; zero: horizontal */
    size_t corner_count;     /* of a plate, whose thickness is as above */
    double corners[SE3DI_PLATE_CORNERS_MAX][3];
} se3di_bar;

/* Whether a body is said by its points. */
bool se3di_is_bar(const se3di_node *body);
/* Read one, or report what has no effect without its points. */
bool se3di_read_bar(se3di_reader *reader, const se3di_node *body, se3di_bar *bar);
/* Its centre of mass, and the inertia about it over the mass [m^2], along the axes of the ground:
 * xx, yy, zz, xy, yz, xz. @return its volume [m^3] */
double se3di_bar_weigh(const se3di_bar *bar, double centre[3], double inertia[6]);
/* Draw it: shapes of the body of this entry of the model. */
bool se3di_add_bar_shapes(se3di_reader *reader, const se3di_node *body, const se3di_bar *bar,
                          size_t entry);
/* The joints at the ends of the bars of a part, after all bodies. */
bool se3di_read_bar_joints(se3di_reader *reader, const se3di_node *root);

#endif
