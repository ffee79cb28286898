/* SPDX-License-Identifier: BSD-3-Clause */
/* Whether coefficients are constant is seen by comparing them with those a thousandth of a radian
 * further along the motion, in axes that have turned at their own rates meanwhile. What is compared
 * does not depend on the basis of the freedoms: P = Z^T Z and P M P, P D P, P K P, of entries in
 * units of the masses and of the fastest rate. */
#include "analysis/steady.h"

#include "math/larger.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define TURN     1e-3 /* rad, of the fastest body */
#define CONSTANT 1e-6 /* relative change of coefficients that are constant: .1 % a radian */
#define SLOW     1e-6 /* of the frequencies: a motion that changes no coefficient */

enum { BODY_AXES, CARRIER_AXES, GROUND_AXES, KINDS_OF_AXES };

typedef struct coefficients {
    double *P, *M, *D, *K; /* [n n] each */
} coefficients;

/* ---- axes ---- */

/* Of the body that carries free body k: of those it is joined to the one that turns most slowly, if
 * more slowly than itself. */
static uint32_t find_carrier(const se3di_linear *linear, uint32_t body)
{
    const se3di_model *model = linear->equations->assembly.model;
    uint32_t carrier = body;
    for (size_t j = 0; j < model->constraint_slots.count; ++j) {
        const se3di_constraint *c = &model->constraints[j];
        for (uint32_t k = 0; k < 2; ++k) {
            const uint32_t other = c->bodies[1 - k];
            if (c->bodies[k] == body && se3di_norm(model->frames[other].w) <
                                            (1.0 - 1e-9) * se3di_norm(model->frames[carrier].w)) {
                carrier = other;
            }
        }
    }
    return carrier;
}

/* The rates of the axes, in the axes, which are those of the bodies at present. */
static void choose_axes(se3di_linear *linear, int kind)
{
    const se3di_assembly *assembly = &linear->equations->assembly;
    linear->own_axes = kind == BODY_AXES;
    linear->is_turned = 0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        const se3di_frame *frame = &assembly->model->frames[body];
        double *rate = linear->rate + 3 * (size_t)k;
        double w[3] = {0.0, 0.0, 0.0};
        const uint32_t carrier = find_carrier(linear, body);
        if (kind == CARRIER_AXES && carrier != body) {
            se3di_mul(assembly->model->frames[carrier].A, assembly->model->frames[carrier].w, w);
            se3di_mul_transposed(frame->A, w, rate);
        } else {
            se3di_copy(kind == GROUND_AXES ? w : frame->w, rate);
        }
    }
}

/* ---- along the motion ---- */

/* All bodies move on for h, with what follows from the constraints there. */
static se3d_status move_on(const se3di_linear *linear, double t, double h)
{
    se3di_equations *equations = linear->equations;
    const se3di_assembly *assembly = &equations->assembly;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const uint32_t body = assembly->free_body[k];
        se3di_frame *frame = &assembly->model->frames[body];
        const double *a = assembly->model->acceleration + 6 * (size_t)body;
        double dq[6];
        for (int c = 0; c < 3; ++c) {
            dq[c] = h * (frame->v[c] + 0.5 * h * a[c]);
            dq[3 + c] = h * (frame->w[c] + 0.5 * h * a[3 + c]);
        }
        assembly->formulation->move(frame, dq);
        se3di_add_scaled(h, a, frame->v);
        se3di_add_scaled(h, a + 3, frame->w);
        se3di_frame_update(frame);
    }
    return se3di_state_solve(equations, t + h);
}

/* The axes turn by their rates, the bodies have turned by A0^T A. */
static void turn_axes(se3di_linear *linear, double h)
{
    const se3di_assembly *assembly = &linear->equations->assembly;
    linear->is_turned = !linear->own_axes;
    for (uint32_t k = 0; k < assembly->body_count && linear->is_turned; ++k) {
        const uint32_t body = assembly->free_body[k];
        const double *rate = linear->rate + 3 * (size_t)k;
        const double *p0 = linear->equations->accepted[body].p;
        double half[4] = {1.0, 0.5 * h * rate[0], 0.5 * h * rate[1], 0.5 * h * rate[2]};
        const double angle = h * se3di_norm(rate);
        double p[4];
        double A[9];
        for (int c = 1; c < 4; ++c) { /* sin(angle / 2) / (angle / 2) */
            half[c] *= 1.0 - angle * angle / 24.0;
        }
        half[0] = 1.0 - angle * angle / 8.0;
        se3di_quat_normalize(half, half);
        se3di_quat_mul(p0, half, p); /* axes -> ground */
        se3di_quat_to_matrix(p, A);
        se3di_mat_mul_transposed(assembly->model->frames[body].A, A, linear->turn + 9 * (size_t)k);
    }
}

/* ---- comparison ---- */

/* out [n n] = Z^T X Z, X [f f], or Z^T Z if NULL. */
static void expand(const se3di_linear *linear, const double *X, double *out)
{
    const size_t n = (size_t)linear->n;
    const size_t f = (size_t)linear->freedoms;
    double *half = linear->work; /* [f n] = X Z */
    memset(half, 0, f * n * sizeof *half);
    memset(out, 0, n * n * sizeof *out);
    for (size_t r = 0; r < f; ++r) {
        for (size_t k = 0; k < f; ++k) {
            const double x = X ? X[r * f + k] : (double)(r == k);
            for (size_t c = 0; c < n; ++c) {
                half[r * n + c] += x * linear->Z[k * n + c];
            }
        }
        for (size_t k = 0; k < n * n; ++k) {
            out[k] += linear->Z[r * n + k / n] * half[r * n + k % n];
        }
    }
}

static se3d_status evaluate(se3di_linear *linear, double t, const coefficients *out)
{
    const se3di_model *model = linear->equations->assembly.model;
    SE3DI_TRY(se3di_linear_eval_statics(linear, t));
    se3di_assembly_get_acceleration(&linear->equations->assembly, linear->equations->x);
    SE3DI_TRY(se3di_linear_eval_matrices(linear, t, linear->equations->x, model->lambda));
    if (out) {
        expand(linear, NULL, out->P);
        expand(linear, linear->Mr, out->M);
        expand(linear, linear->Dr, out->D);
        expand(linear, linear->Kr, out->K);
    }
    return SE3D_OK;
}

/* The square of the highest frequency that one body would have alone. */
static double find_stiffness(const se3di_linear *linear)
{
    const size_t n = (size_t)linear->n;
    double rate2 = 0.0;
    for (size_t k = 0; k < n; ++k) {
        rate2 = fmax(rate2, fabs(linear->K[k * n + k]) / linear->M[k * n + k]);
    }
    return rate2;
}

static double fastest_rate(const se3di_assembly *assembly)
{
    double rate = 0.0;
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        rate = fmax(rate, se3di_norm(assembly->model->frames[assembly->free_body[k]].w));
    }
    return rate;
}

/* The largest change of an entry, in units of masses, and masses times rate and its square. */
static double compare(const se3di_linear *linear, const coefficients *a, const coefficients *b,
                      double rate)
{
    const size_t n = (size_t)linear->n;
    double most = 0.0;
    for (size_t k = 0; k < n * n; ++k) {
        const double mass = sqrt(linear->M[k / n * (n + 1)] * linear->M[k % n * (n + 1)]);
        const double changes[4] = {fabs(a->P[k] - b->P[k]), fabs(a->M[k] - b->M[k]) / mass,
                                   fabs(a->D[k] - b->D[k]) / (mass * rate),
                                   fabs(a->K[k] - b->K[k]) / (mass * rate * rate)};
        for (int c = 0; c < 4; ++c) {
            most = se3di_larger(most, changes[c]);
        }
    }
    return most;
}

static se3d_status try_axes(se3di_linear *linear, double t, int kind, coefficients both[2],
                            double *change)
{
    se3di_equations *equations = linear->equations;
    const double w = fastest_rate(&equations->assembly);
    choose_axes(linear, kind);
    SE3DI_TRY(evaluate(linear, t, &both[0]));
    const double rate = fmax(w, sqrt(find_stiffness(linear)));
    *change = 0.0;
    if (w <= SLOW * rate) {
        return SE3D_OK;
    }
    const double h = TURN / w;
    se3d_status status = move_on(linear, t, h);
    turn_axes(linear, h);
    status = status < 0 ? status : evaluate(linear, t + h, &both[1]);
    if (status >= 0) {
        *change = compare(linear, &both[0], &both[1], rate);
    }
    se3di_state_restore(equations);
    linear->is_turned = 0;
    SE3DI_TRY(status);
    SE3DI_TRY(se3di_assembly_eval_functions(&equations->assembly, t, equations->error));
    return evaluate(linear, t, NULL);
}

static se3d_status find_axes(se3di_linear *linear, double t, coefficients both[2])
{
    double change[KINDS_OF_AXES];
    for (int kind = 0; kind < KINDS_OF_AXES; ++kind) {
        SE3DI_TRY(try_axes(linear, t, kind, both, &change[kind]));
        if (change[kind] <= CONSTANT) {
            return SE3D_OK;
        }
    }
    return se3di_error_set(
        linear->equations->error, SE3D_ERR_STATE,
        "t = %g s: small motions about the present one have no constant coefficients (they change "
        "by %.2g of their size in %.2g s, in axes that turn with the bodies, with what carries "
        "them, or not at all): modes are those of an equilibrium or of a steady motion",
        t, fmin(change[0], fmin(change[1], change[2])),
        TURN / fastest_rate(&linear->equations->assembly));
}

se3d_status se3di_steady_linearise(se3di_linear *linear, double t)
{
    const se3d_allocator *allocator = &linear->equations->assembly.model->allocator;
    const size_t size = (size_t)linear->n * (size_t)linear->n;
    coefficients both[2];
    if (!(fastest_rate(&linear->equations->assembly) > 0.0)) {
        return evaluate(linear, t, NULL);
    }
    double *memory = se3di_alloc(allocator, 8 * size, sizeof *memory);
    if (!memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    for (size_t k = 0; k < 2; ++k) {
        double *part = memory + 4 * k * size;
        both[k] = (coefficients){part, part + size, part + 2 * size, part + 3 * size};
    }
    se3di_state_accept(linear->equations);
    const se3d_status status = find_axes(linear, t, both);
    se3di_free(allocator, memory, 8 * size, sizeof *memory);
    return status;
}
