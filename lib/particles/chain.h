/* SPDX-License-Identifier: BSD-3-Clause */
/* The chain of the sets of a model, in creation order, and copies of it. */
#ifndef SE3DI_PARTICLES_CHAIN_H
#define SE3DI_PARTICLES_CHAIN_H

#include "particles/set.h"

/* Put a set at the end; take it out. Either counts as an edit of the model: the method may depend
 * on it, and snapshots do. */
void se3di_sets_link(se3di_model *model, se3di_particles *set);
void se3di_sets_unlink(se3di_model *model, const se3di_particles *set);
/* NULL if there is none of that name, or not as many. */
se3di_particles *se3di_sets_find(const se3di_model *model, const char *name);
se3di_particles *se3di_sets_get(const se3di_model *model, size_t index);

/* Discount (add 0) or count the materials and functions of the model that a set uses. */
void se3di_particles_count_users(const se3di_particles *set, se3di_model *model, int add);

/* Copies of all sets as a chain; NO_MEMORY: none is held. */
se3d_status se3di_sets_save(const se3di_particles *sets, const se3d_allocator *allocator,
                            se3di_particles **saved);
void se3di_sets_forget(se3di_particles *saved, const se3d_allocator *allocator);
/* Let copies take from the model what they touch, as the next step would. @return OK, NO_MEMORY */
se3d_status se3di_sets_sync(se3di_particles *saved, const se3di_model *model);
/* Whether the materials of their particles are still there. */
int se3di_sets_can_take(const se3di_model *model, const se3di_particles *saved);
/* Give the model's sets what a chain of as many copies holds, and free the chain. */
void se3di_sets_take(se3di_model *model, se3di_particles *saved);

#endif
