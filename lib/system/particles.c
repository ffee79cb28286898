/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles: creation, bulk access, stepping. */
#include "system/particles.h"

#include "base/sized.h"
#include "force/force.h"
#include "math/vec3.h"
#include "particles/audit.h"
#include "particles/bond.h"
#include "particles/chain.h"
#include "particles/clump.h"
#include "particles/energy.h"
#include "particles/list.h"
#include "particles/step.h"
#include "particles/sync.h"

#include <math.h>
#include <string.h>

#define THREADS_MAX 1024

void se3d_particles_def_init(se3d_particles_def *def, size_t size)
{
    se3d_particles_def defaults = {
        .struct_size = size, .threads = 1, .skin = 0.1, .group = 1, .mask = UINT32_MAX};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_domain(se3d_system *system, const se3d_particles_def *def)
{
    for (int a = 0; a < 3; ++a) {
        if (def->boundary[a] < SE3D_DOMAIN_BOUNDARY_OPEN ||
            def->boundary[a] > SE3D_DOMAIN_BOUNDARY_SINK) {
            return SE3DI_FAIL_OF(system, "boundary", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%d] = %d, must be an se3d_domain_boundary", a, def->boundary[a]);
        }
        int used = def->boundary[a] != SE3D_DOMAIN_BOUNDARY_OPEN;
        int finite = isfinite(def->lower[a]) && isfinite(def->upper[a]);
        if (used && !(finite && def->upper[a] > def->lower[a])) {
            return SE3DI_FAIL_OF(system, "lower", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%d] = %g and upper[%d] = %g, must be finite and increasing if "
                                 "the boundary is not open",
                                 a, def->lower[a], a, def->upper[a]);
        }
    }
    return SE3D_OK;
}

static se3d_status check_particles_def(se3d_system *system, const se3d_particles_def *def)
{
    if (def->threads < 1 || def->threads > THREADS_MAX) {
        return SE3DI_FAIL_OF(system, "threads", SE3D_ERR_INVALID_ARGUMENT,
                             " = %d, must be at least 1 and at most %d", def->threads, THREADS_MAX);
    }
    if (!(isfinite(def->step) && def->step >= 0.0)) {
        return SE3DI_FAIL_OF(system, "step", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite and >= 0 (0: automatic)", def->step);
    }
    if (!(def->skin > 0.0 && def->skin <= 10.0)) {
        return SE3DI_FAIL_OF(system, "skin", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g, must be > 0 and <= 10", def->skin);
    }
    return check_domain(system, def);
}

se3d_status se3d_particles_create(se3d_system *system, const se3d_particles_def *def,
                                  se3d_particles **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT(system);
    SE3DI_TRY(se3di_check_pointer(system, "out", out));
    se3d_particles_def full = se3d_particles_def_default();
    if (def) {
        SE3DI_TRY(se3di_check_def(system, "particles def", def, &full, sizeof full));
    }
    SE3DI_TRY(check_particles_def(system, &full));
    SE3DI_TRY(se3di_check_particles_name(system, full.name));
    const se3d_allocator *allocator = &system->model.allocator;
    se3d_particles *particles = se3di_alloc(allocator, 1, sizeof *particles);
    if (!particles) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for particles");
    }
    se3di_particles *set = &particles->set;
    se3di_particles_init(set, allocator);
    particles->system = system;
    particles->next = NULL;
    particles->is_copy = particles->kept = 0;
    set->threads = full.threads;
    set->kernels = se3di_particle_kernels_choose(full.portable);
    set->audits = full.audit != 0;
    memcpy(set->boundary, full.boundary, sizeof set->boundary);
    memcpy(set->lower, full.lower, sizeof set->lower);
    memcpy(set->upper, full.upper, sizeof set->upper);
    set->step = full.step;
    set->skin_ratio = full.skin;
    set->group = full.group;
    set->mask = full.mask;
    set->time = system->model.time;
    if (full.name) {
        set->name = se3di_text_copy(allocator, full.name);
        if (!set->name) {
            se3di_free(allocator, particles, 1, sizeof *particles);
            return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for the name of particles");
        }
    }
    se3di_sets_link(&system->model, set);
    *out = particles;
    return SE3D_OK;
}

se3d_status se3di_particles_use(se3d_particles *particles, se3d_material material, uint32_t *index)
{
    se3d_system *system = particles->system;
    uint32_t dense;
    SE3DI_TRY(se3di_find_material(system, "material", material, &dense));
    if (se3di_particles_hold(&particles->set, &system->model, dense, index) < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a material");
    }
    return SE3D_OK;
}

void se3d_particles_destroy(se3d_particles *particles)
{
    if (!particles ||
        (particles->system && se3di_enter(particles->system, SE3DI_BUSY_FREE, __func__) < 0)) {
        return;
    }
    if (particles->system && particles->kept) {
        (void)SE3DI_FAIL(particles->system, SE3D_ERR_STATE,
                         "se3d_particles_destroy is not allowed: they belong to the model, or to "
                         "whoever else keeps their system (se3d_system_set_kept)");
        return;
    }
    const se3d_allocator allocator = particles->set.allocator;
    if (particles->system) {
        se3di_particles_count_users(&particles->set, &particles->system->model, 0);
        se3di_owner_unlink(particles);
    }
    se3di_particles_destroy(&particles->set);
    se3di_free(&allocator, particles, 1, sizeof *particles);
}

se3d_status se3d_particles_clone(const se3d_particles *particles, se3d_particles **out)
{
    if (out) {
        *out = NULL;
    }
    SE3DI_EDIT_OF(particles);
    if (!out) {
        return SE3D_ERR_NULL;
    }
    const se3d_allocator *allocator = &particles->set.allocator;
    se3d_particles *copy = se3di_alloc(allocator, 1, sizeof *copy);
    if (!copy) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_status status = se3di_particles_clone(&particles->set, &copy->set);
    if (status < 0) {
        se3di_free(allocator, copy, 1, sizeof *copy);
        return status;
    }
    copy->system = particles->system;
    copy->is_copy = 1;
    copy->kept = 0;
    copy->next = copy->system->copies;
    copy->system->copies = copy;
    se3di_particles_count_users(&copy->set, &copy->system->model, 1);
    *out = copy;
    return SE3D_OK;
}

se3d_status se3d_particles_restore(se3d_particles *particles, const se3d_particles *saved)
{
    SE3DI_EDIT_OF(particles);
    SE3DI_TRY(se3di_check_pointer(particles->system, "saved", saved));
    if (saved->system != particles->system) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_STATE,
                          "the saved particles belong to another system");
    }
    se3di_particles copy;
    if (se3di_particles_clone(&saved->set, &copy) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY,
                          "no memory to restore %zu particles", saved->set.count);
    }
    se3di_particles_count_users(&particles->set, &particles->system->model, 0);
    se3di_particles_replace(&particles->set, &copy);
    se3di_particles_count_users(&particles->set, &particles->system->model, 1);
    return SE3D_OK;
}

se3d_status se3di_particles_make_room(se3d_particles *particles, size_t count)
{
    se3di_particles *set = &particles->set;
    if (count > SE3DI_CARRY_WALL - set->id_count - 1 || count > SE3DI_CARRY_WALL - set->count - 1) {
        return SE3DI_FAIL_OF(particles->system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, at most 2^31 particles can be made", count);
    }
    if (se3di_particles_reserve(set, set->count + count) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory for %zu particles",
                          count);
    }
    return SE3D_OK;
}

se3d_status se3di_check_tag(se3d_particles *particles, uint32_t tag)
{
    if (tag >= SE3D_PARTICLES_TAGS) {
        return SE3DI_FAIL_OF(particles->system, "tag", SE3D_ERR_INVALID_ARGUMENT,
                             " = %u, must be less than %d", tag, SE3D_PARTICLES_TAGS);
    }
    return SE3D_OK;
}

se3d_status se3di_check_period(se3d_particles *particles, double radius)
{
    const se3di_particles *set = &particles->set;
    for (int a = 0; a < 3; ++a) {
        double length = set->upper[a] - set->lower[a];
        if (set->boundary[a] == SE3DI_BOUNDARY_PERIODIC && length < SE3DI_PERIOD_LEAST * radius) {
            return SE3DI_FAIL_OF(particles->system, "radius", SE3D_ERR_INVALID_ARGUMENT,
                                 " = %g m, the domain is periodic along %c and only %g m long, "
                                 "must be at least %g radii",
                                 radius, "xyz"[a], length, SE3DI_PERIOD_LEAST);
        }
    }
    return SE3D_OK;
}

static se3d_status check_finite_array(se3d_particles *particles, const char *what,
                                      const double *values, size_t count)
{
    for (size_t k = 0; values && k < count; ++k) {
        if (!isfinite(values[k])) {
            return SE3DI_FAIL_OF(particles->system, what, SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] = %g, must be finite", k, values[k]);
        }
    }
    return SE3D_OK;
}

se3d_status se3d_particles_add(se3d_particles *particles, se3d_material material, size_t count,
                               const double *r, const double *radius, const double *v,
                               const double *w, uint32_t *first)
{
    SE3DI_EDIT_OF(particles);
    uint32_t index;
    SE3DI_TRY(se3di_check_pointer(particles->system, "r", r));
    SE3DI_TRY(se3di_check_pointer(particles->system, "radius", radius));
    for (size_t k = 0; k < count; ++k) {
        if (!(isfinite(radius[k]) && radius[k] > 0.0)) {
            return SE3DI_FAIL_OF(particles->system, "radius", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] = %g m, must be finite and > 0", k, radius[k]);
        }
        SE3DI_TRY(se3di_check_period(particles, radius[k]));
    }
    SE3DI_TRY(check_finite_array(particles, "r", r, 3 * count));
    SE3DI_TRY(check_finite_array(particles, "v", v, 3 * count));
    SE3DI_TRY(check_finite_array(particles, "w", w, 3 * count));
    SE3DI_TRY(se3di_particles_use(particles, material, &index));
    SE3DI_TRY(se3di_particles_make_room(particles, count));
    if (first) {
        *first = (uint32_t)particles->set.id_count;
    }
    for (size_t k = 0; k < count; ++k) {
        (void)se3di_particles_append(&particles->set, index, radius[k], r + 3 * k,
                                     v ? v + 3 * k : NULL, w ? w + 3 * k : NULL);
    }
    return SE3D_OK;
}

static se3d_status check_ids(se3d_particles *particles, size_t count, const uint32_t *ids)
{
    const se3di_particles *set = &particles->set;
    for (size_t k = 0; k < count; ++k) {
        if (ids[k] >= set->id_count || set->index_of[ids[k]] == SE3DI_NO_INDEX) {
            return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                              "ids[%zu] = %u does not name a live particle", k, ids[k]);
        }
    }
    return SE3D_OK;
}

se3d_status se3d_particles_remove(se3d_particles *particles, size_t count, const uint32_t *ids)
{
    SE3DI_EDIT_OF(particles);
    se3di_particles *set = &particles->set;
    if (count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_pointer(particles->system, "ids", ids));
    SE3DI_TRY(check_ids(particles, count, ids));
    if (se3di_particles_remove(set, count, ids) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory to remove particles");
    }
    return SE3D_OK;
}

size_t se3d_particles_count(const se3d_particles *particles)
{
    return particles ? particles->set.count : 0;
}

se3d_status se3d_particles_set_tags(se3d_particles *particles, size_t count, const uint32_t *ids,
                                    uint32_t tag)
{
    SE3DI_SET_OF(particles);
    if (count > 0) {
        SE3DI_TRY(se3di_check_pointer(particles->system, "ids", ids));
    }
    SE3DI_TRY(se3di_check_tag(particles, tag));
    SE3DI_TRY(check_ids(particles, count, ids));
    const se3di_particles *set = &particles->set;
    for (size_t k = 0; k < count; ++k) {
        uint32_t id, end;
        for (se3di_clump_range(set, ids[k], &id, &end); id < end; ++id) {
            set->spins[set->index_of[id]].tag = (uint16_t)tag;
        }
    }
    return SE3D_OK;
}

static se3d_status check_free(se3d_particles *particles, size_t count, const uint32_t *ids)
{
    const se3di_particles *set = &particles->set;
    if (set->cell.count > 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_STATE,
                          "the domain strains (se3d/cell.h): its particles cannot be fixed");
    }
    for (size_t k = 0; k < count; ++k) {
        if (se3di_clump_find(set, set->index_of[ids[k]])) {
            return SE3DI_FAIL(particles->system, SE3D_ERR_INVALID_ARGUMENT,
                              "ids[%zu] = %u is a sphere of a clump, which cannot be fixed", k,
                              ids[k]);
        }
    }
    return SE3D_OK;
}

se3d_status se3d_particles_set_fixed(se3d_particles *particles, size_t count, const uint32_t *ids,
                                     int32_t fixed)
{
    SE3DI_EDIT_OF(particles);
    if (count == 0) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_pointer(particles->system, "ids", ids));
    SE3DI_TRY(check_ids(particles, count, ids));
    if (fixed) {
        SE3DI_TRY(check_free(particles, count, ids));
    }
    if (se3di_particles_collect(&particles->set) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory to fix particles");
    }
    for (size_t k = 0; k < count; ++k) {
        se3di_particles_fix(&particles->set, ids[k], fixed != 0);
        se3di_bonds_damp(&particles->set, ids[k]);
    }
    return SE3D_OK;
}

/* The size that arrays must have. */
static se3d_status check_count(const se3d_particles *particles, size_t count)
{
    if (!particles) {
        return SE3D_ERR_NULL;
    }
    return count == particles->set.count ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3d_particles_get_ids(const se3d_particles *particles, size_t count, uint32_t *ids)
{
    SE3DI_TRY(check_count(particles, count));
    if (!ids) {
        return SE3D_ERR_NULL;
    }
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        ids[k] = particles->set.spins[se3di_particles_next(&particles->set, &id)].id;
    }
    return SE3D_OK;
}

se3d_status se3d_particles_get_tags(const se3d_particles *particles, size_t count, uint32_t *tags)
{
    SE3DI_TRY(check_count(particles, count));
    if (!tags) {
        return SE3D_ERR_NULL;
    }
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        tags[k] = particles->set.spins[se3di_particles_next(&particles->set, &id)].tag;
    }
    return SE3D_OK;
}

se3d_status se3d_particles_get_materials(const se3d_particles *particles, size_t count,
                                         se3d_material *materials)
{
    SE3DI_TRY(check_count(particles, count));
    if (!materials) {
        return SE3D_ERR_NULL;
    }
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        uint32_t material =
            particles->set.spins[se3di_particles_next(&particles->set, &id)].material;
        se3di_handle handle = particles->set.stuffs[material].handle;
        materials[k] = (se3d_material){handle.index1, handle.generation};
    }
    return SE3D_OK;
}

se3d_status se3d_particles_get_radii(const se3d_particles *particles, size_t count, double *radius)
{
    SE3DI_TRY(check_count(particles, count));
    if (!radius) {
        return SE3D_ERR_NULL;
    }
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        radius[k] = particles->set.particles[se3di_particles_next(&particles->set, &id)].radius;
    }
    return SE3D_OK;
}

se3d_status se3d_particles_get_all(const se3d_particles *particles, size_t count, double *r,
                                   double *v, double *w)
{
    SE3DI_TRY(check_count(particles, count));
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        size_t index = se3di_particles_next(&particles->set, &id);
        const se3di_particle *particle = &particles->set.particles[index];
        if (r) {
            se3di_copy(particle->x, r + 3 * k);
        }
        if (v) {
            se3di_copy(particle->v, v + 3 * k);
        }
        if (w) {
            se3di_copy(particles->set.spins[index].w, w + 3 * k);
        }
    }
    return SE3D_OK;
}

se3d_status se3d_particles_set_all(se3d_particles *particles, size_t count, const double *r,
                                   const double *v, const double *w)
{
    SE3DI_SET_OF(particles);
    se3di_particles *set = &particles->set;
    if (count != set->count) {
        return SE3DI_FAIL_OF(particles->system, "count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be the number of particles, %zu", count, set->count);
    }
    SE3DI_TRY(check_finite_array(particles, "r", r, 3 * count));
    SE3DI_TRY(check_finite_array(particles, "v", v, 3 * count));
    SE3DI_TRY(check_finite_array(particles, "w", w, 3 * count));
    if (r && se3di_particles_collect(set) < 0) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_NO_MEMORY, "no memory to move particles");
    }
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        size_t index = se3di_particles_next(set, &id);
        if (se3di_clump_find(set, index)) {
            continue;
        }
        if (r) {
            se3di_copy(r + 3 * k, set->particles[index].x);
        }
        if (v) {
            se3di_copy(v + 3 * k, set->particles[index].v);
        }
        if (w) {
            se3di_copy(w + 3 * k, set->spins[index].w);
        }
    }
    set->force_valid = 0;
    return SE3D_OK;
}

se3d_status se3d_particles_get_forces(const se3d_particles *particles, size_t count, double *force,
                                      double *torque)
{
    SE3DI_TRY(check_count(particles, count));
    size_t id = 0;
    for (size_t k = 0; k < count; ++k) {
        static const se3di_load none; /* after an edit there are no forces yet */
        size_t index = se3di_particles_next(&particles->set, &id);
        const se3di_load *load = particles->set.list_valid ? &particles->set.loads[index] : &none;
        if (force) {
            se3di_copy(load->force, force + 3 * k);
        }
        if (torque) {
            se3di_copy(load->torque, torque + 3 * k);
        }
    }
    return SE3D_OK;
}

static se3d_status advance(se3d_particles *particles, double h, double length, size_t steps)
{
    se3d_system *system = particles->system;
    se3di_work_begin(system);
    return se3di_work_end(system, se3di_particles_run(&particles->set, &system->model, h, length,
                                                      steps, &system->found));
}

se3d_status se3d_particles_step(se3d_particles *particles, size_t steps)
{
    SE3DI_EDIT_OF(particles);
    double h = se3di_particles_want_step(&particles->set, &particles->system->model);
    if (steps == 0 || se3di_particles_is_idle(&particles->set)) {
        particles->set.time += h * (double)steps;
        return SE3D_OK;
    }
    return advance(particles, h, h, steps);
}

se3d_status se3d_particles_run(se3d_particles *particles, double time)
{
    SE3DI_EDIT_OF(particles);
    se3di_particles *set = &particles->set;
    if (!(isfinite(time) && time >= set->time)) {
        return SE3DI_FAIL_OF(particles->system, "time", SE3D_ERR_INVALID_ARGUMENT,
                             " = %g s, must be finite and not before %g s", time, set->time);
    }
    double h = se3di_particles_want_step(&particles->set, &particles->system->model);
    double steps = h > 0.0 ? ceil((time - set->time) / h - 1e-9) : 0.0;
    if (steps > SE3DI_STEPS_MOST) {
        return SE3DI_FAIL(particles->system, SE3D_ERR_STEP_COUNT,
                          "a step of %g s needs %g steps until %g s, must be at most %g", h, steps,
                          time, SE3DI_STEPS_MOST);
    }
    if (steps > 0.0 && !se3di_particles_is_idle(set)) {
        const double length = (time - set->time) / steps;
        SE3DI_TRY(advance(particles, h, length, (size_t)steps));
    }
    set->time = time;
    return SE3D_OK;
}

se3d_status se3d_particles_get_step(const se3d_particles *particles, double *step)
{
    SE3DI_OWNED(particles);
    if (!step) {
        return SE3D_ERR_NULL;
    }
    const se3di_floats host = se3di_floats_set();
    *step = se3di_particles_want_step(&particles->set, &particles->system->model);
    se3di_floats_restore(host);
    return SE3D_OK;
}

se3d_status se3d_particles_set_step(se3d_particles *particles, double step)
{
    SE3DI_SET_OF(particles);
    SE3DI_TRY(se3di_check_range(particles->system, "step", step, 0.0, 1e30));
    particles->set.step = step;
    return SE3D_OK;
}

se3d_status se3d_particles_get_time(const se3d_particles *particles, double *time)
{
    if (!particles || !time) {
        return SE3D_ERR_NULL;
    }
    *time = particles->set.time;
    return SE3D_OK;
}

se3d_status se3di_particles_gravity(const se3d_particles *particles, double g[3])
{
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(particles->system, &reading));
    return se3di_read_end(
        &reading, se3di_gravity_eval(&particles->system->model, particles->set.time, g, NULL));
}

se3d_status se3d_particles_get_energy_sized(const se3d_particles *particles,
                                            se3d_particles_energy *energy, size_t size)
{
    SE3DI_OWNED(particles);
    if (!energy) {
        return SE3D_ERR_NULL;
    }
    double g[3];
    SE3DI_TRY(se3di_particles_gravity(particles, g));
    const se3di_floats host = se3di_floats_set();
    const se3d_particles_energy full = se3di_particles_energy(&particles->set, g);
    se3di_floats_restore(host);
    return se3di_sized_give(energy, size, &full, sizeof full);
}

se3d_status se3d_particles_get_dissipation_sized(const se3d_particles *particles,
                                                 se3d_particles_dissipation *out, size_t size)
{
    if (!particles || !out) {
        return SE3D_ERR_NULL;
    }
    const se3di_particles *set = &particles->set;
    if (!set->audits) {
        return SE3D_ERR_STATE;
    }
    const se3di_floats host = se3di_floats_set();
    double elastic[SE3DI_AUDIT_KINDS];
    se3di_audit_elastic(set, elastic);
    se3d_particles_dissipation full = {.normal = set->audit_work[0],
                                       .tangential = set->audit_work[1] - elastic[1],
                                       .rolling = set->audit_work[2] - elastic[2],
                                       .torsion = set->audit_work[3] - elastic[3],
                                       .wall_work = set->wall_work};
    for (int k = 0; k < SE3DI_AUDIT_KINDS; ++k) {
        full.elastic += elastic[k];
    }
    for (size_t k = 0; k < set->bond_group_count; ++k) {
        full.bonds += set->bond_groups[k].dissipated;
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        full.bonds += set->bonds[k].dissipated;
    }
    se3di_floats_restore(host);
    return se3di_sized_give(out, size, &full, sizeof full);
}

se3d_status se3d_particles_get_stats_sized(const se3d_particles *particles,
                                           se3d_particles_stats *stats, size_t size)
{
    if (!particles || !stats) {
        return SE3D_ERR_NULL;
    }
    const se3d_particles_stats full = se3di_particles_stats(&particles->set);
    return se3di_sized_give(stats, size, &full, sizeof full);
}

uint64_t se3d_particles_hash(const se3d_particles *particles)
{
    return particles ? se3di_particles_hash(&particles->set) : 0;
}
