/* SPDX-License-Identifier: BSD-3-Clause */
/* Files of meshes that a machine names: where they are, seen from the model file. */
#ifndef SE3D_IO_IMPORT_MESH_H
#define SE3D_IO_IMPORT_MESH_H

#include "io/import/machine.h"

/* Take the mesh that `name` means, a path relative to `folder` (NULL or "": that of the file that
 * is imported) or package://, model:// or file:// something, into `shape`. @return false: the
 * reason was noted, and the shape is none. */
bool se3di_mesh_take(se3di_machine *m, size_t line, const char *folder, const char *name,
                     const double scale[3], se3di_machine_shape *shape);
/* The path of `name`, relative to `folder`, or NULL: no memory. */
const char *se3di_path_join(se3di_machine *m, const char *folder, const char *name);
/* The folder of a path, "." if it has none; NULL: no memory. */
const char *se3di_path_folder(se3di_machine *m, const char *path);

#endif
