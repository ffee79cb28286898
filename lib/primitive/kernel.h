/* SPDX-License-Identifier: BSD-3-Clause */
/* What the primitives share: how a body-fixed vector a, A a in the ground frame, moves with its
 * body, in both formulations, and how curvature blocks are added.
 *
 *                              r-omega                       r-p
 *     gradient of (A a).y      a x A^T y                     B(p,a)^T y
 *     derivative D of A a      -A tilde(a)       (3 x 3)     B(p,a)           (3 x 4)
 *     rate                     A (w x a)                     B(p,a) pdot
 *     acceleration, velocity   A (w x (w x a))               B(pdot,a) pdot
 *       part
 *     derivative of gradient   tilde(a) tilde(A^T y)         K(a,y)
 *
 * The two columns are coded independently of each other, so that the tests' comparison of the
 * formulations compares two things. What is made of them is written once: `way` names the column.
 * docs/theory/rotations.md */
#ifndef SE3DI_PRIMITIVE_KERNEL_H
#define SE3DI_PRIMITIVE_KERNEL_H

#include "math/quaternion.h"
#include "math/vec3.h"
#include "primitive/primitive.h"

/* A function of both columns: callers give `way` as a constant, no choice is left when it runs. */
#ifdef __OPTIMIZE__
#define SE3DI_EITHER inline __attribute__((always_inline))
#else
#define SE3DI_EITHER inline
#endif

typedef enum se3di_way { SE3DI_WAY_ROMEGA, SE3DI_WAY_RP } se3di_way;

/* First column of the rotational block of body i in a term's rows, and the most columns of one. */
enum { SE3DI_ROTATION_I = 3, SE3DI_TERM_TOTAL = 14 };

/* Rotational unknowns of a body. */
static SE3DI_EITHER int se3di_turns(se3di_way way)
{
    return way == SE3DI_WAY_RP ? 4 : 3;
}

/* Columns of a term's rows. */
static SE3DI_EITHER int se3di_columns(se3di_way way)
{
    return 2 * (3 + se3di_turns(way));
}

/* First column of the rotational block of body j. */
static SE3DI_EITHER int se3di_rotation_j(se3di_way way)
{
    return 6 + se3di_turns(way);
}

static inline void se3di_romega_gradient(const se3di_frame *f, const double a[3], const double y[3],
                                         double out[3])
{
    double local[3];
    se3di_mul_transposed(f->A, y, local);
    se3di_cross(a, local, out);
}

static inline void se3di_rp_gradient(const se3di_frame *f, const double a[3], const double y[3],
                                     double out[4])
{
    se3di_b_transposed_mul(f->p, a, y, out);
}

static inline void se3di_romega_derivative(const se3di_frame *f, const double a[3], double D[9])
{
    for (int r = 0; r < 3; ++r) {
        se3di_cross(a, f->A + 3 * r, D + 3 * r); /* row r of -A tilde(a) is a x (row r of A) */
    }
}

static inline void se3di_rp_derivative(const se3di_frame *f, const double a[3], double D[12])
{
    se3di_b_matrix(f->p, a, D);
}

static inline void se3di_romega_rate(const se3di_frame *f, const double a[3], double out[3])
{
    double local[3];
    se3di_cross(f->w, a, local);
    se3di_mul(f->A, local, out);
}

static inline void se3di_rp_rate(const se3di_frame *f, const double a[3], double out[3])
{
    se3di_b_mul(f->p, a, f->pdot, out);
}

static inline void se3di_romega_velocity_term(const se3di_frame *f, const double a[3],
                                              double out[3])
{
    double once[3];
    double twice[3];
    se3di_cross(f->w, a, once);
    se3di_cross(f->w, once, twice);
    se3di_mul(f->A, twice, out);
}

static inline void se3di_rp_velocity_term(const se3di_frame *f, const double a[3], double out[3])
{
    se3di_b_mul(f->pdot, a, f->pdot, out);
}

static SE3DI_EITHER void se3di_gradient(se3di_way way, const se3di_frame *f, const double a[3],
                                        const double y[3], double *out)
{
    if (way == SE3DI_WAY_RP) {
        se3di_rp_gradient(f, a, y, out);
    } else {
        se3di_romega_gradient(f, a, y, out);
    }
}

static SE3DI_EITHER void se3di_derivative(se3di_way way, const se3di_frame *f, const double a[3],
                                          double *D)
{
    if (way == SE3DI_WAY_RP) {
        se3di_rp_derivative(f, a, D);
    } else {
        se3di_romega_derivative(f, a, D);
    }
}

static SE3DI_EITHER void se3di_rate(se3di_way way, const se3di_frame *f, const double a[3],
                                    double out[3])
{
    if (way == SE3DI_WAY_RP) {
        se3di_rp_rate(f, a, out);
    } else {
        se3di_romega_rate(f, a, out);
    }
}

static SE3DI_EITHER void se3di_velocity_term(se3di_way way, const se3di_frame *f, const double a[3],
                                             double out[3])
{
    if (way == SE3DI_WAY_RP) {
        se3di_rp_velocity_term(f, a, out);
    } else {
        se3di_romega_velocity_term(f, a, out);
    }
}

/* d_ij = r_j + A_j s_j - r_i - A_i s_i */
static inline void se3di_term_distance(const se3di_term *t, const se3di_frame *i,
                                       const se3di_frame *j, double d[3])
{
    double arm[3];
    se3di_mul(j->A, t->s_j, d);
    se3di_mul(i->A, t->s_i, arm);
    for (int k = 0; k < 3; ++k) {
        d[k] += j->r[k] - i->r[k] - arm[k];
    }
}

/* The rate of d_ij. */
static SE3DI_EITHER void se3di_distance_rate(se3di_way way, const se3di_term *t,
                                             const se3di_frame *i, const se3di_frame *j,
                                             double out[3])
{
    double arm[3];
    se3di_rate(way, j, t->s_j, out);
    se3di_rate(way, i, t->s_i, arm);
    for (int k = 0; k < 3; ++k) {
        out[k] += j->v[k] - i->v[k] - arm[k];
    }
}

/* The velocity part of the second time derivative of d_ij. */
static SE3DI_EITHER void se3di_distance_velocity_term(se3di_way way, const se3di_term *t,
                                                      const se3di_frame *i, const se3di_frame *j,
                                                      double out[3])
{
    double arm[3];
    se3di_velocity_term(way, j, t->s_j, out);
    se3di_velocity_term(way, i, t->s_i, arm);
    se3di_sub(out, arm, out);
}

/* The derivative of d_ij: [-I, -D(s_i), I, D(s_j)], 3 x 12 or 3 x 14, row-major. */
static SE3DI_EITHER void se3di_distance_derivative(se3di_way way, const se3di_term *t,
                                                   const se3di_frame *i, const se3di_frame *j,
                                                   double *D)
{
    const int m = se3di_turns(way);
    double D_i[12];
    double D_j[12];
    se3di_derivative(way, i, t->s_i, D_i);
    se3di_derivative(way, j, t->s_j, D_j);
    for (int r = 0; r < 3; ++r) {
        double *row = D + se3di_columns(way) * r;
        for (int c = 0; c < 3; ++c) {
            row[c] = r == c ? -1.0 : 0.0;
            row[3 + m + c] = r == c ? 1.0 : 0.0;
        }
        for (int c = 0; c < m; ++c) {
            row[SE3DI_ROTATION_I + c] = -D_i[m * r + c];
            row[se3di_rotation_j(way) + c] = D_j[m * r + c];
        }
    }
}

/* The block of H (row-major, n columns) that begins at (row, column). */
static inline double *se3di_block(double *H, int n, int row, int column)
{
    return H + (n * row + column);
}

/* block += s X^T Y, where X is 3 x rows and Y 3 x columns (row-major) and `n` is the number of
 * columns of the matrix that has the block. */
static inline void se3di_block_add_product(double *block, int n, double s, const double *X,
                                           int rows, const double *Y, int columns)
{
    for (int r = 0; r < rows; ++r) {
        const double x0 = s * X[r];
        const double x1 = s * X[rows + r];
        const double x2 = s * X[2 * rows + r];
        for (int c = 0; c < columns; ++c) {
            block[n * r + c] += x0 * Y[c] + x1 * Y[columns + c] + x2 * Y[2 * columns + c];
        }
    }
}

/* block += s times the derivative of the gradient of (A a).y, y fixed in the ground frame. */
static inline void se3di_romega_add_curvature(double *block, const se3di_frame *f, double s,
                                              const double a[3], const double y[3])
{
    double u[3];
    se3di_mul_transposed(f->A, y, u);
    const double along = s * se3di_dot(a, u);
    for (int r = 0; r < 3; ++r) {
        double *row = block + se3di_columns(SE3DI_WAY_ROMEGA) * r;
        for (int c = 0; c < 3; ++c) {
            row[c] += s * u[r] * a[c]; /* tilde(a) tilde(u) = u a^T - (a.u) I */
        }
        row[r] -= along;
    }
}

static inline void se3di_rp_add_curvature(double *block, double s, const double a[3],
                                          const double y[3])
{
    double K[16];
    se3di_k_matrix(a, y, K);
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
            block[se3di_columns(SE3DI_WAY_RP) * r + c] += s * K[4 * r + c];
        }
    }
}

static SE3DI_EITHER void se3di_add_curvature(se3di_way way, double *block, const se3di_frame *f,
                                             double s, const double a[3], const double y[3])
{
    if (way == SE3DI_WAY_RP) {
        se3di_rp_add_curvature(block, s, a, y);
    } else {
        se3di_romega_add_curvature(block, f, s, a, y);
    }
}

#endif
