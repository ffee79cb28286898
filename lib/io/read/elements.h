/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints, constraints, drivers and forces: what they have in common. */
#ifndef SE3D_IO_ELEMENTS_H
#define SE3D_IO_ELEMENTS_H

#include "io/document/reader.h"
#include "io/model/model.h"

/* The words of se3d_joint_coordinate; NULL at the end. */
extern const char *const se3di_coordinates[];

/* Begin an element: its name, given or made up, is added to the model. */
bool se3di_read_element(se3di_reader *reader, const se3di_node *node, se3di_element_kind kind,
                        se3di_element_entry **entry);
/* The joint whose name stands under `key`. */
bool se3di_read_key_joint(se3di_reader *reader, const se3di_node *map, const char *key,
                          se3d_constraint *joint);
/* The coordinate of `joint` under `coordinate`, or the only one that it has. */
bool se3di_read_key_coordinate(se3di_reader *reader, const se3di_node *map, se3d_constraint joint,
                               int32_t *coordinate);

/* The angle of a joint may be used: it counts as in a part that is not mirrored. */
bool se3di_check_angle(se3di_reader *reader, const se3di_node *node, se3d_constraint joint);

#endif
