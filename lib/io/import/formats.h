/* SPDX-License-Identifier: BSD-3-Clause */
/* The formats that are imported: each fills a machine from a text. @return false: the machine has
 * failed, with a message. */
#ifndef SE3D_IO_IMPORT_FORMATS_H
#define SE3D_IO_IMPORT_FORMATS_H

#include "io/document/document.h"
#include "io/import/machine.h"
#include "io/import/xml.h"

bool se3di_import_urdf(se3di_machine *m, se3di_xml *root);
bool se3di_import_sdf(se3di_machine *m, se3di_xml *root);
/* The tree is changed: files that it includes are put into it. */
bool se3di_import_mjcf(se3di_machine *m, se3di_xml *root);
bool se3di_import_chrono(se3di_machine *m, const se3di_node *root);
bool se3di_import_is_chrono(const se3di_node *root);
bool se3di_import_me751(se3di_machine *m, const se3di_node *root);
bool se3di_import_is_me751(const se3di_node *root);
bool se3di_import_adams(se3di_machine *m, const char *text, size_t length);

/* Another file that a file names: its text, and what a document in it says. */
bool se3di_import_read(se3di_machine *m, const char *path, char **text, size_t *length);
bool se3di_import_document(se3di_machine *m, const char *path, se3di_node **root);

#endif
