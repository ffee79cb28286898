/* SPDX-License-Identifier: BSD-3-Clause */
/* Signs that stability, not accuracy, limits the steps of an explicit method, and that many bodies
 * are at each other. */
#include "contact/bodies/crowd.h"
#include "integrator/explicit_point.h"
#include "integrator/explicit_step.h"

#include <math.h>

int se3di_explicit_is_held(const se3di_integration *integration)
{
    const double held = se3di_explicit_past_of(integration->equations->assembly.model)->held;
    return held >= SE3DI_HELD_MIN || (integration->settings.leaves_crowd && held < 0.0);
}

void se3di_explicit_watch_crowd(se3di_explicit *m)
{
    if (m->step.integration->settings.leaves_crowd) {
        m->past->held = se3di_bodies_crowd(m->assembly->model) ? -1.0 : fmax(m->past->held, 0.0);
    }
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
