/* SPDX-License-Identifier: BSD-3-Clause */
/* The solver, for the files of the public layer that deal with it. */
#ifndef SE3DI_SYSTEM_SOLVER_H
#define SE3DI_SYSTEM_SOLVER_H

#include "analysis/run.h"
#include "system/system_internal.h"

struct se3d_solver {
    se3d_system
        *system; /* NULL: destroyed before the solver, of which only the counters are left */
    se3d_allocator allocator;
    se3d_solver *next; /* of the same system */
    se3di_run run;
};

/* `system` goes: what its solvers hold of it is released, calls of theirs are refused from now on.
 */
void se3di_solvers_orphan(se3d_system *system);

#endif
