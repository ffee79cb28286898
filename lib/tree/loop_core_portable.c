/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of loops in plain C.                        docs/theory/joint_coordinates.md */
#include "math/fma.h"
#include "tree/loop_core.h"

#include <string.h>

typedef struct quad {
    double lane[SE3DI_STRIP];
} quad;

static inline quad load(const double *p)
{
    quad o;
    memcpy(o.lane, p, sizeof o.lane);
    return o;
}

static inline void store(double *p, quad a)
{
    memcpy(p, a.lane, sizeof a.lane);
}

static inline quad SPREAD(double x)
{
    return (quad){{x, x, x, x}};
}

static inline quad FOUR(double x, double y, double z, double w)
{
    return (quad){{x, y, z, w}};
}

static inline quad add_of(quad a, quad b)
{
    for (int k = 0; k < SE3DI_STRIP; ++k) {
        a.lane[k] += b.lane[k];
    }
    return a;
}

static inline quad mul_of(quad a, quad b)
{
    for (int k = 0; k < SE3DI_STRIP; ++k) {
        a.lane[k] *= b.lane[k];
    }
    return a;
}

static inline quad fma_of(quad a, quad b, quad c)
{
    for (int k = 0; k < SE3DI_STRIP; ++k) {
        c.lane[k] = se3di_fma(a.lane[k], b.lane[k], c.lane[k]);
    }
    return c;
}

static inline quad fnma_of(quad a, quad b, quad c)
{
    for (int k = 0; k < SE3DI_STRIP; ++k) {
        c.lane[k] = se3di_fma(-a.lane[k], b.lane[k], c.lane[k]);
    }
    return c;
}

static inline void transpose(const quad a[SE3DI_STRIP], quad o[SE3DI_STRIP])
{
    for (int k = 0; k < SE3DI_STRIP; ++k) {
        for (int m = 0; m < SE3DI_STRIP; ++m) {
            o[m].lane[k] = a[k].lane[m];
        }
    }
}

#define scalar_fma(a, b, c) se3di_fma(a, b, c)
#define CARRY_TEAM          NULL

#include "tree/loop_core.inc"

const se3di_loop_core *se3di_loop_core_portable(void)
{
    return &loop_table;
}
