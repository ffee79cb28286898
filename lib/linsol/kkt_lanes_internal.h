/* SPDX-License-Identifier: BSD-3-Clause */
/* Data of the KKT solver's lanes, and the kernels of each width. */
#ifndef SE3DI_LINSOL_KKT_LANES_INTERNAL_H
#define SE3DI_LINSOL_KKT_LANES_INTERNAL_H

#include "linsol/kkt_internal.h"
#include "linsol/kkt_lanes.h"

/* Every number stands for `width` doubles. */
typedef struct se3di_kkt_lane_core {
    int32_t width;
    /* mobility, weight and e = eps w; lanes->verdict is not a number if a weight vanishes. */
    void (*weigh)(const se3di_kkt_lanes *lanes, const se3di_kkt_values *values, double eps);
    /* Gather the values, eliminate all nodes, and do the forward half for the right-hand side in z;
     * lanes->top: the largest weight / pivot of rows; lanes->verdict becomes not a number if a
     * pivot is no number or a body's is negative. */
    void (*factor)(const se3di_kkt_lanes *lanes, const se3di_kkt_values *values);
    /* (b, c) in z; either may be NULL for zero. */
    void (*scatter)(const se3di_kkt_lanes *lanes, const double *b, const double *c);
    void (*forward)(const se3di_kkt_lanes *lanes);
    /* The other half, then x and l. */
    void (*backward)(const se3di_kkt_lanes *lanes, double *x, double *l);
    /* residual_b = b - H x - C^T l, residual_c = c - C x */
    void (*residual)(const se3di_kkt_lanes *lanes, const se3di_kkt_values *values, const double *b,
                     const double *c, const double *x, const double *l);
    /* to += from */
    void (*add)(size_t count, const double *from, double *to);
    /* lanes->verdict becomes not a number in lanes with one that is not finite. */
    void (*check)(const se3di_kkt_lanes *lanes, size_t count, const double *numbers);
} se3di_kkt_lane_core;

/* NULL: not on this processor. */
const se3di_kkt_lane_core *se3di_kkt_lane_core_portable(void);
const se3di_kkt_lane_core *se3di_kkt_lane_core_avx2(void);
const se3di_kkt_lane_core *se3di_kkt_lane_core_avx512(void);

struct se3di_kkt_lanes {
    se3d_allocator allocator;
    se3di_kkt *kkt; /* structure and settings; it solves for lanes that are alone */
    const se3di_kkt_lane_core *core;
    double *memory; /* all of it, as allocated */
    size_t memory_count;
    /* numbers, with the places of the solver's arrays of these names */
    double *upper, *scaled, *inverse_d, *z, *mobility, *weight, *e;
    double *residual_b, *residual_c, *correction_x, *correction_l;
    double *top, *verdict;
    /* one state, for a lane that is alone */
    double *body, *coupling, *joint, *b, *c, *x, *l;
};

#endif
