/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles and what they touch: wrenches on bodies, contacts as they are. */
#include "particles/contacts.h"
#include "particles/energy.h"
#include "system/particles.h"

#include <string.h>

se3d_status se3d_particles_get_wrench(const se3d_particles *particles, se3d_body body,
                                      double force[3], double torque[3])
{
    SE3DI_OWNED(particles);
    if (!force || !torque) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &particles->system->model;
    if (se3di_slots_find(&model->body_slots, body.index1, body.generation) == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    memset(force, 0, 3 * sizeof *force);
    memset(torque, 0, 3 * sizeof *torque);
    const se3di_floats host = se3di_floats_set();
    se3di_particles_push_body(&particles->set, SE3DI_HANDLE(body), force, torque);
    se3di_floats_restore(host);
    return SE3D_OK;
}

int se3di_particles_are_current(const se3d_particles *particles)
{
    return particles->set.topology_version == particles->system->model.topology_version;
}

/* What se3di_particles_contacts lists, by the law. */
static se3d_status list(const se3d_particles *particles, size_t most, void *contacts, size_t size,
                        size_t *count)
{
    se3di_reading reading;
    SE3DI_TRY(se3di_read_begin(particles->system, &reading));
    return se3di_read_end(
        &reading, se3di_particles_contacts(&particles->set, most, contacts, size, count, NULL));
}

size_t se3d_particles_count_contacts(const se3d_particles *particles)
{
    size_t count = 0;
    if (particles && particles->system && se3di_particles_are_current(particles)) {
        (void)list(particles, SIZE_MAX, NULL, 0, &count);
    }
    return count;
}

se3d_status se3d_particles_get_contacts_sized(const se3d_particles *particles, size_t count,
                                              se3d_particles_contact *contacts, size_t size)
{
    SE3DI_OWNED(particles);
    if (!contacts) {
        return SE3D_ERR_NULL;
    }
    if (size == 0 || size > sizeof *contacts + SE3DI_SIZED_GROWTH) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    size_t found = 0;
    if (se3di_particles_are_current(particles)) { /* once: every contact calls the law */
        SE3DI_TRY(list(particles, count, contacts, size, &found));
    }
    return found == count ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}
