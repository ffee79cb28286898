/* SPDX-License-Identifier: BSD-3-Clause */
/* Up to four tyres by the Magic Formula that have the same data, but for their sides, and touch: in
 * the lanes of a register, each as if it were alone, to the bit.        docs/theory/tyre.md */
#ifndef SE3DI_FORCE_TYRE_LANES_H
#define SE3DI_FORCE_TYRE_LANES_H

#include "force/tyre.h"

enum { SE3DI_TYRE_LANES = 4 };

typedef struct se3di_tyre_lanes {
    double side[SE3DI_TYRE_LANES], cosine[SE3DI_TYRE_LANES], length[SE3DI_TYRE_LANES];
    double in[SE3DI_PATCH_INPUTS][SE3DI_TYRE_LANES];
    double of[6][SE3DI_TYRE_LANES];   /* forces and moments */
    double rate[2][SE3DI_TYRE_LANES]; /* of slips, those that lag, if wanted */
    double ratio[SE3DI_TYRE_LANES], tangent[SE3DI_TYRE_LANES]; /* slips of the instant */
    double rolling_radius[SE3DI_TYRE_LANES], reference[SE3DI_TYRE_LANES];
} se3di_tyre_lanes;

typedef struct se3di_tyre_core {
    /* which: SE3DI_TYRE_WANTS_... */
    void (*eval)(const se3di_force *force, int which, se3di_tyre_lanes *lanes);
} se3di_tyre_core;

/* NULL: without lanes. */
const se3di_tyre_core *se3di_tyre_core_avx2(void);

#endif
