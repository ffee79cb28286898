/* SPDX-License-Identifier: BSD-3-Clause */
/* Inertia tensors: principal moments by Jacobi rotations, and what is physical. */
#include "math/inertia.h"

#include "math/elementary.h"
#include "math/vec3.h"

#include <string.h>

/* Data sheets round their figures: a plate (c = a + b) must pass. */
#define RELATIVE_TOLERANCE 1e-9

/* Jacobi converges quadratically: five sweeps reach rounding for any 3 x 3 matrix. */
#define SWEEPS 8

void se3di_inertia_matrix(const double J[6], double M[9])
{
    M[0] = J[0];
    M[4] = J[1];
    M[8] = J[2];
    M[1] = M[3] = J[3];
    M[5] = M[7] = J[4];
    M[2] = M[6] = J[5];
}

/* Turn in the plane (r, s) so that the symmetric M loses its element (r, s); o is the third axis.
 * The columns of R turn along. */
static void rotate_away(double M[9], double R[9], int r, int s)
{
    const int o = 3 - r - s;
    const double off = M[3 * r + s];
    if (off == 0.0) {
        return;
    }
    /* tangent of the smaller angle: t^2 + 2 zeta t - 1 = 0 */
    const double zeta = (M[4 * s] - M[4 * r]) / (2.0 * off);
    const double t = copysign(1.0, zeta) / (fabs(zeta) + se3di_hypot(zeta, 1.0));
    const double cosine = 1.0 / se3di_hypot(t, 1.0);
    const double sine = t * cosine;
    const double ro = M[3 * r + o];
    const double so = M[3 * s + o];
    M[4 * r] -= t * off;
    M[4 * s] += t * off;
    M[3 * r + s] = M[3 * s + r] = 0.0;
    M[3 * r + o] = M[3 * o + r] = cosine * ro - sine * so;
    M[3 * s + o] = M[3 * o + s] = sine * ro + cosine * so;
    for (int row = 0; row < 9; row += 3) {
        const double before = R[row + r];
        R[row + r] = cosine * before - sine * R[row + s];
        R[row + s] = sine * before + cosine * R[row + s];
    }
}

static void order(double *low, double *high)
{
    if (*low > *high) {
        const double swap = *low;
        *low = *high;
        *high = swap;
    }
}

void se3di_inertia_axes(const double J[6], double moments[3], double R[9])
{
    static const double identity[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};
    double M[9];
    se3di_inertia_matrix(J, M);
    memcpy(R, identity, sizeof identity);
    for (int sweep = 0; sweep < SWEEPS; ++sweep) {
        rotate_away(M, R, 0, 1);
        rotate_away(M, R, 0, 2);
        rotate_away(M, R, 1, 2);
    }
    for (int k = 0; k < 3; ++k) {
        moments[k] = M[4 * k];
    }
}

void se3di_inertia_principal(const double J[6], double moments[3])
{
    double R[9];
    se3di_inertia_axes(J, moments, R);
    order(&moments[0], &moments[1]);
    order(&moments[1], &moments[2]);
    order(&moments[0], &moments[1]);
}

int se3di_inertia_is_physical(const double J[6])
{
    if (!se3di_is_finite(J, 6)) {
        return SE3DI_INERTIA_NOT_POSITIVE;
    }
    double m[3];
    se3di_inertia_principal(J, m);
    const double slack = RELATIVE_TOLERANCE * fmax(fabs(m[0]), fabs(m[2]));
    if (!(m[0] >= -slack)) {
        return SE3DI_INERTIA_NOT_POSITIVE;
    }
    /* m[2] - m[1], not m[0] + m[1]: cannot overflow */
    if (!(m[2] - m[1] <= m[0] + slack)) {
        return SE3DI_INERTIA_NOT_TRIANGLE;
    }
    return SE3DI_INERTIA_PHYSICAL;
}
