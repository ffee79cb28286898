/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/modes.h"

#include "analysis/lowest_modes.h"
#include "analysis/steady.h"
#include "force/driver_rate.h"
#include "linsol/dense.h"
#include "math/elementary.h"
#include "math/vec3.h"
#include "nonlinear/ranks.h"

#include <math.h>
#include <string.h>

#define MODES_ARRAYS 10
#define OPEN         1e-3 /* violation, relative to the size of the mechanism, that is refused */

static void list_arrays(se3di_modes *m, se3di_array list[MODES_ARRAYS])
{
    size_t f = m->is_sparse ? 0 : m->f;
    const se3di_array arrays[] = {
        {(void **)&m->M, f * f, sizeof *m->M},
        {(void **)&m->D, f * f, sizeof *m->D},
        {(void **)&m->K, f * f, sizeof *m->K},
        {(void **)&m->Z, f * m->n, sizeof *m->Z},
        {(void **)&m->b, m->inputs * f, sizeof *m->b},
        {(void **)&m->c, m->outputs * f, sizeof *m->c},
        {(void **)&m->A, 4 * f * f, sizeof *m->A},
        {(void **)&m->B, m->inputs * 2 * f, sizeof *m->B},
        {(void **)&m->rotation, m->bodies * 9, sizeof *m->rotation},
        {(void **)&m->largest, m->is_sparse ? 2 * (size_t)m->eigen.room : 4 * f,
         sizeof *m->largest},
    };
    _Static_assert(sizeof arrays == MODES_ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

void se3di_modes_destroy(se3di_modes *modes)
{
    const se3d_allocator *allocator = &modes->allocator;
    se3di_array arrays[MODES_ARRAYS];
    list_arrays(modes, arrays);
    se3di_arrays_free(allocator, arrays, MODES_ARRAYS);
    se3di_free(allocator, modes->quantity, modes->outputs, sizeof *modes->quantity);
    se3di_free(allocator, modes->free, modes->bodies, sizeof *modes->free);
    se3di_eigen_destroy(allocator, &modes->eigen);
}

static se3d_status allocate(se3di_modes *m)
{
    se3di_array arrays[MODES_ARRAYS];
    list_arrays(m, arrays);
    SE3DI_TRY(se3di_arrays_alloc(&m->allocator, arrays, MODES_ARRAYS));
    m->quantity = se3di_alloc(&m->allocator, m->outputs, sizeof *m->quantity);
    m->free = se3di_alloc(&m->allocator, m->bodies, sizeof *m->free);
    return m->quantity && m->free ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

/* row [f] = Z g */
static void fill_row(const se3di_linear *linear, const se3di_modes_port *port, double *row)
{
    const se3di_assembly *assembly = &linear->equations->assembly;
    const int32_t free = assembly->free_index[port->body];
    double g[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
    double local[3];
    se3di_mul_transposed(assembly->model->frames[port->body].A, port->direction, local);
    if (port->turns) {
        se3di_copy(local, g + 3);
    } else {
        se3di_copy(local, g);
        se3di_cross(port->point, local, g + 3);
    }
    for (size_t r = 0; r < (size_t)linear->freedoms; ++r) {
        row[r] = 0.0;
        for (size_t c = 0; c < 6 && free >= 0; ++c) {
            row[r] += linear->Z[r * (size_t)linear->n + 6 * (size_t)free + c] * g[c];
        }
    }
}

/* A = [0 I; -M^-1 K, -M^-1 D], B = [0; M^-1 b], column by column. */
static se3d_status fill_state_space(se3di_modes *m)
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

/* x [6] of one body, ground frame, of a real shape. */
static void expand(const se3di_modes *m, const double *y, size_t body, double x[6])
{
    if (m->is_sparse) {
        const double none[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
        const double *own = m->free[body] < 0 ? none : y + 6 * (size_t)m->free[body];
        se3di_copy(own, x);
        se3di_mul(m->rotation + 9 * body, own + 3, x + 3);
        return;
    }
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
static void find_largest(const se3di_modes *m, size_t k, double scale[2])
{
    double best = 0.0;
    scale[0] = 1.0;
    scale[1] = 0.0;
    for (size_t body = 0; body < m->bodies; ++body) {
        double re[6], im[6];
        expand(m, m->eigen.y_re + k * (size_t)m->eigen.f, body, re);
        expand(m, m->eigen.y_im + k * (size_t)m->eigen.f, body, im);
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

static void keep_bodies(se3di_modes *m, const se3di_assembly *assembly)
{
    for (size_t k = 0; k < m->bodies; ++k) {
        m->free[k] = assembly->free_index[k];
        memcpy(m->rotation + 9 * k, assembly->model->frames[k].A, 9 * sizeof *m->rotation);
    }
}

static void find_all_largest(const se3di_modes *m)
{
    for (size_t k = 0; k < (size_t)m->eigen.count; ++k) {
        find_largest(m, k, m->largest + 2 * k);
    }
}

static se3d_status fill(const se3di_linear *linear, const se3di_modes_port *ports, se3di_modes *m)
{
    size_t f = m->f;
    memcpy(m->M, linear->Mr, f * f * sizeof *m->M);
    memcpy(m->D, linear->Dr, f * f * sizeof *m->D);
    memcpy(m->K, linear->Kr, f * f * sizeof *m->K);
    memcpy(m->Z, linear->Z, f * m->n * sizeof *m->Z);
    keep_bodies(m, &linear->equations->assembly);
    for (size_t k = 0; k < m->inputs; ++k) {
        fill_row(linear, &ports[k], m->b + k * f);
    }
    for (size_t k = 0; k < m->outputs; ++k) {
        fill_row(linear, &ports[m->inputs + k], m->c + k * f);
    }
    SE3DI_TRY(fill_state_space(m));
    SE3DI_TRY(se3di_eigen_solve(&m->allocator, (int32_t)f, m->M, m->D, m->K, &m->eigen));
    if (m->lowest > 0 && (size_t)m->eigen.count > m->lowest) {
        m->eigen.count = (int32_t)m->lowest;
    }
    find_all_largest(m);
    return SE3D_OK;
}

/* A mechanism whose constraints are violated has no modes. */
static se3d_status check_poses(se3di_equations *equations, double t)
{
    char gap[400];
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    if (se3di_position_measure(equations, gap, sizeof gap) <= OPEN) {
        return SE3D_OK;
    }
    return se3di_error_set(equations->error, SE3D_ERR_INCONSISTENT,
                           "t = %g s: the poses do not fit the constraints: %s; run an assembly or "
                           "an equilibrium before modes",
                           t, gap);
}

/* Only the modes that are asked for. m->is_sparse: they were found. */
static se3d_status find_lowest(se3di_modes *m, se3di_equations *equations, double t)
{
    int32_t freedoms = 0;
    SE3DI_TRY(
        se3di_lowest_modes_find(equations, t, m->lowest, &m->eigen, &freedoms, &m->is_sparse));
    if (!m->is_sparse) {
        return SE3D_OK;
    }
    m->f = (size_t)freedoms;
    m->n = equations->assembly.unknown_count;
    const se3d_status status = allocate(m);
    if (status < 0) {
        se3di_modes_destroy(m);
        return status;
    }
    keep_bodies(m, &equations->assembly);
    find_all_largest(m);
    return SE3D_OK;
}

se3d_status se3di_modes_prepare(se3di_equations *equations)
{
    const double time = equations->assembly.model->time;
    SE3DI_TRY(se3di_ranks_decide(equations, time));
    SE3DI_TRY(check_poses(equations, time));
    return se3di_acceleration_solve(equations, time);
}

/* Linearise and keep what the queries need. */
static se3d_status make(se3di_modes *m, se3di_equations *equations, const se3di_modes_port *ports,
                        const int32_t *quantity)
{
    const double time = equations->assembly.model->time;
    se3di_linear linear;
    SE3DI_TRY(se3di_modes_prepare(equations));
    if (m->lowest > 0) {
        SE3DI_TRY(find_lowest(m, equations, time));
        if (m->is_sparse) {
            return SE3D_OK;
        }
    }
    SE3DI_TRY(se3di_linear_init(&linear, equations));
    se3d_status status = se3di_steady_linearise(&linear, time);
    if (status >= 0) {
        m->f = (size_t)linear.freedoms;
        m->n = (size_t)linear.n;
        status = allocate(m);
    }
    if (status >= 0) {
        memcpy(m->quantity, quantity, m->outputs * sizeof *quantity);
        status = fill(&linear, ports, m);
    }
    if (status < 0) {
        se3di_modes_destroy(m);
    }
    se3di_linear_destroy(&linear);
    return status;
}

se3d_status se3di_modes_init(se3di_modes *modes, se3di_model *model, se3di_error *error,
                             size_t inputs, size_t outputs, const se3di_modes_port *ports,
                             const int32_t *quantity, size_t lowest)
{
    se3di_equations equations;
    *modes = (se3di_modes){.allocator = model->allocator,
                           .inputs = inputs,
                           .outputs = outputs,
                           .bodies = model->body_slots.count,
                           .lowest = lowest};
    if (se3di_find_driver_rate(model) != SE3DI_NO_INDEX) {
        return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                               "the rate of a driver follows signals: no position is held, about "
                               "which the model could be linearised");
    }
    SE3DI_TRY(se3di_equations_init(&equations, model, &se3di_formulation_romega, 0, error));
    se3di_error_clear(error);
    const se3d_status status = make(modes, &equations, ports, quantity);
    se3di_equations_destroy(&equations);
    return status;
}

void se3di_modes_shape(const se3di_modes *modes, size_t k, size_t body, double real[6],
                       double imaginary[6])
{
    double re[6], im[6];
    const double *scale = modes->largest + 2 * k;
    expand(modes, modes->eigen.y_re + k * (size_t)modes->eigen.f, body, re);
    expand(modes, modes->eigen.y_im + k * (size_t)modes->eigen.f, body, im);
    double square = scale[0] * scale[0] + scale[1] * scale[1];
    for (int c = 0; c < 6; ++c) {
        real[c] = (re[c] * scale[0] + im[c] * scale[1]) / square;
        imaginary[c] = (im[c] * scale[0] - re[c] * scale[1]) / square;
    }
}

/* Level of an output: 0 position, 1 velocity, 2 acceleration. */
static int level_of(const se3di_modes *m, size_t output)
{
    return m->quantity[output] % 3;
}

static double c_entry(const se3di_modes *m, size_t output, size_t column)
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

static double d_entry(const se3di_modes *m, size_t output, size_t input)
{
    double sum = 0.0;
    for (size_t r = 0; level_of(m, output) == 2 && r < m->f; ++r) {
        sum += m->c[output * m->f + r] * m->B[input * 2 * m->f + m->f + r];
    }
    return sum;
}

double se3di_modes_entry(const se3di_modes *m, int32_t matrix, size_t r, size_t c)
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

void se3di_modes_size(const se3di_modes *modes, int32_t matrix, size_t size[2])
{
    const size_t f = modes->f;
    const size_t sizes[8][2] = {{2 * f, 2 * f},
                                {2 * f, modes->inputs},
                                {modes->outputs, 2 * f},
                                {modes->outputs, modes->inputs},
                                {f, f},
                                {f, f},
                                {f, f},
                                {modes->n, f}};
    memcpy(size, sizes[matrix], sizeof sizes[matrix]);
}

/* (K - w^2 M + i w D) (x + i z) = b as a real system of 2 f. */
static se3d_status solve_frequency(const se3di_modes *m, size_t input, double w, double *S,
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

se3d_status se3di_modes_transfer(const se3di_modes *modes, size_t input, size_t output, double w,
                                 double h[2])
{
    size_t f = modes->f;
    size_t count = 4 * f * f + 2 * f;
    double *S = se3di_alloc(&modes->allocator, count, sizeof *S);
    int32_t *pivot = se3di_alloc(&modes->allocator, 2 * f, sizeof *pivot);
    se3d_status status = S && pivot ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    double g[2] = {0.0, 0.0};
    if (status >= 0 && f > 0) {
        double *x = S + 4 * f * f;
        status = solve_frequency(modes, input, w, S, x, pivot);
        for (size_t r = 0; status >= 0 && r < f; ++r) {
            g[0] += modes->c[output * f + r] * x[r];
            g[1] += modes->c[output * f + r] * x[f + r];
        }
    }
    se3di_free(&modes->allocator, S, count, sizeof *S);
    se3di_free(&modes->allocator, pivot, 2 * f, sizeof *pivot);
    int level = level_of(modes, output); /* times (i w)^level */
    h[0] = level == 0 ? g[0] : level == 1 ? -w * g[1] : -w * w * g[0];
    h[1] = level == 0 ? g[1] : level == 1 ? w * g[0] : -w * w * g[1];
    return status;
}
