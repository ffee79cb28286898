/* SPDX-License-Identifier: BSD-3-Clause */
/* Stop: a one-sided spring-damper at the ends of the range of a coordinate. With the penetration
 * delta >= 0,
 *
 *     n = k delta (1 + d(e) deltadot / v0), at least 0          against the penetration
 *
 * v0 is the speed of the impact (that of the last accepted state outside). Under this law alone a
 * mass leaves with exactly e v0, whatever its mass and k, because
 *
 *     v dv / (1 + d v/v0) = -(k/m) delta ddelta    from v0 to -e v0 gives
 *     d (1 + e) = ln((1 + d)/(1 - d e))
 *
 * state: [0] v0; [1], [2] the coordinate and its rate at the last accepted state.
 * docs/theory/stop.md */
#include "force/stop.h"
#include "force/measure.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define SPEED_MIN 1e-3  /* slower impacts are damped as this one */
#define ROUNDING  4e-15 /* of a coordinate, over the step, in the slope of its cubic */

double se3di_stop_damping(double e)
{
    double low = 0.0;
    double high = 1.0 / e;
    if (e >= 1.0) {
        return 0.0;
    }
    for (int k = 0; k < 200; ++k) {
        double d = 0.5 * (low + high);
        double gap = se3di_log1p(d) - se3di_log1p(-d * e) - d * (1.0 + e);
        if (gap < 0.0) {
            low = d;
        } else {
            high = d;
        }
    }
    return 0.5 * (low + high);
}

/* The signed penetration: positive beyond the upper end, negative below the lower one. */
static double penetration(const se3di_force *force, double x)
{
    if (x > force->high) {
        return x - force->high;
    }
    return x < force->low ? x - force->low : 0.0;
}

static double damping_of(const se3di_force *force)
{
    return force->c / fmax(force->state[0], SPEED_MIN);
}

double se3di_stop_get_damper(const se3di_force *force, double delta)
{
    return force->k * delta * damping_of(force);
}

static se3d_status eval_stop(const se3di_model *model, const se3di_force *force, double t,
                             se3di_effect *effect)
{
    (void)t;
    se3di_measure measure;
    int regular = se3di_measure_force(model, force, effect->wants_derivative, &measure);
    double delta = penetration(force, measure.value);
    const double damping = damping_of(force);
    se3di_law law = {0};
    if (fabs(delta) > 0.0) {
        if (!regular) {
            return SE3D_ERR_SINGULAR;
        }
        double inward = delta > 0.0 ? measure.rate : -measure.rate;
        double factor = 1.0 + damping * inward;
        if (factor > 0.0) {
            law.n = force->k * delta * factor;
            law.n_x = force->k * factor;
            law.n_rate = force->k * fabs(delta) * damping;
        }
        effect->potential = 0.5 * force->k * delta * delta;
        effect->power[0] = (law.n - force->k * delta) * measure.rate;
    }
    se3di_effect_add(effect, &measure, &law);
    return SE3D_OK;
}

static void accept_stop(const se3di_model *model, se3di_force *force)
{
    se3di_measure measure;
    (void)se3di_measure_force(model, force, 0, &measure);
    if (!(fabs(penetration(force, measure.value)) > 0.0)) {
        force->state[0] = fabs(measure.rate);
    } else if (!(force->state[0] > 0.0)) { /* it begins inside */
        force->state[0] = fmax(fabs(measure.rate), SPEED_MIN);
    }
    force->state[1] = measure.value;
    force->state[2] = measure.rate;
}

/* Hermite's cubic from a to b at the part s of h, and its slope. */
static double eval_cubic(const double a[2], const double b[2], double h, double s, double *slope)
{
    const double d = b[0] - a[0] - h * a[1], e = h * (b[1] - a[1]);
    *slope = a[1] + s * (6.0 * d - 2.0 * e + 3.0 * s * (e - 2.0 * d)) / h;
    return a[0] + s * (h * a[1] + s * (3.0 * d - e + s * (e - 2.0 * d)));
}

double se3di_stop_review(const se3di_model *model, const se3di_force *force, double h, double *part)
{
    const double begin[2] = {force->state[1], force->state[2]};
    double inside = 1.0, outside = 0.0, slope = 0.0;
    se3di_measure measure;
    *part = 0.0;
    (void)se3di_measure_force(model, force, 0, &measure);
    if (fabs(penetration(force, begin[0])) > 0.0 ||
        !(fabs(penetration(force, measure.value)) > 0.0)) {
        return 0.0;
    }
    const double end[2] = {measure.value, measure.rate};
    for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (outside + inside);
        const double x = eval_cubic(begin, end, h, middle, &slope);
        if (fabs(penetration(force, x)) > 0.0) {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    (void)eval_cubic(begin, end, h, inside, &slope);
    *part = inside;
    const double *const r[2] = {model->frames[force->body_i].r, model->frames[force->body_j].r};
    const int turns = force->coordinate == SE3D_JOINT_COORDINATE_ANGLE;
    const double size = fabs(end[0]) + (turns ? 1.0 : se3di_norm(r[0]) + se3di_norm(r[1]));
    const double gap = fabs(fmax(fabs(slope), SPEED_MIN) - fmax(force->state[0], SPEED_MIN));
    return fmax(0.0, gap - ROUNDING * size / h);
}

int se3di_stop_changes(const se3di_model *model, const se3di_force *force)
{
    se3di_measure measure;
    (void)se3di_measure_force(model, force, 0, &measure);
    return (fabs(penetration(force, force->state[1])) > 0.0) !=
           (fabs(penetration(force, measure.value)) > 0.0);
}

const se3di_force_class se3di_force_class_stop = {
    .name = "stop",
    .eval = eval_stop,
    .accept = accept_stop,
    .traits = SE3DI_FORCE_IS_SCALAR,
};
