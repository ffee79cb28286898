/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of elements that may be set between steps. */
#ifndef SE3D_IO_SETTABLE_H
#define SE3D_IO_SETTABLE_H

#include "io/model/model.h"

/* Set a number of a load, an effort or a driver that is settable (se3di_element_entry).
 * @param[in] component  of a load, from 0 */
se3d_status se3di_element_set(const se3d_model *model, size_t element, size_t component,
                              double value);
/* Get the time and the integral of a rate (se3di_element_entry) then. */
se3d_status se3di_rate_get_place(const se3d_model *model, se3d_function rate, double *time,
                                 double *place);
/* Set a rate to `value` from `time` on, when its integral is `place`. It changes the time of the
 * system. */
se3d_status se3di_rate_put_place(const se3d_model *model, se3d_function rate, double time,
                                 double place, double value);

#endif
