/* SPDX-License-Identifier: BSD-3-Clause */
/* Fields of particles on a grid. */
#include "particles/field.h"

#include "system/particles.h"

#include <string.h>

#define SIZE_LEAST 1e-30
#define SIZE_MOST  1e30
#define CELLS_MOST 1e8

void se3d_field_grid_init(se3d_field_grid *grid, size_t size)
{
    se3d_field_grid defaults = {.struct_size = size, .tag = -1};
    se3di_def_init(grid, size, &defaults, sizeof defaults);
}

/* What the caller knows of a grid. */
static int read_grid(const se3d_field_grid *grid, se3d_field_grid *full)
{
    *full = se3d_field_grid_default();
    if (grid->struct_size < sizeof(size_t) || grid->struct_size > sizeof *full) {
        return 0;
    }
    memcpy(full, grid, grid->struct_size);
    full->struct_size = sizeof *full;
    return 1;
}

/* Whether there is such a grid, with so many numbers. */
static int is_grid(const se3d_field_grid *grid, size_t count)
{
    double cells = 1.0;
    int is = grid->width >= SIZE_LEAST && grid->width <= SIZE_MOST && grid->tag >= -1 &&
             grid->tag < SE3D_PARTICLES_TAGS;
    for (int a = 0; a < 3; ++a) {
        cells *= grid->cells[a];
        is = is && grid->cells[a] >= 1 && grid->lower[a] >= -SIZE_MOST &&
             grid->upper[a] <= SIZE_MOST && grid->upper[a] - grid->lower[a] >= SIZE_LEAST;
    }
    return is && cells <= CELLS_MOST && count == (size_t)cells * SE3D_FIELD_VALUES;
}

se3d_status se3d_particles_get_fields(const se3d_particles *particles, const se3d_field_grid *grid,
                                      size_t count, double *values)
{
    se3d_field_grid full;
    se3di_reading reading;
    SE3DI_OWNED(particles);
    if (!grid || !values) {
        return SE3D_ERR_NULL;
    }
    if (!read_grid(grid, &full) || !is_grid(&full, count)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    SE3DI_TRY(se3di_read_begin(particles->system, &reading));
    se3di_particles_fields(&particles->set, &full, se3di_particles_are_current(particles), values);
    return se3di_read_end(&reading, SE3D_OK);
}
