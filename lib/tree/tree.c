/* SPDX-License-Identifier: BSD-3-Clause */
/* The spanning tree, its memory, and what it takes from the model.
 *
 * Joints wait in one queue for each number of freedoms, fewest first, from the time that one of
 * their bodies is reached; nodes are numbered along the branches, so that most parents are the
 * number before.                                             docs/theory/joint_coordinates.md */
#include "tree/tree.h"

#include "joint/joint.h"
#include "model/state.h"
#include "primitive/user.h"
#include "tree/core.h"
#include "tree/packs.h"

#include <string.h>

#define FREEDOMS_MAX 3 /* of a joint that may be on the tree */

static const int32_t position_count[SE3DI_TREE_JOINT_COUNT] = {
#define SE3DI_TREE_POSITIONS(NAME, name, positions, velocities) positions,
    SE3DI_TREE_JOINT_LIST(SE3DI_TREE_POSITIONS)
#undef SE3DI_TREE_POSITIONS
};

static const int32_t velocity_count[SE3DI_TREE_JOINT_COUNT] = {
#define SE3DI_TREE_VELOCITIES(NAME, name, positions, velocities) velocities,
    SE3DI_TREE_JOINT_LIST(SE3DI_TREE_VELOCITIES)
#undef SE3DI_TREE_VELOCITIES
};

/* ---- which joints may be on a tree ---- */

static int32_t type_of(const se3di_model *model, uint32_t constraint)
{
    static const char *const names[SE3DI_TREE_JOINT_COUNT] = {
#define SE3DI_TREE_NAME(NAME, name, positions, velocities) #name,
        SE3DI_TREE_JOINT_LIST(SE3DI_TREE_NAME)
#undef SE3DI_TREE_NAME
    };
    const se3di_constraint *c = &model->constraints[constraint];
    int32_t type = -1;
    for (int32_t k = SE3DI_TREE_FIXED; k < SE3DI_TREE_JOINT_COUNT && type < 0; ++k) {
        type = strcmp(c->type, names[k]) == 0 ? k : -1;
    }
    for (uint32_t r = 0; type >= 0 && r < c->row_count; ++r) {
        if (model->rows[c->row_begin + r].left_out) {
            return -1; /* what another loop makes redundant is not held exactly */
        }
    }
    return type >= 0 && c->body_count == 2 && c->bodies[0] != c->bodies[1] ? type : -1;
}

/* ---- building ---- */

/* Joints of each body in turn, and what waits. */
typedef struct builder {
    se3di_tree *tree;
    uint32_t *begin, *list; /* [bodies + 1], [2 joints] */
    uint32_t *queue;        /* [freedoms + 1][joints] */
    uint32_t head[FREEDOMS_MAX + 1], tail[FREEDOMS_MAX + 1];
    int32_t *parent, *joint;                  /* [bodies]: -1 not reached, or the ground; */
    int32_t *first_child, *last_child, *next; /* [bodies]: in the order of reaching */
    int8_t *is_reached;
    int8_t *is_queued, *type, *is_heavy; /* [constraints]; heavy: there is an armature on it */
    uint32_t bodies, constraints;
} builder;

#define BUILDER_ARRAYS 12

static void list_builder(builder *b, se3di_array list[BUILDER_ARRAYS])
{
    const size_t n = b->bodies, m = b->constraints;
    const se3di_array arrays[] = {
        {(void **)&b->begin, n + 1, sizeof *b->begin},
        {(void **)&b->list, 2 * m, sizeof *b->list},
        {(void **)&b->queue, (FREEDOMS_MAX + 1) * m, sizeof *b->queue},
        {(void **)&b->parent, n, sizeof *b->parent},
        {(void **)&b->joint, n, sizeof *b->joint},
        {(void **)&b->first_child, n + 1, sizeof *b->first_child},
        {(void **)&b->last_child, n + 1, sizeof *b->last_child},
        {(void **)&b->next, n, sizeof *b->next},
        {(void **)&b->is_reached, n, sizeof *b->is_reached},
        {(void **)&b->is_queued, m, sizeof *b->is_queued},
        {(void **)&b->type, m, sizeof *b->type},
        {(void **)&b->is_heavy, m, sizeof *b->is_heavy},
    };
    _Static_assert(sizeof arrays == BUILDER_ARRAYS * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void list_joints(builder *b, const se3di_model *model)
{
    for (uint32_t k = 0; k < b->constraints; ++k) {
        b->type[k] = (int8_t)type_of(model, k);
        for (int side = 0; b->type[k] >= 0 && side < 2; ++side) {
            ++b->begin[model->constraints[k].bodies[side] + 1];
        }
    }
    for (uint32_t k = 0; k < b->bodies; ++k) {
        b->begin[k + 1] += b->begin[k];
    }
    /* from the end: the end of each body's joints becomes their beginning */
    const uint32_t total = b->begin[b->bodies];
    for (uint32_t k = b->constraints; k-- > 0;) {
        for (int side = 0; b->type[k] >= 0 && side < 2; ++side) {
            b->list[--b->begin[model->constraints[k].bodies[side] + 1]] = k;
        }
    }
    for (uint32_t k = 0; k < b->bodies; ++k) {
        b->begin[k] = b->begin[k + 1];
    }
    b->begin[b->bodies] = total;
}

static void forget_all(builder *b)
{
    for (uint32_t k = 0; k < b->bodies; ++k) {
        b->parent[k] = b->joint[k] = b->next[k] = -1;
        b->tree->node_of[k] = -1;
        b->is_reached[k] = 0;
    }
    for (uint32_t k = 0; k <= b->bodies; ++k) {
        b->first_child[k] = b->last_child[k] = -1;
    }
    for (uint32_t k = 0; k < b->constraints; ++k) {
        b->tree->tree_of[k] = -1;
        b->is_queued[k] = 0;
    }
    memset(b->head, 0, sizeof b->head);
    memset(b->tail, 0, sizeof b->tail);
}

static void reach(builder *b, uint32_t body)
{
    b->is_reached[body] = 1;
    for (uint32_t k = b->begin[body]; k < b->begin[body + 1]; ++k) {
        const uint32_t joint = b->list[k];
        if (!b->is_queued[joint]) {
            const int32_t freedoms = b->is_heavy[joint] ? 0 : velocity_count[b->type[joint]];
            b->is_queued[joint] = 1;
            b->queue[(uint32_t)freedoms * b->constraints + b->tail[freedoms]++] = joint;
        }
    }
}

static void adopt(builder *b, uint32_t body, int32_t parent, int32_t joint)
{
    const uint32_t place = parent < 0 ? b->bodies : (uint32_t)parent;
    b->parent[body] = parent;
    b->joint[body] = joint;
    if (b->last_child[place] >= 0) {
        b->next[b->last_child[place]] = (int32_t)body;
    } else {
        b->first_child[place] = (int32_t)body;
    }
    b->last_child[place] = (int32_t)body;
    reach(b, body);
}

/* Take all joints that lead further. */
static void spread(builder *b)
{
    const se3di_model *model = b->tree->model;
    for (int k = 0; k <= FREEDOMS_MAX;) {
        if (b->head[k] == b->tail[k]) {
            ++k;
            continue;
        }
        const uint32_t joint = b->queue[(uint32_t)k * b->constraints + b->head[k]++];
        const uint32_t *sides = model->constraints[joint].bodies;
        const int to = b->is_reached[sides[1]] ? 0 : 1;
        if (!b->is_reached[sides[to]]) {
            const uint32_t from = sides[1 - to];
            adopt(b, sides[to], model->bodies[from].fixed ? -1 : (int32_t)from, (int32_t)joint);
        }
        k = 0;
    }
}

static void span(builder *b)
{
    const se3di_model *model = b->tree->model;
    for (uint32_t k = 0; k < b->bodies; ++k) {
        if (!se3di_body_moves(&model->bodies[k], b->tree->moves_states)) {
            reach(b, k);
        }
    }
    spread(b);
    for (uint32_t k = 0; k < b->bodies; ++k) {
        if (!b->is_reached[k]) {
            adopt(b, k, -1, -1);
            spread(b);
        }
    }
}

/* The joint of an armature is on the tree, or between bodies that do not move. */
static int has_joint(const builder *b, const se3di_force *force)
{
    const uint32_t sides[2] = {force->body_i, force->body_j};
    int found = 1;
    for (int k = 0; k < 2; ++k) {
        found &= !se3di_body_moves(&b->tree->model->bodies[sides[k]], b->tree->moves_states);
    }
    for (int k = 0; k < 2; ++k) {
        found |= b->joint[sides[k]] == force->joint;
    }
    return found;
}

/* Armatures are parts of the mass matrix of the tree only where their joints are on it: if the tree
 * lacks one it is made again with these joints first, which leaves as few as there can be. */
static void span_armatures(builder *b)
{
    const se3di_model *model = b->tree->model;
    int lacks = 0;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        if (force->type == SE3DI_FORCE_ARMATURE) {
            b->is_heavy[force->joint] = 1;
            lacks |= !has_joint(b, force);
        }
    }
    if (lacks) {
        forget_all(b);
        span(b);
    }
}

static void add_node(builder *b, uint32_t body)
{
    se3di_tree *tree = b->tree;
    const se3di_model *model = tree->model;
    const int32_t joint = b->joint[body];
    se3di_tree_node *n = &tree->nodes[tree->count];
    *n = (se3di_tree_node){.body = body,
                           .parent = -1,
                           .constraint = joint,
                           .type = model->bodies[body].state != 0 ? SE3DI_TREE_CARRIER
                                                                  : SE3DI_TREE_FREE,
                           .angle = -1,
                           .driver = -1,
                           .branch = -1,
                           .child = -1,
                           .before = -1,
                           .q = tree->q_count,
                           .v = tree->v_count,
                           .B = {1.0, 0.0, 0.0, 0.0}};
    if (joint >= 0) {
        const se3di_constraint *c = &model->constraints[joint];
        n->type = b->type[joint];
        n->is_reversed = c->bodies[0] == body;
        n->parent_body = c->bodies[n->is_reversed];
        n->angle = n->type == SE3DI_TREE_PRISMATIC ? -1 : c->angle;
        tree->tree_of[joint] = (int32_t)tree->count;
    }
    tree->has_states |= model->bodies[body].state != 0;
    n->q_count = position_count[n->type];
    n->v_count = velocity_count[n->type];
    tree->q_count += (uint32_t)n->q_count;
    tree->v_count += (uint32_t)n->v_count;
    tree->node_of[body] = (int32_t)tree->count++;
    if (b->parent[body] >= 0) {
        n->parent = tree->node_of[b->parent[body]];
        se3di_tree_node *parent = &tree->nodes[n->parent];
        n->before = parent->child;
        parent->child = tree->node_of[body];
        if (n->parent + 1 != tree->node_of[body] && parent->branch < 0) {
            parent->branch = (int32_t)tree->branch_count++;
        }
    }
}

/* Along the branches; without recursion, which a long chain would make deep. */
static void number(builder *b)
{
    int32_t body = b->first_child[b->bodies];
    while (body >= 0) {
        add_node(b, (uint32_t)body);
        int32_t to = b->first_child[body];
        while (to < 0 && body >= 0) {
            to = b->next[body];
            body = b->parent[body];
        }
        body = to;
    }
}

/* A driver of a joint with one freedom prescribes it; of two, the older. */
static void find_drivers(se3di_tree *tree)
{
    const se3di_model *model = tree->model;
    for (uint32_t k = 0; k < tree->constraint_count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        const int32_t joint =
            strcmp(c->type, "driver") == 0 && !se3di_is_user(c) ? c->joints[0] : -1;
        const int32_t node = joint >= 0 ? tree->tree_of[joint] : -1;
        if (node < 0 || model->rows[c->row_begin].left_out) {
            continue;
        }
        se3di_tree_node *n = &tree->nodes[node];
        const int is_angle =
            model->terms[model->rows[c->row_begin].term_begin].type == SE3DI_PRIMITIVE_ANGLE;
        if (n->v_count == 1 && n->driver < 0 && is_angle == (n->type != SE3DI_TREE_PRISMATIC)) {
            n->driver = (int32_t)k;
            n->flags |= SE3DI_TREE_GIVEN;
            tree->tree_of[k] = node;
            ++tree->given_count;
        }
    }
}

/* Parents come before their children. */
static void find_driven(se3di_tree *tree)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        se3di_tree_node *n = &tree->nodes[k];
        n->is_driven = n->driver >= 0 || (n->parent >= 0 && tree->nodes[n->parent].is_driven);
    }
}

/* The coordinates of the tree that efforts act on. */
static void find_efforts(se3di_tree *tree)
{
    for (uint32_t k = 0; k < tree->force_count; ++k) {
        const se3di_force *force = &tree->model->forces[k];
        const int is_effort = force->type == SE3DI_FORCE_EFFORT;
        const int32_t place = is_effort ? tree->tree_of[force->joint] : -1;
        const se3di_tree_node *n = place >= 0 ? &tree->nodes[place] : NULL;
        const int32_t component = n ? se3di_tree_component(n, force->coordinate) : -1;
        tree->along[k] = component < 0 ? -1 : (int32_t)n->v + component;
        tree->has_efforts |= component >= 0;
        tree->has_others |= is_effort && component < 0;
    }
}

/* ---- memory ---- */

#define TREE_STRUCTURE 5
#define TREE_VALUES    22

static void list_structure(se3di_tree *t, se3di_array list[TREE_STRUCTURE])
{
    const se3di_array arrays[] = {
        {(void **)&t->nodes, t->body_count, sizeof *t->nodes},
        {(void **)&t->node_of, t->body_count, sizeof *t->node_of},
        {(void **)&t->tree_of, t->constraint_count, sizeof *t->tree_of},
        {(void **)&t->along, t->force_count, sizeof *t->along},
        {(void **)&t->counted, t->angle_count, sizeof *t->counted},
    };
    _Static_assert(sizeof arrays == TREE_STRUCTURE * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void list_values(se3di_tree *t, se3di_array list[TREE_VALUES])
{
    const size_t v = t->v_count, number_size = sizeof(double);
    const se3di_array arrays[] = {
        {(void **)&t->links, t->count, sizeof *t->links},
        {(void **)&t->S, 6 * v, number_size},
        {(void **)&t->U, 6 * v, number_size},
        {(void **)&t->D, v, number_size},
        {(void **)&t->R, v, number_size},
        {(void **)&t->V, 6 * v, number_size},
        {(void **)&t->k, v, number_size},
        {(void **)&t->e, v, number_size},
        {(void **)&t->given, v, number_size},
        {(void **)&t->effort, v, number_size},
        {(void **)&t->effort_before, v, number_size},
        {(void **)&t->armature, v, number_size},
        {(void **)&t->wrench, 6 * (size_t)t->count, number_size},
        {(void **)&t->q, t->q_count, number_size},
        {(void **)&t->qdot, v, number_size},
        {(void **)&t->qddot, v, number_size},
        {(void **)&t->branches, t->branch_count, sizeof *t->branches},
        {(void **)&t->passed, t->count, sizeof *t->passed},
        {(void **)&t->scratch, 12 * (size_t)t->count, number_size},
        {(void **)&t->frames, t->body_count, sizeof *t->frames},
        {(void **)&t->steps, t->count, sizeof *t->steps},
        {(void **)&t->keys, 4 * (size_t)t->count, sizeof *t->keys},
    };
    _Static_assert(sizeof arrays == TREE_VALUES * sizeof *arrays, "all of them");
    memcpy(list, arrays, sizeof arrays);
}

static void choose_core(se3di_tree *tree)
{
    const se3di_tree_core *avx512 = se3di_tree_core_avx512(), *avx2 = se3di_tree_core_avx2();
    tree->core = avx512 ? avx512 : avx2 ? avx2 : se3di_tree_core_portable();
}

static se3d_status build(se3di_tree *tree)
{
    const se3d_allocator *allocator = &tree->model->allocator;
    builder b = {.tree = tree, .bodies = tree->body_count, .constraints = tree->constraint_count};
    se3di_array arrays[BUILDER_ARRAYS];
    se3di_array structure[TREE_STRUCTURE];
    se3di_array values[TREE_VALUES];
    list_structure(tree, structure);
    SE3DI_TRY(se3di_arrays_alloc(allocator, structure, TREE_STRUCTURE));
    list_builder(&b, arrays);
    const se3d_status status = se3di_arrays_alloc(allocator, arrays, BUILDER_ARRAYS);
    if (status >= 0) {
        forget_all(&b);
        list_joints(&b, tree->model);
        span(&b);
        span_armatures(&b);
        number(&b);
        find_drivers(tree);
        find_driven(tree);
        find_efforts(tree);
    }
    se3di_arrays_free(allocator, arrays, BUILDER_ARRAYS);
    SE3DI_TRY(status);
    list_values(tree, values);
    SE3DI_TRY(se3di_arrays_alloc(allocator, values, TREE_VALUES));
    tree->pack_max = tree->core->has_packs ? se3di_tree_count_packs(tree) : 0;
    tree->packs = se3di_alloc(allocator, tree->pack_max, sizeof *tree->packs);
    return tree->packs ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

/* Planar joints turn by their third coordinate. */
static void find_counted(se3di_tree *tree)
{
    for (size_t k = 0; k < tree->angle_count; ++k) {
        tree->counted[k] = -1;
    }
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        if (n->angle >= 0) {
            tree->counted[n->angle] = (int32_t)n->q + (n->type == SE3DI_TREE_PLANAR ? 2 : 0);
        }
    }
}

se3d_status se3di_tree_init(se3di_tree *tree, se3di_model *model, int moves_states,
                            se3di_error *error)
{
    *tree = (se3di_tree){.model = model,
                         .topology_version = model->topology_version,
                         .break_version = model->break_version,
                         .moves_states = moves_states,
                         .acts = 1,
                         .body_count = (uint32_t)model->body_slots.count,
                         .constraint_count = (uint32_t)model->constraint_slots.count,
                         .force_count = (uint32_t)model->force_slots.count,
                         .angle_count = (uint32_t)model->angle_count};
    choose_core(tree);
    const se3d_status status = build(tree);
    if (status < 0) {
        se3di_tree_destroy(tree);
        return se3di_error_set(error, status, "no memory for the tree of %zu bodies",
                               model->body_slots.count);
    }
    find_counted(tree);
    se3di_tree_refresh(tree);
    return SE3D_OK;
}

void se3di_tree_destroy(se3di_tree *tree)
{
    if (!tree->model) {
        return;
    }
    const se3d_allocator *allocator = &tree->model->allocator;
    se3di_array structure[TREE_STRUCTURE];
    se3di_array values[TREE_VALUES];
    se3di_free(allocator, tree->packs, tree->pack_max, sizeof *tree->packs);
    list_values(tree, values);
    se3di_arrays_free(allocator, values, TREE_VALUES);
    list_structure(tree, structure);
    se3di_arrays_free(allocator, structure, TREE_STRUCTURE);
    memset(tree, 0, sizeof *tree);
}
