/* SPDX-License-Identifier: BSD-3-Clause */
/* The force kernels in plain C for x86-64 with FMA, where fma() is one instruction and not a call:
 * what is chosen if no vectors are wanted.                          docs/theory/particles.md */
#include "contact/shape/mesh_tree.h"
#include "math/larger.h"
#include "particles/clump.h"
#include "particles/sift.h"
#include "particles/wall.h"

#include "base/target.h"

#if defined(SE3DI_TARGETS)

SE3DI_TARGET_BEGIN(SE3DI_TARGET_FMA)

#define FMA(a, b, c) fma(a, b, c)
#include "particles/force_plain.inc"

static const se3di_kernels core_table = {"fma", pairs, walls, sift, clumps, spheres};

SE3DI_TARGET_END

#endif

SE3DI_TARGET_FINDER(se3di_kernels, se3di_particle_kernels_fma, se3di_has_fma, core_table)
