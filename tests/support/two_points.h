/* SPDX-License-Identifier: BSD-3-Clause */
/* A constraint by callback whose second derivative couples two bodies in every direction. */
#ifndef SE3D_TESTS_SUPPORT_TWO_POINTS_H
#define SE3D_TESTS_SUPPORT_TWO_POINTS_H

#include "math/quaternion.h"
#include "math/vec3.h"
#include "se3d/se3d.h"

#include <math.h>

enum { TWO_POINTS_BODIES = 2, TWO_POINTS_EQUATIONS = 2 };

static const double two_points_at[TWO_POINTS_BODIES][3] = {{0.3, -0.2, 0.5}, {-0.4, 0.1, 0.2}};

/* With the points P_i, P_j of two bodies: P_i . P_j - sin 3t and P_i.x P_j.z + t^2 P_j.y. */
static inline se3d_status two_points(void *ctx, double t, const se3d_body_motion *bodies,
                                     double *phi, double *jacobian, double *nu, double *gamma)
{
    double P[TWO_POINTS_BODIES][3], Pdot[TWO_POINTS_BODIES][3], turned[TWO_POINTS_BODIES][3],
        A[TWO_POINTS_BODIES][9];
    (void)ctx;
    for (int k = 0; k < TWO_POINTS_BODIES; ++k) {
        const se3d_body_motion *b = &bodies[k];
        double wxs[3], wxwxs[3];
        se3di_quat_to_matrix(b->p, A[k]);
        se3di_mul(A[k], two_points_at[k], P[k]);
        se3di_add(P[k], b->r, P[k]);
        se3di_cross(b->w, two_points_at[k], wxs);
        se3di_cross(b->w, wxs, wxwxs);
        se3di_mul(A[k], wxs, Pdot[k]);
        se3di_add(Pdot[k], b->v, Pdot[k]);
        se3di_mul(A[k], wxwxs, turned[k]);
    }
    const double gradient[TWO_POINTS_EQUATIONS][TWO_POINTS_BODIES][3] = {
        {{P[1][0], P[1][1], P[1][2]}, {P[0][0], P[0][1], P[0][2]}},
        {{P[1][2], 0.0, 0.0}, {0.0, t * t, P[0][0]}}};
    if (phi) {
        phi[0] = se3di_dot(P[0], P[1]) - sin(3.0 * t);
        phi[1] = P[0][0] * P[1][2] + t * t * P[1][1];
    }
    if (nu) {
        nu[0] = 3.0 * cos(3.0 * t);
        nu[1] = -2.0 * t * P[1][1];
    }
    if (gamma) {
        gamma[0] = -2.0 * se3di_dot(Pdot[0], Pdot[1]) - 9.0 * sin(3.0 * t);
        gamma[1] = -2.0 * Pdot[0][0] * Pdot[1][2] - 4.0 * t * Pdot[1][1] - 2.0 * P[1][1];
    }
    for (int e = 0; e < TWO_POINTS_EQUATIONS; ++e) {
        for (int k = 0; k < TWO_POINTS_BODIES; ++k) {
            double local[3];
            se3di_mul_transposed(A[k], gradient[e][k], local);
            if (jacobian) {
                se3di_copy(gradient[e][k], jacobian + 6 * (TWO_POINTS_BODIES * e + k));
                se3di_cross(two_points_at[k], local,
                            jacobian + 6 * (TWO_POINTS_BODIES * e + k) + 3);
            }
            if (gamma) {
                gamma[e] -= se3di_dot(gradient[e][k], turned[k]);
            }
        }
    }
    return SE3D_OK;
}

#endif
