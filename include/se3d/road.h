/* SPDX-License-Identifier: BSD-3-Clause */
/* Roads: surfaces under tyres, fixed to a body or moving by themselves.
 *
 * A road has a frame on its body: its origin, x forward, y to the left, z up. It is the plane z = 0
 * of that frame, or has a height z over x and y: a function, also of the time, a grid of heights,
 * or a mesh of triangles. What tyres make of it: docs/theory/road.md.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_ROAD_H
#define SE3D_ROAD_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The definition of a road: at most one of `height`, `heights` and `triangles`; none: a plane.
 * @since 0.1 */
typedef struct se3d_road_def {
    size_t struct_size;
    const char *name;      /* copied; NULL or unique among roads */
    se3d_body body;        /* that the road is fixed to */
    double point[3];       /* origin of the road, frame of the body [m] */
    double normal[3];      /* z [1], frame of the body, not zero; default (0, 0, 1) */
    double forward[3];     /* x [1] as far as it is not along the normal, frame of the body; default
                             (1, 0, 0) */
    se3d_function height;  /* z [m] over t [s], x, y [m], in this order, or over the first of them;
                             null: none. It should have a slope everywhere, also a steep one; of a
                             callback curvatures are differences of its slopes. */
    const double *heights; /* [row_count * column_count], copied: z [m], row by row along x,
                                  the rows along y, the middle of the grid at the origin; between
                                  them bicubic with continuous slopes, outside level */
    size_t row_count;      /* 2 to 1e6 */
    size_t column_count;   /* 2 to 1e6; at most 1e8 heights */
    double spacing[2];     /* between columns, along x, and rows, along y, > 0 [m] */
    const double *vertices;    /* [3 * vertex_count], copied: x, y, z [m] */
    size_t vertex_count;       /* 3 or more */
    const uint32_t *triangles; /* [3 * triangle_count], copied: numbers of vertices, in any order of
                                  turn. The highest one over a point counts, if there is none z
                                  is 0. */
    size_t triangle_count;     /* 1 or more */
} se3d_road_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_road_def_default. @since 0.1 */
SE3D_API void se3d_road_def_init(se3d_road_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_road_def se3d_road_def_default(void)
{
    se3d_road_def def;
    se3d_road_def_init(&def, sizeof def);
    return def;
}

/* Create a road. @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_road_create(se3d_system *system, const se3d_road_def *def,
                                      se3d_road *road);

/* Destroy a road that no tyre is on. @return OK, NULL, STALE_HANDLE, IN_USE. @since 0.1 */
SE3D_API se3d_status se3d_road_destroy(se3d_system *system, se3d_road road);

/* Find a road by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name).
 * @since 0.1 */
SE3D_API se3d_status se3d_road_find(const se3d_system *system, const char *name, se3d_road *road);

/* Get the definition of a road. Set def->struct_size before the call.
 * @param[out] def  its name (NULL: none) and arrays are valid until the system is edited
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_road_get_def(const se3d_system *system, se3d_road road,
                                       se3d_road_def *def);

/* Define a road again: see se3d_body_set_def. Tyres stay on it; while there are any, so does its
 * body (IN_USE).
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT, IN_USE, NO_MEMORY.
 * @since 0.1 */
SE3D_API se3d_status se3d_road_set_def(se3d_system *system, se3d_road road,
                                       const se3d_road_def *def);

/* Get the name of a road.
 * @param[out] name  "" if it has none; valid as long as the road lives
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_road_get_name(const se3d_system *system, se3d_road road,
                                        const char **name);

/* Compute how high a road is at the system's time.
 * @param[in] x        forward, frame of the road [m]
 * @param[in] y        to the left [m]
 * @param[out] height  [4] z [m], dz/dx, dz/dy [1], dz/dt [m/s]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (x, y), NOT_FINITE, CALLBACK.
 * @since 0.1 */
SE3D_API se3d_status se3d_road_get_height(const se3d_system *system, se3d_road road, double x,
                                          double y, double height[4]);

/* Count the roads of a system. @return their number, 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_roads(const se3d_system *system);

/* Get a road by its number.
 * @param[in] index  0 to count - 1, in order of creation
 * @return OK, NULL, INVALID_ARGUMENT (no such road).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_road(const se3d_system *system, size_t index, se3d_road *road);

#ifdef __cplusplus
}
#endif
#endif
