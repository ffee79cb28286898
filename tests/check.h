/* SPDX-License-Identifier: BSD-3-Clause */
/* The tests' own small harness: a test program lists its cases, each a sentence.
 *
 *     static void stale_handle_is_always_detected(void) { CHECK(...); CHECK_NEAR(a, b, tol); }
 *     int main(void) { RUN(stale_handle_is_always_detected); return check_finish(); }
 */
#ifndef SE3D_TESTS_CHECK_H
#define SE3D_TESTS_CHECK_H

#include <fenv.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int check_failures;
static int check_count;
static const char *check_case = "";

static inline void check_that(int holds, const char *text, const char *file, int line)
{
    ++check_count;
    if (!holds) {
        ++check_failures;
        fprintf(stderr, "%s:%d: %s: failed: %s\n", file, line, check_case, text);
    }
}

static inline void check_near(double actual, double expected, double tolerance, const char *text,
                              const char *file, int line)
{
    ++check_count;
    if (!(fabs(actual - expected) <= tolerance)) { /* NaN fails */
        ++check_failures;
        fprintf(stderr, "%s:%d: %s: %s is %.17g, expected %.17g within %.3g (off by %.3g)\n", file,
                line, check_case, text, actual, expected, tolerance, fabs(actual - expected));
    }
}

static inline void check_text(const char *actual, const char *part, const char *file, int line)
{
    ++check_count;
    if (!actual || !strstr(actual, part)) {
        ++check_failures;
        fprintf(stderr, "%s:%d: %s: \"%s\" does not contain \"%s\"\n", file, line, check_case,
                actual ? actual : "(null)", part);
    }
}

static inline int check_finish(void)
{
    printf("%d checks, %d failed\n", check_count, check_failures);
    return check_failures > 0 || check_count == 0;
}

/* A folder of this test's own, for files; without ctest one that all share. */
static inline const char *check_scratch(void)
{
    const char *folder = getenv("SE3D_SCRATCH_DIR");
    return folder ? folder : "/tmp";
}

/* Whether all rows of long tables are wanted (SE3D_LONG in the environment), not a part of them. */
static inline int check_is_long(void)
{
    return getenv("SE3D_LONG") != NULL;
}

/* The library divides by no zero, as its hosts may trap that: no case leaves the processor's flag
 * of it, in its own thread. Clang divides before it has asked whether it may, so its flag says
 * nothing. `ends`: of the case; else one begins. */
static inline void check_divisions(int ends)
{
#if defined(FE_DIVBYZERO) && !defined(__clang__)
    if (ends) {
        check_that(!fetestexcept(FE_DIVBYZERO), "no division by zero", __FILE__, __LINE__);
    }
    feclearexcept(FE_DIVBYZERO);
#else
    (void)ends;
#endif
}

/* A reproducible random number in [-1, 1): xorshift64*. */
static inline double check_random(uint64_t *seed)
{
    *seed ^= *seed >> 12;
    *seed ^= *seed << 25;
    *seed ^= *seed >> 27;
    return (double)((*seed * UINT64_C(2685821657736338717)) >> 11) * 0x1p-52 - 1.0;
}

#define CHECK(condition) check_that((condition) != 0, #condition, __FILE__, __LINE__)
#define CHECK_NEAR(actual, expected, tolerance)                                                    \
    check_near((actual), (expected), (tolerance), #actual, __FILE__, __LINE__)
#define CHECK_CONTAINS(text, part) check_text((text), (part), __FILE__, __LINE__)
#define RUN(test)                                                                                  \
    do {                                                                                           \
        check_case = #test;                                                                        \
        check_divisions(0);                                                                        \
        test();                                                                                    \
        check_divisions(1);                                                                        \
    } while (0)

#endif
