/* SPDX-License-Identifier: BSD-3-Clause */
/* Signs that stability, not accuracy, limits the steps of an explicit method, and that many bodies
 * are at each other. */
#include "contact/bodies/crowd.h"
#include "integrator/explicit_point.h"
#include "integrator/explicit_step.h"

#include <math.h>

#define COUNTED 256.0 /* steps */
#define SHORT   5e-5  /* s, shorter than this on the average: convex makes one of 20 or more */
#define TINY    2e-6  /* s, a step that no touch of its own needs: contacts come and go */
#define TINIES  20.0  /* such steps in a row tell, and need not wait for the others */

int se3di_explicit_is_held(const se3di_integration *integration)
{
    const double held = se3di_explicit_past_of(integration->equations->assembly.model)->held;
    return held >= SE3DI_HELD_MIN || (integration->settings.leaves_crowd && held < 0.0);
}

/* The last COUNTED steps were short, or on a mesh the last TINIES tiny, and something touches at
 * their end. */
static int is_slow(const se3di_explicit *m, int32_t crowd)
{
    se3di_explicit_past *past = m->past;
    const double t = past->at.time;
    past->counted += 1.0;
    past->tiny = t - past->at.begin < TINY ? past->tiny + 1.0 : 0.0;
    if (past->counted < COUNTED) {
        return crowd == SE3DI_CROWD_ROUGH && past->tiny >= TINIES &&
               se3di_bodies_touch(m->assembly->model);
    }
    const int is_slow =
        t - past->counts < SHORT * COUNTED && se3di_bodies_touch(m->assembly->model);
    past->counted = 0.0;
    past->counts = t;
    return is_slow;
}

void se3di_explicit_watch_crowd(se3di_explicit *m)
{
    const int32_t crowd = m->step.integration->settings.leaves_crowd;
    if (crowd != SE3DI_CROWD_NONE) {
        const int meets =
            crowd == SE3DI_CROWD_NEAR ? se3di_bodies_crowd(m->assembly->model) : is_slow(m, crowd);
        m->past->held = meets ? -1.0 : fmax(m->past->held, 0.0);
    }
}

int se3di_explicit_leaves_crowd(const se3di_model *model)
{
    return se3di_explicit_past_of(model)->held < 0.0;
}

void se3di_explicit_stays(se3di_model *model)
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
