/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that the program copies and asks about; how they are opened and completed is said in
 * io/base/file.h, for libse3d-io and the program alike. */
#ifndef SE3D_TOOL_FILE_H
#define SE3D_TOOL_FILE_H

#include <stdio.h>

#include "io/base/file.h"

/* Complete a file of se3di_partial_open and give it its name, or take it away if it is not `good`.
 * @return false: errno says why. */
int file_end(FILE *file, const char *path, int good);
/* Copy what is at `from`. @return false: errno says why. */
int file_copy(const char *from, const char *to);
/* Copy into a file that is open. */
int file_append(FILE *file, const char *from);
/* True for a file or folder of this user or of root that others cannot change. */
int file_is_own(const char *path);
/* True if there is nothing of this name. */
int file_is_missing(const char *path);

#endif
