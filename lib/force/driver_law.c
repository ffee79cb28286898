/* SPDX-License-Identifier: BSD-3-Clause */
/* A coordinate x of a joint that follows a function of the time and of signals s of positions:
 *
 *     Phi   = x - f(t, s_1, s_2, ...)
 *     Phi_q = x_q - sum_k f_k s_k,q
 *     nu    = f_t
 *     gamma = f'' - u.x_qq u + sum_k f_k u.s_k,qq u
 *     (Phi_q^T lambda)_q = lambda (x_qq - sum_k f_k s_k,qq - sum_kl f_kl s_k,q^T s_l,q)
 *
 * with the velocities u, f_k = df/ds_k, and f'' the second derivative of f along the direction
 * (1, s_1', s_2', ...), which the expression gives. f_kl follows from second derivatives along
 * sums of axes. As a driver of time, Phi of an angle is taken modulo 2 pi.
 *
 * docs/theory/signals.md */
#include "force/driver_law.h"

#include "expression/expression.h"
#include "force/signal.h"
#include "joint/rows.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define PI     3.1415926535897932384626433832795
#define TWO_PI 6.283185307179586476925286766559

enum { PAIR = 12, VARIABLES = SE3D_FUNCTION_VARIABLES_MAX, NUMBERS = 6 * SE3DI_NODE_BODIES_MAX };

/* A coordinate or signal with its derivatives to the displacements (dr, dtheta) of two bodies. */
typedef struct quantity {
    double value, rate;
    double curve; /* u . H u */
    uint32_t bodies[2];
    double q[PAIR];
    double H[PAIR * PAIR]; /* derivative of q */
} quantity;

/* The function with what it depends on; [0] of the arrays is the time. */
typedef struct law {
    const se3d_expression *expression;
    uint32_t count; /* of variables */
    double x[VARIABLES];
    double direction[VARIABLES];
    double value, slope[VARIABLES];
    quantity signals[VARIABLES];
    quantity own; /* the driven coordinate */
} law;

/* ---- signals ---- */

static void take_measure(const se3di_measure *m, quantity *out)
{
    out->value = m->value;
    memcpy(out->q, m->g, sizeof out->q);
    memcpy(out->H, m->H, sizeof out->H);
}

static void take_joint(const se3di_model *model, uint32_t joint, int32_t coordinate, quantity *out)
{
    se3di_measure m;
    se3di_measure_joint(model, joint, coordinate, 1, &m);
    memcpy(out->bodies, model->constraints[joint].bodies, sizeof out->bodies);
    take_measure(&m, out);
}

/* e . (r + A s): q = (e, s x a), a = A^T e, and with da = a x dtheta
 * H = a s^T - (s . a) 1 of rotations. */
static void curve_point(const se3di_frame *frame, const se3di_signal *signal, quantity *out)
{
    const double *A = frame->A, *s = signal->point;
    const double a[3] = {A[3 * signal->component], A[3 * signal->component + 1],
                         A[3 * signal->component + 2]};
    const double sa = se3di_dot(s, a);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            out->H[PAIR * (9 + r) + 9 + c] = a[r] * s[c] - (r == c ? sa : 0.0);
        }
    }
}

/* p_k: q = 1/2 row k of G(p)^T, which is linear in p, and dp = 1/2 G^T dtheta. */
static void curve_orientation(const se3di_frame *frame, const se3di_signal *signal, quantity *out)
{
    for (int c = 0; c < 3; ++c) {
        double e[3] = {0.0, 0.0, 0.0}, dp[4], G[12];
        e[c] = 0.5;
        se3di_g_transposed_mul(frame->p, e, dp);
        se3di_g_matrix(dp, G);
        for (int r = 0; r < 3; ++r) {
            out->H[PAIR * (9 + r) + 9 + c] = 0.5 * G[4 * r + signal->component];
        }
    }
}

static se3d_status take_signal(const se3di_model *model, const se3di_signal *signal, double t,
                               quantity *out)
{
    if (signal->kind == SE3D_SIGNAL_JOINT_COORDINATE) {
        take_joint(model, signal->joint, signal->component, out);
        return SE3D_OK;
    }
    if (signal->kind == SE3D_SIGNAL_FORCE_COORDINATE) {
        se3di_measure m;
        se3di_signal_bodies(model, signal, out->bodies);
        if (!se3di_measure_force(model, &model->forces[signal->force], 1, &m)) {
            return SE3D_ERR_NOT_FINITE;
        }
        take_measure(&m, out);
        return SE3D_OK;
    }
    se3di_signal_value value;
    const se3di_frame *frame = &model->frames[signal->body];
    SE3DI_TRY(se3di_signal_eval(model, signal, t, 1, &value));
    out->value = value.value;
    memcpy(out->bodies, value.bodies, sizeof out->bodies);
    memcpy(out->q, value.q, sizeof out->q);
    memset(out->H, 0, sizeof out->H);
    if (signal->kind == SE3D_SIGNAL_ORIENTATION) {
        curve_orientation(frame, signal, out);
    } else {
        curve_point(frame, signal, out);
    }
    return SE3D_OK;
}

/* Rate and curve at the velocities of the model. */
static void move(const se3di_model *model, quantity *out)
{
    double u[PAIR];
    for (int b = 0; b < 2; ++b) {
        se3di_copy(model->frames[out->bodies[b]].v, u + 6 * b);
        se3di_copy(model->frames[out->bodies[b]].w, u + 6 * b + 3);
    }
    out->rate = out->curve = 0.0;
    for (int r = 0; r < PAIR; ++r) {
        double row = 0.0;
        for (int c = 0; c < PAIR; ++c) {
            row += out->H[PAIR * r + c] * u[c];
        }
        out->rate += out->q[r] * u[r];
        out->curve += u[r] * row;
    }
}

/* ---- the function ---- */

static se3d_status begin(const se3di_model *model, const se3di_constraint *constraint, double t,
                         law *l)
{
    const se3di_function *function = &model->functions[constraint->law];
    double jet[3];
    l->expression = function->expression;
    l->count = function->variable_count;
    l->x[0] = t;
    l->direction[0] = 1.0;
    for (uint32_t k = 1; k < l->count; ++k) {
        SE3DI_TRY(take_signal(model, &function->signals[k - 1], t, &l->signals[k]));
        move(model, &l->signals[k]);
        l->x[k] = l->signals[k].value;
        l->direction[k] = l->signals[k].rate;
    }
    take_joint(model, (uint32_t)constraint->joints[0], constraint->coordinate, &l->own);
    move(model, &l->own);
    SE3DI_TRY(se3di_function_eval(function, l->x, jet, l->slope));
    l->value = jet[0];
    return SE3D_OK;
}

/* f'' along a direction. */
static double bend(const law *l, const double *direction)
{
    double jet[3];
    se3di_expression_eval_along(l->expression, l->x, direction, (1u << l->count) - 1u, jet);
    return jet[2];
}

/* d2 f / ds_a ds_b */
static double mixed(const law *l, uint32_t a, uint32_t b)
{
    double one[VARIABLES] = {0.0}, other[VARIABLES] = {0.0}, both[VARIABLES] = {0.0};
    one[a] = other[b] = both[a] = both[b] = 1.0;
    return a == b ? bend(l, one) : 0.5 * (bend(l, both) - bend(l, one) - bend(l, other));
}

/* Places of the bodies of a quantity in the driver's list; body_count: it is the ground, which is
 * not in the list. */
static void find_places(const se3di_constraint *constraint, const quantity *one, uint32_t place[2])
{
    for (int b = 0; b < 2; ++b) {
        place[b] = 0;
        while (place[b] < constraint->body_count &&
               constraint->bodies[place[b]] != one->bodies[b]) {
            ++place[b];
        }
    }
}

/* row [6 * bodies] += by q */
static void add_row(const se3di_constraint *constraint, const quantity *one, double by, double *row)
{
    uint32_t place[2];
    find_places(constraint, one, place);
    for (int k = 0; k < PAIR; ++k) {
        if (place[k / 6] < constraint->body_count) {
            row[6 * place[k / 6] + (uint32_t)k % 6] += by * one->q[k];
        }
    }
}

/* H [n * n] += by H of the quantity, n = 6 * bodies */
static void add_curvature(const se3di_constraint *constraint, const quantity *one, double by,
                          double *H)
{
    const uint32_t n = 6 * constraint->body_count;
    uint32_t place[2];
    find_places(constraint, one, place);
    for (int k = 0; k < PAIR * PAIR; ++k) {
        const uint32_t r = place[k / PAIR / 6], c = place[k % PAIR / 6];
        if (r < constraint->body_count && c < constraint->body_count) {
            H[n * (6 * r + (uint32_t)(k / PAIR) % 6) + 6 * c + (uint32_t)k % 6] += by * one->H[k];
        }
    }
}

static void fill_jacobian(const se3di_constraint *constraint, const law *l, double *row)
{
    add_row(constraint, &l->own, 1.0, row);
    for (uint32_t k = 1; k < l->count; ++k) {
        add_row(constraint, &l->signals[k], -l->slope[k], row);
    }
}

static double compute_phi(const se3di_constraint *constraint, const law *l)
{
    double phi = l->own.value - l->value;
    if (constraint->coordinate == SE3D_JOINT_COORDINATE_ANGLE) {
        phi = remainder(phi, TWO_PI);
        phi = phi <= -PI ? phi + TWO_PI : phi;
    }
    return phi;
}

static double compute_gamma(const law *l)
{
    double gamma = bend(l, l->direction) - l->own.curve;
    for (uint32_t k = 1; k < l->count; ++k) {
        gamma += l->slope[k] * l->signals[k].curve;
    }
    return gamma;
}

static se3d_status eval(const se3di_model *model, const se3di_constraint *constraint, double t,
                        int wanted, se3di_user_values *values)
{
    law l;
    memset(values, 0, sizeof *values);
    if (begin(model, constraint, t, &l) < 0) {
        return SE3D_ERR_NOT_FINITE;
    }
    const int n = 6 * (int)constraint->body_count;
    values->phi[0] = wanted & SE3DI_USER_PHI ? compute_phi(constraint, &l) : 0.0;
    values->nu[0] = wanted & SE3DI_USER_NU ? l.slope[0] : 0.0;
    values->gamma[0] = wanted & SE3DI_USER_GAMMA ? compute_gamma(&l) : 0.0;
    if (wanted & SE3DI_USER_JACOBIAN) {
        fill_jacobian(constraint, &l, values->jacobian);
    }
    if (se3di_is_finite(values->phi, 1) && se3di_is_finite(values->nu, 1) &&
        se3di_is_finite(values->gamma, 1) && se3di_is_finite(values->jacobian, n)) {
        return SE3D_OK;
    }
    memset(values, 0, sizeof *values);
    return SE3D_ERR_NOT_FINITE;
}

/* H -= by f_kl s_k,q^T s_l,q */
static void add_products(const se3di_constraint *constraint, const law *l, double by, double *H)
{
    const uint32_t n = 6 * constraint->body_count;
    for (uint32_t a = 1; a < l->count; ++a) {
        for (uint32_t b = 1; b < l->count; ++b) {
            double row_a[NUMBERS] = {0.0}, row_b[NUMBERS] = {0.0};
            const double f_ab = mixed(l, a, b);
            if (f_ab == 0.0) {
                continue;
            }
            add_row(constraint, &l->signals[a], 1.0, row_a);
            add_row(constraint, &l->signals[b], 1.0, row_b);
            for (uint32_t k = 0; k < n * n; ++k) {
                H[k] -= by * f_ab * row_a[k / n] * row_b[k % n];
            }
        }
    }
}

static se3d_status curvature(const se3di_model *model, const se3di_constraint *constraint, double t,
                             const double *lambda, double *H, double *g)
{
    law l;
    const uint32_t n = 6 * constraint->body_count;
    memset(H, 0, (size_t)n * n * sizeof *H);
    memset(g, 0, n * sizeof *g);
    if (begin(model, constraint, t, &l) < 0) {
        return SE3D_ERR_NOT_FINITE;
    }
    fill_jacobian(constraint, &l, g);
    for (uint32_t k = 0; k < n; ++k) {
        g[k] *= lambda[0];
    }
    add_curvature(constraint, &l.own, lambda[0], H);
    for (uint32_t k = 1; k < l.count; ++k) {
        add_curvature(constraint, &l.signals[k], -lambda[0] * l.slope[k], H);
    }
    add_products(constraint, &l, lambda[0], H);
    return se3di_is_finite(H, (int)(n * n)) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

static const se3di_user_class driver_law = {eval, curvature};

/* ---- construction ---- */

static int add_body(se3di_constraint *constraint, uint32_t body)
{
    for (uint32_t k = 0; k < constraint->body_count; ++k) {
        if (constraint->bodies[k] == body) {
            return 1;
        }
    }
    if (constraint->body_count == SE3DI_NODE_BODIES_MAX) {
        return 0;
    }
    constraint->bodies[constraint->body_count++] = body;
    return 1;
}

int se3di_driver_law_draft(const se3di_model *model, uint32_t joint, int32_t coordinate,
                           int32_t function, const char *name, se3di_draft *draft)
{
    const se3di_constraint *source = &model->constraints[joint];
    const se3di_function *of = &model->functions[function];
    se3di_draft_init(draft, "driver", name, source->bodies[0], source->bodies[1]);
    se3di_constraint *constraint = &draft->constraint;
    constraint->frames = source->frames;
    constraint->joints[0] = (int32_t)joint;
    constraint->law_class = &driver_law;
    constraint->law = function;
    constraint->coordinate = coordinate;
    se3di_draft_add_row(draft, coordinate == SE3D_JOINT_COORDINATE_ANGLE ? "angle" : "displacement",
                        0.0);
    for (uint32_t k = 0; k < of->signal_count; ++k) {
        uint32_t bodies[2];
        se3di_signal_bodies(model, &of->signals[k], bodies);
        for (int b = 0; b < 2; ++b) {
            if (bodies[b] != 0 && !add_body(constraint, bodies[b])) {
                return 0;
            }
        }
    }
    return 1;
}

se3d_status se3di_driver_law_value(const se3di_model *model, const se3di_constraint *constraint,
                                   double *value)
{
    double jet[3];
    SE3DI_TRY(se3di_law_eval(model, &model->functions[constraint->law], &model->time, jet, NULL));
    *value = jet[0];
    return SE3D_OK;
}
