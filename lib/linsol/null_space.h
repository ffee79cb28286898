/* SPDX-License-Identifier: BSD-3-Clause */
/* A basis of the null space of a block-sparse constraint Jacobian, six unknowns a body.
 *
 * Joint after joint, freedoms that a joint would break are combined to ones that it leaves: of the
 * freedoms that take part in a row, one is given up and the others take as much of it as keeps the
 * row at zero. Pivots are among the largest of what a joint has left, and of those with the fewest
 * bodies, so that along a chain or tree only the six freedoms of the next body are worked on.
 * docs/theory/equilibrium.md */
#ifndef SE3DI_LINSOL_NULL_SPACE_H
#define SE3DI_LINSOL_NULL_SPACE_H

#include "base/alloc.h"

typedef struct se3di_null_space_pattern {
    size_t body_count;
    size_t joint_count;
    const int32_t *joint_rows;
    const int32_t *joint_begin; /* [joint_count + 1] into the next two */
    const int32_t *joint_body;  /* none twice in a joint */
    const size_t *block_offset; /* of each block, rows x 6, in C */
} se3di_null_space_pattern;

/* A basis Z [freedoms x 6 bodies], row-major, rows of unit length, C Z^T = 0; to be freed by the
 * caller with that size, NULL if freedoms = 0. Rows of C that the freedoms left meet within
 * `tolerance` of their length are dependent; their number is returned in *dependent.
 * `rest` [rows of all joints in turn] or NULL: by how much a dependent row depends, its largest
 * part on the freedoms left relative to its length; -1: the row is independent.
 * @return OK, NO_MEMORY, NOT_FINITE */
se3d_status se3di_null_space_find(const se3d_allocator *allocator,
                                  const se3di_null_space_pattern *pattern, const double *C,
                                  double tolerance, double **Z, int32_t *freedoms,
                                  int32_t *dependent, double *rest);

/* Make the rows of Z [freedoms x n] orthonormal, of the same span. @return OK, NO_MEMORY */
se3d_status se3di_null_space_orthonormalise(const se3d_allocator *allocator, int32_t freedoms,
                                            int32_t n, double *Z);

#endif
