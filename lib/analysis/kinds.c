/* SPDX-License-Identifier: BSD-3-Clause */
#include "analysis/kinds.h"

#include <stddef.h>

typedef struct kind {
    const char *name;
    uint32_t traits;
} kind;

static const kind kinds[] = {
#define ROW(ANALYSIS, name, traits) [SE3D_ANALYSIS_##ANALYSIS] = {#name, traits},
    SE3DI_ANALYSIS_LIST(ROW)
#undef ROW
};

#define COUNT_ONE(ANALYSIS, name, traits) +1
_Static_assert(sizeof kinds / sizeof *kinds == 0 SE3DI_ANALYSIS_LIST(COUNT_ONE),
               "the numbers of se3d_analysis are those of the list, without gaps");
#undef COUNT_ONE

static const kind *find(int32_t analysis)
{
    static const kind none = {"", 0};
    return analysis >= 0 && (size_t)analysis < sizeof kinds / sizeof *kinds ? &kinds[analysis]
                                                                            : &none;
}

const char *se3di_analysis_get_name(int32_t analysis)
{
    return find(analysis)->name;
}

int se3di_analysis_is(int32_t analysis, uint32_t traits)
{
    return (find(analysis)->traits & traits) != 0;
}
