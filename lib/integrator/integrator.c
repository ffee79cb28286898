/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/integrator.h"

const se3di_integrator *se3di_integrator_find(int32_t method)
{
    switch (method) {
    case SE3D_METHOD_AUTO:
    case SE3D_METHOD_DOP853:
        return &se3di_integrator_dop853;
    case SE3D_METHOD_RK4:
        return &se3di_integrator_rk4;
    case SE3D_METHOD_RK45:
        return &se3di_integrator_rk45;
    case SE3D_METHOD_GENERALIZED_ALPHA:
        return &se3di_integrator_generalized_alpha;
    case SE3D_METHOD_HHT:
        return &se3di_integrator_hht;
    case SE3D_METHOD_RATTLE:
        return &se3di_integrator_rattle;
    case SE3D_METHOD_BDF:
        return &se3di_integrator_bdf;
    case SE3D_METHOD_RADAU:
        return &se3di_integrator_radau;
    case SE3D_METHOD_VERLET:
        return &se3di_integrator_verlet;
    default:
        return NULL;
    }
}
