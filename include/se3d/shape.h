/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes on bodies, for contact.
 *
 * Threads: the rule of se3d/se3d.h. */
#ifndef SE3D_SHAPE_H
#define SE3D_SHAPE_H

#include "se3d/handles.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Kinds of shapes. @since 0.1 */
typedef enum se3d_shape_type {
    SE3D_SHAPE_SPHERE = 0,
    SE3D_SHAPE_BOX = 1,
    SE3D_SHAPE_CAPSULE = 2,
    SE3D_SHAPE_CYLINDER = 3,
    SE3D_SHAPE_PLANE = 4,
    SE3D_SHAPE_MESH = 5,
    SE3D_SHAPE_HULL = 6, /* not the type of a shape of a model file, where it is a convex mesh */
    SE3D_SHAPE_HEIGHTFIELD = 7,
    SE3D_SHAPE_FUNNEL = 8,
    SE3D_SHAPE_ELLIPSOID = 9
} se3d_shape_type;

/* The definition of a shape; every kind takes its own of the last fields. Its frame is at its
 * centre.
 * @since 0.1 */
typedef struct se3d_shape_def {
    size_t struct_size;
    const char *name;       /* copied; NULL or unique among the shapes */
    se3d_body body;         /* null: the ground */
    se3d_material material; /* null: nothing touches it */
    double position[3];     /* body frame [m] */
    double orientation[4];  /* shape -> body, Euler parameters; default (1,0,0,0) */
    double normal[3];       /* plane: direction of its normal, body frame; zero: the shape's z */
    double size[3];         /* box: full lengths [m] > 0 */
    double radius;          /* sphere, capsule, cylinder [m] > 0 */
    double length;          /* along the shape's z: capsule, between the centres of its caps (>= 0);
                               cylinder, funnel (> 0) [m] */
    uint32_t group, mask;   /* a and b touch if a.group & b.mask and b.group & a.mask; default 1 and
                               all ones */
    const double *vertices; /* mesh, hull: [3 * vertex_count], shape frame [m], copied */
    size_t vertex_count;    /* of `vertices` */
    const uint32_t *triangles; /* mesh: [3 * triangle_count] indices of vertices, copied */
    size_t triangle_count;     /* of `triangles` */
    const double *heights; /* heightfield: [row_count * column_count], rows (along x) one after the
                              other; the shape's z [m], copied */
    size_t row_count, column_count; /* of `heights`, each >= 2 */
    double spacing[2];    /* heightfield: between its columns, along x, and rows, along y [m] > 0 */
    double bottom_radius; /* funnel, at its lower end along the shape's z [m] >= 0, */
    double top_radius;    /* and at its upper end [m] >= 0; one of them may be 0: a cone */
    double surface_velocity[3]; /* see se3d_shape_set_surface_motion [m/s] */
    double surface_spin[3];     /* the same [rad/s] */
    double semi_axes[3];        /* ellipsoid: along the shape's x, y, z [m] > 0 */
} se3d_shape_def;

/* Fill `def`, of `size` bytes, with the defaults: see se3d_shape_def_default. @since 0.1 */
SE3D_API void se3d_shape_def_init(se3d_shape_def *def, size_t size);

/* Return the defaults. @since 0.1 */
static inline se3d_shape_def se3d_shape_def_default(void)
{
    se3d_shape_def def;
    se3d_shape_def_init(&def, sizeof def);
    return def;
}

/* Create a sphere. It moves with its body, as every shape does. @return OK, NULL, STALE_HANDLE,
 * INVALID_ARGUMENT, NO_MEMORY. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_sphere(se3d_system *system, const se3d_shape_def *def,
                                              se3d_shape *shape);

/* Create a box. @return as se3d_shape_create_sphere. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_box(se3d_system *system, const se3d_shape_def *def,
                                           se3d_shape *shape);

/* Create a capsule: a cylinder with half spheres as caps. @return as se3d_shape_create_sphere.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_create_capsule(se3d_system *system, const se3d_shape_def *def,
                                               se3d_shape *shape);

/* Create a cylinder. @return as se3d_shape_create_sphere. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_cylinder(se3d_system *system, const se3d_shape_def *def,
                                                se3d_shape *shape);

/* Create a plane. It is infinite, and solid behind its normal. @return as
 * se3d_shape_create_sphere. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_plane(se3d_system *system, const se3d_shape_def *def,
                                             se3d_shape *shape);

/* Create the convex hull of at least four points that are not in one plane. @return as
 * se3d_shape_create_sphere. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_hull(se3d_system *system, const se3d_shape_def *def,
                                            se3d_shape *shape);

/* Create a surface of triangles. Everything touches it, but two meshes touch each other only if
 * one of them is closed (se3d_system_count_passing_meshes). A closed
 * surface has an outside, any other has two sides. A mesh is convex if it is closed, the hull of
 * its vertices, and has at most 1000 triangles; a closed one of at most 400 triangles is taken
 * apart into at most 32 convex pieces if that is possible. @return as se3d_shape_create_sphere.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_create_mesh(se3d_system *system, const se3d_shape_def *def,
                                            se3d_shape *shape);

/* Create a heightfield: heights over a grid whose middle is the shape's origin,
 *
 *     x = (j - (column_count - 1) / 2) spacing[0],   y = (i - (row_count - 1) / 2) spacing[1],
 *     z = heights[column_count * i + j]
 *
 * joined by two triangles to a cell, cut from (i, j) to (i + 1, j + 1). It is touched as an open
 * mesh of these triangles is, but is found by its cells: what is near costs the same however large
 * it is. @return as se3d_shape_create_sphere. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_heightfield(se3d_system *system, const se3d_shape_def *def,
                                                   se3d_shape *shape);

/* Create a funnel: the side of a cone or truncated cone about z, of a tube if both radii are the
 * same. It is a surface with two sides, open at both ends. Particles touch it as it is, bodies a
 * mesh of 144 facets with their corners on it. @return as se3d_shape_create_sphere. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_funnel(se3d_system *system, const se3d_shape_def *def,
                                              se3d_shape *shape);

/* Create an ellipsoid: a ball that is stretched along its three axes. What is convex touches it in
 * one point; the Hertz law takes one radius of curvature for all of its surface, the geometric mean
 * of its semi-axes. @return as se3d_shape_create_sphere. @since 0.1 */
SE3D_API se3d_status se3d_shape_create_ellipsoid(se3d_system *system, const se3d_shape_def *def,
                                                 se3d_shape *shape);

/* Destroy a shape. @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_shape_destroy(se3d_system *system, se3d_shape shape);

/* Find a shape by its name.
 * @param[in] name  UTF-8
 * @return OK, NULL, INVALID_ARGUMENT (no such name; *shape is null).
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_find(const se3d_system *system, const char *name,
                                     se3d_shape *shape);

/* Get the name of a shape.
 * @param[out] name  "" if it has none; lives as long as the shape
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_get_name(const se3d_system *system, se3d_shape shape,
                                         const char **name);

/* Count the shapes of a system. @return the number; 0 for NULL. @since 0.1 */
SE3D_API size_t se3d_system_count_shapes(const se3d_system *system);

/* Get a shape of a system, in the order of creation.
 * @param[in] index  from 0, below se3d_system_count_shapes
 * @return OK, NULL, INVALID_ARGUMENT (index).
 * @since 0.1 */
SE3D_API se3d_status se3d_system_get_shape(const se3d_system *system, size_t index,
                                           se3d_shape *shape);

/* Get the kind of a shape.
 * @param[out] type  se3d_shape_type
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_get_type(const se3d_system *system, se3d_shape shape,
                                         int32_t *type);

/* Get the definition of a shape. Set def->struct_size before the call.
 * @param[out] def  its name (NULL: none) and arrays live as long as the shape; a hull has its
 *                  corners as vertices, a heightfield its points, whose z are the heights (NULL)
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (struct_size).
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_get_def(const se3d_system *system, se3d_shape shape,
                                        se3d_shape_def *def);

/* Get the body that a shape is on. @return OK, NULL, STALE_HANDLE. @since 0.1 */
SE3D_API se3d_status se3d_shape_get_body(const se3d_system *system, se3d_shape shape,
                                         se3d_body *body);

/* Give a shape another material, or none.
 * @param[in] material  null: nothing touches it, and bonds of particles to it end
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_set_material(se3d_system *system, se3d_shape shape,
                                             se3d_material material);

/* Set what a shape may touch: see se3d_shape_def. Bonds of particles that it no longer touches end.
 * @param[in] group  the bits that it is in
 * @param[in] mask   the bits that it touches
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_set_filter(se3d_system *system, se3d_shape shape, uint32_t group,
                                           uint32_t mask);

/* Let the surface of a shape move on its body, as a belt or a turntable does, from now on: a place
 * x of the surface of a shape whose origin is at o has, relative to its body,
 *
 *     u = velocity + spin x (x - o)
 *
 * of which contact takes what is tangential. Friction acts on the velocity relative to it; what
 * sticks moves along. The work that this takes counts as that of actuators (se3d_work).
 * @param[in] velocity  body frame [m/s]
 * @param[in] spin      body frame [rad/s]
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_set_surface_motion(se3d_system *system, se3d_shape shape,
                                                   const double velocity[3], const double spin[3]);

/* Get what se3d_shape_set_surface_motion has set.
 * @param[out] velocity  body frame [m/s]
 * @param[out] spin      body frame [rad/s]
 * @return OK, NULL, STALE_HANDLE.
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_get_surface_motion(const se3d_system *system, se3d_shape shape,
                                                   double velocity[3], double spin[3]);

/* Get the point of a shape's surface that is nearest to a position.
 * @param[in] position   ground frame [m]
 * @param[out] point     of the surface, ground frame [m]
 * @param[out] normal    outward at `point`, unit vector, ground frame
 * @param[out] distance  from `position` to `point` [m]; negative inside the shape
 * @return OK, NULL, STALE_HANDLE, INVALID_ARGUMENT (position).
 * @since 0.1 */
SE3D_API se3d_status se3d_shape_get_nearest(const se3d_system *system, se3d_shape shape,
                                            const double position[3], double point[3],
                                            double normal[3], double *distance);

#ifdef __cplusplus
}
#endif
#endif
