/* SPDX-License-Identifier: BSD-3-Clause */
/* Which triangles of a mesh some spheres touch, many pairs at a time.     docs/theory/shapes.md */
#ifndef SE3DI_PARTICLES_SIFT_H
#define SE3DI_PARTICLES_SIFT_H

#include "particles/set.h"

#define SE3DI_SIFT_SIZE 128 /* pairs, a multiple of the lanes of a block */

/* Pairs of a sphere and a triangle of one mesh. Bit k % 8 of element k / 8 of `left`: the triangle
 * may be nearer to the centre than the radius; of `inside`: it is, at the foot of the
 * perpendicular, and the distance and the normals towards the centre are those. */
typedef struct se3di_sift {
    _Alignas(64) double x[3][SE3DI_SIFT_SIZE]; /* in: centres, ground frame */
    double radius[SE3DI_SIFT_SIZE];
    double distance[SE3DI_SIFT_SIZE];
    double local[3][SE3DI_SIFT_SIZE];  /* normals in the frame of the mesh */
    double normal[3][SE3DI_SIFT_SIZE]; /* and of the ground */
    uint32_t triangle[SE3DI_SIFT_SIZE];
    uint8_t left[SE3DI_SIFT_SIZE / 8], inside[SE3DI_SIFT_SIZE / 8];
} se3di_sift;

#endif
