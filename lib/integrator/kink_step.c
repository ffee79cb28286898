/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/kink_step.h"

#include <math.h>

#define SAME 1e-9 /* of a step: a kink is there already */

/* The length of the step from t that ends at `end`, a little before a kink: methods add it to t,
 * and rounding must not take them over the kink. */
static double length_to(double t, double end)
{
    double before = end;
    while (t + (before - t) > end) {
        before = nextafter(before, t);
    }
    return before - t;
}

double se3di_kink_step(se3di_integration *integration, double t, double h, double ahead,
                       double *end)
{
    se3di_kink kink;
    if (!isfinite(ahead) ||
        !se3di_kink_find(&integration->equations->assembly, t, t + ahead, &kink)) {
        return h;
    }
    const double rest = kink.t_before - t;
    if (!(rest > SAME * h)) {
        integration->at_kink = 1;
        integration->kink = kink;
        return 0.0;
    }
    if (rest > (1.0 + SAME) * h) {
        const double part = rest < (2.0 - SAME) * h ? 0.5 * rest : h;
        *end = part < h ? t + part : *end;
        return part;
    }
    *end = kink.t_before;
    return length_to(t, kink.t_before);
}
