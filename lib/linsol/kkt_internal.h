/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT solver's own data, shared by its files.
 *
 * Nodes are bodies and joints; a joint of more than 8 rows is cut into nodes of up to 8. A node of
 * size s, at position k of the elimination order, owns a panel of blocks of s rows and 8 columns
 * (the unused ones are zero): its diagonal block, then one block for each neighbour that is
 * eliminated later. `upper` holds A_kj, `lower` (unsymmetric mode) the transpose of A_jk. */
#ifndef SE3DI_LINSOL_KKT_INTERNAL_H
#define SE3DI_LINSOL_KKT_INTERNAL_H

#include "base/error.h"
#include "linsol/kkt.h"

#define KKT_LANES 8 /* columns of every block in the solver's own storage */

/* A dependent row's pivot is E / n^2, n the row's entry in the unit vector of the dependence; below
 * this multiple of E a pivot is taken to have vanished. */
#define KKT_VANISHED 1e4
/* Of dependent rows it is some 30 to 100 E; one above this multiple is of its own size. */
#define KKT_CLEARLY_DEPENDENT 300.0
/* Relative pivots of rows that are not even nearly dependent. */
#define KKT_FAR_FROM_DEPENDENT 1e-3

/* E of a row is that of all, unless the row's weight is further away than this. */
#define SE3DI_KKT_WEIGHT_RANGE 1e4
/* The largest weight over pivot of rows of which no pivot is small; of a wide filter. */
#define KKT_NONE_SMALL      1e6
#define KKT_NONE_SMALL_WIDE (1.0 / KKT_FAR_FROM_DEPENDENT)

/* Arrays of the caller's values. */
enum {
    KKT_BASE_BODY = 0,
    KKT_BASE_COUPLING_UPPER = 1,
    KKT_BASE_COUPLING_LOWER = 2,
    KKT_BASE_JOINT = 3,
    KKT_BASE_JOINT_B = 4,
    KKT_BASE_COUNT = 5
};

/* A block from the caller, of `rows` rows and body_size columns, to copy. */
typedef struct se3di_kkt_source {
    int32_t base;
    int32_t rows;
    bool lower;     /* into `lower` */
    bool is_turned; /* the transpose */
    size_t source, dest;
} se3di_kkt_source;

typedef struct se3di_kkt_core {
    /* Gather the values and eliminate all nodes; if a right-hand side is expected, also the
     * forward half of its solution, in kkt->z. */
    void (*factor)(se3di_kkt *kkt, const se3di_kkt_values *values);
    /* Overwrite the right-hand side in kkt->z by the solution (of an expected one: the second
     * half).
     */
    void (*solve)(se3di_kkt *kkt);
    /* residual_b = b - H x - B l, residual_c = c - C x, kkt->scale_b and scale_c. */
    void (*residual)(se3di_kkt *kkt, const se3di_kkt_values *values, const double *b,
                     const double *c, const double *x, const double *l);
    /* mobility and kkt->weight = diag(C H^-1 B) with the diagonal of H only. */
    void (*weigh)(se3di_kkt *kkt, const se3di_kkt_values *values);
} se3di_kkt_core;

/* Whether body blocks and weights are those of the factorisation before, see se3di_kkt_hold. */
typedef enum kkt_hold { KKT_FREE = 0, KKT_HOLD_NEXT = 1, KKT_HELD = 2 } kkt_hold;

typedef struct se3di_kkt_block_list {
    void *memory;
    size_t count, size;
} se3di_kkt_block_list;

#define KKT_MAX_ARRAYS 64

/* Also what solvers of one pattern share: then all but the numbers is there. */
struct se3di_kkt {
    se3d_allocator allocator;
    struct se3di_kkt_structure *structure;       /* of which arrays are used; NULL: this is it */
    se3di_kkt_block_list arrays[KKT_MAX_ARRAYS]; /* its own */
    size_t array_count;
    bool out_of_memory;

    se3di_kkt_pattern pattern; /* arrays are copies */
    se3di_kkt_kind kind;
    se3di_kkt_level level;
    const se3di_kkt_core *core;
    se3di_kkt_layout layout;
    se3di_kkt_settings settings;
    int32_t *row_offset;
    size_t *block_offset;
    bool has_loop;
    bool has_unbound;     /* a joint without bodies */
    bool has_zero_weight; /* of a row of a joint with bodies */
    double cost;

    /* graph: nodes 0 .. body_count - 1 are bodies, the others pieces of joints */
    int32_t node_count;
    int32_t *node_size;
    int32_t *node_joint;  /* -1 for a body */
    int32_t *node_row;    /* first row in the joint */
    int32_t *graph_begin; /* [node_count + 1] */
    int32_t *graph;       /* neighbours */
    int32_t *joint_node;  /* [joint_count + 1]: first node of each joint */

    /* elimination order */
    int32_t *node_at;      /* position -> node */
    int32_t *position_of;  /* node -> position */
    int32_t *size_at;      /* position -> size */
    int32_t *row_at;       /* position -> first row of a joint's node, -1 for a body */
    bool *is_untouched_at; /* position -> a body whose block no elimination before it changes */
    bool *is_full_at;      /* position -> every block of its panel has a source */
    int32_t *near_begin;   /* [node_count + 1] into near */
    int32_t *near;         /* positions > k, ascending */
    size_t *panel;         /* [node_count + 1]: offset of each panel */
    size_t *update_begin;  /* [node_count + 1] into update */
    size_t *update;        /* offset of the block (a, b), a <= b, of each node */
    int32_t *load_begin;   /* [node_count + 1] into load */
    int32_t *load;         /* positions to gather before position k is eliminated */
    int32_t *source_begin; /* [node_count + 1] into source */
    se3di_kkt_source *source;
    int32_t max_degree;

    /* numbers, aligned to 64 bytes */
    double *upper, *lower;
    double *scaled;    /* work: scaled panel of one node */
    double *inverse_d; /* [8 node_count] */
    double *shift;     /* [8 body_count]: sigma p of blocks of size 8 */
    double *z;         /* [8 node_count] */
    int8_t *pivot;     /* [8 node_count]: row order, unsymmetric mode */
    double *mobility;  /* [8 body_count]: 1 / H_cc */
    double *weight;    /* [row_count]: diag(C H^-1 B) */
    double *raised;    /* [body_count * n * n]: H of kkt_raise.c */
    double *raise;     /* [body_count]: over that of the caller */
    double *e;         /* [row_count]: E of the last factorisation */
    double *residual_b, *residual_c, *correction_x, *correction_l;
    double *saved_l, *saved_x; /* multipliers of rows and of normalisations */
    double *magnitude;         /* [unknown_count]: work of the residual */
    double scale_b, scale_c;
    double *ratio; /* [row_count]: if some pivot is small, each relative to its weight */
    double
        ratio_bound; /* pivots of dependent rows are below this multiple of `ratio`; 0: unknown */
    kkt_hold hold;
    const double *expected;   /* not NULL: factoring also does the forward half for this b, */
    const double *expected_c; /* and this c */
    bool has_ratio;           /* `ratio` is of the last factorisation */
    bool bodies_first; /* no body is changed by eliminating joints: S = C H^-1 C^T is factored */

    /* outcome of a factorisation */
    double eps, middle; /* of the last factorisation: E = eps middle, nearly */
    int32_t factorisations;
    double min_pivot;   /* relative, with E */
    double min_sigma;   /* smallest relative pivot without E above 1e-13 */
    double least_clear; /* smallest relative pivot that is not clearly a dependent row's */
    int32_t dependent_rows, near_dependent, negative_pivots, positive_rows;
    int32_t far_rows; /* with a pivot of KKT_FAR_FROM_DEPENDENT at least; with small pivots only */
    double least_far; /* the smallest of these */
    bool finite;
    bool is_raised; /* H is `raised` */

    /* dense kind */
    double *dense; /* N x N row-major */
    double *dense_work;
    int32_t *dense_pivot;
    double *rank_matrix, *rank_tau, *rank_work;
    int32_t *rank_pivot;
};

/* What follows from a pattern: the same for every solver of it, and never changed. */
typedef struct se3di_kkt_structure {
    se3di_shelf_item item;
    se3di_kkt kkt;
} se3di_kkt_structure;

/* Zeroed array that se3di_kkt_destroy frees; on failure kkt->out_of_memory is set. */
void *se3di_kkt_take(se3di_kkt *kkt, size_t count, size_t size);
/* The same, aligned to 64 bytes. */
double *se3di_kkt_take_aligned(se3di_kkt *kkt, size_t count);

/* The fill-in of an order: near[begin[k] .. begin[k + 1]) are the positions, ascending, that are
 * coupled to position k when it is eliminated; parent[] is the elimination tree (-1: root). */
typedef struct se3di_kkt_fill {
    int32_t *begin;  /* [node_count + 1] */
    int32_t *near;   /* [capacity], used up to begin[node_count] */
    int32_t *parent; /* [node_count] */
    size_t capacity;
    double cost;
} se3di_kkt_fill;

/* kkt_fill.c */
se3d_status se3di_kkt_fill_create(const se3di_kkt *kkt, const int32_t *node_at,
                                  se3di_kkt_fill *fill);
void se3di_kkt_fill_destroy(const se3di_kkt *kkt, se3di_kkt_fill *fill);
/* Estimated vector operations of eliminating a node of `size` with neighbours of these sizes;
 * `free` if it is a body whose block is still the mass block of SE3DI_KKT_BODY_MASS. */
double se3di_kkt_node_cost(int32_t size, const int32_t *near_size, int32_t degree, bool is_mass);

/* kkt_order.c: choose the elimination order, into kkt->node_at. */
se3d_status se3di_kkt_order_choose(se3di_kkt *kkt);
/* kkt_greedy.c: an order of least local cost that never makes a joint redundant for a time. */
se3d_status se3di_kkt_greedy_order(const se3di_kkt *kkt, int32_t *node_at);

/* kkt_symbolic.c: everything that follows from the order. */
se3d_status se3di_kkt_symbolic_build(se3di_kkt *kkt);
/* Room for the numbers of such a structure. */
se3d_status se3di_kkt_symbolic_take(se3di_kkt *kkt);
/* Give back all of its own arrays. */
void se3di_kkt_give_back(se3di_kkt *kkt);

/* What pivots say of the solutions: E / w, the least relative pivot, that which is not clearly a
 * dependent row's, rows that are dependent or nearly so, negative ones of bodies. */
typedef struct se3di_kkt_pivots {
    double eps, least, least_clear;
    int32_t dependent, negative;
} se3di_kkt_pivots;

/* kkt_solve.c: E / w that a factorisation begins with, below 0 if a wide one is tried before, */
double se3di_kkt_first_eps(const se3di_kkt *kkt);
/* and how many refinements a solution takes, -1: the residual tells. */
int32_t se3di_kkt_count_refinements(const se3di_kkt *kkt, const se3di_kkt_pivots *pivots);

/* kkt_dense.c */
se3d_status se3di_kkt_dense_create(se3di_kkt *kkt);
void se3di_kkt_dense_factor(se3di_kkt *kkt, const se3di_kkt_values *values);
void se3di_kkt_dense_solve(se3di_kkt *kkt, const double *b, const double *c, double *x, double *l);

/* kkt_raise.c: whether some bodies are far lighter than others. */
bool se3di_kkt_has_light(const se3di_kkt *kkt);
/* What is to be factored in place of the values; false if that is no other. The
 * mobilities are those of the values. */
bool se3di_kkt_raise(se3di_kkt *kkt, const se3di_kkt_values *values, se3di_kkt_values *raised);

/* The kernels of each level, NULL if the compiler cannot make them. */
const se3di_kkt_core *se3di_kkt_core_portable(void);
const se3di_kkt_core *se3di_kkt_core_avx2(void);
const se3di_kkt_core *se3di_kkt_core_avx512(void);

#endif
