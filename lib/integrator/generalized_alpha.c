/* SPDX-License-Identifier: BSD-3-Clause */
/* generalized_alpha (Chung, Hulbert 1993; Lie group: Bruels, Cardona, Arnold 2012): order 2,
 * numerical damping set by the spectral radius rho at infinite frequency,
 *
 *     alpha_m = (2 rho - 1)/(rho + 1)   alpha_f = rho/(rho + 1)
 *     gamma = 1/2 + alpha_f - alpha_m   beta = (gamma + 1/2)^2 / 4          docs/theory/newmark.md
 */
#include "integrator/newmark.h"

static se3di_newmark parameters(const se3di_integration *integration)
{
    const double rho = integration->settings.spectral_radius;
    return (se3di_newmark){.alpha_m = (2.0 * rho - 1.0) / (rho + 1.0),
                           .alpha_f = rho / (rho + 1.0)};
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

const se3di_integrator se3di_integrator_generalized_alpha = {
    .name = "generalized_alpha",
    .tag = SE3D_METHOD_GENERALIZED_ALPHA,
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
