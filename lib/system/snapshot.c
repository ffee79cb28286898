/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots: everything that a step reads and writes, the integrator's history included. */
#include "model/saved.h"
#include "particles/chain.h"
#include "system/particles.h"

struct se3d_snapshot {
    se3d_allocator allocator;
    uint64_t topology_version;
    se3di_saved state;
    se3di_particles *sets; /* copies of the particle sets */
};

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
    se3d_snapshot *snapshot = se3di_alloc(&model->allocator, 1, sizeof *snapshot);
    if (!snapshot) {
        return SE3D_ERR_NO_MEMORY;
    }
    snapshot->allocator = model->allocator;
    snapshot->topology_version = model->topology_version;
    if (se3di_saved_fill(&snapshot->state, model, &model->allocator) < 0 ||
        se3di_sets_save(model->sets, &model->allocator, &snapshot->sets) < 0) {
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
    if (snapshot->topology_version != model->topology_version || !se3di_saved_fits(state, model)) {
        return SE3DI_FAIL(system, SE3D_ERR_STATE,
                          "the snapshot has %zu bodies and %zu equations at edit %llu, the system "
                          "%zu and %zu at edit %llu; only the same model can be restored",
                          state->frames.count, state->lambda.count,
                          (unsigned long long)snapshot->topology_version, model->body_slots.count,
                          model->row_count, (unsigned long long)model->topology_version);
    }
    se3d_status status = se3di_saved_reserve(state, model);
    if (status < 0) {
        return SE3DI_FAIL(system, status, "no memory for the integrator's history");
    }
    se3di_particles *sets;
    if (se3di_sets_save(snapshot->sets, &model->allocator, &sets) < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for the snapshot's particles");
    }
    se3di_sets_take(model, sets);
    se3di_saved_restore(state, model);
    ++model->history_stamp;
    return SE3D_OK;
}

void se3d_snapshot_destroy(se3d_snapshot *snapshot)
{
    if (snapshot) {
        se3d_allocator allocator = snapshot->allocator;
        se3di_saved_destroy(&snapshot->state, &allocator);
        se3di_sets_forget(snapshot->sets, &allocator);
        se3di_free(&allocator, snapshot, 1, sizeof *snapshot);
    }
}
