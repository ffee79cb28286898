/* SPDX-License-Identifier: BSD-3-Clause */
/* The equations of loops on a tree where the rows are clear of each other: no regularisation, no
 * refinement but one where pivots are small. With D and Y of tree/loops.h,
 *
 *     S lambda = Y D^-1 e - c',    S = Y D^-1 Y^T = L D L^T by blocks,    D y = e - Y^T lambda
 *
 * Rows of a loop stand in strips of up to four. A freedom that many closed loops only pass, such as
 * those of a vehicle's frame, would couple all of them: it is not eliminated but stands last, as an
 * unknown of its own, with S less its part:
 *
 *     [S  -Y^T] [lambda]   [Y D^-1 e - c']
 *     [-Y  -D ] [y     ] = [-e           ]
 *                                                              docs/theory/joint_coordinates.md */
#ifndef SE3DI_TREE_LOOP_SYSTEM_H
#define SE3DI_TREE_LOOP_SYSTEM_H

#include "tree/tree.h"

#define SE3DI_STRIP 4 /* lanes */

/* The nodes between the bodies of a loop and the ground, descending, the place of each parent among
 * them (-1: the ground). */
typedef struct se3di_loop_path {
    int32_t count, reserved;
    const int32_t *node, *parent;
} se3di_loop_path;

/* Up to four rows of a loop, or freedoms of a node. */
typedef struct se3di_loop_strip {
    int32_t loop;  /* -1: of freedoms */
    int32_t first; /* among the rows of the loop that are kept, or velocity */
    int32_t count;
    int32_t Y; /* quads: where the numbers of its members begin */
} se3di_loop_strip;

/* What makes a block of S: Y[a] (Y[b] R[v])^T of two strips; v = -1: -Y^T of `b` freedoms from
 * Y[a]. */
typedef struct se3di_loop_product {
    int32_t a, b, v;
} se3di_loop_product;

typedef struct se3di_loop_system {
    int32_t is_there;    /* it was made */
    int32_t strip_count; /* in the order of elimination, */
    int32_t row_strips;  /* first those of rows */
    int32_t is_fine;     /* not 0: the factors serve, */
    int32_t is_refined;  /* and solutions are refined once */
    int32_t is_near;     /* some pivot is much smaller than usual */
    int32_t width;       /* the most rows or freedoms of a strip */
    int32_t is_dull;     /* some row has next to nothing at every pose */
    se3di_loop_strip *strips;
    const int32_t *member_begin, *member; /* of loops: velocities, see tree/loops.h */
    int8_t *is_passed;                    /* [velocities]: not eliminated */
    int32_t *column_begin; /* [strips + 1] entries of L: the diagonal block, then below, */
    int32_t *column_row;   /* ascending */
    int32_t *row_begin; /* [strips + 1] into the next: the entries of a row before the diagonal */
    int32_t *row_entry, *row_column;
    int32_t *product_begin; /* [entries + 1] */
    se3di_loop_product *products;
    int32_t *where;   /* [strips]: scratch */
    int32_t *carried; /* [row_strips]: their order on the way down, first by teams of four */
    int32_t team_count, reserved;
    size_t entry_count, product_count, quad_count, velocity_count;
    double *X;            /* [entries][4][4]: columns of L D; of diagonal blocks L */
    double *pivot;        /* [strips][4]: inverse pivots */
    double *weight;       /* [strips][4]: sizes of rows, as in tree/loops.h */
    double *usual;        /* [strips][4]: pivots over weights at poses that nothing singles out */
    double *least;        /* [strips][4]: the same that pivots must be beyond, */
    double *bound;        /* [strips][4]: and pivots */
    double *Y;            /* [quads][4] */
    double *c, *z, *rest; /* [strips][4] */
    const struct se3di_loop_core *core;
} se3di_loop_system;

struct se3di_tree_loops;

/* For loops whose rows that are kept are known, and their paths and members. Nothing is there
 * without loops, or where too many of them pass the same freedoms; on failure nothing is held.
 * @return OK, NO_MEMORY */
se3d_status se3di_loop_system_init(se3di_loop_system *system, const struct se3di_tree_loops *loops);
void se3di_loop_system_destroy(se3di_loop_system *system, const se3d_allocator *allocator);

/* Whether the rows were clear of each other at some of these poses. */
int se3di_loop_system_is_regular(const se3di_loop_system *system);
/* Of factors, a solution and the rows on the way, in operations on four numbers. */
double se3di_loop_system_cost(const se3di_loop_system *system);
/* The same at least, of loops with so many members. */
double se3di_loop_system_least_cost(size_t members);

/* With Y, c and weight: factors. @return whether they serve */
int se3di_loop_system_factor(se3di_loop_system *system, const se3di_tree *tree);
/* lambda into z [strips][4] for e and c; e becomes what is added to the freedoms, D y. */
void se3di_loop_system_solve(se3di_loop_system *system, const se3di_tree *tree, double *e);
/* With Y and weight of a pose that nothing singles out: clear pivots are not much smaller than
 * here, or at the others since `forget`. Nothing serves before. */
void se3di_loop_system_forget(se3di_loop_system *system);
void se3di_loop_system_learn(se3di_loop_system *system, const se3di_tree *tree);

#endif
