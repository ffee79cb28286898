/* SPDX-License-Identifier: BSD-3-Clause */
/* A machine as a model file. */
#ifndef SE3D_IO_IMPORT_YAML_H
#define SE3D_IO_IMPORT_YAML_H

#include "io/import/machine.h"

/* Write the model file into memory of the pool. @return OK, NO_MEMORY. */
se3d_status se3di_machine_write(se3di_machine *m, const char **text, size_t *length);

#endif
