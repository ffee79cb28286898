/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts of a model: files that are included and instances of `parts`. */
#ifndef SE3D_IO_INCLUDE_H
#define SE3D_IO_INCLUDE_H

#include "io/document/part.h"
#include "io/document/reader.h"

/* Files that were read, kept for further readings of the model. */
typedef struct se3di_library {
    se3di_iopool *pool;
    struct se3di_library_entry *first;
    size_t bytes, count;
} se3di_library;

/* Begin with the part of the model itself, which the reader is at then. */
bool se3di_read_main_part(se3di_reader *reader, const se3di_node *root);
/* All parts below it, in the order of the entries, each before those that it includes. */
bool se3di_read_parts(se3di_reader *reader, se3di_library *library);
/* Let the reader stand in a part. */
void se3di_reader_enter(se3di_reader *reader, const se3di_component *part);

#endif
