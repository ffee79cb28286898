/* SPDX-License-Identifier: BSD-3-Clause */
/* How fast particles may hit before they overlap more than the model allows. */
#ifndef SE3D_TOOL_SOFT_H
#define SE3D_TOOL_SOFT_H

#include <se3d/particles.h>

/* What the materials of a set hold. */
typedef struct soft {
    double speed; /* [m/s] 0: their attraction alone presses them in too far; infinite: any */
    double limit; /* the overlap that is allowed, over the radius */
} soft;

/* Look at every particle of a set, meeting one as itself or a wall of its material without loss.
 * @return 0 if the set cannot be read */
int soft_look(const se3d_system *system, const se3d_particles *set, soft *out);

#endif
