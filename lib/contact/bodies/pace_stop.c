/* SPDX-License-Identifier: BSD-3-Clause */
/* A stop is a contact of a coordinate x with the end of its range: half a period of what moves
 * there,
 *
 *     T = pi / sqrt(k W),  W = g M^-1 g^T,  g = dx/dq of the two bodies alone
 *
 * which joints can only lengthen. A coordinate that is apart from the end by a gap d, closing at
 * the speed s under the acceleration a, does not meet it before d / (s + sqrt(2 a d)): a step that
 * long lands where the impact begins, and the next one is a small part of T.
 * docs/theory/stop.md */
#include "contact/bodies/pace_stop.h"

#include "force/measure.h"
#include "force/stop.h"
#include "math/elementary.h"
#include "math/inertia.h"
#include "math/vec3.h"

#include <math.h>

#define PARTS        64.0 /* steps in the time of an impact */
#define LAND_PARTS   16.0 /* if the error is controlled */
#define STABLE_PARTS 3.0  /* fewer are refused; of explicit methods, see stable_step */
#define AT_REST      0.1  /* amplitude of a coordinate at rest on its stop over its penetration */
#define SHORT        1e-6 /* a long step ends so much before an impact begins */
#define SOFT         1e-9 /* m or rad: arrivals that move less in the time of an impact */

/* g M^-1 g^T of the free bodies of the element. */
static double inverse_mass(const se3di_model *model, const se3di_force *force,
                           const se3di_measure *measure)
{
    const uint32_t body[2] = {force->body_i, force->body_j};
    double sum = 0.0;
    for (int k = 0; k < 2; ++k) {
        const se3di_body *b = &model->bodies[body[k]];
        const double *g = measure->g + 6 * k;
        double J[9], turn[3];
        if (!b->fixed) {
            se3di_inertia_matrix(b->J, J);
            se3di_solve3(J, g + 3, turn);
            sum += se3di_dot(g, g) / b->mass + se3di_dot(g + 3, turn);
        }
    }
    return sum;
}

/* One end of the range: `gap` to it, `speed` and `acceleration` towards it. */
typedef struct arrival {
    double gap, speed, acceleration, time;
    double stable; /* step */
} arrival;

/* The impact is followed; if the stop is rested upon, only explicit methods need that, or what is
 * stable. */
static double pace_inside(const arrival *a, se3di_pace_kind kind, double parts, double h)
{
    const double rate = 3.14159265358979324 / a->time;
    const double amplitude = se3di_hypot(a->speed / rate, a->acceleration / (rate * rate));
    const int rests = amplitude < AT_REST * -a->gap;
    h = fmin(h, a->stable);
    return kind != SE3DI_PACE_EXPLICIT && rests ? h : fmin(h, a->time / parts);
}

static double pace_outside(const arrival *a, double parts, double h)
{
    const double closing = fmax(0.0, a->speed) + sqrt(2.0 * fmax(0.0, a->acceleration) * a->gap);
    if (!(a->gap < h * closing) || !(closing * a->time > SOFT)) {
        return h;
    }
    return fmin(h, fmax((1.0 - SHORT) * a->gap / closing, fmin(a->time / parts, a->stable)));
}

/* The force of an explicit step acts on where the speed of the impact carried the coordinate in the
 * step before: its impulse, k h^2 (1 + d) W of that speed, is to be no more than what stops it. So
 * is that of the damper beyond the end. A given step beyond that makes what rests on the stop
 * rattle. */
static double stable_step(const se3di_force *force, se3di_pace_kind kind, double parts,
                          const arrival *a, double inverse)
{
    const int is_explicit = kind == SE3DI_PACE_EXPLICIT;
    const int is_damped = is_explicit && parts > STABLE_PARTS;
    const double h = is_explicit ? a->time / (STABLE_PARTS * sqrt(1.0 + force->c)) : HUGE_VAL;
    const double damper = se3di_stop_get_damper(force, fmax(-a->gap, 0.0)) * inverse;
    return is_damped && damper * h > 1.0 ? 1.0 / damper : h;
}

static double pace_stop(const se3di_model *model, const se3di_force *force, se3di_pace_kind kind,
                        double parts, double h)
{
    se3di_measure measure;
    if (!se3di_measure_force(model, force, 0, &measure)) {
        return h;
    }
    const double inverse = inverse_mass(model, force, &measure);
    const double acceleration = se3di_measure_acceleration(model, force);
    for (int end = 0; end < 2 && inverse > 0.0; ++end) {
        const double limit = end ? force->high : force->low, way = end ? 1.0 : -1.0;
        arrival a = {.gap = way * (limit - measure.value),
                     .speed = way * measure.rate,
                     .acceleration = way * acceleration,
                     .time = 3.14159265358979324 / sqrt(force->k * inverse)};
        a.stable = stable_step(force, kind, parts, &a, inverse);
        if (isfinite(limit)) {
            h = a.gap > 0.0 ? pace_outside(&a, parts, h) : pace_inside(&a, kind, parts, h);
        }
    }
    return h;
}

/* *which: the element that limits the step. */
static double pace_all(const se3di_model *model, se3di_pace_kind kind, double parts, double h,
                       const se3di_force **which)
{
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        if (se3di_stop_acts(&model->forces[k])) {
            const double step = pace_stop(model, &model->forces[k], kind, parts, h);
            *which = step < h ? &model->forces[k] : *which;
            h = step;
        }
    }
    return h;
}

double se3di_stops_pace(const se3di_model *model, se3di_pace_kind kind, double h)
{
    const se3di_force *which = NULL;
    return pace_all(model, kind, kind == SE3DI_PACE_ADAPTIVE ? LAND_PARTS : PARTS, h, &which);
}

se3d_status se3di_stops_check_step(const se3di_model *model, se3di_pace_kind kind, double h,
                                   se3di_error *error)
{
    const se3di_force *which = NULL;
    const double step = pace_all(model, kind, STABLE_PARTS, h, &which);
    if (!which || !(step < h)) {
        return SE3D_OK;
    }
    const char *name = which->name ? which->name : "without a name";
    return se3di_error_set(error, SE3D_ERR_STEP_SIZE,
                           "t = %g s: a step of %g s is too large for the impact on the stop "
                           "%.60s; try at most %.3g s, or a run that chooses its steps",
                           model->time, h, name, se3di_stops_pace(model, kind, step));
}
