/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops in planes that lean, or move: where joint points coincide the tree may imply what
 * is along n, fixed on body i, and nothing along the ground's axes. The three rows are then turned,
 *
 *     [u w n]^T A_i^T (Phi, C, gamma),    lambda = A_i [u w n] lambda'
 *
 * so that the last of them is empty in every pose, as what tree/loop_rows.c looks for.
 *                                                             docs/theory/joint_coordinates.md */
#include "tree/loops.h"

#include "math/vec3.h"

#include <math.h>

#define EMPTY 1e-12 /* of the rows' size, in the direction that is implied */

/* Body i of a loop. */
static const double *frame_of(const se3di_tree_loops *loops, uint32_t loop)
{
    const se3di_model *model = loops->tree->model;
    return model->frames[model->constraints[loops->constraints[loop]].bodies[0]].A;
}

int se3di_tree_loops_is_point(const se3di_tree_loops *loops, uint32_t loop)
{
    const se3di_model *model = loops->tree->model;
    const se3di_constraint *c = &model->constraints[loops->constraints[loop]];
    int is = c->pattern != SE3DI_PATTERN_NONE;
    for (uint32_t r = 0; is && r < 3; ++r) {
        is = model->rows[c->row_begin + r].function < 0;
    }
    return is;
}

/* The rows as they stand, in the axes of body i: three numbers of each freedom in `columns`. */
static void eval_columns(se3di_tree_loops *loops, uint32_t loop, double *const columns[3])
{
    const size_t count = loops->tree->v_count;
    const double *A = frame_of(loops, loop);
    for (size_t r = 0; r < 3; ++r) {
        for (size_t v = 0; v < count; ++v) {
            columns[r][v] = 0.0;
        }
        se3di_tree_loops_row(loops, loop, r, columns[r]);
    }
    for (size_t v = 0; v < count; ++v) {
        const double x[3] = {columns[0][v], columns[1][v], columns[2][v]};
        double own[3];
        se3di_mul_transposed(A, x, own);
        for (int k = 0; k < 3; ++k) {
            columns[k][v] = own[k];
        }
    }
}

void se3di_tree_loops_watch_turn(se3di_tree_loops *loops, uint32_t loop, int looks)
{
    double *const columns[3] = {loops->y, loops->H, loops->b};
    se3di_loop_turn *turn = &loops->turns[loop];
    if (!se3di_tree_loops_is_point(loops, loop)) {
        return;
    }
    eval_columns(loops, loop, columns);
    for (size_t v = 0; v < loops->tree->v_count; ++v) {
        const double x[3] = {columns[0][v], columns[1][v], columns[2][v]};
        if (looks) {
            turn->rest = fmax(turn->rest, fabs(se3di_dot(turn->Q + 6, x)));
            continue;
        }
        for (int r = 0; r < 3; ++r) {
            for (int c = 0; c < 3; ++c) {
                turn->Q[3 * r + c] += x[r] * x[c];
            }
        }
    }
}

/* The best of the products of two rows of a symmetric matrix with one eigenvalue 0; 0: none. */
static int find_normal(const double M[9], double n[3])
{
    double best = 0.0;
    for (int k = 0; k < 3; ++k) {
        double x[3];
        se3di_cross(M + 3 * k, M + 3 * ((k + 1) % 3), x);
        const double size = se3di_norm(x);
        if (size > best) {
            best = size;
            se3di_scale(1.0 / size, x, n);
        }
    }
    return best > 0.0;
}

int se3di_tree_loops_foresee_turn(se3di_tree_loops *loops, uint32_t loop)
{
    static const double axes[3][3] = {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    se3di_loop_turn *turn = &loops->turns[loop];
    double *Q = turn->Q, n[3] = {0.0, 0.0, 0.0};
    turn->size = sqrt(Q[0] + Q[4] + Q[8]);
    if (!se3di_tree_loops_is_point(loops, loop) || !find_normal(Q, n)) {
        return 0;
    }
    int least = 0;
    for (int k = 1; k < 3; ++k) {
        least = fabs(n[k]) < fabs(n[least]) ? k : least;
    }
    se3di_cross(n, axes[least], Q);
    se3di_scale(1.0 / se3di_norm(Q), Q, Q);
    se3di_cross(n, Q, Q + 3);
    se3di_copy(n, Q + 6);
    return 1;
}

void se3di_tree_loops_decide_turn(se3di_tree_loops *loops, uint32_t loop)
{
    se3di_loop_turn *turn = &loops->turns[loop];
    turn->is_turned = turn->rest <= EMPTY * turn->size;
}

void se3di_tree_loops_turn(const se3di_tree_loops *loops, uint32_t loop, double x[3], size_t stride)
{
    const double *A = frame_of(loops, loop);
    const double plain[3] = {x[0], x[stride], x[2 * stride]};
    double own[3];
    se3di_mul_transposed(A, plain, own);
    for (size_t k = 0; k < 3; ++k) {
        x[k * stride] = se3di_dot(loops->turns[loop].Q + 3 * k, own);
    }
}

void se3di_tree_loops_turn_back(const se3di_tree_loops *loops, uint32_t loop, double x[3])
{
    double own[3];
    se3di_mul_transposed(loops->turns[loop].Q, x, own);
    se3di_mul(frame_of(loops, loop), own, x);
}

void se3di_tree_loops_turn_rows(const se3di_tree_loops *loops, int others_only)
{
    const se3di_assembly *a = loops->assembly;
    for (uint32_t k = 0; k < loops->count; ++k) {
        const uint32_t constraint = loops->constraints[k];
        if (!loops->turns[k].is_turned || (others_only && loops->points[k].is_there)) {
            continue;
        }
        se3di_tree_loops_turn(
            loops, k, loops->gamma + loops->tree->model->constraints[constraint].row_begin, 1);
        for (int32_t e = a->joint_begin[constraint]; e < a->joint_begin[constraint + 1]; ++e) {
            for (size_t c = 0; c < 6; ++c) {
                se3di_tree_loops_turn(loops, k, a->C + a->block_offset[e] + c, 6);
            }
        }
    }
}
