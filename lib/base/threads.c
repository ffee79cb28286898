/* SPDX-License-Identifier: BSD-3-Clause */
#include "base/threads.h"

#ifdef _OPENMP
#include <omp.h>
#endif

/* The threads that gcc's OpenMP keeps between regions do not exist in the child of a fork, which
 * would wait for them for ever. They end before a fork; the next region starts them again. */
#if defined(_OPENMP) && defined(__unix__) && !defined(__clang__) && __GNUC__ >= 9
#include <pthread.h>

static void end_threads(void)
{
    (void)omp_pause_resource_all(omp_pause_hard);
}

__attribute__((constructor)) static void watch_forks(void)
{
    (void)pthread_atfork(end_threads, 0, 0);
}
#endif

int se3di_threads_get_own(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

int se3di_threads_count(void)
{
#ifdef _OPENMP
    return omp_get_num_threads();
#else
    return 1;
#endif
}
