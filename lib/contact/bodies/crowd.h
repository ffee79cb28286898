/* SPDX-License-Identifier: BSD-3-Clause */
/* Many bodies at each other, where following each contact takes long. */
#ifndef SE3DI_CONTACT_CROWD_H
#define SE3DI_CONTACT_CROWD_H

#include "model/model.h"

#define SE3DI_CROWD 10 /* free bodies */

/* So many free bodies touch something, or are a small part of their size from doing so while bounds
 * overlap: those of balls do only if they touch. */
int se3di_bodies_crowd(const se3di_model *model);

#endif
