/* SPDX-License-Identifier: BSD-3-Clause */
/* Bushing: elastic and viscous connection of frame i (point s_i, axes R_i on body i) and frame j,
 *
 *     z = (u, theta),  u = R_i^T A_i^T d_ij,  exp(tilde(theta)) = R_i^T A_i^T A_j R_j
 *     V = 1/2 z^T K z,  n = K z + C zdot,  wrench = -sum_k n_k dz_k/dq
 *
 * u_k is a DP2. With Tinv the inverse tangent of the exponential map and turns dpi_i, dpi_j,
 * dtheta = Tinv R_j^T dpi_j - Tinv^T R_i^T dpi_i, so that torques are R_i Tinv n_theta and
 * -R_j Tinv^T n_theta.  Degenerate at |theta| = pi, unless no angle has a stiffness or damping:
 * then none is computed.
 * docs/theory/bushing.md */
#include "force/measure.h"
#include "math/elementary.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/primitive.h"

#include <math.h>
#include <string.h>

typedef struct bushing_frames {
    int count;             /* coordinates that act: 3 where nothing depends on the angles */
    double R_i[9], R_j[9]; /* frame -> body */
    double d[3];           /* A_i^T d_ij */
    double z[6];           /* u, theta */
    double Tinv[9];
    /* for derivatives: */
    double Tinv_t[9];   /* its transpose */
    double curve;       /* a: Tinv = I + tilde/2 + a tilde^2 */
    double curve_slope; /* (da/dphi)/phi */
} bushing_frames;

/* A coordinate acts, too, if all that is there is the sign of a zero. */
static int are_none(const double *values, size_t count)
{
    static const double none[18] = {0.0};
    return memcmp(values, none, count * sizeof *values) == 0;
}

static int count_coordinates(const se3di_force *force)
{
    int plain = are_none(force->K + 18, 18) && are_none(force->C + 18, 18);
    for (size_t row = 0; row < 18 && plain; row += 6) {
        plain = are_none(force->K + row + 3, 3) && are_none(force->C + row + 3, 3);
    }
    return plain ? 3 : 6;
}

/* The coordinates. */
static void take_frames(const se3di_model *model, const se3di_force *force, bushing_frames *f)
{
    const se3di_frame *i = &model->frames[force->body_i], *j = &model->frames[force->body_j];
    double arm_i[3], arm_j[3], d[3], p_i[4], p_j[4];
    f->count = count_coordinates(force);
    se3di_quat_to_matrix(force->p_i, f->R_i);
    se3di_mul(i->A, force->s_i, arm_i);
    se3di_mul(j->A, force->s_j, arm_j);
    for (int k = 0; k < 3; ++k) {
        d[k] = j->r[k] + arm_j[k] - i->r[k] - arm_i[k];
    }
    se3di_mul_transposed(i->A, d, f->d);
    se3di_mul_transposed(f->R_i, f->d, f->z);
    if (f->count > 3) {
        se3di_quat_to_matrix(force->p_j, f->R_j);
        se3di_quat_mul(i->p, force->p_i, p_i);
        se3di_quat_mul(j->p, force->p_j, p_j);
        se3di_quat_log(p_i, p_j, f->z + 3);
    }
}

/* Their rates; and Tinv. */
static void find_rates(const se3di_model *model, const se3di_force *force, bushing_frames *f,
                       double rate[6])
{
    const se3di_frame *i = &model->frames[force->body_i], *j = &model->frames[force->body_j];
    double swing[3], back[3], arm_i[3], arm_j[3], ddot[3], local[3];
    se3di_cross(i->w, force->s_i, swing);
    se3di_mul(i->A, swing, arm_i);
    se3di_cross(j->w, force->s_j, swing);
    se3di_mul(j->A, swing, arm_j);
    for (int k = 0; k < 3; ++k) {
        ddot[k] = j->v[k] + arm_j[k] - i->v[k] - arm_i[k];
    }
    se3di_mul_transposed(i->A, ddot, local);
    se3di_cross(i->w, f->d, swing);
    se3di_sub(local, swing, local);
    se3di_mul_transposed(f->R_i, local, rate);
    if (f->count > 3) {
        se3di_exp_tangent_inverse(f->z + 3, f->Tinv);
        se3di_mul_transposed(f->R_j, j->w, local);
        se3di_mul(f->Tinv, local, rate + 3);
        se3di_mul_transposed(f->R_i, i->w, local);
        se3di_mul_transposed(f->Tinv, local, back);
        se3di_sub(rate + 3, back, rate + 3);
    }
}

/* Of n, to the forces against the coordinates. */
static void add_wrench(const se3di_model *model, const se3di_force *force, const bushing_frames *f,
                       const double n[6], double wrench[12])
{
    const se3di_frame *i = &model->frames[force->body_i], *j = &model->frames[force->body_j];
    double own[3], F[3], arm[3], other[3], moment[3], turn[3];
    se3di_mul(f->R_i, n, own);
    se3di_mul(i->A, own, F);
    se3di_add(F, wrench, wrench);
    se3di_sub(wrench + 6, F, wrench + 6);
    se3di_add(f->d, force->s_i, arm);
    se3di_cross(arm, own, moment);
    se3di_add(wrench + 3, moment, wrench + 3);
    se3di_mul_transposed(j->A, F, other);
    se3di_cross(force->s_j, other, moment);
    se3di_sub(wrench + 9, moment, wrench + 9);
    if (f->count > 3) {
        se3di_mul(f->Tinv, n + 3, turn);
        se3di_mul(f->R_i, turn, moment);
        se3di_add(wrench + 3, moment, wrench + 3);
        se3di_mul_transposed(f->Tinv, n + 3, turn);
        se3di_mul(f->R_j, turn, moment);
        se3di_sub(wrench + 9, moment, wrench + 9);
    }
}

/* The elastic part of n, and the potential. */
static double stretch(const se3di_force *force, const bushing_frames *f, double n[6])
{
    double potential = 0.0;
    for (int k = 0; k < f->count; ++k) {
        n[k] = 0.0;
        for (int l = 0; l < f->count; ++l) {
            n[k] += force->K[6 * k + l] * f->z[l];
        }
        potential += 0.5 * n[k] * f->z[k];
    }
    return potential;
}

/* ---- Derivatives ---------------------------------------------------------------------------*/

static void find_curves(bushing_frames *f)
{
    for (int k = 0; k < 9; ++k) {
        f->Tinv_t[k] = f->Tinv[3 * (k % 3) + k / 3];
    }
    double square = se3di_dot(f->z + 3, f->z + 3);
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
    const double *theta = f->z + 3;
    double once[3], twice[3], Y[9], Once[9], Theta[9], product[9];
    se3di_cross(theta, y, once);
    se3di_cross(theta, once, twice);
    se3di_tilde(y, Y);
    se3di_tilde(once, Once);
    se3di_tilde(theta, Theta);
    se3di_mat_mul(Theta, Y, product);
    for (int k = 0; k < 9; ++k) {
        M[k] = -0.5 * sign * Y[k] - f->curve * (Once[k] + product[k]) +
               f->curve_slope * twice[k / 3] * theta[k % 3];
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

static void measure_rotation(const bushing_frames *f, int axis, se3di_measure *measure)
{
    double y[3] = {0.0, 0.0, 0.0};
    double m_i[3], m_j[3], M[9];
    y[axis] = 1.0;
    memset(measure->g, 0, sizeof measure->g);
    se3di_mul(f->Tinv, y, m_i);
    se3di_mul_transposed(f->Tinv, y, m_j);
    se3di_mul(f->R_i, m_i, measure->g + 3);
    se3di_scale(-1.0, measure->g + 3, measure->g + 3);
    se3di_mul(f->R_j, m_j, measure->g + 9);
    memset(measure->H, 0, sizeof measure->H);
    differentiate(f, y, 1.0, M);
    set_block(measure->H, 3, 3, 1.0, f->R_i, M, f->Tinv_t, f->R_i);
    set_block(measure->H, 3, 9, -1.0, f->R_i, M, f->Tinv, f->R_j);
    differentiate(f, y, -1.0, M);
    set_block(measure->H, 9, 3, -1.0, f->R_j, M, f->Tinv_t, f->R_i);
    set_block(measure->H, 9, 9, 1.0, f->R_j, M, f->Tinv, f->R_j);
}

/* Gradients and curvatures of the coordinates. */
static void measure_all(const se3di_model *model, const se3di_force *force, bushing_frames *f,
                        se3di_measure z[6])
{
    for (int k = 0; k < 3; ++k) {
        se3di_term term;
        se3di_length_term(force, &term);
        term.type = SE3DI_PRIMITIVE_DP2;
        for (int c = 0; c < 3; ++c) {
            term.a_i[c] = f->R_i[3 * c + k];
        }
        se3di_measure_term(model, &term, 1, &z[k]);
    }
    if (f->count > 3) {
        find_curves(f);
    }
    for (int k = 3; k < f->count; ++k) {
        se3di_velocity_pair(model, force, z[k].u);
        measure_rotation(f, k - 3, &z[k]);
    }
}

static void add_derivatives(const se3di_model *model, const se3di_force *force, bushing_frames *f,
                            const double n[6], se3di_effect *effect)
{
    const int count = f->count;
    se3di_measure z[6];
    double rate_q[6][12]; /* d zdot / dq */
    measure_all(model, force, f, z);
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

/* ---- The element ---------------------------------------------------------------------------*/

static se3d_status eval_bushing(const se3di_model *model, const se3di_force *force, double t,
                                se3di_effect *effect)
{
    (void)t;
    bushing_frames f;
    double rate[6], n[6];
    take_frames(model, force, &f);
    find_rates(model, force, &f, rate);
    effect->potential = stretch(force, &f, n);
    for (int k = 0; k < f.count; ++k) {
        double viscous = 0.0;
        for (int l = 0; l < f.count; ++l) {
            viscous += force->C[6 * k + l] * rate[l];
        }
        n[k] += viscous;
        effect->power[0] += viscous * rate[k];
    }
    add_wrench(model, force, &f, n, effect->wrench);
    if (effect->wants_derivative) {
        add_derivatives(model, force, &f, n, effect);
    }
    return SE3D_OK;
}

static se3d_status find_potential(const se3di_model *model, const se3di_force *force, double t,
                                  double *potential)
{
    (void)t;
    bushing_frames f;
    double n[6];
    take_frames(model, force, &f);
    *potential = stretch(force, &f, n);
    return SE3D_OK;
}

const se3di_force_class se3di_force_class_bushing = {
    .name = "bushing",
    .eval = eval_bushing,
    .find_potential = find_potential,
    .traits = SE3DI_FORCE_IS_ELASTIC | SE3DI_FORCE_HOLDS,
};
