/* SPDX-License-Identifier: BSD-3-Clause */
/* Positions: min |dq|_M with Phi(q, t) = 0, by Newton with line search; where that stalls (far from
 * a solution, or where there is none) by damped Gauss-Newton (Levenberg-Marquardt: the KKT system
 * with a large regularisation), which ends in the least violation. A stationary violation means
 * that the constraints cannot be met from here: the gap is named.  docs/theory/consistency.md */
#include "nonlinear/equations.h"

#include "math/vec3.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DAMPED_ITERATIONS 200

typedef struct position_problem {
    se3di_equations *equations;
    double size;    /* of the mechanism [m] */
    double merit;   /* sum of squared scaled violations */
    double worst;   /* largest scaled violation */
    uint32_t where; /* its row */
} position_problem;

static double model_size(const se3di_model *model)
{
    double size = 1e-6;
    for (size_t k = 0; k < model->row_count; ++k) {
        for (uint32_t t = 0; t < model->rows[k].term_count; ++t) {
            const se3di_term *term = &model->terms[model->rows[k].term_begin + t];
            size = fmax(size, fmax(se3di_norm(term->s_i), se3di_norm(term->s_j)));
        }
    }
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        size = fmax(size, fmin(1e3 * size, se3di_norm(model->frames[k].r)));
    }
    return size;
}

/* What a violation of a row is measured by: 1 for angles and cosines, lengths, squared lengths. */
static double row_scale(const position_problem *problem, uint32_t row)
{
    const se3di_model *model = problem->equations->assembly.model;
    const se3di_term *term = &model->terms[model->rows[row].term_begin];
    switch (term->type) {
    case SE3DI_PRIMITIVE_D:
        return problem->size * problem->size;
    case SE3DI_PRIMITIVE_DP2:
    case SE3DI_PRIMITIVE_CD:
        return problem->size;
    default:
        return 1.0;
    }
}

static void measure(position_problem *problem)
{
    se3di_equations *equations = problem->equations;
    const se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_eval_phi(assembly, equations->phi);
    problem->merit = 0.0;
    problem->worst = 0.0;
    problem->where = 0;
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        double scaled = fabs(equations->phi[k]) / row_scale(problem, k);
        problem->merit += scaled * scaled;
        if (!(scaled <= problem->worst)) {
            problem->worst = scaled;
            problem->where = k;
        }
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        double gap =
            assembly->formulation->normalisation(&assembly->model->frames[assembly->free_body[k]]);
        problem->merit += gap * gap;
        problem->worst = fmax(problem->worst, fabs(gap));
    }
}

/* Newton or damped step into x; its largest turn or relative shift is returned in *length. */
static se3d_status compute_step(position_problem *problem, double *length)
{
    se3di_equations *equations = problem->equations;
    const se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    SE3DI_TRY(se3di_equations_factor(equations));
    memset(equations->b, 0, assembly->unknown_count * sizeof *equations->b);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        if (n == 8) {
            equations->b[k * n + 7] = assembly->formulation->normalisation(
                &assembly->model->frames[assembly->free_body[k]]);
        }
    }
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = -equations->phi[k];
    }
    SE3DI_TRY(se3di_equations_solve(equations));
    ++equations->counters.iterations;
    *length = 0.0;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        size_t part = k % n;
        double weight = part < 3 ? 1.0 / problem->size : n == 8 ? 2.0 : 1.0;
        *length = part < 7 ? fmax(*length, weight * fabs(equations->x[k])) : *length;
    }
    return SE3D_OK;
}

static void move(const position_problem *problem, double fraction)
{
    se3di_equations *equations = problem->equations;
    const se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    double dq[SE3DI_BLOCK_MAX];
    se3di_equations_restore(equations);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        for (size_t c = 0; c < n; ++c) {
            dq[c] = fraction * equations->x[k * n + c];
        }
        assembly->formulation->move(&assembly->model->frames[assembly->free_body[k]], dq);
    }
}

/* Take the step, shortened until the violation falls. Returns 0 where it does not. */
static int search_line(position_problem *problem, double length)
{
    double merit = problem->merit;
    double fraction = length > 1.0 ? 1.0 / length : 1.0;
    se3di_equations_save(problem->equations);
    for (int halvings = 0; halvings < 12; ++halvings, fraction *= 0.5) {
        move(problem, fraction);
        measure(problem);
        if (problem->merit <= (1.0 - 1e-4 * fraction) * merit) {
            return 1;
        }
    }
    se3di_equations_restore(problem->equations);
    measure(problem);
    return 0;
}

/* Newton until rounding. Returns with *converged = 0 where it stalls. */
static se3d_status run_newton(position_problem *problem, int *converged)
{
    se3di_equations *equations = problem->equations;
    *converged = 0;
    for (int32_t k = 0; k <= equations->iterations_max; ++k) {
        double length;
        if (problem->worst <= 1e-15) {
            *converged = 1;
            return SE3D_OK;
        }
        SE3DI_TRY(compute_step(problem, &length));
        int fell = search_line(problem, length);
        if (!isfinite(problem->worst)) {
            return se3di_error_set(equations->error, SE3D_ERR_NOT_FINITE,
                                   "t = %g s: a constraint is not finite",
                                   equations->assembly.model->time);
        }
        if ((length < 1e-7 || !fell) && problem->worst < 1e-11) {
            *converged = 1;
            return SE3D_OK;
        }
        if (!fell) {
            return SE3D_OK;
        }
    }
    return SE3D_OK;
}

/* Damped steps: the regularised system without refinement. Ends at a solution or at the least
 * violation. */
static se3d_status run_damped(position_problem *problem, int *stationary)
{
    se3di_equations *equations = problem->equations;
    se3di_kkt_settings exact = se3di_kkt_get_settings(equations->kkt);
    se3di_kkt_settings damped = exact;
    se3d_status status = SE3D_OK;
    damped.max_refinements = 0;
    damped.regularise = SE3DI_KKT_REGULARISE_FIRST;
    double damping = 1e-2;
    double length = 1.0;
    *stationary = 0;
    for (int k = 0; k < DAMPED_ITERATIONS && problem->worst > 1e-4 && !*stationary; ++k) {
        double before = problem->merit;
        damped.eps = damping;
        damped.eps_min = damping;
        se3di_kkt_set_settings(equations->kkt, &damped);
        status = compute_step(problem, &length);
        if (status < 0) {
            break;
        }
        int fell = search_line(problem, length);
        damping = fell ? fmax(damping * 0.3, 1e-6) : damping * 10.0;
        *stationary = (fell && before - problem->merit < 1e-9 * before) || damping > 1e6;
    }
    se3di_kkt_set_settings(equations->kkt, &exact);
    return status;
}

/* Lengths by which the constraint of a row is open, or its largest angle. */
static void describe_gap(const position_problem *problem, char *text, size_t size)
{
    const se3di_equations *equations = problem->equations;
    const se3di_model *model = equations->assembly.model;
    char name[128];
    se3di_row_name(model, problem->where, name, sizeof name);
    const se3di_row *row = &model->rows[problem->where];
    const se3di_term *term = &model->terms[row->term_begin];
    double phi = equations->phi[problem->where];
    double sum = 0.0;
    uint32_t owner = 0;
    while (problem->where >=
           model->constraints[owner].row_begin + model->constraints[owner].row_count) {
        ++owner;
    }
    switch (term->type) {
    case SE3DI_PRIMITIVE_D: {
        double f = equations->assembly.f[3 * problem->where];
        snprintf(text, size, "%s is open by %.6g m", name, sqrt(fmax(phi + f, 0.0)) - sqrt(f));
        break;
    }
    case SE3DI_PRIMITIVE_CD:
    case SE3DI_PRIMITIVE_DP2:
        for (uint32_t k = 0; k < model->constraints[owner].row_count; ++k) {
            uint32_t r = model->constraints[owner].row_begin + k;
            int32_t type = model->terms[model->rows[r].term_begin].type;
            if (type == SE3DI_PRIMITIVE_CD || type == SE3DI_PRIMITIVE_DP2) {
                sum += equations->phi[r] * equations->phi[r];
            }
        }
        snprintf(text, size, "%s is open by %.6g m (equation %s)",
                 model->constraints[owner].name ? model->constraints[owner].name
                                                : model->constraints[owner].type,
                 sqrt(sum), name);
        break;
    default:
        snprintf(text, size, "%s is off by %.6g", name, phi);
        break;
    }
}

static se3d_status report_gap(const position_problem *problem, double t, int stationary)
{
    char gap[320];
    describe_gap(problem, gap, sizeof gap);
    if (stationary) {
        return se3di_error_set(
            problem->equations->error, SE3D_ERR_INCONSISTENT,
            "t = %g s: the constraints cannot be met: %s at the least violation; "
            "the mechanism is locked, over-constrained, or its parts do not reach",
            t, gap);
    }
    return se3di_error_set(
        problem->equations->error, SE3D_ERR_NO_CONVERGENCE,
        "t = %g s: the positions did not converge: %s; the initial poses are too "
        "far from an assembled one, or the step is too large",
        t, gap);
}

se3d_status se3di_position_solve(se3di_equations *equations, double t)
{
    position_problem problem = {.equations = equations};
    int converged;
    int stationary = 0;
    problem.size = model_size(equations->assembly.model);
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    measure(&problem);
    SE3DI_TRY(run_newton(&problem, &converged));
    for (int round = 0; round < 3 && !converged && !stationary; ++round) {
        SE3DI_TRY(run_damped(&problem, &stationary));
        if (problem.worst < 1e-2) {
            SE3DI_TRY(run_newton(&problem, &converged));
        }
    }
    for (uint32_t k = 0; k < equations->assembly.dense_count; ++k) {
        se3di_frame *frame = &equations->assembly.model->frames[k];
        if (equations->assembly.free_index[k] >= 0) {
            se3di_frame_update(frame);
        }
    }
    return converged ? SE3D_OK : report_gap(&problem, t, stationary);
}
