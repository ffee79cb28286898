/* SPDX-License-Identifier: BSD-3-Clause */
/* Archives (zip) that others have made, into a folder of our own. */
#ifndef SE3D_IO_UNZIP_H
#define SE3D_IO_UNZIP_H

#include <stdbool.h>

#include "se3d/base.h"

/* Unpack the files of an archive whose names are wanted into `folder`, which ends without a slash.
 * The list of the archive is believed in nothing: every name must stay in the folder, whether it is
 * wanted or not; links, devices, encrypted files and such as overlap are refused, and what would
 * become far too large. `problem` gets why not; what was unpacked by then stays. @return OK, IO,
 * UNSUPPORTED, NO_MEMORY */
se3d_status se3di_unzip(const char *path, const char *folder, bool (*is_wanted)(const char *name),
                        const se3d_allocator *allocator, char *problem, size_t size);

#endif
