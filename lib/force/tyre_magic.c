/* SPDX-License-Identifier: BSD-3-Clause */
/* The Magic Formula with derivatives.                                  docs/theory/tyre.md */
#include "force/tyre.h"

typedef se3di_dual dual;

#define OF(name)   se3di_dual_##name
#define TAKE(x)    (x)
#define GIVE(x, o) ((o) = (x))

#include "force/tyre_magic.inc"

void se3di_tyre_magic(const se3di_force *force, const se3di_tyre_slip *slip,
                      se3di_tyre_forces *forces)
{
    find_all(force, slip, forces);
}

void se3di_tyre_magic_relaxation(const se3di_force *force, const se3di_tyre_slip *slip,
                                 se3di_dual length[2])
{
    find_relaxation(force, slip, length);
}

se3di_dual se3di_tyre_magic_radius(const se3di_force *force, se3di_dual deflection, se3di_dual spin)
{
    const magic only = {.c = force->tyre->coefficients}, *m = &only;
    const double static_part = C(FNOMIN) / force->k, growth = force->rest / C(LONGVL);
    const se3di_dual rho = se3di_dual_scale(1.0 / static_part, deflection);
    const se3di_dual free =
        se3di_dual_square(force->rest * C(QRE0), 0.0, force->rest * C(QV1) * growth * growth, spin);
    if (!(fabs(C(DREFF)) > 0.0 || fabs(C(FREFF)) > 0.0)) {
        return se3di_dual_sub(free, se3di_dual_scale(1.0 / 3.0, deflection));
    }
    const se3di_dual bent = se3di_dual_atan(se3di_dual_scale(C(BREFF), rho));
    const se3di_dual sunk =
        se3di_dual_add(se3di_dual_scale(C(DREFF), bent), se3di_dual_scale(C(FREFF), rho));
    return se3di_dual_sub(free, se3di_dual_scale(static_part, sunk));
}
