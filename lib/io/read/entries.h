/* SPDX-License-Identifier: BSD-3-Clause */
/* Lists of a model file, entry by entry. */
#ifndef SE3D_IO_ENTRIES_H
#define SE3D_IO_ENTRIES_H

#include "io/document/reader.h"

/* Read the entries of a list that are wanted and whose `when` holds. */
bool se3di_read_each(se3di_reader *reader, const se3di_node *root, const char *key,
                     bool (*read)(se3di_reader *reader, const se3di_node *node));
/* A zeroed array for all entries of a list (NULL: none); NULL: no memory, which is reported. */
void *se3di_read_room(se3di_reader *reader, const se3di_node *list, size_t size);
bool se3di_read_entries(se3di_reader *reader, const se3di_node *list,
                        bool (*read)(se3di_reader *reader, const se3di_node *node));

#endif
