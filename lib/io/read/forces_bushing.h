/* SPDX-License-Identifier: BSD-3-Clause */
/* Bushings. */
#ifndef SE3D_IO_FORCES_BUSHING_H
#define SE3D_IO_FORCES_BUSHING_H

#include "io/document/reader.h"
#include "io/model/model.h"

bool se3di_read_bushing(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);

#endif
