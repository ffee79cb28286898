/* SPDX-License-Identifier: BSD-3-Clause */
/* Averages over the particles in a box. */
#ifndef SE3DI_PARTICLES_AVERAGE_H
#define SE3DI_PARTICLES_AVERAGE_H

#include "particles/set.h"
#include "se3d/average.h"

/* What is averaged over: a box, and the particles of a tag; -1: all. */
typedef struct se3di_average_box {
    double lower[3], upper[3];
    int32_t tag;
    int32_t contacts; /* 0: without what they give */
} se3di_average_box;

/* The components of a symmetric tensor: xx, yy, zz, xy, yz, xz. */
static const int se3di_stress_row[6] = {0, 1, 2, 0, 1, 0};
static const int se3di_stress_column[6] = {0, 1, 2, 1, 2, 2};

void se3di_particles_average(const se3di_particles *set, const se3di_average_box *box,
                             se3d_average *average);

/* The volume of sphere k; those of a clump share the volume of their union. */
double se3di_particles_volume(const se3di_particles *set, size_t k);
/* A free sphere or a clump, which its first sphere stands for; returns 0 for the others. */
int se3di_particles_whole(const se3di_particles *set, size_t k, double *mass, double x[3],
                          double v[3]);

#endif
