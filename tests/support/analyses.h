/* SPDX-License-Identifier: BSD-3-Clause */
/* The table of analyses and methods that every system-wide test runs through. */
#ifndef SE3D_TESTS_SUPPORT_ANALYSES_H
#define SE3D_TESTS_SUPPORT_ANALYSES_H

#include "se3d/se3d.h"

typedef struct support_analysis {
    const char *mechanism; /* of support/models.h */
    int count;
    int32_t analysis, method;
    double step, t_end;
} support_analysis;

static const support_analysis support_analyses[] = {
    {"driven_four_bar", 1, SE3D_ANALYSIS_ASSEMBLY, SE3D_METHOD_AUTO, 0.01, 0.1},
    {"driven_four_bar", 1, SE3D_ANALYSIS_KINEMATICS, SE3D_METHOD_AUTO, 0.01, 0.2},
    {"driven_slider_crank", 1, SE3D_ANALYSIS_INVERSE_DYNAMICS, SE3D_METHOD_AUTO, 0.01, 0.2},
    {"driven_double_pendulum", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_AUTO, 0.005, 0.2},
    {"four_bar", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GENERALIZED_ALPHA, 0.005, 0.2},
    {"slider_crank", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_HHT, 0.002, 0.1},
    {"heavy_top", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GENERALIZED_ALPHA, 0.001, 0.1},
    {"chain_ball", 6, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_HHT, 0.002, 0.1},
    {"chain_revolute", 8, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GENERALIZED_ALPHA, 0.002, 0.1},
    {"four_bar", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_DOP853, 0.02, 0.4},
    {"chain_ball", 4, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_RK45, 0.01, 0.3},
    {"chain_revolute", 3, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_RK4, 0.01, 0.2},
    {"chain_ball", 3, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_GAUSS, 0.01, 0.3},
    {"heavy_top", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_RATTLE, 0.001, 0.1},
    {"driven_double_pendulum", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_VERLET, 0.001, 0.1},
    {"slider_crank", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_BDF, 0.0005, 0.02},
    {"four_bar", 1, SE3D_ANALYSIS_DYNAMICS, SE3D_METHOD_RADAU, 0.02, 0.4},
};

#define SUPPORT_ANALYSES (sizeof support_analyses / sizeof support_analyses[0])

/* A solver for a row. */
static inline se3d_status support_solver_create(se3d_system *system, const support_analysis *row,
                                                int32_t formulation, se3d_solver **solver)
{
    se3d_solver_def def = se3d_solver_def_default();
    def.analysis = row->analysis;
    def.formulation = formulation;
    def.method = row->method;
    def.step = row->step;
    return se3d_solver_create(system, &def, solver);
}

#endif
