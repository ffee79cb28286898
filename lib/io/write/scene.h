/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion that a scene has recorded. */
#ifndef SE3D_IO_SCENE_H
#define SE3D_IO_SCENE_H

#include "base/coder.h"
#include "io/model/model.h"

/* The records so far, of a scene of the same model. */
void se3di_scene_pack(se3d_scene *scene, se3di_coder *coder);

#endif
