/* SPDX-License-Identifier: BSD-3-Clause */
/* rattle: symplectic and symmetric, order 2; the constraints of positions and of velocities hold at
 * every step. Forces that depend on velocities are taken at the end velocities, by fixed-point
 * iteration. Order 4 is the symmetric composition of five steps of Suzuki (1990),
 * gamma = 1/(4 - 4^(1/3)): gamma, gamma, 1 - 4 gamma, gamma, gamma.  docs/theory/rattle.md */
#include "integrator/lie_verlet.h"

#define FORCE_ITERATIONS 12

static se3d_status advance(se3di_lie_verlet *m)
{
    SE3DI_TRY(se3di_lie_verlet_drift(m));
    SE3DI_TRY(se3di_lie_verlet_kick(m));
    return se3di_lie_verlet_finish(m);
}

static se3d_status step(se3di_integration *integration, double h)
{
    static const double compose2[1] = {1.0};
    static const double compose4[5] = {0.41449077179437573714, 0.41449077179437573714,
                                       -0.65796308717750294857, 0.41449077179437573714,
                                       0.41449077179437573714};
    se3di_assembly *assembly = &integration->equations->assembly;
    double t0 = assembly->model->time;
    int parts = integration->settings.order == 4 ? 5 : 1;
    const double *weights = parts == 5 ? compose4 : compose2;
    se3di_lie_verlet m = se3di_lie_verlet_begin(integration, FORCE_ITERATIONS);
    if (parts == 5 && m.friction.count > 0) {
        return se3di_error_set(
            integration->equations->error, SE3D_ERR_UNSUPPORTED,
            "rattle of order 4 steps back in time, which friction does not allow; "
            "use order 2");
    }
    se3d_status status = se3di_equations_keep(m.equations);
    double sum = 0.0;
    for (int k = 0; k < parts && status >= 0; ++k) {
        sum += weights[k];
        m.h = weights[k] * h;
        m.t1 = k == parts - 1 ? t0 + h : t0 + sum * h;
        status = advance(&m);
    }
    if (status < 0) {
        se3di_equations_come_back(m.equations);
        return status;
    }
    ++integration->equations->counters.steps;
    return SE3D_OK;
}

const se3di_integrator se3di_integrator_rattle = {
    .name = "rattle",
    .tag = SE3D_METHOD_RATTLE,
    .history_count = se3di_lie_verlet_history_count,
    .work_count = se3di_lie_verlet_work_count,
    .start = se3di_lie_verlet_start,
    .renew = se3di_lie_verlet_renew,
    .step = step,
    .orders = 1u << 2 | 1u << 4,
};
