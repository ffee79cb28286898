/* SPDX-License-Identifier: BSD-3-Clause */
/* What passes through planes in a step. */
#ifndef SE3DI_PARTICLES_PASSAGE_H
#define SE3DI_PARTICLES_PASSAGE_H

#include "particles/set.h"

/* Before the particles [begin, end) are moved: on which sides they are, to key[]; of clumps, to
 * order[]. */
void se3di_flows_mark(se3di_particles *set, size_t begin, size_t end);
void se3di_flows_mark_clumps(se3di_particles *set, size_t begin, size_t end);
/* After all were moved, for the time `drift`: count those that are on another side, one after the
 * other. */
void se3di_flows_count(se3di_particles *set, double drift);
/* A set that was spread is whole again: what all processes have seen, to the totals. */
void se3di_flows_unite(se3di_particles *set);
/* Means from the beginning of the window to a time. */
se3di_flow_rates se3di_flow_rates_since(const se3di_flow *flow, double time);
/* A step has ended: begin a new window if the last one is over. */
void se3di_flows_tick(se3di_particles *set);

#endif
