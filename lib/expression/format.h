/* SPDX-License-Identifier: BSD-3-Clause */
/* Bytecode as text: what is compiled from it is the same bytecode. */
#ifndef SE3DI_EXPRESSION_FORMAT_H
#define SE3DI_EXPRESSION_FORMAT_H

#include "expression/program.h"

/* Write a checked program with these names of its variables. At most `capacity` bytes are written,
 * the last one 0; *length is what all of it has. @return OK, NO_MEMORY. */
se3d_status se3di_program_format(const se3d_allocator *allocator, const se3di_instruction *code,
                                 size_t count, const char *const *names, char *text,
                                 size_t capacity, size_t *length);

#endif
