/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: linearisation. Inputs and outputs are both vectors g over displacements in body
 * axes: a force e at s does the work g . dq, and the displacement of the point along e is g . dq,
 * g = (A^T e, s x A^T e); a torque and a rotation have g = (0, A^T e). */
#include "se3d/modes.h"

#include "analysis/linearise.h"
#include "analysis/modes.h"
#include "analysis/steady.h"
#include "linsol/dense.h"
#include "math/elementary.h"
#include "math/vec3.h"
#include "nonlinear/ranks.h"
#include "system/coordinate.h"

#include <math.h>
#include <string.h>

struct se3d_modes {
    se3d_allocator allocator;
    size_t f, n, inputs, outputs, bodies; /* bodies: dense */
    se3di_eigen eigen;
    double *M, *D, *K; /* [f f] */
    double *Z;         /* [f n], rows */
    double *b;         /* [inputs f] */
    double *c;         /* [outputs f] */
    double *A;         /* [2 f 2 f] */
    double *B;         /* [inputs 2 f], by input */
    int32_t *quantity; /* [outputs] */
    int32_t *free;     /* [bodies] -1: fixed */
    double *rotation;  /* [bodies 9] */
    double *largest;   /* [2 f 2] largest component of each mode, complex */
};

void se3d_modes_def_init(se3d_modes_def *def, size_t size)
{
    se3d_modes_def defaults = {.struct_size = size};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

#define MODES_ARRAYS 10

typedef struct modes_array {
    double **data;
    size_t count;
} modes_array;

static void list_arrays(se3d_modes *m, modes_array list[MODES_ARRAYS])
{
    size_t f = m->f;
    const modes_array arrays[MODES_ARRAYS] = {
        {&m->M, f * f},
        {&m->D, f * f},
        {&m->K, f * f},
        {&m->Z, f * m->n},
        {&m->b, m->inputs * f},
        {&m->c, m->outputs * f},
        {&m->A, 4 * f * f},
        {&m->B, m->inputs * 2 * f},
        {&m->rotation, m->bodies * 9},
        {&m->largest, 4 * f},
    };
    memcpy(list, arrays, sizeof arrays);
}

void se3d_modes_destroy(se3d_modes *modes)
{
    if (!modes) {
        return;
    }
    se3d_allocator allocator = modes->allocator;
    modes_array arrays[MODES_ARRAYS];
    list_arrays(modes, arrays);
    for (int k = 0; k < MODES_ARRAYS; ++k) {
        se3di_free(&allocator, *arrays[k].data, arrays[k].count, sizeof(double));
    }
    se3di_free(&allocator, modes->quantity, modes->outputs, sizeof *modes->quantity);
    se3di_free(&allocator, modes->free, modes->bodies, sizeof *modes->free);
    se3di_eigen_destroy(&allocator, &modes->eigen);
    se3di_free(&allocator, modes, 1, sizeof *modes);
}

static se3d_status allocate(se3d_modes *m)
{
    modes_array arrays[MODES_ARRAYS];
    list_arrays(m, arrays);
    for (int k = 0; k < MODES_ARRAYS; ++k) {
        *arrays[k].data = se3di_alloc(&m->allocator, arrays[k].count, sizeof(double));
        if (!*arrays[k].data) {
            return SE3D_ERR_NO_MEMORY;
        }
    }
    m->quantity = se3di_alloc(&m->allocator, m->outputs, sizeof *m->quantity);
    m->free = se3di_alloc(&m->allocator, m->bodies, sizeof *m->free);
    return m->quantity && m->free ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

/* Everything of the def is valid; nothing is kept. */
static se3d_status check(se3d_system *system, const se3d_modes_def *def)
{
    uint32_t body;
    double unit[3];
    if ((def->input_count > 0 && !def->inputs) || (def->output_count > 0 && !def->outputs)) {
        return SE3DI_FAIL(system, SE3D_ERR_NULL, "inputs or outputs is NULL");
    }
    for (size_t k = 0; k < def->input_count; ++k) {
        SE3DI_TRY(se3di_find_body(system, "inputs[].body", def->inputs[k].body, &body));
        SE3DI_TRY(se3di_check_finites(system, "inputs[].point", def->inputs[k].point, 3));
        SE3DI_TRY(
            se3di_check_direction(system, "inputs[].direction", def->inputs[k].direction, unit));
    }
    for (size_t k = 0; k < def->output_count; ++k) {
        const se3d_modes_output *output = &def->outputs[k];
        SE3DI_TRY(se3di_find_body(system, "outputs[].body", output->body, &body));
        SE3DI_TRY(se3di_check_finites(system, "outputs[].point", output->point, 3));
        SE3DI_TRY(se3di_check_direction(system, "outputs[].direction", output->direction, unit));
        if (output->quantity < SE3D_MODES_POSITION ||
            output->quantity > SE3D_MODES_ANGULAR_ACCELERATION) {
            return SE3DI_FAIL_OF(system, "outputs", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu].quantity = %d, must be one of se3d_modes_quantity", k,
                                 (int)output->quantity);
        }
    }
    return SE3D_OK;
}

/* row [f] = Z g */
static se3d_status fill_row(se3d_system *system, const se3di_linear *linear, se3d_body handle,
                            const double point[3], const double direction[3], int turns,
                            double *row)
{
    const se3di_assembly *assembly = &linear->equations->assembly;
    uint32_t body;
    double unit[3];
    double g[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    SE3DI_TRY(se3di_find_body(system, "body", handle, &body));
    SE3DI_TRY(se3di_check_direction(system, "direction", direction, unit));
    int32_t free = assembly->free_index[body];
    double local[3];
    se3di_mul_transposed(assembly->model->frames[body].A, unit, local);
    if (turns) {
        se3di_copy(local, g + 3);
    } else {
        se3di_copy(local, g);
        se3di_cross(point, local, g + 3);
    }
    for (size_t r = 0; r < (size_t)linear->freedoms; ++r) {
        row[r] = 0.0;
        for (size_t c = 0; c < 6 && free >= 0; ++c) {
            row[r] += linear->Z[r * (size_t)linear->n + 6 * (size_t)free + c] * g[c];
        }
    }
    return SE3D_OK;
}

/* A = [0 I; -M^-1 K, -M^-1 D], B = [0; M^-1 b], column by column. */
static se3d_status fill_state_space(se3d_modes *m)
{
    size_t f = m->f;
    size_t count = f * f + f;
    double *LU = se3di_alloc(&m->allocator, count, sizeof *LU);
    int32_t *pivot = se3di_alloc(&m->allocator, f, sizeof *pivot);
    se3d_status status = LU && pivot ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    if (status >= 0) {
        memcpy(LU, m->M, f * f * sizeof *LU);
        status = se3di_dense_lu_factor((int32_t)f, LU, pivot);
    }
    for (size_t c = 0; status >= 0 && c < 2 * f + m->inputs; ++c) {
        double *x = LU + f * f;
        for (size_t r = 0; r < f; ++r) {
            x[r] = c < f       ? -m->K[r * f + c]
                   : c < 2 * f ? -m->D[r * f + c - f]
                               : m->b[(c - 2 * f) * f + r];
        }
        se3di_dense_lu_solve((int32_t)f, LU, pivot, x);
        for (size_t r = 0; r < f; ++r) {
            if (c < 2 * f) {
                m->A[(f + r) * 2 * f + c] = x[r];
            } else {
                m->B[(c - 2 * f) * 2 * f + f + r] = x[r];
            }
        }
    }
    for (size_t r = 0; status >= 0 && r < f; ++r) {
        m->A[r * 2 * f + f + r] = 1.0;
    }
    se3di_free(&m->allocator, LU, count, sizeof *LU);
    se3di_free(&m->allocator, pivot, f, sizeof *pivot);
    return status;
}

/* x [6] of one body, ground frame, of a real vector over freedoms. */
static void expand(const se3d_modes *m, const double *y, size_t body, double x[6])
{
    double local[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    for (size_t r = 0; r < m->f && m->free[body] >= 0; ++r) {
        for (size_t c = 0; c < 6; ++c) {
            local[c] += m->Z[r * m->n + 6 * (size_t)m->free[body] + c] * y[r];
        }
    }
    se3di_mul(m->rotation + 9 * body, local, x);
    se3di_mul(m->rotation + 9 * body, local + 3, x + 3);
}

/* The largest component of mode k, as a complex number. */
static void find_largest(const se3d_modes *m, size_t k, double scale[2])
{
    double best = 0.0;
    scale[0] = 1.0;
    scale[1] = 0.0;
    for (size_t body = 0; body < m->bodies; ++body) {
        double re[6], im[6];
        expand(m, m->eigen.y_re + k * m->f, body, re);
        expand(m, m->eigen.y_im + k * m->f, body, im);
        for (int c = 0; c < 6; ++c) {
            double size = se3di_hypot(re[c], im[c]);
            if (size > best * (1.0 + 1e-9)) {
                best = size;
                scale[0] = re[c];
                scale[1] = im[c];
            }
        }
    }
}

static se3d_status fill(se3d_system *system, const se3di_linear *linear, const se3d_modes_def *def,
                        se3d_modes *m)
{
    size_t f = m->f;
    const se3di_assembly *assembly = &linear->equations->assembly;
    memcpy(m->M, linear->Mr, f * f * sizeof *m->M);
    memcpy(m->D, linear->Dr, f * f * sizeof *m->D);
    memcpy(m->K, linear->Kr, f * f * sizeof *m->K);
    memcpy(m->Z, linear->Z, f * m->n * sizeof *m->Z);
    for (size_t k = 0; k < m->bodies; ++k) {
        m->free[k] = assembly->free_index[k];
        memcpy(m->rotation + 9 * k, assembly->model->frames[k].A, 9 * sizeof *m->rotation);
    }
    for (size_t k = 0; k < m->inputs; ++k) {
        const se3d_modes_input *in = &def->inputs[k];
        SE3DI_TRY(fill_row(system, linear, in->body, in->point, in->direction, in->is_torque,
                           m->b + k * f));
    }
    for (size_t k = 0; k < m->outputs; ++k) {
        const se3d_modes_output *out = &def->outputs[k];
        m->quantity[k] = out->quantity;
        SE3DI_TRY(fill_row(system, linear, out->body, out->point, out->direction,
                           out->quantity >= SE3D_MODES_ROTATION, m->c + k * f));
    }
    SE3DI_TRY(fill_state_space(m));
    SE3DI_TRY(se3di_eigen_solve(&m->allocator, (int32_t)f, m->M, m->D, m->K, &m->eigen));
    for (size_t k = 0; k < (size_t)m->eigen.count; ++k) {
        find_largest(m, k, m->largest + 2 * k);
    }
    return SE3D_OK;
}

/* Linearise and keep what the queries need. */
static se3d_status make(se3d_system *system, se3di_equations *equations, const se3d_modes_def *def,
                        se3d_modes **out)
{
    se3di_model *model = &system->model;
    se3di_linear linear;
    SE3DI_TRY(se3di_ranks_decide(equations, model->time));
    SE3DI_TRY(se3di_acceleration_solve(equations, model->time));
    SE3DI_TRY(se3di_linear_init(&linear, equations));
    se3d_status status = se3di_steady_linearise(&linear, model->time);
    se3d_modes *modes = status >= 0 ? se3di_alloc(&model->allocator, 1, sizeof *modes) : NULL;
    status = status >= 0 && !modes ? SE3D_ERR_NO_MEMORY : status;
    if (status >= 0) {
        *modes = (se3d_modes){.allocator = model->allocator,
                              .f = (size_t)linear.freedoms,
                              .n = (size_t)linear.n,
                              .inputs = def->input_count,
                              .outputs = def->output_count,
                              .bodies = model->body_slots.count};
        status = allocate(modes);
        status = status >= 0 ? fill(system, &linear, def, modes) : status;
        if (status < 0) {
            se3d_modes_destroy(modes);
        } else {
            *out = modes;
        }
    }
    se3di_linear_destroy(&linear);
    return status;
}

static se3d_status linearise(se3d_system *system, const se3d_modes_def *def, se3d_modes **out)
{
    se3di_equations equations;
    SE3DI_TRY(se3di_equations_init(&equations, &system->model, &se3di_formulation_romega,
                                   &system->error));
    se3di_error_clear(&system->error);
    const se3d_status status = make(system, &equations, def, out);
    se3di_equations_destroy(&equations);
    return status;
}

se3d_status se3d_modes_create(se3d_system *system, const se3d_modes_def *def, se3d_modes **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    se3d_modes_def full = se3d_modes_def_default();
    if (def) {
        SE3DI_TRY(se3di_check_def(system, "modes def", def, &full, sizeof full));
    }
    SE3DI_TRY(check(system, &full));
    se3di_work_begin(system);
    const se3d_status status = se3di_work_end(system, linearise(system, &full, out));
    if (status < 0 && system->error.status != status) {
        return SE3DI_FAIL(system, status, "the linearised equations: %s",
                          se3d_status_get_text(status));
    }
    return status < 0 ? status : SE3D_OK;
}

size_t se3d_modes_count(const se3d_modes *modes)
{
    return modes ? (size_t)modes->eigen.count : 0;
}

size_t se3d_modes_count_freedoms(const se3d_modes *modes)
{
    return modes ? modes->f : 0;
}

se3d_status se3d_modes_get_eigenvalue_sized(const se3d_modes *modes, size_t k,
                                            se3d_eigenvalue *eigenvalue, size_t size)
{
    if (eigenvalue) {
        (void)se3di_sized_give(eigenvalue, size, &(se3d_eigenvalue){0.0, 0.0, 0.0, 0.0},
                               sizeof *eigenvalue);
    }
    if (!modes || !eigenvalue) {
        return SE3D_ERR_NULL;
    }
    if (k >= (size_t)modes->eigen.count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const double modulus = se3di_hypot(modes->eigen.re[k], modes->eigen.im[k]);
    const se3d_eigenvalue full = {.real = modes->eigen.re[k],
                                  .imaginary = modes->eigen.im[k],
                                  .frequency = modulus / 6.283185307179586476925286766559,
                                  .damping = modulus > 0.0 ? 0.0 - modes->eigen.re[k] / modulus
                                                           : 0.0 /* never -0 */};
    return se3di_sized_give(eigenvalue, size, &full, sizeof full);
}

se3d_status se3d_modes_get_shape(const se3d_modes *modes, size_t k, size_t body, double real[6],
                                 double imaginary[6])
{
    for (int c = 0; c < 6; ++c) {
        if (real) {
            real[c] = 0.0;
        }
        if (imaginary) {
            imaginary[c] = 0.0;
        }
    }
    if (!modes) {
        return SE3D_ERR_NULL;
    }
    if (k >= (size_t)modes->eigen.count || body >= modes->bodies) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    double re[6], im[6];
    const double *scale = modes->largest + 2 * k;
    expand(modes, modes->eigen.y_re + k * modes->f, body, re);
    expand(modes, modes->eigen.y_im + k * modes->f, body, im);
    double square = scale[0] * scale[0] + scale[1] * scale[1];
    for (int c = 0; c < 6; ++c) {
        if (real) {
            real[c] = (re[c] * scale[0] + im[c] * scale[1]) / square;
        }
        if (imaginary) {
            imaginary[c] = (im[c] * scale[0] - re[c] * scale[1]) / square;
        }
    }
    return SE3D_OK;
}

/* Level of an output: 0 position, 1 velocity, 2 acceleration. */
static int level_of(const se3d_modes *m, size_t output)
{
    return m->quantity[output] % 3;
}

static double c_entry(const se3d_modes *m, size_t output, size_t column)
{
    size_t f = m->f;
    int level = level_of(m, output);
    double sum = 0.0;
    if (level < 2) {
        size_t begin = level == 0 ? 0 : f;
        return column >= begin && column < begin + f ? m->c[output * f + column - begin] : 0.0;
    }
    for (size_t r = 0; r < f; ++r) {
        sum += m->c[output * f + r] * m->A[(f + r) * 2 * f + column];
    }
    return sum;
}

static double d_entry(const se3d_modes *m, size_t output, size_t input)
{
    double sum = 0.0;
    for (size_t r = 0; level_of(m, output) == 2 && r < m->f; ++r) {
        sum += m->c[output * m->f + r] * m->B[input * 2 * m->f + m->f + r];
    }
    return sum;
}

static double entry(const se3d_modes *m, int32_t matrix, size_t r, size_t c)
{
    size_t f = m->f;
    switch (matrix) {
    case SE3D_MODES_A:
        return m->A[r * 2 * f + c];
    case SE3D_MODES_B:
        return m->B[c * 2 * f + r];
    case SE3D_MODES_C:
        return c_entry(m, r, c);
    case SE3D_MODES_D:
        return d_entry(m, r, c);
    case SE3D_MODES_MASS:
        return m->M[r * f + c];
    case SE3D_MODES_DAMPING:
        return m->D[r * f + c];
    case SE3D_MODES_STIFFNESS:
        return m->K[r * f + c];
    default:
        return m->Z[c * m->n + r];
    }
}

se3d_status se3d_modes_get_matrix(const se3d_modes *modes, int32_t matrix, size_t *rows,
                                  size_t *columns, double *values, size_t capacity)
{
    if (rows) {
        *rows = 0;
    }
    if (columns) {
        *columns = 0;
    }
    if (!modes || !rows || !columns) {
        return SE3D_ERR_NULL;
    }
    size_t f = modes->f;
    const size_t sizes[8][2] = {{2 * f, 2 * f},
                                {2 * f, modes->inputs},
                                {modes->outputs, 2 * f},
                                {modes->outputs, modes->inputs},
                                {f, f},
                                {f, f},
                                {f, f},
                                {modes->n, f}};
    if (matrix < SE3D_MODES_A || matrix > SE3D_MODES_BASIS) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    *rows = sizes[matrix][0];
    *columns = sizes[matrix][1];
    if (values && capacity < *rows * *columns) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    for (size_t k = 0; values && k < *rows * *columns; ++k) {
        values[k] = entry(modes, matrix, k / *columns, k % *columns);
    }
    return SE3D_OK;
}

/* (K - w^2 M + i w D) (x + i z) = b as a real system of 2 f. */
static se3d_status solve_frequency(const se3d_modes *m, size_t input, double w, double *S,
                                   double *x, int32_t *pivot)
{
    size_t f = m->f;
    for (size_t r = 0; r < f; ++r) {
        for (size_t c = 0; c < f; ++c) {
            double stiffness = m->K[r * f + c] - w * w * m->M[r * f + c];
            double damping = w * m->D[r * f + c];
            S[r * 2 * f + c] = S[(f + r) * 2 * f + f + c] = stiffness;
            S[r * 2 * f + f + c] = -damping;
            S[(f + r) * 2 * f + c] = damping;
        }
        x[r] = m->b[input * f + r];
        x[f + r] = 0.0;
    }
    SE3DI_TRY(se3di_dense_lu_factor((int32_t)(2 * f), S, pivot));
    se3di_dense_lu_solve((int32_t)(2 * f), S, pivot, x);
    return SE3D_OK;
}

se3d_status se3d_modes_get_transfer(const se3d_modes *modes, size_t input, size_t output,
                                    double frequency, double *real, double *imaginary)
{
    if (real) {
        *real = 0.0;
    }
    if (imaginary) {
        *imaginary = 0.0;
    }
    if (!modes || !real || !imaginary) {
        return SE3D_ERR_NULL;
    }
    if (input >= modes->inputs || output >= modes->outputs || !isfinite(frequency)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    size_t f = modes->f;
    size_t count = 4 * f * f + 2 * f;
    double w = 6.283185307179586476925286766559 * frequency;
    double *S = se3di_alloc(&modes->allocator, count, sizeof *S);
    int32_t *pivot = se3di_alloc(&modes->allocator, 2 * f, sizeof *pivot);
    se3d_status status = S && pivot ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    double h[2] = {0.0, 0.0};
    if (status >= 0 && f > 0) {
        double *x = S + 4 * f * f;
        status = solve_frequency(modes, input, w, S, x, pivot);
        for (size_t r = 0; status >= 0 && r < f; ++r) {
            h[0] += modes->c[output * f + r] * x[r];
            h[1] += modes->c[output * f + r] * x[f + r];
        }
    }
    se3di_free(&modes->allocator, S, count, sizeof *S);
    se3di_free(&modes->allocator, pivot, 2 * f, sizeof *pivot);
    int level = level_of(modes, output); /* times (i w)^level */
    *real = level == 0 ? h[0] : level == 1 ? -w * h[1] : -w * w * h[0];
    *imaginary = level == 0 ? h[1] : level == 1 ? w * h[0] : -w * w * h[1];
    return status;
}
