/* SPDX-License-Identifier: BSD-3-Clause */
/* Signals. A wrench Q = gain(q) f(t, own variables, s_1, s_2, ...) has, beside the derivatives of
 * an element by itself,
 *
 *     dQ/dq += gain f_s ds/dq        dQ/du += gain f_s ds/du
 *
 * in the columns of the bodies that the signal s is of, which need not be those of the element:
 *
 *     coordinate x of two bodies       x_q = g                    x_u = 0
 *     its rate xdot = g . u            x_q = u^T H                x_u = g
 *     point r + A s                    e . dr - e . A s~ dtheta
 *     its velocity v + A w~ s          -e . A (w~ s)~ dtheta      e . dv - e . A s~ dw
 *     Euler parameter p_k              1/2 (G^T dtheta)_k
 *     state z of a carrier             0                          (1, 0, 0) . dv
 *
 * Outputs and inputs of states are functions of signals themselves: what they depend on in the end
 * are the leaves of a law, with the products of the slopes on the way.
 *
 * docs/theory/signals.md */
#include "force/signal.h"

#include "math/quaternion.h"
#include "math/vec3.h"
#include "model/state.h"

#include <string.h>

static int is_of_joint(const se3di_signal *signal)
{
    return signal->kind == SE3D_SIGNAL_JOINT_COORDINATE || signal->kind == SE3D_SIGNAL_JOINT_RATE;
}

static int is_of_force(const se3di_signal *signal)
{
    return signal->kind == SE3D_SIGNAL_FORCE_COORDINATE || signal->kind == SE3D_SIGNAL_FORCE_RATE;
}

void se3di_signal_bodies(const se3di_model *model, const se3di_signal *signal, uint32_t bodies[2])
{
    bodies[0] = 0;
    bodies[1] = signal->body;
    if (is_of_joint(signal)) {
        bodies[0] = model->constraints[signal->joint].bodies[0];
        bodies[1] = model->constraints[signal->joint].bodies[1];
    } else if (is_of_force(signal)) {
        bodies[0] = model->forces[signal->force].body_i;
        bodies[1] = model->forces[signal->force].body_j;
    }
}

/* A coordinate of two bodies, or its rate. */
static se3d_status eval_coordinate(const se3di_model *model, const se3di_signal *signal,
                                   int wants_derivative, se3di_signal_value *out)
{
    se3di_measure m;
    const int is_rate =
        signal->kind == SE3D_SIGNAL_JOINT_RATE || signal->kind == SE3D_SIGNAL_FORCE_RATE;
    const int wants_H = wants_derivative && is_rate;
    if (is_of_joint(signal)) {
        se3di_measure_joint(model, signal->joint, signal->component, wants_H, &m);
    } else if (!se3di_measure_force(model, &model->forces[signal->force], wants_H, &m)) {
        return SE3D_ERR_SINGULAR;
    }
    out->value = is_rate ? m.rate : m.value;
    if (!wants_derivative) {
        return SE3D_OK;
    }
    memcpy(is_rate ? out->u : out->q, m.g, sizeof m.g);
    for (int c = 0; is_rate && c < 12; ++c) {
        for (int r = 0; r < 12; ++r) {
            out->q[c] += m.u[r] * m.H[12 * r + c];
        }
    }
    return SE3D_OK;
}

/* row = -(row `axis` of A s~) = row `axis` of A, times s from the left */
static void lever_row(const double A[9], const double s[3], int axis, double row[3])
{
    const double a[3] = {A[3 * axis], A[3 * axis + 1], A[3 * axis + 2]};
    se3di_cross(s, a, row);
}

/* A coordinate of a point or of its velocity. */
static double point_value(const se3di_frame *frame, const se3di_signal *signal)
{
    const int axis = signal->component;
    const double *row = frame->A + 3 * axis;
    double turned[3];
    if (signal->kind == SE3D_SIGNAL_POINT_POSITION) {
        return frame->r[axis] + se3di_dot(row, signal->point);
    }
    se3di_cross(frame->w, signal->point, turned);
    return frame->v[axis] + se3di_dot(row, turned);
}

static void eval_point(const se3di_frame *frame, const se3di_signal *signal,
                       se3di_signal_value *out)
{
    const int axis = signal->component;
    double turned[3];
    out->value = point_value(frame, signal);
    if (signal->kind == SE3D_SIGNAL_POINT_POSITION) {
        out->q[6 + axis] = 1.0;
        lever_row(frame->A, signal->point, axis, out->q + 9);
        return;
    }
    se3di_cross(frame->w, signal->point, turned);
    lever_row(frame->A, turned, axis, out->q + 9);
    out->u[6 + axis] = 1.0;
    lever_row(frame->A, signal->point, axis, out->u + 9);
}

const se3di_function *se3di_signal_function(const se3di_model *model, const se3di_signal *signal)
{
    if (signal->kind != SE3D_SIGNAL_STATE || signal->component == SE3D_STATE_VALUE) {
        return NULL;
    }
    const int32_t function =
        model->forces[signal->force].function[SE3DI_FORCE_OUTPUT - 1 + signal->component];
    return function >= 0 ? &model->functions[function] : NULL;
}

static const double *find_note(const se3di_law_notes *notes, const se3di_function *function)
{
    for (int32_t k = 0; notes && k < notes->count; ++k) {
        if (notes->function[k] == function) {
            return &notes->value[k];
        }
    }
    return NULL;
}

static void take_note(se3di_law_notes *notes, const se3di_function *function, double value)
{
    if (notes && notes->count < SE3DI_LAW_NOTES) {
        notes->function[notes->count] = function;
        notes->value[notes->count++] = value;
    }
}

/* The value of a state, or its output or input; without a function the output is the value, the
 * input 0. */
static se3d_status state_value(const se3di_model *model, const se3di_signal *signal, double t,
                               se3di_law_notes *notes, double *value)
{
    const se3di_function *function = se3di_signal_function(model, signal);
    const double *note = function ? find_note(notes, function) : NULL;
    double jet[3];
    *value = signal->component == SE3D_STATE_INPUT ? 0.0 : model->frames[signal->body].v[0];
    if (note) {
        *value = *note;
    } else if (function) {
        SE3DI_TRY(se3di_law_eval(model, function, &t, notes, jet, NULL));
        *value = jet[0];
        take_note(notes, function, *value);
    }
    return SE3D_OK;
}

static se3d_status eval_state(const se3di_model *model, const se3di_signal *signal, double t,
                              se3di_signal_value *out)
{
    const int is_own =
        signal->component != SE3D_STATE_INPUT && !se3di_signal_function(model, signal);
    out->u[6] = is_own ? 1.0 : 0.0;
    return state_value(model, signal, t, NULL, &out->value);
}

/* The value alone. */
static se3d_status find_value(const se3di_model *model, const se3di_signal *signal, double t,
                              se3di_law_notes *notes, double *value)
{
    const se3di_frame *frame = &model->frames[signal->body];
    if (is_of_joint(signal) || is_of_force(signal)) {
        se3di_signal_value out;
        SE3DI_TRY(eval_coordinate(model, signal, 0, &out));
        *value = out.value;
        return SE3D_OK;
    }
    if (signal->kind == SE3D_SIGNAL_STATE) {
        return state_value(model, signal, t, notes, value);
    }
    *value = signal->kind == SE3D_SIGNAL_ANGULAR_VELOCITY ? frame->w[signal->component]
             : signal->kind == SE3D_SIGNAL_ORIENTATION    ? frame->p[signal->component]
                                                          : point_value(frame, signal);
    return SE3D_OK;
}

se3d_status se3di_signal_eval(const se3di_model *model, const se3di_signal *signal, double t,
                              int wants_derivative, se3di_signal_value *out)
{
    memset(out, 0, sizeof *out);
    se3di_signal_bodies(model, signal, out->bodies);
    const se3di_frame *frame = &model->frames[signal->body];
    if (is_of_joint(signal) || is_of_force(signal)) {
        return eval_coordinate(model, signal, wants_derivative, out);
    }
    if (signal->kind == SE3D_SIGNAL_ANGULAR_VELOCITY) {
        out->value = frame->w[signal->component];
        out->u[9 + signal->component] = 1.0;
    } else if (signal->kind == SE3D_SIGNAL_STATE) {
        return eval_state(model, signal, t, out);
    } else if (signal->kind == SE3D_SIGNAL_ORIENTATION) {
        double G[12];
        se3di_g_matrix(frame->p, G);
        out->value = frame->p[signal->component];
        for (int c = 0; c < 3; ++c) {
            out->q[9 + c] = 0.5 * G[4 * c + signal->component];
        }
    } else {
        eval_point(frame, signal, out);
    }
    return SE3D_OK;
}

/* The value alone, the same bits; slopes that are infinite are no failure of an expression. */
static se3d_status find_law(const se3di_function *function, const double *x, double jet[3])
{
    jet[1] = jet[2] = 0.0;
    return function->expression && !function->integral
               ? se3d_expression_eval(function->expression, x, jet)
               : se3di_function_eval(function, x, jet, NULL);
}

se3d_status se3di_law_eval(const se3di_model *model, const se3di_function *function,
                           const double *own, se3di_law_notes *notes, double jet[3],
                           double *gradient)
{
    double x[SE3D_FUNCTION_VARIABLES_MAX] = {0.0};
    const uint32_t first = function->variable_count - function->signal_count;
    if (function->signal_count == 0) {
        return se3di_function_eval(function, own, jet, gradient);
    }
    memcpy(x, own, first * sizeof *x);
    for (uint32_t k = 0; k < function->signal_count; ++k) {
        SE3DI_TRY(find_value(model, &function->signals[k], own[0], notes, &x[first + k]));
    }
    return gradient ? se3di_function_eval(function, x, jet, gradient) : find_law(function, x, jet);
}

static int has_callback(const se3di_model *model, const se3di_function *function)
{
    int found = function->callback != NULL;
    for (uint32_t k = 0; k < function->signal_count && !found; ++k) {
        const se3di_function *inner = se3di_signal_function(model, &function->signals[k]);
        found = inner && has_callback(model, inner);
    }
    return found;
}

int se3di_law_has_callback(const se3di_model *model, const se3di_force *force)
{
    return force->function[0] >= 0 && has_callback(model, &model->functions[force->function[0]]);
}

void se3di_law_keep_own(const se3di_function *function, double *gradient)
{
    for (uint32_t k = function->variable_count - function->signal_count; k < 3; ++k) {
        gradient[k] = 0.0;
    }
}

/* Component c of a load, or of a torque, on body j. */
static void load_gain(const se3di_model *model, const se3di_force *force, int c, double gain[12])
{
    const se3di_frame *frame = &model->frames[force->body_j];
    double e[3] = {0.0, 0.0, 0.0};
    double local[3], ground[3];
    e[c] = 1.0;
    if (force->in_body_frame) {
        se3di_copy(e, local);
        se3di_mul(frame->A, e, ground);
    } else {
        se3di_copy(e, ground);
        se3di_mul_transposed(frame->A, e, local);
    }
    if (force->type == SE3DI_FORCE_TORQUE) {
        se3di_copy(local, gain + 9);
    } else {
        se3di_copy(ground, gain + 6);
        se3di_cross(force->s_j, local, gain + 9);
    }
}

void se3di_force_gain(const se3di_model *model, const se3di_force *force, int c, double gain[12])
{
    se3di_measure measure;
    memset(gain, 0, 12 * sizeof *gain);
    if (force->type == SE3DI_FORCE_STATE) {
        gain[6] = SE3DI_CARRIER_MASS;
        return;
    }
    if (force->type == SE3DI_FORCE_LOAD || force->type == SE3DI_FORCE_TORQUE) {
        load_gain(model, force, c, gain);
        return;
    }
    if (!se3di_measure_force(model, force, 0, &measure)) {
        return;
    }
    for (int k = 0; k < 12; ++k) { /* h acts against the coordinate, an effort along it */
        gain[k] = force->type == SE3DI_FORCE_EFFORT ? measure.g[k] : -measure.g[k];
    }
}

/* The variables that the element itself gives. */
static void own_variables(const se3di_model *model, const se3di_force *force, double t,
                          double own[3])
{
    se3di_measure m = {.value = 0.0, .rate = 0.0};
    if (force->type != SE3DI_FORCE_LOAD && force->type != SE3DI_FORCE_TORQUE &&
        force->type != SE3DI_FORCE_STATE) {
        (void)se3di_measure_force(model, force, 0, &m);
    }
    own[0] = t;
    own[1] = m.value;
    own[2] = m.rate;
}

uint32_t se3di_law_count_leaves(const se3di_model *model, const se3di_function *function)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < function->signal_count; ++s) {
        const se3di_function *inner = se3di_signal_function(model, &function->signals[s]);
        count += inner ? se3di_law_count_leaves(model, inner) : 1;
    }
    return count;
}

const se3di_signal *se3di_law_get_leaf(const se3di_model *model, const se3di_function *function,
                                       uint32_t k)
{
    for (uint32_t s = 0; s < function->signal_count; ++s) {
        const se3di_function *inner = se3di_signal_function(model, &function->signals[s]);
        const uint32_t count = inner ? se3di_law_count_leaves(model, inner) : 1;
        if (k < count) {
            return inner ? se3di_law_get_leaf(model, inner, k) : &function->signals[s];
        }
        k -= count;
    }
    return NULL;
}

/* The derivative of a function to its leaf k. */
static se3d_status leaf_slope(const se3di_model *model, const se3di_function *function,
                              const double *own, uint32_t k, double *slope)
{
    double jet[3], gradient[SE3D_FUNCTION_VARIABLES_MAX];
    SE3DI_TRY(se3di_law_eval(model, function, own, NULL, jet, gradient));
    for (uint32_t s = 0; s < function->signal_count; ++s) {
        const se3di_function *inner = se3di_signal_function(model, &function->signals[s]);
        const uint32_t count = inner ? se3di_law_count_leaves(model, inner) : 1;
        if (k < count) {
            double factor = 1.0;
            SE3DI_TRY(inner ? leaf_slope(model, inner, own, k, &factor) : SE3D_OK);
            *slope = factor * gradient[function->variable_count - function->signal_count + s];
            return SE3D_OK;
        }
        k -= count;
    }
    *slope = 0.0;
    return SE3D_OK;
}

se3d_status se3di_signal_tangent(const se3di_model *model, const se3di_force *force, int c,
                                 uint32_t leaf, double t, uint32_t bodies[2], double K[288],
                                 double D[288])
{
    const se3di_function *function = &model->functions[force->function[c]];
    double own[3], gain[12], slope;
    se3di_signal_value signal;
    own_variables(model, force, t, own);
    SE3DI_TRY(leaf_slope(model, function, own, leaf, &slope));
    SE3DI_TRY(se3di_signal_eval(model, se3di_law_get_leaf(model, function, leaf), t, 1, &signal));
    se3di_force_gain(model, force, c, gain);
    memcpy(bodies, signal.bodies, sizeof signal.bodies);
    for (int k = 0; k < 4; ++k) {
        for (int r = 0; r < 6; ++r) {
            const double row = slope * gain[6 * (k / 2) + r];
            for (int column = 0; column < 6; ++column) {
                K[72 * k + 12 * r + column] = row * signal.q[6 * (k % 2) + column];
                D[72 * k + 12 * r + column] = row * signal.u[6 * (k % 2) + column];
            }
        }
    }
    return SE3D_OK;
}
