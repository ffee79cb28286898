/* SPDX-License-Identifier: BSD-3-Clause */
#include "nonlinear/newton.h"

#include "math/quaternion.h"
#include "math/vec3.h"

#include <string.h>

static se3d_status create_kkt(se3di_newton *newton)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    se3di_kkt_pattern pattern = {
        .body_count = assembly->body_count,
        .joint_count = assembly->constraint_count,
        .coupling_count = newton->tangent.coupling_count,
        .joint_rows = assembly->joint_rows,
        .joint_begin = assembly->joint_begin,
        .joint_body = assembly->joint_body,
        .coupling = newton->tangent.coupling,
        .body_size = assembly->formulation->block,
        .symmetric = false,
        .body_kind = SE3DI_KKT_BODY_FULL,
    };
    return se3di_kkt_create(&assembly->model->allocator, &pattern, SE3DI_KKT_STRUCTURED,
                            assembly->model->shelf, &newton->kkt);
}

static se3d_status build(se3di_newton *newton)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    SE3DI_TRY(se3di_tangent_init(&newton->tangent, assembly));
    SE3DI_TRY(create_kkt(newton));
    newton->force_count = assembly->model->force_slots.count;
    newton->Tinv = se3di_alloc(allocator, 9 * (size_t)assembly->body_count, sizeof(double));
    newton->rows = se3di_alloc(allocator, assembly->joint_value_count, sizeof(double));
    newton->columns = se3di_alloc(
        allocator, newton->equations->friction.count > 0 ? assembly->joint_value_count : 0,
        sizeof(double));
    newton->memory =
        se3di_alloc(allocator, SE3DI_FORCE_STATES * newton->force_count, sizeof(double));
    return newton->Tinv && newton->rows && newton->columns && newton->memory ? SE3D_OK
                                                                             : SE3D_ERR_NO_MEMORY;
}

se3d_status se3di_newton_init(se3di_newton *newton, se3di_equations *equations)
{
    *newton = (se3di_newton){.equations = equations};
    se3d_status status = build(newton);
    if (status < 0) {
        se3di_newton_destroy(newton);
    }
    return status;
}

void se3di_newton_destroy(se3di_newton *newton)
{
    if (!newton->equations) {
        return;
    }
    const se3di_assembly *assembly = &newton->equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    se3di_free(allocator, newton->Tinv, 9 * (size_t)assembly->body_count, sizeof(double));
    se3di_free(allocator, newton->rows, assembly->joint_value_count, sizeof(double));
    se3di_free(allocator, newton->columns,
               newton->equations->friction.count > 0 ? assembly->joint_value_count : 0,
               sizeof(double));
    se3di_free(allocator, newton->memory, SE3DI_FORCE_STATES * newton->force_count, sizeof(double));
    se3di_kkt_destroy(newton->kkt);
    se3di_tangent_destroy(&newton->tangent);
    memset(newton, 0, sizeof *newton);
}

/* Right three columns of a block of rows of six times Tinv. */
static void turn_columns(double *block, int32_t rows, const double *Tinv)
{
    for (int32_t r = 0; r < rows; ++r) {
        double row[3];
        se3di_mul_transposed(Tinv, block + 6 * r + 3, row);
        se3di_copy(row, block + 6 * r + 3);
    }
}

/* D <- (M + velocity D) T^-1 + position K, block by block. */
static void combine(double *D, const double *M, const double *K, const double *Tinv,
                    const se3di_newton_weights *weights, size_t n)
{
    for (size_t k = 0; k < n * n; ++k) {
        D[k] = weights->velocity * D[k] + (M ? M[k] : 0.0);
    }
    if (n == 6) {
        turn_columns(D, 6, Tinv);
    }
    for (size_t k = 0; k < n * n; ++k) {
        D[k] += weights->position * K[k];
    }
}

static void combine_all(se3di_newton *newton, const se3di_newton_weights *weights)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    se3di_tangent *tangent = &newton->tangent;
    size_t n = (size_t)assembly->formulation->block;
    size_t size = n * n;
    const int coupled = assembly->armature_count > 0;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        combine(tangent->D + k * size, tangent->M + k * size, tangent->K + k * size,
                newton->Tinv + 9 * k, weights, n);
    }
    for (size_t k = 0; k < tangent->coupling_count; ++k) {
        const int32_t *pair = tangent->coupling + 2 * k;
        if (!tangent->is_filled[k]) {
            continue;
        }
        combine(tangent->D_upper + k * size, coupled ? tangent->M_upper + k * size : NULL,
                tangent->K_upper + k * size, newton->Tinv + 9 * (size_t)pair[1], weights, n);
        combine(tangent->D_lower + k * size, coupled ? tangent->M_lower + k * size : NULL,
                tangent->K_lower + k * size, newton->Tinv + 9 * (size_t)pair[0], weights, n);
    }
}

static se3di_kkt_values values_of(const se3di_newton *newton)
{
    return (se3di_kkt_values){
        .body = newton->tangent.D,
        .coupling_upper = newton->tangent.D_upper,
        .coupling_lower = newton->tangent.D_lower,
        .joint = newton->has_rows ? newton->rows : newton->equations->assembly.C,
        .joint_b = newton->has_columns ? newton->columns : newton->equations->assembly.C};
}

/* What multipliers do to the bodies, if some of them load friction. */
static void set_columns(se3di_newton *newton, const double *lambda)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    newton->has_columns = 0;
    if (newton->equations->friction.count > 0 && assembly->joint_value_count > 0) {
        memcpy(newton->columns, assembly->C, assembly->joint_value_count * sizeof(double));
        newton->has_columns = se3di_frictions_add_columns(assembly, lambda, newton->columns);
    }
}

/* With T^-1 and `rows` as they are. */
static se3d_status factor(se3di_newton *newton, double t, const double *vdot, const double *lambda,
                          const se3di_newton_weights *weights)
{
    se3di_equations *equations = newton->equations;
    SE3DI_TRY(se3di_tangent_eval(&newton->tangent, t, vdot, lambda, equations->error));
    combine_all(newton, weights);
    set_columns(newton, lambda);
    const se3di_kkt_values values = values_of(newton);
    ++equations->counters.factorizations;
    const se3d_status status = se3di_kkt_factor(newton->kkt, &values, NULL);
    return status < 0 ? se3di_error_set(equations->error, status,
                                        "t = %g s: the Newton matrix is singular or not finite", t)
                      : status;
}

se3d_status se3di_newton_factor(se3di_newton *newton, double t, const double *vdot,
                                const double *lambda, const double *step,
                                const se3di_newton_weights *weights)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    for (size_t k = 0; k < assembly->body_count && assembly->formulation->block == 6; ++k) {
        se3di_exp_tangent_inverse(step + 6 * k + 3, newton->Tinv + 9 * k);
    }
    newton->has_rows = 0;
    return factor(newton, t, vdot, lambda, weights);
}

/* The rows C T^-1 + c d(Phi_q qdot)/dq of constraints that enter by velocities. */
static void set_rows(se3di_newton *newton, double c)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    if (assembly->joint_value_count > 0) {
        memcpy(newton->rows, assembly->C, assembly->joint_value_count * sizeof *newton->rows);
    }
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        for (int32_t k = assembly->joint_begin[joint]; k < assembly->joint_begin[joint + 1]; ++k) {
            const double *Tinv = newton->Tinv + 9 * (size_t)assembly->joint_body[k];
            turn_columns(newton->rows + assembly->block_offset[k], assembly->joint_rows[joint],
                         Tinv);
        }
    }
    se3di_assembly_add_rate_gradient(assembly, c, newton->rows);
    newton->has_rows = 1;
}

se3d_status se3di_newton_factor_velocities(se3di_newton *newton, double t, const double *vdot,
                                           const double *lambda, const double *step,
                                           const se3di_newton_weights *weights)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        se3di_exp_tangent_inverse(step + 6 * k + 3, newton->Tinv + 9 * k);
    }
    set_rows(newton, weights->position / weights->velocity);
    return factor(newton, t, vdot, lambda, weights);
}

/* p o (1 - c/2 w) is held, so that dtheta o (1 - c/2 w) = c dw and T^-1 = I + c/2 ~w + c^2/4 w w^T.
 */
static void set_turns(se3di_newton *newton, double c)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        const double *w = assembly->model->frames[assembly->free_body[k]].w;
        double *Tinv = newton->Tinv + 9 * k;
        se3di_tilde(w, Tinv);
        for (int e = 0; e < 9; ++e) {
            Tinv[e] = 0.5 * c * Tinv[e] + 0.25 * c * c * w[e / 3] * w[e % 3];
        }
        Tinv[0] += 1.0;
        Tinv[4] += 1.0;
        Tinv[8] += 1.0;
    }
}

se3d_status se3di_newton_factor_rates(se3di_newton *newton, double t, const double *vdot,
                                      const double *lambda, double c)
{
    const se3di_newton_weights weights = {.velocity = c, .position = c * c};
    set_turns(newton, c);
    set_rows(newton, c);
    return factor(newton, t, vdot, lambda, &weights);
}

se3d_status se3di_newton_solve_displacement(se3di_newton *newton)
{
    const se3di_kkt_values values = values_of(newton);
    return se3di_equations_solve_by(newton->equations, newton->kkt, &values);
}

void se3di_newton_add_matrix(const se3di_newton *newton, const double *x, double *out)
{
    se3di_tangent_add_damping(&newton->tangent, 1.0, x, out); /* where `combine` has put it */
}

void se3di_newton_turn(const se3di_newton *newton, double *x)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    for (size_t k = 0; assembly->formulation->block == 6 && k < assembly->body_count; ++k) {
        double *turn = x + 6 * k + 3, turned[3];
        se3di_mul(newton->Tinv + 9 * k, turn, turned);
        se3di_copy(turned, turn);
    }
}

se3d_status se3di_newton_solve(se3di_newton *newton)
{
    const se3d_status status = se3di_newton_solve_displacement(newton);
    SE3DI_TRY(status);
    se3di_newton_turn(newton, newton->equations->x);
    return status;
}

/* out += scale rows x of one block of rows on a body. */
static void add_rows(const double *rows, int32_t count, double scale, const double x[6],
                     double *out)
{
    for (int32_t r = 0; r < count; ++r, rows += 6) {
        for (int c = 0; c < 6; ++c) {
            out[r] += scale * rows[c] * x[c];
        }
    }
}

void se3di_newton_add_gradient(const se3di_newton *newton, double scale, const double *y,
                               double *out)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        double *part = out + assembly->model->constraints[joint].row_begin;
        const int32_t count = assembly->joint_rows[joint];
        for (int32_t k = assembly->joint_begin[joint]; k < assembly->joint_begin[joint + 1]; ++k) {
            const size_t body = (size_t)assembly->joint_body[k], at = assembly->block_offset[k];
            const double *whole = y + 6 * body;
            double turned[6] = {whole[0], whole[1], whole[2]};
            se3di_mul(newton->Tinv + 9 * body, whole + 3, turned + 3);
            add_rows(newton->rows + at, count, scale, whole, part);
            add_rows(assembly->C + at, count, -scale, turned, part);
        }
    }
}

int se3di_newton_note(const se3di_newton *newton, double size)
{
    se3di_newton_trace *trace = newton->trace;
    if (trace && trace->count < (int32_t)(sizeof trace->size / sizeof trace->size[0])) {
        trace->size[trace->count++] = size;
    }
    return trace != NULL;
}
