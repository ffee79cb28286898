/* SPDX-License-Identifier: BSD-3-Clause */
#include "tree/loops.h"

#include "assembly/user.h"
#include "math/vec3.h"
#include "primitive/scale.h"
#include "primitive/turn_counter.h"
#include "tree/loop_core.h"
#include "tree/recursion.h"

#include <math.h>
#include <string.h>

/* Less than this part of what it comes from is rounding, and what poses leave of the equations. */
#define NOISE 1e-9

/* Stages keep symmetries of the motion only if the regularisation leaves nothing: what it leaves
 * grows with the inverse square of the distance to a singular position. There a fixed number of
 * refinements filters. */
#define TOLERANCE   1e-15
#define REFINEMENTS 3

#define LOOPS_STRUCTURE 15
#define LOOPS_VALUES    12

static void list_structure(se3di_tree_loops *l, se3di_array list[LOOPS_STRUCTURE])
{
    const size_t n = l->tree->constraint_count;
    const se3di_array arrays[] = {
        {(void **)&l->constraints, n, sizeof *l->constraints},
        {(void **)&l->rows, n, sizeof *l->rows},
        {(void **)&l->row_begin, n + 1, sizeof *l->row_begin},
        {(void **)&l->kept, l->row_count, sizeof *l->kept},
        {(void **)&l->kept_count, n, sizeof *l->kept_count},
        {(void **)&l->kept_begin, n, sizeof *l->kept_begin},
        {(void **)&l->path_begin, n + 1, sizeof *l->path_begin},
        {(void **)&l->path_node, l->path_count, sizeof *l->path_node},
        {(void **)&l->path_parent, l->path_count, sizeof *l->path_parent},
        {(void **)&l->member_begin, n + 1, sizeof *l->member_begin},
        {(void **)&l->member, l->member_count, sizeof *l->member},
        {(void **)&l->place_of, l->tree->count, sizeof *l->place_of},
        {(void **)&l->turns, n, sizeof *l->turns},
        {(void **)&l->points, n, sizeof *l->points},
        {(void **)&l->others, n, sizeof *l->others},
    };
    _Static_assert(sizeof arrays == LOOPS_STRUCTURE * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void list_values(se3di_tree_loops *l, se3di_array list[LOOPS_VALUES])
{
    const size_t size = sizeof(double), v = l->tree->v_count;
    const se3di_array arrays[] = {
        {(void **)&l->Y, l->value_count, size},
        {(void **)&l->gamma, l->assembly->row_count, size},
        {(void **)&l->lambda, l->assembly->row_count, size},
        {(void **)&l->c, l->row_count, size},
        {(void **)&l->l, l->row_count, size},
        {(void **)&l->weight, l->row_count, size},
        {(void **)&l->y, v, size},
        {(void **)&l->H, v, size},
        {(void **)&l->b, v, size},
        {(void **)&l->K, l->scratch_count, size},
        {(void **)&l->size, l->scratch_count / 3, size},
        {(void **)&l->noise, v, size},
    };
    _Static_assert(sizeof arrays == LOOPS_VALUES * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

/* ---- structure ---- */

static int32_t freedoms_of(const se3di_tree_node *n)
{
    return n->flags & SE3DI_TREE_GIVEN ? 0 : n->v_count;
}

/* Marks of the nodes between the bodies of a constraint and the ground; returns how many, their
 * freedoms are added to *members. */
static size_t mark_path(const se3di_tree_loops *loops, uint32_t constraint, int32_t *mark,
                        size_t *members)
{
    const se3di_assembly *a = loops->assembly;
    const se3di_tree *tree = loops->tree;
    size_t count = 0;
    for (int32_t k = a->joint_begin[constraint]; k < a->joint_begin[constraint + 1]; ++k) {
        int32_t node = tree->node_of[a->free_body[a->joint_body[k]]];
        for (; node >= 0 && mark[node] != (int32_t)constraint + 1; ++count) {
            mark[node] = (int32_t)constraint + 1;
            *members += (size_t)freedoms_of(&tree->nodes[node]);
            node = tree->nodes[node].parent;
        }
    }
    return count;
}

se3d_status se3di_tree_loops_count_members(se3di_tree *tree, se3di_assembly *assembly,
                                           size_t *members)
{
    const se3d_allocator *allocator = &tree->model->allocator;
    const se3di_tree_loops loops = {.tree = tree, .assembly = assembly};
    int32_t *mark = se3di_alloc(allocator, tree->count, sizeof *mark);
    *members = 0;
    for (uint32_t k = 0; mark && k < tree->constraint_count; ++k) {
        if (se3di_tree_leaves(tree, k)) {
            (void)mark_path(&loops, k, mark, members);
        }
    }
    se3di_free(allocator, mark, tree->count, sizeof *mark);
    return mark ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

/* Sizes of everything; `mark` [nodes] zeroed. */
static void measure_paths(se3di_tree_loops *loops, int32_t *mark)
{
    const se3di_tree *tree = loops->tree;
    const se3di_model *model = tree->model;
    for (uint32_t k = 0; k < tree->constraint_count; ++k) {
        if (!se3di_tree_leaves(tree, k)) {
            continue;
        }
        const size_t rows = model->constraints[k].row_count;
        size_t members = 0;
        const size_t path = mark_path(loops, k, mark, &members);
        const size_t scratch = 6 * (rows > SE3DI_STRIP ? rows : SE3DI_STRIP) * path;
        loops->path_count += path;
        loops->member_count += members;
        loops->value_count += rows * members;
        loops->row_count += (uint32_t)rows;
        loops->scratch_count = scratch > loops->scratch_count ? scratch : loops->scratch_count;
    }
}

static void add_loop(se3di_tree_loops *loops, uint32_t constraint, int32_t *mark)
{
    const se3di_tree *tree = loops->tree;
    const uint32_t k = loops->count++;
    int32_t path = loops->path_begin[k], member = loops->member_begin[k];
    loops->constraints[k] = constraint;
    loops->rows[k] = (int32_t)tree->model->constraints[constraint].row_count;
    size_t members = 0;
    (void)mark_path(loops, constraint, mark, &members);
    for (uint32_t i = tree->count; i-- > 0;) {
        if (mark[i] != (int32_t)constraint + 1) {
            continue;
        }
        loops->place_of[i] = path - loops->path_begin[k];
        loops->path_node[path++] = (int32_t)i;
        for (int32_t j = 0; j < freedoms_of(&tree->nodes[i]); ++j) {
            loops->member[member++] = (int32_t)tree->nodes[i].v + j;
        }
    }
    for (int32_t p = loops->path_begin[k]; p < path; ++p) {
        const int32_t parent = tree->nodes[loops->path_node[p]].parent;
        loops->path_parent[p] = parent < 0 ? -1 : loops->place_of[parent];
    }
    loops->path_begin[k + 1] = path;
    loops->member_begin[k + 1] = member;
    loops->row_begin[k + 1] = loops->row_begin[k] + (uint32_t)loops->rows[k];
}

static se3d_status create_kkt(se3di_tree_loops *loops)
{
    const se3di_kkt_pattern pattern = {
        .body_count = loops->tree->v_count,
        .joint_count = loops->count,
        .joint_rows = loops->kept_count,
        .joint_begin = loops->member_begin,
        .joint_body = loops->member,
        .body_size = 1,
        .symmetric = true,
        .body_kind = SE3DI_KKT_BODY_FULL,
    };
    SE3DI_TRY(se3di_kkt_create(&loops->tree->model->allocator, &pattern, SE3DI_KKT_STRUCTURED,
                               loops->tree->model->shelf, &loops->kkt));
    for (uint32_t k = 0; k < loops->count; ++k) {
        if (loops->kept_count[k] > loops->member_begin[k + 1] - loops->member_begin[k]) {
            se3di_kkt_settings settings = se3di_kkt_get_settings(loops->kkt);
            settings.regularise = SE3DI_KKT_REGULARISE_FIRST; /* more rows than freedoms */
            se3di_kkt_set_settings(loops->kkt, &settings);
        }
    }
    return SE3D_OK;
}

static se3d_status build(se3di_tree_loops *loops)
{
    se3di_tree *tree = loops->tree;
    const se3d_allocator *allocator = &tree->model->allocator;
    se3di_array structure[LOOPS_STRUCTURE], values[LOOPS_VALUES];
    int32_t *mark = se3di_alloc(allocator, tree->count, sizeof *mark);
    if (!mark) {
        return SE3D_ERR_NO_MEMORY;
    }
    measure_paths(loops, mark);
    memset(mark, 0, tree->count * sizeof *mark);
    list_structure(loops, structure);
    se3d_status status = se3di_arrays_alloc(allocator, structure, LOOPS_STRUCTURE);
    for (uint32_t k = 0; status >= 0 && k < tree->constraint_count; ++k) {
        if (se3di_tree_leaves(tree, k)) {
            add_loop(loops, k, mark);
        }
    }
    se3di_free(allocator, mark, tree->count, sizeof *mark);
    SE3DI_TRY(status);
    list_values(loops, values);
    SE3DI_TRY(se3di_arrays_alloc(allocator, values, LOOPS_VALUES));
    se3di_tree_loops_keep_rows(loops);
    SE3DI_TRY(se3di_tree_loops_count_freedoms(loops));
    SE3DI_TRY(create_kkt(loops));
    SE3DI_TRY(se3di_loop_system_init(&loops->system, loops));
    se3di_tree_loops_refresh(loops);
    return SE3D_OK;
}

se3d_status se3di_tree_loops_init(se3di_tree_loops *loops, se3di_tree *tree,
                                  se3di_assembly *assembly, se3di_error *error)
{
    *loops = (se3di_tree_loops){.tree = tree, .assembly = assembly, .error = error};
    const se3d_status status = build(loops);
    if (status < 0) {
        se3di_tree_loops_destroy(loops);
        return se3di_error_set(error, status, "no memory for the loops of the tree");
    }
    return SE3D_OK;
}

void se3di_tree_loops_destroy(se3di_tree_loops *loops)
{
    if (!loops->tree) {
        return;
    }
    const se3d_allocator *allocator = &loops->tree->model->allocator;
    se3di_array structure[LOOPS_STRUCTURE], values[LOOPS_VALUES];
    se3di_kkt_destroy(loops->kkt);
    se3di_loop_system_destroy(&loops->system, allocator);
    list_values(loops, values);
    se3di_arrays_free(allocator, values, LOOPS_VALUES);
    list_structure(loops, structure);
    se3di_arrays_free(allocator, structure, LOOPS_STRUCTURE);
    memset(loops, 0, sizeof *loops);
}

void se3di_tree_loops_filter(se3di_tree_loops *loops, const se3di_kkt_settings *settings)
{
    se3di_kkt_settings own = *settings;
    own.tolerance = TOLERANCE;
    own.max_refinements = REFINEMENTS;
    if (own.regularise == SE3DI_KKT_REGULARISE_AUTO) {
        own.regularise =
            SE3DI_KKT_REGULARISE_FIRST; /* the graph of the rows has no loop, they do */
    }
    se3di_kkt_set_settings(loops->kkt, &own);
}

/* ---- rows ---- */

void se3di_tree_take_given(se3di_tree *tree, const se3di_assembly *assembly)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        if (n->flags & SE3DI_TREE_GIVEN) {
            const uint32_t row = tree->model->constraints[n->driver].row_begin;
            const se3di_term *term = &tree->model->terms[tree->model->rows[row].term_begin];
            tree->given[n->v] = assembly->f[3 * (size_t)row + 2] / term->coefficient;
        }
    }
}

/* A row of a body (to dr of the centre of mass, ground frame, and turns of the body frame) as one
 * of its node: to angular acceleration and acceleration of P, ground axes. */
static void row_to_link(const se3di_tree_link *link, const double A[9], const double row[6],
                        double K[6])
{
    double x[3], y[3];
    se3di_cross(link->s, row, x);
    se3di_mul(A, row + 3, y);
    se3di_add(x, y, K);
    se3di_copy(row, K + 3);
}

static double size_of(const double x[3])
{
    return fabs(x[0]) + fabs(x[1]) + fabs(x[2]);
}

/* The sizes of the two halves of a row before its parts cancel: rounding is relative to them. */
static void add_sizes(const double K[6], double factor, double size[2])
{
    size[0] += factor * size_of(K);
    size[1] += factor * size_of(K + 3);
}

/* The same of a row of a body, as row_to_link takes it. */
static void add_row_sizes(const se3di_tree_link *link, const double row[6], double size[2])
{
    const double force = size_of(row);
    size[0] += size_of(link->s) * force + size_of(row + 3);
    size[1] += force;
}

/* What a row gives of its body's mobility. */
static double row_weight(const se3di_body *body, const double row[6])
{
    double weight = se3di_dot(row, row) / body->mass;
    for (int k = 0; k < 3; ++k) {
        weight += row[3 + k] * row[3 + k] / body->J[k];
    }
    return weight;
}

/* Rows of a loop on its bodies into K; from `c` what the centre of mass has on its own. */
static void load_rows(se3di_tree_loops *loops, uint32_t loop, double *c, double *weight)
{
    const se3di_assembly *a = loops->assembly;
    const se3di_tree *tree = loops->tree;
    const uint32_t constraint = loops->constraints[loop];
    const int32_t rows = loops->kept_count[loop];
    const int32_t *kept = loops->kept + loops->row_begin[loop];
    const int32_t *nodes = loops->path_node + loops->path_begin[loop];
    const size_t count = (size_t)(loops->path_begin[loop + 1] - loops->path_begin[loop]);
    memset(weight, 0, (size_t)rows * sizeof *weight);
    memset(loops->K, 0, 6 * (size_t)rows * count * sizeof *loops->K);
    memset(loops->size, 0, 2 * (size_t)rows * count * sizeof *loops->size);
    for (int32_t k = a->joint_begin[constraint]; k < a->joint_begin[constraint + 1]; ++k) {
        const uint32_t body = a->free_body[a->joint_body[k]];
        const int32_t node = tree->node_of[body];
        const se3di_tree_link *link = &tree->links[node];
        size_t place = 0;
        double x[3], turning[3];
        while (nodes[place] != node) {
            ++place;
        }
        se3di_cross(link->w, link->s, x);
        se3di_cross(link->w, x, turning);
        se3di_add(turning, tree->pull, turning);
        for (int32_t r = 0; r < rows; ++r) {
            const double *row = a->C + a->block_offset[k] + 6 * (size_t)kept[r];
            const size_t at = place * (size_t)rows + (size_t)r;
            double K[6], *to = loops->K + 6 * at;
            row_to_link(link, tree->model->frames[body].A, row, K);
            add_row_sizes(link, row, loops->size + 2 * at);
            weight[r] += row_weight(&tree->model->bodies[body], row);
            for (int i = 0; i < 6; ++i) {
                to[i] += K[i];
            }
            c[r] -= se3di_dot(row, turning);
        }
    }
}

/* y = K . S, exactly zero if it is rounding: a row that the tree implies is empty, and no equation
 * is made of what is left of it. */
static double without_noise(double y, const double s[6], const double size[2])
{
    double parts[2] = {0.0, 0.0};
    add_sizes(s, 1.0, parts);
    return fabs(y) <= NOISE * (parts[0] * size[0] + parts[1] * size[1]) ? 0.0 : y;
}

/* What a node's freedoms and its bias take from a row; the rest K is its parent's. */
static void pass_row(const se3di_tree *tree, int32_t node, double *K, double *size, double *Y,
                     int32_t stride, double *c)
{
    const se3di_tree_node *n = &tree->nodes[node];
    double bias[6];
    for (int32_t j = freedoms_of(n) - 1; j >= 0; --j) {
        const size_t v = n->v + (size_t)j;
        const double *s = tree->S + 6 * v, *U = tree->U + 6 * v;
        const double y = without_noise(se3di_dot(K, s) + se3di_dot(K + 3, s + 3), s, size);
        const double rate = y / tree->D[v];
        Y[j * stride] = y;
        for (int i = 0; i < 6; ++i) {
            K[i] -= U[i] * rate;
        }
        add_sizes(U, fabs(rate), size);
    }
    se3di_tree_bias(tree, (uint32_t)node, bias);
    *c -= se3di_dot(K, bias) + se3di_dot(K + 3, bias + 3);
    if (n->parent < 0) { /* the ground of a tree at which gravity pulls accelerates by -g */
        *c += se3di_dot(K + 3, tree->pull);
    }
}

static void carry_down(se3di_tree_loops *loops, uint32_t loop, double *Y, double *c)
{
    const se3di_tree *tree = loops->tree;
    const int32_t rows = loops->kept_count[loop];
    const int32_t begin = loops->path_begin[loop];
    for (int32_t p = begin; p < loops->path_begin[loop + 1]; ++p) {
        const int32_t node = loops->path_node[p], parent = loops->path_parent[p];
        const double *d = tree->links[node].d;
        for (int32_t r = 0; r < rows; ++r) {
            const size_t at = (size_t)((p - begin) * rows + r);
            double *K = loops->K + 6 * at, *size = loops->size + 2 * at;
            pass_row(tree, node, K, size, Y + r, rows, &c[r]);
            if (parent >= 0) {
                const size_t place = (size_t)(parent * rows + r);
                double *to = loops->K + 6 * place, x[3];
                se3di_cross(d, K + 3, x);
                loops->size[2 * place] += size[0] + size_of(d) * size[1];
                loops->size[2 * place + 1] += size[1];
                for (int i = 0; i < 3; ++i) {
                    to[i] += K[i] + x[i];
                    to[3 + i] += K[3 + i];
                }
            }
        }
        Y += rows * freedoms_of(&tree->nodes[node]);
    }
}

/* ---- the same by strips ---- */

/* Rows of a body into the lanes of K [6], of `weight`, and of c what its centre has on its own. */
static void load_lanes(const se3di_tree_loops *loops, const se3di_loop_strip *strip, int32_t entry,
                       double *K, size_t at)
{
    const se3di_assembly *a = loops->assembly;
    const se3di_tree *tree = loops->tree;
    const se3di_loop_system *system = &loops->system;
    const uint32_t body = a->free_body[a->joint_body[entry]];
    const se3di_body *own = &tree->model->bodies[body];
    const se3di_tree_link *link = &tree->links[tree->node_of[body]];
    const double *A = tree->model->frames[body].A;
    const double light = 1.0 / own->mass;
    const double slim[3] = {1.0 / own->J[0], 1.0 / own->J[1], 1.0 / own->J[2]};
    const int32_t *kept = loops->kept + loops->row_begin[strip->loop] + strip->first;
    double x[3], turning[3];
    se3di_cross(link->w, link->s, x);
    se3di_cross(link->w, x, turning);
    se3di_add(turning, tree->pull, turning);
    for (int32_t r = 0; r < strip->count; ++r) {
        const double *row = a->C + a->block_offset[entry] + 6 * (size_t)kept[r], *turns = row + 3;
        double own_row[6], weight = light * se3di_dot(row, row);
        row_to_link(link, A, row, own_row);
        for (int k = 0; k < 6; ++k) {
            K[SE3DI_STRIP * k + r] += own_row[k];
        }
        for (int k = 0; k < 3; ++k) {
            weight += slim[k] * turns[k] * turns[k];
        }
        system->weight[at + (size_t)r] += weight;
        system->c[at + (size_t)r] -= se3di_dot(row, turning);
    }
}

static void load_bodies(const se3di_tree_loops *loops, const se3di_loop_strip *strip,
                        const se3di_loop_path *path, size_t at)
{
    const se3di_assembly *a = loops->assembly;
    const se3di_tree *tree = loops->tree;
    const uint32_t constraint = loops->constraints[strip->loop];
    for (int32_t e = a->joint_begin[constraint]; e < a->joint_begin[constraint + 1]; ++e) {
        int32_t place = 0;
        while (path->node[place] != tree->node_of[a->free_body[a->joint_body[e]]]) {
            ++place;
        }
        load_lanes(loops, strip, e, loops->K + 6 * SE3DI_STRIP * (size_t)place, at);
    }
}

/* A strip from its bodies to the ground: Y, c, weight. */
static void carry_strip(se3di_tree_loops *loops, int32_t index)
{
    const se3di_tree *tree = loops->tree;
    const se3di_loop_system *system = &loops->system;
    const se3di_loop_strip *strip = &system->strips[index];
    const uint32_t constraint = loops->constraints[strip->loop];
    const double *gamma = loops->gamma + tree->model->constraints[constraint].row_begin;
    const int32_t *kept = loops->kept + loops->row_begin[strip->loop] + strip->first;
    const se3di_loop_path path = se3di_loop_path_of(loops, strip);
    const size_t at = SE3DI_STRIP * (size_t)index;
    memset(loops->K, 0, 6 * SE3DI_STRIP * (size_t)path.count * sizeof *loops->K);
    const int is_point = loops->points[strip->loop].is_there;
    for (int32_t r = 0; r < SE3DI_STRIP; ++r) {
        system->c[at + (size_t)r] = r < strip->count && !is_point ? gamma[kept[r]] : 0.0;
        system->weight[at + (size_t)r] = 0.0;
    }
    if (is_point) {
        se3di_tree_loops_load_point(loops, strip, loops->K, system->c + at, system->weight + at);
    } else {
        load_bodies(loops, strip, &path, at);
    }
    system->core->carry(tree, &path, loops->K, system->c + at,
                        system->Y + SE3DI_STRIP * (size_t)strip->Y);
}

void se3di_tree_loops_carry(se3di_tree_loops *loops)
{
    const se3di_loop_system *system = &loops->system;
    const int32_t in_teams = system->core->carry_team ? SE3DI_TEAM * system->team_count : 0;
    for (int32_t k = 0; k < in_teams; k += SE3DI_TEAM) {
        if (!se3di_tree_loops_carry_team(loops, k / SE3DI_TEAM)) {
            for (int32_t m = 0; m < SE3DI_TEAM; ++m) {
                carry_strip(loops, system->carried[k + m]);
            }
        }
    }
    for (int32_t k = in_teams; k < system->row_strips; ++k) {
        carry_strip(loops, system->carried[k]);
    }
}

static int factor_strips(se3di_tree_loops *loops)
{
    se3di_tree_loops_carry(loops);
    return se3di_loop_system_factor(&loops->system, loops->tree);
}

/* ---- all rows ---- */

/* out: those of the rows that are kept, of all loops one after the other; from `values` [rows of
 * the model]. */
static void gather_rows(const se3di_tree_loops *loops, const double *values, double *out)
{
    for (uint32_t k = 0; k < loops->count; ++k) {
        const uint32_t begin = loops->tree->model->constraints[loops->constraints[k]].row_begin;
        for (int32_t r = 0; r < loops->kept_count[k]; ++r) {
            *out++ = values[begin + (uint32_t)loops->kept[loops->row_begin[k] + (uint32_t)r]];
        }
    }
}

/* Multipliers of turned rows as those of the rows. */
static void turn_back(const se3di_tree_loops *loops, double *lambda)
{
    for (uint32_t k = 0; k < loops->count; ++k) {
        if (loops->turns[k].is_turned) {
            const uint32_t constraint = loops->constraints[k];
            se3di_tree_loops_turn_back(
                loops, k, lambda + loops->tree->model->constraints[constraint].row_begin);
        }
    }
}

/* The other way; rows that the tree implies get none. */
static void scatter_rows(const se3di_tree_loops *loops, const double *values, double *out)
{
    for (uint32_t k = 0; k < loops->count; ++k) {
        const uint32_t begin = loops->tree->model->constraints[loops->constraints[k]].row_begin;
        memset(out + begin, 0, (size_t)loops->rows[k] * sizeof *out);
        for (int32_t r = 0; r < loops->kept_count[k]; ++r) {
            out[begin + (uint32_t)loops->kept[loops->row_begin[k] + (uint32_t)r]] = *values++;
        }
    }
    turn_back(loops, out);
}

/* With the rows evaluated, by all of them and the KKT solver. */
static se3d_status factor_all(se3di_tree_loops *loops)
{
    se3di_tree *tree = loops->tree;
    gather_rows(loops, loops->gamma, loops->c);
    double *Y = loops->Y, *c = loops->c, *weight = loops->weight;
    for (uint32_t k = 0; k < loops->count; ++k) {
        load_rows(loops, k, c, weight);
        carry_down(loops, k, Y, c);
        Y += loops->kept_count[k] * (loops->member_begin[k + 1] - loops->member_begin[k]);
        c += loops->kept_count[k];
        weight += loops->kept_count[k];
    }
    for (uint32_t v = 0; v < tree->v_count; ++v) {
        loops->H[v] = tree->D[v];
    }
    for (uint32_t k = 0; k < tree->count; ++k) {
        if (tree->nodes[k].flags & SE3DI_TREE_GIVEN) {
            loops->H[tree->nodes[k].v] = 1.0; /* in no row */
            tree->e[tree->nodes[k].v] = 0.0;
        }
    }
    const se3di_kkt_values values = {.body = loops->H, .joint = loops->Y, .weight = loops->weight};
    return se3di_kkt_factor(loops->kkt, &values, NULL);
}

void se3di_tree_loops_eval_rows(se3di_tree_loops *loops)
{
    se3di_assembly_eval_some_rows(loops->assembly, loops->constraints, loops->count, loops->gamma);
    se3di_tree_loops_turn_rows(loops, 0);
    loops->is_aside = 0;
}

/* Only those that do not come from the links. */
static void eval_others(se3di_tree_loops *loops)
{
    if (loops->other_count > 0) {
        se3di_assembly_eval_some_rows(loops->assembly, loops->others, loops->other_count,
                                      loops->gamma);
        se3di_tree_loops_turn_rows(loops, 1);
    }
    loops->is_aside = loops->other_count < loops->count;
}

/* Rows that somebody has left out are not of the links. */
static int may_take_links(const se3di_tree_loops *loops)
{
    return loops->system.is_there && loops->tree->model->left_out_count == 0;
}

int se3di_tree_loops_need_links_only(const se3di_tree_loops *loops)
{
    return loops->other_count == 0 && may_take_links(loops);
}

int se3di_tree_loops_factor_links(se3di_tree_loops *loops)
{
    loops->is_aside = 1;
    loops->is_clear = factor_strips(loops);
    return loops->is_clear;
}

se3d_status se3di_tree_loops_factor(se3di_tree_loops *loops)
{
    if (may_take_links(loops)) {
        eval_others(loops);
        SE3DI_TRY(se3di_user_report(loops->tree->model, loops->error));
        loops->is_clear = factor_strips(loops);
        if (loops->is_clear) {
            return SE3D_OK;
        }
    }
    se3di_tree_loops_eval_rows(loops);
    SE3DI_TRY(se3di_user_report(loops->tree->model, loops->error));
    loops->is_clear = 0;
    return factor_all(loops);
}

int32_t se3di_tree_loops_count_dependent(const se3di_tree_loops *loops)
{
    return loops->is_clear ? 0 : se3di_kkt_get_dependent_rows(loops->kkt);
}

static se3d_status solve(se3di_tree_loops *loops, const double *b, const double *c)
{
    const se3di_kkt_values values = {.body = loops->H, .joint = loops->Y, .weight = loops->weight};
    se3di_kkt_solve_info info = {0};
    const se3d_status status =
        se3di_kkt_solve(loops->kkt, &values, b, c, loops->y, loops->l, &info);
    /* c may be all rounding; the caller checks what it needs of the rows */
    return status == SE3D_ERR_NO_CONVERGENCE && !(info.residual_b > 1e-6) ? SE3D_OK : status;
}

/* lambda of the strips to the places of their rows in the model. */
static se3d_status scatter_strips(se3di_tree_loops *loops)
{
    const se3di_loop_system *system = &loops->system;
    const se3di_constraint *constraints = loops->tree->model->constraints;
    double sum = 0.0;
    for (uint32_t k = 0; k < loops->count && !loops->is_whole; ++k) {
        memset(loops->lambda + constraints[loops->constraints[k]].row_begin, 0,
               (size_t)loops->rows[k] * sizeof *loops->lambda);
    }
    for (int32_t k = 0; k < system->row_strips; ++k) {
        const se3di_loop_strip *strip = &system->strips[k];
        const int32_t *kept = loops->kept + loops->row_begin[strip->loop] + strip->first;
        double *lambda = loops->lambda + constraints[loops->constraints[strip->loop]].row_begin;
        for (int32_t r = 0; r < strip->count; ++r) {
            lambda[kept[r]] = system->z[SE3DI_STRIP * k + r];
            sum += 0.0 * lambda[kept[r]];
        }
    }
    turn_back(loops, loops->lambda);
    return sum == 0.0 ? SE3D_OK : SE3D_ERR_NOT_FINITE;
}

se3d_status se3di_tree_loops_accelerate(se3di_tree_loops *loops, double *qddot)
{
    se3di_tree *tree = loops->tree;
    if (loops->is_clear) {
        memcpy(loops->b, tree->e, tree->v_count * sizeof *loops->b);
        se3di_loop_system_solve(&loops->system, tree, loops->b);
        SE3DI_TRY(scatter_strips(loops));
        se3di_tree_accelerate(tree, loops->b, qddot);
        return SE3D_OK;
    }
    const se3d_status status = solve(loops, tree->e, loops->c);
    SE3DI_TRY(status);
    scatter_rows(loops, loops->l, loops->lambda);
    for (uint32_t v = 0; v < tree->v_count; ++v) {
        loops->b[v] = tree->D[v] * loops->y[v];
    }
    se3di_tree_accelerate(tree, loops->b, qddot);
    return status;
}

/* ---- corrections ---- */

/* Phi of the rows that are kept, and of all that are turned, into gamma. */
static void eval_phi(se3di_tree_loops *loops)
{
    const se3di_model *model = loops->tree->model;
    for (uint32_t k = 0; k < loops->count; ++k) {
        const uint32_t begin = model->constraints[loops->constraints[k]].row_begin;
        const int is_turned = loops->turns[k].is_turned;
        for (int32_t r = 0; r < (is_turned ? loops->rows[k] : loops->kept_count[k]); ++r) {
            const int32_t own = is_turned ? r : loops->kept[loops->row_begin[k] + (uint32_t)r];
            const size_t row = begin + (size_t)own;
            loops->gamma[row] =
                se3di_row_violation(model, &model->rows[row], loops->assembly->f[3 * row]);
        }
        if (is_turned) {
            se3di_tree_loops_turn(loops, k, loops->gamma + begin, 1);
        }
    }
    se3di_user_eval_phi(loops->assembly, loops->gamma);
}

double se3di_tree_loops_eval_gap(se3di_tree_loops *loops, double length, double *c)
{
    const se3di_model *model = loops->tree->model;
    double worst = 0.0;
    eval_phi(loops);
    for (uint32_t k = 0; k < loops->count; ++k) {
        const uint32_t begin = model->constraints[loops->constraints[k]].row_begin;
        for (int32_t r = 0; r < loops->kept_count[k]; ++r) {
            const uint32_t row = begin + (uint32_t)loops->kept[loops->row_begin[k] + (uint32_t)r];
            const double gap = fabs(loops->gamma[row]) / se3di_row_get_scale(model, row, length);
            worst = gap <= worst ? worst : gap; /* NaN stays */
            *c++ = -loops->gamma[row];
        }
    }
    return worst;
}

double se3di_tree_loops_eval_rate_gap(const se3di_tree_loops *loops, double length, double rate,
                                      double *c)
{
    const se3di_assembly *a = loops->assembly;
    const se3di_model *model = loops->tree->model;
    double worst = 0.0;
    for (uint32_t k = 0; k < loops->count; ++k) {
        const uint32_t constraint = loops->constraints[k];
        for (int32_t r = 0; r < loops->kept_count[k]; ++r) {
            const uint32_t own = (uint32_t)loops->kept[loops->row_begin[k] + (uint32_t)r];
            const uint32_t row = model->constraints[constraint].row_begin + own;
            double sum = a->f[3 * (size_t)row + 1];
            for (int32_t e = a->joint_begin[constraint]; e < a->joint_begin[constraint + 1]; ++e) {
                const se3di_frame *frame = &model->frames[a->free_body[a->joint_body[e]]];
                const double *C = a->C + a->block_offset[e] + 6 * (size_t)own;
                sum -= se3di_dot(C, frame->v) + se3di_dot(C + 3, frame->w);
            }
            const double gap = fabs(sum) / (rate * se3di_row_get_scale(model, row, length));
            worst = gap <= worst ? worst : gap;
            *c++ = sum;
        }
    }
    return worst;
}

/* c as rows of strips. */
static void take_strips(se3di_tree_loops *loops, const double *c)
{
    const se3di_loop_system *system = &loops->system;
    for (int32_t k = 0; k < system->row_strips; ++k) {
        const se3di_loop_strip *strip = &system->strips[k];
        for (int32_t r = 0; r < strip->count; ++r) {
            system->c[SE3DI_STRIP * k + r] = c[loops->kept_begin[strip->loop] + strip->first + r];
        }
    }
}

se3d_status se3di_tree_loops_correct(se3di_tree_loops *loops, const double *c, double *dq)
{
    const se3di_tree *tree = loops->tree;
    se3d_status status = SE3D_OK;
    if (loops->is_clear) {
        take_strips(loops, c);
        memset(dq, 0, tree->v_count * sizeof *dq);
        se3di_loop_system_solve(&loops->system, tree, dq);
        for (uint32_t v = 0; v < tree->v_count; ++v) {
            dq[v] *= tree->R[v];
        }
    } else {
        memset(loops->b, 0, tree->v_count * sizeof *loops->b);
        status = solve(loops, loops->b, c);
        SE3DI_TRY(status);
        memcpy(dq, loops->y, tree->v_count * sizeof *dq);
    }
    se3di_tree_spread(tree, dq, dq);
    return status;
}

/* The parts of a loop, from `head` where it is turned: its first three multipliers. */
static void add_loop_wrenches(const se3di_tree_loops *loops, uint32_t loop, const double *l,
                              const double *head, int driven, double *wrench)
{
    const se3di_assembly *a = loops->assembly;
    const se3di_tree *tree = loops->tree;
    const uint32_t constraint = loops->constraints[loop];
    const int32_t turned = head ? 3 : 0;
    for (int32_t k = a->joint_begin[constraint]; k < a->joint_begin[constraint + 1]; ++k) {
        const uint32_t body = a->free_body[a->joint_body[k]];
        const int32_t node = tree->node_of[body];
        double sum[6] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, K[6];
        if (driven && !tree->nodes[node].is_driven) {
            continue;
        }
        for (int32_t r = 0; r < loops->rows[loop]; ++r) {
            const double own = r < turned ? head[r] : l[r];
            for (size_t i = 0; i < 6; ++i) {
                sum[i] += own * a->C[a->block_offset[k] + 6 * (size_t)r + i];
            }
        }
        row_to_link(&tree->links[node], tree->model->frames[body].A, sum, K);
        for (size_t i = 0; i < 6; ++i) {
            wrench[6 * (size_t)node + i] -= K[i];
        }
    }
}

static int touches_driven(const se3di_tree_loops *loops, uint32_t loop)
{
    const se3di_assembly *a = loops->assembly;
    const uint32_t constraint = loops->constraints[loop];
    int touches = 0;
    for (int32_t k = a->joint_begin[constraint]; k < a->joint_begin[constraint + 1]; ++k) {
        const int32_t node = loops->tree->node_of[a->free_body[a->joint_body[k]]];
        touches |= loops->tree->nodes[node].is_driven;
    }
    return touches;
}

void se3di_tree_loops_add_wrenches(se3di_tree_loops *loops, const double *lambda, int driven,
                                   double *wrench)
{
    for (uint32_t loop = 0; loop < loops->count; ++loop) {
        const uint32_t constraint = loops->constraints[loop];
        const double *l = lambda + loops->tree->model->constraints[constraint].row_begin;
        const int is_turned = loops->turns[loop].is_turned != 0;
        double head[3];
        if (driven && !touches_driven(loops, loop)) {
            continue;
        }
        if (loops->is_aside) {
            se3di_tree_loops_eval_rows(loops);
        }
        if (is_turned) {
            se3di_copy(l, head);
            se3di_tree_loops_turn(loops, loop, head, 1);
        }
        add_loop_wrenches(loops, loop, l, is_turned ? head : NULL, driven, wrench);
    }
}

/* Of the rows of a body: the freedoms between it and the ground, and the rounding of each. */
static void add_jacobian(const se3di_tree *tree, uint32_t body, const double row[6], double *G,
                         double *noise)
{
    int32_t node = tree->node_of[body];
    double K[6], size[2] = {0.0, 0.0};
    row_to_link(&tree->links[node], tree->model->frames[body].A, row, K);
    add_row_sizes(&tree->links[node], row, size);
    while (node >= 0) {
        const se3di_tree_node *n = &tree->nodes[node];
        double x[3];
        for (int32_t j = 0; j < n->v_count; ++j) {
            const double *s = tree->S + 6 * (n->v + (size_t)j);
            double parts[2] = {0.0, 0.0};
            add_sizes(s, 1.0, parts);
            G[n->v + (size_t)j] += se3di_dot(K, s) + se3di_dot(K + 3, s + 3);
            noise[n->v + (size_t)j] += NOISE * (parts[0] * size[0] + parts[1] * size[1]);
        }
        size[0] += size_of(tree->links[node].d) * size[1];
        se3di_cross(tree->links[node].d, K + 3, x);
        se3di_add(K, x, K);
        node = n->parent;
    }
}

void se3di_tree_loops_row(const se3di_tree_loops *loops, uint32_t loop, size_t row, double *G)
{
    const se3di_assembly *a = loops->assembly;
    const size_t columns = loops->tree->v_count;
    const uint32_t constraint = loops->constraints[loop];
    memset(loops->noise, 0, columns * sizeof *loops->noise);
    for (int32_t k = a->joint_begin[constraint]; k < a->joint_begin[constraint + 1]; ++k) {
        add_jacobian(loops->tree, a->free_body[a->joint_body[k]],
                     a->C + a->block_offset[k] + 6 * row, G, loops->noise);
    }
    for (size_t v = 0; v < columns; ++v) {
        G[v] = fabs(G[v]) <= loops->noise[v] ? 0.0 : G[v];
    }
}

void se3di_tree_loops_jacobian(const se3di_tree_loops *loops, double *G)
{
    const size_t columns = loops->tree->v_count;
    memset(G, 0, loops->row_count * columns * sizeof *G);
    for (uint32_t loop = 0; loop < loops->count; ++loop) {
        for (size_t row = 0; row < (size_t)loops->rows[loop]; ++row) {
            se3di_tree_loops_row(loops, loop, row, G + (loops->row_begin[loop] + row) * columns);
        }
    }
}
