/* SPDX-License-Identifier: BSD-3-Clause */
/* The KKT solver: bodies and joints as one block-sparse system.
 *
 *     [ H   B ] [x]   [b]
 *     [ C   0 ] [l] = [c]
 *
 * H holds an n x n block per body and, if stiff elements couple bodies, blocks H_ij and H_ji;
 * C holds an m x n block per joint and free body of it; B = C^T in symmetric mode. Redundant rows
 * of C are allowed: x is exact all the same and l is the solution of least 2-norm.
 *
 * The system is factored as [H B; C -E] with E = eps w I, w the size of diag(C H^-1 B), which is
 * quasi-definite, so that the order of elimination is chosen once for cost alone; refinement
 * against the unregularised system removes E from the answer. E = 0 if the graph has no loop.
 *
 * Everything is allocated by se3di_kkt_create; factor and solve allocate nothing. One kkt object is
 * used by one thread at a time; what follows from the pattern alone is made once and shared by all
 * that have the same one.                                              docs/theory/kkt.md */
#ifndef SE3DI_LINSOL_KKT_H
#define SE3DI_LINSOL_KKT_H

#include <stdbool.h>

#include "base/alloc.h"
#include "base/shelf.h"

/* Limits of a pattern. */
#define SE3DI_KKT_MAX_BODY_SIZE  8
#define SE3DI_KKT_MAX_JOINT_ROWS 64

typedef enum se3di_kkt_kind {
    SE3DI_KKT_DENSE = 0,     /* the reference: one dense LU */
    SE3DI_KKT_STRUCTURED = 1 /* block elimination along the body-joint graph */
} se3di_kkt_kind;

typedef enum se3di_kkt_body_kind {
    SE3DI_KKT_BODY_FULL = 0,
    SE3DI_KKT_BODY_MASS = 1 /* n = 6 and every H = diag(m, m, m, J), J 3 x 3 */
} se3di_kkt_body_kind;

/* Instruction level of the kernels. PORTABLE gives the same bits on every machine. */
typedef enum se3di_kkt_level {
    SE3DI_KKT_LEVEL_AUTO = 0,
    SE3DI_KKT_LEVEL_PORTABLE = 1,
    SE3DI_KKT_LEVEL_AVX2 = 2,
    SE3DI_KKT_LEVEL_AVX512 = 3
} se3di_kkt_level;

typedef struct se3di_kkt_pattern {
    size_t body_count;
    size_t joint_count;
    size_t coupling_count;
    const int32_t *joint_rows;  /* [joint_count], 0 .. SE3DI_KKT_MAX_JOINT_ROWS */
    const int32_t *joint_begin; /* [joint_count + 1] into joint_body */
    const int32_t *joint_body;  /* free bodies of each joint, none twice; a joint without any has
                                   multipliers zero */
    const int32_t *coupling;    /* [2 * coupling_count]: pairs i < j, none twice */
    int32_t body_size;          /* n, 1 .. 8; symmetric with n = 8: see se3di_kkt_values */
    bool symmetric;
    se3di_kkt_body_kind body_kind;
    se3di_kkt_level level;
} se3di_kkt_pattern;

/* The numbers, owned by the caller, in the order of the pattern.
 *
 * A symmetric body block of size 8 is [M p; p^T 0], M of size 7 with M + p p^T positive definite
 * (r-p: the last unknown is the multiplier of the normalisation); the last column of C and the last
 * row and column of couplings must then be zero. Other symmetric body blocks are positive definite.
 * Of each only the lower triangle is factored. Unsymmetric blocks are arbitrary; rows are pivoted
 * inside a block. */
typedef struct se3di_kkt_values {
    const double *body;           /* H: n x n a body, row-major */
    const double *coupling_upper; /* H_ij, n x n each */
    const double *coupling_lower; /* H_ji, n x n each; unsymmetric mode only */
    const double *joint;          /* C: m x n for each entry of joint_body, see layout */
    const double *joint_b;        /* unsymmetric mode only: B transposed, laid out exactly as C */
    const double *weight;         /* [row_count]: sizes that rows are measured by, if their own may
                                     vanish; NULL: diag(C H^-1 B) */
} se3di_kkt_values;

/* The places of things. x: body i at i * body_size; l and c: joint j at row_offset[j]. */
typedef struct se3di_kkt_layout {
    size_t unknown_count;       /* body_count * body_size */
    size_t row_count;           /* rows of all joints */
    size_t joint_value_count;   /* doubles of values.joint */
    const int32_t *row_offset;  /* [joint_count + 1] */
    const size_t *block_offset; /* [joint_begin[joint_count]]: of each block in values.joint */
} se3di_kkt_layout;

typedef enum se3di_kkt_regularise {
    SE3DI_KKT_REGULARISE_AUTO = 0,  /* at once if the graph has loops, else when needed */
    SE3DI_KKT_REGULARISE_FIRST = 1, /* redundancy is expected: always at once */
    SE3DI_KKT_REGULARISE_LATE = 2   /* none is expected: only after a pivot vanished */
} se3di_kkt_regularise;

typedef struct se3di_kkt_settings {
    double eps;       /* regularisation relative to diag(C H^-1 B); 1e-10 */
    double eps_min;   /* if rows are nearly dependent it may fall to this; 1e-14; eps: they are
                         filtered, and the solution does not jump where they become dependent */
    double tolerance; /* of the relative residual; 1e-15 */
    int32_t max_refinements;
    se3di_kkt_regularise regularise;
    bool always_check;      /* compute the residual also if the pivots promise the tolerance */
    bool any_multipliers;   /* of dependent rows: they need not be those of least norm */
    bool iterated;          /* the caller iterates on the exact residual (Newton): if E = 0, that
                               corrects what a solution leaves, and it is not looked at */
    bool wide;              /* of a filter: rows are redundant by geometry alone */
    int32_t redundant_rows; /* of a filter: rows known to depend on the others, all: not known */
} se3di_kkt_settings;

typedef struct se3di_kkt_factor_info {
    int32_t factorisations;    /* numeric factorisations that this call took */
    int32_t dependent_rows;    /* rows whose pivot vanished (within 1e-13) */
    int32_t near_dependent;    /* rows whose pivot is below 1e-6 */
    int32_t negative_pivots;   /* body pivots of the wrong sign (symmetric mode: H indefinite) */
    int32_t negative_freedoms; /* symmetric mode: negative eigenvalues of H on the null space of C
                                  (by Sylvester's law; with eps > 0 of H + C^T C / e) */
    int32_t reserved;
    double eps;       /* regularisation that was used, 0 = none */
    double min_pivot; /* smallest pivot of a joint row relative to its diag(C H^-1 B) */
} se3di_kkt_factor_info;

typedef struct se3di_kkt_solve_info {
    int32_t refinements;
    bool checked;      /* the residuals below were computed */
    bool projected;    /* the multipliers were projected to the least norm */
    bool inconsistent; /* dependent rows contradict each other: residual_c stays */
    double rate;       /* last ratio of successive residuals, 0 if there were not two */
    double residual_b; /* |b - H x - B l| / max(|b|, |H x|, |B l|), largest entries */
    double residual_c; /* |c - C x| / max(|c|, |C_rc x_c|); iterated: max(|c|, |C x|) */
} se3di_kkt_solve_info;

typedef struct se3di_kkt se3di_kkt;

/* Analyse `pattern` (which is copied) and allocate everything. What follows from the pattern is
 * taken from `shelf` if it is there, else put there; NULL: no shelf. On failure *kkt is NULL.
 * @return SE3D_OK, SE3D_ERR_INVALID_ARGUMENT (pattern), SE3D_ERR_NO_MEMORY */
se3d_status se3di_kkt_create(const se3d_allocator *allocator, const se3di_kkt_pattern *pattern,
                             se3di_kkt_kind kind, se3di_shelf *shelf, se3di_kkt **kkt);
void se3di_kkt_destroy(se3di_kkt *kkt); /* NULL is fine */

se3di_kkt_settings se3di_kkt_get_settings(const se3di_kkt *kkt);
void se3di_kkt_set_settings(se3di_kkt *kkt, const se3di_kkt_settings *settings);

int32_t se3di_kkt_get_dependent_rows(const se3di_kkt *kkt); /* of the last factorisation */
/* Estimated cost of factor and one solve, in vector operations; for the choice of orders. */
double se3di_kkt_get_cost(const se3di_kkt *kkt);

/* Whether bodies, the ground and joints make a loop: rows may be dependent. */
bool se3di_kkt_has_loop(const se3di_kkt *kkt);

/* Promise that body blocks stay as they are from the next factorisation on: what follows from them
 * alone is then kept, and so are the weights that pivots are measured by. `hold` false, or another
 * call: from then on everything is new. */
void se3di_kkt_hold(se3di_kkt *kkt, bool hold);

/* Tell before se3di_kkt_factor that the first solution after it will be for this b and c, which do
 * not change in between: half of it is then done on the way. */
void se3di_kkt_expect(se3di_kkt *kkt, const double *b, const double *c);

/* Factor. `info` may be NULL.
 * @return SE3D_OK, SE3D_INFO_REDUNDANT (dependent rows), SE3D_ERR_NOT_FINITE (values),
 *         SE3D_ERR_SINGULAR (a body block) */
se3d_status se3di_kkt_factor(se3di_kkt *kkt, const se3di_kkt_values *values,
                             se3di_kkt_factor_info *info);

/* Solve with the last factorisation, which must be of (or near) `values`, by iterative refinement.
 * b[unknown_count], c[row_count] or NULL for zero; x and l must not overlap them. `info` may be
 * NULL.
 * @return SE3D_OK, SE3D_INFO_REDUNDANT (l is the least-norm solution), SE3D_ERR_NOT_FINITE,
 *         SE3D_ERR_NO_CONVERGENCE (the residual stays above 1e-6 without being inconsistent) */
se3d_status se3di_kkt_solve(se3di_kkt *kkt, const se3di_kkt_values *values, const double *b,
                            const double *c, double *x, double *l, se3di_kkt_solve_info *info);

/* The multipliers of least 2-norm among the least-squares solutions of B l = b - H x, by a
 * rank-revealing orthogonal factorisation; dense, for up to some 600 rows. Columns are dependent
 * below `tolerance` (1e-10 is a good choice) after scaling to unit length. *rank may be NULL. The
 * only function here that allocates.
 * @return SE3D_OK, SE3D_ERR_NO_MEMORY, SE3D_ERR_NOT_FINITE */
se3d_status se3di_kkt_min_norm(se3di_kkt *kkt, const se3di_kkt_values *values, const double *b,
                               const double *x, double tolerance, double *l, int32_t *rank);

#endif
