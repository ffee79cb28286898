/* SPDX-License-Identifier: BSD-3-Clause */
/* The numbers of radau. */
#include "integrator/radau_rule.h"

const double se3di_radau_c[3] = {0.15505102572168219, 0.64494897427831781, 1.0};
const double se3di_radau_a[3][3] = {
    {0.19681547722366042586, -0.0655354258501983881, 0.02377097434822015242},
    {0.39442431473908727699, 0.29207341166522846302, -0.0415487521259979301},
    {0.37640306270046727505, 0.51248582618842161383, 0.11111111111111111111},
};
const double se3di_radau_inverse[3][3] = {
    {3.22474487139158904909, 1.16784008469040549492, -0.2531972647421808261},
    {-3.5678400846904054949, 0.77525512860841095090, 1.05319726474218082618},
    {5.53197264742180826185, -7.5319726474218082618, 5.0},
};
const double se3di_radau_gamma = 0.235991;

/* P: found by a search for the least |M(z)^3|^(1/3) on the negative real axis, the imaginary axis
 * and between, M(z) = z (I - z P)^-1 (A - P). */
const double se3di_radau_lower[3][3] = {{0.0}, {1.33667, 0.0}, {-1.631173, 2.208706, 0.0}};
const double se3di_radau_upper[3][3] = {
    {1.0, -0.098781, -0.081871}, {0.0, 1.0, 0.092697}, {0.0, 0.0, 1.0}};

void se3di_radau_untransform(const double u[3], double h, double change[3])
{
    const double x0 = u[0];
    const double x1 = u[1] + se3di_radau_lower[1][0] * x0;
    const double x2 = u[2] + se3di_radau_lower[2][0] * x0 + se3di_radau_lower[2][1] * x1;
    const double x[3] = {x0 + se3di_radau_upper[0][1] * x1 + se3di_radau_upper[0][2] * x2,
                         x1 + se3di_radau_upper[1][2] * x2, x2};
    for (int i = 0; i < 3; ++i) {
        change[i] = 0.0;
        for (int j = 0; j < 3; ++j) {
            change[i] += se3di_radau_inverse[i][j] / h * x[j];
        }
    }
}
