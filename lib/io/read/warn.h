/* SPDX-License-Identifier: BSD-3-Clause */
/* What a model that was read without mistakes says that is probably one: told to the log. */
#ifndef SE3D_IO_WARN_H
#define SE3D_IO_WARN_H

#include "io/document/reader.h"

/* Tell what a node says, as an error would be told: "file:line:column: path: text". */
SE3DI_IO_FORMAT(3, 4)
void se3di_reader_warn(const se3di_reader *reader, const se3di_node *node, const char *format, ...);

/* After all sections. @return false: out of memory */
bool se3di_warn_of_model(se3di_reader *reader);

#endif
