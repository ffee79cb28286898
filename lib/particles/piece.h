/* SPDX-License-Identifier: BSD-3-Clause */
/* What regions are filled with and sources insert: a sphere, or a clump. */
#ifndef SE3DI_PARTICLES_PIECE_H
#define SE3DI_PARTICLES_PIECE_H

#include "particles/set.h"

typedef struct se3di_piece {
    uint32_t clump;    /* 1 + template; 0: a sphere */
    uint32_t material; /* in the set's table */
    uint32_t tag;      /* of its spheres */
    uint32_t reserved;
    double radius; /* of the sphere, or of the one about the centre of mass that holds the clump */
    double x[3], q[4]; /* centre of mass; orientation of the template's frame */
} se3di_piece;

/* Its spheres. */
size_t se3di_piece_count(const se3di_particles *set, uint32_t clump);
/* Its mass; the smallest radius of its spheres, and the least mass that one of them has. */
double se3di_piece_mass(const se3di_particles *set, const se3di_piece *piece);
double se3di_piece_smallest(const se3di_particles *set, const se3di_piece *piece);
double se3di_piece_lightest(const se3di_particles *set, const se3di_piece *piece);
/* Of clumps: the orientation `turn`, or if that is all 0 a random one that depends on the seed and
 * the number of the clump only. */
void se3di_piece_turn(se3di_piece *piece, const double turn[4], uint64_t seed, uint64_t number);
/* A clump to be made. */
typedef struct se3di_clump_made {
    uint32_t template_index, material;
    double scale;
    double x[3], q[4];   /* of the centre of mass; frame of the definition -> ground */
    const double *v, *w; /* NULL: at rest */
} se3di_clump_made;

/* Append it with its spheres; room must have been reserved. Returns the id of its first sphere. */
uint32_t se3di_clumps_append(se3di_particles *set, const se3di_clump_made *made);

/* The place of sphere k as the piece lies; returns its radius. */
double se3di_piece_sphere(const se3di_particles *set, const se3di_piece *piece, size_t k,
                          double x[3]);
/* Append it with this velocity; room must have been reserved. */
void se3di_piece_append(se3di_particles *set, const se3di_piece *piece, const double v[3]);

#endif
