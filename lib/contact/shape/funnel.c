/* SPDX-License-Identifier: BSD-3-Clause */
/* A funnel: the side of a truncated cone about z, with two sides and open at both ends. Particles
 * touch the surface itself (particles/wall.h); bodies touch these triangles, whose corners are on
 * it: they are nearer to the axis by up to r (1 - cos(pi/144)) = 2.4e-4 r. */
#include "contact/shape/mesh.h"
#include "contact/shape/shape.h"
#include "contact/shape/triangles.h"
#include "math/elementary.h"

#include <math.h>

#define FACETS 144 /* neighbours differ by 2.5 degrees: a sphere touches one of them at a time */
#define PI     3.1415926535897932384626433832795

static const se3di_dimension dimensions[] = {
    {"bottom_radius", offsetof(se3d_shape_def, bottom_radius), offsetof(se3di_shape, radius), 1.0,
     1, 1},
    {"top_radius", offsetof(se3d_shape_def, top_radius), offsetof(se3di_shape, top_radius), 1.0, 1,
     1},
    {"length", offsetof(se3d_shape_def, length), offsetof(se3di_shape, half_length), 0.5, 1, 0},
    {.name = NULL}};

static double wider(const se3di_shape *s)
{
    return s->radius > s->top_radius ? s->radius : s->top_radius;
}

/* Corners of facet k below and above, and its two triangles; one without area is left out of the
 * mesh. */
static void make_facet(const se3di_shape *s, uint32_t k, double *corners, uint32_t *triangles)
{
    const double angle = 2.0 * PI * k / FACETS;
    const double radius[2] = {s->radius, s->top_radius};
    const double c = se3di_cos(angle), sine = se3di_sin(angle);
    const uint32_t next = (k + 1) % FACETS;
    const uint32_t quad[6] = {2 * k, 2 * next, 2 * k + 1, 2 * next + 1, 2 * k + 1, 2 * next};
    for (int end = 0; end < 2; ++end) {
        corners[3 * end] = radius[end] * c;
        corners[3 * end + 1] = radius[end] * sine;
        corners[3 * end + 2] = end == 0 ? -s->half_length : s->half_length;
    }
    for (int a = 0; a < 6; ++a) {
        triangles[a] = quad[a];
    }
}

static se3d_status define_funnel(const se3d_shape_def *def, const se3d_allocator *allocator,
                                 se3di_shape *s, se3di_error *error)
{
    double corners[6 * FACETS];
    uint32_t triangles[6 * FACETS];
    if (!(wider(s) > 0.0)) {
        return se3di_error_set_of(error, "bottom_radius", SE3D_ERR_INVALID_ARGUMENT,
                                  " = %g m and top_radius = %g m, one of them must be > 0",
                                  def->bottom_radius, def->top_radius);
    }
    for (uint32_t k = 0; k < FACETS; ++k) {
        make_facet(s, k, corners + 6 * (size_t)k, triangles + 6 * (size_t)k);
    }
    const size_t corner_count = 2 * (size_t)FACETS, triangle_count = 2 * (size_t)FACETS;
    const se3d_status status =
        se3di_mesh_build(allocator, corners, corner_count, triangles, triangle_count, s);
    if (status == SE3D_ERR_INVALID_ARGUMENT) {
        return se3di_error_set(error, status, "none of the funnel's triangles has an area");
    }
    return status < 0 ? se3di_error_set(error, status, "no memory for a funnel") : SE3D_OK;
}

static double bound_funnel(const se3di_shape *s)
{
    return sqrt(wider(s) * wider(s) + s->half_length * s->half_length);
}

static void nearest_funnel(const se3di_shape *s, const double local[3], double point[3],
                           double normal[3], double *distance)
{
    se3di_shape_class_mesh.nearest(s, local, point, normal, distance);
}

const se3di_shape_class se3di_shape_class_funnel = {
    .name = "funnel",
    .dimensions = dimensions,
    .define = define_funnel,
    .bound = bound_funnel,
    .size = se3di_vertices_size,
    .nearest = nearest_funnel,
    .support = se3di_vertices_support,
};
