/* SPDX-License-Identifier: BSD-3-Clause */
/* The analysis of a model's constraints: rank, redundant equations with the ones they depend on,
 * contradictions, bodies that nothing holds. docs/theory/redundancy.md */
#ifndef SE3DI_CHECK_H
#define SE3DI_CHECK_H

#include "nonlinear/equations.h"

typedef struct se3di_check {
    se3d_allocator allocator;
    size_t bodies;       /* that move */
    size_t equations;    /* without normalisation */
    size_t rank;         /* independent equations */
    size_t inconsistent; /* equations that contradict those they depend on */
    char **messages;     /* one sentence each */
    size_t message_count, message_capacity;
} se3di_check;

/* Analyse the constraints of `model` at its time. If the poses do not fit, they are assembled
 * first (or brought to the least violation); the model is left as it was. On failure nothing is
 * held. @return OK, INFO_REDUNDANT, NO_MEMORY, NOT_FINITE, CALLBACK */
se3d_status se3di_check_init(se3di_check *check, se3di_model *model, se3di_error *error);
void se3di_check_destroy(se3di_check *check);

#endif
