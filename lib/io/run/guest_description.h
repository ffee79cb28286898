/* SPDX-License-Identifier: BSD-3-Clause */
/* What a run needs of the modelDescription.xml of a unit. */
#ifndef SE3D_IO_RUN_GUEST_DESCRIPTION_H
#define SE3D_IO_RUN_GUEST_DESCRIPTION_H

#include "io/base/pool.h"

typedef struct se3di_guest_variable {
    const char *name;
    const char *causality;
    const char *type; /* "Real", "Float64", ..., or "array" */
    uint32_t reference;
} se3di_guest_variable;

typedef struct se3di_guest_description {
    int version; /* 2 or 3 */
    const char *token;
    const char *identifier; /* for co-simulation; NULL: the unit is for something else */
    bool is_single;         /* a process can have one instance */
    bool has_states;        /* that can be had, set and written as bytes */
    se3di_guest_variable *variables;
    size_t count, capacity;
} se3di_guest_description;

/* Read a description into memory of the pool. `problem` gets why not. @return OK, IO, UNSUPPORTED,
 * NO_MEMORY. */
se3d_status se3di_guest_describe(const char *path, se3di_iopool *pool,
                                 se3di_guest_description *description, char *problem, size_t size);

#endif
