/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/pending.h"

#include "base/floats.h"

#include <stddef.h>

#if !defined(__STDC_NO_THREADS__) && !defined(_WIN32)
#include <threads.h>
#include <time.h>
#endif

#define PATIENCE 10000 /* tries, some microseconds */

/* The thread that completes may wait for the processor that this one holds. */
static void give_way(void)
{
#if !defined(__STDC_NO_THREADS__) && !defined(_WIN32)
    const struct timespec pause = {0, 10000};
    (void)thrd_sleep(&pause, NULL);
#endif
}

void se3di_pending_init(se3di_pending *pending)
{
    atomic_init(&pending->is_open, 0);
    atomic_flag_clear(&pending->working);
    pending->complete = NULL;
    pending->ctx = NULL;
}

void se3di_pending_open(se3di_pending *pending, void (*complete)(void *ctx), void *ctx)
{
    pending->complete = complete;
    pending->ctx = ctx;
    atomic_store_explicit(&pending->is_open, 1, memory_order_release);
}

void se3di_pending_drop(se3di_pending *pending)
{
    if (pending) {
        atomic_store_explicit(&pending->is_open, 0, memory_order_release);
    }
}

int se3di_pending_is_of(se3di_pending *pending, const void *ctx)
{
    return pending && atomic_load_explicit(&pending->is_open, memory_order_acquire) &&
           pending->ctx == ctx;
}

void se3di_pending_complete(se3di_pending *pending)
{
    int tries = 0;
    /* a microsecond or two: who comes second waits without sleeping, but not for ever */
    while (pending && atomic_load_explicit(&pending->is_open, memory_order_acquire)) {
        /* unreached: another thread is at it */
        if (!atomic_flag_test_and_set_explicit(&pending->working, memory_order_acquire)) {
            /* unreached: another thread was faster */
            if (atomic_load_explicit(&pending->is_open, memory_order_acquire)) {
                const se3di_floats host = se3di_floats_set();
                pending->complete(pending->ctx);
                se3di_floats_restore(host);
                atomic_store_explicit(&pending->is_open, 0, memory_order_release);
            }
            atomic_flag_clear_explicit(&pending->working, memory_order_release);
        } else if (++tries > PATIENCE) { /* unreached: another thread is at it */
            give_way();
        }
    }
}
