/* SPDX-License-Identifier: BSD-3-Clause */
/* The page that shows a scene, and films of it. */
#ifndef SE3D_TOOL_VIEW_H
#define SE3D_TOOL_VIEW_H

/* Write the page of a folder of results. @return the exit code, after a message if it failed. */
int view_write(const char *command, const char *folder, const char *other, const char *path);

/* Read "AZIMUTH,ELEVATION" [degrees]; NULL: `view` stays. @return false after a message. */
int view_read_angles(const char *command, const char *text, double view[2]);

/* Make a film of a folder of results; `speed`: seconds of motion in one of film. @return the exit
 * code, after a message if it failed. */
int video_write(const char *results, const char *path, double speed, int quiet);

#endif
