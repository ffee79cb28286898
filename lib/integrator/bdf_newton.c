/* SPDX-License-Identifier: BSD-3-Clause */
/* A step of bdf, y_1 = base + c y'_1:
 *
 *     v_1 = base_v + c vdot_1,   r_1 = base_r + c v_1,   p_1 = (I - c/2 Omega(w_1))^-1 base_p
 *     M vdot_1 + Phi_q^T lambda = Q + velocity terms,   Phi_q v_1 = nu(t_1)
 *
 * where the base of the positions is moved so that the predicted ones fulfil Phi(q, t_1) = 0: both
 * levels of the constraints take part (stabilised index 2; Gear, Gupta, Leimkuhler 1985).
 * The Jacobian is taken at positions that fulfil the constraints, the predicted ones projected:
 * elsewhere redundant rows are only nearly dependent, and what they then ask for is error of the
 * prediction over its own size. With it the regularisation can be small enough that a singular
 * position is passed as if it were none, except within its square root.  docs/theory/bdf.md */
#include "integrator/bdf.h"

#include "contact/bodies/pace.h"
#include "force/friction.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define REGULARISATION 1e-9
#define CLOSINGS       3 /* until rounding is left */

/* y_1 from the accelerations, and the frames. */
static void update_state(se3di_bdf *m)
{
    const double c = m->c;
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const double *base = m->base + k * SE3DI_STATE_SIZE;
        double *y = m->y + k * SE3DI_STATE_SIZE;
        double rate[4];
        for (size_t i = 0; i < 6; ++i) {
            y[7 + i] = base[7 + i] + c * m->acceleration[6 * k + i];
        }
        for (size_t i = 0; i < 3; ++i) {
            y[i] = base[i] + c * y[7 + i];
        }
        se3di_quat_rate(base + 3, y + 10, rate);
        const double scale = 1.0 / (1.0 + 0.25 * c * c * se3di_dot(y + 10, y + 10));
        for (size_t i = 0; i < 4; ++i) {
            y[3 + i] = scale * (base[3 + i] + c * rate[i]);
        }
    }
    se3di_state_set(m->assembly, m->y);
}

/* The positions that were predicted, put onto their constraints, by another base: the constraints
 * of positions take part in the step (mu of Gear, Gupta, Leimkuhler), and the Newton matrix stays
 * exact. */
static se3d_status project_prediction(se3di_bdf *m)
{
    const se3di_assembly *assembly = m->assembly;
    update_state(m);
    if (assembly->row_count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_state_project_positions(m->equations, m->t, &m->past->scale, m->accuracy));
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        double *base = m->base + k * SE3DI_STATE_SIZE;
        double rate[4];
        se3di_quat_rate(frame->p, frame->w, rate);
        for (int i = 0; i < 3; ++i) {
            base[i] = frame->r[i] - m->c * frame->v[i];
        }
        for (int i = 0; i < 4; ++i) {
            base[3 + i] = frame->p[i] - m->c * rate[i];
        }
    }
    update_state(m);
    return SE3D_OK;
}

/* The size of a change of the accelerations, as it shows in velocities and positions. */
static double measure(const se3di_bdf *m, const double *change)
{
    double largest = 0.0;
    for (size_t k = 0; k < 6 * (size_t)m->assembly->body_count; k += 6) {
        if (se3di_state_is_carrier(m->assembly, k / 6)) {
            const double z = se3di_state_part(m->assembly, k / 6, &m->past->scale, change + k);
            largest = se3di_larger(largest, z);
            continue;
        }
        const double linear = se3di_norm(change + k), angular = se3di_norm(change + k + 3);
        const double part = linear * (1.0 / m->past->scale.speed + m->c / m->past->scale.length) +
                            angular * (1.0 / m->past->scale.spin + m->c);
        largest = se3di_larger(largest, part);
    }
    return m->c * largest / m->tolerance;
}

/* Right-hand sides of a Newton correction of accelerations and multipliers. */
static se3d_status eval_residual(se3di_bdf *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    se3di_assembly_eval_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    se3di_frictions_take_loads(assembly->model, m->lambda);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, m->t, equations->b, equations->error));
    se3di_assembly_add_transposed(assembly, -1.0, m->lambda, equations->b);
    se3di_assembly_subtract_mass(assembly, m->acceleration, equations->b);
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul(assembly, equations->x, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = (assembly->f[3 * (size_t)k + 1] - equations->c[k]) / m->c;
    }
    return SE3D_OK;
}

/* One correction; its size relative to the tolerance. */
static se3d_status iterate(se3di_bdf *m, int refactor, double *size)
{
    se3di_equations *equations = m->equations;
    se3di_newton *newton = &m->integration->newton;
    const size_t n = m->assembly->unknown_count;
    SE3DI_TRY(eval_residual(m));
    if (refactor) {
        se3di_kkt_expect(newton->kkt, equations->b, equations->c);
        const se3d_status status =
            se3di_newton_factor_rates(newton, m->t, m->acceleration, m->lambda, m->c);
        if (status < 0) {
            se3di_kkt_expect(newton->kkt, NULL, NULL);
            return status;
        }
        m->fast = se3di_relax_trust(equations, se3di_relax_measure(newton, m->c, m->h));
    }
    SE3DI_TRY(se3di_newton_solve(newton));
    ++equations->counters.iterations;
    for (size_t k = 0; k < n; ++k) {
        m->acceleration[k] += equations->x[k];
    }
    for (uint32_t k = 0; k < m->assembly->row_count; ++k) {
        m->lambda[k] += equations->l[k];
    }
    memcpy(m->work, equations->x, n * sizeof *m->work);
    *size = measure(m, equations->x);
    update_state(m);
    return isfinite(*size) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

/* *size of the last correction of the accelerations, which is in m->work, without what the
 * projection of the end will take away: near a singular position the directions that the filter of
 * the Newton matrix leaves free. */
static se3d_status measure_tangent(se3di_bdf *m, double *size)
{
    se3di_equations *equations = m->equations;
    const se3di_assembly *assembly = m->assembly;
    if (*size <= 0.03 || !isfinite(*size) || assembly->row_count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_equations_factor(equations));
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        m->work[k] *= -1.0;
    }
    se3di_assembly_subtract_mass(assembly, m->work, equations->b);
    SE3DI_TRY(se3di_equations_solve(equations));
    *size = measure(m, equations->x);
    return SE3D_OK;
}

/* A fall from a correction that had blown up (a stop, a contact that comes and goes) says nothing
 * of what remains: what is left must be small by itself, too. */
static se3d_status iterate_to_convergence(se3di_bdf *m)
{
    double before = HUGE_VAL, size = HUGE_VAL;
    int refactor = 1;
    for (int k = 0; k < m->iterations_max; ++k) {
        SE3DI_TRY(se3di_equations_ask(m->equations));
        SE3DI_TRY(iterate(m, refactor, &size));
        const int is_traced = se3di_newton_note(&m->integration->newton, size * m->tolerance);
        if (size <= 1e-3 || (k > 0 && size <= 1.0 && size * size / before <= 1e-3) ||
            (k > 1 && size > 0.8 * before && size * m->tolerance <= SE3DI_STATE_NOISE) ||
            (k > 0 && size * m->tolerance <= se3di_relax_noise(&m->fast, &m->past->scale, m->h))) {
            return SE3D_OK;
        }
        if (k > 1 && size > 2.0 * before) {
            break;
        }
        refactor = is_traced || (k > 0 && size > 0.1 * before);
        before = size;
    }
    SE3DI_TRY(measure_tangent(m, &size));
    return size <= 0.03
               ? SE3D_OK
               : se3di_error_set(m->equations->error, SE3D_ERR_NO_CONVERGENCE,
                                 "t = %g s: Newton did not converge in a step of %g s; try a "
                                 "smaller step or tolerance",
                                 m->t, m->h);
}

/* Those of the predicted state: near a singular position multipliers have a pole, and their
 * curvature belongs to the matrix; and in the directions of dependent rows those of the step before
 * would add up rounding. */
static se3d_status predict_multipliers(se3di_bdf *m)
{
    se3di_equations *equations = m->equations;
    if (m->assembly->row_count == 0) {
        return SE3D_OK;
    }
    const se3di_kkt_settings before = se3di_state_begin(equations, REGULARISATION, 1e-12);
    const se3d_status status = se3di_state_evaluate(equations, m->t);
    se3di_state_end(equations, &before);
    SE3DI_TRY(status);
    memcpy(m->lambda, equations->l, m->assembly->row_count * sizeof *m->lambda);
    return SE3D_OK;
}

se3d_status se3di_bdf_solve(se3di_bdf *m)
{
    se3di_kkt *kkt = m->integration->newton.kkt;
    se3di_contacts_begin(m->assembly->model, m->is_controlled ? 0.0 : m->h, 1.0, 0);
    SE3DI_TRY(se3di_assembly_eval_functions(m->assembly, m->t, m->equations->error));
    SE3DI_TRY(project_prediction(m));
    SE3DI_TRY(predict_multipliers(m));
    const se3di_kkt_settings before = se3di_state_regularise(m->assembly, kkt, REGULARISATION);
    const se3d_status status = iterate_to_convergence(m);
    se3di_kkt_set_settings(kkt, &before);
    return status;
}

se3d_status se3di_bdf_close(se3di_bdf *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    if (!se3di_is_fast(&m->fast)) {
        return SE3D_OK; /* a step to start from may have no coefficient c */
    }
    const double weight = 1.0 / (m->c * m->c);
    for (int round = 0; round < CLOSINGS && assembly->row_count > 0; ++round) {
        se3di_assembly_eval_jacobian(assembly);
        se3di_assembly_eval_phi(assembly, equations->c);
        for (uint32_t k = 0; k < assembly->row_count; ++k) {
            equations->c[k] *= -weight;
        }
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        SE3DI_TRY(se3di_newton_solve_displacement(&m->integration->newton));
        for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
            m->work[k] = equations->x[k] / weight;
        }
        for (uint32_t k = 0; k < assembly->body_count; ++k) {
            se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
            assembly->formulation->move(frame, m->work + 6 * (size_t)k);
            se3di_quat_normalize(frame->p, frame->p);
            se3di_frame_update(frame);
        }
    }
    return SE3D_OK;
}
