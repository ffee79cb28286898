/* SPDX-License-Identifier: BSD-3-Clause */
/* Mass, centre and inertia of the solids that shapes bound, of uniform density. */
#ifndef SE3D_IO_SOLID_H
#define SE3D_IO_SOLID_H

#include "io/document/reader.h"
#include "io/model/model.h"

typedef struct se3di_solid {
    double mass;
    double centre[3];  /* of mass, shape frame */
    double inertia[9]; /* about the centre, along the shape's axes; row-major */
    double size;       /* of the order of the shape's extent */
} se3di_solid;

/* A mesh must be closed: else fails with the place of the gap. A plane has no mass. */
bool se3di_solid_measure(se3di_reader *reader, const se3di_node *node,
                         const se3d_model_shape *shape, const se3di_mesh *mesh, double density,
                         se3di_solid *solid);

#endif
