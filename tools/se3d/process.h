/* SPDX-License-Identifier: BSD-3-Clause */
/* Other programs that `se3d` runs: gnuplot, Chromium, ffmpeg. */
#ifndef SE3D_TOOL_PROCESS_H
#define SE3D_TOOL_PROCESS_H

#include <stddef.h>

/* True if a program is on the PATH, or is a path of an executable file. */
int process_is_found(const char *name);

/* Run a program in `folder` (NULL: here) and wait for it. `words` ends with NULL. @return its exit
 * code, -1 if it could not be run. */
int process_run(const char *folder, const char *const *words);

/* argv[0], kept as it is. */
void process_set_own_name(const char *name);

/* The folder of this program: by /proc, or by the name that it was called by. @return false: it is
 * not known. */
int process_get_own_folder(char *folder, size_t size);

/* Say that a program is missing and how to get it. @return EXIT_FAILED. */
int process_report_missing(const char *command, const char *name, const char *package);

/* The folder of a path, "." where it names none. @return false: it does not fit. */
int path_get_folder(const char *path, char *folder, size_t size);
/* What comes after the folder. */
const char *path_get_name(const char *path);
/* Copy a path without its extension, if that is `extension` (".csv"). */
int path_cut(const char *path, const char *extension, char *out, size_t size);
/* True for the names of model files. */
int path_is_model(const char *path);
/* True if the path begins at the root. */
int path_is_absolute(const char *path);
/* The absolute form of a path of something that exists. @return false: there is none. */
int path_get_absolute(const char *path, char *out, size_t size);

#endif
