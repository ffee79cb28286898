/* SPDX-License-Identifier: BSD-3-Clause */
/* Dry friction whose limits are known, in accelerations: with P (symmetric, positive semidefinite)
 * the deceleration of coordinates by unit forces against them, find n and
 *
 *     a = a_0 - P n,   |n_k| <= F_k:    a_k = 0 inside,   a_k >= 0 at F_k,   a_k <= 0 at -F_k
 *
 * which is the least of n.Pn/2 - a_0.n in a box: a exists and is unique, n if P is definite. Of
 * several n the one of least sum of S_k n_k^2, by proximal steps: S is added to the diagonal, the
 * solution becomes the centre, a few times. Each step tries all that contradicts at once (a
 * semismooth Newton method, some three rounds), and if that goes round an active set, one
 * element at a time, whose objective falls: it ends always.  docs/theory/friction.md */
#ifndef SE3DI_FRICTION_BOX_H
#define SE3DI_FRICTION_BOX_H

#include <stdint.h>

typedef struct se3di_friction_box {
    uint32_t count;
    uint32_t reserved;
    const double *P;      /* [count * count] */
    const double *a;      /* [count]: a_0 */
    const double *limit;  /* [count]: F */
    const double *share;  /* [count]: S, > 0 unless fixed */
    int32_t *at;          /* [count]: -1, 0, +1: at -F, inside, at F; out */
    const int32_t *fixed; /* [count]: not 0: n stays as it is */
    double *n;            /* [count]: in and out */
    double *work;         /* [SE3DI_FRICTION_BOX_WORK(count)] */
} se3di_friction_box;

#define SE3DI_FRICTION_BOX_WORK(count) ((size_t)(count) * (count) + 4 * (size_t)(count))

void se3di_friction_box_solve(const se3di_friction_box *box);

#endif
