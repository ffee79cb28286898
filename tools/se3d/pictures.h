/* SPDX-License-Identifier: BSD-3-Clause */
/* The pictures that a model's `output` asks for. */
#ifndef SE3D_TOOL_PICTURES_H
#define SE3D_TOOL_PICTURES_H

#include "se3d/io.h"

/* Make them from the results in `folder`; `type` NULL: all, else those of this type. One that fails
 * does not keep the others from being made. @return the exit code, after messages where one failed.
 */
int pictures_make(const se3d_model *model, se3d_scene *scene, const char *folder, const char *type,
                  int quiet);

#endif
