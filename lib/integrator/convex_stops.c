/* SPDX-License-Identifier: BSD-3-Clause */
/* Stops in a step of convex: contacts without friction, along a coordinate x of two bodies in place
 * of a point's normal. With g = dx/dq of a body's velocities (v, w) and n a unit vector, what moves
 * towards the stop is the velocity
 *
 *     reach v + n (g_w . w),    n . that = g . (v, w)
 *
 * n and reach = 1 from the gradient by v where that is a unit vector, as of displacements and
 * distances; reach = 0 for angles. All stops of a machine are in every step in which anything
 * touches it: what hits one body drives another onto its stop in the same step.
 *                                                                      docs/theory/convex.md */
#include "integrator/convex.h"

#include "force/force.h"
#include "force/measure.h"
#include "force/stop.h"
#include "math/vec3.h"

#include <math.h>

#define NEAR       2.0 /* steps at the speed of a coordinate: its stop may act in this one */
#define FAST_TIMES 2.0 /* an impact arrives so much faster than a step makes it */
#define SETTLING   4.0 /* steps in which a coordinate on its stop comes to rest */
#define RIGID      1e4 /* an impact of one step, over what moves its bodies as one */

/* The coordinate of a stop at the start of a step, and its acceleration in the one before. */
typedef struct coordinate {
    const se3di_force *force;
    se3di_measure measure;
    double acceleration;
} coordinate;

/* Returns 0 where the coordinate has no direction. */
static int look(const se3di_model *model, const se3di_force *force, coordinate *x)
{
    *x = (coordinate){.force = force};
    if (!se3di_stop_acts(force) || !se3di_measure_force(model, force, 0, &x->measure)) {
        return 0;
    }
    x->acceleration = se3di_measure_acceleration(model, force);
    return 1;
}

/* A free body that it acts on, the other one moves in steps as this one does; -1: on none. */
static int32_t body_of(const se3di_assembly *assembly, const se3di_force *force)
{
    const int32_t i = assembly->free_index[force->body_i];
    return i >= 0 ? i : assembly->free_index[force->body_j];
}

/* Towards the upper end, or the lower one: how far it is off, and its speed. */
static double gap_to(const coordinate *x, int upper, double *speed)
{
    const double way = upper ? 1.0 : -1.0;
    *speed = way * x->measure.rate;
    return way * ((upper ? x->force->high : x->force->low) - x->measure.value);
}

void se3di_convex_mark_stops(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    coordinate x;
    double speed;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const int32_t body = body_of(assembly, &model->forces[k]);
        if (body < 0 || c->asleep[body] || !look(model, &model->forces[k], &x)) {
            continue;
        }
        const double reach = NEAR * c->h * (fabs(x.measure.rate) + c->h * fabs(x.acceleration));
        if (gap_to(&x, 0, &speed) < reach || gap_to(&x, 1, &speed) < reach) {
            c->drifts[body] = 0;
        }
    }
}

/* The force of friction on the coordinate of a stop against what moves towards it. */
static double friction_on(const se3di_model *model, const se3di_convex_contact *stop)
{
    const se3di_force *own = stop->element;
    double sum = 0.0;
    for (size_t k = 0; k < model->force_slots.count && own->coordinate != SE3DI_FORCE_LENGTH; ++k) {
        const se3di_force *force = &model->forces[k];
        if (force->type == SE3DI_FORCE_FRICTION && force->joint == own->joint &&
            force->coordinate == own->coordinate) {
            sum += se3di_friction_get(model, force);
        }
    }
    return stop->upper ? sum : -sum;
}

/* What leaves the stop with the restitution times the speed that it meets it with: from a gap d
 * that closes at the speed u under the acceleration a it moves by v h from where it is, under an
 * acceleration b that friction has turned in, so that
 *
 *     v^2 + 2 b (d + h v) = e^2 (u^2 + 2 a d) */
static double rebound_of(const se3di_convex *c, const se3di_convex_contact *stop, double gap,
                         double inverse_mass)
{
    const double e = stop->element->restitution, a = stop->towards, h = c->h;
    const double b = a + 2.0 * inverse_mass * friction_on(c->model, stop);
    const double speed = -se3di_dot(stop->before, stop->normal);
    const double leaves = e * e * fmax(0.0, speed * speed + 2.0 * a * gap);
    const double square = b * b * h * h - 2.0 * b * gap + leaves;
    return square > 0.0 ? fmax(0.0, sqrt(square) - b * h) : 0.0;
}

int se3di_convex_stop_is_near(const se3di_convex_contact *stop, double h)
{
    const double speed = -se3di_dot(stop->before, stop->normal);
    return stop->overlap > 0.0 || -stop->overlap < h * (fabs(speed) + h * fabs(stop->towards));
}

/* The spring and the damper are those of the start of the step, to which velocities of half a step
 * before and after belong: the damper has a part of each. */
static void follow_law(se3di_convex_contact *stop, double delta, double speed, double h,
                       double inverse_mass)
{
    const se3di_force *force = stop->element;
    const double damper = se3di_stop_get_damper(force, delta);
    const double before = se3di_convex_before(damper, inverse_mass, h);
    stop->lead = se3di_convex_lead_of(force->k, inverse_mass, h);
    stop->damping = se3di_convex_ease(damper - before, stop->lead * force->k);
    stop->overlap += before * speed / force->k;
}

void se3di_convex_choose_stop(const se3di_convex *c, se3di_convex_contact *stop,
                              double inverse_mass)
{
    const se3di_force *force = stop->element;
    const double h = c->h;
    const double gap = -stop->overlap, speed = -se3di_dot(stop->before, stop->normal);
    const double change = h * fabs(stop->towards);
    const int meets = gap > -h * speed && gap < h * (speed + change);
    if (!se3di_convex_is_short(force->k, inverse_mass, h)) {
        follow_law(stop, fmax(0.0, -gap), speed, h, inverse_mass);
        return;
    }
    stop->damping = gap < 0.0 ? SETTLING * h * force->k : 0.0;
    if (meets && speed > FAST_TIMES * change) {
        stop->way = SE3DI_CONVEX_IMPACT;
        stop->damping = RIGID / inverse_mass;
        stop->rebound = rebound_of(c, stop, gap, inverse_mass);
    }
}

int se3di_convex_set_row(se3di_convex *c, const se3di_assembly *assembly, const double g[12],
                         double way, se3di_convex_contact *row)
{
    const uint32_t body[2] = {row->element->body_i, row->element->body_j};
    const double *along = g + 6;
    row->reach = se3di_dot(along, along) > 0.25 ? 1.0 : 0.0;
    se3di_scale(way, along, row->normal);
    if (!(row->reach > 0.0)) {
        row->normal[0] = 1.0;
    }
    for (int k = 0; k < 2; ++k) {
        const double *turn = g + 6 * k + 3;
        const double sign = k ? way : -way; /* velocities of i count as j's less */
        row->free[k] = assembly->free_index[body[k]];
        for (int r = 0; r < 3; ++r) {
            for (int e = 0; e < 3; ++e) {
                row->lever[k][3 * r + e] = sign * row->normal[r] * turn[e];
            }
        }
        if (row->free[k] >= 0) {
            c->touched[row->free[k]] = 1;
        }
    }
    se3di_convex_slip(row, c->start, row->before);
    if (assembly->row_count > 0) {
        se3di_convex_velocity(row, c->chord, row->chord);
    }
    return row->free[0] >= 0 || row->free[1] >= 0;
}

/* What its spring holds. */
static double energy_beyond(const se3di_convex_contact *stop, double depth)
{
    return depth > 0.0 ? 0.5 * stop->stiffness * depth * depth : 0.0;
}

static void add_end(se3di_convex *c, const se3di_assembly *assembly, const coordinate *x, int upper)
{
    se3di_convex_contact *stop = &c->contacts[c->contact_count];
    double speed;
    const double gap = gap_to(x, upper, &speed);
    *stop = (se3di_convex_contact){.coupling = -1,
                                   .element = x->force,
                                   .upper = upper,
                                   .way = SE3DI_CONVEX_SPRING,
                                   .stiffness = x->force->k,
                                   .power = 1.0,
                                   .lead = c->h,
                                   .overlap = -gap,
                                   .towards = (upper ? 1.0 : -1.0) * x->acceleration};
    if (!(gap < HUGE_VAL) ||
        !se3di_convex_set_row(c, assembly, x->measure.g, upper ? -1.0 : 1.0, stop)) {
        return;
    }
    stop->held = energy_beyond(stop, stop->overlap);
    ++c->contact_count;
}

se3d_status se3di_convex_collect_stops(se3di_convex *c, const se3di_assembly *assembly,
                                       se3di_error *error)
{
    const se3di_model *model = assembly->model;
    size_t count = 0;
    coordinate x;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        count += se3di_stop_acts(&model->forces[k]) ? 2 : 0;
    }
    SE3DI_TRY(se3di_convex_reserve(c, assembly, count, error));
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const int32_t body = body_of(assembly, &model->forces[k]);
        if (body >= 0 && !c->drifts[body] && !c->asleep[body] &&
            look(model, &model->forces[k], &x)) {
            add_end(c, assembly, &x, 0);
            add_end(c, assembly, &x, 1);
        }
    }
    return SE3D_OK;
}

double se3di_convex_apart_power(const se3di_model *model)
{
    double sum = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        const int is_apart = se3di_stop_acts(force) || force->type == SE3DI_FORCE_FRICTION;
        se3di_effect effect = {.wants_derivative = 0};
        if (is_apart && se3di_force_eval(model, force, model->time, &effect) >= 0) {
            sum += effect.power[0];
        }
    }
    return sum;
}

double se3di_convex_stopped(const se3di_convex *c, const se3di_model *model)
{
    double sum = 0.0;
    for (size_t k = c->roll_end; k < c->stop_end; ++k) {
        const se3di_convex_contact *stop = &c->contacts[k];
        const se3di_force *force = stop->element;
        double x;
        sum += se3di_convex_taken_by(stop) + stop->held;
        if (se3di_measure_value(model, force, &x)) {
            sum -= energy_beyond(stop, stop->upper ? x - force->high : force->low - x);
        }
    }
    return sum;
}
