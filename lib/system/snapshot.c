/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots: everything that a step reads and writes, the integrator's history included. */
#include "system/snapshot.h"

#include "base/hash.h"
#include "force/driver_rate.h"
#include "system/particles.h"

#include <string.h>

static uint64_t add_words(uint64_t hash, const uint32_t *words, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        const unsigned char bytes[4] = {(unsigned char)words[k], (unsigned char)(words[k] >> 8),
                                        (unsigned char)(words[k] >> 16),
                                        (unsigned char)(words[k] >> 24)};
        hash = se3di_hash_bytes(hash, bytes, sizeof bytes);
    }
    return hash;
}

/* The coordinates that a constraint binds, which bodies and rows do not say: of a rate the one that
 * is free to the state, of other drivers and of couplers those of their equations. */
static uint64_t add_coordinates(uint64_t hash, const se3di_model *model, const se3di_constraint *c)
{
    if (se3di_is_driver_rate(c)) {
        const uint32_t words[] = {(uint32_t)c->joints[0], (uint32_t)c->coordinate};
        return add_words(hash, words, 2);
    }
    for (size_t k = 0; k < SE3D_COUPLER_TERMS_MAX && c->joints[k] >= 0; ++k) {
        hash = add_words(hash, &(uint32_t){(uint32_t)c->joints[k]}, 1);
    }
    for (uint32_t r = 0; r < c->row_count && c->joints[0] >= 0; ++r) {
        const char *name = model->rows[c->row_begin + r].name;
        hash = se3di_hash_bytes(hash, name, strlen(name) + 1);
    }
    return hash;
}

uint64_t se3di_snapshot_structure(const se3di_model *model)
{
    uint64_t hash = SE3DI_HASH_START;
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        hash = add_words(hash, &(uint32_t){model->bodies[k].fixed != 0}, 1);
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        hash = se3di_hash_bytes(hash, c->type, strlen(c->type) + 1);
        hash = add_words(hash, &c->row_count, 1);
        hash = add_words(hash, c->bodies, c->body_count);
        hash = add_coordinates(hash, model, c);
    }
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const se3di_force *f = &model->forces[k];
        const uint32_t words[] = {(uint32_t)f->type, f->body_i, f->body_j};
        hash = add_words(hash, words, 3);
    }
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        const uint32_t words[] = {(uint32_t)model->shapes[k].kind, model->shapes[k].body};
        hash = add_words(hash, words, 2);
    }
    for (const se3di_particles *set = model->sets; set; set = set->next) {
        const uint32_t words[] = {(uint32_t)set->boundary[0], (uint32_t)set->boundary[1],
                                  (uint32_t)set->boundary[2], (uint32_t)set->source_count,
                                  (uint32_t)set->sink_count,  (uint32_t)set->flow_count};
        hash = add_words(hash, words, set->flow_count > 0 ? 6 : 5);
        if (set->cell.count > 0) {
            const uint32_t cell[] = {(uint32_t)set->cell.count, (uint32_t)set->cell.flow,
                                     (uint32_t)set->cell.gradient};
            hash = add_words(hash, cell, 3);
        }
        if (set->servo_count > 0 || set->audits) {
            const uint32_t more[] = {(uint32_t)set->servo_count, 1 + (uint32_t)set->audits};
            hash = add_words(hash, more, 2);
        }
        for (size_t k = 0; k < set->servo_count; ++k) {
            const se3di_servo *servo = &set->servos[k];
            const se3di_handle shape = servo->shape;
            const uint32_t moved =
                se3di_slots_find(&model->shape_slots, shape.index1, shape.generation);
            hash = add_words(hash, &moved, 1);
            hash = se3di_hash_numbers(hash, servo->axis, 3);
        }
        if (set->bond_group_count > 0) {
            const uint32_t groups = (uint32_t)set->bond_group_count;
            hash = add_words(hash, &groups, 1);
        }
    }
    return hash;
}

/* ---- the list of shapes that may touch: methods ask whether there are any ---- */

static se3d_status resize(se3di_saved_array *array, const se3d_allocator *allocator, size_t count,
                          size_t size)
{
    array->count = count;
    return se3di_array_reserve(allocator, &array->data, &array->capacity, count, size);
}

static void copy(void *to, const void *from, size_t size)
{
    if (size > 0) {
        memcpy(to, from, size);
    }
}

static se3d_status save_near(se3di_snapshot_near *near, const se3di_model *model)
{
    const se3di_body_contacts *c = &model->contacts;
    const int is_listed = c->version == model->topology_version && model->shape_slots.count > 0;
    const size_t shapes = is_listed ? model->shape_slots.count : 0;
    const size_t pairs = is_listed ? c->pair_count : 0;
    near->margin = is_listed ? c->margin : 0.0;
    SE3DI_TRY(resize(&near->pairs, &model->allocator, 2 * pairs, sizeof *c->pairs));
    SE3DI_TRY(resize(&near->reference, &model->allocator, 3 * shapes, sizeof *c->reference));
    SE3DI_TRY(resize(&near->order, &model->allocator, shapes, sizeof *c->order));
    copy(near->pairs.data, c->pairs, near->pairs.count * sizeof *c->pairs);
    copy(near->reference.data, c->reference, near->reference.count * sizeof *c->reference);
    copy(near->order.data, c->order, near->order.count * sizeof *c->order);
    return SE3D_OK;
}

static se3d_status reserve_one(se3di_model *model, void **data, size_t *capacity, size_t count,
                               size_t size)
{
    return se3di_array_reserve(&model->allocator, data, capacity, count, size);
}

/* Room for the list, so that restore_near cannot fail. */
static se3d_status reserve_near(const se3di_snapshot_near *near, se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    const size_t shapes = near->order.count;
    void *pairs = c->pairs, *reference = c->reference, *order = c->order;
    se3d_status status =
        reserve_one(model, &pairs, &c->pair_capacity, near->pairs.count / 2, 2 * sizeof *c->pairs);
    c->pairs = pairs;
    SE3DI_TRY(status);
    status =
        reserve_one(model, &reference, &c->reference_capacity, shapes, 3 * sizeof *c->reference);
    c->reference = reference;
    SE3DI_TRY(status);
    status = reserve_one(model, &order, &c->order_capacity, shapes, sizeof *c->order);
    c->order = order;
    return status;
}

static void restore_near(const se3di_snapshot_near *near, se3di_model *model)
{
    se3di_body_contacts *c = &model->contacts;
    copy(c->pairs, near->pairs.data, near->pairs.count * sizeof *c->pairs);
    copy(c->reference, near->reference.data, near->reference.count * sizeof *c->reference);
    copy(c->order, near->order.data, near->order.count * sizeof *c->order);
    c->pair_count = near->pairs.count / 2;
    c->margin = near->margin;
    c->version = near->order.count > 0 ? model->topology_version : 0;
}

static void release_near(se3di_snapshot_near *near, const se3d_allocator *allocator)
{
    se3di_free(allocator, near->pairs.data, near->pairs.capacity, sizeof(uint32_t));
    se3di_free(allocator, near->reference.data, near->reference.capacity, sizeof(double));
    se3di_free(allocator, near->order.data, near->order.capacity, sizeof(uint32_t));
}

se3d_status se3d_snapshot_create(const se3d_system *system, se3d_snapshot **out)
{
    if (out) {
        *out = NULL;
    }
    if (!system || !out) {
        return SE3D_ERR_NULL;
    }
    if (!se3di_is_settled(system)) {
        return SE3D_ERR_STATE;
    }
    const se3di_model *model = &system->model;
    se3di_pending_complete(model->pending);
    se3d_snapshot *snapshot = se3di_alloc(&model->allocator, 1, sizeof *snapshot);
    if (!snapshot) {
        return SE3D_ERR_NO_MEMORY;
    }
    snapshot->allocator = model->allocator;
    snapshot->topology_version = model->topology_version;
    snapshot->inputs_version = model->inputs_version;
    snapshot->values_version = model->values_version;
    snapshot->structure = se3di_snapshot_structure(model);
    if (se3di_saved_fill(&snapshot->state, model, &model->allocator) < 0 ||
        save_near(&snapshot->near, model) < 0 ||
        se3di_sets_save(model->sets, &model->allocator, &snapshot->sets) < 0 ||
        se3di_sets_sync(snapshot->sets, model) < 0) {
        se3d_snapshot_destroy(snapshot);
        return SE3D_ERR_NO_MEMORY;
    }
    *out = snapshot;
    return SE3D_OK;
}

se3d_status se3d_snapshot_restore(const se3d_snapshot *snapshot, se3d_system *system)
{
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "snapshot", snapshot));
    se3di_model *model = &system->model;
    const se3di_saved *state = &snapshot->state;
    if (snapshot->topology_version != model->topology_version || !se3di_saved_fits(state, model) ||
        !se3di_sets_can_take(model, snapshot->sets)) {
        return SE3DI_FAIL(system, SE3D_ERR_STATE,
                          "the snapshot has %zu bodies and %zu equations at edit %llu, the system "
                          "%zu and %zu at edit %llu; only the same model can be restored",
                          state->frames.count, state->lambda.count,
                          (unsigned long long)snapshot->topology_version, model->body_slots.count,
                          model->row_count, (unsigned long long)model->topology_version);
    }
    se3d_status status = se3di_saved_reserve(state, model);
    status = status < 0 ? status : reserve_near(&snapshot->near, model);
    if (status < 0) {
        return SE3DI_FAIL(system, status, "no memory for the integrator's history");
    }
    se3di_particles *sets;
    if (se3di_sets_save(snapshot->sets, &model->allocator, &sets) < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for the snapshot's particles");
    }
    se3di_sets_take(model, sets);
    se3di_saved_restore(state, model);
    restore_near(&snapshot->near, model);
    ++model->history_stamp;
    ++model->poses_version;
    return SE3D_OK;
}

void se3d_snapshot_destroy(se3d_snapshot *snapshot)
{
    if (snapshot) {
        se3d_allocator allocator = snapshot->allocator;
        se3di_saved_destroy(&snapshot->state, &allocator);
        release_near(&snapshot->near, &allocator);
        se3di_sets_forget(snapshot->sets, &allocator);
        se3di_free(&allocator, snapshot, 1, sizeof *snapshot);
    }
}
