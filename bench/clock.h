/* SPDX-License-Identifier: BSD-3-Clause */
/* Seconds of a clock. Before the first header: #define _POSIX_C_SOURCE 200809L */
#ifndef BENCH_CLOCK_H
#define BENCH_CLOCK_H

#include <time.h>

static inline double bench_clock_of(clockid_t id)
{
    struct timespec t;
    clock_gettime(id, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Of the processor, for this process. */
static inline double bench_clock(void)
{
    return bench_clock_of(CLOCK_PROCESS_CPUTIME_ID);
}

#endif
