/* SPDX-License-Identifier: BSD-3-Clause */
/* Friction on a joint coordinate x with load L (friction_load.c: times its arm on an angle):
 *
 *     stick   n = n_0 + s (x - z + T xdot) + viscous xdot        |n_0 + s (x - z)| <= F_s
 *     slip    n = +-F_c + viscous xdot                   in the direction of the motion
 *     F_c = mu L + limit,  F_s = mu_static L + limit,  s = F_s / presliding when it begins to stick
 *     T   = 2 sqrt(presliding / 10), 0 from 1e-7 on: what F_s decelerates by 10 m/s^2 is damped
 *           critically, as no method follows that vibration
 *
 * L belongs to the multipliers of the same instant: it is an unknown of the step. Whether it sticks
 * or slips, the anchor z, n_0 and s do not change within a step, so that the step solves smooth
 * equations. Fixed steps compare what they assumed with their end (`revise`) and are repeated if
 * they differ, the return mapping of elasto-plasticity; methods with error control change modes at
 * the ends of steps (integrator/memory.h). The energy of the spring is continuous.
 * docs/theory/friction.md */
#include "force/friction.h"
#include "force/measure.h"

#include <math.h>

enum {
    ANCHOR = SE3DI_FRICTION_ANCHOR,
    LOAD = SE3DI_FRICTION_LOAD,
    MODE = SE3DI_FRICTION_MODE,
    SET = SE3DI_FRICTION_SET,
    STIFFNESS = SE3DI_FRICTION_STIFFNESS,
    FORCE = SE3DI_FRICTION_FORCE,
    ENERGY = SE3DI_FRICTION_ENERGY,
    RATE = SE3DI_FRICTION_RATE
};

#define STALE 2.0  /* the stiffness of sticking follows the load in such factors */
#define CALM  10.0 /* F_s over the mass of what sticks, m/s^2 or rad/s^2, for critical damping */
#define RIGID 1e-7 /* a presliding below it, m or rad, stands for none; a larger one is elastic */

double se3di_friction_limit(const se3di_force *force, int slips)
{
    const double mu = slips ? force->mu : force->mu_static;
    return force->released ? 0.0 : mu * force->state[LOAD] + force->limit;
}

double se3di_friction_get_damper(const se3di_force *force, double s)
{
    return force->presliding < RIGID ? 2.0 * sqrt(force->presliding / CALM) * s : 0.0;
}

static double stick_damping(const se3di_force *force)
{
    return se3di_friction_get_damper(force, force->state[STIFFNESS]);
}

static double spring_force(const se3di_force *force, double x)
{
    return force->state[FORCE] + force->state[STIFFNESS] * (x - force->state[ANCHOR]);
}

static double stick_force(const se3di_force *force, double x, double rate)
{
    return spring_force(force, x) + stick_damping(force) * rate;
}

/* The energy that the spring holds more than at the anchor. */
static double stick_energy(const se3di_force *force, double x)
{
    const double stretch = x - force->state[ANCHOR];
    return stretch * (force->state[FORCE] + 0.5 * force->state[STIFFNESS] * stretch);
}

static double coordinate(const se3di_model *model, const se3di_force *force, double *rate)
{
    se3di_measure measure;
    (void)se3di_measure_force(model, force, 0, &measure);
    *rate = measure.rate;
    return measure.value;
}

double se3di_friction_get(const se3di_model *model, const se3di_force *force)
{
    double rate;
    if (!se3di_friction_sticks(force)) {
        return force->state[MODE] * se3di_friction_limit(force, 1);
    }
    const double x = coordinate(model, force, &rate);
    return force->state[SET] > 0.0 ? spring_force(force, x) : 0.0;
}

void se3di_friction_anchor(se3di_force *force, double x, double n)
{
    if (se3di_friction_sticks(force) && force->state[SET] > 0.0) {
        force->state[ENERGY] += stick_energy(force, x);
    }
    force->state[ANCHOR] = x;
    force->state[FORCE] = n;
    force->state[STIFFNESS] = se3di_friction_limit(force, 0) / force->presliding;
}

void se3di_friction_set(const se3di_model *model, se3di_force *force, double mode, double n)
{
    double rate;
    se3di_friction_anchor(force, coordinate(model, force, &rate), n);
    force->state[MODE] = mode;
    force->state[SET] = 1.0;
    force->state[RATE] = rate;
}

void se3di_friction_hold(const se3di_model *model, se3di_force *force, double n)
{
    double rate;
    force->state[ANCHOR] = coordinate(model, force, &rate);
    force->state[FORCE] = n;
    force->state[STIFFNESS] = 0.0;
}

void se3di_friction_shift(const se3di_model *model, se3di_force *force)
{
    double rate;
    const double x = coordinate(model, force, &rate);
    if (force->state[SET] > 0.0 && !se3di_friction_sticks(force)) {
        force->state[ANCHOR] = x;
        force->state[RATE] = rate;
    }
}

void se3di_friction_silence(se3di_force *force)
{
    force->state[FORCE] = force->state[STIFFNESS] = force->state[MODE] = 0.0;
}

static se3d_status eval_friction(const se3di_model *model, const se3di_force *force, double t,
                                 se3di_effect *effect)
{
    (void)t;
    se3di_measure measure;
    (void)se3di_measure_force(model, force, effect->wants_derivative, &measure);
    const int sticks = se3di_friction_sticks(force);
    const int holds = sticks && force->state[SET] > 0.0; /* else nothing to hold on to */
    se3di_law law = {.n_rate = force->viscous};
    effect->potential = force->state[ENERGY];
    if (holds) {
        const double damping = stick_damping(force);
        law.n = stick_force(force, measure.value, measure.rate);
        law.n_x = force->state[STIFFNESS];
        law.n_rate += damping;
        effect->power[0] += damping * measure.rate * measure.rate;
        effect->potential += stick_energy(force, measure.value);
    } else if (!sticks) {
        law.n = force->state[MODE] * se3di_friction_limit(force, 1);
        effect->power[0] = law.n * measure.rate;
    }
    law.n += force->viscous * measure.rate;
    effect->power[0] += force->viscous * measure.rate * measure.rate;
    se3di_effect_add(effect, &measure, &law);
    return SE3D_OK;
}

static uint32_t revise_friction(const se3di_model *model, se3di_force *force)
{
    double rate, mode = force->state[MODE];
    if (!(force->state[SET] > 0.0)) {
        return 0;
    }
    if (!se3di_friction_sticks(force)) { /* that of the load which came out */
        force->state[STIFFNESS] = se3di_friction_limit(force, 0) / force->presliding;
    }
    const double x = coordinate(model, force, &rate), n = spring_force(force, x);
    const double slip = se3di_friction_limit(force, 1);
    const double rounding = 2e-15 * force->state[STIFFNESS] * fabs(x) + 1e-12 * slip;
    if (!se3di_friction_sticks(force)) {
        mode = mode * n < slip - rounding ? 0.0 : mode;
    } else if (fabs(n) > se3di_friction_limit(force, 0) + rounding) {
        mode = n > 0.0 ? 1.0 : -1.0;
    }
    const int changes = fabs(mode - force->state[MODE]) > 0.0;
    force->state[MODE] = mode;
    return (uint32_t)changes;
}

void se3di_friction_begin(const se3di_model *model, se3di_force *force)
{
    double rate;
    const double x = coordinate(model, force, &rate);
    if (!(force->state[SET] > 0.0)) {
        const double mode = fabs(rate) > SE3DI_FRICTION_REST ? copysign(1.0, rate) : 0.0;
        se3di_friction_anchor(force, x, mode * se3di_friction_limit(force, 1));
        force->state[MODE] = mode;
        force->state[SET] = 1.0;
        force->state[RATE] = rate;
    }
}

/* It has turned back, and will not go on by itself. */
static int has_turned(const se3di_model *model, const se3di_force *force, double rate)
{
    const double mode = force->state[MODE];
    return mode * rate < 0.0 && !(mode * se3di_measure_acceleration(model, force) > 0.0);
}

static void accept_friction(const se3di_model *model, se3di_force *force)
{
    double rate;
    const double x = coordinate(model, force, &rate);
    se3di_friction_begin(model, force);
    force->state[RATE] = rate;
    if (!se3di_friction_sticks(force)) {
        se3di_friction_anchor(force, x, force->state[MODE] * se3di_friction_limit(force, 1));
        force->state[MODE] = has_turned(model, force, rate) ? 0.0 : force->state[MODE];
        return;
    }
    const double n = spring_force(force, x), limit = se3di_friction_limit(force, 0);
    const double fresh = limit / force->presliding;
    if (force->state[STIFFNESS] > STALE * fresh || force->state[STIFFNESS] < fresh / STALE) {
        se3di_friction_anchor(force, x, n);
    }
}

const se3di_force_class se3di_force_class_friction = {
    .name = "friction",
    .eval = eval_friction,
    .accept = accept_friction,
    .revise = revise_friction,
    .traits = SE3DI_FORCE_IS_SCALAR,
};
