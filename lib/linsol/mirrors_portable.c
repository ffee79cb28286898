/* SPDX-License-Identifier: BSD-3-Clause */
#include "linsol/mirrors.h"

#define WIDTH 2
#include "linsol/mirrors.inc"

const se3di_mirrors *se3di_mirrors_portable(void)
{
    return &table;
}
