/* SPDX-License-Identifier: BSD-3-Clause */
/* Materials by their names. */
#ifndef SE3D_IO_MATERIALS_H
#define SE3D_IO_MATERIALS_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* The material that the value of `key` names, which is made when it is needed first. */
bool se3di_read_key_material(se3di_reader *reader, const se3di_node *map, const char *key,
                             se3d_material *material);
/* The material of a name. @return false: there is none, or (reader->status < 0) it is refused. */
bool se3di_reader_find_material(se3di_reader *reader, const char *name, se3d_material *material);

#endif
