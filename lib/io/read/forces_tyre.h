/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements of the type `tyre`. */
#ifndef SE3D_IO_FORCES_TYRE_H
#define SE3D_IO_FORCES_TYRE_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* The words of se3d_tyre_law and se3d_tyre_side; NULL at the end. */
extern const char *const se3di_tyre_laws[];
extern const char *const se3di_tyre_sides[];

bool se3di_read_tyre(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);

#endif
