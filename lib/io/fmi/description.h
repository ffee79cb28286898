/* SPDX-License-Identifier: BSD-3-Clause */
/* modelDescription.xml of a mock-up unit. */
#ifndef SE3D_IO_FMI_DESCRIPTION_H
#define SE3D_IO_FMI_DESCRIPTION_H

#include "io/fmi/variables.h"

enum { SE3DI_FMI_IDENTIFIER_SIZE = 100 };

typedef struct se3di_fmi_description {
    const se3d_model *model;
    const se3di_fmi_variables *variables;
    int version; /* of the standard: 2 or 3 */
    char identifier[SE3DI_FMI_IDENTIFIER_SIZE];
} se3di_fmi_description;

/* An identifier of C for the files of the unit, made from the name of the model. */
void se3di_fmi_make_identifier(const char *name, char identifier[SE3DI_FMI_IDENTIFIER_SIZE]);
/* The description as a text in memory of the pool: *size bytes and a zero at the end.
 * @return NULL: no memory. */
char *se3di_fmi_description_write(const se3di_fmi_description *description, se3di_iopool *pool,
                                  size_t *size);

#endif
