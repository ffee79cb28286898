/* SPDX-License-Identifier: BSD-3-Clause */
/* How the processor rounds, whatever the host has set: work is done with rounding to nearest and
 * with small numbers kept, so that the host's setting changes no bit of it. What the host traps is
 * not trapped there: NaN is a value that is compared and told. Only its trap of divisions by zero
 * stays, since there are none. */
#ifndef SE3DI_BASE_FLOATS_H
#define SE3DI_BASE_FLOATS_H

#include <fenv.h>
#include <math.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/* The host's setting. */
typedef struct se3di_floats {
    int rounding;         /* of the C library */
    unsigned int control; /* of x86's vector unit */
} se3di_floats;

/* Rounding, flush to zero and denormals are zero in the control word of x86's vector unit, and what
 * it does not trap: all but divisions by zero. */
#define SE3DI_FLOATS_MODES 0xe040u
#define SE3DI_FLOATS_QUIET 0x1d80u

/* Round to nearest, keep small numbers and trap nothing. @return the setting before */
static inline se3di_floats se3di_floats_set(void)
{
    se3di_floats before = {.control = 0};
#if defined(FE_TONEAREST)
    before.rounding = fegetround();
#endif
#if defined(__SSE2__)
    before.control = _mm_getcsr() & (SE3DI_FLOATS_MODES | SE3DI_FLOATS_QUIET);
#endif
#if defined(FE_TONEAREST)
    if (before.rounding != FE_TONEAREST) {
        (void)fesetround(FE_TONEAREST);
    }
#endif
#if defined(__SSE2__)
    if (before.control != SE3DI_FLOATS_QUIET) {
        _mm_setcsr((_mm_getcsr() & ~SE3DI_FLOATS_MODES) | SE3DI_FLOATS_QUIET);
    }
#endif
    return before;
}

static inline void se3di_floats_restore(se3di_floats before)
{
#if defined(FE_TONEAREST)
    if (before.rounding != FE_TONEAREST) {
        (void)fesetround(before.rounding);
    }
#endif
#if defined(__SSE2__)
    if (before.control != SE3DI_FLOATS_QUIET) { /* flags raised meanwhile stay */
        _mm_setcsr((_mm_getcsr() & ~(SE3DI_FLOATS_MODES | SE3DI_FLOATS_QUIET)) | before.control);
    }
#endif
}

/* As in work again, after code that is not the library's: it may have left its own setting, or may
 * have loaded what sets one. */
static inline void se3di_floats_resume(void)
{
    (void)se3di_floats_set();
}

/* The integer nearest to x, of two the even one, however the processor rounds: nearbyint that
 * rounds up would make a turn of an angle that is a little above zero. |x| below 2^52. */
static inline double se3di_nearest(double x)
{
    const double k = floor(x + 0.5);
    const int is_odd = k != 2.0 * floor(0.5 * k);
    return k - x > 0.5 || (k - x == 0.5 && is_odd) ? k - 1.0 : k;
}

#endif
