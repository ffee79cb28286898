/* SPDX-License-Identifier: BSD-3-Clause */
/* Cohesion and adhesion in a step of convex. Of the attraction of the law
 *
 *     A = R* cohesion delta + 2 sqrt(R* pull_off E)        E = kn s delta
 *
 * which is not convex, a step has that of its beginning, or of its middle where it follows the
 * contact; friction does not see it. An impact of one step leaves at the speed at which its point
 * would by the law if it were alone, if it does.                       docs/theory/convex.md */
#include "integrator/convex.h"

#include "contact/bodies/law.h"
#include "math/elementary.h"

#include <math.h>

#define PHASE 0.05 /* of a swing of its spring, in a step */
#define STEPS 400  /* what is not out by then stays */

static int is_sticky(const se3di_pair *pair)
{
    return pair->cohesion > 0.0 || pair->pull_off > 0.0;
}

static double root_of(const se3di_pair *pair, double radius, double delta)
{
    return se3di_pair_is_hertz(pair) ? sqrt(radius * delta) : 1.0;
}

double se3di_convex_attraction(const se3di_pair *pair, double radius, double delta)
{
    if (!(delta > 0.0) || !is_sticky(pair)) {
        return 0.0;
    }
    const double elastic = pair->kn * root_of(pair, radius, delta) * delta;
    return pair->cohesion * radius * delta + 2.0 * sqrt(pair->pull_off * radius * elastic);
}

/* Its integral over the overlap. */
static double integral_of(const se3di_pair *pair, double radius, double delta)
{
    const double all = se3di_convex_attraction(pair, radius, delta);
    const double soft = pair->cohesion * radius * fmax(0.0, delta);
    return (0.5 * soft + (se3di_pair_is_hertz(pair) ? 4.0 / 7.0 : 2.0 / 3.0) * (all - soft)) *
           delta;
}

double se3di_convex_stuck(const se3di_model *model, const se3di_body_contact *r)
{
    const se3di_pair *pair = se3di_pair_of(model, r->shape_i, r->shape_j);
    return is_sticky(pair) && r->kind != SE3DI_CONTACT_PARTING
               ? integral_of(pair, se3di_convex_radius(model, r), r->overlap)
               : 0.0;
}

/* A point that comes at u, of the mass that it moves alone, followed until it is out (leapfrog).
 * Returns the speed at which it leaves, 0 if it stays. */
static double follow(const se3di_pair *pair, double radius, double inverse_mass, double u)
{
    const int hertz = se3di_pair_is_hertz(pair);
    const double k = pair->kn * (hertz ? sqrt(radius) : 1.0);
    const double stuck = hertz ? se3di_pow(4.0 * pair->pull_off * radius / k, 2.0 / 3.0) : 0.0;
    const double deep = hertz ? fmax(stuck, se3di_convex_hertz_depth(k, inverse_mass, u)) : 0.0;
    const double stiffness = k * (hertz ? 1.5 * sqrt(deep) : 1.0);
    const double h = PHASE / sqrt(stiffness * inverse_mass);
    double delta = 0.0, speed = u;
    for (int step = 0; step < STEPS; ++step) {
        const double middle = delta + 0.5 * h * speed, s = root_of(pair, radius, middle);
        const double damper = pair->dn * sqrt(s / inverse_mass);
        double now = speed;
        if (!(middle > 0.0)) {
            return -speed;
        }
        for (int look = 0; look < 2; ++look) { /* with the speed to be expected there */
            const double force = fmax(0.0, pair->kn * s * middle + damper * now) -
                                 se3di_convex_attraction(pair, radius, middle);
            now = speed - (look ? 1.0 : 0.5) * h * inverse_mass * force;
        }
        delta = middle + 0.5 * h * now;
        speed = now;
    }
    return 0.0;
}

double se3di_convex_leave(const se3di_model *model, const se3di_body_contact *r, double e, double u)
{
    const se3di_pair *pair = se3di_pair_of(model, r->shape_i, r->shape_j);
    return is_sticky(pair) && u > 0.0
               ? follow(pair, se3di_convex_radius(model, r), r->inverse_mass, u)
               : e * u;
}
