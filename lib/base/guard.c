/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/guard.h"

#include <math.h>

#include "base/floats.h"

#define HALF_FIRST 4096.0 /* steps until the time is noted first, and again as many for a pace */
#define MARGIN     1.01   /* of what is foreseen: fixed steps may be as many as are allowed */

void se3di_guard_begin(se3di_guard *guard, double begin, double end)
{
    guard->begin = guard->half_time = begin;
    guard->end = end;
    guard->steps = guard->half = 0.0;
    guard->next = HALF_FIRST;
    guard->came = guard->muted = 0;
}

int se3di_guard_ask(se3di_guard *guard)
{
    if (guard && guard->interrupt && !guard->muted && !guard->came) {
        guard->came = guard->interrupt(guard->ctx) != 0;
        se3di_floats_resume();
    }
    return guard && !guard->muted && guard->came;
}

/* Steps of the whole run at the pace of the last ones; infinite if the time stands still. */
static double foresee(const se3di_guard *guard, double t, double since, double steps)
{
    const double rest = guard->end - t;
    return guard->steps + (t > since ? steps * (rest / (t - since)) : HUGE_VAL);
}

int se3di_guard_count(se3di_guard *guard, double t, se3di_guard_pace *pace)
{
    const double steps = guard->steps;
    const double last = steps - guard->half;
    const int has_pace = guard->half > 0.0;
    guard->steps += 1.0;
    if (steps < guard->next && steps < guard->most) {
        return 0;
    }
    *pace = (se3di_guard_pace){.steps = steps,
                               .length = (t - guard->half_time) / fmax(1.0, last),
                               .foreseen = fmin(foresee(guard, t, guard->half_time, last),
                                                foresee(guard, t, guard->begin, steps))};
    guard->half = steps;
    guard->half_time = t;
    guard->next = 2.0 * steps;
    return steps >= guard->most || (has_pace && pace->foreseen > MARGIN * guard->most);
}
