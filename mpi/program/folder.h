/* SPDX-License-Identifier: BSD-3-Clause */
/* Folders of results that do not stay. */
#ifndef SE3DM_FOLDER_H
#define SE3DM_FOLDER_H

/* Copy what is in a folder into one that is there; nothing if the first one is not. @return 0: it
 * cannot be copied */
int folder_copy(const char *from, const char *to);
/* Take a folder away with all that is in it. */
void folder_remove(const char *path);

#endif
