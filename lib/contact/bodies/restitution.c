/* SPDX-License-Identifier: BSD-3-Clause */
/* Restitution of a damped contact whose force never pulls.
 *
 * Hooke, with b = zeta w0 and w = sqrt(w0^2 - b^2): contact ends where the force first vanishes,
 *
 *     e = exp(-(b/w) (pi - atan2(2 b w, w^2 - b^2)))                      zeta < 1
 *     e = exp((b/q) log((b - q)/(b + q))),  q = sqrt(b^2 - w0^2)           zeta > 1
 *
 * (Schwager and Poeschel 2007). Hertz has no closed form: in u = x / x_scale the equation is free
 * of parameters but alpha, and is integrated once per trial. Both fall monotonically from 1, so the
 * inverse is found by bisection.                                    docs/theory/contact-laws.md */
#include "contact/bodies/restitution.h"
#include "math/elementary.h"

#include <math.h>

#define PI          3.1415926535897932384626433832795
#define HERTZ_STEP  2e-3
#define HERTZ_STEPS 200000
#define BISECTIONS  60

double se3di_restitution_hooke(double zeta)
{
    const double near_one = 1e-6;
    if (zeta > 1.0 - near_one && zeta < 1.0 + near_one) {
        return se3di_exp(-2.0); /* the limit; off by less than 1e-6 */
    }
    if (zeta < 1.0) {
        double w = sqrt(1.0 - zeta * zeta);
        return se3di_exp(-(zeta / w) * (PI - se3di_atan2(2.0 * zeta * w, w * w - zeta * zeta)));
    }
    double q = sqrt(zeta * zeta - 1.0);
    return se3di_exp(-(2.0 * zeta / q) * se3di_log(zeta + q)); /* (b-q)(b+q) = w0^2 */
}

static double hertz_force(double alpha, double x, double v)
{
    double root = sqrt(x > 0.0 ? x : 0.0);
    return x * root + alpha * sqrt(root) * v;
}

/* One step of Runge-Kutta 4 in time. */
static void hertz_step(double alpha, double h, double *x, double *v)
{
    double k1x = *v;
    double k1v = -hertz_force(alpha, *x, *v);
    double k2x = *v + 0.5 * h * k1v;
    double k2v = -hertz_force(alpha, *x + 0.5 * h * k1x, k2x);
    double k3x = *v + 0.5 * h * k2v;
    double k3v = -hertz_force(alpha, *x + 0.5 * h * k2x, k3x);
    double k4x = *v + h * k3v;
    double k4v = -hertz_force(alpha, *x + h * k3x, k4x);
    *x += h / 6.0 * (k1x + 2.0 * (k2x + k3x) + k4x);
    *v += h / 6.0 * (k1v + 2.0 * (k2v + k3v) + k4v);
}

double se3di_restitution_hertz(double alpha)
{
    double x = 0.0;
    double v = 1.0;
    for (int k = 0; k < HERTZ_STEPS; ++k) {
        /* Short steps first: x^.25 is not smooth where contact begins. */
        double h = k < 64 ? HERTZ_STEP / 64.0 : HERTZ_STEP;
        double x0 = x;
        double v0 = v;
        hertz_step(alpha, h, &x, &v);
        double after = x > 0.0 ? hertz_force(alpha, x, v) : -1.0;
        if (v < 0.0 && after <= 0.0) {
            double before = hertz_force(alpha, x0, v0);
            double share = before > 0.0 ? before / (before - after) : 0.0;
            return -(v0 + share * (v - v0));
        }
    }
    return -v; /* still creeping out: what is left is its restitution */
}

static double invert(double (*restitution)(double), double e)
{
    double low = 0.0;
    double high = 1.0;
    if (e >= 1.0) {
        return 0.0;
    }
    while (restitution(high) > e && high < 1e3) {
        high *= 2.0;
    }
    for (int k = 0; k < BISECTIONS && high - low > 1e-12 * high; ++k) {
        double middle = 0.5 * (low + high);
        if (restitution(middle) > e) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return 0.5 * (low + high);
}

double se3di_restitution_hooke_damping(double e)
{
    return invert(se3di_restitution_hooke, e);
}

double se3di_restitution_hertz_damping(double e)
{
    return invert(se3di_restitution_hertz, e);
}
