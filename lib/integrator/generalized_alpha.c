/* SPDX-License-Identifier: BSD-3-Clause */
/* generalized_alpha (Chung, Hulbert 1993; Lie group: Bruels, Cardona, Arnold 2012): order 2,
 * numerical damping set by the spectral radius rho at infinite frequency,
 *
 *     alpha_m = (2 rho - 1)/(rho + 1)   alpha_f = rho/(rho + 1)
 *     gamma = 1/2 + alpha_f - alpha_m   beta = (gamma + 1/2)^2 / 4          docs/theory/newmark.md
 */
#include "integrator/newmark.h"

static se3di_newmark get_coefficients(const se3di_integrator_settings *settings)
{
    const double rho = settings->spectral_radius;
    return (se3di_newmark){.alpha_m = (2.0 * rho - 1.0) / (rho + 1.0),
                           .alpha_f = rho / (rho + 1.0)};
}

const se3di_integrator se3di_integrator_generalized_alpha = {
    .name = "generalized_alpha",
    .tag = SE3D_METHOD_GENERALIZED_ALPHA,
    SE3DI_NEWMARK_METHOD,
    .newmark = get_coefficients,
};
