/* SPDX-License-Identifier: BSD-3-Clause */
/* A model as an engineer's sketch: bodies as links with numbers, joints as symbols with letters,
 * springs, dampers, ground, frames, degrees of freedom. */
#ifndef SE3D_IO_SKETCH_H
#define SE3D_IO_SKETCH_H

#include <stdio.h>

#include "se3d/io.h"

/* Write a sketch of the present state as SVG to a file that is open.
 * @param[in] view  azimuth and elevation of the eye [rad]; NULL: along the axes of a planar
 *                  mechanism, else from where joints are farthest apart
 * @return OK, NO_MEMORY, or a failure of the analysis of the constraints. */
se3d_status se3di_sketch_put(se3d_model *model, const double view[2], FILE *file);

#endif
