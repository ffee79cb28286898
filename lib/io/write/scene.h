/* SPDX-License-Identifier: BSD-3-Clause */
/* The motion that a scene has recorded. */
#ifndef SE3D_IO_SCENE_H
#define SE3D_IO_SCENE_H

#include <stdio.h>

#include "base/coder.h"
#include "io/write/drawing.h"

/* The records so far, of a scene of the same model. */
void se3di_scene_pack(se3d_scene *scene, se3di_coder *coder);
/* Write what se3d_scene_write writes to a file that is open. @return false: errno says why, unless
 * the file does (ferror). */
bool se3di_scene_put(se3d_scene *scene, FILE *file);
/* The same of a scene that has recorded nothing, with the bodies at the first of these poses, which
 * have times. */
bool se3di_scene_put_at(se3d_scene *scene, const se3di_poses *poses, FILE *file);

#endif
