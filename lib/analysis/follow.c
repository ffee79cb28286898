/* SPDX-License-Identifier: BSD-3-Clause */
/* Forward sensitivities by the implicit function theorem. With d the data of a model (masses,
 * points, values) and x its solution, R(x, d) = 0, another model whose data are d + e is put to
 *
 *     x(e) = x - R_x^-1 R(x, d + e)
 *
 * where R_x is that of the first model, solved exactly, and R an explicit function of the data of
 * the second one. So dx/de at e = 0 is -R_x^-1 R_d, the derivative of the solution, and x(e) is
 * smooth and free of the noise of iterations. Of what constraints and drivers determine the levels
 * follow each other:
 *
 *     Phi_q dq    = -Phi(q)
 *     Phi_q dv    = nu - Phi_q(q + dq) v
 *     Phi_q da    = gamma(q + dq, v + dv) - Phi_q(q + dq) a
 *     Phi_q^T dl  = Q - M (a + da) - Phi_q(q + dq)^T l
 *
 * and of equilibria, with K of the first model (analysis/static_newton.h),
 *
 *     [K       Phi_q^T] [dq]   [Q - Phi_q^T l]
 *     [Phi_q   0      ] [dl] = [-Phi         ]
 *
 * in a few such steps, as K is shifted by a trace there. docs/theory/sensitivities.md */
#include "analysis/follow.h"

#include "analysis/static_newton.h"
#include "integrator/step_list.h"
#include "math/quaternion.h"
#include "model/integral.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define STATIC_STEPS 4     /* of equilibria */
#define STATIC_LEFT  1e-2  /* of the first one, that the last one may be, */
#define ROUNDING     1e-11 /* and this of it [m, rad] */

static se3d_status refuse(const se3di_run *run, se3d_status status, const char *why)
{
    return se3di_error_set(run->error, status, "%s", why);
}

static int are_constraints_alike(const se3di_constraint *a, const se3di_constraint *b)
{
    return strcmp(a->type, b->type) == 0 && a->row_count == b->row_count &&
           a->term_count == b->term_count && a->body_count == b->body_count &&
           a->angle == b->angle && a->callback == b->callback && a->coordinate == b->coordinate &&
           memcmp(a->joints, b->joints, sizeof a->joints) == 0 &&
           memcmp(a->bodies, b->bodies, a->body_count * sizeof *a->bodies) == 0;
}

static int are_forces_alike(const se3di_force *a, const se3di_force *b)
{
    return a->type == b->type && a->body_i == b->body_i && a->body_j == b->body_j &&
           a->joint == b->joint && a->angle == b->angle && a->coordinate == b->coordinate &&
           a->in_body_frame == b->in_body_frame && a->callback == b->callback;
}

/* Whether the models have the same unknowns and rows. */
static int are_alike(const se3di_model *a, const se3di_model *b)
{
    int alike = a->body_slots.count == b->body_slots.count && a->row_count == b->row_count &&
                a->constraint_slots.count == b->constraint_slots.count &&
                a->force_slots.count == b->force_slots.count && a->angle_count == b->angle_count;
    for (size_t k = 0; alike && k < a->body_slots.count; ++k) {
        alike =
            a->bodies[k].fixed == b->bodies[k].fixed && a->bodies[k].state == b->bodies[k].state;
    }
    for (size_t k = 0; alike && k < a->constraint_slots.count; ++k) {
        alike = are_constraints_alike(&a->constraints[k], &b->constraints[k]);
    }
    for (size_t k = 0; alike && k < a->force_slots.count; ++k) {
        alike = are_forces_alike(&a->forces[k], &b->forces[k]);
    }
    return alike;
}

/* What is no smooth function of the data, or has a past. */
static se3d_status check(const se3di_run *run, const se3di_run *from)
{
    const se3di_model *model = from->model;
    if (run->analysis != from->analysis || from->analysis == SE3D_ANALYSIS_ASSEMBLY) {
        return refuse(run, SE3D_ERR_UNSUPPORTED,
                      "an assembly cannot be followed, nor another analysis");
    }
    if (!from->prepared || !se3di_assembly_fits(&from->equations.assembly)) {
        return refuse(run, SE3D_ERR_STATE, "the other solver has not come to a solution");
    }
    if (!are_alike(run->model, model)) {
        return refuse(run, SE3D_ERR_STATE, "the systems have not the same structure");
    }
    if (from->equations.friction.count > 0 || model->sets || model->contacts.pair_count > 0) {
        return refuse(run, SE3D_ERR_UNSUPPORTED,
                      "friction, contacts and particles cannot be followed");
    }
    return SE3D_OK;
}

/* The same, of what no steps lead to. */
static se3d_status check_solution(const se3di_run *run, const se3di_run *from)
{
    if (from->analysis != SE3D_ANALYSIS_EQUILIBRIUM && from->model->settled != SE3DI_SETTLED) {
        return refuse(run, SE3D_ERR_STATE, "the other solver has not come to a solution");
    }
    if (from->equations.assembly.formulation->block != 6 || run->formulation != from->formulation ||
        from->model->left_out_count > 0) {
        return refuse(run, SE3D_ERR_UNSUPPORTED, "r-p and broken joints cannot be followed");
    }
    return SE3D_OK;
}

/* The state of the other model, but for what is data: where fixed bodies are. */
static void take_state(se3di_run *run, const se3di_run *from)
{
    const se3di_assembly *assembly = &run->equations.assembly;
    se3di_model *to = run->model;
    const se3di_model *of = from->model;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const size_t body = assembly->free_body[k];
        to->frames[body] = of->frames[body];
        memcpy(to->acceleration + 6 * body, of->acceleration + 6 * body, 6 * sizeof(double));
    }
    for (size_t k = 0; k < to->row_count; ++k) {
        to->lambda[k] = of->lambda[k];
    }
    for (size_t k = 0; k < to->force_slots.count; ++k) {
        memcpy(to->forces[k].state, of->forces[k].state, sizeof to->forces[k].state);
    }
    for (size_t k = 0; k < to->angle_count; ++k) {
        to->angles[k].theta = of->angles[k].theta;
    }
    to->time = of->time;
}

/* Move all bodies by x. */
static void move(se3di_equations *equations, const double *x)
{
    const se3di_assembly *assembly = &equations->assembly;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        assembly->formulation->move(frame, x + 6 * k);
        se3di_quat_normalize(frame->p, frame->p);
        se3di_frame_update(frame);
    }
}

/* x, l of b, c by the factors of `from`. */
static se3d_status solve(se3di_equations *equations, const se3di_equations *from)
{
    const se3di_kkt_values values = se3di_equations_values(from);
    return se3di_equations_solve_by(equations, from->kkt, &values);
}

static void clear_b(se3di_equations *equations)
{
    memset(equations->b, 0, equations->assembly.unknown_count * sizeof *equations->b);
}

static se3d_status follow_positions(se3di_equations *equations, const se3di_equations *from)
{
    se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_eval_phi(assembly, equations->phi);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = -equations->phi[k];
    }
    clear_b(equations);
    SE3DI_TRY(solve(equations, from));
    move(equations, equations->x);
    return SE3D_OK;
}

static se3d_status follow_velocities(se3di_equations *equations, const se3di_equations *from)
{
    se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_eval_jacobian(assembly);
    se3di_assembly_get_velocity(assembly, equations->probe);
    se3di_assembly_mul(assembly, equations->probe, equations->phi);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = assembly->f[3 * k + 1] - equations->phi[k];
    }
    clear_b(equations);
    SE3DI_TRY(solve(equations, from));
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        equations->x[k] += equations->probe[k];
    }
    se3di_assembly_set_velocity(assembly, equations->x);
    return SE3D_OK;
}

static se3d_status follow_accelerations(se3di_equations *equations, const se3di_equations *from)
{
    se3di_assembly *assembly = &equations->assembly;
    se3di_assembly_eval_rows(assembly, equations->c);
    se3di_assembly_get_acceleration(assembly, equations->probe);
    se3di_assembly_mul(assembly, equations->probe, equations->phi);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] -= equations->phi[k];
    }
    clear_b(equations);
    SE3DI_TRY(solve(equations, from));
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        equations->probe[k] += equations->x[k];
    }
    se3di_assembly_set_acceleration(assembly, equations->probe);
    return SE3D_OK;
}

/* At accelerations `probe`. */
static se3d_status follow_multipliers(se3di_equations *equations, const se3di_equations *from)
{
    se3di_assembly *assembly = &equations->assembly;
    double *lambda = assembly->model->lambda;
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, assembly->model->time, equations->b,
                                         equations->error));
    se3di_assembly_subtract_inertia(assembly, equations->probe, equations->b);
    se3di_assembly_add_transposed(assembly, -1.0, lambda, equations->b);
    memset(equations->c, 0, assembly->row_count * sizeof *equations->c);
    const se3d_status status = solve(equations, from);
    SE3DI_TRY(status);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        lambda[k] += equations->l[k];
    }
    return status == SE3D_INFO_REDUNDANT ? se3di_multipliers_reduce(equations) : SE3D_OK;
}

/* The factors of a driven motion at its present state, made once for all that follow it. */
static se3d_status factor(se3di_run *from)
{
    se3di_equations *equations = &from->equations;
    const int is_there = from->followed_at == equations->counters.factorizations &&
                         from->followed_time == from->model->time;
    if (!is_there) {
        SE3DI_TRY(se3di_equations_factor(equations));
        from->followed_at = equations->counters.factorizations;
        from->followed_time = from->model->time;
    }
    return SE3D_OK;
}

static se3d_status follow_driven(se3di_run *run, se3di_run *from)
{
    se3di_equations *equations = &run->equations;
    SE3DI_TRY(factor(from));
    SE3DI_TRY(follow_positions(equations, &from->equations));
    SE3DI_TRY(follow_velocities(equations, &from->equations));
    SE3DI_TRY(follow_accelerations(equations, &from->equations));
    SE3DI_TRY(follow_multipliers(equations, &from->equations));
    run->model->settled = SE3DI_SETTLED;
    run->model->work_valid = SE3DI_WORK_UNKNOWN;
    for (int k = 0; k < 3; ++k) { /* they are no function of the state alone */
        run->model->work[k] = equations->audits ? (double)NAN : 0.0;
    }
    return SE3D_OK;
}

/* ---- equilibria ---- */

/* One step; *length: its largest part. */
static se3d_status follow_static(se3di_equations *equations, se3di_static_newton *newton,
                                 double *length)
{
    se3di_assembly *assembly = &equations->assembly;
    double *lambda = assembly->model->lambda;
    se3di_assembly_eval_jacobian(assembly);
    SE3DI_TRY(se3di_assembly_eval_forces(assembly, assembly->model->time, equations->b,
                                         equations->error));
    se3di_assembly_add_transposed(assembly, -1.0, lambda, equations->b);
    se3di_assembly_eval_phi(assembly, equations->phi);
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        equations->c[k] = -equations->phi[k];
    }
    SE3DI_TRY(se3di_static_newton_solve(newton, equations->b, equations->c, equations->x));
    *length = 0.0;
    for (uint32_t k = 0; k < assembly->unknown_count; ++k) {
        *length = fmax(*length, fabs(equations->x[k]));
    }
    for (uint32_t k = 0; k < assembly->row_count; ++k) {
        lambda[k] += newton->reaction[k];
    }
    move(equations, equations->x);
    return SE3D_OK;
}

static se3d_status follow_statics(se3di_run *run, se3di_static_newton *newton)
{
    double first = 0.0;
    double length = 0.0;
    for (int k = 0; k < STATIC_STEPS; ++k) {
        SE3DI_TRY(follow_static(&run->equations, newton, &length));
        first = fmax(first, length);
    }
    return length <= STATIC_LEFT * first + ROUNDING
               ? SE3D_OK
               : refuse(run, SE3D_ERR_NO_CONVERGENCE, "the equilibrium leaves a freedom");
}

static se3d_status follow_equilibrium(se3di_run *run, se3di_run *from)
{
    se3di_equations *equations = &from->equations;
    se3di_assembly *assembly = &equations->assembly;
    se3di_static_newton newton;
    int32_t negative;
    SE3DI_TRY(se3di_static_newton_init(&newton, equations));
    se3di_assembly_eval_jacobian(assembly);
    se3d_status status =
        se3di_assembly_eval_forces(assembly, from->model->time, equations->b, equations->error);
    if (status >= 0) {
        status = se3di_static_newton_eval(&newton, from->model->time, equations->b,
                                          from->model->lambda, 0);
    }
    if (status >= 0) {
        status = se3di_static_newton_factor(&newton, 0.0, &negative);
    }
    if (status >= 0) {
        status = follow_statics(run, &newton);
    }
    se3di_static_newton_destroy(&newton);
    return status;
}

/* ---- dynamics ---- */

/* By the steps that the other run has made since others follow it. */
static se3d_status follow_dynamics(se3di_run *run, se3di_run *from)
{
    if (!from->integration.method->explicit_class || from->integration.settings.step > 0.0) {
        return refuse(run, SE3D_ERR_UNSUPPORTED,
                      "of dynamics only explicit methods that choose their steps can be followed");
    }
    if (!from->integration.record && from->equations.counters.steps > 0) {
        return refuse(run, SE3D_ERR_STATE, "the other run is to be followed from its beginning on");
    }
    if (!from->integration.record) {
        from->integration.record = &from->steps;
        se3di_step_list_begin(&from->integration, from->model->time);
    }
    run->integration.repeat = &from->steps;
    run->shows_motion = from->shows_motion;
    const se3d_status status = se3di_run_to(run, from->model->time);
    run->integration.repeat = NULL;
    return status >= 0 && run->integration.method != from->integration.method
               ? refuse(run, SE3D_ERR_UNSUPPORTED, "the systems move by different methods")
               : status;
}

/* ---- all ---- */

static se3d_status follow_solution(se3di_run *run, se3di_run *from)
{
    se3di_model *model = run->model;
    const double t = from->model->time;
    const int is_static = from->analysis == SE3D_ANALYSIS_EQUILIBRIUM;
    SE3DI_TRY(check_solution(run, from));
    SE3DI_TRY(se3di_run_prepare(run));
    if (se3di_integrals_reserve(model, t) < 0) {
        return refuse(run, SE3D_ERR_NO_MEMORY, "no memory for integrals of rates");
    }
    se3di_integrals_advance(model, t);
    take_state(run, from);
    SE3DI_TRY(se3di_assembly_eval_functions(&run->equations.assembly, t, run->error));
    SE3DI_TRY(is_static ? follow_equilibrium(run, from) : follow_driven(run, from));
    se3di_angles_accept(model);
    if (is_static) {
        se3di_model_touch_state(model);
    }
    return SE3D_OK;
}

se3d_status se3di_run_follow(se3di_run *run, se3di_run *from)
{
    SE3DI_TRY(check(run, from));
    return from->analysis == SE3D_ANALYSIS_DYNAMICS ? follow_dynamics(run, from)
                                                    : follow_solution(run, from);
}
