/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/linearise.h"

#include "linsol/null_space.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define RANK_TOLERANCE 1e-9
#define LINEAR_ARRAYS  14

typedef struct linear_array {
    double **data;
    size_t count;
} linear_array;

static void list_arrays(se3di_linear *l, linear_array list[LINEAR_ARRAYS])
{
    size_t n = (size_t)l->n;
    size_t rows = (size_t)l->rows;
    const linear_array arrays[LINEAR_ARRAYS] = {
        {&l->M, n * n},    {&l->D, n * n},        {&l->K, n * n},     {&l->Z, n * n},
        {&l->Mr, n * n},   {&l->Dr, n * n},       {&l->Kr, n * n},    {&l->unit, 6 * n},
        {&l->load, n},     {&l->work, 2 * n * n}, {&l->lambda, rows}, {&l->buffer, n},
        {&l->rate, n / 2}, {&l->turn, 3 * n / 2},
    };
    memcpy(list, arrays, sizeof arrays);
}

se3d_status se3di_linear_init(se3di_linear *linear, se3di_equations *equations)
{
    const se3di_assembly *assembly = &equations->assembly;
    linear_array arrays[LINEAR_ARRAYS];
    *linear = (se3di_linear){.equations = equations,
                             .n = (int32_t)assembly->unknown_count,
                             .rows = (int32_t)assembly->row_count,
                             .own_axes = 1};
    list_arrays(linear, arrays);
    se3d_status status = se3di_tangent_init(&linear->tangent, assembly);
    for (int k = 0; k < LINEAR_ARRAYS && status >= 0; ++k) {
        *arrays[k].data = se3di_alloc(&assembly->model->allocator, arrays[k].count, sizeof(double));
        status = *arrays[k].data ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    }
    if (status < 0) {
        se3di_linear_destroy(linear);
        return se3di_error_set(equations->error, status, "no memory for dense matrices of %d",
                               (int)assembly->unknown_count);
    }
    memset(linear->unit, 0, 6 * (size_t)linear->n * sizeof *linear->unit);
    for (size_t k = 0; k < (size_t)linear->n; ++k) {
        linear->unit[6 * k + k % 6] = 1.0;
    }
    return status;
}

void se3di_linear_destroy(se3di_linear *linear)
{
    if (!linear->equations) {
        return;
    }
    const se3d_allocator *allocator = &linear->equations->assembly.model->allocator;
    linear_array arrays[LINEAR_ARRAYS];
    list_arrays(linear, arrays);
    for (int k = 0; k < LINEAR_ARRAYS; ++k) {
        se3di_free(allocator, *arrays[k].data, arrays[k].count, sizeof(double));
    }
    se3di_tangent_destroy(&linear->tangent);
    memset(linear, 0, sizeof *linear);
}

static const double *rotation_of(const se3di_linear *linear, size_t body)
{
    const se3di_assembly *assembly = &linear->equations->assembly;
    return assembly->model->frames[assembly->free_body[body]].A;
}

/* Both parts of each body of a vector over unknowns in the axes of the linearisation. */
static void to_axes(const se3di_linear *linear, double *x)
{
    for (size_t k = 0; k < (size_t)linear->n / 6; ++k) {
        double local[3];
        se3di_mul_transposed(rotation_of(linear, k), x + 6 * k, local);
        se3di_copy(local, x + 6 * k);
        for (size_t half = 0; linear->is_turned && half < 2; ++half) {
            se3di_mul_transposed(linear->turn + 9 * k, x + 6 * k + 3 * half, local);
            se3di_copy(local, x + 6 * k + 3 * half);
        }
    }
}

/* Z, from Phi_q in the assembly. */
static se3d_status find_freedoms(se3di_linear *linear)
{
    const se3di_assembly *assembly = &linear->equations->assembly;
    const se3d_allocator *allocator = &assembly->model->allocator;
    const se3di_null_space_pattern pattern = {.body_count = assembly->body_count,
                                              .joint_count = assembly->constraint_count,
                                              .joint_rows = assembly->joint_rows,
                                              .joint_begin = assembly->joint_begin,
                                              .joint_body = assembly->joint_body,
                                              .block_offset = assembly->block_offset};
    size_t n = (size_t)linear->n;
    double *Z;
    int32_t dependent;
    SE3DI_TRY(se3di_null_space_find(allocator, &pattern, assembly->C, RANK_TOLERANCE, &Z,
                                    &linear->freedoms, &dependent, NULL));
    size_t count = (size_t)linear->freedoms * n;
    for (size_t r = 0; r < (size_t)linear->freedoms; ++r) {
        to_axes(linear, Z + r * n);
    }
    se3d_status status =
        linear->rows > 0
            ? se3di_null_space_orthonormalise(allocator, linear->freedoms, linear->n, Z)
            : SE3D_OK;
    if (status >= 0 && count > 0) {
        memcpy(linear->Z, Z, count * sizeof *Z);
    }
    se3di_free(allocator, Z, count, sizeof *Z);
    return status;
}

/* The multipliers of Phi_q^T lambda = load, of least 2-norm if rows are redundant. */
static se3d_status balance(se3di_linear *linear)
{
    se3di_equations *equations = linear->equations;
    const se3di_kkt_values values = se3di_equations_values_of(equations, linear->unit);
    se3di_kkt_solve_info info = {0};
    if (linear->rows == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_kkt_factor(equations->kkt, &values, NULL));
    se3d_status status = se3di_kkt_solve(equations->kkt, &values, linear->load, NULL,
                                         linear->buffer, linear->lambda, &info);
    if (status == SE3D_ERR_NO_CONVERGENCE || info.residual_b > 1e-9) {
        memset(linear->buffer, 0, (size_t)linear->n * sizeof *linear->buffer);
        status = se3di_kkt_min_norm(equations->kkt, &values, linear->load, linear->buffer,
                                    RANK_TOLERANCE, linear->lambda, NULL);
    }
    return status < 0 ? status : SE3D_OK;
}

se3d_status se3di_linear_eval_statics(se3di_linear *linear, double t)
{
    se3di_equations *equations = linear->equations;
    se3di_assembly_eval_jacobian(&equations->assembly);
    SE3DI_TRY(find_freedoms(linear));
    SE3DI_TRY(se3di_assembly_eval_forces(&equations->assembly, t, linear->load, equations->error));
    SE3DI_TRY(balance(linear));
    to_axes(linear, linear->load);
    return SE3D_OK;
}

/* A block of the tangent into a dense matrix. */
static void place_block(double *dense, size_t n, size_t row, size_t column, const double *block)
{
    for (size_t r = 0; r < 6; ++r) {
        memcpy(dense + (6 * row + r) * n + 6 * column, block + 6 * r, 6 * sizeof *block);
    }
}

static void fill_dense(const se3di_linear *linear, double *dense, const double *body,
                       const double *upper, const double *lower)
{
    const se3di_tangent *tangent = &linear->tangent;
    size_t n = (size_t)linear->n;
    memset(dense, 0, n * n * sizeof *dense);
    for (size_t k = 0; k < n / 6; ++k) {
        place_block(dense, n, k, k, body + 36 * k);
    }
    for (size_t k = 0; upper && k < tangent->coupling_count; ++k) {
        size_t i = (size_t)tangent->coupling[2 * k];
        size_t j = (size_t)tangent->coupling[2 * k + 1];
        place_block(dense, n, i, j, upper + 36 * k);
        place_block(dense, n, j, i, lower + 36 * k);
    }
}

/* X <- E^T X E */
static void turn_matrix(const se3di_linear *linear, double *X)
{
    size_t n = (size_t)linear->n;
    double *column = linear->buffer;
    for (size_t r = 0; r < n; ++r) {
        to_axes(linear, X + r * n);
    }
    for (size_t c = 0; c < n; ++c) {
        for (size_t r = 0; r < n; ++r) {
            column[r] = X[r * n + c];
        }
        to_axes(linear, column);
        for (size_t r = 0; r < n; ++r) {
            X[r * n + c] = column[r];
        }
    }
}

/* Y columns of a body += s X columns of the body times B (3 x 3), for both halves or the first. */
static void add_columns(const se3di_linear *linear, double *Y, const double *X, size_t column,
                        double s, const double B[9])
{
    size_t n = (size_t)linear->n;
    for (size_t r = 0; r < n; ++r) {
        double product[3];
        se3di_mul_transposed(B, X + r * n + column, product);
        se3di_add_scaled(s, product, Y + r * n + column);
    }
}

/* Rates of axes, in these axes: of the body, its change, of the axes, of the axes beside the body.
 */
typedef struct axes_rates {
    double w[3], wdot[3], W[9], T[9];
} axes_rates;

static axes_rates get_rates(const se3di_linear *linear, size_t k)
{
    const se3di_model *model = linear->equations->assembly.model;
    const uint32_t body = linear->equations->assembly.free_body[k];
    const double *rate = linear->rate + 3 * k;
    axes_rates rates;
    double beside[3];
    se3di_copy(model->frames[body].w, rates.w);
    se3di_copy(model->acceleration + 6 * body + 3, rates.wdot);
    if (linear->is_turned) {
        se3di_mul_transposed(linear->turn + 9 * k, model->frames[body].w, rates.w);
        se3di_mul_transposed(linear->turn + 9 * k, model->acceleration + 6 * body + 3, rates.wdot);
    }
    for (int c = 0; c < 3; ++c) {
        beside[c] = linear->own_axes ? 0.0 : rate[c] - rates.w[c];
    }
    se3di_tilde(linear->own_axes ? rates.w : rate, rates.W);
    se3di_tilde(beside, rates.T);
    return rates;
}

/* Of rotations: dw = s' + W s, dwdot = s'' + (W + T) s' + (T W + Wdot) s. */
static void add_rotation(se3di_linear *linear, size_t k, const axes_rates *rates)
{
    const size_t column = 6 * k + 3;
    double turn[9];
    double change[9];
    for (int e = 0; e < 9; ++e) {
        turn[e] = rates->W[e] + rates->T[e];
    }
    if (linear->own_axes) {
        se3di_tilde(rates->wdot, change);
    } else {
        se3di_mat_mul(rates->T, rates->W, change);
    }
    add_columns(linear, linear->K, linear->D, column, 1.0, rates->W);
    add_columns(linear, linear->K, linear->M, column, 1.0, change);
    add_columns(linear, linear->D, linear->M, column, 1.0, turn);
}

/* Of translations: dv = s' + W s, dvdot = s'' + 2 W s' + (W W + Wdot) s. */
static void add_translation(se3di_linear *linear, size_t k, const axes_rates *rates)
{
    const size_t column = 6 * k;
    double WW[9];
    double Wdot[9];
    se3di_tilde(rates->wdot, Wdot);
    se3di_mat_mul(rates->W, rates->W, WW);
    add_columns(linear, linear->K, linear->D, column, 1.0, rates->W);
    if (linear->own_axes) {
        add_columns(linear, linear->K, linear->M, column, 1.0, Wdot);
    }
    add_columns(linear, linear->D, linear->M, column, 2.0, rates->W);
    add_columns(linear, linear->K, linear->M, column, 1.0, WW);
}

/* The rates of the axes: K first (it needs the old D), then D. */
static void add_motion(se3di_linear *linear)
{
    for (size_t k = 0; k < (size_t)linear->n / 6; ++k) {
        const axes_rates rates = get_rates(linear, k);
        add_translation(linear, k, &rates);
        add_rotation(linear, k, &rates);
    }
}

/* out += s x, [count] */
static void add_row(size_t count, double s, const double *x, double *out)
{
    for (size_t k = 0; k < count; ++k) {
        out[k] += s * x[k];
    }
}

/* out [f f] = Z X Z^T; most of X is zero. */
static void reduce(const se3di_linear *linear, const double *X, double *work, double *out)
{
    size_t n = (size_t)linear->n;
    size_t f = (size_t)linear->freedoms;
    double *turned = work + n * f; /* Z^T */
    for (size_t r = 0; r < f; ++r) {
        for (size_t c = 0; c < n; ++c) {
            turned[c * f + r] = linear->Z[r * n + c];
        }
    }
    memset(work, 0, n * f * sizeof *work);
    for (size_t k = 0; k < n * n; ++k) { /* work [n f] = X Z^T */
        if (fabs(X[k]) > 0.0 || isnan(X[k])) {
            add_row(f, X[k], turned + k % n * f, work + k / n * f);
        }
    }
    memset(out, 0, f * f * sizeof *out);
    for (size_t k = 0; k < n; ++k) {
        for (size_t r = 0; r < f; ++r) {
            add_row(f, turned[k * f + r], work + k * f, out + r * f);
        }
    }
}

se3d_status se3di_linear_eval_matrices(se3di_linear *linear, double t, const double *vdot,
                                       const double *lambda)
{
    se3di_tangent *tangent = &linear->tangent;
    SE3DI_TRY(se3di_tangent_eval(tangent, t, vdot, lambda, linear->equations->error));
    const int coupled = linear->equations->assembly.armature_count > 0;
    fill_dense(linear, linear->M, tangent->M, coupled ? tangent->M_upper : NULL, tangent->M_lower);
    fill_dense(linear, linear->D, tangent->D, tangent->D_upper, tangent->D_lower);
    fill_dense(linear, linear->K, tangent->K, tangent->K_upper, tangent->K_lower);
    turn_matrix(linear, linear->M);
    turn_matrix(linear, linear->D);
    turn_matrix(linear, linear->K);
    add_motion(linear);
    reduce(linear, linear->M, linear->work, linear->Mr);
    reduce(linear, linear->D, linear->work, linear->Dr);
    reduce(linear, linear->K, linear->work, linear->Kr);
    return SE3D_OK;
}
