/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints between joints. */
#ifndef SE3D_IO_COUPLINGS_H
#define SE3D_IO_COUPLINGS_H

#include "io/document/reader.h"
#include "io/model/model.h"

bool se3di_read_gear(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);
bool se3di_read_rack(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);
bool se3di_read_coupler(se3di_reader *reader, const se3di_node *node, se3di_element_entry *entry);

#endif
