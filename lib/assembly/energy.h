/* SPDX-License-Identifier: BSD-3-Clause */
/* Energies, powers and work of a model: bodies, gravity, force elements, contacts and drivers.
 * docs/theory/energy.md */
#ifndef SE3DI_ASSEMBLY_ENERGY_H
#define SE3DI_ASSEMBLY_ENERGY_H

#include "model/model.h"

/* The kinetic energy of all bodies [J]. */
double se3di_kinetic_energy(const se3di_model *model);
/* Potential energy of gravity (zero at the ground origin) and elements [J]. */
se3d_status se3di_forces_potential(const se3di_model *model, double t, double *potential);
/* The same with that of the springs of contacts, which *springs gets, too. */
se3d_status se3di_loads_potential(const se3di_model *model, double t, double *potential,
                                  double *springs);
/* Power at the state of the model [W]: {dissipated, fed in by actuators, loads and gravity that
 * changes, fed in by drivers (from model->lambda)}. All that goes into contacts counts as
 * dissipated; what their springs hold of it is subtracted when energies are reported. */
se3d_status se3di_loads_power(const se3di_model *model, double t, double power[3]);
/* The same where power[0] and power[1] hold those of gravity and elements; contacts: theirs. */
se3d_status se3di_loads_complete_power(const se3di_model *model, double t, const double contacts[2],
                                       double power[3]);
/* Add the work since the last accepted state, over a step h, by the trapezoidal rule to model->work
 * (h = 0: only note the present power, and begin the audit if it is void). */
se3d_status se3di_work_accept(se3di_model *model, double h);
/* The same with the present power. */
void se3di_work_take(se3di_model *model, double h, const double power[3]);
/* Work of actuators since the audit began [J], with what the energies of callbacks have become:
 * model->work[1] began at their negative. @return OK, CALLBACK, NOT_FINITE */
se3d_status se3di_work_fed(const se3di_model *model, double *fed);
/* Energy lost since the audit began [J]; `springs` of contacts hold energy now. */
double se3di_work_lost(const se3di_model *model, double springs);

#endif
