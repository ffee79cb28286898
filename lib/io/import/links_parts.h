/* SPDX-License-Identifier: BSD-3-Clause */
/* What the parts of links*.c share. */
#ifndef SE3D_IO_IMPORT_LINKS_PARTS_H
#define SE3D_IO_IMPORT_LINKS_PARTS_H

#include "io/import/links.h"

/* The link that holds the mass of the group. */
size_t se3di_links_leader(const se3di_links *links, size_t link);
void se3di_links_merge(se3di_links *links);
bool se3di_links_emit_joints(se3di_links *links);

#endif
