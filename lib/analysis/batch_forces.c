/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches: force elements that lanes can compute, in the coordinates of the tree: a spring or an
 * effort on a coordinate is a law of it, points are counted from joint points. If one element is
 * something else, all are evaluated state by state.              docs/theory/lanes.md */
#include "analysis/batch.h"

#include "math/vec3.h"

static int has_functions(const se3di_force *force)
{
    int found = 0;
    for (int k = 0; k < SE3DI_FORCE_FUNCTIONS; ++k) {
        found |= force->function[k] >= 0;
    }
    return found;
}

/* A law of the coordinate that an rsda or effort acts on; 0: it is none of the tree's. */
static int add_law(se3di_batch *b, const se3di_force *force)
{
    const se3di_tree *tree = &b->tree;
    for (uint32_t k = 0; k < tree->count; ++k) {
        const se3di_tree_node *n = &tree->nodes[k];
        const int is_its = force->joint >= 0 ? n->constraint == force->joint
                                             : force->angle >= 0 && n->angle == force->angle;
        const int32_t component = is_its ? se3di_tree_component(n, force->coordinate) : -1;
        if (component < 0) {
            continue;
        }
        const int is_effort = force->type == SE3DI_FORCE_EFFORT;
        b->laws[b->law_count++] =
            (se3di_lane_law){.q = n->q + (uint32_t)component,
                             .v = n->v + (uint32_t)component,
                             .k = is_effort ? 0.0 : force->k,
                             .c = is_effort ? 0.0 : force->c,
                             .rest = is_effort ? 0.0 : force->rest,
                             .preload = is_effort ? -force->value[0] : force->preload};
        return 1;
    }
    return 0;
}

static se3di_lane_point find_point(const se3di_batch *b, uint32_t body, const double local[3])
{
    const int32_t node = b->tree.node_of[body];
    se3di_lane_point p = {.node = node};
    if (node < 0) {
        const se3di_frame *frame = &b->model->frames[body];
        se3di_mul(frame->A, local, p.at);
        se3di_add(p.at, frame->r, p.at);
    } else {
        const se3di_tree_node *n = &b->tree.nodes[node];
        se3di_tree_to_triad(n, local, p.at);
        se3di_add(p.at, n->s, p.at);
    }
    return p;
}

static int add_spring(se3di_batch *b, const se3di_force *force)
{
    b->springs[b->spring_count++] =
        (se3di_lane_spring){.i = find_point(b, force->body_i, force->s_i),
                            .j = find_point(b, force->body_j, force->s_j),
                            .k = force->k,
                            .c = force->c,
                            .rest = force->rest,
                            .preload = force->preload};
    return 1;
}

/* On a fixed body it does nothing. */
static int add_load(se3di_batch *b, const se3di_force *force)
{
    static const double centre[3] = {0.0, 0.0, 0.0};
    const int is_torque = force->type == SE3DI_FORCE_TORQUE;
    const int32_t node = b->tree.node_of[force->body_j];
    double value[3];
    if (node < 0) {
        return 1;
    }
    se3di_copy(force->value, value);
    if (force->in_body_frame) {
        se3di_tree_to_triad(&b->tree.nodes[node], force->value, value);
    }
    se3di_lane_load *load = &b->loads[b->load_count++];
    *load =
        (se3di_lane_load){.point = find_point(b, force->body_j, is_torque ? centre : force->s_j),
                          .in_triad = force->in_body_frame};
    se3di_copy(value, is_torque ? load->torque : load->force);
    return 1;
}

/* 0: lanes cannot compute it. */
static int add_force(se3di_batch *b, const se3di_force *force)
{
    if (has_functions(force)) {
        return 0;
    }
    switch (force->type) {
    case SE3DI_FORCE_ARMATURE:
        return 1; /* the tree has it */
    case SE3DI_FORCE_RSDA:
    case SE3DI_FORCE_EFFORT:
        return add_law(b, force);
    case SE3DI_FORCE_TSDA:
        return add_spring(b, force);
    case SE3DI_FORCE_LOAD:
    case SE3DI_FORCE_TORQUE:
        return add_load(b, force);
    default:
        return 0;
    }
}

se3d_status se3di_batch_take_forces(se3di_batch *batch)
{
    se3di_batch *b = batch;
    const se3di_model *model = b->model;
    const size_t count = model->force_slots.count;
    const se3d_allocator *allocator = &model->allocator;
    b->springs = se3di_alloc(allocator, count, sizeof *b->springs);
    b->loads = se3di_alloc(allocator, count, sizeof *b->loads);
    b->laws = se3di_alloc(allocator, count, sizeof *b->laws);
    if (!b->springs || !b->loads || !b->laws) {
        return SE3D_ERR_NO_MEMORY;
    }
    b->is_in_lanes = 1;
    for (size_t k = 0; k < count; ++k) {
        b->is_in_lanes &= add_force(b, &model->forces[k]);
    }
    for (int c = 0; c < 3; ++c) {
        b->is_in_lanes &= model->gravity_function[c] < 0;
    }
    if (!b->is_in_lanes) {
        b->spring_count = b->load_count = b->law_count = 0;
    }
    return SE3D_OK;
}

void se3di_batch_drop_forces(se3di_batch *batch)
{
    const se3d_allocator *allocator = &batch->model->allocator;
    const size_t count = batch->model->force_slots.count;
    se3di_free(allocator, batch->springs, count, sizeof *batch->springs);
    se3di_free(allocator, batch->loads, count, sizeof *batch->loads);
    se3di_free(allocator, batch->laws, count, sizeof *batch->laws);
}
