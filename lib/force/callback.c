/* SPDX-License-Identifier: BSD-3-Clause */
/* Force callbacks: a user-defined wrench on two bodies. Without a user-defined Jacobian, central
 * differences stand in: enough for Newton, not for an exact linearisation.
 *
 * With an energy V and a dissipated power D of the user's own, what the element feeds in is
 * W . u + D + dV/dt. Its integral needs no dV/dt: the work of actuators counts W . u + D, and V as
 * it is now is added when somebody asks (assembly/energy.c).  docs/theory/loads.md */
#include "base/floats.h"
#include "force/measure.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define STEP   1e-6
#define MOMENT 1e-5 /* [m, rad]: how far the bodies move for the rate of an energy */

/* Displace coordinate k (0..5 body i, 6..11 body j) or velocity k - 12. */
static void displace(se3d_body_motion motion[2], int k, double by)
{
    se3d_body_motion *m = &motion[k % 12 / 6];
    int part = k % 6;
    if (k >= 12) {
        double *velocity = part < 3 ? m->v : m->w;
        velocity[part % 3] += by;
    } else if (part < 3) {
        m->r[part] += by;
    } else {
        double theta[3] = {0.0, 0.0, 0.0};
        theta[part - 3] = by;
        se3di_quat_rotate(m->p, theta, m->p);
    }
}

static se3d_status call(const se3di_force *force, double t, const se3d_body_motion motion[2],
                        double wrench[12], double *derivatives)
{
    memset(wrench, 0, 12 * sizeof *wrench);
    se3d_status status = force->callback(force->ctx, t, motion, wrench, derivatives,
                                         derivatives ? derivatives + 144 : NULL);
    se3di_floats_resume();
    if (status < 0) {
        return SE3D_ERR_CALLBACK;
    }
    return se3di_is_finite(wrench, 12) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

static se3d_status difference(const se3di_force *force, double t, const se3d_body_motion motion[2],
                              se3di_effect *effect)
{
    for (int k = 0; k < 24; ++k) {
        double *matrix = k < 12 ? effect->K : effect->D;
        double plus[12];
        double minus[12];
        se3d_body_motion moved[2] = {motion[0], motion[1]};
        displace(moved, k, STEP);
        SE3DI_TRY(call(force, t, moved, plus, NULL));
        moved[0] = motion[0];
        moved[1] = motion[1];
        displace(moved, k, -STEP);
        SE3DI_TRY(call(force, t, moved, minus, NULL));
        for (int r = 0; r < 12; ++r) {
            matrix[12 * r + k % 12] = (plus[r] - minus[r]) / (2.0 * STEP);
        }
    }
    return SE3D_OK;
}

static se3d_status call_energy(const se3di_force *force, double t, const se3d_body_motion motion[2],
                               double *potential, double *dissipated)
{
    *potential = *dissipated = 0.0;
    const se3d_status status = force->energy(force->ctx, t, motion, potential, dissipated);
    se3di_floats_resume();
    if (status < 0) {
        return SE3D_ERR_CALLBACK;
    }
    return isfinite(*potential) && isfinite(*dissipated) ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

static void get_motions(const se3di_model *model, const se3di_force *force,
                        se3d_body_motion motion[2])
{
    se3di_frame_get_motion(&model->frames[force->body_i], &motion[0]);
    se3di_frame_get_motion(&model->frames[force->body_j], &motion[1]);
}

static se3d_status find_energy(const se3di_model *model, const se3di_force *force, double t,
                               double *potential)
{
    se3d_body_motion motion[2];
    double dissipated;
    *potential = 0.0;
    if (!force->energy) {
        return SE3D_OK;
    }
    get_motions(model, force, motion);
    return call_energy(force, t, motion, potential, &dissipated);
}

/* The energy a while `by` later, if the velocities stay. */
static se3d_status energy_after(const se3di_force *force, double t,
                                const se3d_body_motion motion[2], double by, double *potential)
{
    se3d_body_motion moved[2] = {motion[0], motion[1]};
    double dissipated;
    for (int b = 0; b < 2; ++b) {
        double theta[3];
        se3di_add_scaled(by, moved[b].v, moved[b].r);
        se3di_scale(by, moved[b].w, theta);
        se3di_quat_rotate(moved[b].p, theta, moved[b].p);
    }
    return call_energy(force, t + by, moved, potential, &dissipated);
}

/* By central differences of fourth order along the motion. */
se3d_status se3di_callback_energy_rate(const se3di_model *model, const se3di_force *force, double t,
                                       double *rate)
{
    se3d_body_motion motion[2];
    double speed = 1.0;
    double near[2];
    double far[2];
    *rate = 0.0;
    if (!force->energy) {
        return SE3D_OK;
    }
    get_motions(model, force, motion);
    for (int b = 0; b < 2; ++b) {
        speed = fmax(speed, fmax(se3di_norm(motion[b].v), se3di_norm(motion[b].w)));
    }
    const double h = MOMENT / speed;
    for (int side = 0; side < 2; ++side) {
        const double by = side == 0 ? -h : h;
        SE3DI_TRY(energy_after(force, t, motion, by, &near[side]));
        SE3DI_TRY(energy_after(force, t, motion, 2.0 * by, &far[side]));
    }
    *rate = (8.0 * (near[1] - near[0]) - (far[1] - far[0])) / (12.0 * h);
    return SE3D_OK;
}

se3d_status se3di_callbacks_energy(const se3di_model *model, double t, double *potential)
{
    *potential = 0.0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        if (force->type == SE3DI_FORCE_CALLBACK && force->energy) {
            double own;
            SE3DI_TRY(find_energy(model, force, t, &own));
            *potential += own;
        }
    }
    return SE3D_OK;
}

static se3d_status eval_callback(const se3di_model *model, const se3di_force *force, double t,
                                 se3di_effect *effect)
{
    se3d_body_motion motion[2];
    double u[12];
    double derivatives[288] = {0.0};
    int own = effect->wants_derivative && force->has_jacobian;
    get_motions(model, force, motion);
    SE3DI_TRY(call(force, t, motion, effect->wrench, own ? derivatives : NULL));
    if (own) {
        memcpy(effect->K, derivatives, sizeof effect->K);
        memcpy(effect->D, derivatives + 144, sizeof effect->D);
    } else if (effect->wants_derivative) {
        SE3DI_TRY(difference(force, t, motion, effect));
    }
    se3di_velocity_pair(model, force, u);
    for (int k = 0; k < 12; ++k) {
        effect->power[1] += effect->wrench[k] * u[k];
    }
    if (force->energy) {
        SE3DI_TRY(call_energy(force, t, motion, &effect->potential, &effect->power[0]));
        effect->power[1] += effect->power[0];
    }
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_callback = {
    .name = "callback",
    .eval = eval_callback,
    .find_potential = find_energy,
};
