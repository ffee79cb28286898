/* SPDX-License-Identifier: BSD-3-Clause */
/* Random solids and poses for tests of the narrow phase. SE3D_POSES in the environment is how many
 * of a kind are tried, in place of the few that a test's time allows:
 *
 *     SE3D_POSES=100000 build/dev/tests/test_unit_separation */
#ifndef SE3D_TESTS_POSES_H
#define SE3D_TESTS_POSES_H

#include "base/alloc.h"
#include "check.h"
#include "contact/shape/hull.h"
#include "contact/shape/shape.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#include <stdlib.h>

#define POSES_CORNERS 8 /* of a hull */

static inline int poses_are_many(void)
{
    return getenv("SE3D_POSES") != NULL;
}

static inline int poses_count(int usual)
{
    const char *wanted = getenv("SE3D_POSES");
    return wanted ? (int)strtol(wanted, NULL, 10) : usual;
}

static inline double poses_between(uint64_t *seed, double low, double high)
{
    return low + 0.5 * (high - low) * (1.0 + check_random(seed));
}

static inline void poses_turn(uint64_t *seed, se3di_shape_pose *pose)
{
    double q[4], p[4];
    memset(pose, 0, sizeof *pose);
    for (int k = 0; k < 4; ++k) {
        q[k] = check_random(seed);
    }
    se3di_quat_normalize(q, p);
    se3di_quat_to_matrix(p, pose->R);
}

/* Turned as another one, its axes exchanged, but for an angle between powers of ten. */
static inline void poses_turn_slightly(uint64_t *seed, const se3di_shape_pose *as, double least,
                                       double most, se3di_shape_pose *pose)
{
    const double angle = pow(10.0, poses_between(seed, least, most));
    const int first = (int)poses_between(seed, 0.0, 2.999);
    double q[4] = {1.0, 0.0, 0.0, 0.0}, p[4], turn[9], mixed[9];
    for (int k = 1; k < 4; ++k) {
        q[k] = angle * check_random(seed);
    }
    se3di_quat_normalize(q, p);
    se3di_quat_to_matrix(p, turn);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            mixed[3 * r + c] = as->R[3 * r + (c + first) % 3];
        }
    }
    se3di_mat_mul(turn, mixed, pose->R);
}

static inline void poses_lean(uint64_t *seed, const se3di_shape_pose *as, se3di_shape_pose *pose)
{
    poses_turn_slightly(seed, as, -12.0, -1.0, pose);
}

/* A shape with room for a hull of its own. */
typedef struct poses_solid {
    se3di_shape shape;
    double vertices[3 * POSES_CORNERS];
    uint32_t triangles[3 * 2 * POSES_CORNERS];
    double planes[4 * 2 * POSES_CORNERS];
} poses_solid;

/* A hull's arrays become those of a solid; the hull is gone then. */
static inline void poses_take_hull(poses_solid *s, se3di_shape *hull)
{
    const se3d_allocator allocator = se3di_alloc_default();
    memcpy(s->vertices, hull->vertices, 3 * hull->vertex_count * sizeof(double));
    memcpy(s->triangles, hull->triangles, 3 * hull->triangle_count * sizeof(uint32_t));
    memcpy(s->planes, hull->planes, 4 * hull->triangle_count * sizeof(double));
    s->shape.vertex_count = hull->vertex_count;
    s->shape.triangle_count = hull->triangle_count;
    se3di_shape_release(&allocator, hull);
}

/* Corners on a sphere, so that all count. */
static inline void poses_hull(poses_solid *s, uint64_t *seed)
{
    const se3d_allocator allocator = se3di_alloc_default();
    const int count = 4 + (int)poses_between(seed, 0.0, POSES_CORNERS - 3.001);
    double points[3 * POSES_CORNERS];
    se3di_shape hull = {.kind = SE3DI_SHAPE_HULL};
    do {
        for (int k = 0; k < count; ++k) {
            double *x = points + 3 * k;
            for (int c = 0; c < 3; ++c) {
                x[c] = check_random(seed);
            }
            se3di_scale(0.25 / se3di_norm(x), x, x);
        }
    } while (se3di_hull_build(&allocator, points, (size_t)count, &hull) < 0);
    poses_take_hull(s, &hull);
}

/* The arrays of a hull, which are within the solid, after it was copied, too. */
static inline void poses_link(poses_solid *s)
{
    s->shape.vertices = s->vertices;
    s->shape.triangles = s->triangles;
    s->shape.planes = s->planes;
}

static inline void poses_random_solid(int kind, uint64_t *seed, poses_solid *s)
{
    memset(s, 0, sizeof *s);
    s->shape.kind = kind;
    s->shape.radius = poses_between(seed, 0.04, 0.2);
    s->shape.half_length = poses_between(seed, 0.04, 0.25);
    for (int c = 0; c < 3; ++c) {
        s->shape.half[c] = poses_between(seed, 0.04, 0.25);
    }
    if (kind == SE3DI_SHAPE_HULL) {
        poses_hull(s, seed);
        poses_link(s);
    }
    s->shape.bound = se3di_shape_bound(&s->shape);
}

/* A place within it; hulls may have their origin anywhere. */
static inline void poses_inner(const se3di_shape *s, const se3di_shape_pose *at, double x[3])
{
    double mean[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < s->vertex_count; ++k) {
        se3di_add_scaled(1.0 / (double)s->vertex_count, s->vertices + 3 * k, mean);
    }
    se3di_mul(at->R, mean, x);
    se3di_add(at->x, x, x);
}

/* The least half width, about. */
static inline double poses_size(const se3di_shape *s)
{
    return s->kind == SE3DI_SHAPE_BOX || s->kind == SE3DI_SHAPE_ELLIPSOID
               ? fmin(s->half[0], fmin(s->half[1], s->half[2]))
           : s->kind == SE3DI_SHAPE_CYLINDER ? fmin(s->radius, s->half_length)
           : s->kind == SE3DI_SHAPE_HULL     ? 0.05
                                             : s->radius;
}

#endif
