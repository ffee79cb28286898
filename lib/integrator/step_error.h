/* SPDX-License-Identifier: BSD-3-Clause */
/* What the steps of rattle and verlet, which control no error, may have made in all: by the change
 * of accelerations over each step,
 *
 *     error of a step   h^2 |a_1 - a_0| / 12      of order h^3, as that of the methods
 *
 * summed over the run. Steps that nobody has given are told of in the log if that is much. */
#ifndef SE3DI_STEP_ERROR_H
#define SE3DI_STEP_ERROR_H

typedef struct se3di_step_error {
    double shift, turn; /* of the body that has most [m], [rad] */
    double told; /* as much was told of, relative to the size of the model or in rad; 0: none */
} se3di_step_error;

struct se3di_integration;

/* After a step of h whose start is in equations->accepted_acceleration, of order 2, without shapes
 * near each other or particles, which choose their own steps; tell at the first part in a thousand,
 * and whenever it has grown tenfold. */
void se3di_step_error_add(struct se3di_integration *integration, double h);

#endif
