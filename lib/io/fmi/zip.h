/* SPDX-License-Identifier: BSD-3-Clause */
/* A zip archive whose files are stored as they are: the same files make the same bytes. */
#ifndef SE3D_IO_FMI_ZIP_H
#define SE3D_IO_FMI_ZIP_H

#include <stdio.h>

#include "io/base/pool.h"

typedef struct se3di_zip {
    FILE *file;
    se3di_iopool *pool;
    struct se3di_zip_entry *entries;
    size_t count, capacity;
    uint64_t written;
    const char *problem; /* the first, NULL if none */
} se3di_zip;

/* Begin an archive in a file that is open. */
se3di_zip se3di_zip_begin(FILE *file, se3di_iopool *pool);
/* Add a file; `name` with slashes, UTF-8. */
void se3di_zip_add(se3di_zip *zip, const char *name, const void *bytes, size_t size);
/* The list at the end. @return NULL, or why the archive is not whole. */
const char *se3di_zip_end(se3di_zip *zip);

#endif
