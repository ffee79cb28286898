/* SPDX-License-Identifier: BSD-3-Clause */
/* The solver, for the files of the public layer that deal with it. */
#ifndef SE3DI_SYSTEM_SOLVER_H
#define SE3DI_SYSTEM_SOLVER_H

#include "analysis/run.h"
#include "system/system_internal.h"

struct se3d_solver {
    se3d_system *system;
    se3di_run run;
};

#endif
