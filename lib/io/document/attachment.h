/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that a model names: meshes, tables of particles. */
#ifndef SE3D_IO_ATTACHMENT_H
#define SE3D_IO_ATTACHMENT_H

#include "io/document/reader.h"

/* The path of a file beside the one that the reader is at, in memory of `pool`; NULL: none. */
const char *se3di_find_attachment(const se3di_reader *reader, se3di_iopool *pool, const char *file);
/* Load the file that a key of a map names, relative to the model, to memory of `pool`; a zero
 * follows it. */
bool se3di_read_attachment(se3di_reader *reader, const se3di_node *map, const char *key,
                           const char *file, se3di_iopool *pool, char **text, size_t *size);

#endif
