/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of the user's constraints within those of the model. A callback that fails leaves
 * zeros and is remembered in the model; the next se3di_user_report, at the latest at the next time
 * that functions of time are evaluated, says so. */
#ifndef SE3DI_ASSEMBLY_USER_H
#define SE3DI_ASSEMBLY_USER_H

#include "assembly/assembly.h"
#include "primitive/user.h"

/* Nothing has failed yet. */
void se3di_user_begin(se3di_model *model);
/* The failure since se3di_user_begin, with a message; a value that was not finite is forgotten with
 * it (a shorter step may avoid it), a callback that returned a failure is not.
 * @return OK, CALLBACK, NOT_FINITE */
se3d_status se3di_user_report(se3di_model *model, se3di_error *error);

/* Ask every callback for nu, so that one that failed outside the equations is known. */
void se3di_user_find_failure(se3di_model *model);

/* phi, gamma [rows of the model]: those of the user's constraints are written. */
void se3di_user_eval_phi(const se3di_assembly *assembly, double *phi);
void se3di_user_eval_gamma(const se3di_assembly *assembly, double *gamma);
/* Blocks of C, and nu into f. */
void se3di_user_eval_jacobian(se3di_assembly *assembly);

#endif
