/* SPDX-License-Identifier: BSD-3-Clause */
/* Loop constraints of a tree: cut joints, primitives, couplers, drivers that prescribe no
 * coordinate of the tree, equations of users.
 *
 * With y = what each freedom adds on the way out of the articulated bodies (D y = e without loops)
 * the mass matrix is diagonal, and a row of the constraints, carried down the tree, has one number
 * for each freedom between its bodies and the ground:
 *
 *     [D  Y^T] [y     ]   [e ]
 *     [Y  0  ] [lambda] = [c']
 *
 * solved without regularisation where the rows are clear of each other (tree/loop_system.h), else
 * by the KKT solver (linsol/kkt.h): order, regularisation, refinement and multipliers of least norm
 * are its own.                                                  docs/theory/joint_coordinates.md */
#ifndef SE3DI_TREE_LOOPS_H
#define SE3DI_TREE_LOOPS_H

#include "assembly/assembly.h"
#include "linsol/kkt.h"
#include "tree/loop_system.h"
#include "tree/tree.h"

/* How the rows of a loop whose joint points coincide are turned (tree/loop_turns.c). */
typedef struct se3di_loop_turn {
    double Q[9];       /* [u w n]^T, axes of body i; before: sums of products of the rows */
    double size, rest; /* of the rows, in all directions and along n */
    int32_t is_turned, reserved;
} se3di_loop_turn;

/* A loop whose rows come from the links alone (tree/loop_points.c). */
typedef struct se3di_loop_side {
    int32_t node;     /* -1: the ground */
    int32_t place;    /* of the node in the loop's path */
    double arm[3];    /* from P to the point, triad; of the ground: the point */
    double square[9]; /* d square d: what a row along d, triad, gives of the body's mobility */
} se3di_loop_side;

typedef struct se3di_loop_point {
    int32_t is_there;
    int32_t turns_with; /* the node whose triad has the directions, -1: the ground, */
    int32_t has_axes;   /* whose axes they are, all three */
    int32_t reserved;
    double direction[9];
    se3di_loop_side side[2]; /* of bodies i and j */
} se3di_loop_point;

typedef struct se3di_tree_loops {
    se3di_tree *tree;
    se3di_assembly *assembly; /* r-omega, of the same model */
    se3di_kkt *kkt;
    se3di_error *error; /* where failures of callbacks are recorded; NULL: nowhere */
    uint32_t count;     /* loop constraints */
    uint32_t row_count; /* theirs */
    uint32_t *constraints;
    int32_t *rows;         /* of each */
    uint32_t *row_begin;   /* [count + 1] its first among those of the loops */
    int32_t *kept;         /* [rows of the loops]: the rows of each that the tree does not imply */
    int32_t *kept_count;   /* how many of them, */
    int32_t *kept_begin;   /* and of the loops before */
    int32_t *path_begin;   /* [count + 1] into the next two: nodes from its bodies to the ground, */
    int32_t *path_node;    /* descending */
    int32_t *path_parent;  /* place of the node's parent in the same path, -1: the ground */
    int32_t *member_begin; /* [count + 1] freedoms of those nodes that are not prescribed */
    int32_t *member;
    se3di_loop_turn *turns;   /* of each */
    se3di_loop_point *points; /* of each */
    uint32_t *others;         /* constraints whose rows do not come from the links alone */
    uint32_t other_count;
    int32_t is_aside; /* the assembly's rows are not those of the last factors */
    size_t path_count, member_count, value_count, scratch_count;
    double *Y;              /* [values]: rows x 1 for each member */
    double *gamma;          /* [rows of the model] */
    double *lambda;         /* [rows of the model]: of loops, others 0 */
    double *c, *l;          /* [rows of the loops]: of those that are kept */
    double *weight;         /* [rows of the loops]: sizes of C M^-1 C^T of the bodies, which, unlike
                               those of Y D^-1 Y^T, do not vanish at singular positions */
    double *y;              /* [velocities] */
    double *H, *b;          /* [velocities] */
    double *K;              /* rows on the nodes of one path, */
    double *size;           /* and the sizes of their halves before parts cancel */
    double *noise;          /* [velocities]: rounding of a row */
    int32_t *place_of;      /* [nodes]: scratch of the building */
    int32_t is_whole;       /* all rows are kept */
    int32_t is_clear;       /* the last factors are those of `system`, not of `kkt` */
    int32_t leaves_freedom; /* each loop, and all that share freedoms with it, can move: more
                               freedoms than rows, in a loop no fewer */
    se3di_loop_system system;
} se3di_tree_loops;

/* On failure nothing is held; `error` (NULL: none) is kept. The model's frames are used as scratch
 * and come back, the tree is placed there in the end. @return OK, NO_MEMORY */
se3d_status se3di_tree_loops_init(se3di_tree_loops *loops, se3di_tree *tree,
                                  se3di_assembly *assembly, se3di_error *error);
void se3di_tree_loops_destroy(se3di_tree_loops *loops);

/* Freedoms between the bodies of each loop and the ground, of all loops, without building anything.
 * @return OK, NO_MEMORY */
se3d_status se3di_tree_loops_count_members(se3di_tree *tree, se3di_assembly *assembly,
                                           size_t *members);

/* Masses have changed: which sizes of pivots are usual. The model's frames and the tree as above.
 */
void se3di_tree_loops_refresh(se3di_tree_loops *loops);

/* Solve as another solver with these settings does, whatever it has against light bodies. */
void se3di_tree_loops_filter(se3di_tree_loops *loops, const se3di_kkt_settings *settings);

/* Take the accelerations that drivers of tree coordinates prescribe; functions evaluated. */
void se3di_tree_take_given(se3di_tree *tree, const se3di_assembly *assembly);

/* After se3di_tree_factor at the model's frames, functions evaluated: evaluate the rows, carry them
 * down and factor. @return OK, INFO_REDUNDANT, NOT_FINITE, SINGULAR, CALLBACK */
se3d_status se3di_tree_loops_factor(se3di_tree_loops *loops);
/* The same without frames, if they are not needed. @return whether the factors serve; else there
 * are none */
int se3di_tree_loops_factor_links(se3di_tree_loops *loops);
/* Accelerations, and the multipliers of the loops. @return as se3di_kkt_solve */
se3d_status se3di_tree_loops_accelerate(se3di_tree_loops *loops, double *qddot);
/* Rows that were dependent, or are filtered, at the last factorisation. */
int32_t se3di_tree_loops_count_dependent(const se3di_tree_loops *loops);
/* Whether the last factorisation was at, or not far from, a singular position. */
static inline int se3di_tree_loops_is_near(const se3di_tree_loops *loops)
{
    return !loops->is_clear || loops->system.is_near;
}
/* Whether the factors need no frames, and no functions: rows of loops come from the links alone,
 * if they are clear of each other. */
int se3di_tree_loops_need_links_only(const se3di_tree_loops *loops);
/* The tree is refreshed: what of loops is fixed in its links. */
void se3di_tree_loops_take_points(se3di_tree_loops *loops);
/* Add the rows of a strip of such a loop to K [path][6][4], c and weight [4]. */
void se3di_tree_loops_load_point(const se3di_tree_loops *loops, const se3di_loop_strip *strip,
                                 double *K, double *c, double *weight);
/* Evaluate the rows at the model's frames, functions evaluated, and turn them. */
void se3di_tree_loops_eval_rows(se3di_tree_loops *loops);
/* c [rows of the loops that are kept] = -Phi at the model's frames; returns the largest violation
 * relative to its scale, with `length` for lengths. */
double se3di_tree_loops_eval_gap(se3di_tree_loops *loops, double length, double *c);
/* c = nu - Phi_q qdot, rows evaluated; the largest relative to a rate [1/s]. */
double se3di_tree_loops_eval_rate_gap(const se3di_tree_loops *loops, double length, double rate,
                                      double *c);
/* The least change dq [velocities], weighed by the masses, that changes the rows by c; prescribed
 * coordinates stay. By the last factorisation. @return as se3di_kkt_solve */
se3d_status se3di_tree_loops_correct(se3di_tree_loops *loops, const double *c, double *dq);
/* Add what the loops do with `lambda` [rows of the model] to wrenches [nodes * 6] about P; the
 * model's frames are where the last factors were made. driven: only to driven nodes. */
void se3di_tree_loops_add_wrenches(se3di_tree_loops *loops, const double *lambda, int driven,
                                   double *wrench);
/* Add a row of a loop, rows evaluated, to the Jacobian's [velocities]. */
void se3di_tree_loops_row(const se3di_tree_loops *loops, uint32_t loop, size_t row, double *G);
/* Turned rows, at the model's frames: the sums of products of a loop's plain rows in one pose more,
 * or (looks) what is left along n; n from the sums of all poses, 0: there is none; whether it is
 * to be taken. Then three numbers of the rows, to turned ones and back; all rows, as evaluated. */
void se3di_tree_loops_watch_turn(se3di_tree_loops *loops, uint32_t loop, int looks);
/* The first three rows of a loop are those of two points that coincide, at all times. */
int se3di_tree_loops_is_point(const se3di_tree_loops *loops, uint32_t loop);
int se3di_tree_loops_foresee_turn(se3di_tree_loops *loops, uint32_t loop);
void se3di_tree_loops_decide_turn(se3di_tree_loops *loops, uint32_t loop);
void se3di_tree_loops_turn(const se3di_tree_loops *loops, uint32_t loop, double x[3],
                           size_t stride);
void se3di_tree_loops_turn_back(const se3di_tree_loops *loops, uint32_t loop, double x[3]);
void se3di_tree_loops_turn_rows(const se3di_tree_loops *loops, int others_only);
/* Find the rows that the tree does not imply (tree/loop_rows.c). */
void se3di_tree_loops_keep_rows(se3di_tree_loops *loops);
/* Whether they leave a freedom. @return OK, NO_MEMORY */
se3d_status se3di_tree_loops_count_freedoms(se3di_tree_loops *loops);
/* Rows as evaluated into the strips of `system`. */
void se3di_tree_loops_carry(se3di_tree_loops *loops);
/* The points of loops are known: those whose rows are carried side by side (tree/loop_teams.c). */
void se3di_tree_loops_find_teams(se3di_tree_loops *loops);
/* The rows of the `index`-th team into their strips. @return 0: not now, a coordinate on the way is
 * prescribed */
int se3di_tree_loops_carry_team(const se3di_tree_loops *loops, int32_t index);
/* The path of a strip's loop. */
static inline se3di_loop_path se3di_loop_path_of(const se3di_tree_loops *loops,
                                                 const se3di_loop_strip *strip)
{
    const int32_t begin = loops->path_begin[strip->loop];
    return (se3di_loop_path){.count = loops->path_begin[strip->loop + 1] - begin,
                             .node = loops->path_node + begin,
                             .parent = loops->path_parent + begin};
}
/* G [rows of the loops x velocities], row-major: the Jacobian to the velocities of the tree. */
void se3di_tree_loops_jacobian(const se3di_tree_loops *loops, double *G);

#endif
