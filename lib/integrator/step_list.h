/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps that other runs repeat, so that what they compute is a smooth function of their data. */
#ifndef SE3DI_STEP_LIST_H
#define SE3DI_STEP_LIST_H

#include "integrator/integrator.h"

/* A motion begins at t: what integration->record has is over, if there is one. */
void se3di_step_list_begin(const se3di_integration *integration, double t);
/* Note the end of a step in integration->record, if there is one. @return OK, NO_MEMORY */
se3d_status se3di_step_list_note(const se3di_integration *integration, double end);
/* The next step of integration->repeat from `begin`, of *h to *end; 0 at a kink, which is
 * integration->at_kink. @return OK, STEP_SIZE (there is none from here), INTERRUPTED, STEP_COUNT */
se3d_status se3di_step_list_next(se3di_integration *integration, double begin, double *h,
                                 double *end);
/* The failure of a step that cannot be made. */
se3d_status se3di_step_list_fail(const se3di_integration *integration);

#endif
