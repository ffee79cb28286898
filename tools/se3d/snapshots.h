/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots of particles, packed for the page. */
#ifndef SE3D_TOOL_SNAPSHOTS_H
#define SE3D_TOOL_SNAPSHOTS_H

#include <stdio.h>

/* True if a results file holds snapshots of particles. */
int snapshots_is(const char *path);
/* Write them as a JSON object: times, the box around all, radii, and of each snapshot the positions
 * as 16-bit parts of the box (65535: not there), and, if the file has them, forces as 16-bit parts
 * of the largest, names and numbers of sets. Of very many, every so many are written; "null"
 * if there are none. @return false after a message. */
int snapshots_put(FILE *out, const char *command, const char *path);
/* Write bytes in base64. */
void base64_put(FILE *file, const void *data, size_t size);

#endif
