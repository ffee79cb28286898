/* SPDX-License-Identifier: BSD-3-Clause */
/* What happens before the analysis that is stepped through. */
#ifndef SE3D_IO_FMI_BEFORE_H
#define SE3D_IO_FMI_BEFORE_H

#include "io/model/model.h"

/* Run the analyses before `index` as se3d_model_run does, events included: each begins at its
 * `start`, or where the one before has ended.
 * @param[in] interrupt  asked whether to end; NULL: never
 * @param[out] start     when the analysis `index` begins
 * @param[out] failed    which one has failed
 * @return OK, or the failure. */
se3d_status se3di_fmi_run_before(se3d_model *model, size_t index, se3d_interrupt interrupt,
                                 void *ctx, double *start, size_t *failed);

#endif
