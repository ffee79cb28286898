/* SPDX-License-Identifier: BSD-3-Clause */
/* Clumps of a table of particles: rows that follow each other and name one clump are its spheres.
 */
#ifndef SE3D_IO_PARTICLE_CLUMPS_H
#define SE3D_IO_PARTICLE_CLUMPS_H

#include "io/model/tagged.h"
#include "se3d/clump.h"

/* A template of clumps as the file defines it, with what its spheres are together. */
typedef struct se3di_clump_entry {
    se3d_clump_def def;
    se3d_clump_template_info info;
} se3di_clump_entry;

/* How a clump lies and moves. */
typedef struct se3di_clump_pose {
    size_t entry;
    double scale;
    double r[3], e[4], v[3], w[3]; /* of its centre of mass, ground frame */
} se3di_clump_pose;

/* Spheres of one clump. */
typedef struct se3di_clump_rows {
    size_t count;
    double *r;            /* [3 * count], brought to one side of each period */
    const double *radius; /* [count] */
    const double *v, *w;  /* of the first one */
} se3di_clump_rows;

/* Find the template that has these spheres in this order, and how it lies.
 * @return false: there is none. */
bool se3di_clump_recognise(const se3di_tagged *particles, const se3di_clump_rows *rows,
                           se3di_clump_pose *pose);
/* Add it, at the end of the set, at rest if it is scaled. */
se3d_status se3di_clump_add(const se3di_tagged *particles, se3d_material material,
                            const se3di_clump_pose *pose);

#endif
