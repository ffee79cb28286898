/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/step_error.h"

#include "base/log.h"
#include "integrator/integrator.h"
#include "integrator/state.h"
#include "math/vec3.h"

#include <math.h>

#define MUCH 1e-3

/* The largest change of the accelerations of a free body over the step: of its centre, and of its
 * turn. */
static void measure(const se3di_equations *equations, double change[2])
{
    const se3di_assembly *assembly = &equations->assembly;
    change[0] = change[1] = 0.0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const size_t at = 6 * (size_t)assembly->free_body[k];
        const double *now = assembly->model->acceleration + at;
        const double *before = equations->accepted_acceleration + at;
        double d[6];
        for (int c = 0; c < 6; ++c) {
            d[c] = now[c] - before[c];
        }
        change[0] = fmax(change[0], se3di_norm(d));
        change[1] = fmax(change[1], se3di_norm(d + 3));
    }
}

/* Nobody has given a step, nor do contacts choose it. */
static int is_asked(const se3di_integration *integration)
{
    const se3di_model *model = integration->equations->assembly.model;
    return !(integration->settings.step > 0.0) && integration->settings.order <= 2 &&
           model->contacts.pair_count == 0 && !model->sets;
}

void se3di_step_error_add(se3di_integration *integration, double h)
{
    const se3di_equations *equations = integration->equations;
    const se3di_model *model = equations->assembly.model;
    se3di_step_error *error = &integration->step_error;
    double change[2];
    if (!is_asked(integration)) {
        return;
    }
    measure(equations, change);
    error->shift += h * h * change[0] / 12.0;
    error->turn += h * h * change[1] / 12.0;
    const double part = fmax(error->shift / se3di_state_length(model), error->turn);
    if (part >= MUCH && part >= 10.0 * error->told) {
        error->told = part;
        se3di_log_write(
            equations->error, SE3D_LOG_WARNING,
            "t = %g s: no step was given to %s, which controls no error: its steps of "
            "%.3g s may have made errors of %.2g m and %.2g rad in all; give a step, or "
            "take a method with error control",
            model->time, integration->method->name, h, error->shift, error->turn);
    }
}
