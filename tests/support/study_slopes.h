/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of a study's measures by runs beside a point, extrapolated (Richardson). */
#ifndef SE3D_TESTS_SUPPORT_STUDY_SLOPES_H
#define SE3D_TESTS_SUPPORT_STUDY_SLOPES_H

#include "check.h"
#include "se3d/study.h"

enum { STUDY_SLOPES_MAX = 16 }; /* parameters, and measures */

/* `slopes` [measures] by the parameter `which` of the point `at` [parameters]. */
static inline void study_slopes(se3d_study *study, const double *at, size_t parameters,
                                size_t which, double *slopes, size_t measures)
{
    enum { LEVELS = 5 };
    double table[LEVELS][STUDY_SLOPES_MAX];
    double h = 0.02 * at[which];
    for (int n = 0; n < LEVELS; ++n, h *= 0.5) {
        double p[2][STUDY_SLOPES_MAX], y[2][STUDY_SLOPES_MAX];
        for (int side = 0; side < 2; ++side) {
            memcpy(p[side], at, parameters * sizeof *at);
            p[side][which] += side ? h : -h;
            CHECK(se3d_study_eval(study, p[side], y[side], NULL) == SE3D_OK);
        }
        for (size_t k = 0; k < measures; ++k) {
            double slope = (y[1][k] - y[0][k]) / (p[1][which] - p[0][which]), weight = 1.0;
            for (int i = 0; i < n; ++i) {
                const double before = table[i][k];
                table[i][k] = slope;
                weight *= 4.0;
                slope += (slope - before) / (weight - 1.0);
            }
            table[n][k] = slopes[k] = slope;
        }
    }
}

#endif
