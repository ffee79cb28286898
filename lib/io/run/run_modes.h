/* SPDX-License-Identifier: BSD-3-Clause */
/* The files that an analysis of type modes writes. */
#ifndef SE3D_IO_RUN_MODES_H
#define SE3D_IO_RUN_MODES_H

#include "io/model/model.h"

enum { SE3DI_MODES_FILES_MAX = 6 };

typedef struct se3di_modes_run {
    const se3d_model *model;
    const se3di_modes_entry *entry;
    const char *folder;
    const struct se3di_watch *watch; /* gets the modes in place of files; NULL: there are files */
    se3di_iopool *pool;
    se3d_run_file files[SE3DI_MODES_FILES_MAX]; /* written */
    size_t file_count;
    char problem[900]; /* why a file could not be written; "" if the system knows why */
} se3di_modes_run;

/* Linearise at the present state and write eigenvalues and shapes, with inputs or outputs also the
 * matrices A, B, C, D, with frequencies the transfer functions. */
se3d_status se3di_modes_run_write(se3di_modes_run *run);

#endif
