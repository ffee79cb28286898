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

static se3di_newmark get_coefficients(const se3di_integrator_settings *settings)
{
    return (se3di_newmark){.alpha_m = 0.0, .alpha_f = -settings->alpha};
}

const se3di_integrator se3di_integrator_hht = {
    .name = "hht",
    .tag = SE3D_METHOD_HHT,
    SE3DI_NEWMARK_METHOD,
    .newmark = get_coefficients,
};
