/* SPDX-License-Identifier: BSD-3-Clause */
/* Loops that are carried down the tree side by side: four whose rows come from points along the
 * ground's axes and whose paths have nodes of the same types, as the corners of a vehicle have.
 *                                                             docs/theory/joint_coordinates.md */
#include "tree/loop_core.h"
#include "tree/loops.h"

#include <string.h>

#define LOOKS 64 /* strips after one among which others of its team are sought */

static int may_join(const se3di_tree_loops *loops, const se3di_loop_strip *strip)
{
    const se3di_loop_point *point = &loops->points[strip->loop];
    return point->is_there && point->has_axes && strip->count == SE3DI_TEAM_ROWS &&
           se3di_loop_path_of(loops, strip).count <= SE3DI_TEAM_NODES;
}

static int are_sides_alike(const se3di_loop_side *a, const se3di_loop_side *b)
{
    return (a->node < 0) == (b->node < 0) && a->place == b->place;
}

/* Paths have the same shape and the same freedoms at each place. */
static int are_alike(const se3di_tree_loops *loops, const se3di_loop_strip *one,
                     const se3di_loop_strip *other)
{
    const se3di_tree_node *nodes = loops->tree->nodes;
    const se3di_loop_path a = se3di_loop_path_of(loops, one), b = se3di_loop_path_of(loops, other);
    const se3di_loop_point *p = &loops->points[one->loop], *q = &loops->points[other->loop];
    int alike = a.count == b.count && are_sides_alike(&p->side[0], &q->side[0]) &&
                are_sides_alike(&p->side[1], &q->side[1]);
    for (int32_t k = 0; alike && k < a.count; ++k) {
        alike = a.parent[k] == b.parent[k] && nodes[a.node[k]].type == nodes[b.node[k]].type;
    }
    return alike;
}

/* Strips from the k-th on that are alike; returns how many there are up to a team, of which places
 * are in `team`. Those that stand in one already are marked. */
static int32_t seek(const se3di_tree_loops *loops, const int32_t *mark, int32_t k,
                    int32_t team[SE3DI_TEAM])
{
    const se3di_loop_system *s = &loops->system;
    const int32_t end = k + LOOKS < s->row_strips ? k + LOOKS : s->row_strips;
    int32_t count = 0;
    for (int32_t m = k; m < end && count < SE3DI_TEAM; ++m) {
        if (!mark[m] && may_join(loops, &s->strips[m]) &&
            (m == k || are_alike(loops, &s->strips[k], &s->strips[m]))) {
            team[count++] = m;
        }
        if (count == 0) {
            return 0; /* not even the first */
        }
    }
    return count;
}

void se3di_tree_loops_find_teams(se3di_tree_loops *loops)
{
    se3di_loop_system *s = &loops->system;
    int32_t *mark = s->where, team[SE3DI_TEAM], count = 0;
    s->team_count = 0;
    if (!s->is_there) {
        return;
    }
    memset(mark, 0, (size_t)s->strip_count * sizeof *mark);
    for (int32_t k = 0; k < s->row_strips; ++k) {
        if (seek(loops, mark, k, team) < SE3DI_TEAM) {
            continue;
        }
        for (int m = 0; m < SE3DI_TEAM; ++m) {
            mark[team[m]] = 1;
            s->carried[count++] = team[m];
        }
        ++s->team_count;
    }
    for (int32_t k = 0; k < s->row_strips; ++k) {
        if (!mark[k]) {
            s->carried[count++] = k;
        }
    }
}

static int is_given(const se3di_tree *tree, const se3di_loop_path *path)
{
    int given = 0;
    for (int32_t k = 0; k < path->count; ++k) {
        given |= tree->nodes[path->node[k]].flags & SE3DI_TREE_GIVEN;
    }
    return given;
}

int se3di_tree_loops_carry_team(const se3di_tree_loops *loops, int32_t index)
{
    const se3di_loop_system *s = &loops->system;
    se3di_loop_team team;
    int given = 0;
    for (int m = 0; m < SE3DI_TEAM; ++m) {
        const int32_t k = s->carried[SE3DI_TEAM * index + m];
        const se3di_loop_strip *strip = &s->strips[k];
        const se3di_loop_point *point = &loops->points[strip->loop];
        team.path[m] = se3di_loop_path_of(loops, strip);
        team.side[0][m] = &point->side[0];
        team.side[1][m] = &point->side[1];
        team.Y[m] = s->Y + SE3DI_STRIP * (size_t)strip->Y;
        team.c[m] = s->c + SE3DI_STRIP * (size_t)k;
        team.weight[m] = s->weight + SE3DI_STRIP * (size_t)k;
        given |= is_given(loops->tree, &team.path[m]);
    }
    if (!given) {
        s->core->carry_team(loops->tree, &team);
    }
    return !given;
}
