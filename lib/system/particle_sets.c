/* SPDX-License-Identifier: BSD-3-Clause */
/* The particle sets that a system owns: found by name, cloned, saved and destroyed with it. */
#include "particles/chain.h"
#include "particles/sync.h"
#include "system/particles.h"

static se3d_particles *owner_of(se3di_particles *set)
{
    return (se3d_particles *)(void *)set;
}

static void unlink_copy(se3d_particles *particles)
{
    se3d_particles **link = &particles->system->copies;
    while (*link != particles) {
        link = &(*link)->next;
    }
    *link = particles->next;
}

void se3di_owner_unlink(se3d_particles *particles)
{
    if (particles->is_copy) {
        unlink_copy(particles);
    } else {
        se3di_sets_unlink(&particles->system->model, &particles->set);
    }
}

void se3di_owners_keep(se3d_system *system, int32_t kept)
{
    for (se3di_particles *set = system->model.sets; set; set = set->next) {
        owner_of(set)->kept = kept;
    }
}

void se3di_copies_orphan(se3d_system *system)
{
    for (se3d_particles *copy = system->copies; copy; copy = copy->next) {
        copy->system = NULL;
    }
    system->copies = NULL;
}

void se3di_owners_destroy(se3di_model *model)
{
    while (model->sets) {
        se3d_particles *particles = owner_of(model->sets);
        model->sets = particles->set.next;
        se3di_particles_destroy(&particles->set);
        se3di_free(&model->allocator, particles, 1, sizeof *particles);
    }
}

se3d_status se3di_owners_clone(const se3d_system *system, se3d_system *copy)
{
    const se3d_allocator *allocator = &copy->model.allocator;
    se3di_particles **last = &copy->model.sets;
    for (const se3di_particles *set = system->model.sets; set; set = set->next) {
        se3d_particles *particles = se3di_alloc(allocator, 1, sizeof *particles);
        if (!particles) {
            return SE3D_ERR_NO_MEMORY;
        }
        if (se3di_particles_clone(set, &particles->set) < 0) {
            se3di_free(allocator, particles, 1, sizeof *particles);
            return SE3D_ERR_NO_MEMORY;
        }
        particles->system = copy;
        particles->next = NULL;
        particles->is_copy = particles->kept = 0;
        se3di_particles_adopt(&particles->set, &copy->model);
        *last = &particles->set;
        last = &particles->set.next;
        if (set->name) {
            particles->set.name = se3di_text_copy(allocator, set->name);
            if (!particles->set.name) {
                return SE3D_ERR_NO_MEMORY;
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_check_particles_name(se3d_system *system, const char *name)
{
    if (!name) {
        return SE3D_OK;
    }
    SE3DI_TRY(se3di_check_name(system, name));
    if (se3di_sets_find(&system->model, name)) {
        return SE3DI_FAIL_OF(system, "name", SE3D_ERR_INVALID_ARGUMENT,
                             " = \"%.64s\" is taken by other particles, must be unique", name);
    }
    return SE3D_OK;
}

se3d_status se3d_particles_find(const se3d_system *system, const char *name,
                                se3d_particles **particles)
{
    if (particles) {
        *particles = NULL;
    }
    if (!system || !name || !particles) {
        return SE3D_ERR_NULL;
    }
    se3di_particles *set = se3di_sets_find(&system->model, name);
    *particles = set ? owner_of(set) : NULL;
    return set ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3d_particles_get_name(const se3d_particles *particles, const char **name)
{
    if (name) {
        *name = NULL;
    }
    if (!particles || !name) {
        return SE3D_ERR_NULL;
    }
    *name = particles->set.name ? particles->set.name : "";
    return SE3D_OK;
}

size_t se3d_system_count_particles(const se3d_system *system)
{
    size_t count = 0;
    for (const se3di_particles *set = system ? system->model.sets : NULL; set; set = set->next) {
        ++count;
    }
    return count;
}

se3d_status se3d_system_get_particles(const se3d_system *system, size_t index,
                                      se3d_particles **particles)
{
    if (particles) {
        *particles = NULL;
    }
    if (!system || !particles) {
        return SE3D_ERR_NULL;
    }
    se3di_particles *set = se3di_sets_get(&system->model, index);
    *particles = set ? owner_of(set) : NULL;
    return set ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}
