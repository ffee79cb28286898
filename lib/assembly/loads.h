/* SPDX-License-Identifier: BSD-3-Clause */
/* All that acts on bodies: gravity and force elements (force/force.h) and contacts
 * (contact/bodies/body_contacts.h) together, as integrators see them; their energies are in
 * energy.h. */
#ifndef SE3DI_ASSEMBLY_LOADS_H
#define SE3DI_ASSEMBLY_LOADS_H

#include "contact/bodies/body_contacts.h"
#include "force/force.h"

/* Wrenches on all bodies, see se3di_forces_eval. */
se3d_status se3di_loads_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed);
/* The same with powers and efforts, those of contacts left out: se3di_forces_sum. */
se3d_status se3di_loads_sum(const se3di_model *model, double t, se3di_force_sums *sums);
/* The state of the model at t is about to be accepted (all that can fail), and is. */
se3d_status se3di_loads_prepare(se3di_model *model, double t, se3di_error *error);
void se3di_loads_accept(se3di_model *model);
/* There may be forces that depend on positions or velocities. */
int se3di_loads_are_stiff(const se3di_model *model);

#endif
