/* SPDX-License-Identifier: BSD-3-Clause */
/* A ball that moves over a valley of a mesh: the force of springs on its overlaps has no jumps, is
 * the slope of one energy, and is that of two faces where the ball does not reach the pass. */
#include "check.h"
#include "contact/narrow/internal.h"
#include "contact/shape/mesh.h"

#include <math.h>
#include <string.h>

#define PI     3.14159265358979323846
#define RADIUS 0.05
#define WIDTH  0.015 /* of the way to either side */
#define STEPS  4000

/* Two faces that rise by `slope` on either side of the line x = 0, cut into uneven triangles. */
static void build(se3di_shape *shape, double slope)
{
    const se3d_allocator standard = se3di_alloc_default();
    const double c = cos(slope), s = sin(slope);
    const double vertices[] = {-c, -1, s, 0, -1, 0, c, -1, s, -c, 1.3, s, 0, 1.3, 0, c, 1.3, s};
    const uint32_t triangles[] = {0, 1, 3, 1, 4, 3, 1, 2, 4, 2, 5, 4};
    *shape = (se3di_shape){.kind = SE3DI_SHAPE_MESH};
    CHECK(se3di_mesh_build(&standard, vertices, 6, triangles, 4, shape) == SE3D_OK);
    shape->bound = se3di_shape_bound(shape);
}

/* What the point on the face that falls to `side` is told apart by. */
static uint32_t feature_of(const se3di_manifold *manifold, double side)
{
    for (uint32_t k = 0; k < manifold->count; ++k) {
        if (side * manifold->points[k].normal[0] > 0.0) {
            return manifold->points[k].feature;
        }
    }
    return UINT32_MAX;
}

/* The force of springs of 1 N/m on a ball with its centre at (x, 0, z); returns their number. */
static uint32_t press(const se3di_shape *mesh, double x, double z, double force[3])
{
    const se3di_shape ball = {.kind = SE3DI_SHAPE_SPHERE, .radius = RADIUS, .bound = RADIUS};
    const se3di_shape_pose at = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    se3di_shape_pose there = at;
    se3di_manifold manifold = {0};
    there.x[0] = x;
    there.x[2] = z;
    force[0] = force[1] = force[2] = 0.0;
    se3di_narrow_find(mesh, &at, &ball, &there, &manifold);
    for (uint32_t k = 0; k < manifold.count; ++k) {
        for (int a = 0; a < 3; ++a) {
            force[a] += manifold.points[k].overlap * manifold.points[k].normal[a];
        }
    }
    return manifold.count;
}

/* Place n of a closed way: over the valley, rising by 1 mm, and back in a bow. */
static void place(int n, double low, double at[2])
{
    const double part = (n <= STEPS ? n : 2 * STEPS - n) / (double)STEPS;
    at[0] = WIDTH * (2.0 * part - 1.0);
    at[1] = low + 0.001 * part + (n > STEPS ? 0.004 * part * (1.0 - part) : 0.0);
}

static void a_valley_takes_over_without_jumps(void)
{
    const se3d_allocator standard = se3di_alloc_default();
    const double slopes[] = {2.0, 3.75, 7.5, 15.0, 30.0};
    for (int k = 0; k < 5; ++k) {
        const double slope = slopes[k] * PI / 180.0, low = RADIUS / cos(slope) - 0.004;
        double work = 0.0, most = 0.0, jump = 0.0, last[3], force[3], from[2], to[2];
        uint32_t two = 0;
        se3di_shape mesh;
        build(&mesh, slope);
        place(0, low, from);
        press(&mesh, from[0], from[1], last);
        for (int n = 1; n <= 2 * STEPS; ++n) {
            place(n, low, to);
            two += press(&mesh, to[0], to[1], force) == 2;
            work += 0.5 * (force[0] + last[0]) * (to[0] - from[0]) +
                    0.5 * (force[2] + last[2]) * (to[1] - from[1]);
            jump = fmax(jump, hypot(force[0] - last[0], force[2] - last[2]));
            most = fmax(most, hypot(force[0], force[2]));
            memcpy(last, force, sizeof last);
            memcpy(from, to, sizeof from);
        }
        CHECK(two > 100);
        CHECK(jump < 10.0 * WIDTH / STEPS); /* a slope, of springs of 1 N/m */
        CHECK_NEAR(work, 0.0, 1e-5 * most * WIDTH);
        se3di_shape_release(&standard, &mesh);
    }
}

/* In the middle, at the depth that both faces have, less what the pass is deep along them. */
static void two_faces_carry_twice_where_the_pass_is_out_of_reach(void)
{
    const se3d_allocator standard = se3di_alloc_default();
    const double slopes[] = {10.0, 30.0, 45.0};
    for (int k = 0; k < 3; ++k) {
        const double slope = slopes[k] * PI / 180.0, depth = 2e-4;
        const double z = (RADIUS - depth) / cos(slope);
        double force[3];
        se3di_shape mesh;
        build(&mesh, slope);
        CHECK(z > RADIUS);
        CHECK(press(&mesh, 0.0, z, force) == 2);
        CHECK_NEAR(force[0], 0.0, 1e-15);
        CHECK_NEAR(force[2], 2.0 * depth * cos(slope), 1e-14);
        const double deep = RADIUS - 2e-3; /* of the pass below the centre */
        CHECK(press(&mesh, 0.0, deep, force) == 2);
        CHECK_NEAR(force[2], 2.0 * (RADIUS - deep * cos(slope)) * cos(slope) - 2e-3, 1e-14);
        se3di_shape_release(&standard, &mesh);
    }
}

/* Faces that look nearly the same way keep their names as the ball goes from one to the other. */
static void points_keep_their_features(void)
{
    const se3d_allocator standard = se3di_alloc_default();
    const se3di_shape ball = {.kind = SE3DI_SHAPE_SPHERE, .radius = RADIUS, .bound = RADIUS};
    const se3di_shape_pose at = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    se3di_manifold left = {0}, right = {0};
    se3di_shape_pose there = at;
    se3di_shape mesh;
    build(&mesh, 15.0 * PI / 180.0);
    there.x[2] = RADIUS;
    there.x[0] = -1e-4;
    se3di_narrow_find(&mesh, &at, &ball, &there, &left);
    there.x[0] = 1e-4;
    se3di_narrow_find(&mesh, &at, &ball, &there, &right);
    CHECK(left.count == 2 && right.count == 2);
    CHECK(feature_of(&left, 1.0) != feature_of(&left, -1.0));
    CHECK(feature_of(&left, 1.0) == feature_of(&right, 1.0));
    CHECK(feature_of(&left, -1.0) == feature_of(&right, -1.0));
    se3di_shape_release(&standard, &mesh);
}

int main(void)
{
    RUN(points_keep_their_features);
    RUN(a_valley_takes_over_without_jumps);
    RUN(two_faces_carry_twice_where_the_pass_is_out_of_reach);
    return check_finish();
}
