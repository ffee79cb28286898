/* SPDX-License-Identifier: BSD-3-Clause */
/* hht (Hilber, Hughes, Taylor 1977; multibody index 3: Negrut, Rampalli, Ottarsson, Sajdak 2007):
 * order 2, numerical damping set by alpha in [-1/3, 0],
 *
 *     gamma = (1 - 2 alpha)/2    beta = (1 - alpha)^2 / 4
 *
 * written as the Newmark family with alpha_m = 0, alpha_f = -alpha: a = (1 + alpha) vdot - alpha
 * vdot_n, so that the equations of motion hold at the end of the step, not between its ends.
 * docs/theory/newmark.md */
#include "integrator/newmark.h"

static se3di_newmark parameters(const se3di_integration *integration)
{
    return (se3di_newmark){.alpha_m = 0.0, .alpha_f = -integration->settings.alpha};
}

static se3d_status start(se3di_integration *integration, double h)
{
    const se3di_newmark m = parameters(integration);
    return se3di_newmark_start(integration, &m, h);
}

static se3d_status renew(se3di_integration *integration)
{
    const se3di_newmark m = parameters(integration);
    return se3di_newmark_renew(integration, &m);
}

static se3d_status step(se3di_integration *integration, double h)
{
    const se3di_newmark m = parameters(integration);
    return se3di_newmark_make_step(integration, &m, h);
}

static se3d_status run(se3di_integration *integration, double t_end)
{
    const se3di_newmark m = parameters(integration);
    return se3di_newmark_run(integration, &m, t_end);
}

static se3d_status advance(se3di_integration *integration, double t_end)
{
    const se3di_newmark m = parameters(integration);
    return se3di_newmark_advance(integration, &m, t_end);
}

const se3di_integrator se3di_integrator_hht = {
    .name = "hht",
    .tag = SE3D_METHOD_HHT,
    .history_count = se3di_newmark_history_count,
    .work_count = se3di_newmark_work_count,
    .start = start,
    .renew = renew,
    .step = step,
    .run = run,
    .advance = advance,
    .interpolate = se3di_newmark_interpolate,
    .is_implicit = 1,
    .is_reduced = 1,
    .orders = 1u << 2,
    .reach = SE3DI_NEWMARK_REACH,
    .fixes_step = 1,
};
