/* SPDX-License-Identifier: BSD-3-Clause */
/* Gyration in a step of convex: the moment -w_m x J w_m at the mean of the angular velocities at
 * both ends, w_m = (w_0 + w_1)/2, in the frame of the body. It keeps the energy, as it is across
 * w_m, and is of order 2.
 *
 * Of a body that nothing touches, w_1 is known by Newton's method. Of others it is what contacts
 * and constraints make of it: the moment follows from iteration to iteration, as the caps of
 * friction do,
 *
 *     g <- g + (I + G J^-1)^-1 (h w_m x J w_m - g),      G = h/2 (tilde(w_m) J - tilde(J w_m))
 *
 * which is Newton's step if nothing else answers, and comes nearer with any contacts, as G J^-1 is
 * nearly skew.                                                        docs/theory/convex.md */
#include "integrator/convex.h"

#include "math/vec3.h"

#include <string.h>

#define FREE_STEPS 30
#define NEAR       1e-9 /* of the momentum: changes that need no other iteration */

/* h w x J w, and its derivative by w */
static void moment_of(const double J[9], const double w[3], double h, double moment[3],
                      double slope[9])
{
    double L[3], W[9], tilde[9], WJ[9];
    se3di_mul(J, w, L);
    se3di_cross(w, L, moment);
    se3di_scale(h, moment, moment);
    se3di_tilde(w, W);
    se3di_tilde(L, tilde);
    se3di_mat_mul(W, J, WJ);
    for (int e = 0; e < 9; ++e) {
        slope[e] = h * (WJ[e] - tilde[e]);
    }
}

/* J (w - w_0) + h w_m x J w_m = h n, for w. */
void se3di_convex_turn_freely(const double J[9], const double w0[3], const double torque[3],
                              double h, double w[3])
{
    double wm[3];
    se3di_copy(w0, wm);
    for (int k = 0; k < FREE_STEPS; ++k) {
        double gyro[3], f[3], D[9], dw[3], turn[3];
        moment_of(J, wm, h, gyro, D);
        se3di_sub(wm, w0, turn);
        se3di_mul(J, turn, f);
        for (int e = 0; e < 9; ++e) {
            D[e] += 2.0 * J[e];
        }
        for (int e = 0; e < 3; ++e) {
            f[e] = h * torque[e] - 2.0 * f[e] - gyro[e];
        }
        se3di_solve3(D, f, dw);
        se3di_add(wm, dw, wm);
        if (!(se3di_norm(dw) > 1e-15 * se3di_norm(wm))) {
            break;
        }
    }
    for (int e = 0; e < 3; ++e) {
        w[e] = 2.0 * wm[e] - w0[e];
    }
}

static void inertia_of(const se3di_convex *c, size_t place, double J[9])
{
    for (size_t r = 0; r < 3; ++r) {
        memcpy(J + 3 * r, c->own + 36 * place + 6 * (3 + r) + 3, 3 * sizeof *J);
    }
}

/* The mean of w at both ends. */
static void middle_of(const double *start, const double *end, double w[3])
{
    se3di_add(start, end, w);
    se3di_scale(0.5, w, w);
}

void se3di_convex_gyrate_begin(se3di_convex *c, const se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < assembly->body_count; ++k) {
        const size_t place = (size_t)c->place[k];
        double *spin = c->spin + 6 * place, J[9], w[3], slope[9];
        if (!se3di_convex_takes_part(c, k)) {
            continue;
        }
        inertia_of(c, place, J);
        se3di_copy(c->start + 6 * (size_t)k + 3, spin);
        middle_of(spin, c->aim + 6 * (size_t)k + 3, w);
        moment_of(J, w, c->h, spin + 3, slope);
        se3di_add(spin, c->chord + 6 * (size_t)k + 3, spin);
    }
}

/* What is missing of the moment of a body, with what its own turning makes of it. Returns its
 * square, by the mobility. */
static double look(const se3di_convex *c, size_t place, double missing[3])
{
    const double *spin = c->spin + 6 * place, *inverse = c->mobility + 10 * place + 1;
    double J[9], w[3], G[9], D[9], gap[3], turned[3];
    inertia_of(c, place, J);
    middle_of(spin, c->v + 6 * place + 3, w);
    moment_of(J, w, 0.5 * c->h, gap, G);
    for (int e = 0; e < 3; ++e) {
        gap[e] = 2.0 * gap[e] - spin[3 + e];
    }
    se3di_mat_mul(G, inverse, D);
    for (int e = 0; e < 3; ++e) {
        D[4 * e] += 1.0;
    }
    se3di_solve3(D, gap, missing);
    se3di_mul(inverse, missing, turned);
    return se3di_dot(missing, turned);
}

void se3di_convex_gyrate(se3di_convex *c, const se3di_convex_island *island)
{
    double sum = 0.0, missing[3];
    for (size_t k = island->body; k < island->body_end; ++k) {
        sum += look(c, k, missing);
    }
    if (!(sum > NEAR * NEAR * island->momentum)) {
        return;
    }
    for (size_t k = island->body; k < island->body_end; ++k) {
        (void)look(c, k, missing);
        se3di_add(c->spin + 6 * k + 3, missing, c->spin + 6 * k + 3);
        se3di_add(c->moved + 6 * k + 3, missing, c->moved + 6 * k + 3);
    }
}

double se3di_convex_gyration_work(const se3di_convex *c, uint32_t body)
{
    const double *spin = c->spin + 6 * (size_t)c->place[body];
    double w[3];
    middle_of(spin, c->v + 6 * (size_t)body + 3, w);
    return se3di_dot(spin + 3, w);
}
