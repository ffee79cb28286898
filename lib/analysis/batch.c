/* SPDX-License-Identifier: BSD-3-Clause */
/* Batches: what they may be made of, their memory, and numbers in and out. docs/theory/lanes.md */
#include "analysis/batch.h"

#include "contact/bodies/body_contacts.h"
#include "force/force.h"
#include "math/quaternion.h"

#include <string.h>

/* ---- what a tree alone cannot say ---- */

static const char *name_of(const char *name)
{
    return name ? name : "";
}

static se3d_status check_constraints(const se3di_tree *tree, se3di_error *error)
{
    const se3di_model *model = tree->model;
    for (uint32_t k = 0; k < tree->constraint_count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        const int is_driver = tree->tree_of[k] >= 0 && strcmp(c->type, "driver") == 0;
        if (c->break_limit[0] > 0.0 || c->break_limit[1] > 0.0) {
            return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                                   "'%.64s' (%s) may break: a batch has no such joints",
                                   name_of(c->name), c->type);
        }
        if ((tree->tree_of[k] < 0 && c->pattern == SE3DI_PATTERN_NONE) || is_driver) {
            return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                                   "'%.64s' (%s) is not a joint of a tree: a batch has no couplers "
                                   "and drivers, and loops that pins of planes or balls close",
                                   name_of(c->name), c->type);
        }
    }
    return SE3D_OK;
}

/* Some joint of the tree counts the turns of this angle. */
static int is_of_tree(const se3di_tree *tree, int32_t angle)
{
    for (uint32_t k = 0; k < tree->count; ++k) {
        if (tree->nodes[k].angle == angle) {
            return 1;
        }
    }
    return 0;
}

static se3d_status check_forces(const se3di_tree *tree, se3di_error *error)
{
    const se3di_model *model = tree->model;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *force = &model->forces[k];
        const se3di_force_class *type = se3di_force_class_of(force);
        if (type->accept) {
            return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                                   "'%.64s' (%s) remembers what was before: a batch has no such "
                                   "force elements",
                                   name_of(force->name), type->name);
        }
        if (force->angle >= 0 && !is_of_tree(tree, force->angle)) {
            return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                                   "'%.64s' (%s) counts turns that are not a joint's: in a batch "
                                   "it has to act on a joint",
                                   name_of(force->name), type->name);
        }
    }
    return SE3D_OK;
}

static se3d_status check_shapes(const se3di_model *model, se3di_error *error)
{
    const uint32_t count = (uint32_t)model->shape_slots.count;
    for (uint32_t a = 0; a < count; ++a) {
        for (uint32_t b = a + 1; b < count; ++b) {
            if (se3di_shapes_may_touch(model, a, b)) {
                return se3di_error_set(error, SE3D_ERR_UNSUPPORTED,
                                       "the shapes of '%.64s' and '%.64s' may touch: a batch has "
                                       "no contact",
                                       se3di_shape_describe(model, a),
                                       se3di_shape_describe(model, b));
            }
        }
    }
    return SE3D_OK;
}

static se3d_status check_model(const se3di_tree *tree, se3di_error *error)
{
    if (tree->model->sets) {
        return se3di_error_set(error, SE3D_ERR_UNSUPPORTED, "a batch has no particles");
    }
    if (tree->model->state_count > 0) {
        return se3di_error_set(error, SE3D_ERR_UNSUPPORTED, "a batch has no user-defined states");
    }
    SE3DI_TRY(check_constraints(tree, error));
    SE3DI_TRY(check_forces(tree, error));
    return check_shapes(tree->model, error);
}

/* ---- loops ---- */

static se3d_status fail_loop(const se3di_batch *b, uint32_t constraint)
{
    const se3di_constraint *c = &b->model->constraints[constraint];
    return se3di_error_set(b->error, SE3D_ERR_UNSUPPORTED,
                           "'%.64s' (%s) closes a loop that is not in a plane: a batch has loops "
                           "that pins of planes or balls close, whose equations do not depend on "
                           "each other",
                           name_of(c->name), c->type);
}

static se3d_status take_loops(se3di_batch *b)
{
    for (uint32_t k = 0; k < b->tree.constraint_count; ++k) {
        b->has_loops |= se3di_tree_leaves(&b->tree, k);
    }
    if (!b->has_loops) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_assembly_init(&b->assembly, b->model, &se3di_formulation_romega, 0, b->error));
    b->has_assembly = 1;
    SE3DI_TRY(se3di_tree_loops_init(&b->loops, &b->tree, &b->assembly, b->error));
    if (b->loops.other_count > 0) {
        return fail_loop(b, b->loops.others[0]);
    }
    if (!se3di_tree_loops_need_links_only(&b->loops) ||
        !se3di_loop_system_is_regular(&b->loops.system)) {
        return fail_loop(b, b->loops.constraints[0]);
    }
    return se3di_lane_loops_init(&b->lane_loops, &b->loops);
}

/* ---- memory ---- */

typedef struct room {
    double **to;
    size_t count;
} room;

/* One block for all rooms, each aligned, also for those that nothing is in. @return the block;
 * *count: its numbers */
static double *take_rooms(const se3d_allocator *allocator, const room *rooms, int rooms_count,
                          size_t *count)
{
    const size_t step = SE3DI_LANES_ALIGN / sizeof(double);
    size_t total = step;
    for (int k = 0; k < rooms_count; ++k) {
        total += (rooms[k].count + step - 1) / step * step;
    }
    double *block = se3di_alloc(allocator, total, sizeof *block);
    double *at = block ? se3di_lanes_align(block) : NULL;
    for (int k = 0; block && k < rooms_count; ++k) {
        *rooms[k].to = at;
        at += (rooms[k].count + step - 1) / step * step;
    }
    *count = block ? total : 0;
    return block;
}

static size_t state_size(const se3di_batch *b)
{
    return (size_t)b->tree.q_count + b->tree.v_count;
}

static se3d_status take_numbers(se3di_batch *b)
{
    const size_t width = (size_t)b->core->width, all = b->groups * width;
    const room rooms[] = {{&b->states, all * state_size(b)},
                          {&b->efforts, all * b->tree.v_count},
                          {&b->gravity, all * 3},
                          {&b->time, all}};
    const size_t widest = SIZE_MAX / (16 + state_size(b) + b->tree.v_count) / sizeof(double);
    if (b->groups > widest / width) {
        return SE3D_ERR_NO_MEMORY;
    }
    b->memory =
        take_rooms(&b->model->allocator, rooms, sizeof rooms / sizeof *rooms, &b->memory_count);
    b->status = se3di_alloc(&b->model->allocator, all, sizeof *b->status);
    return b->memory && b->status ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

/* Bodies that do not move are where they are for all lanes. */
static void spread_frames(const se3di_model *model, const se3di_batch_worker *w, size_t width)
{
    const size_t bodies = model->body_slots.count, size = sizeof(se3di_frame) / sizeof(double);
    for (size_t lane = 0; lane < width; ++lane) {
        memcpy(w->frames + lane * bodies, model->frames, bodies * sizeof *w->frames);
        for (size_t k = 0; k < model->angle_count; ++k) {
            w->angles[lane * model->angle_count + k] = model->angles[k];
        }
    }
    for (size_t k = 0; k < bodies * size; ++k) {
        const double *from = (const double *)(const void *)model->frames;
        for (size_t lane = 0; lane < width; ++lane) {
            w->lanes.frames[k * width + lane] = from[k];
        }
    }
}

static se3d_status take_model(se3di_batch *b, se3di_batch_worker *w)
{
    const se3d_allocator *allocator = &b->model->allocator;
    const size_t width = (size_t)b->core->width;
    SE3DI_TRY(se3di_model_clone(b->model, &w->model));
    w->has_model = 1;
    w->frames = se3di_alloc(allocator, width * b->model->body_slots.count, sizeof *w->frames);
    w->angles = se3di_alloc(allocator, width * b->model->angle_count, sizeof *w->angles);
    if (!w->frames || !w->angles) {
        return SE3D_ERR_NO_MEMORY;
    }
    spread_frames(b->model, w, width);
    return SE3D_OK;
}

static se3d_status init_worker(se3di_batch *b, se3di_batch_worker *w)
{
    const size_t width = (size_t)b->core->width, y = width * state_size(b);
    const size_t rows = se3di_lane_loops_room(&b->lane_loops);
    const room rooms[] = {{&w->y, y},
                          {&w->end, y},
                          {&w->rates, SE3DI_BATCH_STAGES * y},
                          {&w->effort, width * b->tree.v_count},
                          {&w->acting, width * b->tree.v_count},
                          {&w->verdict, width},
                          {&w->rows, width * rows},
                          {&w->scalars, 6 * (size_t)b->tree.body_count}};
    SE3DI_TRY(se3di_lanes_init(&w->lanes, &b->tree, b->core, !b->is_in_lanes));
    w->lanes.wants_points = b->spring_count > 0;
    if (b->is_in_lanes && !b->has_loops && b->spring_count + b->load_count == 0) {
        se3di_lanes_take_plane(&w->lanes);
    }
    w->memory =
        take_rooms(&b->model->allocator, rooms, sizeof rooms / sizeof *rooms, &w->memory_count);
    if (!w->memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    if (b->has_loops) {
        se3di_lanes_take_loops(&w->lanes, &b->lane_loops, w->rows);
    }
    return b->is_in_lanes ? SE3D_OK : take_model(b, w);
}

static void destroy_worker(const se3di_batch *b, se3di_batch_worker *w)
{
    const se3d_allocator *allocator = &b->model->allocator;
    const size_t width = b->core ? (size_t)b->core->width : 0;
    se3di_free(allocator, w->frames, width * b->model->body_slots.count, sizeof *w->frames);
    se3di_free(allocator, w->angles, width * b->model->angle_count, sizeof *w->angles);
    se3di_free(allocator, w->memory, w->memory_count, sizeof *w->memory);
    se3di_lanes_destroy(&w->lanes);
    if (w->has_model) {
        se3di_model_destroy(&w->model);
    }
}

static se3d_status take_workers(se3di_batch *b, int32_t count)
{
    b->workers = se3di_alloc(&b->model->allocator, (size_t)count, sizeof *b->workers);
    if (!b->workers) {
        return SE3D_ERR_NO_MEMORY;
    }
    b->worker_count = count;
    for (int32_t k = 0; k < count; ++k) {
        SE3DI_TRY(init_worker(b, &b->workers[k]));
    }
    return SE3D_OK;
}

/* All states are the model's, without efforts. */
static void fill(se3di_batch *b)
{
    const se3di_model *model = b->model;
    const size_t width = (size_t)b->core->width, size = state_size(b);
    for (size_t k = 0; k < b->groups * size * width; ++k) {
        const size_t c = k / width % size;
        b->states[k] = c < b->tree.q_count ? b->tree.q[c] : b->tree.qdot[c - b->tree.q_count];
    }
    for (size_t k = 0; k < b->groups * width; ++k) {
        const size_t group = k / width, lane = k % width;
        for (size_t c = 0; c < 3; ++c) {
            b->gravity[(3 * group + c) * width + lane] = model->gravity[c];
        }
        b->time[k] = model->time;
    }
    for (size_t group = 0; group < b->groups; ++group) {
        b->workers[0].lanes.core->normalise(&b->workers[0].lanes, b->states + group * size * width);
    }
}

static se3d_status build(se3di_batch *b, int32_t threads)
{
    SE3DI_TRY(se3di_tree_init(&b->tree, b->model, 0, b->error));
    SE3DI_TRY(check_model(&b->tree, b->error));
    SE3DI_TRY(take_loops(b));
    SE3DI_TRY(se3di_batch_take_forces(b));
    SE3DI_TRY(take_numbers(b));
    SE3DI_TRY(take_workers(b, threads));
    se3di_tree_get(&b->tree, b->tree.q, b->tree.qdot);
    fill(b);
    se3di_batch_settle(b, 0, b->count);
    return SE3D_OK;
}

se3d_status se3di_batch_init(se3di_batch *batch, se3di_model *model, size_t count, int32_t threads,
                             se3di_error *error)
{
    const se3di_lane_core *core = se3di_lane_core_widest();
    const size_t width = (size_t)core->width, groups = count / width + (count % width > 0);
    *batch = (se3di_batch){
        .model = model, .error = error, .core = core, .count = count, .groups = groups};
    const int32_t most = groups < (size_t)threads ? (int32_t)groups : threads;
    const se3d_status status = build(batch, most > 0 ? most : 1);
    if (status == SE3D_ERR_NO_MEMORY) {
        se3di_error_set(error, status, "no memory for a batch of %zu states", count);
    }
    if (status < 0) {
        se3di_batch_destroy(batch);
    }
    return status;
}

static size_t count_inertias(const se3di_batch *b)
{
    return b->groups * b->tree.count * 7 * (size_t)b->core->width +
           SE3DI_LANES_ALIGN / sizeof(double);
}

void se3di_batch_destroy(se3di_batch *batch)
{
    se3di_batch *b = batch;
    if (!b->model) {
        return;
    }
    const se3d_allocator *allocator = &b->model->allocator;
    for (int32_t k = 0; k < b->worker_count; ++k) {
        destroy_worker(b, &b->workers[k]);
    }
    se3di_free(allocator, b->workers, (size_t)b->worker_count, sizeof *b->workers);
    se3di_free(allocator, b->memory, b->memory_count, sizeof *b->memory);
    se3di_free(allocator, b->inertia_memory, count_inertias(b), sizeof(double));
    se3di_free(allocator, b->status, b->groups * (size_t)b->core->width, sizeof *b->status);
    se3di_batch_drop_forces(b);
    se3di_lane_loops_destroy(&b->lane_loops);
    se3di_tree_loops_destroy(&b->loops);
    if (b->has_assembly) {
        se3di_assembly_destroy(&b->assembly);
    }
    se3di_tree_destroy(&b->tree);
    memset(b, 0, sizeof *b);
}

/* ---- numbers in and out ---- */

se3di_batch_part se3di_batch_positions(const se3di_batch *b)
{
    return (se3di_batch_part){b->states, b->tree.q_count, 0, state_size(b)};
}

se3di_batch_part se3di_batch_velocities(const se3di_batch *b)
{
    return (se3di_batch_part){b->states, b->tree.v_count, b->tree.q_count, state_size(b)};
}

se3di_batch_part se3di_batch_efforts(const se3di_batch *b)
{
    return (se3di_batch_part){b->efforts, b->tree.v_count, 0, b->tree.v_count};
}

se3di_batch_part se3di_batch_gravity(const se3di_batch *b)
{
    return (se3di_batch_part){b->gravity, 3, 0, 3};
}

se3di_batch_part se3di_batch_time(const se3di_batch *b)
{
    return (se3di_batch_part){b->time, 1, 0, 1};
}

/* The first number of a state; its others are a width apart. */
static double *find_numbers(const se3di_batch *b, const se3di_batch_part *part, size_t state)
{
    const size_t width = (size_t)b->core->width;
    return part->numbers + (state / width * part->whole + part->offset) * width + state % width;
}

void se3di_batch_write(const se3di_batch *batch, const se3di_batch_part *part, size_t first,
                       size_t count, const double *values)
{
    const size_t width = (size_t)batch->core->width;
    for (size_t k = 0; k < count; ++k) {
        double *to = find_numbers(batch, part, first + k);
        for (size_t c = 0; c < part->size; ++c) {
            to[c * width] = values[k * part->size + c];
        }
    }
}

void se3di_batch_read(const se3di_batch *batch, const se3di_batch_part *part, size_t first,
                      size_t count, double *values)
{
    const size_t width = (size_t)batch->core->width;
    for (size_t k = 0; k < count; ++k) {
        const double *from = find_numbers(batch, part, first + k);
        for (size_t c = 0; c < part->size; ++c) {
            values[k * part->size + c] = from[c * width];
        }
    }
}

void se3di_batch_normalise(const se3di_batch *batch, size_t first, size_t count)
{
    const size_t width = (size_t)batch->core->width;
    const se3di_batch_part q = se3di_batch_positions(batch);
    for (size_t k = first; k < first + count; ++k) {
        double *at = find_numbers(batch, &q, k);
        for (uint32_t i = 0; i < batch->tree.count; ++i) {
            const se3di_tree_node *n = &batch->tree.nodes[i];
            const size_t place = n->q + (n->type == SE3DI_TREE_FREE ? 3 : 0);
            double p[4];
            if (n->type != SE3DI_TREE_FREE && n->type != SE3DI_TREE_SPHERICAL) {
                continue;
            }
            for (size_t c = 0; c < 4; ++c) {
                p[c] = at[(place + c) * width];
            }
            se3di_quat_normalize(p, p);
            for (size_t c = 0; c < 4; ++c) {
                at[(place + c) * width] = p[c];
            }
        }
    }
}

void se3di_batch_revive(const se3di_batch *batch, size_t first, size_t count)
{
    for (size_t k = first; k < first + count; ++k) {
        batch->status[k] = SE3D_OK;
    }
}

/* All states have the model's inertias. */
static se3d_status take_inertias(se3di_batch *b)
{
    const size_t width = (size_t)b->core->width, nodes = b->tree.count;
    b->inertia_memory = se3di_alloc(&b->model->allocator, count_inertias(b), sizeof(double));
    if (!b->inertia_memory) {
        return SE3D_ERR_NO_MEMORY;
    }
    b->inertias = se3di_lanes_align(b->inertia_memory);
    for (size_t k = 0; k < b->groups * nodes * 7 * width; ++k) {
        const se3di_tree_node *n = &b->tree.nodes[k / width / 7 % nodes];
        const size_t c = k / width % 7;
        b->inertias[k] = c == 0 ? n->mass : n->J[c - 1];
    }
    return SE3D_OK;
}

se3d_status se3di_batch_set_inertia(se3di_batch *batch, uint32_t body, size_t first, size_t count,
                                    const double *mass, const double *J)
{
    const size_t node = (size_t)batch->tree.node_of[body], nodes = batch->tree.count;
    if (!batch->inertias && take_inertias(batch) < 0) {
        return se3di_error_set(batch->error, SE3D_ERR_NO_MEMORY,
                               "no memory for the masses of %zu states", batch->count);
    }
    const se3di_batch_part part = {batch->inertias, 7, 7 * node, 7 * nodes};
    for (size_t k = 0; k < count; ++k) {
        double own[7];
        own[0] = mass[k];
        se3di_tree_inertia_of(&batch->tree.nodes[node], mass[k], J + 6 * k, own + 1);
        se3di_batch_write(batch, &part, first + k, 1, own);
    }
    return SE3D_OK;
}

size_t se3di_batch_find_failed(const se3di_batch *batch)
{
    size_t k = 0;
    while (k < batch->count && batch->status[k] >= 0) {
        ++k;
    }
    return k;
}
