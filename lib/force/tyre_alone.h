/* SPDX-License-Identifier: BSD-3-Clause */
/* Tyres one by one: what tyre_magic.inc and tyre_slip.inc are compiled with. */
#ifndef SE3DI_FORCE_TYRE_ALONE_H
#define SE3DI_FORCE_TYRE_ALONE_H

#include "force/tyre.h"

typedef double number;

#define PICK(holds, a, b)  ((holds) ? (a) : (b))
#define ANY(holds)         (holds)
#define IS_NOT(holds)      (!(holds))
#define ABS(x)             fabs(x)
#define ROOT(x)            sqrt(x)
#define ARCSINE(x)         se3di_asin(x)
#define POWER(x, exponent) se3di_pow(x, exponent)

#define SLIP     se3di_tyre_slip
#define FORCES   se3di_tyre_forces
#define RATE     se3di_dual
#define FOLLOWED se3di_tyre_followed

#endif
