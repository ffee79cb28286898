/* SPDX-License-Identifier: BSD-3-Clause */
/* Signs that stability, not accuracy, limits the steps of an explicit method. */
#include "integrator/explicit_point.h"
#include "integrator/explicit_step.h"

int se3di_explicit_is_held(const se3di_integration *integration)
{
    return se3di_explicit_past_of(integration->equations->assembly.model)->held >= SE3DI_HELD_MIN;
}

void se3di_explicit_count_sign(se3di_explicit *m, int is_held)
{
    double *held = &m->past->held, *free = &m->past->free;
    if (is_held) {
        *held += 1.0;
        *free = 0.0;
    } else if (*held > 0.0) {
        *free += 1.0;
        *held = *free < SE3DI_FREE_MIN ? *held : 0.0;
        *free = *free < SE3DI_FREE_MIN ? *free : 0.0;
    }
}
