/* SPDX-License-Identifier: BSD-3-Clause */
/* What rolls on a step bends away from the tangent plane. A mark that is left behind on a surface
 * with the curvatures S (a tensor in the tangent plane), by a way s over it, is seen at
 *
 *     x = s - h (s.Ss) Ss,      h = (1 - sin(v)/v)/v^2,      v = |Ss|
 *     s = x + g (x.Sx) Sx,      g = (asin(w)/w - 1)/w^2,     w = |Sx|
 *
 * in that plane: of a ball that has rolled by an angle theta at R sin(theta), not R theta. It is
 * exact for balls, and for cylinders across their axis, else to the third power of the way, with
 * the next term left out. Edges and corners do not roll. Derivatives take the curvatures of an
 * ellipsoid as those at the point.                               docs/theory/body-contact.md */
#include "contact/bodies/encounter.h"
#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>

#define SHARP   1e-3 /* of R*: what bends by less is an edge or a corner */
#define STEEP   0.9  /* of w^2: g grows no further */
#define SHALLOW 1e-4 /* of w^2: up to here by series */

/* The surface of body k about the point, and a way over it. */
typedef struct bent {
    double u[2][3], curvature[2]; /* principal */
    double a[2], q[2];            /* components of the way and of how far the normal turns on it */
    double along, w2;
} bent;

/* How deep the point is below the surface of body k, as a part of the overlap. */
static double share_of(const se3di_encounter *e, int k)
{
    return k ? 1.0 - e->at->share : e->at->share;
}

/* Whether the surface bends. */
static int get_curvature(const se3di_encounter *e, int k, double curvature[2])
{
    const se3di_bend *bend = k ? &e->at->bend_j : &e->at->bend_i;
    const double inside = share_of(e, k) * e->at->overlap;
    for (int m = 0; m < 2; ++m) {
        const double radius = bend->r[m] - inside;
        curvature[m] = radius < HUGE_VAL && radius > SHARP * e->radius ? 1.0 / radius : 0.0;
    }
    return curvature[0] > 0.0 || curvature[1] > 0.0;
}

/* Whether the way bends. */
static int set_bent(const se3di_encounter *e, int k, const double way[3], bent *b)
{
    if (!get_curvature(e, k, b->curvature)) {
        return 0;
    }
    b->along = b->w2 = 0.0;
    se3di_copy(k ? e->at->bend_j.u : e->at->bend_i.u, b->u[0]);
    se3di_cross(e->at->normal, b->u[0], b->u[1]);
    for (int m = 0; m < 2; ++m) {
        b->a[m] = se3di_dot(b->u[m], way);
        b->q[m] = b->curvature[m] * b->a[m];
        b->along += b->a[m] * b->q[m];
        b->w2 += b->q[m] * b->q[m];
    }
    return b->along > 0.0;
}

/* g, and its derivative with respect to w^2. */
static double unbend(double w2, double *slope)
{
    const double most = fmin(w2, STEEP);
    if (most < SHALLOW) {
        *slope = 3.0 / 40.0 + most * (15.0 / 168.0 + most * (105.0 / 1152.0));
        return 1.0 / 6.0 + most * (3.0 / 40.0 + most * (15.0 / 336.0));
    }
    const double w = sqrt(most), cosine = sqrt(1.0 - most);
    const double ratio = se3di_atan2(w, cosine) / w;
    const double g = (ratio - 1.0) / most;
    *slope = w2 < STEEP ? ((1.0 / cosine - ratio) / (2.0 * most) - g) / most : 0.0;
    return g;
}

void se3di_encounter_unroll(const se3di_encounter *e, int k, double mark[3])
{
    bent b;
    double way[3], slope;
    se3di_sub(mark, e->at->point, way);
    if (!set_bent(e, k, way, &b)) {
        return;
    }
    const double factor = unbend(b.w2, &slope) * b.along;
    for (int m = 0; m < 2; ++m) {
        se3di_add_scaled(factor * b.q[m], b.u[m], mark);
    }
}

void se3di_encounter_unroll_rate(const se3di_encounter *e, int k, const double turn[3],
                                 const double dn[3], const double dp[3], double ddelta,
                                 const double mark[3], double dmark[3])
{
    bent b;
    double way[3], dway[3], du[2][3], x[3], da[2], dq[2], slope;
    double dalong = 0.0, dw2 = 0.0;
    se3di_sub(mark, e->at->point, way);
    if (!set_bent(e, k, way, &b)) {
        return;
    }
    const double *n = e->at->normal;
    const double share = share_of(e, k);
    const double g = unbend(b.w2, &slope);
    se3di_sub(dmark, dp, dway);
    se3di_cross(turn, b.u[0], du[0]); /* the directions go with the body, in the tangent plane */
    se3di_add_scaled(-se3di_dot(n, du[0]) - se3di_dot(dn, b.u[0]), n, du[0]);
    se3di_cross(dn, b.u[0], du[1]);
    se3di_cross(n, du[0], x);
    se3di_add(du[1], x, du[1]);
    for (int m = 0; m < 2; ++m) {
        const double dcurvature = b.curvature[m] * b.curvature[m] * share * ddelta;
        da[m] = se3di_dot(du[m], way) + se3di_dot(b.u[m], dway);
        dq[m] = b.curvature[m] * da[m] + dcurvature * b.a[m];
        dalong += da[m] * b.q[m] + b.a[m] * dq[m];
        dw2 += 2.0 * b.q[m] * dq[m];
    }
    const double factor = g * b.along, dfactor = slope * dw2 * b.along + g * dalong;
    for (int m = 0; m < 2; ++m) {
        se3di_add_scaled(dfactor * b.q[m] + factor * dq[m], b.u[m], dmark);
        se3di_add_scaled(factor * b.q[m], du[m], dmark);
    }
}

void se3di_encounter_roll_up(const se3di_encounter *e, int k, const double way[3], double mark[3])
{
    bent b;
    if (!set_bent(e, k, way, &b)) {
        return;
    }
    const double v2 = fmin(b.w2, 1.0);
    const double h = 1.0 / 6.0 - v2 * (1.0 / 120.0 - v2 * (1.0 / 5040.0 - v2 / 362880.0));
    const double fall = 0.5 - v2 * (1.0 / 24.0 - v2 * (1.0 / 720.0 - v2 / 40320.0));
    for (int m = 0; m < 2; ++m) {
        se3di_add_scaled(-h * b.along * b.q[m], b.u[m], mark);
    }
    se3di_add_scaled((k ? 1.0 : -1.0) * fall * b.along, e->at->normal, mark);
}

/* a = 2 tan(angle/4), and its derivative */
static double half_turn(double angle, double *slope)
{
    const double x2 = angle * angle;
    *slope = 0.5 + x2 * (1.0 / 32.0 + x2 / 768.0);
    return angle * (0.5 + x2 * (1.0 / 96.0 + x2 / 3840.0));
}

void se3di_encounter_spins(const se3di_encounter *e, double spin[2])
{
    for (int k = 0; k < 2; ++k) {
        spin[k] = se3di_dot(e->w[k], e->at->normal) + se3di_dot(e->surface_w[k], e->at->normal);
    }
}

/* What a way is longer by the angle. */
static double lengthen(const se3di_encounter *e)
{
    return -(e->memory->spin[0] + e->memory->spin[1]) * e->elapsed / 24.0;
}

/* What the angle has more by the square of the way; `rate`, unless NULL: d of it by the overlap. */
static double bow(const se3di_encounter *e, double *rate)
{
    double sum = 0.0, change = 0.0;
    for (int k = 0; k < 2; ++k) {
        double curvature[2];
        if (get_curvature(e, k, curvature)) {
            const double part = (k ? 1.0 : -1.0) * curvature[0] * curvature[1] * e->memory->spin[k];
            sum += part;
            change += part * (curvature[0] + curvature[1]) * share_of(e, k);
        }
    }
    if (rate) {
        *rate = change * e->elapsed / 12.0;
    }
    return sum * e->elapsed / 12.0;
}

/* If one body spins on the other by an angle about the normal, the marks move apart without slip.
 * Ways of constant speed and curvature over both surfaces are parallel if they are turned back by
 * half of what they turn from the start to the point, and by what the area A = L^3 kappa/12
 * between a way and its chord adds on a surface of the Gaussian curvature K (Gauss-Bonnet), K A/2:
 *
 *     xi + 2 tan(angle/4) n x way,       way = point - middle of the marks,   L = |way|
 *
 * Their lengths differ by the angle times a twelfth of how the ways turn, in the mean: those of a
 * contact that goes straight on turn as the bodies do, back, kappa L = -spin t. */
void se3di_encounter_wander(se3di_encounter *e, const double middle[3])
{
    const double *n = e->at->normal;
    double way[3], across[3], slope;
    se3di_sub(e->at->point, middle, way);
    se3di_cross(n, way, across);
    const double angle = se3di_dot(e->turn, n) + bow(e, NULL) * se3di_dot(across, across);
    se3di_add_scaled(half_turn(angle, &slope), across, e->xi);
    se3di_add_scaled(-se3di_dot(n, way), n, way);
    se3di_add_scaled(angle * lengthen(e), way, e->xi);
}

void se3di_encounter_wander_rate(const se3di_encounter *e, const double middle[3], double ddelta,
                                 const double dn[3], const double dway[3], const double dturn[3],
                                 double dxi[3])
{
    const double *n = e->at->normal;
    double way[3], across[3], dacross[3], x[3], slope, rate;
    const double more = bow(e, &rate);
    se3di_sub(e->at->point, middle, way);
    se3di_cross(n, way, across);
    se3di_cross(dn, way, dacross);
    se3di_cross(n, dway, x);
    se3di_add(dacross, x, dacross);
    const double angle = se3di_dot(e->turn, n) + more * se3di_dot(across, across);
    const double dangle = se3di_dot(dturn, n) + se3di_dot(e->turn, dn) +
                          2.0 * more * se3di_dot(across, dacross) +
                          rate * ddelta * se3di_dot(across, across);
    se3di_add_scaled(half_turn(angle, &slope), dacross, dxi);
    se3di_add_scaled(slope * dangle, across, dxi);
    const double along = se3di_dot(n, way);
    const double dalong = se3di_dot(dn, way) + se3di_dot(n, dway);
    const double b = angle * lengthen(e), db = dangle * lengthen(e);
    se3di_add_scaled(db, way, dxi);
    se3di_add_scaled(b, dway, dxi);
    se3di_add_scaled(-db * along - b * dalong, n, dxi);
    se3di_add_scaled(-b * along, dn, dxi);
}
