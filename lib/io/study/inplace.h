/* SPDX-License-Identifier: BSD-3-Clause */
/* Samples whose parameters are set in a model that was read already. */
#ifndef SE3D_IO_STUDY_INPLACE_H
#define SE3D_IO_STUDY_INPLACE_H

#include "io/study/study.h"

/* Get a model with these values, without reading it, if they are of parameters that say nothing but
 * what can be defined again in a system; else *model is NULL. `pool`: of the sample; the model is
 * to be left by se3di_inplace_end, before the pool ends.
 * @return OK, NO_MEMORY */
se3d_status se3di_inplace_begin(se3d_study *study, const se3di_named *values, size_t count,
                                se3di_iopool *pool, se3d_model **model);
/* Take the system of the sample that se3di_inplace_begin has begun, which ends: the caller destroys
 * it. What the model says beside it is that of the next sample. */
se3d_system *se3di_inplace_take(se3d_study *study);
/* End the sample that se3di_inplace_begin has begun. */
void se3di_inplace_end(se3d_study *study);
/* Whether a model is kept for the parameters of the last sample. */
bool se3di_inplace_is_kept(const se3d_study *study);
/* Keep no model. */
void se3di_inplace_destroy(se3d_study *study);

#endif
