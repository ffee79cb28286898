/* SPDX-License-Identifier: BSD-3-Clause */
/* Calls of one kind, of which a test lets one fail on each path of calls that asks for it. Paths
 * are told apart by the innermost calls. */
#ifndef SE3D_TESTS_SUPPORT_CALL_PATHS_H
#define SE3D_TESTS_SUPPORT_CALL_PATHS_H

#include <stdint.h>
#include <stdio.h>
#include <string.h>
#if defined(__GLIBC__)
#include <execinfo.h>
#endif

#define DEPTH_MOST 6
#define PATHS      (1u << 16)
#define CALLS      (1u << 20) /* of one use */

static struct {
    size_t count;   /* of calls so far */
    size_t refused; /* the call that is refused, from 1; 0: none */
    size_t reached; /* calls that were refused */
    int depth;      /* calls that tell paths apart, at most DEPTH_MOST */
    int looks;      /* new paths are noted */
    int tells;      /* the path that is refused is told */
    uint64_t seen[PATHS];
    size_t seen_count;
    size_t fresh[CALLS]; /* calls on new paths */
    size_t fresh_count;
} calls;

static uint64_t path_of_calls(void)
{
    uint64_t hash = UINT64_C(14695981039346656037);
#if defined(__GLIBC__)
    void *frames[DEPTH_MOST + 3];
    const int count = backtrace(frames, calls.depth + 3);
    for (int k = 3; k < count; ++k) { /* not this function, is_refused() and its caller */
        hash = (hash ^ (uint64_t)(uintptr_t)frames[k]) * UINT64_C(1099511628211);
    }
#else
    hash += calls.count; /* all calls */
#endif
    return hash | 1u;
}

static int is_new(uint64_t path)
{
    size_t k = path % PATHS;
    while (calls.seen[k] != 0 && calls.seen[k] != path) {
        k = (k + 1) % PATHS;
    }
    if (calls.seen[k] == path || calls.seen_count + 1 >= PATHS) {
        return 0;
    }
    calls.seen[k] = path;
    ++calls.seen_count;
    return 1;
}

static void tell_path(void)
{
#if defined(__GLIBC__)
    void *frames[20];
    const int count = backtrace(frames, 20);
    backtrace_symbols_fd(frames + 2, count - 2, 2);
#endif
}

static __attribute__((noinline)) int is_refused(void)
{
    ++calls.count;
    if (calls.looks && calls.fresh_count < CALLS && is_new(path_of_calls())) {
        calls.fresh[calls.fresh_count++] = calls.count;
    }
    const int hit = calls.count == calls.refused;
    calls.reached += hit ? 1 : 0;
    if (hit && calls.tells) {
        tell_path();
    }
    return hit;
}

static inline void forget_paths(void)
{
    memset(calls.seen, 0, sizeof calls.seen);
    calls.seen_count = 0;
}

#endif
