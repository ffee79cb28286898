/* SPDX-License-Identifier: BSD-3-Clause */
/* Four tyres for x86-64 with AVX2. Nothing is fused, as where tyres are alone: the same bits.
 *                                                                       docs/theory/tyre.md */
#include "force/tyre_lanes.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>
#include <stdint.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

typedef double number __attribute__((vector_size(32)));
typedef uint64_t integers __attribute__((vector_size(32)));
typedef int64_t verdict __attribute__((vector_size(32)));

typedef struct lanes {
    number v;
} dual;

#define LANES     SE3DI_TYRE_LANES
#define NUMBER(x) ((number)_mm256_set1_pd(x))
#define WIDE(x)   ((x)*NUMBER(1.0)) /* also of a plain number */
#define PICK(holds, a, b)                                                                          \
    ((number)_mm256_blendv_pd((__m256d)WIDE(b), (__m256d)WIDE(a), (__m256d)(holds)))
#define ANY(holds)         (_mm256_movemask_pd((__m256d)(holds)) != 0)
#define IS_NOT(holds)      (~(holds))
#define ABS(x)             ((number)_mm256_andnot_pd(_mm256_set1_pd(-0.0), (__m256d)(x)))
#define ROOT(x)            ((number)_mm256_sqrt_pd((__m256d)(x)))
#define ARCSINE(x)         each(se3di_asin, x)
#define POWER(x, exponent) each_power(x, exponent)

static number each(double (*f)(double), number x)
{
    number y;
    for (int k = 0; k < LANES; ++k) {
        y[k] = f(x[k]);
    }
    return y;
}

static number each_power(number x, double exponent)
{
    number y;
    for (int k = 0; k < LANES; ++k) {
        y[k] = se3di_pow(x[k], exponent);
    }
    return y;
}

/* ---- math/quick.h, to the bit ---- */

static inline number with_sign(number size, number sign)
{
    const __m256d bit = _mm256_set1_pd(-0.0);
    return (number)_mm256_or_pd(_mm256_andnot_pd(bit, (__m256d)size),
                                _mm256_and_pd(bit, (__m256d)sign));
}

static inline number nearest(number x)
{
    return (x + 0x1.8p52) - 0x1.8p52;
}

/* Pairs of a table into two numbers. */
static inline void look_up(const double table[][2], __m128i at, number *high, number *low)
{
    const __m128d a = _mm_loadu_pd(table[_mm_extract_epi32(at, 0)]);
    const __m128d b = _mm_loadu_pd(table[_mm_extract_epi32(at, 1)]);
    const __m128d c = _mm_loadu_pd(table[_mm_extract_epi32(at, 2)]);
    const __m128d d = _mm_loadu_pd(table[_mm_extract_epi32(at, 3)]);
    const __m256d ac = _mm256_insertf128_pd(_mm256_castpd128_pd256(a), c, 1);
    const __m256d bd = _mm256_insertf128_pd(_mm256_castpd128_pd256(b), d, 1);
    *high = (number)_mm256_unpacklo_pd(ac, bd);
    *low = (number)_mm256_unpackhi_pd(ac, bd);
}

static __attribute__((noinline)) number arctangent(number x)
{
    const number size = ABS(x);
    if (ANY(IS_NOT(size < 0x1p50))) {
        return each(se3di_quick_atan, x);
    }
    const verdict is_steep = size > 1.0;
    const number small = PICK(is_steep, 1.0 / PICK(is_steep, size, 1.0), size);
    const number k = nearest(64.0 * small), t = k / 64.0;
    const number ts = t * size;
    const number z = PICK(is_steep, 1.0 - ts, size - t) / PICK(is_steep, size + t, 1.0 + ts);
    const number s = z * z;
    const number rest = z * s * (1.0 / 3.0 - s * (0.2 - s * (1.0 / 7.0 - s / 9.0)));
    number high, low;
    look_up(atan_table, _mm256_cvtpd_epi32((__m256d)k), &high, &low);
    number angle = high + (z + (low - rest));
    angle = PICK(is_steep, half_pi_pair[0] + (half_pi_pair[1] - angle), angle);
    return with_sign(angle, x);
}

static __attribute__((noinline)) void turn_of(number x, number *sine, number *cosine)
{
    if (ANY(IS_NOT(ABS(x) < 25.0))) {
        for (int k = 0; k < LANES; ++k) {
            double s, c;
            se3di_quick_sincos(x[k], &s, &c);
            (*sine)[k] = s;
            (*cosine)[k] = c;
        }
        return;
    }
    const number k = nearest(x * rate_sin);
    const number r = (x - k * pi_128[0]) - k * pi_128[1], s = r * r;
    const number sr = r - r * s * (1.0 / 6.0 - s * (1.0 / 120.0 - s / 5040.0));
    const number cr = -s * (0.5 - s * (1.0 / 24.0 - s * (1.0 / 720.0 - s / 40320.0)));
    const __m128i n = _mm256_cvtpd_epi32((__m256d)k), i = _mm_and_si128(n, _mm_set1_epi32(63));
    const __m256i quadrant = _mm256_cvtepi32_epi64(_mm_srai_epi32(n, 6));
    number sa, sa_low, ca, ca_low;
    look_up(sin_table, i, &sa, &sa_low);
    look_up(sin_table, _mm_sub_epi32(_mm_set1_epi32(64), i), &ca, &ca_low);
    const number a = sa + (sa_low + (ca * sr + sa * cr));
    const number b = ca + (ca_low + (ca * cr - sa * sr));
    const __m256d odd = _mm256_castsi256_pd(_mm256_slli_epi64(quadrant, 63));
    const __m256d half = _mm256_castsi256_pd(_mm256_slli_epi64(quadrant, 62));
    const __m256d bit = _mm256_set1_pd(-0.0);
    const __m256d turned = _mm256_blendv_pd((__m256d)a, (__m256d)b, odd);
    const __m256d other = _mm256_blendv_pd((__m256d)b, (__m256d)a, odd);
    *sine = (number)_mm256_xor_pd(turned, _mm256_and_pd(bit, half));
    *cosine = (number)_mm256_xor_pd(other, _mm256_and_pd(bit, _mm256_xor_pd(odd, half)));
}

/* ---- math/dual.inc, values ---- */

#define OF(name)                      se3di_wide_##name
#define se3di_wide_of(x)              ((dual){WIDE(x)})
#define se3di_wide_seed(x, at, s)     se3di_wide_of(x)
#define se3di_wide_chain(f, s, x)     ((void)(s), (dual){f})
#define se3di_wide_line(a, b, x)      ((dual){(a) + (b) * (x).v})
#define se3di_wide_scale(b, x)        ((dual){(b) * (x).v})
#define se3di_wide_square(a, b, c, x) se3di_wide_square_of(WIDE(a), WIDE(b), WIDE(c), x)
#define se3di_wide_pick(c, x, y)      se3di_wide_pick_of((verdict)(c), x, y)

static inline dual se3di_wide_square_of(number a, number b, number c, dual x)
{
    return (dual){a + (b + c * x.v) * x.v};
}

static inline dual se3di_wide_pick_of(verdict takes_first, dual x, dual y)
{
    return (dual){(number)_mm256_blendv_pd((__m256d)y.v, (__m256d)x.v, (__m256d)takes_first)};
}

static inline dual se3di_wide_add(dual x, dual y)
{
    return (dual){x.v + y.v};
}

static inline dual se3di_wide_sub(dual x, dual y)
{
    return (dual){x.v - y.v};
}

static inline dual se3di_wide_mul(dual x, dual y)
{
    return (dual){x.v * y.v};
}

/* Divisions by zero are not made, see math/over.h. */
static inline dual se3di_wide_div(dual x, dual y)
{
    const verdict is_zero = y.v == 0.0;
    if (!ANY(is_zero)) {
        return (dual){x.v / y.v};
    }
    for (int k = 0; k < LANES; ++k) {
        x.v[k] = se3di_over(x.v[k], y.v[k]);
    }
    return x;
}

static inline dual se3di_wide_abs(dual x)
{
    return (dual){ABS(x.v)};
}

static inline dual se3di_wide_sqrt(dual x)
{
    return (dual){ROOT(x.v)};
}

static inline dual se3di_wide_asin(dual x)
{
    return (dual){ARCSINE(x.v)};
}

static inline dual se3di_wide_sin(dual x)
{
    number sine, cosine;
    turn_of(x.v, &sine, &cosine);
    return (dual){sine};
}

static inline dual se3di_wide_cos(dual x)
{
    number sine, cosine;
    turn_of(x.v, &sine, &cosine);
    return (dual){cosine};
}

static inline dual se3di_wide_tan(dual x)
{
    number sine, cosine;
    turn_of(x.v, &sine, &cosine);
    return (dual){sine / cosine};
}

static inline dual se3di_wide_atan(dual x)
{
    return (dual){arctangent(x.v)};
}

static inline dual se3di_wide_cos_atan(dual x)
{
    return (dual){1.0 / ROOT(1.0 + x.v * x.v)};
}

static inline dual se3di_wide_exp(dual x)
{
    return ANY(ABS(x.v) > 0.0) ? (dual){each(se3di_exp, x.v)} : se3di_wide_of(1.0);
}

/* ---- laws ---- */

typedef struct slip {
    dual load, rolling_radius, ratio, tangent, slide[2], shear[2], roll, speed, reference, way;
    dual camber, turn, lean;
} slip_in_lanes;

typedef struct forces {
    dual of[6];
} forces_in_lanes;

#define SLIP       slip_in_lanes
#define FORCES     forces_in_lanes
#define RATE       dual
#define TAKE(x)    (x)
#define GIVE(x, o) ((o) = (x))

#define SLOPE(x, at, slope)           ((void)(slope))
#define FOLLOWED(force, slip, number) ((number) ? &(slip)->tangent : &(slip)->ratio)

#include "force/tyre_magic.inc"
#include "force/tyre_slip.inc"

static void load(int count, const double (*from)[LANES], number *to)
{
    for (int k = 0; k < count; ++k) {
        to[k] = (number)_mm256_loadu_pd(from[k]);
    }
}

static void eval(const se3di_force *force, int which, se3di_tyre_lanes *lanes)
{
    number in[SE3DI_PATCH_INPUTS], side, cosine, length;
    dual rate[2] = {{NUMBER(0.0)}, {NUMBER(0.0)}};
    forces_in_lanes forces;
    slip_in_lanes slip;
    load(SE3DI_PATCH_INPUTS, (const double(*)[LANES])lanes->in, in);
    load(1, (const double(*)[LANES])lanes->side, &side);
    load(1, (const double(*)[LANES])lanes->cosine, &cosine);
    load(1, (const double(*)[LANES])lanes->length, &length);
    take_slip(force, side, cosine, in, &slip);
    _mm256_storeu_pd(lanes->ratio, (__m256d)slip.ratio.v);
    _mm256_storeu_pd(lanes->tangent, (__m256d)slip.tangent.v);
    _mm256_storeu_pd(lanes->rolling_radius, (__m256d)slip.rolling_radius.v);
    _mm256_storeu_pd(lanes->reference, (__m256d)slip.reference.v);
    if ((which & SE3DI_TYRE_WANTS_RATES) && (force->tyre->lags[0] || force->tyre->lags[1])) {
        find_rates(force, in, 1, &slip, rate);
    }
    for (int k = 0; k < 2; ++k) {
        if (force->tyre->lags[k]) {
            FOLLOWED(force, &slip, k)->v = in[SE3DI_PATCH_LAGGED + k];
        }
        _mm256_storeu_pd(lanes->rate[k], (__m256d)rate[k].v);
    }
    find_all(force, &slip, which, &forces);
    forces.of[2] = slip.load;
    for (int k = 0; k < 6; ++k) {
        number of = k % 2 ? forces.of[k].v * side : forces.of[k].v; /* Fy, Mx, Mz */
        if (k == 4) {
            of = of + forces.of[0].v * (length - slip.rolling_radius.v);
        }
        _mm256_storeu_pd(lanes->of[k], (__m256d)of);
    }
}

static const se3di_tyre_core tyre_table = {.eval = eval};

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_tyre_core, se3di_tyre_core_avx2, se3di_has_avx2, tyre_table)
