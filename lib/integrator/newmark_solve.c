/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of a step of the Newmark family and their Newton iteration. */
#include "integrator/newmark.h"

#include "assembly/loads.h"
#include "contact/bodies/pace.h"
#include "force/friction.h"
#include "integrator/state.h"
#include "math/larger.h"
#include "math/quaternion.h"
#include "model/state.h"

#include <math.h>
#include <string.h>

#define PLAIN_ITERATIONS 6     /* with the mass matrix alone */
#define GOES_ASTRAY      30.0  /* a correction over the one before */
#define REVISIONS_MAX    30    /* of elements with a memory, per step */
#define GAP_ROUNDING     1e-14 /* relative violation of positions that is left as it is */
#define GAP_CLOSES       1e-8  /* one correction makes such a gap rounding */
#define GAP_ROUNDS       3     /* corrections of positions in an iteration, */
#define GAP_PART         1e-3  /* until so much of the gap is left */

/* The frame of a free body moved by dq, on the group. */
static void move(se3di_frame *frame, const double *dq)
{
    for (int k = 0; k < 3; ++k) {
        frame->r[k] += dq[k];
    }
    se3di_quat_rotate(frame->p, dq + 3, frame->p);
    (void)se3di_quat_normalize(frame->p, frame->p);
}

/* q, v, a from the present vdot and z. */
static void update_state(se3di_newmark_step *step)
{
    se3di_assembly *assembly = step->assembly;
    const double h = step->h, by = 1.0 / (1.0 - step->alpha_m);
    double *v = step->equations->x;
    se3di_equations_restore(step->equations);
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        step->a[k] = by * ((1.0 - step->alpha_f) * step->vdot[k] + step->alpha_f * step->vdot_n[k] -
                           step->alpha_m * step->a_n[k]);
        step->x[k] =
            h * (step->v_n[k] + h * ((0.5 - step->beta) * step->a_n[k] + step->beta * step->a[k]));
        v[k] = step->v_n[k] + h * ((1.0 - step->gamma) * step->a_n[k] + step->gamma * step->a[k]);
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        move(frame, step->x + 6 * (size_t)k);
        move(frame, step->z + 6 * (size_t)k);
        se3di_frame_update(frame);
    }
    se3di_assembly_set_velocity(assembly, v);
}

/* b = Q + velocity terms - M vdot - Phi_q^T lambda, c = (nu - Phi_q v) / velocity, and
 * equations->phi = Phi. */
static se3d_status eval_residual(se3di_newmark_step *step)
{
    se3di_equations *equations = step->equations;
    se3di_assembly *assembly = step->assembly;
    se3di_assembly_follow_mass(assembly);
    se3di_assembly_eval_jacobian(assembly);
    se3di_frictions_take_loads(assembly->model, step->lambda);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, step->t, equations->b, equations->error));
    se3di_assembly_add_transposed(assembly, -1.0, step->lambda, equations->b);
    se3di_assembly_subtract_mass(assembly, step->vdot, equations->b);
    se3di_assembly_get_velocity(assembly, equations->x);
    se3di_assembly_mul(assembly, equations->x, equations->c);
    se3di_assembly_eval_phi(assembly, equations->phi);
    step->gap = 0.0;
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        const double gap =
            fabs(equations->phi[k]) / se3di_row_get_scale(assembly->model, k, step->length);
        step->gap = se3di_larger(step->gap, gap);
        equations->c[k] = (assembly->f[3 * (size_t)k + 1] - equations->c[k]) / step->velocity;
    }
    return SE3D_OK;
}

se3d_status se3di_newmark_factor(se3di_newmark_step *step)
{
    se3di_equations *equations = step->equations;
    if (step->exact) {
        const se3di_newton_weights weights = {.velocity = step->velocity,
                                              .position = step->position};
        return se3di_newton_factor_velocities(&step->integration->newton, step->t, step->vdot,
                                              step->lambda, step->x, &weights);
    }
    const se3di_kkt_values values = se3di_equations_values(equations);
    ++equations->counters.factorizations;
    const se3d_status status = se3di_kkt_factor(equations->kkt, &values, NULL);
    return status < 0
               ? se3di_error_set(equations->error, status,
                                 "t = %g s: the Newton matrix is singular or not finite", step->t)
               : SE3D_OK;
}

static se3d_status fail_not_finite(const se3di_newmark_step *step)
{
    return se3di_error_set(step->equations->error, SE3D_ERR_NOT_FINITE,
                           "t = %g s: the state is not finite, the step is too large", step->t);
}

static double largest(const double *values, uint32_t count)
{
    double most = 0.0;
    for (uint32_t k = 0; k < count; ++k) {
        most = fmax(most, fabs(values[k]));
    }
    return most;
}

/* The largest of accelerations. States have no part in it, or, if they `count`, as much as their
 * change in the step is of their size, times `unit`. */
static double largest_acceleration(const se3di_newmark_step *step, const double *values,
                                   double unit)
{
    const se3di_assembly *assembly = step->assembly;
    double most = 0.0;
    if (assembly->model->state_count == 0) {
        return largest(values, assembly->unknown_count);
    }
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        const uint32_t body = assembly->free_body[k / 6];
        const int is_state = assembly->model->bodies[body].state != 0;
        const double part =
            is_state ? step->h * unit / se3di_state_size(assembly->model, body) : 1.0;
        most = fmax(most, part * fabs(values[k]));
    }
    return most;
}

static void add(double *to, const double *what, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        to[k] += what[k];
    }
}

/* vdot and lambda corrected by the solution. */
static void take_solution(se3di_newmark_step *step)
{
    const se3di_equations *equations = step->equations;
    const uint32_t n = step->assembly->unknown_count;
    add(step->vdot, equations->x, n);
    add(step->lambda, equations->l, step->assembly->row_count);
    const double unit = 1.0 + largest_acceleration(step, step->vdot, 0.0);
    step->correction =
        se3di_larger(step->correction, largest_acceleration(step, equations->x, unit));
    for (uint32_t k = 0; k < n; ++k) {
        step->is_finite = step->is_finite && isfinite(equations->x[k]);
    }
}

/* Set the right-hand sides for a displacement that closes the gap of positions that there will be
 * once the velocities meet their constraints. */
static void aim_at_gap(se3di_newmark_step *step)
{
    se3di_equations *equations = step->equations;
    memset(equations->b, 0, step->assembly->unknown_count * sizeof *equations->b);
    for (uint32_t k = 0; k < step->assembly->row_count; ++k) {
        equations->c[k] = -equations->phi[k] - step->position * step->c[k];
    }
}

/* The right-hand sides b, c of the step to those of the equations. */
static void aim_at_motion(const se3di_newmark_step *step)
{
    memcpy(step->equations->b, step->b, step->assembly->unknown_count * sizeof *step->b);
    if (step->assembly->row_count > 0) {
        memcpy(step->equations->c, step->c, step->assembly->row_count * sizeof *step->c);
    }
}

/* With the mass matrix alone. */
static se3d_status correct_plainly(se3di_newmark_step *step)
{
    se3di_equations *equations = step->equations;
    if (step->opens) {
        aim_at_gap(step);
        SE3DI_TRY(se3di_equations_solve(equations));
        add(step->z, equations->x, step->assembly->unknown_count);
    }
    aim_at_motion(step);
    SE3DI_TRY(se3di_equations_solve(equations));
    take_solution(step);
    return SE3D_OK;
}

/* dz, with the matrix whose rows are those of velocities, refined if they are very different;
 * and what it changes: of b and c of the step, and of phi. */
static se3d_status close_gap(se3di_newmark_step *step)
{
    se3di_equations *equations = step->equations;
    se3di_newton *newton = &step->integration->newton;
    const se3di_assembly *assembly = step->assembly;
    const uint32_t n = assembly->unknown_count, rows = assembly->row_count;
    aim_at_gap(step);
    const double open = largest(equations->c, rows);
    SE3DI_TRY(se3di_newton_solve_displacement(newton));
    memcpy(step->dz, equations->x, n * sizeof *step->dz);
    se3di_assembly_mul(assembly, step->dz, equations->c);
    se3di_newton_add_gradient(newton, -1.0, step->dz, equations->c);
    for (uint32_t k = 0; k < rows; ++k) {
        equations->c[k] = -equations->phi[k] - step->position * step->c[k] - equations->c[k];
    }
    if (largest(equations->c, rows) > GAP_PART * open) {
        SE3DI_TRY(se3di_newton_solve_displacement(newton));
        add(step->dz, equations->x, n);
    }
    add(step->z, step->dz, n);
    se3di_assembly_mul(assembly, step->dz, equations->c);
    add(equations->phi, equations->c, rows);
    se3di_tangent_add_stiffness(&newton->tangent, -1.0, step->dz, step->b);
    se3di_newton_add_gradient(newton, -1.0 / step->position, step->dz, step->c);
    return SE3D_OK;
}

/* With the exact matrix: positions, and what they change of the rest, as often as that changes them
 * again. */
static se3d_status correct_exactly(se3di_newmark_step *step)
{
    se3di_equations *equations = step->equations;
    se3di_newton *newton = &step->integration->newton;
    const se3di_assembly *assembly = step->assembly;
    const uint32_t n = assembly->unknown_count, rows = assembly->row_count;
    double open = 0.0;
    for (uint32_t k = 0; k < rows; ++k) {
        open = fmax(open, fabs(equations->phi[k]) + step->position * fabs(step->c[k]));
    }
    for (int round = 0; round < GAP_ROUNDS; ++round) {
        if (step->opens) {
            SE3DI_TRY(close_gap(step));
        }
        aim_at_motion(step);
        SE3DI_TRY(se3di_newton_solve_displacement(newton));
        se3di_assembly_mul(assembly, equations->x, equations->c);
        for (uint32_t k = 0; k < rows; ++k) {
            equations->phi[k] += step->position * equations->c[k];
        }
        se3di_newton_turn(newton, equations->x);
        take_solution(step);
        if (!step->opens || largest(equations->phi, rows) <= GAP_PART * open) {
            break;
        }
        memset(step->b, 0, n * sizeof *step->b);
        memset(step->c, 0, rows * sizeof *step->c);
    }
    return SE3D_OK;
}

/* One Newton correction of z, vdot and lambda. */
static se3d_status iterate(se3di_newmark_step *step, int refactor)
{
    se3di_equations *equations = step->equations;
    const se3di_assembly *assembly = step->assembly;
    SE3DI_TRY(eval_residual(step));
    if (refactor) {
        SE3DI_TRY(se3di_newmark_factor(step));
    }
    memcpy(step->b, equations->b, assembly->unknown_count * sizeof *step->b);
    if (assembly->row_count > 0) {
        memcpy(step->c, equations->c, assembly->row_count * sizeof *step->c);
    }
    step->opens = step->gap > GAP_ROUNDING;
    step->previous = step->correction;
    step->correction = 0.0;
    step->is_finite = 1;
    SE3DI_TRY(step->exact ? correct_exactly(step) : correct_plainly(step));
    ++equations->counters.iterations;
    update_state(step);
    return step->is_finite ? SE3D_OK : fail_not_finite(step);
}

/* Corrections are looked at by fmax, which passes over what is not a number; and the state may
 * overflow if they do not. */
static se3d_status check_state(const se3di_newmark_step *step)
{
    const se3di_model *model = step->assembly->model;
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

/* What is missing of vdot, by the last corrections, is below 1e-11 of it; or the corrections are
 * rounding of velocities or positions. */
static int has_converged(const se3di_newmark_step *step)
{
    const double scale = 1.0 + largest_acceleration(step, step->vdot, 0.0);
    const double rate = step->correction / step->previous; /* 0 in the first iteration */
    const double missing = rate < 0.5 ? 2.0 * rate * step->correction : HUGE_VAL;
    const double shift = step->position * step->correction;
    const double change = step->velocity * step->correction;
    if (!(step->gap <= GAP_CLOSES)) {
        return 0;
    }
    return step->correction <= 1e-11 * scale ||
           (step->previous < HUGE_VAL && missing <= 1e-11 * scale) || shift <= 1e-15 ||
           change <= 1e-15 * largest_acceleration(step, step->v_n, 0.0) ||
           (shift <= 1e-11 && rate > 0.3);
}

/* Else rounding adds up in the directions of multipliers of dependent rows. */
static void forget_dependent(se3di_newmark_step *step)
{
    if (step->equations->redundant) {
        memset(step->lambda, 0, step->assembly->row_count * sizeof *step->lambda);
    }
}

void se3di_newmark_predict(se3di_newmark_step *step)
{
    const se3di_newmark_history past = se3di_newmark_get_history(step->assembly);
    const double last = past.header->last;
    const double ratio = last > 0.0 ? step->h / last : 0.0;
    for (uint32_t k = 0; k < step->assembly->unknown_count; ++k) {
        step->vdot[k] = past.vdot[k] + ratio * (past.vdot[k] - past.vdot_begin[k]);
    }
    memcpy(step->lambda, past.lambda, step->assembly->row_count * sizeof *step->lambda);
}

/* At the beginning of the iteration stiff springs are out of balance, and their force times the
 * curvature of their length may make the matrix singular: corrections grow, and what z has taken
 * of that stays there. From the first guess again, by matrices without negative curvature. */
static void begin_again(se3di_newmark_step *step)
{
    step->integration->newton.tangent.is_convex = 1;
    se3di_newmark_predict(step);
    forget_dependent(step);
    memset(step->z, 0, step->assembly->unknown_count * sizeof *step->z);
    step->correction = HUGE_VAL;
    update_state(step);
}

/* Newton with the mass matrix alone if there are no force elements; with the exact matrix if
 * there are, or if the other one does not do. */
static se3d_status iterate_to_convergence(se3di_newmark_step *step)
{
    const int32_t limit = step->integration->settings.iterations_max;
    const int32_t *is_convex = &step->integration->newton.tangent.is_convex;
    int refactor = 1;
    forget_dependent(step);
    step->correction = HUGE_VAL;
    for (int32_t k = 0; k < limit; ++k) {
        SE3DI_TRY(se3di_equations_ask(step->equations));
        SE3DI_TRY(iterate(step, refactor));
        const int is_traced = se3di_newton_note(&step->integration->newton, step->correction);
        if (has_converged(step)) {
            return check_state(step);
        }
        const double grown = step->correction / step->previous;
        refactor = is_traced || step->equations->redundant || *is_convex ||
                   (k > 0 && grown > (step->exact ? 0.05 : 0.25));
        if (step->exact && !*is_convex && grown > GOES_ASTRAY) {
            begin_again(step);
        }
        if (k == PLAIN_ITERATIONS && !step->exact) {
            step->exact = refactor = 1;
        }
    }
    const se3d_status status = se3di_error_set(
        step->equations->error, SE3D_ERR_NO_CONVERGENCE,
        "t = %g s: Newton did not converge in %d iterations of a step of %g s; try a smaller step",
        step->t, (int)limit, step->h);
    if (!(step->integration->settings.tolerance > 0.0)) { /* the last word */
        se3di_contacts_blame(step->equations->assembly.model, step->equations->error);
    }
    return status;
}

/* Elements with a memory may have assumed wrong what comes out: again until none has, unless the
 * step is made again up to where they change. */
static se3d_status iterate_with_memory(se3di_newmark_step *step)
{
    se3di_model *model = step->assembly->model;
    for (int round = 0; round < REVISIONS_MAX; ++round) {
        SE3DI_TRY(iterate_to_convergence(step));
        if (step->assembly->row_count > 0) {
            memcpy(model->lambda, step->lambda, step->assembly->row_count * sizeof *model->lambda);
        }
        if (step->settles || se3di_forces_revise(model) == 0) {
            return SE3D_OK;
        }
    }
    return SE3D_OK; /* the last one stands */
}

/* Rounding contradicts itself in dependent rows: a smaller regularisation, which tells nearly
 * dependent rows from dependent ones, would only amplify it. */
se3d_status se3di_newmark_solve(se3di_newmark_step *step)
{
    step->exact = se3di_loads_are_stiff(step->assembly->model);
    se3di_kkt *kkt = step->exact ? step->integration->newton.kkt : step->equations->kkt;
    const se3di_kkt_settings before = se3di_kkt_get_settings(kkt);
    SE3DI_TRY(se3di_assembly_eval_functions(step->assembly, step->t, step->equations->error));
    if (step->equations->redundant) {
        se3di_kkt_settings settings = before;
        settings.eps_min = settings.eps;
        se3di_kkt_set_settings(kkt, &settings);
    }
    se3di_assembly_eval_mass(step->assembly);
    memset(step->z, 0, step->assembly->unknown_count * sizeof *step->z);
    update_state(step);
    const se3d_status status = iterate_with_memory(step);
    step->integration->newton.tangent.is_convex = 0;
    se3di_kkt_set_settings(kkt, &before);
    return status;
}
