/* SPDX-License-Identifier: BSD-3-Clause */
/* The page that shows a scene. */
#ifndef SE3D_TOOL_VIEW_H
#define SE3D_TOOL_VIEW_H

/* Write the page of a folder of results. @return the exit code, after a message where it failed. */
int view_write(const char *command, const char *folder, const char *path);

#endif
