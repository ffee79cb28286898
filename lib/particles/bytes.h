/* SPDX-License-Identifier: BSD-3-Clause */
/* Particle sets as bytes: all that the next step depends on but what their definitions say. */
#ifndef SE3DI_PARTICLES_BYTES_H
#define SE3DI_PARTICLES_BYTES_H

#include "base/coder.h"
#include "particles/set.h"

/* Write, or measure, a chain of sets that have taken what they touch from the model. */
void se3di_sets_write(se3di_coder *coder, const se3di_particles *sets);
/* Read a chain of as many sets as the model has, each with what its set is made of and does, the
 * number of threads included. @return OK, NO_MEMORY, INVALID_ARGUMENT (malformed), STATE (of other
 * sets); after a failure nothing is held. */
se3d_status se3di_sets_read(se3di_coder *coder, const se3di_model *model, se3di_particles **sets);

/* bytes_check.c: whether the lists of a set that was read name what is there, whatever the bytes
 * say, and are such that threads do not meet; the spheres of clumps get to know these. */
int se3di_particles_are_sound(se3di_particles *set);

#endif
