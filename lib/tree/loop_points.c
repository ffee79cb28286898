/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops that keep no rows but some of those of two points that coincide, without functions of time:
 * their rows come from the links alone, no frame of a body is needed. With d_k the directions of
 * the rows (axes of the ground, or turned ones of body i), x and b = w x (w x x) the arm from P to
 * the point on each link and what the point accelerates by its velocity, on j and, less, on i:
 *
 *     K_k = (x x d_k, d_k)    c_k = -d_k . b          docs/theory/joint_coordinates.md */
#include "tree/loops.h"

#include "math/vec3.h"
#include "tree/loop_core.h"
#include "tree/recursion.h"

#include <string.h>

static const double ground_axes[9] = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0};

/* ---- what does not change with the state ---- */

/* The square that directions d of the triad give: of (s x d)^2 / J, in the axes of the body. */
static void take_square(const se3di_tree_node *n, const se3di_body *body, const double s[3],
                        double square[9])
{
    double axes[9], turns[9];
    for (int k = 0; k < 3; ++k) {
        se3di_tree_to_triad(n, ground_axes + 3 * k, axes + 3 * k);
    }
    for (int k = 0; k < 3; ++k) { /* row k: of the triad's direction k */
        const double d[3] = {axes[k], axes[3 + k], axes[6 + k]};
        se3di_cross(s, d, turns + 3 * k);
    }
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            double sum = r == c ? 1.0 / body->mass : 0.0;
            for (int k = 0; k < 3; ++k) {
                sum += turns[3 * r + k] * turns[3 * c + k] / body->J[k];
            }
            square[3 * r + c] = sum;
        }
    }
}

static int32_t place_of(const se3di_tree_loops *loops, uint32_t loop, int32_t node)
{
    const int32_t begin = loops->path_begin[loop];
    int32_t place = 0;
    while (loops->path_node[begin + place] != node) {
        ++place;
    }
    return place;
}

static void take_side(const se3di_tree_loops *loops, uint32_t loop, uint32_t body,
                      const double s[3], se3di_loop_side *side)
{
    const se3di_tree *tree = loops->tree;
    side->node = tree->node_of[body];
    if (side->node < 0) {
        se3di_tree_point(tree, body, s, side->arm);
        return;
    }
    const se3di_tree_node *n = &tree->nodes[side->node];
    double x[3];
    side->place = place_of(loops, loop, side->node);
    se3di_tree_to_triad(n, s, x);
    se3di_add(n->s, x, side->arm);
    take_square(n, &tree->model->bodies[body], s, side->square);
}

static int keeps_points_only(const se3di_tree_loops *loops, uint32_t loop)
{
    int only = se3di_tree_loops_is_point(loops, loop);
    for (int32_t r = 0; r < loops->kept_count[loop]; ++r) {
        only &= loops->kept[loops->row_begin[loop] + (uint32_t)r] < 3;
    }
    return only;
}

static void take_loop(se3di_tree_loops *loops, uint32_t loop)
{
    const se3di_model *model = loops->tree->model;
    const se3di_constraint *c = &model->constraints[loops->constraints[loop]];
    const se3di_term *term = &model->terms[c->term_begin];
    const se3di_loop_turn *turn = &loops->turns[loop];
    se3di_loop_point *point = &loops->points[loop];
    memset(point, 0, sizeof *point);
    point->is_there = keeps_points_only(loops, loop) && term->body_i != term->body_j;
    if (!point->is_there) {
        loops->others[loops->other_count++] = loops->constraints[loop];
        return;
    }
    take_side(loops, loop, term->body_i, term->s_i, &point->side[0]);
    take_side(loops, loop, term->body_j, term->s_j, &point->side[1]);
    memcpy(point->direction, turn->is_turned ? turn->Q : ground_axes, sizeof point->direction);
    point->turns_with = turn->is_turned ? point->side[0].node : -1;
    for (int k = 0; k < 3 && point->turns_with >= 0; ++k) {
        se3di_tree_to_triad(&loops->tree->nodes[point->turns_with], turn->Q + 3 * k,
                            point->direction + 3 * k);
    }
    point->has_axes = !turn->is_turned && loops->kept_count[loop] == 3; /* which are in order */
    if (turn->is_turned && point->turns_with < 0) {                     /* body i is fixed */
        for (size_t k = 0; k < 3; ++k) {
            se3di_mul(model->frames[term->body_i].A, turn->Q + 3 * k, point->direction + 3 * k);
        }
    }
}

void se3di_tree_loops_take_points(se3di_tree_loops *loops)
{
    loops->other_count = 0;
    for (uint32_t k = 0; k < loops->count; ++k) {
        take_loop(loops, k);
    }
    se3di_tree_loops_find_teams(loops);
}

/* ---- at a state ---- */

static void load_along(const se3di_tree_loops *loops, const se3di_loop_strip *strip,
                       const se3di_loop_point *point, double *K, double *c, double *weight)
{
    const se3di_tree *tree = loops->tree;
    const int32_t *kept = loops->kept + loops->row_begin[strip->loop] + strip->first;
    double directions[3 * SE3DI_STRIP] = {0.0};
    for (int32_t r = 0; r < strip->count; ++r) {
        const double *own = point->direction + 3 * kept[r];
        double d[3];
        if (point->turns_with >= 0) {
            se3di_mul(tree->links[point->turns_with].W, own, d);
        } else {
            se3di_copy(own, d);
        }
        for (int k = 0; k < 3; ++k) {
            directions[SE3DI_STRIP * k + r] = d[k];
        }
    }
    for (int k = 0; k < 2; ++k) {
        const se3di_loop_side *side = &point->side[k];
        if (side->node >= 0) {
            loops->system.core->load_side(tree, side, k == 0 ? -1.0 : 1.0, directions,
                                          K + 6 * SE3DI_STRIP * (size_t)side->place, c, weight);
        }
    }
}

void se3di_tree_loops_load_point(const se3di_tree_loops *loops, const se3di_loop_strip *strip,
                                 double *K, double *c, double *weight)
{
    const se3di_loop_point *point = &loops->points[strip->loop];
    if (!point->has_axes) {
        load_along(loops, strip, point, K, c, weight);
        return;
    }
    for (int k = 0; k < 2; ++k) {
        const se3di_loop_side *side = &point->side[k];
        if (side->node >= 0) {
            loops->system.core->load_axes(loops->tree, side, k == 0 ? -1.0 : 1.0,
                                          K + 6 * SE3DI_STRIP * (size_t)side->place, c, weight);
        }
    }
}
