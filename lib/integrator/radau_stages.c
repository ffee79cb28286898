/* SPDX-License-Identifier: BSD-3-Clause */
/* The three stages of a step of radau:
 *
 *     r_i = r_0 + h sum_j a_ij v_j + s_i,   P_i = p_0 + h sum_j a_ij 1/2 P_j o w_j  (linear in P)
 *     p_i = P_i o exp(s_i),   s_i = H^-1 Phi_q^T mu_i,   Phi(q_i, t_i) = 0
 *     M vdot_i + Phi_q^T lambda_i = Q + velocity terms,   h sum_j a_ij vdot_j = v_i - v_0
 *     Phi_q qdot_i = nu(t_i)
 *
 * Unknowns are v_i, lambda_i and mu_i; H is the Newton matrix, so that one factorisation serves
 * all. In it the coefficients A are replaced by P = gamma S (I - N)^-1 S^-1, N strictly lower
 * triangular: the stages are solved one after the other with one real matrix, that of a step
 * gamma h; the errors that A - P leaves fall by 0.37 or better in every iteration, however stiff
 * the motion.  docs/theory/radau.md */
#include "force/friction.h"
#include "integrator/radau.h"
#include "integrator/radau_lines.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define STAGES     SE3DI_RADAU_STAGES
#define RATE_MIN   1e-3
#define RATE_STIFF 0.37 /* of the iteration where forces are much stiffer than the step is short */
#define MOST_STIFF 0.03 /* may be missing: what positions are off by, over the step, is velocity */
#define CLOSINGS   3    /* of positions at the end, until rounding is left */
#define STIFF      2.0  /* the defect at the start over what the filter leaves of it */
#define STAYS      0.5  /* of the correction three iterations ago: it is rounding that remains */

/* A vector of stage i. */
static double *at(double *values, int i, size_t size)
{
    return values + (size_t)i * size;
}

size_t se3di_radau_work_count(const se3di_assembly *assembly)
{
    size_t n = assembly->unknown_count;
    size_t rows = assembly->row_count;
    size_t count = se3di_state_count(assembly);
    return STAGES * (count + 4 * rows + 4 * n) + 2 * count + 2 * rows + 7 * n +
           assembly->joint_value_count + se3di_radau_lines_count(assembly->model);
}

void se3di_radau_begin(se3di_radau *m, se3di_integration *integration)
{
    se3di_assembly *assembly = &integration->equations->assembly;
    size_t n = assembly->unknown_count;
    size_t rows = assembly->row_count;
    size_t count = se3di_state_count(assembly);
    double *work = integration->work;
    *m = (se3di_radau){.integration = integration,
                       .equations = integration->equations,
                       .assembly = assembly,
                       .count = count,
                       .projects = se3di_kkt_has_loop(integration->equations->kkt)};
    struct {
        double **place;
        size_t size;
    } const parts[] = {
        {&m->Y, STAGES * count},
        {&m->lambda, STAGES * rows},
        {&m->ul, STAGES * rows},
        {&m->g, STAGES * rows},
        {&m->gap, STAGES * rows},
        {&m->shift, STAGES * n},
        {&m->b, STAGES * n},
        {&m->u, STAGES * n},
        {&m->uq, STAGES * n},
        {&m->f0, count},
        {&m->d, count},
        {&m->lambda0, rows},
        {&m->vdot, n},
        {&m->none, n},
        {&m->normal, n},
        {&m->sum, n},
        {&m->sum_q, n},
        {&m->C1, assembly->joint_value_count},
        {&m->relaxation, 2 * n + rows},
        {&m->lines, se3di_radau_lines_count(assembly->model)},
    };
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; ++k) {
        *parts[k].place = work;
        work += parts[k].size;
    }
}

static void copy(double *to, const double *from, size_t count)
{
    if (count > 0) {
        memcpy(to, from, count * sizeof *to);
    }
}

se3d_status se3di_radau_prepare(se3di_radau *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    se3di_kkt_settings settings = se3di_state_begin(equations, 1e-8, 1e-15);
    const se3d_status status = se3di_state_evaluate(equations, m->t);
    se3di_state_end(equations, &settings);
    SE3DI_TRY(status);
    copy(m->lambda0, equations->l, assembly->row_count);
    SE3DI_TRY(se3di_state_derivative(assembly, m->t, equations->x, equations->l, m->f0));
    return SE3D_OK;
}

/* P_i - (h/2) sum_j a_ij P_j o w_j = p_0, by elimination in the quaternions: coefficients multiply
 * from the right. */
static void solve_turn(const double p0[4], double h, double w[STAGES][3], double P[STAGES][4])
{
    double q[STAGES][STAGES][4], f[4], part[4], inverse[STAGES][4];
    for (int i = 0; i < STAGES; ++i) {
        memcpy(P[i], p0, 4 * sizeof(double));
        for (int j = 0; j < STAGES; ++j) {
            q[i][j][0] = i == j ? 1.0 : 0.0;
            for (int c = 0; c < 3; ++c) {
                q[i][j][1 + c] = -0.5 * h * se3di_radau_a[i][j] * w[j][c];
            }
        }
    }
    for (int k = 0; k < STAGES; ++k) {
        const double *d = q[k][k];
        const double norm = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3];
        for (int c = 0; c < 4; ++c) {
            inverse[k][c] = (c == 0 ? d[c] : -d[c]) / norm;
        }
        for (int i = k + 1; i < STAGES; ++i) {
            se3di_quat_mul(inverse[k], q[i][k], f);
            for (int j = k + 1; j < STAGES; ++j) {
                se3di_quat_mul(q[k][j], f, part);
                for (int c = 0; c < 4; ++c) {
                    q[i][j][c] -= part[c];
                }
            }
            se3di_quat_mul(P[k], f, part);
            for (int c = 0; c < 4; ++c) {
                P[i][c] -= part[c];
            }
        }
    }
    for (int k = STAGES - 1; k >= 0; --k) {
        for (int j = k + 1; j < STAGES; ++j) {
            se3di_quat_mul(P[j], q[k][j], part);
            for (int c = 0; c < 4; ++c) {
                P[k][c] -= part[c];
            }
        }
        se3di_quat_mul(P[k], inverse[k], P[k]);
    }
}

/* Positions of the stages from their velocities. */
static void update_positions(se3di_radau *m)
{
    const size_t bodies = m->assembly->body_count;
    for (size_t k = 0; k < bodies; ++k) {
        const double *y0 = m->y0 + k * SE3DI_STATE_SIZE;
        double v[STAGES][3], w[STAGES][3], P[STAGES][4];
        for (int j = 0; j < STAGES; ++j) {
            const double *y = at(m->Y, j, m->count) + k * SE3DI_STATE_SIZE;
            se3di_copy(y + 7, v[j]);
            se3di_copy(y + 10, w[j]);
        }
        solve_turn(y0 + 3, m->h, w, P);
        for (int i = 0; i < STAGES; ++i) {
            double *y = at(m->Y, i, m->count) + k * SE3DI_STATE_SIZE;
            const double *shift = at(m->shift, i, 6 * bodies) + 6 * k;
            se3di_add(y0, shift, y);
            for (int j = 0; j < STAGES; ++j) {
                se3di_add_scaled(m->h * se3di_radau_a[i][j], v[j], y);
            }
            se3di_quat_rotate(P[i], shift + 3, y + 3);
        }
    }
}

void se3di_radau_get_acceleration(const se3di_radau *m, int i, double *vdot)
{
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const size_t place = k * SE3DI_STATE_SIZE + 7;
        double *out = vdot + 6 * k;
        for (size_t c = 0; c < 6; ++c) {
            const double v0 = m->y0[place + c];
            out[c] = 0.0;
            for (int j = 0; j < STAGES; ++j) {
                out[c] +=
                    se3di_radau_inverse[i][j] / m->h * (at(m->Y, j, m->count)[place + c] - v0);
            }
        }
    }
}

/* The residual of a stage on its constraints: b = a - vdot, with the multipliers of a. */
static se3d_status eval_projected(se3di_radau *m, int i)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const size_t n = assembly->unknown_count;
    const double t = m->t + se3di_radau_c[i] * m->h;
    double *b = at(m->b, i, n);
    se3di_state_set(assembly, at(m->Y, i, m->count));
    SE3DI_TRY(se3di_state_project(equations, t, &m->scale, m->accuracy, 0));
    SE3DI_TRY(se3di_state_evaluate(equations, t));
    se3di_radau_get_acceleration(m, i, m->vdot);
    for (size_t k = 0; k < n; ++k) {
        b[k] = equations->x[k] - m->vdot[k];
    }
    copy(m->vdot, equations->x, n);
    copy(at(m->lambda, i, assembly->row_count), equations->l, assembly->row_count);
    return SE3D_OK;
}

static se3d_status eval_stage(se3di_radau *m, int i)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const size_t rows = assembly->row_count;
    const double t = m->t + se3di_radau_c[i] * m->h;
    double *b = at(m->b, i, assembly->unknown_count);
    se3di_state_set(assembly, at(m->Y, i, m->count));
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, t, equations->error));
    se3di_assembly_follow_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    se3di_frictions_take_loads(assembly->model, at(m->lambda, i, rows));
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, t, b, equations->error));
    SE3DI_TRY(se3di_radau_lines_apply(m, i, t, b));
    se3di_assembly_add_transposed(assembly, -1.0, at(m->lambda, i, rows), b);
    se3di_radau_get_acceleration(m, i, m->vdot);
    se3di_assembly_subtract_mass(assembly, m->vdot, b);
    se3di_assembly_get_velocity(assembly, m->sum);
    se3di_assembly_mul(assembly, m->sum, at(m->g, i, rows));
    se3di_assembly_eval_phi(assembly, at(m->gap, i, rows));
    for (size_t k = 0; k < rows; ++k) {
        at(m->g, i, rows)[k] -= assembly->f[3 * k + 1];
        at(m->gap, i, rows)[k] *= -1.0;
    }
    return SE3D_OK;
}

/* At the state of the second stage, which was evaluated last. */
static se3d_status factor(se3di_radau *m)
{
    const double c = se3di_radau_gamma * m->h;
    const se3di_newton_weights weights = {.velocity = c, .position = c * c};
    se3di_newton *newton = &m->integration->newton;
    copy(m->C1, m->assembly->C, m->assembly->joint_value_count);
    newton->tangent.excess = se3di_radau_lines_excess(m);
    const se3d_status status =
        se3di_newton_factor(newton, m->t + se3di_radau_c[1] * m->h, m->vdot,
                            at(m->lambda, 1, m->assembly->row_count), m->none, &weights);
    newton->tangent.excess = NULL;
    return status;
}

/* Right-hand sides of a stage of the transformed system from the balance of its forces and what
 * its velocities lack, with h (W b)_i in equations->b. */
static void set_balance(se3di_radau *m, int i)
{
    se3di_equations *equations = m->equations;
    const size_t rows = m->assembly->row_count;
    if (i > 0) {
        se3di_assembly_subtract_mass(m->assembly, m->sum, equations->b);
    }
    for (size_t k = 0; k < rows; ++k) { /* -S^-1 g */
        const double g0 = m->g[k], g1 = m->g[rows + k], g2 = m->g[2 * rows + k];
        const double h1 = g1 - se3di_radau_upper[1][2] * g2;
        equations->c[k] = i == 2 ? -g2
                          : i == 1
                              ? -h1
                              : -(g0 - se3di_radau_upper[0][1] * h1 - se3di_radau_upper[0][2] * g2);
    }
}

/* The part of a vector that is against the constraints, M^-1 Phi_q^T mu, at the state that was
 * evaluated last, whose projection takes it away: into equations->x. */
static se3d_status solve_normal(se3di_radau *m, const double *vector)
{
    se3di_equations *equations = m->equations;
    memset(equations->b, 0, m->assembly->unknown_count * sizeof *equations->b);
    se3di_assembly_mul(m->assembly, vector, equations->c);
    return se3di_equations_solve(equations);
}

/* The same if residuals are accelerations: those against the constraints, too, of which only the
 * tangent part is seen by forces: they do not feel what is projected away. */
static se3d_status set_missing(se3di_radau *m)
{
    se3di_equations *equations = m->equations;
    const size_t n = m->assembly->unknown_count;
    for (size_t k = 0; k < n; ++k) {
        m->sum[k] = equations->b[k] - m->sum[k];
    }
    SE3DI_TRY(solve_normal(m, m->sum));
    for (size_t k = 0; k < n; ++k) {
        m->normal[k] = equations->x[k];
        m->sum[k] = m->normal[k] - m->sum[k]; /* minus the tangent part */
    }
    memset(equations->b, 0, n * sizeof *equations->b);
    se3di_assembly_subtract_mass(m->assembly, m->sum, equations->b);
    se3di_newton_add_matrix(&m->integration->newton, m->normal, equations->b);
    return SE3D_OK;
}

/* One stage of the transformed system: u, uq and ul. */
static se3d_status solve_stage(se3di_radau *m, int i, double W[STAGES][STAGES])
{
    se3di_equations *equations = m->equations;
    const se3di_assembly *assembly = m->assembly;
    const size_t n = assembly->unknown_count;
    const size_t rows = assembly->row_count;
    const double c = se3di_radau_gamma * m->h;
    for (size_t k = 0; k < n; ++k) {
        equations->b[k] =
            m->h * (W[i][0] * m->b[k] + W[i][1] * m->b[n + k] + W[i][2] * m->b[2 * n + k]);
        m->sum[k] = m->sum_q[k] = 0.0;
        for (int j = 0; j < i; ++j) { /* minus, as what is to be subtracted */
            m->sum[k] -= se3di_radau_lower[i][j] * at(m->u, j, n)[k];
            m->sum_q[k] += se3di_radau_lower[i][j] * at(m->uq, j, n)[k];
        }
    }
    if (m->projects) {
        SE3DI_TRY(set_missing(m));
    } else {
        set_balance(m, i);
    }
    if (i > 0) {
        se3di_tangent_add_stiffness(&m->integration->newton.tangent, -c, m->sum_q, equations->b);
    }
    SE3DI_TRY(se3di_newton_solve(&m->integration->newton));
    for (size_t k = 0; k < n; ++k) {
        at(m->u, i, n)[k] = equations->x[k];
        at(m->uq, i, n)[k] = c * (equations->x[k] - m->normal[k]) + m->sum_q[k];
    }
    copy(at(m->ul, i, rows), equations->l, rows);
    return SE3D_OK;
}

/* The size of a change of position and velocity of a body. */
static double measure(const se3di_radau *m, size_t body, const double q[6], const double v[6])
{
    const se3di_state_scale *scale = &m->scale;
    if (se3di_state_is_carrier(m->assembly, body)) {
        return se3di_state_part(m->assembly, body, scale, v);
    }
    return se3di_norm(q) / scale->length + se3di_norm(q + 3) + se3di_norm(v) / scale->speed +
           se3di_norm(v + 3) / scale->spin;
}

/* Take the transformed corrections to the stages. */
static void apply_corrections(se3di_radau *m)
{
    const se3di_assembly *assembly = m->assembly;
    const size_t n = assembly->unknown_count;
    for (int i = 0; i < STAGES; ++i) {
        for (size_t k = 0; k < assembly->body_count; ++k) {
            double v[6] = {0.0}, q[6] = {0.0};
            for (int j = i; j < STAGES; ++j) {
                for (size_t c = 0; c < 6; ++c) {
                    v[c] += se3di_radau_upper[i][j] * at(m->u, j, n)[6 * k + c];
                    q[c] += se3di_radau_upper[i][j] * at(m->uq, j, n)[6 * k + c];
                }
            }
            double *y = at(m->Y, i, m->count) + k * SE3DI_STATE_SIZE;
            se3di_add(y + 7, v, y + 7);
            se3di_add(y + 10, v + 3, y + 10);
            const double part = measure(m, k, q, v) / m->tolerance;
            m->size = se3di_larger(m->size, part);
        }
    }
}

/* Multipliers enter the equations linearly and not through P. */
static void apply_multipliers(se3di_radau *m)
{
    const size_t rows = m->assembly->row_count;
    for (size_t k = 0; k < rows; ++k) {
        const double u[STAGES] = {m->ul[k], m->ul[rows + k], m->ul[2 * rows + k]};
        double change[STAGES];
        se3di_radau_untransform(u, m->h, change);
        for (int i = 0; i < STAGES; ++i) {
            at(m->lambda, i, rows)[k] += change[i];
        }
    }
}

static double largest_gap(const se3di_radau *m)
{
    const size_t rows = m->assembly->row_count;
    double largest = 0.0;
    for (size_t k = 0; k < STAGES * rows; ++k) {
        const double gap =
            fabs(m->gap[k]) /
            se3di_row_get_scale(m->assembly->model, (uint32_t)(k % rows), m->scale.length);
        largest = se3di_larger(largest, gap);
    }
    return largest;
}

/* Shift the stages onto the constraints of positions. */
static se3d_status correct_positions(se3di_radau *m)
{
    se3di_equations *equations = m->equations;
    const se3di_assembly *assembly = m->assembly;
    const size_t rows = assembly->row_count;
    const size_t bodies = assembly->body_count;
    if (!(largest_gap(m) > 1e-2 * m->tolerance)) {
        return SE3D_OK;
    }
    for (int i = 0; i < STAGES; ++i) {
        memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
        copy(equations->c, at(m->gap, i, rows), rows);
        SE3DI_TRY(se3di_newton_solve(&m->integration->newton));
        for (size_t k = 0; k < bodies; ++k) {
            const double none[6] = {0.0};
            const double *six = equations->x + 6 * k;
            double *shift = at(m->shift, i, 6 * bodies) + 6 * k;
            const double part = measure(m, k, six, none) / m->tolerance;
            m->size = se3di_larger(m->size, part);
            se3di_add(shift, six, shift);
            se3di_add(shift + 3, six + 3, shift + 3);
        }
    }
    return SE3D_OK;
}

/* (I - N) S^-1 A */
static void set_weights(double W[STAGES][STAGES])
{
    for (int j = 0; j < STAGES; ++j) {
        const double a2 = se3di_radau_a[2][j];
        const double a1 = se3di_radau_a[1][j] - se3di_radau_upper[1][2] * a2;
        const double a0 =
            se3di_radau_a[0][j] - se3di_radau_upper[0][1] * a1 - se3di_radau_upper[0][2] * a2;
        W[0][j] = a0;
        W[1][j] = a1 - se3di_radau_lower[1][0] * a0;
        W[2][j] = a2 - se3di_radau_lower[2][0] * a0 - se3di_radau_lower[2][1] * a1;
    }
}

static se3d_status iterate(se3di_radau *m, int refactor)
{
    static const int order[STAGES] = {0, 2, 1};
    double W[STAGES][STAGES];
    set_weights(W);
    for (int k = 0; k < STAGES; ++k) {
        SE3DI_TRY(m->projects ? eval_projected(m, order[k]) : eval_stage(m, order[k]));
    }
    if (refactor) {
        SE3DI_TRY(factor(m));
        m->fast = se3di_relax_measure(&m->integration->newton, se3di_radau_gamma * m->h, m->h);
    }
    copy(m->assembly->C, m->C1, m->assembly->joint_value_count);
    for (int i = 0; i < STAGES; ++i) {
        SE3DI_TRY(solve_stage(m, i, W));
    }
    ++m->equations->counters.iterations;
    ++m->iterations;
    m->past[2] = m->past[1];
    m->past[1] = m->past[0];
    m->past[0] = m->size;
    m->size = 0.0;
    apply_corrections(m);
    if (!m->projects) {
        se3di_radau_lines_correct(m, W);
        apply_multipliers(m);
        SE3DI_TRY(correct_positions(m));
    }
    update_positions(m);
    return isfinite(m->size) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

/* A faster fall than RATE_MIN says nothing of what remains: if a stop or a contact comes and
 * goes between iterations, corrections blow up and fall back by many orders; and if forces are
 * stiff what is soft falls fast, and what is stiff remains. */
static int has_converged(const se3di_radau *m, double rate)
{
    const int is_stiff = se3di_is_fast(&m->fast);
    const double least = is_stiff ? RATE_STIFF : RATE_MIN, most = is_stiff ? MOST_STIFF : 1.0;
    if (m->inner > 0.0 && m->iterations > 1 &&
        m->size * m->tolerance <= se3di_relax_noise(&m->fast, &m->scale, m->h)) {
        return 1;
    }
    if (rate > 0.8) {
        const int stays = m->iterations > 3 && m->size > STAYS * m->past[2];
        return m->size <= 0.1 || (stays && m->size * m->tolerance <= SE3DI_STATE_NOISE);
    }
    return m->size * fmax(rate, least) / (1.0 - rate) <= most;
}

static se3d_status iterate_to_convergence(se3di_radau *m)
{
    memset(m->shift, 0, STAGES * 6 * (size_t)m->assembly->body_count * sizeof *m->shift);
    memset(m->normal, 0, m->assembly->unknown_count * sizeof *m->normal);
    se3di_assembly_eval_mass(m->assembly); /* constant in the unknowns of this method */
    update_positions(m);
    m->has_lines = 0;
    SE3DI_TRY(m->projects ? SE3D_OK : se3di_radau_lines_begin(m));
    m->size = m->past[0] = m->past[1] = HUGE_VAL;
    m->iterations = 0;
    for (int k = 0; k < m->iterations_max; ++k) {
        SE3DI_TRY(se3di_equations_ask(m->equations));
        SE3DI_TRY(iterate(m, k == 0));
        (void)se3di_newton_note(&m->integration->newton, m->size * m->tolerance);
        const double rate = k == 0 ? 1.0 : m->size / m->past[0]; /* .3, .3, 1, .3, .3, 1 */
        if (has_converged(m, rate)) {
            return SE3D_OK;
        }
        if (k > 3 && rate > 1.0 && m->size > m->past[1]) {
            break;
        }
    }
    return se3di_error_set(m->equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: Newton did not converge in a step of %g s; try a smaller "
                           "step or tolerance",
                           m->t, m->h);
}

se3d_status se3di_radau_solve(se3di_radau *m)
{
    se3di_equations *equations = m->equations;
    se3di_kkt *kkt = m->integration->newton.kkt;
    if (!m->projects) {
        const se3di_kkt_settings before =
            se3di_state_regularise(m->assembly, kkt, SE3DI_STATE_REGULARISATION);
        const se3d_status status = iterate_to_convergence(m);
        se3di_kkt_set_settings(kkt, &before);
        return status;
    }
    const se3di_kkt_settings newton =
        se3di_state_regularise(m->assembly, kkt, SE3DI_RADAU_REGULARISATION);
    const se3di_kkt_settings plain =
        se3di_state_begin(equations, SE3DI_RADAU_REGULARISATION, 1e-13);
    se3di_state_begin_step(equations, 0.0, 0);
    const se3d_status status = iterate_to_convergence(m);
    se3di_state_end(equations, &plain);
    se3di_kkt_set_settings(kkt, &newton);
    return status;
}

/* Positions lack what is projected away, too: it is no error. */
static se3d_status project_defect(se3di_radau *m)
{
    se3di_equations *equations = m->equations;
    const se3di_kkt_settings before =
        se3di_state_begin(equations, SE3DI_RADAU_REGULARISATION, 1e-13);
    const se3d_status status = solve_normal(m, m->sum_q);
    se3di_state_end(equations, &before);
    for (size_t k = 0; k < m->assembly->unknown_count; ++k) {
        m->sum_q[k] -= equations->x[k];
    }
    return status;
}

/* d from what the filter has left of gamma d: velocities in equations->x, positions in m->sum_q. */
static void set_filtered(const se3di_radau *m, double *d)
{
    const double by = 1.0 / se3di_radau_gamma;
    for (size_t k = 0; k < m->assembly->body_count; ++k) {
        const double *q = m->sum_q + 6 * k, *v = m->equations->x + 6 * k;
        double *out = d + k * SE3DI_STATE_SIZE;
        se3di_scale(by, q, out);
        se3di_quat_rate(m->y0 + k * SE3DI_STATE_SIZE + 3, q + 3, out + 3);
        for (size_t j = 3; j < 7; ++j) {
            out[j] *= by;
        }
        for (size_t j = 0; j < 6; ++j) {
            out[7 + j] = by * v[j];
        }
    }
}

se3d_status se3di_radau_filter(se3di_radau *m, double *d, double *error)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const size_t n = assembly->unknown_count;
    const double gamma = se3di_radau_gamma;
    const double c = gamma * m->h;
    double whole = 0.0; /* without the filter */
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const double *raw = d + k * SE3DI_STATE_SIZE;
        const double *p0 = m->y0 + k * SE3DI_STATE_SIZE + 3;
        double *q = m->sum_q + 6 * k;
        se3di_copy(raw, q);
        se3di_quat_angular_velocity(p0, raw + 3, q + 3);
        for (size_t j = 0; j < 6; ++j) {
            q[j] *= gamma;
            m->sum[6 * k + j] = -gamma * raw[7 + j];
        }
        whole = fmax(whole, measure(m, k, q, m->sum + 6 * k));
    }
    copy(assembly->C, m->C1, assembly->joint_value_count);
    if (m->projects) {
        SE3DI_TRY(project_defect(m));
    }
    memset(equations->b, 0, n * sizeof *equations->b);
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    se3di_assembly_subtract_mass(assembly, m->sum, equations->b);
    se3di_tangent_add_stiffness(&m->integration->newton.tangent, -c, m->sum_q, equations->b);
    SE3DI_TRY(se3di_newton_solve(&m->integration->newton));
    *error = 0.0;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        double *q = m->sum_q + 6 * k;
        const double *v = equations->x + 6 * k;
        for (size_t j = 0; j < 6; ++j) {
            q[j] += c * v[j];
        }
        const double part = measure(m, k, q, v);
        *error = se3di_larger(*error, part);
    }
    m->is_stiff = whole > STIFF * *error;
    if (m->is_stiff) {
        set_filtered(m, d);
    }
    return SE3D_OK;
}

se3d_status se3di_radau_close(se3di_radau *m)
{
    se3di_equations *equations = m->equations;
    se3di_assembly *assembly = m->assembly;
    const size_t n = assembly->unknown_count;
    double *shift = at(m->shift, STAGES - 1, n);
    SE3DI_TRY(se3di_assembly_eval_functions(assembly, m->t + m->h, equations->error));
    for (int round = 0; round < CLOSINGS && assembly->row_count > 0; ++round) {
        se3di_state_set(assembly, at(m->Y, STAGES - 1, m->count));
        se3di_assembly_eval_phi(assembly, equations->c);
        for (size_t k = 0; k < assembly->row_count; ++k) {
            equations->c[k] *= -1.0;
        }
        memset(equations->b, 0, n * sizeof *equations->b);
        copy(assembly->C, m->C1, assembly->joint_value_count);
        SE3DI_TRY(se3di_newton_solve(&m->integration->newton));
        for (size_t k = 0; k < n; ++k) {
            shift[k] += equations->x[k];
        }
        update_positions(m);
    }
    return SE3D_OK;
}
