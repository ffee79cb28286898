/* SPDX-License-Identifier: BSD-3-Clause */
/* The force kernels for x86-64 with AVX-512, chosen at run time.       docs/theory/particles.md */
#include "contact/shape/mesh_tree.h"
#include "math/larger.h"
#include "particles/clump.h"
#include "particles/sift.h"
#include "particles/wall.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

#if defined(__clang__)
SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX512)
#else
SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX512 ",prefer-vector-width=512")
#endif

#define LANES    8
#define BESIDE   1
#define V_INLINE static inline __attribute__((always_inline))

typedef __m512d V;
typedef __mmask8 M;

#define V_SET(s)          _mm512_set1_pd(s)
#define V_LOAD(p)         _mm512_load_pd(p)
#define V_STORE(p, v)     _mm512_store_pd(p, v)
#define V_LOAD_ANY(p)     _mm512_loadu_pd(p)
#define V_STORE_ANY(p, v) _mm512_storeu_pd(p, v)
#define V_FMA(a, b, c)    _mm512_fmadd_pd(a, b, c)
#define V_FNMA(a, b, c)   _mm512_fnmadd_pd(a, b, c)
#define V_SQRT(a)         _mm512_sqrt_pd(a)
#define V_MAX(a, b)       _mm512_max_pd(a, b)
#define V_MIN(a, b)       _mm512_min_pd(a, b)
#define V_ROUND(a)        _mm512_roundscale_pd(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)
#define V_LESS(a, b)      _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ)
#define V_PICK(m, a, b)   _mm512_mask_blend_pd(m, b, a)
#define V_KEEP(m, a)      _mm512_maskz_mov_pd(m, a)
#define M_ANY(m)          ((m) != 0)
#define M_BITS(m)         ((unsigned)(m))
#define M_COUNT(m)        ((uint64_t)__builtin_popcount(m))

/* A row of four numbers of a record. */
typedef __m256d ROW;

#define ROW_LOAD(p)     _mm256_load_pd(p)
#define ROW_STORE(p, a) _mm256_store_pd(p, a)
#define ROW_ALL(p)      _mm256_broadcast_sd(p)
#define ROW_ADD(a, b)   _mm256_add_pd(a, b)
#define ROW_MUL(a, b)   _mm256_mul_pd(a, b)

V_INLINE ROW ROW_THREE(double s)
{
    return _mm256_maskz_mov_pd(7, _mm256_set1_pd(s));
}

/* What is behind three numbers may be none: it is read as 0, and stays. */
V_INLINE ROW ROW_LOAD_THREE(const double *p)
{
    return _mm256_maskz_load_pd(7, p);
}

V_INLINE void ROW_STORE_THREE(double *p, ROW a)
{
    _mm256_mask_store_pd(p, 7, a);
}

V_INLINE double sum_lanes(const double *v)
{
    __m256d h = _mm256_add_pd(_mm256_load_pd(v), _mm256_load_pd(v + 4));
    __m128d s = _mm_add_pd(_mm256_castpd256_pd128(h), _mm256_extractf128_pd(h, 1));
    return _mm_cvtsd_f64(_mm_add_sd(s, _mm_unpackhi_pd(s, s)));
}

V_INLINE double V_LARGEST(V a)
{
    __m256d h = _mm256_max_pd(_mm512_castpd512_pd256(a), _mm512_extractf64x4_pd(a, 1));
    __m128d s = _mm_max_pd(_mm256_castpd256_pd128(h), _mm256_extractf128_pd(h, 1));
    return _mm_cvtsd_f64(_mm_max_sd(s, _mm_unpackhi_pd(s, s)));
}

V_INLINE M lanes_used(M m, const uint32_t *i, const uint32_t *j)
{
    __m256i a = _mm256_loadu_si256((const __m256i *)(const void *)i);
    __m256i b = _mm256_loadu_si256((const __m256i *)(const void *)j);
    return (M)(m & _mm256_cmpneq_epi32_mask(a, b));
}

V_INLINE M lanes_real(M m, V radius)
{
    return (M)(m & _mm512_cmp_pd_mask(radius, _mm512_setzero_pd(), _CMP_GT_OQ));
}

/* Rows become columns. */
V_INLINE void transpose(const V in[8], V out[8])
{
    V t[8];
    for (int k = 0; k < 8; k += 2) {
        t[k] = _mm512_unpacklo_pd(in[k], in[k + 1]);
        t[k + 1] = _mm512_unpackhi_pd(in[k], in[k + 1]);
    }
    for (int k = 0; k < 2; ++k) {
        V a = _mm512_shuffle_f64x2(t[k], t[2 + k], 0x88);
        V b = _mm512_shuffle_f64x2(t[4 + k], t[6 + k], 0x88);
        V c = _mm512_shuffle_f64x2(t[k], t[2 + k], 0xdd);
        V d = _mm512_shuffle_f64x2(t[4 + k], t[6 + k], 0xdd);
        out[k] = _mm512_shuffle_f64x2(a, b, 0x88);
        out[4 + k] = _mm512_shuffle_f64x2(a, b, 0xdd);
        out[2 + k] = _mm512_shuffle_f64x2(c, d, 0x88);
        out[6 + k] = _mm512_shuffle_f64x2(c, d, 0xdd);
    }
}

V_INLINE void clear_load(se3di_load *load)
{
    _mm512_store_pd(load, _mm512_setzero_pd());
}

V_INLINE void load_particles(const se3di_particle *particles, const uint32_t *i, V out[8])
{
    V rows[8];
    for (int k = 0; k < 8; ++k) {
        rows[k] = _mm512_load_pd(&particles[i[k]]);
    }
    transpose(rows, out);
}

/* Of i relative to j. */
V_INLINE void load_apart(const se3di_particle *particles, const uint32_t *i, const uint32_t *j,
                         V d[4], V v[4])
{
    V rows[8], out[8];
    for (int k = 0; k < 8; ++k) {
        rows[k] = _mm512_sub_pd(_mm512_load_pd(&particles[i[k]]), _mm512_load_pd(&particles[j[k]]));
    }
    transpose(rows, out);
    for (int a = 0; a < 4; ++a) {
        d[a] = out[a];
        v[a] = out[4 + a];
    }
}

/* Also what is behind the 15 numbers. */
V_INLINE void load_facets(const se3di_mesh_facet *facets, const uint32_t *at, V out[16])
{
    for (int part = 0; part < 16; part += 8) {
        V rows[8];
        for (int k = 0; k < 8; ++k) {
            rows[k] = _mm512_loadu_pd((const double *)(const void *)&facets[at[k]] + part);
        }
        transpose(rows, out + part);
    }
}

/* Halves of two rows side by side make one transposition of four do for eight. */
V_INLINE void transpose_halves(const V in[4], V out[4])
{
    V a = _mm512_unpacklo_pd(in[0], in[1]);
    V b = _mm512_unpackhi_pd(in[0], in[1]);
    V c = _mm512_unpacklo_pd(in[2], in[3]);
    V d = _mm512_unpackhi_pd(in[2], in[3]);
    const __m512i first = _mm512_set_epi64(13, 12, 5, 4, 9, 8, 1, 0);
    const __m512i third = _mm512_set_epi64(15, 14, 7, 6, 11, 10, 3, 2);
    /* [0 1 | 8 9 | 4 5 | 12 13]: lanes 0..3 come from the low halves, 4..7 from the high ones */
    out[0] = _mm512_permutex2var_pd(a, first, c);
    out[1] = _mm512_permutex2var_pd(b, first, d);
    out[2] = _mm512_permutex2var_pd(a, third, c);
    out[3] = _mm512_permutex2var_pd(b, third, d);
}

V_INLINE void turn_rows(const ROW rows[8], V out[4])
{
    V wide[4];
    for (int k = 0; k < 4; ++k) {
        wide[k] = _mm512_insertf64x4(_mm512_castpd256_pd512(rows[k]), rows[4 + k], 1);
    }
    transpose_halves(wide, out);
}

V_INLINE void load_four(const double *const at[8], V out[4])
{
    ROW rows[8];
    for (int k = 0; k < 8; ++k) {
        rows[k] = _mm256_loadu_pd(at[k]);
    }
    turn_rows(rows, out);
}

V_INLINE void store_four(double *const at[8], const V in[4])
{
    V rows[4];
    transpose_halves(in, rows);
    for (int k = 0; k < 4; ++k) {
        _mm256_storeu_pd(at[k], _mm512_castpd512_pd256(rows[k]));
        _mm256_storeu_pd(at[4 + k], _mm512_extractf64x4_pd(rows[k], 1));
    }
}

/* What is behind the three numbers stays. */
V_INLINE void store_three(double *const at[8], const V in[3])
{
    const V four[4] = {in[0], in[1], in[2], _mm512_setzero_pd()};
    V rows[4];
    transpose_halves(four, rows);
    for (int k = 0; k < 4; ++k) {
        _mm256_mask_storeu_pd(at[k], 7, _mm512_castpd512_pd256(rows[k]));
        _mm256_mask_storeu_pd(at[4 + k], 7, _mm512_extractf64x4_pd(rows[k], 1));
    }
}

V_INLINE V load_each(const double *const at[8])
{
    return _mm512_set_pd(*at[7], *at[6], *at[5], *at[4], *at[3], *at[2], *at[1], *at[0]);
}

V_INLINE void load_spins(const se3di_spin *spins, const uint32_t *i, V out[3])
{
    const double *at[8];
    V four[4];
    for (int k = 0; k < 8; ++k) {
        at[k] = spins[i[k]].w;
    }
    load_four(at, four);
    out[0] = four[0];
    out[1] = four[1];
    out[2] = four[2];
}

/* Force and torque of each lane. */
typedef struct turned_loads {
    V load[8];
} turned_loads;

V_INLINE void turn_loads(const V force[3], const V torque[3], turned_loads *out)
{
    V zero = _mm512_setzero_pd();
    V rows[8] = {force[0], force[1], force[2], zero, torque[0], torque[1], torque[2], zero};
    transpose(rows, out->load);
}

V_INLINE void add_load(se3di_load *load, V more)
{
    _mm512_store_pd(load, _mm512_add_pd(_mm512_load_pd(load), more));
}

V_INLINE void add_turned(se3di_load *loads, const uint32_t *i, const turned_loads *of)
{
    for (int k = 0; k < 8; ++k) {
        add_load(&loads[i[k]], of->load[k]);
    }
}

/* The opposite force; the torque as it is. */
V_INLINE void take_turned(se3di_load *loads, const uint32_t *j, const turned_loads *of)
{
    for (int k = 0; k < 8; ++k) {
        V before = _mm512_load_pd(&loads[j[k]]);
        V sum = _mm512_add_pd(before, of->load[k]);
        _mm512_store_pd(&loads[j[k]], _mm512_mask_sub_pd(sum, 0x0f, before, of->load[k]));
    }
}

/* For i and for j, lane by lane. */
V_INLINE void add_in_turn(se3di_load *loads, const uint32_t *i, const uint32_t *j, const V on_i[6],
                          const V on_j[6])
{
    turned_loads on, back;
    turn_loads(on_i, on_i + 3, &on);
    turn_loads(on_j, on_j + 3, &back);
    for (int k = 0; k < 8; ++k) {
        add_load(&loads[i[k]], on.load[k]);
        add_load(&loads[j[k]], back.load[k]);
    }
}

#include "particles/clumps.inc"
#include "particles/force.inc"
#include "particles/sift.inc"
#include "particles/spheres.inc"

static const se3di_kernels core_table = {"avx512", pairs, walls, sift, clumps, spheres};

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_kernels, se3di_particle_kernels_avx512, se3di_has_avx512, core_table)
