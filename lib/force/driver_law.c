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
#include "force/quantity.h"
#include "force/signal.h"
#include "joint/rows.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define PI     3.1415926535897932384626433832795
#define TWO_PI 6.283185307179586476925286766559

enum { VARIABLES = SE3D_FUNCTION_VARIABLES_MAX, NUMBERS = 6 * SE3DI_NODE_BODIES_MAX };

/* The function with what it depends on; [0] of the arrays is the time. */
typedef struct law {
    const se3d_expression *expression;
    uint32_t count; /* of variables */
    double x[VARIABLES];
    double direction[VARIABLES];
    double value, slope[VARIABLES];
    se3di_quantity signals[VARIABLES];
    se3di_quantity own; /* the driven coordinate */
} law;

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
        SE3DI_TRY(se3di_quantity_take(model, &function->signals[k - 1], t, &l->signals[k]));
        se3di_quantity_move(model, &l->signals[k]);
        l->x[k] = l->signals[k].value;
        l->direction[k] = l->signals[k].rate;
    }
    se3di_quantity_take_joint(model, (uint32_t)constraint->joints[0], constraint->coordinate,
                              &l->own);
    se3di_quantity_move(model, &l->own);
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

static void fill_jacobian(const se3di_constraint *constraint, const law *l, double *row)
{
    se3di_quantity_add_row(constraint, &l->own, 1.0, row);
    for (uint32_t k = 1; k < l->count; ++k) {
        se3di_quantity_add_row(constraint, &l->signals[k], -l->slope[k], row);
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
    if (begin(model, constraint, t, &l) < 0) {
        return SE3D_ERR_NOT_FINITE;
    }
    values->phi[0] = wanted & SE3DI_USER_PHI ? compute_phi(constraint, &l) : 0.0;
    values->nu[0] = wanted & SE3DI_USER_NU ? l.slope[0] : 0.0;
    values->gamma[0] = wanted & SE3DI_USER_GAMMA ? compute_gamma(&l) : 0.0;
    if (wanted & SE3DI_USER_JACOBIAN) {
        fill_jacobian(constraint, &l, values->jacobian);
    }
    return SE3D_OK;
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
            se3di_quantity_add_row(constraint, &l->signals[a], 1.0, row_a);
            se3di_quantity_add_row(constraint, &l->signals[b], 1.0, row_b);
            for (uint32_t k = 0; k < n * n; ++k) {
                H[k] -= by * f_ab * row_a[k / n] * row_b[k % n];
            }
        }
    }
}

static se3d_status curvature(const se3di_model *model, const se3di_constraint *constraint, double t,
                             double lambda, double *H, double *row)
{
    law l;
    if (begin(model, constraint, t, &l) < 0) {
        return SE3D_ERR_NOT_FINITE;
    }
    fill_jacobian(constraint, &l, row);
    se3di_quantity_add_curvature(constraint, &l.own, lambda, H);
    for (uint32_t k = 1; k < l.count; ++k) {
        se3di_quantity_add_curvature(constraint, &l.signals[k], -lambda * l.slope[k], H);
    }
    add_products(constraint, &l, lambda, H);
    return SE3D_OK;
}

static const se3di_user_class driver_law = {eval, curvature};

/* ---- construction ---- */

void se3di_driver_law_begin(const se3di_model *model, uint32_t joint, int32_t coordinate,
                            int32_t function, const char *name, se3di_draft *draft)
{
    const se3di_constraint *source = &model->constraints[joint];
    se3di_draft_init(draft, "driver", name, source->bodies[0], source->bodies[1]);
    draft->constraint.frames = source->frames;
    draft->constraint.joints[0] = (int32_t)joint;
    draft->constraint.law_class = &driver_law;
    draft->constraint.law = function;
    draft->constraint.coordinate = coordinate;
    se3di_draft_add_row(draft, coordinate == SE3D_JOINT_COORDINATE_ANGLE ? "angle" : "displacement",
                        0.0);
}

int se3di_driver_law_add_bodies(const se3di_model *model, const se3di_signal *signal,
                                se3di_draft *draft)
{
    uint32_t bodies[2];
    se3di_signal_bodies(model, signal, bodies);
    for (int b = 0; b < 2; ++b) {
        if (bodies[b] != 0 && !se3di_quantity_add_body(&draft->constraint, bodies[b])) {
            return 0;
        }
    }
    return 1;
}

int se3di_driver_law_draft(const se3di_model *model, uint32_t joint, int32_t coordinate,
                           int32_t function, const char *name, se3di_draft *draft)
{
    const se3di_function *of = &model->functions[function];
    se3di_driver_law_begin(model, joint, coordinate, function, name, draft);
    for (uint32_t k = 0; k < of->signal_count; ++k) {
        if (!se3di_driver_law_add_bodies(model, &of->signals[k], draft)) {
            return 0;
        }
    }
    return 1;
}

se3d_status se3di_driver_law_value(const se3di_model *model, const se3di_constraint *constraint,
                                   double *value)
{
    double jet[3];
    SE3DI_TRY(
        se3di_law_eval(model, &model->functions[constraint->law], &model->time, NULL, jet, NULL));
    *value = jet[0];
    return SE3D_OK;
}
