/* SPDX-License-Identifier: BSD-3-Clause */
/* The Magic Formula, values alone.                                     docs/theory/tyre.md */
#include "force/tyre.h"

typedef se3di_value dual;

#define OF(name)   se3di_value_##name
#define TAKE(x)    se3di_value_of((x).v)
#define GIVE(x, o) ((o).v = (x).v)

#include "force/tyre_magic.inc"

void se3di_tyre_magic_values(const se3di_force *force, const se3di_tyre_slip *slip,
                             se3di_tyre_forces *forces)
{
    find_all(force, slip, forces);
}

void se3di_tyre_magic_relaxation_values(const se3di_force *force, const se3di_tyre_slip *slip,
                                        se3di_dual length[2])
{
    find_relaxation(force, slip, length);
}
