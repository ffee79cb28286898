/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/lowest_modes.h"

#include "assembly/tangent.h"
#include "base/error.h"
#include "linsol/eigen.h"
#include "linsol/kkt.h"

#include <math.h>
#include <string.h>

#define TIGHT   1e-12 /* residual of a mode, relative to its theta */
#define LOOSE   1e-2  /* to choose the shift */
#define NOTHING 1e-11 /* of the shift: such mu are zero */
#define SKEW    1e-9  /* part of a mode that unsymmetric stiffness may add */
#define ARRAYS  10

enum { EXTRA = 30, AT_ONCE = 16, STEPS_PER_VECTOR = 40, LOOK_EVERY = 6, TRIES = 8, BLOCK = 36 };

typedef struct lanczos {
    se3di_equations *equations;
    const se3di_assembly *assembly;
    const se3d_allocator *allocator;
    se3di_tangent tangent;
    se3di_kkt *kkt;
    size_t n, want, room, used; /* unknowns, modes, vectors that there is room for, of the basis */
    size_t next;                /* of the basis, whose image is no part of it yet */
    size_t near;                /* Ritz values that are listed by |mu| */
    double sigma, scale;        /* shift; size of the spectrum */
    double *body, *upper;       /* K - sigma M */
    double *V, *MV, *W;         /* [room + 1][n] basis, times M, under the operator */
    double *T, *theta;          /* [room room] its projection, then Ritz vectors; Ritz values */
    double *mu;                 /* [room] of Ritz values by |mu| */
    double *work, *l;           /* [2 n], [rows] */
    size_t *order;              /* [room] */
    uint64_t seed;
} lanczos;

/* ---- matrices ---------------------------------------------------------------------------------*/

static void add_block(const double *block, int transposed, double s, const double *x, double *out)
{
    for (int r = 0; r < 6; ++r) {
        double sum = 0.0;
        for (int c = 0; c < 6; ++c) {
            sum += block[transposed ? 6 * c + r : 6 * r + c] * x[c];
        }
        out[r] += s * sum;
    }
}

/* out = M x */
static void multiply_mass(const lanczos *z, const double *x, double *out)
{
    const se3di_tangent *g = &z->tangent;
    memset(out, 0, z->n * sizeof *out);
    for (size_t k = 0; k < z->assembly->body_count; ++k) {
        add_block(g->M + BLOCK * k, 0, 1.0, x + 6 * k, out + 6 * k);
    }
    for (size_t k = 0; z->assembly->armature_count > 0 && k < g->coupling_count; ++k) {
        const size_t i = 6 * (size_t)g->coupling[2 * k], j = 6 * (size_t)g->coupling[2 * k + 1];
        add_block(g->M_upper + BLOCK * k, 0, 1.0, x + j, out + i);
        add_block(g->M_upper + BLOCK * k, 1, 1.0, x + i, out + j);
    }
}

/* out = (K - K^T) x / 2 */
static void multiply_skew(const lanczos *z, const double *x, double *out)
{
    const se3di_tangent *g = &z->tangent;
    memset(out, 0, z->n * sizeof *out);
    for (size_t k = 0; k < z->assembly->body_count; ++k) {
        add_block(g->K + BLOCK * k, 0, 0.5, x + 6 * k, out + 6 * k);
        add_block(g->K + BLOCK * k, 1, -0.5, x + 6 * k, out + 6 * k);
    }
    for (size_t k = 0; k < g->coupling_count; ++k) {
        const size_t i = 6 * (size_t)g->coupling[2 * k], j = 6 * (size_t)g->coupling[2 * k + 1];
        add_block(g->K_upper + BLOCK * k, 0, 0.5, x + j, out + i);
        add_block(g->K_lower + BLOCK * k, 1, -0.5, x + j, out + i);
        add_block(g->K_lower + BLOCK * k, 0, 0.5, x + i, out + j);
        add_block(g->K_upper + BLOCK * k, 1, -0.5, x + i, out + j);
    }
}

/* The symmetric part of K, less sigma M. */
static void fill(lanczos *z, double sigma)
{
    const se3di_tangent *g = &z->tangent;
    for (size_t k = 0; k < z->assembly->body_count; ++k) {
        const double *K = g->K + BLOCK * k, *M = g->M + BLOCK * k;
        for (size_t e = 0; e < BLOCK; ++e) {
            z->body[BLOCK * k + e] = 0.5 * (K[e] + K[6 * (e % 6) + e / 6]) - sigma * M[e];
        }
    }
    for (size_t k = 0; k < g->coupling_count; ++k) {
        const double *U = g->K_upper + BLOCK * k, *L = g->K_lower + BLOCK * k;
        for (size_t e = 0; e < BLOCK; ++e) {
            z->upper[BLOCK * k + e] = 0.5 * (U[e] + L[6 * (e % 6) + e / 6]);
            if (z->assembly->armature_count > 0) {
                z->upper[BLOCK * k + e] -= sigma * g->M_upper[BLOCK * k + e];
            }
        }
    }
}

static se3di_kkt_values values_of(const lanczos *z)
{
    return (se3di_kkt_values){.body = z->body, .coupling_upper = z->upper, .joint = z->assembly->C};
}

/* Factor with a shift. *below: how many mu are below it. */
static se3d_status factor(lanczos *z, double sigma, int32_t *below)
{
    se3di_kkt_factor_info info = {0};
    fill(z, sigma);
    const se3di_kkt_values values = values_of(z);
    const se3d_status status = se3di_kkt_factor(z->kkt, &values, &info);
    *below = info.negative_freedoms;
    return status;
}

/* y = the operator of what M x is. @return false: the factors are too bad */
static bool apply(lanczos *z, const double *Mx, double *y)
{
    const se3di_kkt_values values = values_of(z);
    se3di_kkt_solve_info info = {0};
    const se3d_status status = se3di_kkt_solve(z->kkt, &values, Mx, NULL, y, z->l, &info);
    return status >= 0 && !(info.residual_b > 1e-12) && !(info.residual_c > 1e-12);
}

/* ---- the basis --------------------------------------------------------------------------------*/

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t k = 0; k < n; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

static void add(size_t n, double s, const double *a, double *b)
{
    for (size_t k = 0; k < n; ++k) {
        b[k] += s * a[k];
    }
}

/* Make V[used] a direction beside the basis. @return false: it has no such part */
static bool orthonormalise(lanczos *z)
{
    const size_t n = z->n, m = z->used;
    double *v = z->V + m * n, *Mv = z->MV + m * n;
    multiply_mass(z, v, Mv);
    const double before = sqrt(fmax(dot(n, v, Mv), 0.0));
    for (int pass = 0; pass < 3; ++pass) {
        for (size_t k = 0; k < m; ++k) {
            add(n, -dot(n, z->MV + k * n, v), z->V + k * n, v);
        }
    }
    multiply_mass(z, v, Mv);
    const double size = sqrt(fmax(dot(n, v, Mv), 0.0));
    if (!(size > 1e-10 * before) || !(size > 0.0)) {
        return false;
    }
    for (size_t k = 0; k < n; ++k) {
        v[k] /= size;
        Mv[k] /= size;
    }
    return true;
}

/* A direction by chance that meets the constraints. */
static bool draw(lanczos *z)
{
    double *v = z->V + z->used * z->n;
    for (int tries = 0; tries < 3; ++tries) {
        for (size_t k = 0; k < z->n; ++k) {
            z->seed ^= z->seed >> 12;
            z->seed ^= z->seed << 25;
            z->seed ^= z->seed >> 27;
            z->work[k] = (double)(z->seed >> 11) * 0x1p-52 - 1.0;
        }
        multiply_mass(z, z->work, z->work + z->n);
        if (!apply(z, z->work + z->n, v)) {
            return false;
        }
        if (orthonormalise(z)) {
            return true;
        }
    }
    return false;
}

/* V[used] becomes one of the basis, with its row of T. @return false: the factors are too bad */
static bool take(lanczos *z)
{
    const size_t n = z->n, m = z->used;
    double *w = z->W + m * n;
    if (!apply(z, z->MV + m * n, w)) {
        return false;
    }
    z->used = m + 1;
    for (size_t k = 0; k <= m; ++k) {
        z->T[k * z->room + m] = z->T[m * z->room + k] = dot(n, z->MV + k * n, w);
    }
    return true;
}

/* One more of the basis: an image of what is there, or, if all are within it, one by chance. *ends:
 * the basis is all there is. @return false: the factors are too bad */
static bool grow(lanczos *z, bool *ends)
{
    while (z->next < z->used) {
        memcpy(z->V + z->used * z->n, z->W + z->next++ * z->n, z->n * sizeof *z->V);
        if (orthonormalise(z)) {
            return take(z);
        }
    }
    *ends = !draw(z);
    return *ends || take(z);
}

/* Ritz values and vectors of the basis, listed by |mu|. S [used used] */
static se3d_status find_ritz(lanczos *z, double *S)
{
    const size_t m = z->used;
    for (size_t r = 0; r < m; ++r) {
        memcpy(S + r * m, z->T + r * z->room, m * sizeof *S);
    }
    const se3d_status status = se3di_symmetric_eigen(z->allocator, (int32_t)m, S, z->theta);
    z->near = 0;
    for (size_t k = 0; status >= 0 && k < m; ++k) {
        if (!(fabs(z->theta[k]) > 0.0)) {
            continue;
        }
        const double mu = z->sigma + 1.0 / z->theta[k];
        size_t at = z->near++;
        for (; at > 0 && fabs(z->mu[at - 1]) > fabs(mu); --at) {
            z->mu[at] = z->mu[at - 1];
            z->order[at] = z->order[at - 1];
        }
        z->mu[at] = mu;
        z->order[at] = k;
    }
    return status;
}

/* x = the Ritz vector k of S times the columns of V or W */
static void combine(const lanczos *z, const double *S, const double *columns, size_t k, double *x)
{
    memset(x, 0, z->n * sizeof *x);
    for (size_t i = 0; i < z->used; ++i) {
        add(z->n, S[k * z->used + i], columns + i * z->n, x);
    }
}

/* |Op x - theta x| / |theta| of a Ritz vector, in the norm of M. */
static double residual(lanczos *z, const double *S, size_t k)
{
    double *r = z->work, *Mr = z->work + z->n;
    combine(z, S, z->W, k, r);
    for (size_t i = 0; i < z->used; ++i) {
        add(z->n, -z->theta[k] * S[k * z->used + i], z->V + i * z->n, r);
    }
    multiply_mass(z, r, Mr);
    return sqrt(fmax(dot(z->n, r, Mr), 0.0)) / fabs(z->theta[k]);
}

static bool have_converged(lanczos *z, const double *S, double tolerance)
{
    for (size_t k = z->want; k-- > 0;) {
        if (k >= z->near || !(residual(z, S, z->order[k]) <= tolerance)) {
            return false;
        }
    }
    return true;
}

/* The basis becomes the best of its Ritz vectors. */
static se3d_status condense(lanczos *z, double *S, size_t keep)
{
    const size_t n = z->n;
    double *made = se3di_alloc(z->allocator, 3 * keep * n + 1, sizeof *made);
    if (!made) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < keep; ++k) {
        combine(z, S, z->V, z->order[k], made + k * n);
        combine(z, S, z->MV, z->order[k], made + (keep + k) * n);
        combine(z, S, z->W, z->order[k], made + (2 * keep + k) * n);
    }
    memcpy(z->V, made, keep * n * sizeof *made);
    memcpy(z->MV, made + keep * n, keep * n * sizeof *made);
    memcpy(z->W, made + 2 * keep * n, keep * n * sizeof *made);
    se3di_free(z->allocator, made, 3 * keep * n + 1, sizeof *made);
    z->used = keep;
    z->next = 0;
    for (size_t r = 0; r < keep; ++r) {
        for (size_t c = 0; c < keep; ++c) {
            z->T[r * z->room + c] = dot(n, z->MV + r * n, z->W + c * n);
        }
    }
    return SE3D_OK;
}

/* ---- the search -------------------------------------------------------------------------------*/

/* Some directions by chance: as many modes of one frequency can be found. @return false: there are
 * none, or the factors are too bad */
static bool draw_some(lanczos *z)
{
    bool went = true;
    for (size_t k = 0; k < AT_ONCE && k <= z->want && z->used < z->room && went; ++k) {
        went = draw(z) && take(z);
    }
    return z->used > 0;
}

/* Go on until the wanted ones are there. S has them then. *went: whether they are. */
static se3d_status search(lanczos *z, double tolerance, double *S, bool *went)
{
    *went = false;
    for (size_t steps = 0; steps < STEPS_PER_VECTOR * z->room; ++steps) {
        bool ends = false;
        const bool is_full = z->used == z->room;
        if (is_full || z->used % LOOK_EVERY == 0) {
            se3d_status status = find_ritz(z, S);
            if (status < 0 || have_converged(z, S, tolerance)) {
                *went = status >= 0;
                return status;
            }
            const size_t keep = z->want + EXTRA / 2 < z->near ? z->want + EXTRA / 2 : z->near;
            status = is_full ? condense(z, S, keep) : SE3D_OK;
            if (status < 0) {
                return status;
            }
        }
        if (!grow(z, &ends)) {
            return SE3D_OK;
        }
        if (ends) { /* all modes of the model */
            const se3d_status status = find_ritz(z, S);
            *went = status >= 0 && z->near > 0;
            return status;
        }
    }
    return SE3D_OK;
}

/* Anew with a shift. */
static se3d_status begin(lanczos *z, double sigma, double tolerance, double *S, bool *went)
{
    int32_t below = 0;
    *went = false;
    z->sigma = sigma;
    z->used = z->next = 0;
    z->seed = UINT64_C(0x9E3779B97F4A7C15);
    const se3d_status status = factor(z, sigma, &below);
    return status < 0 || !draw_some(z) ? SE3D_OK : search(z, tolerance, S, went);
}

static double wanted_size(const lanczos *z)
{
    return fabs(z->mu[z->want < z->near ? z->want - 1 : z->near - 1]);
}

/* Whether none is missing below the last one that is wanted; of those that are as large as it any
 * will do. */
static bool is_whole(lanczos *z)
{
    const double radius = (1.0 - 1e-8) * wanted_size(z) - NOTHING * fabs(z->sigma);
    size_t inside = 0;
    int32_t above = 0, below = 0;
    while (inside < z->near && fabs(z->mu[inside]) < radius) {
        ++inside;
    }
    return !(radius > 0.0) || (factor(z, radius, &above) >= 0 && factor(z, -radius, &below) >= 0 &&
                               above - below == (int32_t)inside);
}

/* Unsymmetric stiffness does nothing to the modes, neither within them nor beside. */
static bool are_symmetric(lanczos *z, const double *S)
{
    const size_t n = z->n;
    double *x = z->V + z->used * n, *y = z->MV + z->used * n;
    int32_t below = 0;
    if (factor(z, z->sigma, &below) < 0) {
        return false;
    }
    for (size_t k = 0; k < z->want && k < z->near; ++k) {
        combine(z, S, z->V, z->order[k], x);
        multiply_skew(z, x, z->work);
        if (!(dot(n, z->work, z->work) > 0.0)) {
            continue;
        }
        if (!apply(z, z->work, y)) {
            return false;
        }
        multiply_mass(z, y, z->work);
        if (!(dot(n, y, z->work) <= SKEW * SKEW)) {
            return false;
        }
    }
    return true;
}

static bool is_at_rest(const lanczos *z)
{
    const se3di_tangent *g = &z->tangent;
    bool rests = true;
    for (size_t k = 0; k < z->assembly->body_count && rests; ++k) {
        const se3di_frame *frame = &z->assembly->model->frames[z->assembly->free_body[k]];
        rests = !(dot(3, frame->w, frame->w) > 0.0) &&
                !(dot(BLOCK, g->D + BLOCK * k, g->D + BLOCK * k) > 0.0);
    }
    for (size_t k = 0; k < g->coupling_count && rests; ++k) {
        rests = !(dot(BLOCK, g->D_upper + BLOCK * k, g->D_upper + BLOCK * k) > 0.0) &&
                !(dot(BLOCK, g->D_lower + BLOCK * k, g->D_lower + BLOCK * k) > 0.0);
    }
    return rests;
}

/* The largest square of a frequency that an unknown would have alone. */
static double find_scale(const lanczos *z)
{
    const se3di_tangent *g = &z->tangent;
    double scale = 0.0;
    for (size_t k = 0; k < z->n; ++k) {
        const size_t e = BLOCK * (k / 6) + 7 * (k % 6);
        if (g->M[e] > 0.0) {
            scale = fmax(scale, fabs(g->K[e]) / g->M[e]);
        }
    }
    return scale > 0.0 ? scale : 1.0;
}

/* With the shift where the modes are. */
static se3d_status find_all(lanczos *z, double *S, bool *went)
{
    double sigma = -1e-4 * z->scale;
    for (int k = 0; k < 3; ++k) {
        se3d_status status = begin(z, sigma, LOOSE, S, went);
        if (status < 0 || !*went) {
            return status;
        }
        const double size = fmax(wanted_size(z), 1e-9 * z->scale);
        const bool fits = -sigma < 3.0 * size && -sigma > 0.3 * size;
        sigma = fits ? sigma : -size;
        if (fits) {
            break;
        }
    }
    se3d_status status = begin(z, sigma, TIGHT, S, went);
    for (int k = 0; k < TRIES && status >= 0 && *went;
         ++k) { /* what is missing is of the same mu */
        if (is_whole(z)) {
            *went = are_symmetric(z, S);
            return SE3D_OK;
        }
        int32_t below = 0;
        status = factor(z, sigma, &below);
        const size_t keep = z->want + EXTRA / 2 < z->near ? z->want + EXTRA / 2 : z->near;
        status = status < 0 ? status : condense(z, S, keep);
        *went = status >= 0 && draw_some(z);
        status = *went ? search(z, TIGHT, S, went) : status;
    }
    *went = false;
    return status;
}

/* ---- results ----------------------------------------------------------------------------------*/

static se3d_status give(const lanczos *z, const double *S, se3di_eigen *eigen)
{
    SE3DI_TRY(se3di_eigen_reserve(z->allocator, (int32_t)z->n, (int32_t)(2 * z->want), eigen));
    for (size_t k = 0; k < z->want && k < z->near; ++k) {
        const double mu = z->mu[k];
        const double root = fabs(mu) > NOTHING * fabs(z->sigma) ? sqrt(fabs(mu)) : 0.0;
        combine(z, S, z->V, z->order[k], z->work);
        if (mu < 0.0 && root > 0.0) {
            se3di_eigen_add(eigen, -root, 0.0, z->work, NULL);
            se3di_eigen_add(eigen, root, 0.0, z->work, NULL);
        } else {
            se3di_eigen_add(eigen, 0.0, root, z->work, NULL);
        }
    }
    eigen->count = eigen->count < (int32_t)z->want ? eigen->count : (int32_t)z->want;
    return SE3D_OK;
}

static void list_arrays(lanczos *z, se3di_array list[ARRAYS])
{
    const size_t n = z->n, room = z->room;
    const se3di_array arrays[] = {
        {(void **)&z->body, 6 * n, sizeof(double)},
        {(void **)&z->upper, BLOCK * z->tangent.coupling_count + 1, sizeof(double)},
        {(void **)&z->V, (room + 1) * n, sizeof(double)},
        {(void **)&z->MV, (room + 1) * n, sizeof(double)},
        {(void **)&z->W, (room + 1) * n, sizeof(double)},
        {(void **)&z->T, 2 * room * room, sizeof(double)},
        {(void **)&z->theta, 2 * room, sizeof(double)},
        {(void **)&z->work, 2 * n, sizeof(double)},
        {(void **)&z->l, z->assembly->row_count + 1, sizeof(double)},
        {(void **)&z->order, room, sizeof(size_t)},
    };
    _Static_assert(sizeof arrays == ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static se3d_status create_kkt(lanczos *z)
{
    const se3di_assembly *assembly = z->assembly;
    const se3di_kkt_pattern pattern = {
        .body_count = assembly->body_count,
        .joint_count = assembly->constraint_count,
        .coupling_count = z->tangent.coupling_count,
        .joint_rows = assembly->joint_rows,
        .joint_begin = assembly->joint_begin,
        .joint_body = assembly->joint_body,
        .coupling = z->tangent.coupling,
        .body_size = 6,
        .symmetric = true,
        .body_kind = SE3DI_KKT_BODY_FULL,
    };
    SE3DI_TRY(se3di_kkt_create(z->allocator, &pattern, SE3DI_KKT_STRUCTURED, assembly->model->shelf,
                               &z->kkt));
    se3di_kkt_settings settings = se3di_kkt_get_settings(z->kkt);
    settings.any_multipliers = true;
    settings.always_check = true;
    se3di_kkt_set_settings(z->kkt, &settings);
    return SE3D_OK;
}

/* The tangent at the present state. */
static se3d_status evaluate(lanczos *z, double t)
{
    se3di_equations *equations = z->equations;
    se3di_assembly_eval_jacobian(&equations->assembly);
    SE3DI_TRY(se3di_assembly_eval_forces(&equations->assembly, t, z->work, equations->error));
    se3di_assembly_get_acceleration(&equations->assembly, equations->x);
    return se3di_tangent_eval(&z->tangent, t, equations->x, equations->assembly.model->lambda,
                              equations->error);
}

static se3d_status run(lanczos *z, double t, se3di_eigen *eigen, int32_t *freedoms, int32_t *found)
{
    bool went = false;
    double *S = z->T + z->room * z->room;
    z->mu = z->theta + z->room;
    SE3DI_TRY(evaluate(z, t));
    if (!is_at_rest(z)) {
        return SE3D_OK;
    }
    SE3DI_TRY(create_kkt(z));
    z->scale = find_scale(z);
    SE3DI_TRY(find_all(z, S, &went));
    if (went) {
        SE3DI_TRY(factor(z, 1e8 * z->scale, freedoms)); /* all modes are below */
        SE3DI_TRY(give(z, S, eigen));
        *found = 1;
    }
    return SE3D_OK;
}

se3d_status se3di_lowest_modes_find(se3di_equations *equations, double t, size_t count,
                                    se3di_eigen *eigen, int32_t *freedoms, int32_t *found)
{
    lanczos z = {.equations = equations,
                 .assembly = &equations->assembly,
                 .allocator = &equations->assembly.model->allocator,
                 .n = equations->assembly.unknown_count,
                 .want = count,
                 .room = 2 * count + EXTRA};
    *found = 0;
    if (count > z.n || 10 * count + 10 * EXTRA > z.n) {
        return SE3D_OK; /* no less work than all modes */
    }
    SE3DI_TRY(se3di_tangent_init(&z.tangent, z.assembly));
    se3di_array arrays[ARRAYS];
    list_arrays(&z, arrays);
    se3d_status status = se3di_arrays_alloc(z.allocator, arrays, ARRAYS);
    status = status < 0 ? status : run(&z, t, eigen, freedoms, found);
    se3di_kkt_destroy(z.kkt);
    se3di_arrays_free(z.allocator, arrays, ARRAYS);
    se3di_tangent_destroy(&z.tangent);
    return status;
}
