/* SPDX-License-Identifier: BSD-3-Clause */
/* The recursions of the tree in plain C.                    docs/theory/joint_coordinates.md */
#include "math/fma.h"
#include "tree/core.h"

#define fma_of(a, b, c) se3di_fma(a, b, c)

#include "tree/core_one.inc"

const se3di_tree_core *se3di_tree_core_portable(void)
{
    return &core_table;
}
