/* SPDX-License-Identifier: BSD-3-Clause */
/* Surfaces that move on their bodies: belts, rollers, turntables. In the body's frame a place x of
 * the surface of a shape with its origin at o has the velocity
 *
 *     u = velocity + spin x (x - o)
 *
 * of which contact sees what is tangential. What contacts remember of the surface is carried along
 * with it, so that a body that sticks to a belt moves with it.       docs/theory/body-contact.md */
#include "contact/bodies/encounter.h"

#include "math/elementary.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

/* By the angle a about the axis e of the spin w (Rodrigues), and along by the integral of what has
 * turned: y = x - o obeys y' = v + w x y, so that with R = 1 + sin(a) e~ + (1 - cos(a)) e~ e~
 *
 *     y(t) = R y + e (e.v) t + (sin(a) / w) (v - e (e.v)) + ((1 - cos(a)) / w) e x v,  a = w t */
static void carry_round(const se3di_shape *s, double rate, double time, const double from[3],
                        double to[3])
{
    const double *v = s->surface_velocity;
    double arm[3], axis[3], across[3], half_sine, half_cosine;
    se3di_sincos(0.5 * rate * time, &half_sine, &half_cosine);
    const double sine = 2.0 * half_sine * half_cosine, versine = 2.0 * half_sine * half_sine;
    se3di_scale(1.0 / rate, s->surface_spin, axis);
    se3di_sub(from, s->x, arm);
    se3di_cross(axis, arm, across);
    se3di_copy(s->x, to);
    se3di_add_scaled(1.0 - versine, arm, to);
    se3di_add_scaled(sine, across, to);
    se3di_cross(axis, v, across);
    se3di_add_scaled(sine / rate, v, to);
    se3di_add_scaled(versine / rate, across, to);
    const double along = versine * se3di_dot(axis, arm) + (time - sine / rate) * se3di_dot(axis, v);
    se3di_add_scaled(along, axis, to);
}

void se3di_surface_carry(const se3di_shape *s, double time, const double from[3], double to[3])
{
    const double rate = se3di_norm(s->surface_spin);
    if (rate > 0.0) {
        carry_round(s, rate, time, from, to);
        return;
    }
    se3di_copy(from, to);
    se3di_add_scaled(time, s->surface_velocity, to);
}

void se3di_encounter_drift(se3di_encounter *e)
{
    const double *n = e->at->normal;
    memset(e->drift, 0, sizeof e->drift);
    memset(e->surface_w, 0, sizeof e->surface_w);
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *s = &e->model->shapes[k ? e->shape_j : e->shape_i];
        if (se3di_surface_moves(s)) {
            double u[3];
            se3di_surface_velocity(s, e->model->frames[e->body[k]].A, e->arm[k], u,
                                   e->surface_w[k]);
            se3di_add_scaled(k ? 1.0 : -1.0, u, e->drift);
        }
    }
    se3di_add_scaled(-se3di_dot(e->drift, n), n, e->drift);
}

void se3di_encounter_spin(const se3di_encounter *e, double spin[3])
{
    se3di_sub(e->w[1], e->w[0], spin);
    se3di_add(spin, e->surface_w[1], spin);
    se3di_sub(spin, e->surface_w[0], spin);
}

double se3di_encounter_fed(const se3di_encounter *e)
{
    double spin[3];
    se3di_sub(e->surface_w[1], e->surface_w[0], spin);
    return -se3di_dot(e->force, e->drift) - se3di_dot(e->moment, spin);
}

void se3di_encounter_drift_rate(const se3di_encounter *e, const se3di_encounter_change *c,
                                const double dp[3], const double dn[3], double drift[3],
                                double spin[3])
{
    const double *n = e->at->normal;
    double raw[3] = {0.0, 0.0, 0.0}, moved[3] = {0.0, 0.0, 0.0};
    memset(spin, 0, 3 * sizeof *spin);
    for (int k = 0; k < 2; ++k) {
        const se3di_shape *s = &e->model->shapes[k ? e->shape_j : e->shape_i];
        const double *A = e->model->frames[e->body[k]].A, sign = k ? 1.0 : -1.0;
        double u[3], w[3], du[3], dw[3], darm[3], x[3];
        if (!se3di_surface_moves(s)) {
            continue;
        }
        /* in the body's frame u changes by the way of the point in it alone */
        se3di_surface_velocity(s, A, e->arm[k], u, w);
        se3di_cross(c->turn[k], u, du);
        se3di_cross(c->turn[k], w, dw);
        se3di_sub(dp, c->r[k], darm);
        se3di_cross(c->turn[k], e->arm[k], x);
        se3di_sub(darm, x, darm);
        se3di_cross(w, darm, x);
        se3di_add(du, x, du);
        se3di_add_scaled(sign, u, raw);
        se3di_add_scaled(sign, du, moved);
        se3di_add_scaled(sign, dw, spin);
    }
    const double along = se3di_dot(n, raw), rate = se3di_dot(dn, raw) + se3di_dot(n, moved);
    se3di_copy(moved, drift);
    se3di_add_scaled(-rate, n, drift);
    se3di_add_scaled(-along, dn, drift);
}
