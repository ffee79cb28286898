/* SPDX-License-Identifier: BSD-3-Clause */
/* CD: a coordinate difference, the component of the distance between two points along a direction
 * of the ground frame, is prescribed.
 *
 *     Phi     = c.(r_j + A_j s_j - r_i - A_i s_i)
 *     r-omega   phi_i = [-c, -s_i x A_i^T c]        phi_j = [c, s_j x A_j^T c]
 *               gamma = c.A_i (w_i x (w_i x s_i)) - c.A_j (w_j x (w_j x s_j))
 *     r-p       phi_i = [-c, -B(p_i,s_i)^T c]       phi_j = [c, B(p_j,s_j)^T c]
 *               gamma = c.B(pdot_i,s_i) pdot_i - c.B(pdot_j,s_j) pdot_j
 *
 * Removes one degree of freedom; never degenerate for c /= 0.  docs/theory/cd.md */
#include "primitive/kernel.h"
#include "primitive/table.h"

double se3di_primitive_cd_value(const se3di_term *t, const se3di_frame *i, const se3di_frame *j)
{
    double d[3];
    se3di_term_distance(t, i, j, d);
    return se3di_dot(t->c, d);
}

static SE3DI_EITHER void jacobian(se3di_way way, SE3DI_ON_TERM, double *phi_i, double *phi_j)
{
    se3di_copy(t->c, phi_j);
    se3di_scale(-1.0, t->c, phi_i);
    se3di_gradient(way, i, t->s_i, phi_i, phi_i + 3);
    se3di_gradient(way, j, t->s_j, phi_j, phi_j + 3);
}

static SE3DI_EITHER double gamma_of(se3di_way way, SE3DI_ON_TERM)
{
    double d_term[3];
    se3di_distance_velocity_term(way, t, i, j, d_term);
    return -se3di_dot(t->c, d_term);
}

/* In r-p independent of the pose: CD is quadratic in p. */
static SE3DI_EITHER void curvature(se3di_way way, SE3DI_ON_TERM, double lambda, double *H)
{
    const int n = se3di_columns(way), I = SE3DI_ROTATION_I, J = se3di_rotation_j(way);
    se3di_add_curvature(way, se3di_block(H, n, I, I), i, -lambda, t->s_i, t->c);
    se3di_add_curvature(way, se3di_block(H, n, J, J), j, lambda, t->s_j, t->c);
}

SE3DI_PRIMITIVE_JACOBIANS(cd, jacobian)
SE3DI_PRIMITIVE_GAMMAS(cd, gamma_of)
SE3DI_PRIMITIVE_CURVATURES(cd, curvature)
