/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts between bodies, read. */
#include "contact/bodies/body_contacts.h"
#include "math/vec3.h"
#include "particles/contacts.h"
#include "particles/set.h"
#include "se3d/contact.h"
#include "system/system_internal.h"

#include <math.h>

size_t se3d_system_count_contacts(const se3d_system *system)
{
    return system ? system->model.contacts.count : 0;
}

static se3d_shape shape_at(const se3di_model *model, uint32_t index)
{
    se3di_handle handle = se3di_slots_handle(&model->shape_slots, index);
    return (se3d_shape){handle.index1, handle.generation};
}

se3d_status se3d_system_get_contact_force_max(const se3d_system *system, double *force)
{
    if (!system || !force) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    *force = 0.0;
    for (size_t k = 0; k < model->contacts.count; ++k) {
        *force = fmax(*force, se3di_norm(model->contacts.list[k].force));
    }
    se3di_reading reading;
    se3d_status status = se3di_read_begin(system, &reading);
    SE3DI_TRY(status);
    for (const se3di_particles *set = model->sets; set && status >= 0; set = set->next) {
        size_t count;
        status = se3di_particles_contacts(set, 0, NULL, 0, &count, force);
    }
    return se3di_read_end(&reading, status < 0 ? status : SE3D_OK);
}

size_t se3d_system_count_passing_meshes(const se3d_system *system, se3d_shape *i, se3d_shape *j)
{
    se3d_shape first[2] = {{0, 0}, {0, 0}};
    size_t count = 0;
    const uint32_t shapes = system ? (uint32_t)system->model.shape_slots.count : 0;
    for (uint32_t b = 1; b < shapes; ++b) {
        for (uint32_t a = 0; a < b; ++a) {
            if (se3di_shapes_pass_through(&system->model, a, b) && count++ == 0) {
                first[0] = shape_at(&system->model, a);
                first[1] = shape_at(&system->model, b);
            }
        }
    }
    if (i) {
        *i = first[0];
    }
    if (j) {
        *j = first[1];
    }
    return count;
}

se3d_status se3d_system_get_contacts_sized(const se3d_system *system, size_t count,
                                           se3d_contact *contacts, size_t size)
{
    if (!system || (!contacts && count > 0)) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    if (count != model->contacts.count) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    for (size_t k = 0; k < count; ++k) {
        const se3di_body_contact *from = &model->contacts.list[k];
        se3d_contact to;
        to.shape_i = shape_at(model, from->shape_i);
        to.shape_j = shape_at(model, from->shape_j);
        to.overlap = from->overlap;
        se3di_copy(from->point, to.point);
        se3di_copy(from->normal, to.normal);
        se3di_copy(from->force, to.force);
        SE3DI_TRY(se3di_sized_give((unsigned char *)contacts + k * size, size, &to, sizeof to));
    }
    return SE3D_OK;
}
