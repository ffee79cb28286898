/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/pulse_step.h"

#include "model/integral.h"

#include <math.h>

#define CELL       0.0078125 /* s between places, if there are not more than */
#define PLACES_MAX 8192
#define PLACES_MIN 8
#define PART_MOST  0.1  /* of the range of a function within a step, that its ends do not tell */
#define FAINT      1e-9 /* of a function: such a range is none */
#define HALVES_MAX 30

/* Whether the ends of a step tell what a function does within: it stays between their values, or
 * near the polynomial. What cannot be computed is reported when it is used. */
static int is_told(const se3di_function *function, double t, double h)
{
    const double end = t + h;
    const int places = (int)fmin(PLACES_MAX, fmax(PLACES_MIN, ceil(h / CELL)));
    double a[3], b[3], least, most, apart = 0.0;
    if (se3di_function_eval(function, &t, a, NULL) < 0 ||
        se3di_function_eval(function, &end, b, NULL) < 0) {
        return 1;
    }
    /* a0 + h s a1 + (h s)^2 a2/2 + s^3 (c0 + s c1 + s^2 c2) */
    const double d0 = b[0] - a[0] - h * (a[1] + 0.5 * h * a[2]);
    const double d1 = h * (b[1] - a[1] - h * a[2]), d2 = h * h * (b[2] - a[2]);
    const double c0 = 10.0 * d0 - 4.0 * d1 + 0.5 * d2, c1 = -15.0 * d0 + 7.0 * d1 - d2,
                 c2 = 6.0 * d0 - 3.0 * d1 + 0.5 * d2;
    least = fmin(a[0], b[0]);
    most = fmax(a[0], b[0]);
    for (int k = 1; k < places; ++k) {
        const double s = (double)k / places, x = t + s * h;
        double jet[3];
        if (se3di_function_eval(function, &x, jet, NULL) < 0) {
            return 1;
        }
        const double told =
            a[0] + h * s * (a[1] + 0.5 * h * s * a[2]) + s * s * s * (c0 + s * (c1 + s * c2));
        apart = fmax(apart, fabs(jet[0] - told));
        least = fmin(least, jet[0]);
        most = fmax(most, jet[0]);
    }
    const double range = most - least;
    const double beyond = fmax(most - fmax(a[0], b[0]), fmin(a[0], b[0]) - least);
    return !(range > FAINT * fmax(fabs(least), fabs(most))) ||
           fmin(apart, beyond) <= PART_MOST * range;
}

/* A saw-tooth is for others to find. */
static double shorten(const se3di_model *model, int32_t index, double t, double h)
{
    const se3di_function *function = index >= 0 ? &model->functions[index] : NULL;
    se3di_function rate;
    double part = h;
    int halves = 0;
    if (function && function->integral) { /* what has a pulse there */
        rate = se3di_integral_rate(function);
        function = &rate;
    }
    if (!function || function->callback || function->signal_count > 0 ||
        !(function->expression || function->table)) {
        return h;
    }
    while (halves < HALVES_MAX && t + part > t && !is_told(function, t, part)) {
        part *= 0.5;
        ++halves;
    }
    return halves < HALVES_MAX ? part : h;
}

double se3di_pulse_step(const se3di_assembly *assembly, double t, double h)
{
    const se3di_model *model = assembly->model;
    if (!isfinite(h)) {
        return h;
    }
    for (uint32_t k = 0; k < assembly->timed_count; ++k) {
        h = shorten(model, model->rows[assembly->timed_rows[k]].function, t, h);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        const int is_load = force->type == SE3DI_FORCE_LOAD || force->type == SE3DI_FORCE_TORQUE;
        for (int c = 0; is_load && c < 3; ++c) {
            h = shorten(model, force->function[c], t, h);
        }
        for (int c = 0; force->type == SE3DI_FORCE_STATE && c < SE3DI_FORCE_FUNCTIONS; ++c) {
            h = shorten(model, force->function[c], t, h);
        }
    }
    for (int c = 0; c < 3; ++c) {
        h = shorten(model, model->gravity_function[c], t, h);
    }
    return h;
}
