/* SPDX-License-Identifier: BSD-3-Clause */
/* What must not be written over. */
#ifndef SE3D_IO_SAVE_SOURCE_H
#define SE3D_IO_SAVE_SOURCE_H

#include <stdbool.h>

#include "se3d/io.h"

/* Whether a path leads to a file that the model is made of: its own, those of its parts, tables,
 * meshes. */
bool se3di_save_takes_source(const se3d_model *model, const char *path);

#endif
