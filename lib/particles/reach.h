/* SPDX-License-Identifier: BSD-3-Clause */
/* How far particles and walls may move before lists are made anew. */
#ifndef SE3DI_PARTICLES_REACH_H
#define SE3DI_PARTICLES_REACH_H

#include "particles/set.h"

/* The largest reach that a particle may get, to set->stretch; `room`: for two together. */
void se3di_particles_stretch(se3di_particles *set, double room);
/* Reaches of the list from the skin, which may have become smaller, and the speeds; particles and
 * walls are where the list is built. */
void se3di_particles_set_reach(se3di_particles *set);
/* Reaches of the active blocks, at most what is left of those of the list, times `scale`: as
 * distances in se3di_particles_wear(). */
void se3di_particles_set_wear(se3di_particles *set, double scale);
/* The active blocks have been made: distances become inverse squares. */
void se3di_particles_begin_wear(se3di_particles *set);
/* Whether nothing has moved farther than the active blocks allow. */
int se3di_particles_blocks_hold(const se3di_particles *set);
/* Whether the list holds long enough to choose active blocks from it. */
int se3di_particles_list_holds(const se3di_particles *set);

#endif
