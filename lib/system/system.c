/* SPDX-License-Identifier: BSD-3-Clause */
/* Systems: creation, gravity, time, counts, energy, violation, hash. */
#include "system/coordinate.h"
#include "system/definition.h"
#include "system/particles.h"
#include "system/solver.h"

#include "assembly/energy.h"
#include "base/hash.h"
#include "contact/bodies/body_contacts.h"
#include "joint/equation.h"
#include "math/vec3.h"
#include "model/state.h"
#include "particles/step.h"

#include <math.h>
#include <string.h>

void se3d_system_def_init(se3d_system_def *def, size_t size)
{
    se3d_system_def defaults = {.struct_size = size, .gravity = {0.0, 0.0, -9.81}};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

/* Different for systems that live at the same time, so that handles of another system are detected.
 */
static uint32_t salt_of(const se3d_system *system)
{
    uint64_t bits = (uint64_t)(uintptr_t)system * UINT64_C(0x9E3779B97F4A7C15);
    return (uint32_t)(bits >> 52);
}

static se3d_status read_def(const se3d_system_def *def, se3d_system_def *full)
{
    if (!def) {
        return SE3D_OK;
    }
    if (se3di_sized_take(def, full, sizeof *full) != SE3DI_SIZED_FITS) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const se3d_allocator *allocator = full->allocator;
    int complete = !allocator || (allocator->alloc && allocator->realloc && allocator->free);
    int finite = se3di_is_finite(full->gravity, 3) && isfinite(full->time);
    return complete && finite ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

/* Nobody works on it, and it has no solvers. */
static void begin_life(se3d_system *system)
{
    se3di_busy_init(&system->busy);
    system->model.busy = &system->busy;
    se3di_pending_init(&system->pending);
    system->model.pending = &system->pending;
    system->log.busy = &system->busy;
    system->error.log = system->found.log = &system->log;
    system->solvers = NULL;
    system->coordinates = NULL;
    system->copies = NULL;
    system->kept = 0;
}

se3d_status se3d_system_create(const se3d_system_def *def, se3d_system **out)
{
    if (!out) {
        return SE3D_ERR_NULL;
    }
    *out = NULL;
    se3d_system_def full = se3d_system_def_default();
    SE3DI_TRY(read_def(def, &full));
    se3d_allocator allocator = full.allocator ? *full.allocator : se3di_alloc_default();
    se3d_system *system = se3di_alloc(&allocator, 1, sizeof *system);
    if (!system) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_status status = se3di_model_init(&system->model, &allocator, salt_of(system));
    if (status < 0) {
        se3di_free(&allocator, system, 1, sizeof *system);
        return status;
    }
    begin_life(system);
    se3di_copy(full.gravity, system->model.gravity);
    system->model.time = full.time;
    system->log.callback = full.log;
    system->log.ctx = full.log_ctx;
    *out = system;
    return SE3D_OK;
}

se3d_status se3d_system_set_log(se3d_system *system, se3d_log_callback log, void *ctx)
{
    SE3DI_EDIT(system);
    system->log.callback = log;
    system->log.ctx = ctx;
    return SE3D_OK;
}

se3d_status se3d_system_set_kept(se3d_system *system, int32_t kept)
{
    SE3DI_EDIT(system);
    system->kept = kept != 0;
    se3di_owners_keep(system, system->kept);
    return SE3D_OK;
}

se3d_status se3d_system_set_replacing(se3d_system *system, int32_t on)
{
    SE3DI_EDIT(system);
    if (!on) {
        const se3d_status stale = se3di_model_check_stale(&system->model, &system->error);
        if (stale < 0) {
            return se3di_log_error(&system->error, stale);
        }
    }
    system->model.replaces = on != 0;
    return SE3D_OK;
}

void se3d_system_destroy(se3d_system *system)
{
    if (!system || se3di_enter(system, SE3DI_BUSY_FREE, __func__) < 0) {
        return;
    }
    if (system->kept) {
        (void)SE3DI_FAIL(system, SE3D_ERR_STATE,
                         "se3d_system_destroy is not allowed: the system belongs to the model, or "
                         "to whoever else keeps it (se3d_system_set_kept)");
        return;
    }
    const se3d_allocator allocator = system->model.allocator;
    se3di_solvers_orphan(system);
    se3di_coordinates_orphan(system);
    se3di_copies_orphan(system);
    se3di_owners_destroy(&system->model);
    se3di_model_destroy(&system->model);
    se3di_free(&allocator, system, 1, sizeof *system);
}

se3d_status se3d_system_clone(const se3d_system *system, se3d_system **out)
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
    se3di_pending_complete(system->model.pending);
    se3d_system *copy = se3di_alloc(&system->model.allocator, 1, sizeof *copy);
    if (!copy) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_status status = se3di_model_clone(&system->model, &copy->model);
    if (status < 0) {
        se3di_free(&system->model.allocator, copy, 1, sizeof *copy);
        return status;
    }
    begin_life(copy);
    status = se3di_owners_clone(system, copy);
    if (status < 0) {
        se3d_system_destroy(copy);
        return status;
    }
    copy->log.callback = system->log.callback;
    copy->log.ctx = system->log.ctx;
    *out = copy;
    return SE3D_OK;
}

const char *se3d_system_get_error(const se3d_system *system)
{
    return system ? system->error.message : "the system is NULL";
}

se3d_status se3d_system_get_error_status(const se3d_system *system)
{
    return system ? system->error.status : SE3D_ERR_NULL;
}

const char *se3d_system_get_error_field(const se3d_system *system)
{
    return system ? system->error.field : "";
}

se3d_status se3d_system_set_gravity(se3d_system *system, const double gravity[3])
{
    SE3DI_SET(system);
    SE3DI_TRY(se3di_check_pointer(system, "gravity", gravity));
    SE3DI_TRY(se3di_check_finites(system, "gravity", gravity, 3));
    se3di_model *model = &system->model;
    const double before = se3di_audit_forces(model);
    se3di_copy(gravity, model->gravity);
    se3di_audit_change(model, before);
    se3di_model_touch_inputs(model);
    return SE3D_OK;
}

se3d_status se3d_system_set_gravity_function(se3d_system *system, const se3d_function gravity[3])
{
    SE3DI_SET(system);
    SE3DI_TRY(se3di_check_pointer(system, "gravity", gravity));
    int32_t function[3];
    for (int c = 0; c < 3; ++c) {
        SE3DI_TRY(se3di_find_function(system, "gravity", gravity[c], 1, &function[c]));
    }
    se3di_model *model = &system->model;
    const double before = se3di_audit_forces(model);
    for (int c = 0; c < 3; ++c) {
        if (function[c] >= 0) {
            ++model->functions[function[c]].users;
        }
        if (model->gravity_function[c] >= 0) {
            --model->functions[model->gravity_function[c]].users;
        }
        model->gravity_function[c] = function[c];
    }
    se3di_audit_change(model, before);
    se3di_model_touch_inputs(model);
    return SE3D_OK;
}

/* A row by callback is among those that are left out as they depend on others. */
static int leaves_user_rows_out(const se3di_model *model)
{
    for (size_t k = 0; k < model->row_count && model->left_out_count > 0; ++k) {
        if (model->rows[k].term_count == 0 && model->rows[k].left_out == SE3DI_ROW_DEPENDENT) {
            return 1;
        }
    }
    return 0;
}

se3d_status se3d_system_touch(se3d_system *system)
{
    SE3DI_SET(system);
    if (leaves_user_rows_out(&system->model)) { /* do they still depend on others? */
        se3di_model_take_all_rows(&system->model);
    }
    se3di_model_touch_values(&system->model);
    se3di_model_touch_contact(&system->model);
    return SE3D_OK;
}

se3d_status se3d_system_get_gravity(const se3d_system *system, double gravity[3])
{
    if (!system || !gravity) {
        return SE3D_ERR_NULL;
    }
    se3di_copy(system->model.gravity, gravity);
    return SE3D_OK;
}

se3d_status se3d_system_get_gravity_function(const se3d_system *system, se3d_function gravity[3])
{
    if (!system || !gravity) {
        return SE3D_ERR_NULL;
    }
    for (int c = 0; c < 3; ++c) {
        gravity[c] = se3di_function_handle(&system->model, system->model.gravity_function[c]);
    }
    return SE3D_OK;
}

se3d_status se3d_system_set_time(se3d_system *system, double time)
{
    SE3DI_SET(system);
    SE3DI_TRY(se3di_check_finite(system, "time", time));
    system->model.time = time;
    for (se3di_particles *set = system->model.sets; set; set = set->next) {
        set->time = time;
    }
    se3di_model_touch_state(&system->model);
    return SE3D_OK;
}

se3d_status se3d_system_get_time(const se3d_system *system, double *time)
{
    if (!system || !time) {
        return SE3D_ERR_NULL;
    }
    *time = system->model.time;
    return SE3D_OK;
}

se3d_status se3d_system_get_ground(const se3d_system *system, se3d_body *ground)
{
    return se3d_system_get_body(system, 0, ground);
}

size_t se3d_system_count_bodies(const se3d_system *system)
{
    return system ? system->model.body_slots.count - system->model.state_count : 0;
}

size_t se3d_system_count_markers(const se3d_system *system)
{
    return system ? system->model.marker_slots.count : 0;
}

size_t se3d_system_count_constraints(const se3d_system *system)
{
    return system ? system->model.constraint_slots.count : 0;
}

size_t se3d_system_count_forces(const se3d_system *system)
{
    return system ? system->model.force_slots.count - system->model.state_count : 0;
}

se3d_status se3d_system_get_body(const se3d_system *system, size_t index, se3d_body *body)
{
    const int has_states = system && system->model.state_count > 0;
    const size_t dense = has_states ? se3di_model_nth_body(&system->model, index) : index;
    return se3di_read_handle(SE3DI_SLOTS(system, body), dense, body);
}

se3d_status se3d_system_get_marker(const se3d_system *system, size_t index, se3d_marker *marker)
{
    return se3di_read_handle(SE3DI_SLOTS(system, marker), index, marker);
}

se3d_status se3d_system_get_constraint(const se3d_system *system, size_t index,
                                       se3d_constraint *constraint)
{
    return se3di_read_handle(SE3DI_SLOTS(system, constraint), index, constraint);
}

se3d_status se3d_system_get_force(const se3d_system *system, size_t index, se3d_force *force)
{
    const int has_states = system && system->model.state_count > 0;
    const size_t dense = has_states ? se3di_model_nth_force(&system->model, index) : index;
    return se3di_read_handle(SE3DI_SLOTS(system, force), dense, force);
}

se3d_status se3d_system_get_energy_sized(const se3d_system *system, se3d_energy *energy,
                                         size_t size)
{
    if (!system || !energy) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    se3d_energy full = {.kinetic = se3di_kinetic_energy(model)};
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    double springs = 0.0; /* of contacts */
    const se3d_status status = se3di_loads_potential(model, model->time, &full.potential, &springs);
    full.total = full.kinetic + full.potential;
    full.dissipated = status < 0 ? 0.0 : se3di_work_lost(model, springs);
    SE3DI_TRY(se3di_read_end(&reading, status));
    return se3di_sized_give(energy, size, &full, sizeof full);
}

se3d_status se3d_system_get_work_sized(const se3d_system *system, se3d_work *work, size_t size)
{
    if (!system || !work) {
        return SE3D_ERR_NULL;
    }
    if (system->model.work_valid == SE3DI_WORK_UNKNOWN) {
        return SE3D_ERR_STATE;
    }
    double fed = 0.0;
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    const double springs = se3di_has_work(&system->model)
                               ? se3di_contacts_potential(&system->model, system->model.time)
                               : 0.0;
    const double lost = se3di_work_lost(&system->model, springs);
    SE3DI_TRY(se3di_read_end(&reading, se3di_work_fed(&system->model, &fed)));
    const se3d_work full = {.dissipated = lost, .actuators = fed, .drivers = system->model.work[2]};
    return se3di_sized_give(work, size, &full, sizeof full);
}

se3d_status se3d_system_get_violation(const se3d_system *system, double violation[3])
{
    if (!system || !violation) {
        return SE3D_ERR_NULL;
    }
    violation[0] = violation[1] = violation[2] = 0.0;
    SE3DI_TRY(se3di_check_solved(system));
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(system, &reading));
    return se3di_read_end(&reading, se3di_violation_measure(&system->model, violation));
}

uint64_t se3d_system_hash(const se3d_system *system)
{
    if (!system) {
        return 0;
    }
    const se3di_model *model = &system->model;
    se3di_pending_complete(model->pending);
    const int lacks = model->settled & SE3DI_LACKING; /* what is there is of another state */
    uint64_t hash = se3di_hash_numbers(SE3DI_HASH_START, &model->time, 1);
    for (size_t k = 0; k < model->body_slots.count; ++k) {
        const se3di_frame *frame = &model->frames[k];
        hash = se3di_hash_numbers(hash, frame->r, 3);
        hash = se3di_hash_numbers(hash, frame->p, 4);
        hash = se3di_hash_numbers(hash, frame->v, 3);
        hash = se3di_hash_numbers(hash, frame->w, 3);
        hash = se3di_hash_numbers(hash, model->acceleration + 6 * k, lacks ? 0 : 6);
    }
    hash = se3di_hash_numbers(hash, model->lambda, lacks ? 0 : model->row_count);
    for (size_t k = 0; model->broken_count > 0 && k < model->row_count; ++k) {
        hash = se3di_hash_word(hash, (uint64_t)(model->rows[k].left_out & SE3DI_ROW_BREAKS) >> 1);
    }
    for (const se3di_particles *set = model->sets; set; set = set->next) {
        hash = se3di_hash_word(hash, se3di_particles_hash(set));
    }
    return hash;
}
