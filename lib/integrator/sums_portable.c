/* SPDX-License-Identifier: BSD-3-Clause */
#include "integrator/sums.h"

#define WIDTH 2
#include "integrator/sums.inc"

const se3di_sums *se3di_sums_portable(void)
{
    return &table;
}
