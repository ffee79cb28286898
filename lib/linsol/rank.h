/* SPDX-License-Identifier: BSD-3-Clause */
/* Rank-revealing analysis of a constraint Jacobian: which equations are redundant, of which others
 * each is a combination, and which freedoms are left.
 *
 * The rank is that of a QR factorisation of C^T with column pivoting. Rows are then
 * taken in order: a row is redundant if it depends on rows before it, so that it is the later
 * duplicate of an earlier equation that is named.                            docs/theory/kkt.md */
#ifndef SE3DI_LINSOL_RANK_H
#define SE3DI_LINSOL_RANK_H

#include "base/alloc.h"

typedef struct se3di_rank {
    int32_t row_count, column_count;
    int32_t rank;
    int32_t redundant_count;    /* row_count - rank */
    int32_t freedom_count;      /* column_count - rank */
    int32_t *independent;       /* [rank] rows, ascending */
    int32_t *redundant;         /* [redundant_count] rows, ascending */
    int32_t *combination_begin; /* [redundant_count + 1] into the next two */
    int32_t *combination_row;   /* independent rows before the redundant one ... */
    double *combination;        /* ... and their factors: C_redundant = sum of factor C_row */
    double *freedom;          /* [freedom_count x column_count], row-major, orthonormal: C v = 0 */
    double gap_low, gap_high; /* smallest accepted and largest rejected diagonal of R, relative */
    size_t combination_capacity;
} se3di_rank;

/* Analyse C[rows x columns] (row-major; rows and columns scaled by the caller, e.g. C H^-1/2).
 * Rows are dependent below `tolerance` relative to their length; a zero row is redundant with an
 * empty combination. On failure *result is empty.
 * @return SE3D_OK, SE3D_INFO_REDUNDANT, SE3D_ERR_NO_MEMORY, SE3D_ERR_NOT_FINITE */
se3d_status se3di_rank_analyse(const se3d_allocator *allocator, int32_t rows, int32_t columns,
                               const double *C, double tolerance, se3di_rank *result);
void se3di_rank_destroy(const se3d_allocator *allocator, se3di_rank *result);

/* A D P = Q R, with columns of unit length that are taken in the order of P. */
typedef struct se3di_pivoted_qr {
    double *A;     /* columns x rows, column-major: R, and the reflectors below it */
    double *tau;   /* [min] */
    double *work;  /* [2 rows] */
    double *scale; /* [rows]: D, 1 / length of each column */
    int32_t *pivot;
    size_t rows, columns; /* of its transpose */
} se3di_pivoted_qr;

/* A matrix that is factored for solutions of least norm. */
typedef struct se3di_least_norm {
    se3di_pivoted_qr qr;
    double *T, *tau; /* the first rank rows of R P^T D^-1, transposed and factored; NULL: full rank,
                      * the solution is unique */
    int32_t rank, reserved;
} se3di_least_norm;

/* Factor A[rows x columns], column-major. Columns are dependent below `tolerance` after scaling to
 * unit length. On failure *f is empty. @return SE3D_OK, SE3D_ERR_NO_MEMORY, SE3D_ERR_NOT_FINITE */
se3d_status se3di_least_norm_factor(const se3d_allocator *allocator, int32_t rows, int32_t columns,
                                    const double *A, double tolerance, se3di_least_norm *f);
/* The least-norm solution l[columns] of A l = g in the least-squares sense, g[rows] (destroyed);
 * the norm is that of the unscaled l. */
void se3di_least_norm_solve(const se3di_least_norm *f, double *g, double *l);
void se3di_least_norm_destroy(const se3d_allocator *allocator, se3di_least_norm *f);

/* Both in one, with A untouched; *rank may be NULL. @return as se3di_least_norm_factor */
se3d_status se3di_rank_least_norm(const se3d_allocator *allocator, int32_t rows, int32_t columns,
                                  double *A, double *g, double tolerance, double *l, int32_t *rank);

#endif
