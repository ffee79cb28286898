/* SPDX-License-Identifier: BSD-3-Clause */
#ifndef SE3DI_FORCE_STOP_H
#define SE3DI_FORCE_STOP_H

/* The damping d(e) of a stop with the coefficient of restitution e, 0 < e <= 1; see stop.c. */
double se3di_stop_damping(double e);

#endif
