/* SPDX-License-Identifier: BSD-3-Clause */
/* All that acts on bodies: gravity and force elements (force/force.h) and contacts
 * (contact/body_contacts.h) together, as integrators and energies see them. */
#ifndef SE3DI_CONTACT_LOADS_H
#define SE3DI_CONTACT_LOADS_H

#include "contact/body_contacts.h"
#include "force/force.h"

/* Wrenches on all bodies, see se3di_forces_eval. */
se3d_status se3di_loads_eval(const se3di_model *model, double t, double *wrench, uint32_t *failed);
/* Potential energy [J], that of the springs of contacts included. */
se3d_status se3di_loads_potential(const se3di_model *model, double t, double *potential);
/* Powers [W], see se3di_power_eval. All that goes into contacts counts as dissipated; what their
 * springs hold of it is subtracted where energies are reported. */
se3d_status se3di_loads_power(const se3di_model *model, double t, double power[3]);
/* Add the work since the last accepted state, over a step h, by the trapezoidal rule to model->work
 * (h = 0: only note the present power, and begin the audit where it is void). */
se3d_status se3di_work_accept(se3di_model *model, double h);
/* Energy lost since the audit began [J]. */
double se3di_work_lost(const se3di_model *model);

/* The state of the model at t is about to be accepted (all that can fail), and is. */
se3d_status se3di_loads_prepare(se3di_model *model, double t, se3di_error *error);
void se3di_loads_accept(se3di_model *model);
/* There may be forces that depend on positions or velocities. */
int se3di_loads_are_stiff(const se3di_model *model);

#endif
