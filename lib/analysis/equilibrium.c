/* SPDX-License-Identifier: BSD-3-Clause */
/* Equilibrium by a damped Newton method on the constraints: with rho the forces that they do not
 * balance,
 *
 *     (K + s W) dq + C^T dlambda = rho,  C dq = 0,      q moved by dq, then put back on Phi = 0
 *
 * The damping s (of Levenberg and Marquardt, or an implicit Euler step 1 / s of the massless damped
 * system) is raised until no freedom has negative curvature and the step is short enough to trust,
 * so that it leads downhill; and according to how well the model predicts the work done, as forces
 * need not have a potential: by the trapezoidal rule,
 *
 *     predicted  rho . dq - dq . K dq / 2      done  (rho + rho at the end) . dq / 2
 *
 * Without damping it is Newton's method. The curvature at the end tells stable, neutral and
 * unstable apart. docs/theory/equilibrium.md
 */
#include "analysis/equilibrium.h"

#include "analysis/static_newton.h"
#include "math/larger.h"
#include "math/vec3.h"
#include "nonlinear/ranks.h"
#include "primitive/turn_counter.h"

#include <math.h>
#include <string.h>

#define ITERATIONS   2000
#define TRIALS       40    /* dampings in one iteration */
#define TURN_MAX     0.5   /* rad in one step */
#define DAMPING_MIN  1e-10 /* of the largest stiffness / mass: below it none */
#define DAMPING_JUMP 1e-4  /* if there was none */
#define DAMPING_STEP 8.0
#define DAMPING_FREE 1e-7 /* so little does not shorten a step much */
#define BALANCE_MAX  1e-9 /* of the largest force, if damping does */
#define HALVINGS     3    /* of a step that leads too far from the constraints */
#define RATIO_MIN    0.05 /* of the predicted work, or the step is not taken */
#define STALLED      8    /* iterations without a better balance */

typedef struct statics {
    se3di_equations *equations;
    se3di_static_newton newton;
    double t;
    double size;    /* of the mechanism [m] */
    double *memory; /* of the next */
    double *load;   /* [n] applied forces */
    double *rho;    /* [n] what is unbalanced */
    double *step;   /* [n] */
    double *lambda; /* [rows] */
    double damping; /* s */
    double length;  /* largest turn or relative shift of the step */
    int32_t redundant;
    int32_t reserved;
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
        size = fmax(size, model->bodies[k].state == 0 ? se3di_norm(model->frames[k].r) : 0.0);
    }
    return size;
}

static size_t memory_count(const statics *s)
{
    return 3 * (size_t)s->equations->assembly.unknown_count + s->equations->assembly.row_count;
}

static void release(statics *s)
{
    const se3d_allocator *allocator = &s->equations->assembly.model->allocator;
    se3di_free(allocator, s->memory, memory_count(s), sizeof(double));
    se3di_static_newton_destroy(&s->newton);
}

static se3d_status allocate(statics *s)
{
    const se3di_assembly *assembly = &s->equations->assembly;
    const size_t n = assembly->unknown_count;
    se3d_status status = se3di_static_newton_init(&s->newton, s->equations);
    s->memory = se3di_alloc(&assembly->model->allocator, memory_count(s), sizeof(double));
    if (status < 0 || !s->memory) {
        release(s);
        return se3di_error_set(s->equations->error, SE3D_ERR_NO_MEMORY,
                               "no memory for the equilibrium of %zu bodies", n / 6);
    }
    s->load = s->memory;
    s->rho = s->memory + n;
    s->step = s->memory + 2 * n;
    s->lambda = s->memory + 3 * n;
    memset(s->lambda, 0, assembly->row_count * sizeof(double));
    return SE3D_OK;
}

/* What is unbalanced at the present position, on the constraints. */
static se3d_status evaluate(statics *s, int careful)
{
    se3di_equations *equations = s->equations;
    se3di_assembly_eval_jacobian(&equations->assembly);
    SE3DI_TRY(se3di_assembly_eval_forces(&equations->assembly, s->t, s->load, equations->error));
    se3d_status status =
        se3di_static_newton_balance(&s->newton, s->load, s->rho, s->lambda, careful);
    s->redundant = status == SE3D_INFO_REDUNDANT;
    return status < 0 ? se3di_error_set(equations->error, status,
                                        "t = %g s: the forces are not finite", s->t)
                      : SE3D_OK;
}

static double measure_step(const statics *s)
{
    double length = 0.0;
    for (size_t k = 0; k < s->equations->assembly.unknown_count; ++k) {
        const double part = fabs(s->step[k]) / (k % 6 < 3 ? s->size : 1.0);
        length = se3di_larger(length, part);
    }
    return length;
}

static void raise_damping(statics *s, double factor)
{
    s->damping = fmax(factor * s->damping, DAMPING_JUMP * s->newton.rate2);
}

static void lower_damping(statics *s)
{
    s->damping /= DAMPING_STEP;
    if (s->damping < DAMPING_MIN * s->newton.rate2) {
        s->damping = 0.0;
    }
}

/* Solve for the step and measure it. Returns whether it leads downhill and not too far. */
static int solve_step(statics *s, int *too_long)
{
    int32_t negative;
    *too_long = 0;
    if (se3di_static_newton_factor(&s->newton, s->damping, &negative) < 0 || negative > 0 ||
        se3di_static_newton_solve(&s->newton, s->rho, NULL, s->step) < 0) {
        return 0;
    }
    s->length = measure_step(s);
    *too_long = !(s->length <= TURN_MAX);
    return !*too_long;
}

/* The step with as little damping as leads downhill and not too far: if the stiffness has
 * negative curvature without, of its convex part. */
static se3d_status compute_step(statics *s)
{
    int too_long;
    SE3DI_TRY(se3di_static_newton_eval(&s->newton, s->t, s->load, s->lambda, 0));
    if (solve_step(s, &too_long)) {
        return SE3D_OK;
    }
    if (!too_long) {
        SE3DI_TRY(se3di_static_newton_eval(&s->newton, s->t, s->load, s->lambda, 1));
    }
    for (int trial = 0; trial < TRIALS; ++trial) {
        if (solve_step(s, &too_long)) {
            return SE3D_OK;
        }
        raise_damping(s, trial < 4 ? 3.0 : 10.0);
    }
    return se3di_error_set(s->equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: no step towards an equilibrium was found", s->t);
}

static double dot(const statics *s, const double *a, const double *b)
{
    double sum = 0.0;
    for (size_t k = 0; k < s->equations->assembly.unknown_count; ++k) {
        sum += a[k] * b[k];
    }
    return sum;
}

/* Move a fraction of the step, onto the constraints, and evaluate there. */
static se3d_status move(statics *s, double fraction, int *converged)
{
    const se3di_assembly *assembly = &s->equations->assembly;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        double dq[6];
        for (size_t c = 0; c < 6; ++c) {
            dq[c] = fraction * s->step[6 * (size_t)k + c];
        }
        assembly->formulation->move(&assembly->model->frames[assembly->free_body[k]], dq);
    }
    SE3DI_TRY(se3di_position_correct(s->equations, s->t, converged));
    return *converged ? evaluate(s, 0) : SE3D_OK;
}

/* Take the step, shortened if it leads too far from the constraints; *ratio of the work done to
 * what was predicted. If too little is done all is as before, and *ratio is -1. */
static se3d_status try_step(statics *s, double *ratio)
{
    const se3di_assembly *assembly = &s->equations->assembly;
    const size_t bytes = assembly->dense_count * sizeof *s->equations->accepted;
    const double work = dot(s, s->rho, s->step);
    const double curvature = work - se3di_static_newton_measure(&s->newton, s->damping, s->step);
    double fraction = 1.0;
    memcpy(s->equations->accepted, assembly->model->frames, bytes);
    for (int halvings = 0; halvings <= HALVINGS; ++halvings, fraction *= 0.5) {
        int converged = 0;
        se3d_status status = move(s, fraction, &converged);
        if (status == SE3D_ERR_NO_MEMORY || status == SE3D_ERR_CALLBACK ||
            status == SE3D_ERR_INTERRUPTED) {
            return status;
        }
        if (status >= 0 && converged) {
            *ratio = (work + dot(s, s->rho, s->step)) / (2.0 * work - fraction * curvature);
            if (*ratio > RATIO_MIN || s->length < 1e-6) {
                return SE3D_OK;
            }
            halvings = HALVINGS; /* the model is wrong there: more damping */
        }
        memcpy(assembly->model->frames, s->equations->accepted, bytes);
    }
    *ratio = -1.0;
    return evaluate(s, 0);
}

/* What is unbalanced, of turns over a radius. */
static double measure_balance(const statics *s)
{
    double largest = 0.0;
    for (size_t k = 0; k < s->equations->assembly.unknown_count; ++k) {
        const double radius = sqrt(s->newton.weights[k / 6].radius2);
        largest = fmax(largest, fabs(s->rho[k]) / (k % 6 < 3 ? 1.0 : radius));
    }
    return largest;
}

typedef struct history {
    double length;  /* of the last step */
    double balance; /* the best so far */
    int32_t stalled;
} history;

/* Steps at rounding; or no better balance for a while, if steps are noise along freedoms that
 * nothing holds. Not where only the damping holds them short. */
static int has_converged(const statics *s, history *progress)
{
    const double balance = measure_balance(s);
    const int at_rounding =
        s->length < 1e-15 || (s->length < 1e-10 && s->length > 0.25 * progress->length);
    progress->length = s->length;
    progress->stalled = balance < 0.5 * progress->balance ? 0 : progress->stalled + 1;
    progress->balance = fmin(progress->balance, balance);
    const int is_free =
        s->damping <= DAMPING_FREE * s->newton.rate2 || balance <= BALANCE_MAX * s->newton.force;
    return is_free && (at_rounding || (progress->stalled > STALLED && s->length < 1e-6));
}

static se3d_status iterate(statics *s, int *converged)
{
    history progress = {HUGE_VAL, HUGE_VAL, 0};
    *converged = !(measure_balance(s) > 0.0); /* without any force there is no step to find */
    for (int k = 0; k < ITERATIONS && !*converged; ++k) {
        double ratio = -1.0;
        SE3DI_TRY(se3di_equations_ask(s->equations));
        for (int trial = 0; trial < TRIALS && ratio < 0.0; ++trial) {
            SE3DI_TRY(compute_step(s));
            if (trial == 0 && has_converged(s, &progress)) {
                *converged = 1;
                return SE3D_OK;
            }
            SE3DI_TRY(try_step(s, &ratio));
            if (ratio < 0.25) {
                raise_damping(s, ratio < 0.0 ? DAMPING_STEP : 2.0);
            }
        }
        if (ratio < 0.0) {
            return SE3D_OK;
        }
        ++s->equations->counters.iterations;
        if (ratio > 0.75) {
            lower_damping(s);
        }
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

/* Multipliers of least norm, and whether some freedom has negative curvature. */
static se3d_status finish(statics *s)
{
    se3di_model *model = s->equations->assembly.model;
    int32_t negative = 0;
    SE3DI_TRY(se3di_position_solve(s->equations, s->t));
    SE3DI_TRY(evaluate(s, 1));
    SE3DI_TRY(se3di_static_newton_eval(&s->newton, s->t, s->load, s->lambda, 0));
    se3d_status status = se3di_static_newton_factor(&s->newton, 0.0, &negative);
    if (status < 0) { /* a pivot of rounding: a little stiffer */
        status = se3di_static_newton_factor(&s->newton, DAMPING_MIN * s->newton.rate2, &negative);
    }
    if (model->row_count > 0) {
        memcpy(model->lambda, s->lambda, model->row_count * sizeof *model->lambda);
    }
    model->time = s->t;
    s->equations->redundant = s->redundant;
    const int has_stiffness = s->newton.rate2 > 0.0;
    if (has_stiffness && (status < 0 || negative > 0)) {
        return SE3D_INFO_UNSTABLE;
    }
    return se3di_static_newton_is_strict(&s->newton) ? SE3D_OK : SE3D_INFO_NEUTRAL;
}

static se3d_status solve(statics *s)
{
    int converged;
    stop_motion(&s->equations->assembly);
    SE3DI_TRY(se3di_ranks_decide(s->equations, s->t));
    s->equations->unfolds = 1;
    const se3d_status met = se3di_position_solve(s->equations, s->t);
    s->equations->unfolds = 0;
    SE3DI_TRY(met);
    SE3DI_TRY(evaluate(s, 0));
    SE3DI_TRY(iterate(s, &converged));
    if (converged) {
        return finish(s);
    }
    return se3di_error_set(s->equations->error, SE3D_ERR_NO_CONVERGENCE,
                           "t = %g s: no equilibrium was found in %d steps; forces may have none, "
                           "or it is too far: start nearer to it, or let damped dynamics come to "
                           "rest",
                           s->t, ITERATIONS);
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
