/* SPDX-License-Identifier: BSD-3-Clause */
/* Files that are read and written in folders where others may have left something: links are not
 * followed, pipes and devices not opened, and what is not whole gets no name. */
#ifndef SE3D_TOOL_FILE_H
#define SE3D_TOOL_FILE_H

#include <stdio.h>

/* Begin a file under a temporary name in its folder, a new one: what stood there under that name is
 * taken away, a link is not followed. @return NULL: errno says why. */
FILE *file_begin(const char *path);
/* Complete it and give it its name, or take it away where `good` is false. @return false: errno
 * says why. */
int file_end(FILE *file, const char *path, int good);
/* Copy what is at `from`. @return false: errno says why. */
int file_copy(const char *from, const char *to);
/* Copy into a file that is open. */
int file_append(FILE *file, const char *from);
/* Open a regular file for reading; a pipe or device is EINVAL. @return NULL: errno says why. */
FILE *file_read(const char *path);
/* True for a file or folder of this user or of root that others cannot change. */
int file_is_own(const char *path);

#endif
