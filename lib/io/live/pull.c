/* SPDX-License-Identifier: BSD-3-Clause */
/* A spring with a damper from a point of a body to a place, without a free length:
 *
 *     F = k (place - r - A s) - c (v + A (w x s)),     n = s x A^T F
 *
 * k makes the body alone swing 1.5 times a second, c lets it do so about once. */
#include "io/live/pull.h"

#include <math.h>
#include <string.h>

#include "io/base/rotation.h"
#include "math/vec3.h"

#define FREQUENCY 9.42477796076938 /* 3 pi [rad/s] */
#define DAMPING   0.5              /* of the critical one */

/* From the body's frame to the ground's. */
static void turn(const double p[4], const double v[3], double out[3])
{
    double A[9];
    se3di_rotation_to_matrix(p, A);
    se3di_mul(A, v, out);
}

static se3d_status pull_body(void *ctx, double t, const se3d_body_motion motion[2],
                             double wrench[12], double *K, double *D)
{
    const se3di_pull *pull = ctx;
    const se3d_body_motion *m = &motion[1];
    double turned[3];
    double arm[3];
    double rate[3];
    double force[3];
    (void)t;
    (void)K;
    (void)D;
    turn(m->p, pull->point, arm);
    se3di_cross(m->w, pull->point, turned);
    turn(m->p, turned, rate);
    for (int i = 0; i < 3; ++i) {
        force[i] = pull->k * (pull->place[i] - m->r[i] - arm[i]) - pull->c * (m->v[i] + rate[i]);
        wrench[i] = 0.0;
        wrench[3 + i] = 0.0;
        wrench[6 + i] = force[i];
    }
    se3di_rotation_apply_inverse(m->p, force, turned);
    se3di_cross(pull->point, turned, wrench + 9);
    return SE3D_OK;
}

static bool are_finite(const double v[3])
{
    return isfinite(v[0]) && isfinite(v[1]) && isfinite(v[2]);
}

static bool create(se3di_pull *pull, se3d_system *system)
{
    double mass = 0.0;
    int32_t fixed = 0;
    se3d_force_callback_def def = se3d_force_callback_def_default();
    if (se3d_body_get_fixed(system, pull->body, &fixed) < 0 || fixed ||
        se3d_body_get_mass(system, pull->body, &mass, NULL) < 0 || !(mass > 0.0)) {
        return false;
    }
    pull->k = mass * FREQUENCY * FREQUENCY;
    pull->c = 2.0 * DAMPING * mass * FREQUENCY;
    def.body_j = pull->body;
    def.callback = pull_body;
    def.ctx = pull;
    return se3d_system_get_ground(system, &def.body_i) >= 0 &&
           se3d_force_create_callback(system, &def, &pull->force) >= 0;
}

bool se3di_pull_set(se3di_pull *pull, se3d_system *system, se3d_body body, const double point[3],
                    const double place[3])
{
    if (!are_finite(point) || !are_finite(place)) {
        se3di_pull_release(pull, system);
        return false;
    }
    if (pull->force.index1 &&
        (pull->body.index1 != body.index1 || pull->body.generation != body.generation)) {
        se3di_pull_release(pull, system);
    }
    pull->body = body;
    memcpy(pull->point, point, sizeof pull->point);
    memcpy(pull->place, place, sizeof pull->place);
    if (pull->force.index1) {
        return se3d_system_touch(system) >= 0;
    }
    if (create(pull, system)) {
        return true;
    }
    se3di_pull_forget(pull);
    return false;
}

void se3di_pull_release(se3di_pull *pull, se3d_system *system)
{
    if (pull->force.index1) {
        (void)se3d_force_destroy(system, pull->force);
    }
    se3di_pull_forget(pull);
}

void se3di_pull_forget(se3di_pull *pull)
{
    memset(pull, 0, sizeof *pull);
}
