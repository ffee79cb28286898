/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/newmark.h"
#include "math/quaternion.h"

#include "contact/loads.h"
#include "contact/pace.h"
#include "integrator/state.h"
#include "math/elementary.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define PLAIN_ITERATIONS 5  /* with the mass matrix alone */
#define REVISIONS_MAX    30 /* of elements with a memory, per step */

/* memcpy where count may be zero and the pointers NULL. */
static void copy(double *to, const double *from, size_t count)
{
    if (count > 0) {
        memcpy(to, from, count * sizeof *to);
    }
}

/* History: a_n [n], vdot_n [n], the step they belong to, whether rows are redundant, the next step
 * of step control (0: none yet). */
size_t se3di_newmark_history_count(const se3di_assembly *assembly)
{
    return 2 * (size_t)assembly->unknown_count + 3;
}

/* Work: v_n, vdot, a, x [n]; lambda [rows]. */
size_t se3di_newmark_work_count(const se3di_assembly *assembly)
{
    return 4 * (size_t)assembly->unknown_count + assembly->row_count;
}

typedef struct newmark_step {
    const se3di_newmark *method;
    se3di_integration *integration;
    se3di_equations *equations;
    double h, t;
    const double *a_n, *vdot_n;  /* history [n] */
    double *v_n, *vdot, *a;      /* [n] */
    double *x;                   /* [n] displacement of the step */
    double *lambda;              /* [rows] */
    double beta_prime;           /* d vdot / d x: (1 - alpha_m) / (h^2 beta (1 - alpha_f)) */
    double gamma_prime;          /* d v / d vdot: h gamma (1 - alpha_f) / (1 - alpha_m) */
    double correction, previous; /* size of the last two Newton corrections of vdot */
    int exact;                   /* the Newton matrix has stiffness, damping and curvature */
} newmark_step;

/* The third derivative of the motion at the start, from accelerations at h/2 and h along the
 * parabola; zero where they cannot be evaluated. */
static void estimate_jerk(se3di_integration *integration, double h, const double *vdot,
                          double *jerk)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    uint32_t n = assembly->unknown_count;
    size_t block = (size_t)assembly->formulation->block;
    double *v_n = integration->work;
    double *v = integration->work + n;
    double *dq = integration->work + 2 * (size_t)n;
    double t = assembly->model->time;
    const double weight[2] = {4.0, -1.0};
    se3di_error ignored = {0};
    se3di_error *error = equations->error;
    equations->error = &ignored;
    se3di_assembly_get_velocity(assembly, v_n);
    se3di_equations_save(equations);
    for (uint32_t k = 0; k < n; ++k) {
        jerk[k] = -3.0 * vdot[k] / h;
    }
    for (int stage = 0; stage < 2; ++stage) {
        double s = 0.5 * h * (stage + 1);
        se3di_equations_restore(equations);
        for (uint32_t k = 0; k < n; ++k) {
            dq[k] = s * v_n[k] + 0.5 * s * s * vdot[k];
            v[k] = v_n[k] + s * vdot[k];
        }
        for (uint32_t k = 0; k < assembly->body_count; ++k) {
            assembly->formulation->move(&assembly->model->frames[assembly->free_body[k]],
                                        dq + k * block);
        }
        se3di_assembly_set_velocity(assembly, v);
        if (se3di_acceleration_solve(equations, t + s) < 0) {
            memset(jerk, 0, n * sizeof *jerk);
            break;
        }
        for (uint32_t k = 0; k < n; ++k) {
            jerk[k] += weight[stage] * equations->x[k] / h;
        }
    }
    se3di_equations_restore(equations);
    equations->error = error;
}

se3d_status se3di_newmark_start(se3di_integration *integration, const se3di_newmark *method,
                                double h)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    uint32_t n = assembly->unknown_count;
    double *a = assembly->model->history;
    double *vdot = a + n;
    SE3DI_TRY(se3di_acceleration_solve(equations, assembly->model->time));
    copy(vdot, equations->x, n);
    copy(integration->work + 3 * (size_t)n, equations->l, assembly->row_count);
    estimate_jerk(integration, h, vdot, a);
    for (uint32_t k = 0; k < n; ++k) {
        a[k] = vdot[k] + (method->alpha_m - method->alpha_f) * h * a[k];
    }
    vdot[n] = h;
    vdot[n + 1] = equations->redundant ? 1.0 : 0.0;
    copy(assembly->model->lambda, integration->work + 3 * (size_t)n, assembly->row_count);
    se3di_assembly_set_acceleration(assembly, vdot);
    return SE3D_OK;
}

/* Accelerations have jumped, and the algorithmic ones, which lag behind them by the same as before,
 * with them. */
se3d_status se3di_newmark_renew(se3di_integration *integration)
{
    se3di_equations *equations = integration->equations;
    const se3di_assembly *assembly = &equations->assembly;
    double *a = assembly->model->history;
    double *vdot = a + assembly->unknown_count;
    const size_t block = (size_t)assembly->formulation->block;
    se3di_assembly_get_acceleration(assembly, equations->x);
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        const double jump = k % block == 7 ? 0.0 : equations->x[k] - vdot[k];
        a[k] += jump;
        vdot[k] += jump;
    }
    return SE3D_OK;
}

/* q, v, a from the present vdot. */
static void update_state(newmark_step *step)
{
    const se3di_newmark *m = step->method;
    se3di_equations *equations = step->equations;
    se3di_assembly *assembly = &equations->assembly;
    size_t block = (size_t)assembly->formulation->block;
    double h = step->h;
    double *x = step->x;
    se3di_equations_restore(equations);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        step->a[k] = ((1.0 - m->alpha_f) * step->vdot[k] + m->alpha_f * step->vdot_n[k] -
                      m->alpha_m * step->a_n[k]) /
                     (1.0 - m->alpha_m);
        x[k] = h * step->v_n[k] + h * h * ((0.5 - m->beta) * step->a_n[k] + m->beta * step->a[k]);
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        assembly->formulation->move(&assembly->model->frames[assembly->free_body[k]],
                                    x + k * block);
    }
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        equations->x[k] =
            step->v_n[k] + h * ((1.0 - m->gamma) * step->a_n[k] + m->gamma * step->a[k]);
    }
    se3di_assembly_set_velocity(assembly, equations->x);
}

/* b = Q + velocity terms - M vdot - Phi_q^T lambda, c = -beta' Phi, with M and Phi_q at the present
 * state. */
static se3d_status eval_residual(newmark_step *step)
{
    se3di_equations *equations = step->equations;
    se3di_assembly *assembly = &equations->assembly;
    size_t n = (size_t)assembly->formulation->block;
    se3di_assembly_eval_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, step->t, equations->b, equations->error));
    se3di_assembly_add_transposed(assembly, -1.0, step->lambda, equations->b);
    se3di_assembly_subtract_mass(assembly, step->vdot, equations->b);
    for (size_t k = 0; n == 8 && k < assembly->body_count; ++k) {
        equations->b[8 * k + 7] =
            step->beta_prime *
            assembly->formulation->normalisation(&assembly->model->frames[assembly->free_body[k]]);
    }
    se3di_assembly_eval_phi(assembly, equations->c);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] *= -step->beta_prime;
    }
    return SE3D_OK;
}

static se3d_status factor(newmark_step *step)
{
    se3di_equations *equations = step->equations;
    if (step->exact) {
        const se3di_newton_weights weights = {.velocity = step->gamma_prime,
                                              .position = 1.0 / step->beta_prime};
        return se3di_newton_factor(&step->integration->newton, step->t, step->vdot, step->lambda,
                                   step->x, &weights);
    }
    se3di_kkt_values values = {.body = equations->assembly.H, .joint = equations->assembly.C};
    ++equations->counters.factorizations;
    se3d_status status = se3di_kkt_factor(equations->kkt, &values, NULL);
    return status < 0
               ? se3di_error_set(equations->error, status,
                                 "t = %g s: the Newton matrix is singular or not finite", step->t)
               : SE3D_OK;
}

static se3d_status fail_not_finite(const newmark_step *step)
{
    return se3di_error_set(step->equations->error, SE3D_ERR_NOT_FINITE,
                           "t = %g s: the state is not finite, the step is too large", step->t);
}

/* One Newton correction of vdot and lambda. */
static se3d_status iterate(newmark_step *step, int refactor)
{
    se3di_equations *equations = step->equations;
    const se3di_assembly *assembly = &equations->assembly;
    size_t block = (size_t)assembly->formulation->block;
    SE3DI_TRY(eval_residual(step));
    if (refactor) {
        SE3DI_TRY(factor(step));
    }
    SE3DI_TRY(step->exact ? se3di_newton_solve(&step->integration->newton)
                          : se3di_equations_solve(equations));
    ++equations->counters.iterations;
    step->previous = step->correction;
    step->correction = 0.0;
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        step->vdot[k] += equations->x[k];
        if (k % block != 7) {
            step->correction = fmax(step->correction, fabs(equations->x[k]));
        }
    }
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        step->lambda[k] += equations->l[k];
    }
    update_state(step);
    return isfinite(step->correction) ? SE3D_OK : fail_not_finite(step);
}

/* Corrections are looked at by fmax, which passes over what is not a number; and the state may
 * overflow where they do not. */
static se3d_status check_state(const newmark_step *step)
{
    const se3di_model *model = step->equations->assembly.model;
    int finite = 1;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_frame *frame = &model->frames[k];
        for (int i = 0; i < 3; ++i) {
            finite = finite && isfinite(frame->r[i]) && isfinite(frame->v[i]) &&
                     isfinite(frame->p[i]) && isfinite(frame->w[i]);
        }
    }
    return finite ? SE3D_OK : fail_not_finite(step);
}

/* Corrections of vdot below their own rounding (that of positions, times beta') or below 1e-10 of
 * it. */
static int has_converged(const newmark_step *step)
{
    double scale = 0.0;
    size_t block = (size_t)step->equations->assembly.formulation->block;
    for (uint32_t k = 0; k < step->equations->assembly.unknown_count; ++k) {
        scale = k % block == 7 ? scale : fmax(scale, fabs(step->vdot[k]));
    }
    double shift = step->correction / step->beta_prime;
    return step->correction <= 1e-11 * (1.0 + scale) || shift <= 1e-15 ||
           (shift <= 1e-11 && step->correction > 0.3 * step->previous);
}

/* Newton with the mass matrix alone where there are no force elements; with the exact matrix where
 * there are, or where the other one does not do. */
static se3d_status iterate_to_convergence(newmark_step *step)
{
    int32_t limit = step->integration->settings.iterations_max;
    int refactor = 1;
    if (step->equations->redundant) { /* else rounding adds up in the dependent directions */
        memset(step->lambda, 0, step->equations->assembly.row_count * sizeof *step->lambda);
    }
    for (int32_t k = 0; k < limit; ++k) {
        SE3DI_TRY(se3di_equations_ask(step->equations));
        SE3DI_TRY(iterate(step, refactor));
        const int is_traced = se3di_newton_note(&step->integration->newton, step->correction);
        if (has_converged(step)) {
            return check_state(step);
        }
        refactor = is_traced || step->equations->redundant ||
                   (k > 0 && step->correction > (step->exact ? 0.05 : 0.25) * step->previous);
        if (k == PLAIN_ITERATIONS && !step->exact) {
            step->exact = refactor = 1;
        }
    }
    return se3di_error_set(step->equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: Newton did not converge in %d iterations of a step of %g s; "
                           "try a smaller step",
                           step->t, (int)limit, step->h);
}

/* Elements with a memory may have assumed wrong what comes out: again until none has. */
static se3d_status iterate_with_memory(newmark_step *step)
{
    se3di_model *model = step->equations->assembly.model;
    for (int round = 0; round < REVISIONS_MAX; ++round) {
        SE3DI_TRY(iterate_to_convergence(step));
        copy(model->lambda, step->lambda, step->equations->assembly.row_count);
        if (se3di_forces_revise(model) == 0) {
            return SE3D_OK;
        }
    }
    return SE3D_OK; /* the last one stands */
}

/* The rounding of beta' Phi contradicts itself in dependent rows: a smaller regularisation, which
 * tells nearly dependent rows from dependent ones, would only amplify it. */
static se3d_status solve_step(newmark_step *step)
{
    se3di_kkt *kkt = step->exact ? step->integration->newton.kkt : step->equations->kkt;
    se3di_kkt_settings settings = se3di_kkt_get_settings(kkt);
    double eps_min = settings.eps_min;
    if (step->equations->redundant) {
        settings.eps_min = settings.eps;
        se3di_kkt_set_settings(kkt, &settings);
    }
    se3d_status status = iterate_with_memory(step);
    settings.eps_min = eps_min;
    se3di_kkt_set_settings(kkt, &settings);
    return status;
}

static void accept(newmark_step *step)
{
    se3di_assembly *assembly = &step->equations->assembly;
    se3di_model *model = assembly->model;
    uint32_t n = assembly->unknown_count;
    copy(model->history, step->a, n);
    copy(model->history + n, step->vdot, n);
    model->history[2 * (size_t)n] = step->h;
    copy(model->lambda, step->lambda, assembly->row_count);
    se3di_assembly_set_acceleration(assembly, step->vdot);
    model->time = step->t;
    for (uint32_t k = 0; k < assembly->body_count; ++k) { /* r-p: else pdot along p builds up */
        se3di_frame *frame = &model->frames[assembly->free_body[k]];
        se3di_quat_rate(frame->p, frame->w, frame->pdot);
    }
    se3di_angles_accept(model);
    se3di_loads_accept(model);
    ++step->equations->counters.steps;
}

/* a_n belongs to t_n + (alpha_m - alpha_f) h_old: move it to the new step's place. */
static void rescale_history(double *history, uint32_t n, double h)
{
    double ratio = h / history[2 * (size_t)n];
    if (fabs(ratio - 1.0) > 1e-9) {
        for (uint32_t k = 0; k < n; ++k) {
            history[k] = history[n + k] + ratio * (history[k] - history[n + k]);
        }
    }
    history[2 * (size_t)n] = h;
}

/* The local error of positions, relative to the tolerance. */
static double estimate_error(const newmark_step *step)
{
    const se3di_assembly *assembly = &step->equations->assembly;
    size_t block = (size_t)assembly->formulation->block;
    double length = se3di_state_length(assembly->model);
    double factor = step->h * step->h * (fabs(step->method->beta - 1.0 / 6.0) + 1.0 / 24.0);
    double worst = 0.0;
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        size_t part = k % block;
        double size = fabs(step->vdot[k] - step->vdot_n[k]);
        size *= part < 3 ? 1.0 / length : block == 8 ? 2.0 : 1.0;
        worst = part == 7 || size <= worst ? worst : size;
    }
    return factor * worst / step->method->tolerance;
}

se3d_status se3di_newmark_step(se3di_integration *integration, const se3di_newmark *method,
                               double h)
{
    se3di_equations *equations = integration->equations;
    se3di_assembly *assembly = &equations->assembly;
    uint32_t n = assembly->unknown_count;
    double *work = integration->work;
    rescale_history(assembly->model->history, n, h);
    equations->redundant = assembly->model->history[2 * (size_t)n + 1] > 0.0;
    newmark_step step = {
        .method = method,
        .integration = integration,
        .equations = equations,
        .h = h,
        .t = assembly->model->time + h,
        .a_n = assembly->model->history,
        .vdot_n = assembly->model->history + n,
        .v_n = work,
        .vdot = work + n,
        .a = work + 2 * (size_t)n,
        .x = work + 3 * (size_t)n,
        .lambda = work + 4 * (size_t)n,
        .gamma_prime = h * method->gamma * (1.0 - method->alpha_f) / (1.0 - method->alpha_m),
        .exact = se3di_loads_are_stiff(assembly->model),
        .beta_prime = (1.0 - method->alpha_m) / (h * h * method->beta * (1.0 - method->alpha_f)),
    };
    se3di_assembly_get_velocity(assembly, step.v_n);
    memcpy(step.vdot, step.vdot_n, n * sizeof *step.vdot);
    copy(step.lambda, assembly->model->lambda, assembly->row_count);
    se3di_contacts_begin(assembly->model, h, step.gamma_prime / h, 0);
    se3di_equations_save(equations);
    se3di_model_save_memory(assembly->model, integration->newton.memory);
    se3d_status status = se3di_assembly_eval_functions(assembly, step.t, equations->error);
    if (status >= 0) {
        update_state(&step);
        status = solve_step(&step);
    }
    integration->error = HUGE_VAL;
    if (status >= 0 && method->tolerance > 0.0) {
        integration->error = estimate_error(&step);
        status = integration->error <= 1.0 ? SE3D_OK : SE3D_ERR_STEP_SIZE;
    }
    if (status >= 0) {
        status = se3di_loads_prepare(assembly->model, step.t, equations->error);
        integration->error = status < 0 ? HUGE_VAL : integration->error;
    }
    if (status < 0) {
        se3di_equations_restore(equations);
        se3di_model_restore_memory(assembly->model, integration->newton.memory);
        return status;
    }
    accept(&step);
    if (se3di_contacts_changed(assembly->model)) { /* accelerations have jumped */
        SE3DI_TRY(se3di_newmark_start(integration, method, h));
    }
    return se3di_work_accept(assembly->model, h);
}

/* From the error of a step; a rejected one is at least halved. */
static double next_step(double h, double error)
{
    double factor = isfinite(error) ? 0.85 / se3di_cbrt(fmax(error, 1e-6)) : 0.25;
    return h * (error <= 1.0 ? fmin(2.0, factor) : fmin(0.5, fmax(0.1, factor)));
}

se3d_status se3di_newmark_run(se3di_integration *integration, const se3di_newmark *method,
                              double t_end)
{
    se3di_equations *equations = integration->equations;
    se3di_model *model = equations->assembly.model;
    double *next = model->history + 2 * (size_t)equations->assembly.unknown_count + 2;
    *next = *next > 0.0 ? *next : 1e-4;
    while (model->time < t_end) {
        double t = model->time;
        double remaining = t_end - t;
        double h = *next < remaining ? fmin(*next, 0.5 * remaining) : remaining;
        h = se3di_contacts_pace(model, SE3DI_PACE_ADAPTIVE, h);
        double smallest = 1e-12 * fmax(1e-3, fabs(t));
        SE3DI_TRY(se3di_equations_try_step(equations, t));
        SE3DI_TRY(se3di_watch_begin(equations));
        se3d_status status = se3di_newmark_step(integration, method, h);
        if (status >= 0) {
            double wanted = next_step(h, integration->error);
            *next = h < *next ? fmax(*next, wanted) : wanted; /* shortened only for t_end */
            model->time = h < remaining ? model->time : t_end;
            status = se3di_watch_end(equations);
            if (status != SE3D_OK) {
                return status;
            }
            continue;
        }
        if (status == SE3D_ERR_INTERRUPTED) {
            return status;
        }
        ++equations->counters.rejected;
        *next = next_step(h, integration->error);
        if (!(*next > smallest)) {
            return status == SE3D_ERR_STEP_SIZE && isfinite(integration->error)
                       ? se3di_error_set(equations->error, status,
                                         "t = %g s: the step fell to %.3g s: the tolerance %g "
                                         "cannot be met here; the motion is not smooth",
                                         t, *next, integration->settings.tolerance)
                       : status;
        }
    }
    return SE3D_OK;
}
