/* SPDX-License-Identifier: BSD-3-Clause */
/* A coordinate x of a joint whose rate follows a function of the time, of signals s of positions
 * or states, and of signals v of velocities:
 *
 *     x'    = f(t, s, v)
 *     A     = x_q - sum_k f_vk v_k,u
 *     nu    = f - sum_k f_vk v_k                      A u = nu is x' = f
 *     gamma = f_t + f_s s' + f_v v'|a=0 - u.x_qq u    A a = gamma
 *     (A^T lambda)_q = lambda (x_qq - sum_k f_vk v_k,uq - sum_kl f_vk,l v_k,u^T l,q)
 *
 * Nothing is left of it at the level of positions: Phi = 0, the coordinate is what the integral of
 * its rate makes of it. Multipliers act along A, so that virtual motions that the row allows take
 * no work (a gear of any ratio loses none). Of velocities only those of bodies are in A: the rate
 * z' of a state is known. v_k,u of a velocity is s_k,q of the position that it is the rate of.
 *
 * Signals that are outputs or inputs of states are functions themselves; what they depend on in the
 * end are leaves. Derivatives along a direction of the leaves go through all of them.
 *
 * docs/theory/signals.md */
#include "force/driver_rate.h"

#include "expression/expression.h"
#include "force/driver_law.h"
#include "force/force.h"
#include "force/quantity.h"
#include "force/signal.h"
#include "joint/rows.h"
#include "math/vec3.h"

#include <string.h>

enum {
    VARIABLES = SE3D_FUNCTION_VARIABLES_MAX,
    LEAVES = SE3DI_RATE_LEAVES_MAX,
    NUMBERS = 6 * SE3DI_NODE_BODIES_MAX,
    PAIR = SE3DI_QUANTITY_PAIR
};

typedef struct leaf {
    se3di_quantity of; /* of a velocity: the position that it is the rate of */
    double pace;       /* its rate without accelerations */
    double slope;      /* df / d leaf, of velocities */
    int32_t is_velocity;
    int32_t is_state;
} leaf;

typedef struct rate_law {
    const se3di_function *function;
    double t;
    uint32_t count;
    leaf leaves[LEAVES];
    se3di_quantity own; /* the driven coordinate */
} rate_law;

/* ---- leaves ---- */

/* The kind of position that a kind of velocity is the rate of; -1: it is none, or an angular
 * velocity, which is the rate of no position. */
static int32_t position_of(int32_t kind)
{
    switch (kind) {
    case SE3D_SIGNAL_JOINT_RATE:
        return SE3D_SIGNAL_JOINT_COORDINATE;
    case SE3D_SIGNAL_FORCE_RATE:
        return SE3D_SIGNAL_FORCE_COORDINATE;
    case SE3D_SIGNAL_POINT_VELOCITY:
        return SE3D_SIGNAL_POINT_POSITION;
    default:
        return -1;
    }
}

static int is_velocity(const se3di_signal *signal)
{
    return signal->kind == SE3D_SIGNAL_ANGULAR_VELOCITY || position_of(signal->kind) >= 0;
}

/* The rate of a state; inputs without a function are 0. */
static se3d_status take_state(const se3di_model *model, const se3di_signal *signal, double t,
                              leaf *l)
{
    se3di_effect effect;
    memset(&effect, 0, sizeof effect);
    l->is_state = 1;
    l->pace = 0.0;
    if (signal->component == SE3D_STATE_INPUT) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_force_eval(model, &model->forces[signal->force], t, &effect));
    l->pace = effect.value;
    return SE3D_OK;
}

static se3d_status take_leaf(const se3di_model *model, const se3di_signal *signal, double t,
                             leaf *l)
{
    memset(l, 0, sizeof *l);
    l->is_velocity = is_velocity(signal);
    if (signal->kind == SE3D_SIGNAL_STATE) {
        return take_state(model, signal, t, l);
    }
    if (signal->kind == SE3D_SIGNAL_ANGULAR_VELOCITY) {
        l->of.bodies[1] = signal->body;
        l->of.q[9 + signal->component] = 1.0;
    } else {
        se3di_signal position = *signal;
        position.kind = l->is_velocity ? position_of(signal->kind) : signal->kind;
        SE3DI_TRY(se3di_quantity_take(model, &position, t, &l->of));
    }
    se3di_quantity_move(model, &l->of);
    l->pace = l->is_velocity ? l->of.curve : l->of.rate;
    return SE3D_OK;
}

/* ---- the function ---- */

/* f, f' and f'' along the direction that has `time` and `leaves`; x, y, ... of the variables. */
static se3d_status along(const se3di_model *model, const se3di_function *function, double t,
                         double time, const double *leaves, double jet[3])
{
    double x[VARIABLES] = {0.0}, first[VARIABLES] = {0.0}, second[VARIABLES] = {0.0};
    double slope[VARIABLES] = {0.0};
    if (!function->expression) { /* of the time alone */
        SE3DI_TRY(se3di_function_eval(function, &t, jet, NULL));
        jet[1] *= time;
        jet[2] *= time * time;
        return SE3D_OK;
    }
    x[0] = t;
    first[0] = time;
    for (uint32_t k = 1; k < function->variable_count; ++k) {
        const se3di_signal *signal = &function->signals[k - 1];
        const se3di_function *inner = se3di_signal_function(model, signal);
        if (inner) {
            double part[3];
            SE3DI_TRY(along(model, inner, t, time, leaves, part));
            leaves += se3di_law_count_leaves(model, inner);
            x[k] = part[0];
            first[k] = part[1];
            second[k] = part[2];
        } else {
            se3di_signal_value value;
            SE3DI_TRY(se3di_signal_eval(model, signal, t, 0, &value));
            x[k] = value.value;
            first[k] = *leaves++;
        }
    }
    SE3DI_TRY(se3di_function_eval(function, x, jet, slope));
    se3di_expression_eval_along(function->expression, x, first,
                                (1u << function->variable_count) - 1u, jet);
    for (uint32_t k = 1; k < function->variable_count; ++k) {
        jet[2] += slope[k] * second[k];
    }
    return SE3D_OK;
}

static se3d_status begin(const se3di_model *model, const se3di_constraint *constraint, double t,
                         rate_law *l)
{
    l->function = &model->functions[constraint->law];
    l->t = t;
    l->count = se3di_law_count_leaves(model, l->function);
    for (uint32_t k = 0; k < l->count; ++k) {
        double unit[LEAVES] = {0.0}, jet[3];
        const se3di_signal *signal = se3di_law_get_leaf(model, l->function, k);
        SE3DI_TRY(take_leaf(model, signal, t, &l->leaves[k]));
        unit[k] = 1.0;
        if (l->leaves[k].is_velocity) {
            SE3DI_TRY(along(model, l->function, t, 0.0, unit, jet));
            l->leaves[k].slope = jet[1];
        }
    }
    se3di_quantity_take_joint(model, (uint32_t)constraint->joints[0], constraint->coordinate,
                              &l->own);
    se3di_quantity_move(model, &l->own);
    return SE3D_OK;
}

static void fill_jacobian(const se3di_constraint *constraint, const rate_law *l, double *row)
{
    se3di_quantity_add_row(constraint, &l->own, 1.0, row);
    for (uint32_t k = 0; k < l->count; ++k) {
        if (l->leaves[k].is_velocity) {
            se3di_quantity_add_row(constraint, &l->leaves[k].of, -l->leaves[k].slope, row);
        }
    }
}

/* nu and gamma */
static se3d_status fill_rates(const se3di_model *model, const rate_law *l,
                              se3di_user_values *values)
{
    double paces[LEAVES] = {0.0}, jet[3];
    for (uint32_t k = 0; k < l->count; ++k) {
        paces[k] = l->leaves[k].pace;
    }
    SE3DI_TRY(along(model, l->function, l->t, 1.0, paces, jet));
    values->nu[0] = jet[0];
    values->gamma[0] = jet[1] - l->own.curve;
    for (uint32_t k = 0; k < l->count; ++k) {
        if (l->leaves[k].is_velocity) {
            values->nu[0] -= l->leaves[k].slope * l->leaves[k].of.rate;
        }
    }
    return SE3D_OK;
}

static se3d_status eval(const se3di_model *model, const se3di_constraint *constraint, double t,
                        int wanted, se3di_user_values *values)
{
    rate_law l;
    if (!(wanted & ~SE3DI_USER_PHI)) {
        return SE3D_OK;
    }
    se3d_status status = begin(model, constraint, t, &l);
    if (status == SE3D_OK && wanted & (SE3DI_USER_NU | SE3DI_USER_GAMMA)) {
        status = fill_rates(model, &l, values);
    }
    if (status == SE3D_OK && wanted & SE3DI_USER_JACOBIAN) {
        fill_jacobian(constraint, &l, values->jacobian);
    }
    return status == SE3D_OK ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

/* ---- the derivative of its force ---- */

static se3d_status mixed(const se3di_model *model, const rate_law *l, uint32_t a, uint32_t b,
                         double *second)
{
    double direction[LEAVES] = {0.0}, jet[3][3] = {{0.0}};
    direction[a] += 1.0;
    SE3DI_TRY(along(model, l->function, l->t, 0.0, direction, jet[0]));
    *second = jet[0][2];
    if (a == b) {
        return SE3D_OK;
    }
    direction[b] += 1.0;
    SE3DI_TRY(along(model, l->function, l->t, 0.0, direction, jet[1]));
    direction[a] = 0.0;
    SE3DI_TRY(along(model, l->function, l->t, 0.0, direction, jet[2]));
    *second = 0.5 * (jet[1][2] - jet[0][2] - jet[2][2]);
    return SE3D_OK;
}

/* The derivative of a leaf to the displacements of its bodies. */
static void leaf_row(const se3di_model *model, const se3di_constraint *constraint, const leaf *one,
                     double *row)
{
    se3di_quantity moved = one->of;
    double u[PAIR];
    memset(row, 0, NUMBERS * sizeof *row);
    if (one->is_velocity) {
        for (int b = 0; b < 2; ++b) {
            se3di_copy(model->frames[one->of.bodies[b]].v, u + 6 * b);
            se3di_copy(model->frames[one->of.bodies[b]].w, u + 6 * b + 3);
        }
        for (int c = 0; c < PAIR; ++c) {
            moved.q[c] = 0.0;
            for (int r = 0; r < PAIR; ++r) {
                moved.q[c] += u[r] * one->of.H[PAIR * r + c];
            }
        }
    }
    se3di_quantity_add_row(constraint, &moved, 1.0, row);
}

/* H -= by f_vk,l v_k,u^T l,q */
static se3d_status add_products(const se3di_model *model, const se3di_constraint *constraint,
                                const rate_law *l, double by, double *H)
{
    const uint32_t n = 6 * constraint->body_count;
    for (uint32_t a = 0; a < l->count; ++a) {
        double row_a[NUMBERS] = {0.0}, row_b[NUMBERS], f_ab;
        if (!l->leaves[a].is_velocity) {
            continue;
        }
        se3di_quantity_add_row(constraint, &l->leaves[a].of, 1.0, row_a);
        for (uint32_t b = 0; b < l->count; ++b) {
            SE3DI_TRY(mixed(model, l, a, b, &f_ab));
            if (f_ab == 0.0 || l->leaves[b].is_state) {
                continue;
            }
            leaf_row(model, constraint, &l->leaves[b], row_b);
            for (uint32_t k = 0; k < n * n; ++k) {
                H[k] -= by * f_ab * row_a[k / n] * row_b[k % n];
            }
        }
    }
    return SE3D_OK;
}

static se3d_status curvature(const se3di_model *model, const se3di_constraint *constraint, double t,
                             double lambda, double *H, double *row)
{
    rate_law l;
    if (begin(model, constraint, t, &l) < 0) {
        return SE3D_ERR_NOT_FINITE;
    }
    fill_jacobian(constraint, &l, row);
    se3di_quantity_add_curvature(constraint, &l.own, lambda, H);
    for (uint32_t k = 0; k < l.count; ++k) {
        if (l.leaves[k].is_velocity) {
            se3di_quantity_add_curvature(constraint, &l.leaves[k].of, -lambda * l.leaves[k].slope,
                                         H);
        }
    }
    return add_products(model, constraint, &l, lambda, H) < 0 ? SE3D_ERR_NOT_FINITE : SE3D_OK;
}

static const se3di_user_class driver_rate = {eval, curvature};

/* ---- construction ---- */

int se3di_is_driver_rate(const se3di_constraint *constraint)
{
    return constraint->law_class == &driver_rate;
}

uint32_t se3di_find_driver_rate(const se3di_model *model)
{
    for (uint32_t k = 0; k < model->constraint_slots.count; ++k) {
        if (se3di_is_driver_rate(&model->constraints[k])) {
            return k;
        }
    }
    return SE3DI_NO_INDEX;
}

double se3di_driver_rate_coordinate(const se3di_model *model, const se3di_constraint *constraint)
{
    se3di_quantity own;
    se3di_quantity_take_joint(model, (uint32_t)constraint->joints[0], constraint->coordinate, &own);
    return own.value;
}

se3d_status se3di_driver_rate_curve(const se3di_model *model, const se3di_constraint *constraint,
                                    double *gamma)
{
    rate_law l;
    double bends[LEAVES] = {0.0}, moves[LEAVES] = {0.0}, speeds[LEAVES] = {0.0}, both[LEAVES];
    double first[3], second[3][3];
    SE3DI_TRY(begin(model, constraint, model->time, &l));
    for (uint32_t k = 0; k < l.count; ++k) {
        const leaf *one = &l.leaves[k];
        bends[k] = one->is_velocity ? one->pace : 0.0;
        speeds[k] = one->is_velocity ? one->of.rate : 0.0;
        moves[k] = one->is_velocity || one->is_state ? 0.0 : one->pace;
        both[k] = moves[k] + speeds[k];
    }
    SE3DI_TRY(along(model, l.function, l.t, 0.0, bends, first));
    SE3DI_TRY(along(model, l.function, l.t, 0.0, moves, second[0]));
    SE3DI_TRY(along(model, l.function, l.t, 0.0, speeds, second[1]));
    SE3DI_TRY(along(model, l.function, l.t, 0.0, both, second[2]));
    *gamma = first[1] - l.own.curve + 0.5 * (second[2][2] - second[0][2] - second[1][2]);
    return SE3D_OK;
}

int se3di_driver_rate_draft(const se3di_model *model, uint32_t joint, int32_t coordinate,
                            int32_t function, const char *name, se3di_draft *draft)
{
    const se3di_function *of = &model->functions[function];
    const uint32_t leaves = se3di_law_count_leaves(model, of);
    se3di_driver_law_begin(model, joint, coordinate, function, name, draft);
    draft->constraint.law_class = &driver_rate;
    for (uint32_t k = 0; k < leaves; ++k) {
        const se3di_signal *signal = se3di_law_get_leaf(model, of, k);
        if (signal->kind != SE3D_SIGNAL_STATE &&
            !se3di_driver_law_add_bodies(model, signal, draft)) {
            return 0;
        }
    }
    return 1;
}
