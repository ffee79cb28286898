/* SPDX-License-Identifier: BSD-3-Clause */
/* Equilibrium by Newton on the Lagrangian, on the freedoms that the constraints leave: with
 * Z of their null space, Q the applied forces and K the derivative of Phi_q^T lambda - Q,
 *
 *     rho = Z^T Z Q (what is not balanced),   Kr y = Z Q,   q moved by Z^T y, then put back on Phi
 * = 0
 *
 * Where the symmetric part of Kr has negative or no curvature its absolute value is taken, so that
 * the position moves downhill; the step is limited, and halved while rho turns against it (line
 * search without an energy, as forces need not have one). Where that does not end, every direction
 * is damped (dynamic relaxation: the implicit Euler method on a massless system with damping) until
 * it does. The curvature at the end tells stable from unstable.  docs/theory/equilibrium.md */
#include "analysis/equilibrium.h"

#include "analysis/linearise.h"
#include "linsol/dense.h"
#include "math/vec3.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define ITERATIONS      120 /* of each round */
#define ROUNDS          3   /* Newton, then damped twice */
#define TURN_MAX        0.5 /* rad in one step */
#define CURVATURE_FLOOR 1e-10
#define LOAD_ROUNDING   1e-13 /* of the largest load or multiplier */

typedef struct statics {
    se3di_equations *equations;
    se3di_linear linear;
    double t;
    double size;    /* of the mechanism [m] */
    double *rho;    /* [n] unbalanced force, body axes */
    double *step;   /* [n] body axes */
    double *zero;   /* [n] accelerations */
    double *w, *V;  /* eigenvalues and vectors of Kr */
    double *y, *r;  /* [f] */
    double *LU;     /* [f f] */
    int32_t *pivot; /* [f] */
    double lowest;  /* the smallest eigenvalue relative to the largest */
    double damping; /* relative to the largest eigenvalue */
} statics;

static double model_size(const se3di_model *model)
{
    double size = 1e-3;
    for (size_t k = 0; k < model->term_count; ++k) {
        size = fmax(size, fmax(se3di_norm(model->terms[k].s_i), se3di_norm(model->terms[k].s_j)));
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        size = fmax(size, fmax(se3di_norm(model->forces[k].s_i), se3di_norm(model->forces[k].s_j)));
        size = fmax(size, model->forces[k].coordinate == SE3DI_FORCE_LENGTH
                              ? fabs(model->forces[k].rest)
                              : 0.0);
    }
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        size = fmax(size, se3di_norm(model->frames[k].r));
    }
    return size;
}

static void release(statics *s)
{
    const se3d_allocator *allocator = &s->equations->assembly.model->allocator;
    size_t n = (size_t)s->equations->assembly.unknown_count;
    se3di_free(allocator, s->rho, 7 * n + 2 * n * n, sizeof(double));
    se3di_free(allocator, s->pivot, n, sizeof *s->pivot);
    se3di_linear_destroy(&s->linear);
}

static se3d_status allocate(statics *s)
{
    const se3d_allocator *allocator = &s->equations->assembly.model->allocator;
    size_t n = (size_t)s->equations->assembly.unknown_count;
    SE3DI_TRY(se3di_linear_init(&s->linear, s->equations));
    s->rho = se3di_alloc(allocator, 7 * n + 2 * n * n, sizeof(double));
    s->pivot = se3di_alloc(allocator, n, sizeof *s->pivot);
    if (!s->rho || !s->pivot) {
        release(s);
        return se3di_error_set(s->equations->error, SE3D_ERR_NO_MEMORY,
                               "no memory for the equilibrium of %zu bodies", n / 6);
    }
    s->step = s->rho + n;
    s->zero = s->rho + 2 * n;
    s->w = s->rho + 3 * n;
    s->y = s->rho + 4 * n;
    s->r = s->rho + 5 * n;
    s->V = s->rho + 7 * n;
    s->LU = s->V + n * n;
    return SE3D_OK;
}

/* Put the bodies on the constraints and evaluate what is unbalanced there. */
static se3d_status evaluate(statics *s)
{
    SE3DI_TRY(se3di_position_solve(s->equations, s->t));
    SE3DI_TRY(se3di_linear_eval_statics(&s->linear, s->t));
    se3di_linear_project(&s->linear, s->linear.load, s->r);
    se3di_linear_expand(&s->linear, s->r, s->rho);
    return SE3D_OK;
}

/* y = Kr^-1 r by factors; 0 where Kr is singular. */
static int solve_exactly(statics *s)
{
    int32_t f = s->linear.freedoms;
    size_t count = (size_t)f * (size_t)f;
    memcpy(s->LU, s->linear.Kr, count * sizeof *s->LU);
    memcpy(s->y, s->r, (size_t)f * sizeof *s->y);
    if (se3di_dense_lu_factor(f, s->LU, s->pivot) < 0) {
        return 0;
    }
    se3di_dense_lu_solve(f, s->LU, s->pivot, s->y);
    return 1;
}

static double largest_of(size_t count, const double *x)
{
    double largest = 0.0;
    for (size_t k = 0; k < count; ++k) {
        largest = fmax(largest, fabs(x[k]));
    }
    return largest;
}

/* What rounding leaves unbalanced. */
static double rounding_of(const se3di_linear *linear)
{
    return LOAD_ROUNDING * fmax(largest_of((size_t)linear->n, linear->load),
                                largest_of((size_t)linear->rows, linear->lambda));
}

/* y = (|sym Kr| + damping)^-1 r in the eigenvectors. Where there is no curvature (a link of a chain
 * turns about itself) rounding must not be taken for a load: it would move the bodies for ever. */
static void solve_downhill(statics *s, double largest)
{
    size_t f = (size_t)s->linear.freedoms;
    double floor = fmax(CURVATURE_FLOOR, s->damping) * largest;
    double rounding = rounding_of(&s->linear);
    memset(s->y, 0, f * sizeof *s->y);
    for (size_t k = 0; k < f; ++k) {
        double curvature = fabs(s->w[k]) + s->damping * largest;
        double along = 0.0;
        for (size_t c = 0; c < f; ++c) {
            along += s->V[k * f + c] * s->r[c];
        }
        if (curvature <= floor && fabs(along) <= rounding) {
            continue;
        }
        along /= fmax(fmax(curvature, floor), 1e-300);
        for (size_t c = 0; c < f; ++c) {
            s->y[c] += along * s->V[k * f + c];
        }
    }
}

/* The step into s->step; its largest turn or relative shift is returned in *length. */
static se3d_status compute_step(statics *s, double *length)
{
    se3di_linear *linear = &s->linear;
    int32_t f = linear->freedoms;
    *length = 0.0;
    if (f == 0) {
        s->lowest = 0.0;
        memset(s->step, 0, (size_t)linear->n * sizeof *s->step);
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_linear_eval_matrices(linear, s->t, s->zero, linear->lambda));
    SE3DI_TRY(se3di_linear_eigen(linear, s->w, s->V));
    double largest = fmax(fabs(s->w[0]), fabs(s->w[f - 1]));
    s->lowest = largest > 0.0 ? s->w[0] / largest : 0.0;
    int exact = s->lowest > CURVATURE_FLOOR && !(s->damping > 0.0);
    if (!exact || !solve_exactly(s)) {
        solve_downhill(s, largest);
    }
    se3di_linear_expand(linear, s->y, s->step);
    for (int32_t k = 0; k < linear->n; ++k) {
        *length = fmax(*length, fabs(s->step[k]) / (k % 6 < 3 ? s->size : 1.0));
    }
    return SE3D_OK;
}

static void move(const statics *s, double fraction)
{
    const se3di_assembly *assembly = &s->equations->assembly;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        double dq[6];
        se3di_mul(frame->A, s->step + 6 * k, dq);
        se3di_copy(s->step + 6 * k + 3, dq + 3);
        for (int c = 0; c < 6; ++c) {
            dq[c] *= fraction;
        }
        assembly->formulation->move(frame, dq);
    }
}

static double work_of_step(const statics *s)
{
    double sum = 0.0;
    for (int32_t k = 0; k < s->linear.n; ++k) {
        sum += s->rho[k] * s->step[k];
    }
    return sum;
}

/* Move along the step, shortened while the unbalanced force there turns against it. */
static se3d_status search_line(statics *s, double length)
{
    double fraction = length > TURN_MAX ? TURN_MAX / length : 1.0;
    double before = work_of_step(s);
    size_t bytes = s->equations->assembly.dense_count * sizeof *s->equations->accepted;
    const se3di_assembly *assembly = &s->equations->assembly;
    memcpy(s->equations->accepted, assembly->model->frames, bytes);
    for (int halvings = 0;; ++halvings, fraction *= 0.5) {
        move(s, fraction);
        se3d_status status = evaluate(s);
        int good = status >= 0 && (length < 1e-6 || work_of_step(s) >= -0.9 * fabs(before));
        const int ends = status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_INTERRUPTED;
        if (good || ends || halvings >= 20) {
            return status;
        }
        memcpy(assembly->model->frames, s->equations->accepted, bytes);
    }
}

/* Newton until rounding; *converged tells. */
static se3d_status iterate(statics *s, int *converged)
{
    double previous = HUGE_VAL;
    *converged = 0;
    for (int k = 0; k < ITERATIONS; ++k) {
        double length;
        SE3DI_TRY(se3di_equations_ask(s->equations));
        SE3DI_TRY(compute_step(s, &length));
        ++s->equations->counters.iterations;
        if (length < 1e-15 || (length < 1e-10 && length > 0.25 * previous)) {
            *converged = 1;
            return SE3D_OK;
        }
        previous = length;
        SE3DI_TRY(search_line(s, length));
        se3di_angles_accept(s->equations->assembly.model);
    }
    return SE3D_OK;
}

static void stop_motion(const se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        se3di_frame *frame = &assembly->model->frames[assembly->free_body[k]];
        memset(frame->v, 0, sizeof frame->v);
        memset(frame->w, 0, sizeof frame->w);
        se3di_frame_update(frame);
        memset(assembly->model->acceleration + 6 * assembly->free_body[k], 0, 6 * sizeof(double));
    }
}

static se3d_status finish(const statics *s)
{
    se3di_model *model = s->equations->assembly.model;
    if (model->row_count > 0) {
        memcpy(model->lambda, s->linear.lambda, model->row_count * sizeof *model->lambda);
    }
    model->time = s->t;
    s->equations->redundant = s->linear.n - s->linear.freedoms < s->linear.rows;
    return s->lowest < -1e-9 ? SE3D_INFO_UNSTABLE : SE3D_OK;
}

static se3d_status solve(statics *s)
{
    static const double damping[ROUNDS] = {0.0, 0.03, 0.3};
    stop_motion(&s->equations->assembly);
    SE3DI_TRY(evaluate(s));
    for (int round = 0; round < ROUNDS; ++round) {
        int converged;
        s->damping = damping[round];
        SE3DI_TRY(iterate(s, &converged));
        if (s->damping > 0.0) { /* what relaxation has reached is refined */
            s->damping = 0.0;
            SE3DI_TRY(iterate(s, &converged));
        }
        if (converged) {
            return finish(s);
        }
    }
    return se3di_error_set(s->equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: no equilibrium was found in %d steps; forces may have none, "
                           "or it is too far: start nearer to it, or let damped dynamics come to "
                           "rest",
                           s->t, (2 * ROUNDS - 1) * ITERATIONS);
}

se3d_status se3di_equilibrium_solve(se3di_equations *equations, double t)
{
    statics s = {.equations = equations, .t = t};
    s.size = model_size(equations->assembly.model);
    SE3DI_TRY(allocate(&s));
    se3d_status status = solve(&s);
    release(&s);
    return status;
}
