/* SPDX-License-Identifier: BSD-3-Clause */
/* Bushing: elastic and viscous connection of frame i (point s_i, axes R_i on body i) and frame j,
 *
 *     z = (u, theta),  u = R_i^T A_i^T d_ij,  exp(tilde(theta)) = R_i^T A_i^T A_j R_j
 *     V = 1/2 z^T K z,  n = K z + C zdot,  wrench = -sum_k n_k dz_k/dq
 *
 * u_k is a DP2. With Tinv the inverse tangent of the exponential map and turns dpi_i, dpi_j,
 * dtheta = Tinv R_j^T dpi_j - Tinv^T R_i^T dpi_i.  Degenerate at |theta| = pi, unless no angle has
 * a stiffness or damping: then none is computed.
 * docs/theory/bushing.md */
#include "force/measure.h"
#include "math/elementary.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/primitive.h"

#include <math.h>
#include <string.h>

typedef struct bushing_frames {
    double R_i[9], R_j[9]; /* frame -> body */
    double theta[3];
    double Tinv[9], Tinv_t[9]; /* and its transpose */
    double curve;              /* a: Tinv = I + tilde/2 + a tilde^2 */
    double curve_slope;        /* (da/dphi)/phi */
} bushing_frames;

static void read_angles(const se3di_model *model, const se3di_force *force, bushing_frames *f)
{
    double p_i[4], p_j[4];
    se3di_quat_to_matrix(force->p_j, f->R_j);
    se3di_quat_mul(model->frames[force->body_i].p, force->p_i, p_i);
    se3di_quat_mul(model->frames[force->body_j].p, force->p_j, p_j);
    se3di_quat_log(p_i, p_j, f->theta);
    se3di_exp_tangent_inverse(f->theta, f->Tinv);
    for (int k = 0; k < 9; ++k) {
        f->Tinv_t[k] = f->Tinv[3 * (k % 3) + k / 3];
    }
    double square = se3di_dot(f->theta, f->theta);
    if (square < 0.01) { /* series of a = (1 - (phi/2) cot(phi/2))/phi^2 */
        f->curve =
            1.0 / 12.0 + square * (1.0 / 720.0 + square * (1.0 / 30240.0 + square / 1209600.0));
        f->curve_slope =
            1.0 / 360.0 + square * (1.0 / 7560.0 + square * (1.0 / 201600.0 + square / 5987520.0));
    } else {
        double phi = sqrt(square);
        double half = 0.5 * phi / se3di_tan(0.5 * phi);
        double sine = se3di_sin(0.5 * phi);
        double half_slope = half / phi - 0.25 * phi / (sine * sine);
        f->curve = (1.0 - half) / square;
        f->curve_slope = (-half_slope / phi - 2.0 * f->curve) / square;
    }
}

/* The derivative to theta of y + sign/2 theta x y + a theta x (theta x y). */
static void differentiate(const bushing_frames *f, const double y[3], double sign, double M[9])
{
    double once[3], twice[3], Y[9], Once[9], Theta[9], product[9];
    se3di_cross(f->theta, y, once);
    se3di_cross(f->theta, once, twice);
    se3di_tilde(y, Y);
    se3di_tilde(once, Once);
    se3di_tilde(f->theta, Theta);
    se3di_mat_mul(Theta, Y, product);
    for (int k = 0; k < 9; ++k) {
        M[k] = -0.5 * sign * Y[k] - f->curve * (Once[k] + product[k]) +
               f->curve_slope * twice[k / 3] * f->theta[k % 3];
    }
}

/* H block (row, column) = scale R M T B^T */
static void set_block(double *H, int row, int column, double scale, const double R[9],
                      const double M[9], const double T[9], const double B[9])
{
    double RM[9], RMT[9];
    se3di_mat_mul(R, M, RM);
    se3di_mat_mul(RM, T, RMT);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            H[12 * (row + r) + column + c] = scale * se3di_dot(RMT + 3 * r, B + 3 * c);
        }
    }
}

static void measure_rotation(const bushing_frames *f, int axis, int wants_H, se3di_measure *measure)
{
    double y[3] = {0.0, 0.0, 0.0};
    double m_i[3], m_j[3], M[9];
    y[axis] = 1.0;
    memset(measure->g, 0, sizeof measure->g);
    measure->value = f->theta[axis];
    se3di_mul(f->Tinv, y, m_i);
    se3di_mul_transposed(f->Tinv, y, m_j);
    se3di_mul(f->R_i, m_i, measure->g + 3);
    se3di_scale(-1.0, measure->g + 3, measure->g + 3);
    se3di_mul(f->R_j, m_j, measure->g + 9);
    measure->rate = 0.0;
    for (int k = 0; k < 12; ++k) {
        measure->rate += measure->g[k] * measure->u[k];
    }
    if (wants_H) {
        memset(measure->H, 0, sizeof measure->H);
        differentiate(f, y, 1.0, M);
        set_block(measure->H, 3, 3, 1.0, f->R_i, M, f->Tinv_t, f->R_i);
        set_block(measure->H, 3, 9, -1.0, f->R_i, M, f->Tinv, f->R_j);
        differentiate(f, y, -1.0, M);
        set_block(measure->H, 9, 3, -1.0, f->R_j, M, f->Tinv_t, f->R_i);
        set_block(measure->H, 9, 9, 1.0, f->R_j, M, f->Tinv, f->R_j);
    }
}

/* How many coordinates act: 3 where nothing depends on the angles. */
static int count_coordinates(const se3di_force *force)
{
    for (int k = 0; k < 36; ++k) {
        if ((k >= 18 || k % 6 >= 3) && (force->K[k] != 0.0 || force->C[k] != 0.0)) {
            return 6;
        }
    }
    return 3;
}

static void measure_all(const se3di_model *model, const se3di_force *force, int count, int wants_H,
                        se3di_measure z[6])
{
    bushing_frames frames;
    se3di_quat_to_matrix(force->p_i, frames.R_i);
    for (int k = 0; k < 3; ++k) {
        se3di_term term;
        se3di_length_term(force, &term);
        term.type = SE3DI_PRIMITIVE_DP2;
        for (int c = 0; c < 3; ++c) {
            term.a_i[c] = frames.R_i[3 * c + k];
        }
        se3di_measure_term(model, &term, wants_H, &z[k]);
    }
    if (count > 3) {
        read_angles(model, force, &frames);
    }
    for (int k = 3; k < count; ++k) {
        se3di_velocity_pair(model, force, z[k].u);
        measure_rotation(&frames, k - 3, wants_H, &z[k]);
    }
}

static void add_derivatives(const se3di_force *force, const se3di_measure z[6], int count,
                            const double n[6], se3di_effect *effect)
{
    double rate_q[6][12]; /* d zdot / dq */
    for (int k = 0; k < count; ++k) {
        for (int c = 0; c < 12; ++c) {
            rate_q[k][c] = 0.0;
            for (int r = 0; r < 12; ++r) {
                rate_q[k][c] += z[k].u[r] * z[k].H[12 * r + c];
            }
        }
    }
    for (int k = 0; k < count; ++k) {
        double slope[12] = {0.0};
        double rate_slope[12] = {0.0};
        for (int l = 0; l < count; ++l) {
            for (int c = 0; c < 12; ++c) {
                slope[c] += force->K[6 * k + l] * z[l].g[c] + force->C[6 * k + l] * rate_q[l][c];
                rate_slope[c] += force->C[6 * k + l] * z[l].g[c];
            }
        }
        for (int e = 0; e < 144; ++e) {
            effect->K[e] -= z[k].g[e / 12] * slope[e % 12] + n[k] * z[k].H[e];
            effect->D[e] -= z[k].g[e / 12] * rate_slope[e % 12];
        }
    }
}

static se3d_status eval_bushing(const se3di_model *model, const se3di_force *force, double t,
                                se3di_effect *effect)
{
    (void)t;
    se3di_measure z[6];
    double n[6];
    const int count = count_coordinates(force);
    measure_all(model, force, count, effect->wants_derivative, z);
    for (int k = 0; k < count; ++k) {
        double elastic = 0.0;
        double viscous = 0.0;
        for (int l = 0; l < count; ++l) {
            elastic += force->K[6 * k + l] * z[l].value;
            viscous += force->C[6 * k + l] * z[l].rate;
        }
        n[k] = elastic + viscous;
        effect->potential += 0.5 * elastic * z[k].value;
        effect->power[0] += viscous * z[k].rate;
        for (int c = 0; c < 12; ++c) {
            effect->wrench[c] -= n[k] * z[k].g[c];
        }
    }
    if (effect->wants_derivative) {
        add_derivatives(force, z, count, n, effect);
    }
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_bushing = {
    .name = "bushing",
    .eval = eval_bushing,
    .traits = SE3DI_FORCE_IS_ELASTIC | SE3DI_FORCE_HOLDS,
};
