/* SPDX-License-Identifier: BSD-3-Clause */
/* What the creation of force elements has in common. */
#ifndef SE3DI_SYSTEM_FORCE_INTERNAL_H
#define SE3DI_SYSTEM_FORCE_INTERNAL_H

#include "system/system_internal.h"

/* What every creation starts with: nulls the handle. */
se3d_status se3di_force_begin(se3d_system *system, se3d_force *force);
/* An element without functions and joints; the name is the caller's. */
se3di_force se3di_force_blank(int32_t type, const char *name);
/* body_i and body_j differ. */
se3d_status se3di_force_check_pair(se3d_system *system, const se3di_force *data);
/* The parameters of a tsda, rsda, friction or stop are what they may be; completes those that
 * follow from others. */
se3d_status se3di_force_check_values(se3d_system *system, se3di_force *data);
/* Check and take the matrices of a bushing. */
se3d_status se3di_force_take_bushing(se3d_system *system, const double K[36], const double C[36],
                                     se3di_force *data);
/* The element of a query; `out` is where its answer goes. */
se3d_status se3di_force_find_reader(const se3d_system *system, se3d_force force, const void *out,
                                    const se3di_force **data);
/* What every creation of an element by a definition starts with: declares `full`, the definition as
 * this version knows it, with a name that is free, and `data`, the element to fill from it. */
#define SE3DI_FORCE_BEGIN(definition, what, type)                                                  \
    SE3DI_TRY(se3di_force_begin(system, force));                                                   \
    definition full = definition##_default();                                                      \
    SE3DI_TRY(se3di_check_def(system, what, def, &full, sizeof full));                             \
    SE3DI_TRY(se3di_check_new_name(system, &system->model.force_slots, 0, "force", full.name));    \
    se3di_force data = se3di_force_blank(type, full.name)

/* Add the validated element. */
se3d_status se3di_force_add(se3d_system *system, const se3di_force *data, se3d_force *force);

#endif
