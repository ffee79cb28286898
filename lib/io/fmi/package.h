/* SPDX-License-Identifier: BSD-3-Clause */
/* A mock-up unit as a file: description, shared object, and the files of the model. */
#ifndef SE3D_IO_FMI_PACKAGE_H
#define SE3D_IO_FMI_PACKAGE_H

#include <stdio.h>

#include "io/fmi/variables.h"
#include "se3d/io.h"

typedef struct se3di_fmi_package {
    se3d_model *model;                  /* read from `path` with `options` */
    const char *path;                   /* of the model file */
    const se3d_model_options *options;  /* its texts are kept in the unit */
    const char *object;                 /* path of the shared object */
    const char *target;                 /* path of the archive, for messages */
    int version;                        /* of the standard: 2 or 3 */
    size_t inputs, parameters, outputs; /* how many there are; filled */
    size_t states;                      /* of model exchange; filled. 0: none, as `reason` says */
    char reason[SE3DI_FMI_REASON_SIZE];
} se3di_fmi_package;

/* Write the archive to a file that is open for writing.
 * @return OK, UNSUPPORTED (the model cannot be a unit), IO, NO_MEMORY, with `error` filled. */
se3d_status se3di_fmi_package_write(se3di_fmi_package *package, FILE *file,
                                    se3d_model_error *error);

#endif
