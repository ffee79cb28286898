/* SPDX-License-Identifier: BSD-3-Clause */
/* An analysis of type modes. */
#ifndef SE3D_IO_MODES_H
#define SE3D_IO_MODES_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* The keys that only an analysis of type modes has. */
bool se3di_read_modes(se3di_reader *reader, const se3di_node *node, se3di_analysis_entry *entry);

#endif
