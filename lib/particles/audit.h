/* SPDX-License-Identifier: BSD-3-Clause */
/* The energy that particles lose: what contacts turn to heat, by kinds. */
#ifndef SE3DI_PARTICLES_AUDIT_H
#define SE3DI_PARTICLES_AUDIT_H

#include "particles/set.h"

/* Before a kick over a time of `span`: keep the velocities, add the work of fixed particles. */
void se3di_audit_mark(se3di_particles *set, double span);
/* After it: add the work of the forces. */
void se3di_audit_add(se3di_particles *set, double span);
/* A set that was spread is whole again: what all processes have seen, to audit_work. */
void se3di_audit_unite(se3di_particles *set);
/* What contacts store now, by kinds [J]. */
void se3di_audit_elastic(const se3di_particles *set, double elastic[SE3DI_AUDIT_KINDS]);

#endif
