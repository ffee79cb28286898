/* SPDX-License-Identifier: BSD-3-Clause */
/* The force kernels in plain C: the same bits on every machine (built with -ffp-contract=off).
 *                                                                      docs/theory/particles.md */
#include "contact/particle_set.h"

#include <math.h>

#define LANES    1
#define V_INLINE static inline

typedef double V;
typedef int M;

#define V_SET(s)          (s)
#define V_LOAD(p)         (*(p))
#define V_STORE(p, v)     (*(p) = (v))
#define V_LOAD_ANY(p)     (*(p))
#define V_STORE_ANY(p, v) (*(p) = (v))
#define V_FMA(a, b, c)    ((a) * (b) + (c))
#define V_FNMA(a, b, c)   ((c) - (a) * (b))
#define V_SQRT(a)         sqrt(a)
#define V_ROUND(a)        nearbyint(a)
#define V_LESS(a, b)      ((a) < (b))
#define V_PICK(m, a, b)   ((m) ? (a) : (b))
#define V_KEEP(m, a)      ((m) ? (a) : 0.0)
#define V_SUM(a)          (a)
#define V_LARGEST(a)      (a)
#define M_ANY(m)          (m)
#define M_COUNT(m)        ((uint64_t)(m))

V_INLINE V V_MAX(V a, V b)
{
    return a > b ? a : b;
}

V_INLINE V V_MIN(V a, V b)
{
    return a < b ? a : b;
}

V_INLINE M lanes_used(M m, const uint32_t *i, const uint32_t *j)
{
    return m && *i != *j;
}

V_INLINE M lanes_real(M m, V radius)
{
    return m && radius > 0.0;
}

V_INLINE void load_grains(const se3di_grain *grains, const uint32_t *i, V out[8])
{
    const se3di_grain *g = &grains[*i];
    for (int a = 0; a < 3; ++a) {
        out[a] = g->x[a];
        out[4 + a] = g->v[a];
    }
    out[3] = g->radius;
    out[7] = g->inverse_mass;
}

V_INLINE void load_spins(const se3di_spin *spins, const uint32_t *i, V out[3])
{
    for (int a = 0; a < 3; ++a) {
        out[a] = spins[*i].w[a];
    }
}

V_INLINE void add_loads(se3di_load *loads, const uint32_t *i, const V force[3], const V torque[3])
{
    se3di_load *load = &loads[*i];
    for (int a = 0; a < 3; ++a) {
        load->force[a] += force[a];
        load->torque[a] += torque[a];
    }
}

#include "contact/particle_force.inc"

const se3di_kernels *se3di_particle_kernels_portable(void)
{
    static const se3di_kernels table = {"portable", pairs, walls};
    return &table;
}
