/* SPDX-License-Identifier: BSD-3-Clause */
/* The force kernels for x86-64 with AVX2 and FMA, chosen at run time.  docs/theory/particles.md */
#include "contact/shape/mesh_tree.h"
#include "math/larger.h"
#include "particles/clump.h"
#include "particles/sift.h"
#include "particles/wall.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)
#include <immintrin.h>

SE3DI_TARGET_BEGIN(SE3DI_TARGET_AVX2)

#define LANES    4
#define BESIDE   2 /* batches: to fill the waits for roots and quotients */
#define V_INLINE static inline __attribute__((always_inline))

typedef __m256d V;
typedef __m256d M;

#define V_SET(s)          _mm256_set1_pd(s)
#define V_LOAD(p)         _mm256_load_pd(p)
#define V_STORE(p, v)     _mm256_store_pd(p, v)
#define V_LOAD_ANY(p)     _mm256_loadu_pd(p)
#define V_STORE_ANY(p, v) _mm256_storeu_pd(p, v)
#define V_FMA(a, b, c)    _mm256_fmadd_pd(a, b, c)
#define V_FNMA(a, b, c)   _mm256_fnmadd_pd(a, b, c)
#define V_SQRT(a)         _mm256_sqrt_pd(a)
#define V_MAX(a, b)       _mm256_max_pd(a, b)
#define V_MIN(a, b)       _mm256_min_pd(a, b)
#define V_ROUND(a)        _mm256_round_pd(a, _MM_FROUND_TO_NEAREST_INT | _MM_FROUND_NO_EXC)
#define V_LESS(a, b)      _mm256_cmp_pd(a, b, _CMP_LT_OQ)
#define V_PICK(m, a, b)   _mm256_blendv_pd(b, a, m)
#define V_KEEP(m, a)      _mm256_and_pd(m, a)
#define M_ANY(m)          (_mm256_movemask_pd(m) != 0)
#define M_BITS(m)         ((unsigned)_mm256_movemask_pd(m))
#define M_COUNT(m)        ((uint64_t)__builtin_popcount((unsigned)_mm256_movemask_pd(m)))

/* A row of four numbers of a record. */
typedef __m256d ROW;

#define ROW_LOAD(p)     _mm256_load_pd(p)
#define ROW_STORE(p, a) _mm256_store_pd(p, a)
#define ROW_ALL(p)      _mm256_broadcast_sd(p)
#define ROW_ADD(a, b)   _mm256_add_pd(a, b)
#define ROW_MUL(a, b)   _mm256_mul_pd(a, b)

V_INLINE ROW ROW_THREE(double s)
{
    return _mm256_blend_pd(_mm256_set1_pd(s), _mm256_setzero_pd(), 8);
}

/* What is behind three numbers may be none: it is read as 0, and stays. */
V_INLINE ROW ROW_LOAD_THREE(const double *p)
{
    const __m256i three = _mm256_set_epi64x(0, -1, -1, -1);
    return _mm256_and_pd(_mm256_load_pd(p), _mm256_castsi256_pd(three));
}

V_INLINE void ROW_STORE_THREE(double *p, ROW a)
{
    _mm256_store_pd(p, _mm256_blend_pd(a, _mm256_load_pd(p), 8));
}

V_INLINE double sum_lanes(const double *v)
{
    V a = _mm256_add_pd(_mm256_load_pd(v), _mm256_load_pd(v + 4));
    __m128d s = _mm_add_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
    return _mm_cvtsd_f64(_mm_add_sd(s, _mm_unpackhi_pd(s, s)));
}

V_INLINE double V_LARGEST(V a)
{
    __m128d s = _mm_max_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
    return _mm_cvtsd_f64(_mm_max_sd(s, _mm_unpackhi_pd(s, s)));
}

V_INLINE M lanes_used(M m, const uint32_t *i, const uint32_t *j)
{
    __m128i a = _mm_loadu_si128((const __m128i *)(const void *)i);
    __m128i b = _mm_loadu_si128((const __m128i *)(const void *)j);
    __m256i same = _mm256_cvtepi32_epi64(_mm_cmpeq_epi32(a, b));
    return _mm256_andnot_pd(_mm256_castsi256_pd(same), m);
}

V_INLINE M lanes_real(M m, V radius)
{
    return _mm256_and_pd(m, _mm256_cmp_pd(radius, _mm256_setzero_pd(), _CMP_GT_OQ));
}

V_INLINE void transpose(const V in[4], V out[4])
{
    V a = _mm256_unpacklo_pd(in[0], in[1]);
    V b = _mm256_unpackhi_pd(in[0], in[1]);
    V c = _mm256_unpacklo_pd(in[2], in[3]);
    V d = _mm256_unpackhi_pd(in[2], in[3]);
    out[0] = _mm256_permute2f128_pd(a, c, 0x20);
    out[1] = _mm256_permute2f128_pd(b, d, 0x20);
    out[2] = _mm256_permute2f128_pd(a, c, 0x31);
    out[3] = _mm256_permute2f128_pd(b, d, 0x31);
}

#define turn_rows(rows, out) transpose(rows, out)

V_INLINE void clear_load(se3di_load *load)
{
    _mm256_store_pd(load->force, _mm256_setzero_pd());
    _mm256_store_pd(load->torque, _mm256_setzero_pd());
}

V_INLINE void load_particles(const se3di_particle *particles, const uint32_t *i, V out[8])
{
    V low[4], high[4];
    for (int k = 0; k < 4; ++k) {
        low[k] = _mm256_load_pd(particles[i[k]].x);
        high[k] = _mm256_load_pd(particles[i[k]].v);
    }
    transpose(low, out);
    transpose(high, out + 4);
}

/* Of i relative to j; in [3] what nobody needs. */
V_INLINE void load_apart(const se3di_particle *particles, const uint32_t *i, const uint32_t *j,
                         V d[4], V v[4])
{
    V low[4], high[4];
    for (int k = 0; k < 4; ++k) {
        const se3di_particle *a = &particles[i[k]], *b = &particles[j[k]];
        low[k] = _mm256_sub_pd(_mm256_load_pd(a->x), _mm256_load_pd(b->x));
        high[k] = _mm256_sub_pd(_mm256_load_pd(a->v), _mm256_load_pd(b->v));
    }
    transpose(low, d);
    transpose(high, v);
}

V_INLINE void load_four(const double *const at[4], V out[4])
{
    V rows[4];
    for (int k = 0; k < 4; ++k) {
        rows[k] = _mm256_loadu_pd(at[k]);
    }
    turn_rows(rows, out);
}

V_INLINE void store_four(double *const at[4], const V in[4])
{
    V rows[4];
    transpose(in, rows);
    for (int k = 0; k < 4; ++k) {
        _mm256_storeu_pd(at[k], rows[k]);
    }
}

/* What is behind the three numbers stays. */
V_INLINE void store_three(double *const at[4], const V in[3])
{
    const V four[4] = {in[0], in[1], in[2], _mm256_setzero_pd()};
    V rows[4];
    transpose(four, rows);
    for (int k = 0; k < 4; ++k) {
        _mm256_storeu_pd(at[k], _mm256_blend_pd(rows[k], _mm256_loadu_pd(at[k]), 8));
    }
}

V_INLINE V load_each(const double *const at[4])
{
    return _mm256_set_pd(*at[3], *at[2], *at[1], *at[0]);
}

/* Also what is behind the 15 numbers. */
V_INLINE void load_facets(const se3di_mesh_facet *facets, const uint32_t *at, V out[16])
{
    for (int part = 0; part < 16; part += 4) {
        V rows[4];
        for (int k = 0; k < 4; ++k) {
            rows[k] = _mm256_loadu_pd((const double *)(const void *)&facets[at[k]] + part);
        }
        transpose(rows, out + part);
    }
}

V_INLINE void load_spins(const se3di_spin *spins, const uint32_t *i, V out[3])
{
    V rows[4], columns[4];
    for (int k = 0; k < 4; ++k) {
        rows[k] = _mm256_load_pd(spins[i[k]].w);
    }
    transpose(rows, columns);
    out[0] = columns[0];
    out[1] = columns[1];
    out[2] = columns[2];
}

/* Of each lane. */
typedef struct turned_loads {
    V force[4], torque[4];
} turned_loads;

V_INLINE void turn_loads(const V force[3], const V torque[3], turned_loads *out)
{
    V forces[4] = {force[0], force[1], force[2], _mm256_setzero_pd()};
    V torques[4] = {torque[0], torque[1], torque[2], _mm256_setzero_pd()};
    transpose(forces, out->force);
    transpose(torques, out->torque);
}

V_INLINE void add_load(se3di_load *load, V force, V torque)
{
    _mm256_store_pd(load->force, _mm256_add_pd(_mm256_load_pd(load->force), force));
    _mm256_store_pd(load->torque, _mm256_add_pd(_mm256_load_pd(load->torque), torque));
}

V_INLINE void add_turned(se3di_load *loads, const uint32_t *i, const turned_loads *of)
{
    for (int k = 0; k < 4; ++k) {
        add_load(&loads[i[k]], of->force[k], of->torque[k]);
    }
}

/* The opposite force; the torque as it is. */
V_INLINE void take_turned(se3di_load *loads, const uint32_t *j, const turned_loads *of)
{
    for (int k = 0; k < 4; ++k) {
        se3di_load *load = &loads[j[k]];
        _mm256_store_pd(load->force, _mm256_sub_pd(_mm256_load_pd(load->force), of->force[k]));
        _mm256_store_pd(load->torque, _mm256_add_pd(_mm256_load_pd(load->torque), of->torque[k]));
    }
}

/* For i and for j, lane by lane. */
V_INLINE void add_in_turn(se3di_load *loads, const uint32_t *i, const uint32_t *j, const V on_i[6],
                          const V on_j[6])
{
    turned_loads on, back;
    turn_loads(on_i, on_i + 3, &on);
    turn_loads(on_j, on_j + 3, &back);
    for (int k = 0; k < 4; ++k) {
        add_load(&loads[i[k]], on.force[k], on.torque[k]);
        add_load(&loads[j[k]], back.force[k], back.torque[k]);
    }
}

#include "particles/clumps.inc"
#include "particles/force.inc"
#include "particles/sift.inc"
#include "particles/spheres.inc"

static const se3di_kernels core_table = {"avx2", pairs, walls, sift, clumps, spheres};

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_kernels, se3di_particle_kernels_avx2, se3di_has_avx2, core_table)
