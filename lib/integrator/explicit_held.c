/* SPDX-License-Identifier: BSD-3-Clause */
/* Signs that stability, not accuracy, limits the steps of an explicit method, and that many bodies
 * are at each other. */
#include "contact/bodies/crowd.h"
#include "integrator/explicit_point.h"
#include "integrator/explicit_step.h"

#include <math.h>

#define PATIENCE 256.0 /* steps, shorter on the average than */
#define BRIEF    5e-5  /* s: convex makes one of 20 or more; */
#define EACH     5e-6  /* s, what a step takes for each body: it is slower than what happens, */
#define MOST     2e-4  /* s: and convex makes one of 5 or more */

int se3di_explicit_is_held(const se3di_integration *integration)
{
    const double held = se3di_explicit_past_of(integration->equations->assembly.model)->held;
    return held >= SE3DI_HELD_MIN || (integration->settings.leaves_crowd && held < 0.0);
}

void se3di_explicit_watch_crowd(se3di_explicit *m)
{
    const int32_t crowd = m->step.integration->settings.leaves_crowd;
    if (crowd != SE3DI_CROWD_NONE) {
        const double step[2] = {m->past->at.begin, m->past->at.time};
        static const se3di_crowd_pace pace = {
            .steps = PATIENCE, .brief = BRIEF, .brief_each = EACH, .brief_most = MOST};
        const int meets =
            se3di_crowd_watch_step(&m->past->watch, m->assembly->model, crowd, step, &pace);
        m->past->held = meets ? -1.0 : fmax(m->past->held, 0.0);
    }
}

int se3di_explicit_leaves_crowd(const se3di_model *model)
{
    return se3di_explicit_past_of(model)->held < 0.0;
}

void se3di_explicit_stay(se3di_model *model)
{
    se3di_explicit_past *past = se3di_explicit_past_of(model);
    past->held = fmax(past->held, 0.0);
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
