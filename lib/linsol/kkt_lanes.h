/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT solver for several states side by side: the same numbers of each in the lanes of vector
 * registers, one elimination for all. A lane gets the bits that the solver alone gives for its
 * state. What lanes cannot do together (pivots that are small, negative or not finite, solutions of
 * which only the residual tells how often they are refined, multipliers of least norm) the solver
 * does for such a lane alone.                                                docs/theory/kkt.md */
#ifndef SE3DI_LINSOL_KKT_LANES_H
#define SE3DI_LINSOL_KKT_LANES_H

#include "linsol/kkt.h"

#define SE3DI_KKT_LANES_MAX 8

typedef struct se3di_kkt_lanes se3di_kkt_lanes;

/* Of each lane. */
typedef struct se3di_kkt_lanes_info {
    se3d_status status[SE3DI_KKT_LANES_MAX]; /* as se3di_kkt_factor, if that fails, else _solve */
    bool is_alone[SE3DI_KKT_LANES_MAX];      /* the solver did it by itself */
    int32_t refinements;                     /* of those that were done together */
} se3di_kkt_lanes_info;

/* States that this processor can have side by side at most: 8, 4 or 1. */
int32_t se3di_kkt_lanes_widest(void);

/* Lanes of `kkt`, which must outlive them, for `width` states: 8, 4 or 1. On failure *lanes is
 * NULL. @return SE3D_OK, SE3D_ERR_INVALID_ARGUMENT (a width that the processor has not; a solver
 * that is dense, unsymmetric or of blocks of size 8), SE3D_ERR_NO_MEMORY */
se3d_status se3di_kkt_lanes_create(const se3d_allocator *allocator, se3di_kkt *kkt, int32_t width,
                                   se3di_kkt_lanes **lanes);
void se3di_kkt_lanes_destroy(se3di_kkt_lanes *lanes); /* NULL is fine */

/* Factor and solve with the settings of the solver, whose own factorisation is lost. Each number of
 * `values`, b, c, x and l stands for `width` doubles, those of the lanes, at an address that is a
 * multiple of 64; values->weight must be NULL, c may be. Each lane must hold a state.
 * @return SE3D_OK, or the status of the first lane that is below 0 */
se3d_status se3di_kkt_lanes_solve(se3di_kkt_lanes *lanes, const se3di_kkt_values *values,
                                  const double *b, const double *c, double *x, double *l,
                                  se3di_kkt_lanes_info *info);

#endif
