/* SPDX-License-Identifier: BSD-3-Clause */
/* Slips and the Magic Formula with derivatives.                        docs/theory/tyre.md */
#include "force/tyre.h"

#include "force/tyre_alone.h"

typedef se3di_dual dual;

#define OF(name)   se3di_dual_##name
#define TAKE(x)    (x)
#define GIVE(x, o) ((o) = (x))

#define SLOPE(x, at, slope) ((x).d[at] = (slope))

#include "force/tyre_magic.inc"
#include "force/tyre_slip.inc"

void se3di_tyre_magic(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces)
{
    find_all(force, slip, SE3DI_TYRE_WANTS_ALL, forces);
}

void se3di_tyre_take_slip(const se3di_force *force, double cosine, const double *in,
                          se3di_tyre_slip *slip)
{
    take_slip(force, force->tyre->mirrored ? -1.0 : 1.0, cosine, in, slip);
}

void se3di_tyre_find_rates(const se3di_force *force, const double *in, int touches,
                           se3di_tyre_slip *slip, se3di_dual rate[2])
{
    find_rates(force, in, touches, slip, rate);
}
