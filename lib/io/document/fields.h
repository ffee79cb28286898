/* SPDX-License-Identifier: BSD-3-Clause */
/* Reading what has a place in a structure, by the table of an object. */
#ifndef SE3D_IO_FIELDS_H
#define SE3D_IO_FIELDS_H

#include "io/document/reader.h"

/* Read all keys of a map that go into `target`, a structure of this name, in the order of the
 * table; what is not there is left alone. type NULL: the object has none. */
bool se3di_read_fields(se3di_reader *reader, const se3di_node *map, const se3di_object *object,
                       const char *type, const char *structure, void *target);
/* Read one key, also of those that go nowhere, as its row says; what is not there is left alone. */
bool se3di_read_key(se3di_reader *reader, const se3di_node *map, const se3di_object *object,
                    const char *type, const char *key, void *value);

#endif
