/* SPDX-License-Identifier: BSD-3-Clause */
/* Gravity: m g(t) at every centre of mass; V = -m g . r. If g changes in time, dV/dt at rest is
 * counted as work of an actuator.  docs/theory/loads.md */
#include "force/force.h"

se3d_status se3di_gravity_eval(const se3di_model *model, double t, double g[3], double *g_t)
{
    for (int c = 0; c < 3; ++c) {
        double jet[3] = {model->gravity[c], 0.0, 0.0};
        int32_t function = model->gravity_function[c];
        if (function >= 0) {
            SE3DI_TRY(se3di_function_eval(&model->functions[function], &t, jet, NULL));
        }
        g[c] = jet[0];
        if (g_t) {
            g_t[c] = jet[1];
        }
    }
    return SE3D_OK;
}
