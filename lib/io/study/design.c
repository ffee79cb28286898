/* SPDX-License-Identifier: BSD-3-Clause */
/* Layouts of samples.
 *
 * A layout gives each parameter a share u in (0, 1) for sample i; the quantile of its distribution
 * makes a value of it. Grids and tables have values of their own.
 *
 *     monte_carlo      u = random(seed, parameter, i)
 *     latin_hypercube  u = (order(seed, parameter, i) + random(seed, parameter, i)) / n
 *     sobol            u = Sobol's point i, its bits shifted by those of random(seed, parameter)
 *
 * docs/theory/studies.md */
#include "io/study/design.h"

#include <math.h>

#include "io/base/elementary.h"
#include "io/study/quantile.h"
#include "io/study/random.h"

enum { SOBOL_DEGREE_MAX = 7, BITS = 32 };

/* Primitive polynomials over GF(2), and the first direction numbers: S. Joe, F. Y. Kuo,
 * Constructing Sobol sequences with better two-dimensional projections, SIAM J. Sci. Comput. 30
 * (2008) 2635-2654, for dimensions 2 to 21. Bit degree-1-k of `polynomial` is its k-th inner
 * coefficient. */
typedef struct sobol_row {
    uint32_t degree, polynomial;
    uint32_t m[SOBOL_DEGREE_MAX];
} sobol_row;

static const sobol_row sobol_rows[] = {
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
};

/* The direction numbers of a dimension, as 32 bits behind the point. */
static void make_directions(size_t k, uint32_t v[BITS])
{
    for (uint32_t i = 0; i < BITS; ++i) {
        v[i] = UINT32_C(1) << (BITS - 1 - i);
    }
    if (k == 0) {
        return;
    }
    const sobol_row *row = &sobol_rows[k - 1];
    const uint32_t s = row->degree;
    for (uint32_t i = 0; i < BITS; ++i) {
        if (i < s) {
            v[i] = row->m[i] << (BITS - 1 - i);
            continue;
        }
        v[i] = v[i - s] ^ v[i - s] >> s;
        for (uint32_t j = 1; j < s; ++j) {
            v[i] ^= (row->polynomial >> (s - 1 - j) & 1u) ? v[i - j] : 0u;
        }
    }
}

uint32_t se3di_design_sobol(size_t k, uint32_t index)
{
    uint32_t v[BITS];
    uint32_t x = 0;
    make_directions(k, v);
    for (uint32_t i = 0; i < BITS; ++i) {
        x ^= index >> i & 1u ? v[i] : 0u;
    }
    return x;
}

static double get_share(const se3di_study_entry *entry, size_t k, uint64_t index)
{
    const uint64_t seed = (uint64_t)entry->seed;
    const uint32_t stream = (uint32_t)k;
    const double draw =
        se3di_random_uniform(se3di_random_bits(seed, SE3DI_RANDOM_DRAW, stream, index));
    if (entry->method == SE3DI_STUDY_LATIN_HYPERCUBE) {
        const uint64_t place = se3di_random_place(seed, stream, (uint64_t)entry->samples, index);
        const double u = ((double)place + draw) / entry->samples;
        return fmin(u, 1.0 - 0x1p-53); /* the sum may have been rounded up */
    }
    if (entry->method == SE3DI_STUDY_SOBOL) {
        const uint32_t shift = (uint32_t)se3di_random_bits(seed, SE3DI_RANDOM_SHIFT, stream, 0);
        const uint32_t x = se3di_design_sobol(k, (uint32_t)index) ^ shift;
        return ((double)x + 0.5) * 0x1p-32;
    }
    return draw;
}

/* The value at the share u of a distribution. */
static double get_quantile(const se3di_study_variable *v, double u)
{
    const double *a = v->a;
    switch (v->distribution) {
    case SE3DI_DISTRIBUTION_LIST:
        return v->values[(size_t)fmin(u * (double)v->count, (double)(v->count - 1))];
    case SE3DI_DISTRIBUTION_NORMAL:
        return a[0] + a[1] * se3di_quantile_normal(u);
    case SE3DI_DISTRIBUTION_LOGNORMAL:
        return io_exp(a[0] + a[1] * se3di_quantile_normal(u));
    case SE3DI_DISTRIBUTION_TRIANGULAR:
        return se3di_quantile_triangular(a, u);
    case SE3DI_DISTRIBUTION_EXPONENTIAL:
        return a[0] * se3di_quantile_exponential(u);
    case SE3DI_DISTRIBUTION_WEIBULL:
        return a[0] * io_pow(se3di_quantile_exponential(u), 1.0 / a[1]);
    default:
        return a[0] + u * (a[1] - a[0]);
    }
}

/* The k-th value of a parameter of a grid: the ends are those that are written. */
static double get_step(const se3di_study_variable *v, uint64_t k)
{
    if (v->distribution == SE3DI_DISTRIBUTION_LIST) {
        return v->values[k];
    }
    if (k == 0 || v->count == 1) {
        return v->a[0];
    }
    const double last = (double)(v->count - 1);
    return k + 1 == v->count ? v->a[1] : v->a[0] + (v->a[1] - v->a[0]) * ((double)k / last);
}

uint64_t se3di_design_count(const se3di_study_entry *entry)
{
    return (uint64_t)entry->samples;
}

void se3di_design_get(const se3di_study_entry *entry, uint64_t index, double *values)
{
    uint64_t rest = index;
    for (size_t k = entry->variable_count; k-- > 0;) {
        const se3di_study_variable *v = &entry->variables[k];
        if (entry->method == SE3DI_STUDY_TABLE) {
            values[k] = v->values[index];
        } else if (entry->method == SE3DI_STUDY_GRID) {
            values[k] = get_step(v, rest % v->count);
            rest /= v->count;
        } else {
            values[k] = get_quantile(v, get_share(entry, k, index));
        }
    }
}
