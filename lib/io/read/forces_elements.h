/* SPDX-License-Identifier: BSD-3-Clause */
/* Force elements of one type each. */
#ifndef SE3D_IO_FORCES_ELEMENTS_H
#define SE3D_IO_FORCES_ELEMENTS_H

#include "io/document/reader.h"
#include "io/model/model.h"

bool se3di_read_bushing(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);
bool se3di_read_friction(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);
bool se3di_read_effort(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);
bool se3di_read_stop(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);

#endif
