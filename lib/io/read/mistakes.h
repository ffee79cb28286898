/* SPDX-License-Identifier: BSD-3-Clause */
/* All mistakes of a model in one reading: what is wrong is taken out of the tree, and a model that
 * nobody gets is read from the rest. */
#ifndef SE3D_IO_MISTAKES_H
#define SE3D_IO_MISTAKES_H

#include "io/document/recovery.h"
#include "io/model/model.h"

#include "io/read/include.h"

typedef struct se3di_attempt {
    se3d_model *model; /* with its file, name and root */
    const se3d_model_options *options;
    se3d_model_error *error;   /* not NULL; of the first mistake */
    se3di_library *library;    /* files that were included */
    se3di_fault fault;         /* what it is about */
    size_t attached;           /* bytes of other files that were read */
    const se3di_named *values; /* [value_count] in place of parameters; NULL: none */
    size_t value_count;
    const struct se3di_study_entry *study; /* that it is a sample of; NULL: none */
    bool warns;                            /* of what is probably a mistake, to the log */
} se3di_attempt;

/* load.c: an empty model with its own memory (NULL: out of memory), and a model from its root. */
se3d_model *se3di_model_create(const se3d_allocator *allocator);
se3d_status se3di_model_fill(se3di_attempt *attempt);

/* Report the failure before there was a tree. */
void se3di_mistakes_report_one(const se3di_attempt *attempt, se3d_status status);
/* Report the mistake that ended the attempt, and those behind it. The tree is spoilt then. `length`
 * of the text in bytes bounds the work. */
void se3di_mistakes_report_all(se3di_attempt *attempt, size_t length);

#endif
