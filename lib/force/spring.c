/* SPDX-License-Identifier: BSD-3-Clause */
/* The law of TSDA and RSDA, with x = value - rest,
 *
 *     n = preload + k x + spring(x) + c xdot + damper(xdot) + h(t, value, rate)
 *     potential = preload x + k x^2 / 2 + integral of spring from 0 to x
 *     dissipated power = (c xdot + damper) xdot,  actuator power = -h xdot
 *
 * docs/theory/springs.md */
#include "force/signal.h"

#include <math.h>

#define PANELS 16

/* Nodes and weights of Gauss-Legendre, 5 points, on [-1, 1]. */
static const double gauss_node[5] = {-0.9061798459386640, -0.5384693101056831, 0.0,
                                     0.5384693101056831, 0.9061798459386640};
static const double gauss_weight[5] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                       0.4786286704993665, 0.2369268850561891};

static se3d_status integrate_panel(const se3di_function *function, double a, double b, double *sum)
{
    for (int k = 0; k < 5; ++k) {
        double x = 0.5 * (a + b) + 0.5 * (b - a) * gauss_node[k];
        double jet[3] = {0.0, 0.0, 0.0};
        SE3DI_TRY(se3di_function_eval(function, &x, jet, NULL));
        *sum += 0.5 * (b - a) * gauss_weight[k] * jet[0];
    }
    return SE3D_OK;
}

/* The integral from the first point of a table that repeats to x: whole periods, and a part. */
static se3d_status integrate_periodic(const se3di_function *function, double x, double *sum)
{
    const double *knot = function->table;
    const size_t last = function->table_count - 1;
    const double period = knot[last] - knot[0];
    const double periods = floor((x - knot[0]) / period);
    const double end = x - periods * period;
    double whole = 0.0;
    for (size_t k = 0; k < last; ++k) {
        SE3DI_TRY(integrate_panel(function, knot[k], knot[k + 1], &whole));
        if (knot[k] < end) {
            SE3DI_TRY(integrate_panel(function, knot[k], fmin(end, knot[k + 1]), sum));
        }
    }
    *sum += periods * whole;
    return SE3D_OK;
}

/* The integral from 0 to x: exact for tables (cubic between their points). */
static se3d_status integrate(const se3di_function *function, double x, double *sum)
{
    if (function->table && function->table_periodic) {
        double from_zero = 0.0;
        *sum = 0.0;
        SE3DI_TRY(integrate_periodic(function, 0.0, &from_zero));
        SE3DI_TRY(integrate_periodic(function, x, sum));
        *sum -= from_zero;
        return SE3D_OK;
    }
    double low = fmin(x, 0.0);
    double high = fmax(x, 0.0);
    double total = 0.0;
    double from = low;
    for (size_t k = 0; k < function->table_count; ++k) {
        double knot = function->table[k];
        if (knot > from && knot < high) {
            SE3DI_TRY(integrate_panel(function, from, knot, &total));
            from = knot;
        }
    }
    int panels = function->table ? 1 : PANELS;
    double width = (high - from) / panels;
    for (int k = 0; k < panels; ++k) {
        SE3DI_TRY(integrate_panel(function, from + k * width, from + (k + 1) * width, &total));
    }
    *sum = x < 0.0 ? -total : total;
    return SE3D_OK;
}

/* Spring and damper curves. */
static se3d_status add_curves(const se3di_model *model, const se3di_force *force, double x,
                              double rate, se3di_effect *effect, se3di_law *law)
{
    if (force->function[3] >= 0) {
        const se3di_function *spring = &model->functions[force->function[3]];
        double jet[3] = {0.0, 0.0, 0.0};
        double energy = 0.0;
        SE3DI_TRY(se3di_function_eval(spring, &x, jet, NULL));
        SE3DI_TRY(integrate(spring, x, &energy));
        law->n += jet[0];
        law->n_x += jet[1];
        effect->potential += energy;
    }
    if (force->function[4] >= 0) {
        double jet[3] = {0.0, 0.0, 0.0};
        SE3DI_TRY(se3di_function_eval(&model->functions[force->function[4]], &rate, jet, NULL));
        law->n += jet[0];
        law->n_rate += jet[1];
        effect->power[0] += jet[0] * rate;
    }
    return SE3D_OK;
}

static double stiffness_energy(const se3di_force *force, double x)
{
    return (force->preload + 0.5 * force->k * x) * x;
}

se3d_status se3di_spring_law(const se3di_model *model, const se3di_force *force, double t,
                             const se3di_measure *measure, se3di_effect *effect, se3di_law *law)
{
    double x = measure->value - force->rest;
    double rate = measure->rate;
    *law = (se3di_law){
        .n = force->preload + force->k * x + force->c * rate, .n_x = force->k, .n_rate = force->c};
    effect->potential = stiffness_energy(force, x);
    effect->power[0] = force->c * rate * rate;
    SE3DI_TRY(add_curves(model, force, x, rate, effect, law));
    if (force->function[0] >= 0) {
        const se3di_function *h = &model->functions[force->function[0]];
        const double variables[3] = {t, measure->value, rate};
        double jet[3] = {0.0, 0.0, 0.0};
        double gradient[SE3D_FUNCTION_VARIABLES_MAX] = {0.0};
        SE3DI_TRY(se3di_law_eval(model, h, variables, effect->notes, jet,
                                 effect->wants_derivative ? gradient : NULL));
        se3di_law_keep_own(h, gradient);
        law->n += jet[0];
        law->n_x += gradient[1];
        law->n_rate += gradient[2];
        effect->power[1] -= jet[0] * rate;
    }
    return SE3D_OK;
}

se3d_status se3di_spring_find_potential(const se3di_model *model, const se3di_force *force,
                                        double t, double *potential)
{
    double value;
    (void)t;
    if (force->function[0] >= 0 || force->function[3] >= 0 || force->function[4] >= 0 ||
        !se3di_measure_value(model, force, &value)) {
        return SE3DI_FORCE_LEFT; /* actuators and curves may fail, coinciding points too */
    }
    *potential = stiffness_energy(force, value - force->rest);
    return SE3D_OK;
}
