/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots: everything that a step reads and writes, the integrator's history included. */
#include "system/particles.h"

#include <string.h>

struct se3d_snapshot {
    se3d_allocator allocator;
    uint64_t topology_version;
    uint64_t history_tag;
    int32_t settled;
    int32_t reserved;
    double time;
    double work[3], power[3];
    int32_t work_valid;
    int32_t reserved2;
    size_t bodies, rows, angles, forces, history, contacts;
    se3di_frame *frames;
    double *acceleration;  /* [bodies * 6] */
    double *lambda;        /* [rows] */
    double *turns;         /* [angles] */
    double *memory;        /* [forces * SE3DI_FORCE_STATES] */
    double *carried;       /* [history] */
    se3di_particles *sets; /* copies of the particle sets */
    se3di_body_contact *touching;
    double *wrench; /* [6 * shapes] */
    size_t shapes;
    double contact_step;
};

static se3d_status allocate(se3d_snapshot *s)
{
    s->frames = se3di_alloc(&s->allocator, s->bodies, sizeof *s->frames);
    s->acceleration = se3di_alloc(&s->allocator, 6 * s->bodies, sizeof(double));
    s->lambda = se3di_alloc(&s->allocator, s->rows, sizeof(double));
    s->turns = se3di_alloc(&s->allocator, s->angles, sizeof(double));
    s->memory = se3di_alloc(&s->allocator, SE3DI_FORCE_STATES * s->forces, sizeof(double));
    s->carried = se3di_alloc(&s->allocator, s->history, sizeof(double));
    s->touching = se3di_alloc(&s->allocator, s->contacts, sizeof *s->touching);
    s->wrench = se3di_alloc(&s->allocator, 6 * s->shapes, sizeof(double));
    int complete = s->touching && s->wrench && s->frames && s->acceleration && s->lambda &&
                   s->turns && s->memory && s->carried;
    return complete ? SE3D_OK : SE3D_ERR_NO_MEMORY;
}

static void copy(void *to, const void *from, size_t size)
{
    if (size > 0) {
        memcpy(to, from, size);
    }
}

static void fill(se3d_snapshot *s, const se3di_model *model)
{
    copy(s->frames, model->frames, s->bodies * sizeof *s->frames);
    copy(s->acceleration, model->acceleration, 6 * s->bodies * sizeof(double));
    copy(s->lambda, model->lambda, s->rows * sizeof(double));
    copy(s->carried, model->history, s->history * sizeof(double));
    for (size_t k = 0; k < s->angles; ++k) {
        s->turns[k] = model->angles[k].theta;
    }
    se3di_model_save_memory(model, s->memory);
    copy(s->touching, model->contacts.list, s->contacts * sizeof *s->touching);
    for (size_t k = 0; k < s->shapes; ++k) {
        copy(s->wrench + 6 * k, model->shapes[k].force, 3 * sizeof(double));
        copy(s->wrench + 6 * k + 3, model->shapes[k].torque, 3 * sizeof(double));
    }
    s->contact_step = model->contacts.step;
    copy(s->work, model->work, sizeof s->work);
    copy(s->power, model->power, sizeof s->power);
    s->work_valid = model->work_valid;
}

se3d_status se3d_snapshot_create(const se3d_system *system, se3d_snapshot **out)
{
    if (out) {
        *out = NULL;
    }
    if (!system || !out) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    se3d_snapshot *snapshot = se3di_alloc(&model->allocator, 1, sizeof *snapshot);
    if (!snapshot) {
        return SE3D_ERR_NO_MEMORY;
    }
    *snapshot = (se3d_snapshot){
        .allocator = model->allocator,
        .topology_version = model->topology_version,
        .history_tag = model->history_tag,
        .settled = model->settled,
        .time = model->time,
        .bodies = model->body_slots.count,
        .rows = model->row_count,
        .angles = model->angle_count,
        .forces = model->force_slots.count,
        .contacts = model->contacts.count,
        .shapes = model->shape_slots.count,
        .history = model->history_tag ? model->history_count : 0,
    };
    if (allocate(snapshot) < 0 ||
        se3di_sets_save(model->sets, &model->allocator, &snapshot->sets) < 0) {
        se3d_snapshot_destroy(snapshot);
        return SE3D_ERR_NO_MEMORY;
    }
    fill(snapshot, model);
    *out = snapshot;
    return SE3D_OK;
}

se3d_status se3d_snapshot_restore(const se3d_snapshot *snapshot, se3d_system *system)
{
    if (!system) {
        return SE3D_ERR_NULL;
    }
    SE3DI_TRY(se3di_check_pointer(system, "snapshot", snapshot));
    se3di_model *model = &system->model;
    if (snapshot->topology_version != model->topology_version ||
        snapshot->bodies != model->body_slots.count || snapshot->rows != model->row_count ||
        snapshot->angles != model->angle_count || snapshot->forces != model->force_slots.count ||
        snapshot->shapes != model->shape_slots.count) {
        return SE3DI_FAIL(system, SE3D_ERR_STATE,
                          "the snapshot has %zu bodies and %zu equations at edit %llu, the system "
                          "%zu and %zu at edit %llu; only the same model can be restored",
                          snapshot->bodies, snapshot->rows,
                          (unsigned long long)snapshot->topology_version, model->body_slots.count,
                          model->row_count, (unsigned long long)model->topology_version);
    }
    void *history = model->history;
    se3d_status status = se3di_array_reserve(&model->allocator, &history, &model->history_capacity,
                                             snapshot->history, sizeof(double));
    model->history = history;
    void *touching = model->contacts.list;
    status = status < 0
                 ? status
                 : se3di_array_reserve(&model->allocator, &touching, &model->contacts.capacity,
                                       snapshot->contacts, sizeof *snapshot->touching);
    model->contacts.list = touching;
    if (status < 0) {
        return SE3DI_FAIL(system, status, "no memory for the integrator's history");
    }
    se3di_particles *sets;
    if (se3di_sets_save(snapshot->sets, &model->allocator, &sets) < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for the snapshot's particles");
    }
    se3di_sets_take(model, sets);
    copy(model->frames, snapshot->frames, snapshot->bodies * sizeof *model->frames);
    copy(model->acceleration, snapshot->acceleration, 6 * snapshot->bodies * sizeof(double));
    copy(model->lambda, snapshot->lambda, snapshot->rows * sizeof(double));
    copy(model->history, snapshot->carried, snapshot->history * sizeof(double));
    for (size_t k = 0; k < snapshot->angles; ++k) {
        model->angles[k].theta = snapshot->turns[k];
    }
    se3di_model_restore_memory(model, snapshot->memory);
    copy(model->contacts.list, snapshot->touching, snapshot->contacts * sizeof *snapshot->touching);
    model->contacts.count = snapshot->contacts;
    model->contacts.step = snapshot->contact_step;
    for (size_t k = 0; k < snapshot->shapes; ++k) {
        copy(model->shapes[k].force, snapshot->wrench + 6 * k, 3 * sizeof(double));
        copy(model->shapes[k].torque, snapshot->wrench + 6 * k + 3, 3 * sizeof(double));
    }
    copy(model->work, snapshot->work, sizeof model->work);
    copy(model->power, snapshot->power, sizeof model->power);
    model->work_valid = snapshot->work_valid;
    model->settled = snapshot->settled;
    model->remembers = 1;
    model->history_count = snapshot->history;
    model->history_tag = snapshot->history_tag;
    model->time = snapshot->time;
    return SE3D_OK;
}

void se3d_snapshot_destroy(se3d_snapshot *snapshot)
{
    if (snapshot) {
        se3d_allocator allocator = snapshot->allocator;
        se3di_free(&allocator, snapshot->frames, snapshot->bodies, sizeof *snapshot->frames);
        se3di_free(&allocator, snapshot->acceleration, 6 * snapshot->bodies, sizeof(double));
        se3di_free(&allocator, snapshot->lambda, snapshot->rows, sizeof(double));
        se3di_free(&allocator, snapshot->turns, snapshot->angles, sizeof(double));
        se3di_free(&allocator, snapshot->memory, SE3DI_FORCE_STATES * snapshot->forces,
                   sizeof(double));
        se3di_sets_forget(snapshot->sets, &allocator);
        se3di_free(&allocator, snapshot->carried, snapshot->history, sizeof(double));
        se3di_free(&allocator, snapshot->touching, snapshot->contacts, sizeof *snapshot->touching);
        se3di_free(&allocator, snapshot->wrench, 6 * snapshot->shapes, sizeof(double));
        se3di_free(&allocator, snapshot, 1, sizeof *snapshot);
    }
}
