/* SPDX-License-Identifier: BSD-3-Clause */
/* What a unit for model exchange leaves to its caller: the joint coordinates of the model, their
 * rates, and its states; and what tells of events, which are those of the model and the ends of
 * stops. */
#ifndef SE3D_IO_FMI_STATES_H
#define SE3D_IO_FMI_STATES_H

#include "io/channel/sample.h"
#include "io/fmi/variables.h"

/* List the variables of a model. If it remembers more than states, it has none of them, and
 * `reason` of the list says why. `problem` gets why it cannot be a unit. @return OK, UNSUPPORTED,
 * NO_MEMORY; se3di_fmi_variables_destroy is fine in any case. */
se3d_status se3di_fmi_variables_create(se3d_model *model, se3di_fmi_variables *variables,
                                       char *problem, size_t problem_size);
/* The k-th stop of a model. @return false: there are not so many */
bool se3di_fmi_find_stop(const se3d_model *model, size_t k, se3d_force *stop);
/* The value of indicator k at the state of the sample. */
se3d_status se3di_fmi_eval_indicator(const se3d_model *model, size_t k, se3di_sample *sample,
                                     double *value);

#endif
