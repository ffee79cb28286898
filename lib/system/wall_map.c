/* SPDX-License-Identifier: BSD-3-Clause */
/* What particles do to the patches of a surface. */
#include "particles/wall_map.h"

#include "system/particles.h"

/* The shape, if it is a surface. */
static se3d_status find_surface(const se3d_particles *particles, se3d_shape shape,
                                const se3di_shape **surface)
{
    const se3di_model *model = &particles->system->model;
    const uint32_t index = se3di_slots_find(&model->shape_slots, shape.index1, shape.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    *surface = &model->shapes[index];
    return se3di_wall_map_count(*surface) > 0 ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3d_particles_get_wall_map(const se3d_particles *particles, se3d_shape shape,
                                        size_t capacity, double *values, size_t *count)
{
    se3di_reading reading;
    const se3di_shape *surface = NULL;
    SE3DI_OWNED(particles);
    if (!count || (!values && capacity > 0)) {
        return SE3D_ERR_NULL;
    }
    *count = 0;
    SE3DI_TRY(se3di_read_begin(particles->system, &reading));
    const se3d_status status = find_surface(particles, shape, &surface);
    if (status >= 0) {
        const se3di_handle handle = {shape.index1, shape.generation};
        const se3di_wall *wall = se3di_wall_map_find(&particles->set, handle);
        const int forces = wall && se3di_particles_are_current(particles);
        se3di_wall_map_fill(&particles->set, forces ? wall : NULL, surface,
                            capacity / SE3D_WALL_VALUES, values);
        *count = se3di_wall_map_count(surface) * SE3D_WALL_VALUES;
    }
    return se3di_read_end(&reading, status);
}

se3d_status se3d_particles_get_wall_corners(const se3d_particles *particles, se3d_shape shape,
                                            size_t capacity, double *corners, size_t *count)
{
    se3di_reading reading;
    const se3di_shape *surface = NULL;
    SE3DI_OWNED(particles);
    if (!count || (!corners && capacity > 0)) {
        return SE3D_ERR_NULL;
    }
    *count = 0;
    SE3DI_TRY(se3di_read_begin(particles->system, &reading));
    const se3d_status status = find_surface(particles, shape, &surface);
    if (status >= 0) {
        const size_t patches = se3di_wall_map_count(surface), room = capacity / SE3D_WALL_CORNERS;
        for (size_t k = 0; k < patches && k < room; ++k) {
            se3di_wall_map_get_corners(surface, k, corners + k * SE3D_WALL_CORNERS);
        }
        *count = patches * SE3D_WALL_CORNERS;
    }
    return se3di_read_end(&reading, status);
}
