/* SPDX-License-Identifier: BSD-3-Clause */
#include "assembly/fused.h"

#include "math/quaternion.h"
#include "math/vec3.h"

#include <string.h>

#define BLOCK 6 /* of both formulations that are covered */

int se3di_fused_fits(const se3di_assembly *assembly, uint32_t joint)
{
    const se3di_constraint *constraint = &assembly->model->constraints[joint];
    return assembly->formulation->block == BLOCK && constraint->pattern != SE3DI_PATTERN_NONE &&
           constraint->bodies[0] != constraint->bodies[1];
}

/* Rows of a point that moves with a body, sign s: [s I, s s x (rows of A)]. */
static inline void put_point(double *restrict block, const se3di_frame *frame, const double p[3],
                             double s)
{
    const double q[3] = {s * p[0], s * p[1], s * p[2]};
    for (int k = 0; k < 3; ++k, block += BLOCK) {
        const double *a = frame->A + 3 * k;
        block[0] = block[1] = block[2] = 0.0;
        block[k] = s;
        block[3] = q[1] * a[2] - q[2] * a[1];
        block[4] = q[2] * a[0] - q[0] * a[2];
        block[5] = q[0] * a[1] - q[1] * a[0];
    }
}

/* A joint as the kernels see it. */
typedef struct fused_joint {
    const se3di_term *terms;
    const se3di_frame *i, *j;
    double *block_i, *block_j; /* NULL: the body is fixed */
    const double *f;           /* jets of the functions of time */
    double *gamma;             /* NULL: not wanted */
} fused_joint;

/* ---- r-omega ---- */

/* W (W.S) - S (W.W) with S = A s */
static inline void centripetal(const se3di_frame *frame, const double W[3], const double s[3],
                               double out[3])
{
    double S[3];
    se3di_mul(frame->A, s, S);
    const double along = se3di_dot(W, S), square = se3di_dot(W, W);
    for (int k = 0; k < 3; ++k) {
        out[k] = W[k] * along - S[k] * square;
    }
}

static inline void put_direction(double *block, const double A[9], const double n[3])
{
    block[0] = block[1] = block[2] = 0.0;
    se3di_mul_transposed(A, n, block + 3);
}

static inline void romega_directions(const fused_joint *joint, const double W_i[3],
                                     const double W_j[3])
{
    const se3di_frame *i = joint->i, *j = joint->j;
    double u[3], D[3], across[3];
    se3di_mul(j->A, joint->terms[3].a_j, u);
    se3di_sub(W_i, W_j, D);
    se3di_cross(W_i, W_j, across);
    const double square = se3di_dot(D, D), along = se3di_dot(D, u);
    for (int k = 3; k < 5; ++k) {
        double v[3], n[3], minus_n[3];
        se3di_mul(i->A, joint->terms[k].a_i, v);
        se3di_cross(v, u, n);
        if (joint->block_i) {
            put_direction(joint->block_i + k * BLOCK, i->A, n);
        }
        if (joint->block_j) {
            se3di_cross(u, v, minus_n);
            put_direction(joint->block_j + k * BLOCK, j->A, minus_n);
        }
        if (joint->gamma) {
            joint->gamma[k] = joint->f[3 * k + 2] - se3di_dot(n, across) +
                              square * se3di_dot(u, v) - along * se3di_dot(D, v);
        }
    }
}

static void romega_eval(const fused_joint *joint, int has_directions)
{
    const se3di_frame *i = joint->i, *j = joint->j;
    double W_i[3] = {0.0}, W_j[3] = {0.0}, arm_i[3], arm_j[3];
    if (joint->block_i) {
        put_point(joint->block_i, i, joint->terms[0].s_i, -1.0);
    }
    if (joint->block_j) {
        put_point(joint->block_j, j, joint->terms[0].s_j, 1.0);
    }
    if (joint->gamma) {
        se3di_mul(i->A, i->w, W_i);
        se3di_mul(j->A, j->w, W_j);
        centripetal(i, W_i, joint->terms[0].s_i, arm_i);
        centripetal(j, W_j, joint->terms[0].s_j, arm_j);
        for (int k = 0; k < 3; ++k) {
            joint->gamma[k] = joint->f[3 * k + 2] + arm_i[k] - arm_j[k];
        }
    }
    if (has_directions) {
        romega_directions(joint, W_i, W_j);
    }
}

/* ---- r-p, on the tangent ---- */

static inline void put_half(double *block, const double p[4], double s, const double x[4])
{
    double turned[3];
    se3di_g_mul(p, x, turned);
    se3di_scale(0.5 * s, turned, block + 3);
}

static inline void rp_point(double *block, const se3di_frame *frame, const double s[3], double sign)
{
    double B[12];
    se3di_b_matrix(frame->p, s, B);
    for (int k = 0; k < 3; ++k, block += BLOCK) {
        block[0] = block[1] = block[2] = 0.0;
        block[k] = sign;
        put_half(block, frame->p, sign, B + 4 * k);
    }
}

/* Z = 2 A(pdot) - 2 (pdot.pdot) A(p) */
static inline void velocity_matrix(const se3di_frame *frame, double Z[9])
{
    const double *q = frame->pdot;
    const double square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
    se3di_quat_to_matrix(q, Z);
    for (int k = 0; k < 9; ++k) {
        Z[k] = 2.0 * (Z[k] - square * frame->A[k]);
    }
}

static inline void rp_directions(const fused_joint *joint, const double Z_i[9], const double Z_j[9])
{
    const se3di_frame *i = joint->i, *j = joint->j;
    const double *a_j = joint->terms[3].a_j;
    double u[3], u_rate[3], u_term[3];
    se3di_mul(j->A, a_j, u);
    se3di_b_mul(j->p, a_j, j->pdot, u_rate);
    se3di_mul(Z_j, a_j, u_term);
    for (int k = 3; k < 5; ++k) {
        const double *a_i = joint->terms[k].a_i;
        double v[3], gradient[4];
        se3di_mul(i->A, a_i, v);
        if (joint->block_i) {
            double *block = joint->block_i + k * BLOCK;
            block[0] = block[1] = block[2] = 0.0;
            se3di_b_transposed_mul(i->p, a_i, u, gradient);
            put_half(block, i->p, 1.0, gradient);
        }
        if (joint->block_j) {
            double *block = joint->block_j + k * BLOCK;
            block[0] = block[1] = block[2] = 0.0;
            se3di_b_transposed_mul(j->p, a_j, v, gradient);
            put_half(block, j->p, 1.0, gradient);
        }
        if (joint->gamma) {
            double v_rate[3], v_term[3];
            se3di_b_mul(i->p, a_i, i->pdot, v_rate);
            se3di_mul(Z_i, a_i, v_term);
            joint->gamma[k] = joint->f[3 * k + 2] - se3di_dot(u, v_term) - se3di_dot(v, u_term) -
                              2.0 * se3di_dot(u_rate, v_rate);
        }
    }
}

static void rp_eval(const fused_joint *joint, int has_directions)
{
    const se3di_frame *i = joint->i, *j = joint->j;
    double Z_i[9] = {0.0}, Z_j[9] = {0.0}, arm_i[3], arm_j[3];
    if (joint->block_i) {
        rp_point(joint->block_i, i, joint->terms[0].s_i, -1.0);
    }
    if (joint->block_j) {
        rp_point(joint->block_j, j, joint->terms[0].s_j, 1.0);
    }
    if (joint->gamma) {
        velocity_matrix(i, Z_i);
        velocity_matrix(j, Z_j);
        se3di_mul(Z_i, joint->terms[0].s_i, arm_i);
        se3di_mul(Z_j, joint->terms[0].s_j, arm_j);
        for (int k = 0; k < 3; ++k) {
            joint->gamma[k] = joint->f[3 * k + 2] + arm_i[k] - arm_j[k];
        }
    }
    if (has_directions) {
        rp_directions(joint, Z_i, Z_j);
    }
}

void se3di_fused_eval(se3di_assembly *assembly, uint32_t joint, double *gamma)
{
    const se3di_model *model = assembly->model;
    const se3di_constraint *constraint = &model->constraints[joint];
    const se3di_term *terms = model->terms + constraint->term_begin;
    const se3di_term_place *place = &assembly->places[constraint->term_begin];
    const size_t *offset = assembly->block_offset + assembly->joint_begin[joint];
    const fused_joint seen = {
        .terms = terms,
        .i = &model->frames[terms[0].body_i],
        .j = &model->frames[terms[0].body_j],
        .block_i = place->slot_i >= 0 ? assembly->C + offset[place->slot_i] : NULL,
        .block_j = place->slot_j >= 0 ? assembly->C + offset[place->slot_j] : NULL,
        .f = assembly->f + 3 * (size_t)constraint->row_begin,
        .gamma = gamma,
    };
    if (assembly->formulation->id == SE3D_FORMULATION_RP) {
        rp_eval(&seen, constraint->pattern == SE3DI_PATTERN_HINGE);
    } else {
        romega_eval(&seen, constraint->pattern == SE3DI_PATTERN_HINGE);
    }
}

/* ---- curvature ---- */

/* block += s ~a ~b = s (b a^T - (a.b) I), in the rotational part of a 6 x 6 block */
static inline void add_double_tilde(double *block, double s, const double a[3], const double b[3])
{
    const double along = s * se3di_dot(a, b);
    for (int r = 0; r < 3; ++r) {
        double *row = block + BLOCK * (3 + r) + 3;
        for (int c = 0; c < 3; ++c) {
            row[c] += s * b[r] * a[c];
        }
        row[r] -= along;
    }
}

/* K_ij = -~alpha R ~a_j with R = A_i^T A_j, and its transpose. */
static void add_couplings(const se3di_frame *i, const se3di_frame *j, const double alpha[3],
                          const double a_j[3], const se3di_fused_blocks *blocks)
{
    double R[9], left[9], right[9], tilde[9];
    se3di_mat_mul_transposed(i->A, j->A, R);
    se3di_tilde(alpha, tilde);
    se3di_mat_mul(tilde, R, left);
    se3di_tilde(a_j, tilde);
    se3di_mat_mul(left, tilde, right);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            blocks->ij[BLOCK * (3 + r) + 3 + c] -= right[3 * r + c];
            blocks->ji[BLOCK * (3 + c) + 3 + r] -= right[3 * r + c];
        }
    }
}

void se3di_fused_add_curvature(const se3di_assembly *assembly, uint32_t joint, const double *lambda,
                               const se3di_fused_blocks *blocks)
{
    const se3di_model *model = assembly->model;
    const se3di_constraint *constraint = &model->constraints[joint];
    const se3di_term *terms = model->terms + constraint->term_begin;
    const se3di_frame *i = &model->frames[terms[0].body_i], *j = &model->frames[terms[0].body_j];
    double force[3], alpha[3], world[3], turned[3];
    if (blocks->ii) {
        se3di_mul_transposed(i->A, lambda, force);
        add_double_tilde(blocks->ii, -1.0, terms[0].s_i, force);
    }
    if (blocks->jj) {
        se3di_mul_transposed(j->A, lambda, force);
        add_double_tilde(blocks->jj, 1.0, terms[0].s_j, force);
    }
    if (constraint->row_count != 5) {
        return;
    }
    const double *a_j = terms[3].a_j;
    for (int k = 0; k < 3; ++k) {
        alpha[k] = lambda[3] * terms[3].a_i[k] + lambda[4] * terms[4].a_i[k];
    }
    if (blocks->ii) {
        se3di_mul(j->A, a_j, world);
        se3di_mul_transposed(i->A, world, turned);
        add_double_tilde(blocks->ii, 1.0, alpha, turned);
    }
    if (blocks->jj) {
        se3di_mul(i->A, alpha, world);
        se3di_mul_transposed(j->A, world, turned);
        add_double_tilde(blocks->jj, 1.0, a_j, turned);
    }
    if (blocks->ij) {
        add_couplings(i, j, alpha, a_j, blocks);
    }
}

/* ---- gradient of the rates ---- */

/* s (~p A^T) for the three rows of a point */
static void add_arms(double *block, double s, const double p[3], const double A[9])
{
    for (int k = 0; k < 3; ++k) {
        double arm[3];
        se3di_cross(p, A + 3 * k, arm);
        se3di_add_scaled(s, arm, block + BLOCK * k + 3);
    }
}

/* Of v.u, v = A a and its rate A (w x a) on this body, u and its rate W x u on the other one:
 * (w x a) x A^T u + a x A^T (W x u). */
static void add_turns(double *row, double c, const se3di_frame *frame, const double a[3],
                      const double u[3], const double u_rate[3])
{
    double rate[3], turned[3], part[3];
    se3di_cross(frame->w, a, rate);
    se3di_mul_transposed(frame->A, u, turned);
    se3di_cross(rate, turned, part);
    se3di_add_scaled(c, part, row + 3);
    se3di_mul_transposed(frame->A, u_rate, turned);
    se3di_cross(a, turned, part);
    se3di_add_scaled(c, part, row + 3);
}

/* A a and A (w x a) */
static void eval_direction(const se3di_frame *frame, const double a[3], double u[3], double rate[3])
{
    double local[3];
    se3di_cross(frame->w, a, local);
    se3di_mul(frame->A, a, u);
    se3di_mul(frame->A, local, rate);
}

void se3di_fused_add_rate_gradient(const se3di_assembly *assembly, uint32_t joint, double c,
                                   double *rows)
{
    const se3di_model *model = assembly->model;
    const se3di_constraint *constraint = &model->constraints[joint];
    const se3di_term *terms = model->terms + constraint->term_begin;
    const se3di_term_place *place = &assembly->places[constraint->term_begin];
    const size_t *offset = assembly->block_offset + assembly->joint_begin[joint];
    const se3di_frame *i = &model->frames[terms[0].body_i], *j = &model->frames[terms[0].body_j];
    double *block_i = place->slot_i >= 0 ? rows + offset[place->slot_i] : NULL;
    double *block_j = place->slot_j >= 0 ? rows + offset[place->slot_j] : NULL;
    double rate[3], u[3], v[3], u_rate[3], v_rate[3];
    if (block_i) {
        se3di_cross(i->w, terms[0].s_i, rate);
        add_arms(block_i, -c, rate, i->A);
    }
    if (block_j) {
        se3di_cross(j->w, terms[0].s_j, rate);
        add_arms(block_j, c, rate, j->A);
    }
    for (uint32_t k = 3; k < constraint->row_count; ++k) {
        eval_direction(i, terms[k].a_i, v, v_rate);
        eval_direction(j, terms[k].a_j, u, u_rate);
        if (block_i) {
            add_turns(block_i + BLOCK * k, c, i, terms[k].a_i, u, u_rate);
        }
        if (block_j) {
            add_turns(block_j + BLOCK * k, c, j, terms[k].a_j, v, v_rate);
        }
    }
}
