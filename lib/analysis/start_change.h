/* SPDX-License-Identifier: BSD-3-Clause */
/* How much of the given start an analysis had to change: positions and velocities that the
 * constraints do not admit are projected onto them. */
#ifndef SE3DI_START_CHANGE_H
#define SE3DI_START_CHANGE_H

#include "model/model.h"

typedef struct se3di_start_change {
    double time;             /* [s] */
    double position;         /* roots of the sums of squares over the bodies [m] */
    double rotation;         /* [rad] */
    double velocity;         /* [m/s] */
    double angular_velocity; /* [rad/s] */
    double most_position[2]; /* of the body that moved most [m], [rad] */
    double most_velocity[2]; /* of the body whose velocity changed most [m/s], [rad/s] */
    se3di_handle moved;      /* null: none beyond rounding */
    se3di_handle deflected;
} se3di_start_change;

/* What lies between the frames `given` and those of the model. What is rounding by the size and the
 * speeds of the model counts as zero; `driven`: drivers determine the velocities. */
void se3di_start_change_measure(const se3di_model *model, const se3di_frame *given, int driven,
                                se3di_start_change *change);
/* Tell the log. */
void se3di_start_change_log(const se3di_model *model, const se3di_start_change *change,
                            se3d_log_level level, se3di_error *error);

#endif
