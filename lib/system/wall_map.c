/* SPDX-License-Identifier: BSD-3-Clause */
/* What particles do to the triangles of a mesh. */
#include "particles/wall_map.h"

#include "system/particles.h"

se3d_status se3d_particles_get_wall_map(const se3d_particles *particles, se3d_shape shape,
                                        size_t capacity, double *values, size_t *count)
{
    se3di_reading reading;
    SE3DI_OWNED(particles);
    if (!count || (!values && capacity > 0)) {
        return SE3D_ERR_NULL;
    }
    *count = 0;
    SE3DI_TRY(se3di_read_begin(particles->system, &reading));
    const se3di_handle handle = {shape.index1, shape.generation};
    const se3di_model *model = &particles->system->model;
    const uint32_t index = se3di_slots_find(&model->shape_slots, handle.index1, handle.generation);
    if (index == SE3DI_NO_INDEX) {
        return se3di_read_end(&reading, SE3D_ERR_STALE_HANDLE);
    }
    const se3di_shape *mesh = &model->shapes[index];
    if (mesh->kind != SE3DI_SHAPE_MESH) {
        return se3di_read_end(&reading, SE3D_ERR_INVALID_ARGUMENT);
    }
    const se3di_wall *wall = se3di_wall_map_find(&particles->set, handle);
    const int forces = wall && se3di_particles_are_current(particles);
    se3di_wall_map_fill(&particles->set, forces ? wall : NULL, mesh, capacity / SE3D_WALL_VALUES,
                        values);
    *count = mesh->triangle_count * SE3D_WALL_VALUES;
    return se3di_read_end(&reading, SE3D_OK);
}
