/* SPDX-License-Identifier: BSD-3-Clause */
/* What a step has left to be computed until somebody reads it: accelerations, multipliers and
 * powers of the state that it has ended in. Whoever made the step says how; whoever reads or
 * changes something completes it first, so that nobody sees a difference. Readers may come from
 * several threads at once: one of them does it, the others wait. */
#ifndef SE3DI_BASE_PENDING_H
#define SE3DI_BASE_PENDING_H

#include <stdatomic.h>

typedef struct se3di_pending {
    atomic_int is_open;
    atomic_flag working;
    void (*complete)(void *ctx);
    void *ctx;
} se3di_pending;

void se3di_pending_init(se3di_pending *pending);
/* Something remains to be done; nobody reads at the same time, as in the two below. */
void se3di_pending_open(se3di_pending *pending, void (*complete)(void *ctx), void *ctx);
/* It will not be needed any more. `pending` may be NULL here and below: nothing ever remains. */
void se3di_pending_drop(se3di_pending *pending);
/* Whether what `ctx` has left remains. */
int se3di_pending_is_of(se3di_pending *pending, const void *ctx);
/* Do it now, if something remains. Any number of threads. */
void se3di_pending_complete(se3di_pending *pending);

#endif
