/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of a set. */
#ifndef SE3DI_PARTICLES_STEP_H
#define SE3DI_PARTICLES_STEP_H

#include "particles/set.h"

/* Place the walls where the frames of their bodies are. */
void se3di_particles_move_walls(se3di_particles *set, const se3di_frame *frames);
/* What a unit force on a wall does to its body, from now on: what its mass makes of it, or nothing,
 * if the bodies are moved by others (model NULL). */
void se3di_particles_free_walls(se3di_particles *set, const se3di_model *model);
/* Nothing moves and nothing will. */
int se3di_particles_is_idle(const se3di_particles *set);
/* Bring the lists up to date, evaluate all forces; springs advance by h (0: they stay). If
 * memory is missing, lists are made with a smaller skin, which needs none. */
se3d_status se3di_particles_forces(se3di_particles *set, double h);
/* After a failure: the forces are complete all the same. */
int se3di_particles_is_complete(const se3di_particles *set, se3d_status status);
/* Forces that belong to the state, with springs as they are. */
se3d_status se3di_particles_prepare(se3di_particles *set);
/* The automatic step with the model's materials. Infinite if there is nothing to resolve. */
double se3di_particles_safe_step(const se3di_particles *set, const se3di_model *model);
/* One step of velocity Verlet; frames move the walls (NULL: they stay). */
se3d_status se3di_particles_advance(se3di_particles *set, double h, size_t steps,
                                    const se3di_frame *frames);
uint64_t se3di_particles_hash(const se3di_particles *set);

#endif
