/* SPDX-License-Identifier: BSD-3-Clause */
/* rattle: symplectic and symmetric, order 2; the constraints of positions and of velocities hold at
 * every step. Forces that depend on velocities are taken at the end velocities, by fixed-point
 * iteration. Order 4 is the symmetric composition of five steps of Suzuki (1990),
 * gamma = 1/(4 - 4^(1/3)): gamma, gamma, 1 - 4 gamma, gamma, gamma.  docs/theory/rattle.md */
#include "integrator/lie_verlet.h"

#define FORCE_ITERATIONS 12

/* Parts of a step from t0 to t0 + h. */
static se3d_status advance_parts(se3di_lie_verlet *m, double t0, double h, const double *weights,
                                 int parts)
{
    double sum = 0.0;
    m->is_singular = 0;
    for (int k = 0; k < parts; ++k) {
        sum += weights[k];
        m->h = weights[k] * h;
        m->t1 = k == parts - 1 ? t0 + h : t0 + sum * h;
        SE3DI_TRY(se3di_lie_verlet_advance(m));
    }
    return SE3D_OK;
}

/* Order 4. Near a singular position, where constraints have no leverage, going back and forth
 * leaves the branch or loses energy: there the step is made of a few forward ones of order 2, or,
 * if one of them fails, of fewer. Many would meet the position too closely. */
static se3d_status advance_composed(se3di_lie_verlet *m, double t0, double h)
{
    static const double compose4[5] = {0.41449077179437573714, 0.41449077179437573714,
                                       -0.65796308717750294857, 0.41449077179437573714,
                                       0.41449077179437573714};
    static const double quarters[4] = {0.25, 0.25, 0.25, 0.25}, halves[2] = {0.5, 0.5}, whole = 1.0;
    static const struct {
        const double *weights;
        int parts;
    } forward[] = {{quarters, 4}, {halves, 2}, {&whole, 1}};
    se3d_status status = advance_parts(m, t0, h, compose4, 5);
    if (status >= 0 && !m->is_singular) {
        return status;
    }
    status = status >= 0 ? SE3D_ERR_NO_CONVERGENCE : status;
    for (int k = 0; k < 3 && status == SE3D_ERR_NO_CONVERGENCE; ++k) {
        se3di_equations_come_back(m->equations);
        status = advance_parts(m, t0, h, forward[k].weights, forward[k].parts);
    }
    return status;
}

static se3d_status step(se3di_integration *integration, double h)
{
    const double t0 = integration->equations->assembly.model->time;
    const int is_composed = integration->settings.order == 4;
    se3di_lie_verlet m = se3di_lie_verlet_begin(integration, FORCE_ITERATIONS);
    if (is_composed && m.friction.count > 0) {
        return se3di_error_set(
            integration->equations->error, SE3D_ERR_UNSUPPORTED,
            "rattle of order 4 steps back in time, which friction does not allow; "
            "use order 2");
    }
    if (!is_composed) {
        return se3di_lie_verlet_follow(&m, h, t0 + h);
    }
    se3d_status status = se3di_equations_keep(m.equations);
    status = status < 0 ? status : advance_composed(&m, t0, h);
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
    .chooses_step = 1,
    .get_reach = se3di_equal_steps_reach,
    .orders = 1u << 2 | 1u << 4,
    .weighs_bodies = 1,
    .moves_first = 1,
};
