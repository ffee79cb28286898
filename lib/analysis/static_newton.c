/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/static_newton.h"

#include "base/sort.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define STIFFNESS_FLOOR 1e-9 /* F, of a body's own stiffness */
#define RANK_TOLERANCE  1e-9
#define MIN_NORM_ROWS   600 /* beyond it dense least squares would be too slow */

/* Count the pairs of the bodies of joints, and write them if there is room. */
static size_t list_joint_pairs(const se3di_assembly *assembly, int32_t *pairs)
{
    size_t count = 0;
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        for (int32_t b = assembly->joint_begin[joint]; b < assembly->joint_begin[joint + 1]; ++b) {
            for (int32_t a = assembly->joint_begin[joint]; a < b; ++a) {
                const int32_t i = assembly->joint_body[a];
                const int32_t j = assembly->joint_body[b];
                if (pairs) {
                    pairs[2 * count] = i < j ? i : j;
                    pairs[2 * count + 1] = i < j ? j : i;
                }
                ++count;
            }
        }
    }
    return count;
}

static size_t find_pair(const se3di_static_newton *newton, int32_t i, int32_t j)
{
    size_t low = 0;
    size_t high = newton->pair_count;
    while (low + 1 < high) {
        const size_t middle = (low + high) / 2;
        const int32_t *pair = newton->pairs + 2 * middle;
        const int is_after = pair[0] > i || (pair[0] == i && pair[1] > j);
        low = is_after ? low : middle;
        high = is_after ? middle : high;
    }
    return low;
}

static se3d_status list_pairs(se3di_static_newton *newton)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    const size_t couplings = newton->tangent.coupling_count;
    newton->pair_capacity = couplings + list_joint_pairs(assembly, NULL);
    newton->pairs = se3di_alloc(allocator, 2 * newton->pair_capacity, sizeof *newton->pairs);
    newton->coupling_at = se3di_alloc(allocator, couplings, sizeof *newton->coupling_at);
    if (!newton->pairs || !newton->coupling_at) {
        return SE3D_ERR_NO_MEMORY;
    }
    if (couplings > 0) {
        memcpy(newton->pairs, newton->tangent.coupling, 2 * couplings * sizeof *newton->pairs);
    }
    (void)list_joint_pairs(assembly, newton->pairs + 2 * couplings);
    se3di_sort_tuples(newton->pairs, newton->pair_capacity, 2);
    for (size_t k = 0; k < newton->pair_capacity; ++k) {
        int32_t *last = newton->pairs + 2 * newton->pair_count;
        const int32_t *pair = newton->pairs + 2 * k;
        if (k == 0 || pair[0] != last[-2] || pair[1] != last[-1]) {
            last[0] = pair[0];
            last[1] = pair[1];
            ++newton->pair_count;
        }
    }
    for (size_t k = 0; k < couplings; ++k) {
        const int32_t *coupling = newton->tangent.coupling + 2 * k;
        newton->coupling_at[k] = (int32_t)find_pair(newton, coupling[0], coupling[1]);
    }
    return SE3D_OK;
}

static se3d_status create_kkt(const se3di_static_newton *newton, bool symmetric, se3di_kkt **kkt)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    const se3di_kkt_pattern pattern = {
        .body_count = assembly->body_count,
        .joint_count = assembly->constraint_count,
        .coupling_count = newton->pair_count,
        .joint_rows = assembly->joint_rows,
        .joint_begin = assembly->joint_begin,
        .joint_body = assembly->joint_body,
        .coupling = newton->pairs,
        .body_size = assembly->formulation->block,
        .symmetric = symmetric,
        .body_kind = SE3DI_KKT_BODY_FULL,
    };
    SE3DI_TRY(se3di_kkt_create(&assembly->model->allocator, &pattern, SE3DI_KKT_STRUCTURED,
                               assembly->model->shelf, kkt));
    se3di_kkt_settings settings = se3di_kkt_get_settings(*kkt);
    settings.any_multipliers = true;
    se3di_kkt_set_settings(*kkt, &settings);
    return SE3D_OK;
}

static void note_lever(se3di_static_newton *newton, uint32_t dense, const double s[3])
{
    const int32_t body = newton->equations->assembly.free_index[dense];
    if (body >= 0) {
        newton->weights[body].radius2 = fmax(newton->weights[body].radius2, se3di_dot(s, s));
    }
}

/* Weights of a body that do not change: its mass, and as its radius the longest lever of what acts
 * on it. */
static void weigh_bodies(se3di_static_newton *newton)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    const se3di_model *model = assembly->model;
    const double size = se3di_model_get_size(model);
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const se3di_body *body = &model->bodies[assembly->free_body[k]];
        const double trace = body->J[0] + body->J[1] + body->J[2];
        newton->weights[k] =
            (se3di_static_weight){body->mass, 0.0, fmax(trace / body->mass, 1e-6 * size * size)};
    }
    for (size_t k = 0; k < model->term_count; ++k) {
        const se3di_term *term = &model->terms[k];
        note_lever(newton, term->body_i, term->s_i);
        note_lever(newton, term->body_j, term->s_j);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        note_lever(newton, model->forces[k].body_i, model->forces[k].s_i);
        note_lever(newton, model->forces[k].body_j, model->forces[k].s_j);
    }
}

static size_t penalty_count(const se3di_static_newton *newton)
{
    return 36 * ((size_t)newton->equations->assembly.body_count + 4 * newton->pair_count);
}

static se3d_status build(se3di_static_newton *newton)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    SE3DI_TRY(se3di_tangent_init(&newton->tangent, assembly));
    SE3DI_TRY(list_pairs(newton));
    SE3DI_TRY(create_kkt(newton, true, &newton->symmetric));
    SE3DI_TRY(create_kkt(newton, false, &newton->full));
    newton->unit = se3di_alloc(allocator, 36 * (size_t)assembly->body_count, sizeof(double));
    newton->zero = se3di_alloc(allocator, assembly->unknown_count, sizeof(double));
    newton->reaction = se3di_alloc(allocator, assembly->row_count, sizeof(double));
    newton->weights = se3di_alloc(allocator, assembly->body_count, sizeof *newton->weights);
    newton->penalty = se3di_alloc(allocator, penalty_count(newton), sizeof(double));
    if (!newton->unit || !newton->zero || !newton->reaction || !newton->weights ||
        !newton->penalty) {
        return SE3D_ERR_NO_MEMORY;
    }
    newton->penalty_upper = newton->penalty + 36 * (size_t)assembly->body_count;
    newton->upper = newton->penalty_upper + 36 * newton->pair_count;
    newton->full_upper = newton->upper + 36 * newton->pair_count;
    newton->full_lower = newton->full_upper + 36 * newton->pair_count;
    memset(newton->unit, 0, 36 * (size_t)assembly->body_count * sizeof(double));
    memset(newton->zero, 0, assembly->unknown_count * sizeof(double));
    for (size_t k = 0; k < assembly->unknown_count; ++k) {
        newton->unit[6 * k + k % 6] = 1.0;
    }
    weigh_bodies(newton);
    return SE3D_OK;
}

se3d_status se3di_static_newton_init(se3di_static_newton *newton, se3di_equations *equations)
{
    *newton = (se3di_static_newton){.equations = equations};
    se3d_status status = build(newton);
    if (status < 0) {
        se3di_static_newton_destroy(newton);
    }
    return status;
}

void se3di_static_newton_destroy(se3di_static_newton *newton)
{
    if (!newton->equations) {
        return;
    }
    const se3di_assembly *assembly = &newton->equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    se3di_kkt_destroy(newton->symmetric);
    se3di_kkt_destroy(newton->full);
    se3di_free(allocator, newton->penalty, penalty_count(newton), sizeof(double));
    se3di_free(allocator, newton->pairs, 2 * newton->pair_capacity, sizeof *newton->pairs);
    se3di_free(allocator, newton->coupling_at, newton->tangent.coupling_count,
               sizeof *newton->coupling_at);
    se3di_free(allocator, newton->unit, 36 * (size_t)assembly->body_count, sizeof(double));
    se3di_free(allocator, newton->zero, assembly->unknown_count, sizeof(double));
    se3di_free(allocator, newton->reaction, assembly->row_count, sizeof(double));
    se3di_free(allocator, newton->weights, assembly->body_count, sizeof *newton->weights);
    se3di_tangent_destroy(&newton->tangent);
    memset(newton, 0, sizeof *newton);
}

se3d_status se3di_static_newton_balance(se3di_static_newton *newton, const double *load,
                                        double *rho, double *lambda, int careful)
{
    se3di_equations *equations = newton->equations;
    const se3di_assembly *assembly = &equations->assembly;
    const se3di_kkt_values values = se3di_equations_values_of(equations, newton->unit);
    se3di_kkt_solve_info info = {0};
    memcpy(rho, load, assembly->unknown_count * sizeof *rho);
    if (assembly->row_count == 0) {
        return SE3D_OK;
    }
    ++equations->counters.factorizations;
    ++equations->counters.solves;
    SE3DI_TRY(se3di_kkt_factor(equations->kkt, &values, NULL));
    se3d_status status = se3di_kkt_solve(equations->kkt, &values, load, NULL, rho, lambda, &info);
    const int inexact = status == SE3D_ERR_NO_CONVERGENCE || info.residual_b > 1e-9;
    if (inexact && careful && assembly->row_count <= MIN_NORM_ROWS) {
        int32_t rank = 0;
        memset(rho, 0, assembly->unknown_count * sizeof *rho);
        SE3DI_TRY(
            se3di_kkt_min_norm(equations->kkt, &values, load, rho, RANK_TOLERANCE, lambda, &rank));
        memcpy(rho, load, assembly->unknown_count * sizeof *rho);
        se3di_assembly_add_transposed(assembly, -1.0, lambda, rho);
        return (uint32_t)rank < assembly->row_count ? SE3D_INFO_REDUNDANT : SE3D_OK;
    }
    return status == SE3D_ERR_NO_CONVERGENCE ? SE3D_OK : status;
}

/* The largest entry of a block of K, of its turns over the radius. */
static double stiffness_of(const double *K, double radius)
{
    double largest = 0.0;
    for (int e = 0; e < 36; ++e) {
        const double scale = (e / 6 < 3 ? 1.0 : radius) * (e % 6 < 3 ? 1.0 : radius);
        largest = fmax(largest, fabs(K[e]) / scale);
    }
    return largest;
}

/* Of a wrench over the radius, what turning it about the body's centre is worth. */
static double stiffness_of_force(const double *wrench, double radius)
{
    return (se3di_norm(wrench) + se3di_norm(wrench + 3) / radius) / radius;
}

static void weigh_stiffness(se3di_static_newton *newton, const double *load, const double *lambda)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    newton->rate2 = newton->force = 0.0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_static_weight *weight = &newton->weights[k];
        const double radius = sqrt(weight->radius2);
        weight->stiffness = stiffness_of(newton->tangent.K + 36 * (size_t)k, radius) +
                            stiffness_of_force(load + 6 * (size_t)k, radius);
    }
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        const int32_t rows = assembly->joint_rows[joint];
        const double *l = lambda + assembly->model->constraints[joint].row_begin;
        for (int32_t e = assembly->joint_begin[joint]; e < assembly->joint_begin[joint + 1]; ++e) {
            se3di_static_weight *weight = &newton->weights[assembly->joint_body[e]];
            double wrench[6] = {0.0};
            for (int32_t r = 0; r < rows; ++r) {
                for (int c = 0; c < 6; ++c) {
                    wrench[c] +=
                        l[r] * assembly->C[assembly->block_offset[e] + (size_t)(6 * r + c)];
                }
            }
            weight->stiffness =
                fmax(weight->stiffness, stiffness_of_force(wrench, sqrt(weight->radius2)));
        }
    }
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const se3di_static_weight *weight = &newton->weights[k];
        newton->rate2 = fmax(newton->rate2, weight->stiffness / weight->mass);
        newton->force = fmax(newton->force, weight->stiffness * sqrt(weight->radius2));
    }
}

/* The diagonal of s W + F. */
static double shift_of(const se3di_static_newton *newton, size_t body, double s, size_t entry)
{
    const se3di_static_weight *weight = &newton->weights[body];
    const double shift = s * weight->mass + newton->floor * weight->stiffness;
    return entry < 3 ? shift : shift * weight->radius2;
}

/* What a row of a joint is multiplied by: as stiff as the stiffest of the joint's bodies. */
static double penalty_of(const se3di_static_newton *newton, uint32_t joint, int32_t row)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    double stiffness = 0.0;
    double square = 0.0;
    for (int32_t e = assembly->joint_begin[joint]; e < assembly->joint_begin[joint + 1]; ++e) {
        const se3di_static_weight *weight = &newton->weights[assembly->joint_body[e]];
        const double *c = assembly->C + assembly->block_offset[e] + (size_t)(6 * row);
        square += se3di_dot(c, c) + se3di_dot(c + 3, c + 3) / weight->radius2;
        stiffness = fmax(stiffness, weight->stiffness);
    }
    return square > 0.0 ? stiffness / square : 0.0;
}

/* block += s c_i c_j^T */
static void add_outer(double *block, double s, const double *c_i, const double *c_j)
{
    for (int k = 0; k < 36; ++k) {
        block[k] += s * c_i[k / 6] * c_j[k % 6];
    }
}

static void add_joint_penalty(se3di_static_newton *newton, uint32_t joint, int32_t row)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    const double s = penalty_of(newton, joint, row);
    for (int32_t b = assembly->joint_begin[joint]; b < assembly->joint_begin[joint + 1]; ++b) {
        const int32_t j = assembly->joint_body[b];
        const double *c_j = assembly->C + assembly->block_offset[b] + (size_t)(6 * row);
        add_outer(newton->penalty + 36 * (size_t)j, s, c_j, c_j);
        for (int32_t a = assembly->joint_begin[joint]; a < b; ++a) {
            const int32_t i = assembly->joint_body[a];
            const double *c_i = assembly->C + assembly->block_offset[a] + (size_t)(6 * row);
            double *block =
                newton->penalty_upper + 36 * find_pair(newton, i < j ? i : j, i < j ? j : i);
            add_outer(block, s, i < j ? c_i : c_j, i < j ? c_j : c_i);
        }
    }
}

/* P = C^T diag(s) C: nothing along steps on the constraints, and with it the blocks of bodies that
 * only joints hold are not singular. */
static void eval_penalty(se3di_static_newton *newton)
{
    const se3di_assembly *assembly = &newton->equations->assembly;
    memset(newton->penalty, 0,
           36 * (assembly->body_count + newton->pair_count) * sizeof *newton->penalty);
    for (uint32_t joint = 0; joint < assembly->constraint_count; ++joint) {
        for (int32_t row = 0; row < assembly->joint_rows[joint]; ++row) {
            add_joint_penalty(newton, joint, row);
        }
    }
}

/* The blocks of bodies: D of the symmetric part, M of all of K. */
static void combine_bodies(se3di_static_newton *newton, double s)
{
    se3di_tangent *tangent = &newton->tangent;
    for (size_t k = 0; k < newton->equations->assembly.body_count; ++k) {
        const double *K = tangent->K + 36 * k;
        for (size_t e = 0; e < 36; ++e) {
            const size_t r = e / 6;
            const size_t c = e % 6;
            const double shift = r == c ? shift_of(newton, k, s, r) : 0.0;
            const double added = shift + newton->penalty[36 * k + e];
            tangent->D[36 * k + e] = 0.5 * (K[e] + K[6 * c + r]) + added;
            tangent->M[36 * k + e] = K[e] + added;
        }
    }
}

static void combine_pairs(se3di_static_newton *newton)
{
    const se3di_tangent *tangent = &newton->tangent;
    for (size_t e = 0; e < 36 * newton->pair_count; ++e) {
        const size_t turned = e / 36 * 36 + 6 * (e % 6) + e % 36 / 6;
        newton->upper[e] = newton->full_upper[e] = newton->penalty_upper[e];
        newton->full_lower[e] = newton->penalty_upper[turned];
    }
    for (size_t k = 0; k < tangent->coupling_count; ++k) {
        const size_t at = 36 * (size_t)newton->coupling_at[k];
        for (size_t e = 0; e < 36; ++e) {
            const size_t turned = 6 * (e % 6) + e / 6;
            newton->upper[at + e] +=
                0.5 * (tangent->K_upper[36 * k + e] + tangent->K_lower[36 * k + turned]);
            newton->full_upper[at + e] += tangent->K_upper[36 * k + e];
            newton->full_lower[at + e] += tangent->K_lower[36 * k + e];
        }
    }
}

se3d_status se3di_static_newton_eval(se3di_static_newton *newton, double t, const double *load,
                                     const double *lambda, int is_convex)
{
    newton->tangent.is_convex = is_convex;
    newton->floor = STIFFNESS_FLOOR;
    SE3DI_TRY(
        se3di_tangent_eval(&newton->tangent, t, newton->zero, lambda, newton->equations->error));
    weigh_stiffness(newton, load, lambda);
    eval_penalty(newton);
    combine_pairs(newton);
    return SE3D_OK;
}

static se3di_kkt_values symmetric_values(const se3di_static_newton *newton)
{
    return (se3di_kkt_values){.body = newton->tangent.D,
                              .coupling_upper = newton->upper,
                              .joint = newton->equations->assembly.C};
}

se3d_status se3di_static_newton_factor(se3di_static_newton *newton, double s, int32_t *negative)
{
    const se3di_kkt_values values = symmetric_values(newton);
    se3di_kkt_factor_info info = {0};
    *negative = 0;
    combine_bodies(newton, s);
    ++newton->equations->counters.factorizations;
    SE3DI_TRY(se3di_kkt_factor(newton->symmetric, &values, &info));
    *negative = info.negative_freedoms;
    return SE3D_OK;
}

int se3di_static_newton_is_strict(se3di_static_newton *newton)
{
    int32_t negative = 0;
    newton->floor = -STIFFNESS_FLOOR;
    se3d_status status = se3di_static_newton_factor(newton, 0.0, &negative);
    if (status < 0) { /* nothing has any stiffness: is there a freedom at all? */
        status = se3di_static_newton_factor(newton, -1.0, &negative);
    }
    newton->floor = STIFFNESS_FLOOR;
    return status >= 0 && negative == 0;
}

se3d_status se3di_static_newton_solve(se3di_static_newton *newton, const double *rho,
                                      const double *c, double *dq)
{
    se3di_equations *equations = newton->equations;
    const se3di_kkt_values values = {.body = newton->tangent.M,
                                     .coupling_upper = newton->full_upper,
                                     .coupling_lower = newton->full_lower,
                                     .joint = equations->assembly.C,
                                     .joint_b = equations->assembly.C};
    se3di_kkt_solve_info info = {0};
    ++equations->counters.factorizations;
    ++equations->counters.solves;
    SE3DI_TRY(se3di_kkt_factor(newton->full, &values, NULL));
    se3d_status status =
        se3di_kkt_solve(newton->full, &values, rho, c, dq, newton->reaction, &info);
    return status == SE3D_ERR_NO_CONVERGENCE && !(info.residual_b > 1e-3) ? SE3D_OK : status;
}

double se3di_static_newton_measure(const se3di_static_newton *newton, double s, const double *dq)
{
    double sum = 0.0;
    for (size_t k = 0; k < newton->equations->assembly.unknown_count; ++k) {
        sum += shift_of(newton, k / 6, s, k % 6) * dq[k] * dq[k];
    }
    return sum;
}
