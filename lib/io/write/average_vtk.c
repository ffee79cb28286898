/* SPDX-License-Identifier: BSD-3-Clause */
/* Averages for ParaView: fields as an image, what particles do to a wall as its patches, in the
 * frame of its body. */
#include <errno.h>
#include <string.h>

#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/write/average.h"
#include "io/write/vtk.h"
#include "io/write/vtk_file.h"

enum { ARRAYS = 7, CORNERS_MOST = 4 };

/* Corners of the patches, as many points of each as *each says. */
static double *list_points(const se3di_average_sum *a, se3di_iopool *pool, size_t *each)
{
    size_t count = a->cells * SE3D_WALL_CORNERS;
    int32_t type = SE3D_SHAPE_MESH;
    double *points = se3di_iopool_array(pool, a->cells + 1, SE3D_WALL_CORNERS * sizeof *points);
    errno = ENOMEM;
    if (!points ||
        se3d_particles_get_wall_corners(a->model->particles->set, a->wall, count, points, &count) <
            0 ||
        se3d_shape_get_type(a->model->system, a->wall, &type) < 0) {
        return NULL;
    }
    *each = type == SE3D_SHAPE_FUNNEL ? CORNERS_MOST : CORNERS_MOST - 1;
    for (size_t k = 1; k < a->cells && *each < CORNERS_MOST; ++k) {
        memmove(points + k * 3 * *each, points + k * SE3D_WALL_CORNERS, 3 * *each * sizeof *points);
    }
    return points;
}

static bool write_wall(const se3di_average_sum *a, se3di_iopool *pool, const double *values,
                       const se3di_vtk_target *to)
{
    size_t each = 0;
    const double *points = list_points(a, pool, &each);
    if (!points) {
        return false;
    }
    const size_t n = a->cells;
#define WALL(name, first, width)                                                                   \
    {                                                                                              \
        SE3DI_VTK_CELL_DATA, name, values + (first), n, width, SE3D_WALL_VALUES, 0.0, 0.0, false   \
    }
    const se3di_vtk_array arrays[ARRAYS] = {
        WALL("area", SE3D_WALL_AREA, 1),
        WALL("pressure", SE3D_WALL_PRESSURE, 1),
        WALL("shear", SE3D_WALL_SHEAR, 3),
        WALL("sliding", SE3D_WALL_SLIDING, 1),
        {SE3DI_VTK_POINTS, "points", points, each * n, 3, 3, 0.0, 0.0, false},
        {SE3DI_VTK_POLYS, "connectivity", NULL, each * n, 1, 1, 0.0, 1.0, true},
        {SE3DI_VTK_POLYS, "offsets", NULL, n, 1, 1, (double)each, (double)each, true}};
#undef WALL
    const se3di_vtk_file file = {
        .points = each * n, .polys = n, .arrays = arrays, .array_count = ARRAYS};
    return se3di_vtk_file_write(&file, to);
}

bool se3di_average_write_vtk(const se3di_average_sum *average, const char *path, int compression)
{
    se3di_iopool pool;
    se3di_iopool_init(&pool, &average->model->pool.allocator);
    const se3di_vtk_target to = {path, compression, &pool.allocator};
    double *values = se3di_iopool_array(&pool, average->cells + 1, average->width * sizeof *values);
    errno = ENOMEM; /* unless something else fails */
    for (size_t k = 0; values && average->rows > 0 && k < average->cells; ++k) {
        se3di_average_get_means(average, k, values + k * average->width);
    }
    const bool good = values && (average->grid ? se3di_vtk_write_fields(average->grid, values,
                                                                        average->cells, &to)
                                               : write_wall(average, &pool, values, &to));
    const int why = errno;
    se3di_iopool_destroy(&pool);
    errno = why;
    return good;
}
