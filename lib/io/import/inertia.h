/* SPDX-License-Identifier: BSD-3-Clause */
/* Inertias as other formats have them, and masses of solids. */
#ifndef SE3D_IO_IMPORT_INERTIA_H
#define SE3D_IO_IMPORT_INERTIA_H

#include "io/import/machine.h"

/* Whether a body can have this inertia: moments > 0, none more than the sum of the others. */
bool se3di_inertia_is_sound(double mass, const double J[9]);
/* Make the inertia one that a body can have: symmetric, moments > 0, none more than the sum of the
 * others. What was changed is noted with the name of the `body`. */
bool se3di_inertia_mend(se3di_machine *m, const char *body, size_t line, double mass, double J[9]);
/* Mass and inertia about the centre of a solid of `density`, whose z is its axis; a type without
 * volume gives 0. */
se3di_mass se3di_solid_mass(const se3di_machine_shape *shape, double density);

#endif
