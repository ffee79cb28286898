/* SPDX-License-Identifier: BSD-3-Clause */
/* A spring by which a user pulls at a body. */
#ifndef SE3D_IO_PULL_H
#define SE3D_IO_PULL_H

#include <stdbool.h>

#include "se3d/se3d.h"

/* All zero: nothing is pulled. */
typedef struct se3di_pull {
    se3d_force force;
    se3d_body body;
    double point[3]; /* frame of the body [m] */
    double place[3]; /* that it is pulled to, ground frame [m] */
    double k, c;     /* [N/m, N s/m] */
} se3di_pull;

/* Pull a body, or move the place that it is pulled to. The pull must stay where it is until it is
 * released or the system is gone. @return false: the body is fixed, a number is not finite, or out
 * of memory; nothing is pulled then. */
bool se3di_pull_set(se3di_pull *pull, se3d_system *system, se3d_body body, const double point[3],
                    const double place[3]);
void se3di_pull_release(se3di_pull *pull, se3d_system *system);
/* The system will be gone. */
void se3di_pull_forget(se3di_pull *pull);

#endif
