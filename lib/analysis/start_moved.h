/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies that an assembly has put far from where they were given: a wrong point or position. */
#ifndef SE3DI_START_MOVED_H
#define SE3DI_START_MOVED_H

#include "model/model.h"

/* Write into `text` a sentence about the body that was moved by most times its size, if one was by
 * more than that: its size is twice the distance of its centre of mass from the farthest of its
 * joints, force elements and edges. `given`: the frames of all bodies before. Returns whether there
 * is one. */
int se3di_start_moved_describe(const se3di_model *model, const se3di_frame *given, char *text,
                               size_t size);

#endif
