/* SPDX-License-Identifier: BSD-3-Clause */
/* The force kernels in plain C, for every machine.                     docs/theory/particles.md */
#include "contact/shape/mesh_tree.h"
#include "math/fma.h"
#include "math/larger.h"
#include "particles/clump.h"
#include "particles/sift.h"
#include "particles/wall.h"

#define FMA(a, b, c) se3di_fma(a, b, c)
#include "particles/force_plain.inc"

const se3di_kernels *se3di_particle_kernels_portable(void)
{
    static const se3di_kernels table = {"portable", pairs, walls, sift, clumps, spheres};
    const se3di_kernels *fused = se3di_particle_kernels_fma();
    return fused ? fused : &table;
}
