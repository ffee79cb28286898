/* SPDX-License-Identifier: BSD-3-Clause */
/* The row of the misuse table on what a road may be made of. */
#ifndef SE3D_TESTS_MISUSE_ROADS_H
#define SE3D_TESTS_MISUSE_ROADS_H

#include "misuse/misuse_fields.h"

/* A road of triangles that a tyre is on becomes a grid, and what it was. */
static void check_redefinition(arguments *a, se3d_road road, se3d_road_def grid,
                               const se3d_road_def *mesh, const se3d_road_def *lying)
{
    se3d_road_def own = se3d_road_def_default();
    double at[4];
    grid.body = ground_of(a);
    CHECK(se3d_road_set_def(a->system, road, &grid) == SE3D_ERR_IN_USE);
    grid.body = mesh->body;
    for (int k = 0; k < 2; ++k) { /* the second time of its own arrays */
        CHECK(!se3d_road_set_def(a->system, road, k == 0 ? &grid : &own));
        CHECK(!se3d_road_get_height(a->system, road, 0.0, 0.25, at));
        CHECK_NEAR(at[0], 4.0, 0.0);
        CHECK(!se3d_road_get_def(a->system, road, &own) && own.heights != grid.heights);
    }
    INVALID(se3d_road_set_def(a->system, road, lying));
    CHECK(!se3d_road_set_def(a->system, road, mesh));
    CHECK(!se3d_road_get_height(a->system, road, 0.25, 0.25, at));
    CHECK_NEAR(at[0], 1.0, 0.0);
}

/* Grids, meshes, and what a road may not be. */
static se3d_status roads_reject_misuse(arguments *a)
{
    static const double heights[6] = {0.0, 1.0, 2.0, 3.0, 4.0, 5.0};
    static const double bad[4] = {0.0, 1.0, (double)NAN, 1.0};
    static const uint32_t triangle[3] = {0, 1, 2}, beyond[3] = {0, 1, 3};
    static const double corners[9] = {0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 1.0, 1.0};
    const size_t before = se3d_system_count_roads(a->system);
    const se3d_road_def plane = {.struct_size = sizeof plane,
                                 .body = a->use.body,
                                 .normal = {0.0, 0.0, 1.0},
                                 .forward = {1.0, 0.0, 0.0}};
    se3d_road_def grid = plane, mesh = plane, both, many, lying = plane;
    se3d_road road;
    double at[4];
    grid.heights = heights;
    grid.column_count = 3;
    grid.row_count = 2;
    grid.spacing[0] = grid.spacing[1] = 0.5;
    mesh.vertices = corners;
    mesh.vertex_count = 3;
    mesh.triangles = triangle;
    mesh.triangle_count = 1;
    both = many = grid;
    both.triangles = triangle;
    lying.forward[0] = 0.0;
    lying.forward[2] = 2.0;
    INVALID(se3d_road_create(a->system, &both, &road));
    INVALID(se3d_road_create(a->system, &lying, &road));
    many.row_count = many.column_count = 65537; /* a little over 2^32 in all */
    INVALID(se3d_road_create(a->system, &many, &road));
    for (int k = 0; k < 9; ++k) {
        se3d_road_def g = grid, m = mesh;
        g.column_count = k == 0 ? 1 : k == 1 ? SIZE_MAX : 3;
        g.row_count = k == 2 ? 0 : k == 3 ? 1000001 : 2;
        g.spacing[0] = k == 4 ? 0.0 : k == 5 ? (double)NAN : 0.5;
        g.spacing[1] = k == 6 ? -1.0 : k == 7 ? (double)INFINITY : 0.5;
        g.heights = k == 8 ? bad : heights;
        g.column_count = k == 8 ? 2 : g.column_count;
        INVALID(se3d_road_create(a->system, &g, &road));
        m.vertices = k == 0 ? NULL : corners;
        m.vertex_count = k == 1 ? 2 : k == 2 ? SIZE_MAX / 2 : 3;
        m.triangle_count = k == 3 ? 0 : k == 4 ? SIZE_MAX / 3 : 1;
        m.triangles = k > 4 ? beyond : triangle;
        CHECK(se3d_road_create(a->system, &m, &road) < 0 && road.index1 == 0);
    }
    CHECK(se3d_system_count_roads(a->system) == before);
    CHECK(!se3d_road_create(a->system, &grid, &road));
    CHECK(!se3d_road_get_height(a->system, road, 0.0, 0.25, at));
    CHECK_NEAR(at[0], 4.0, 0.0);
    CHECK(!se3d_road_destroy(a->system, road));
    CHECK(!se3d_road_create(a->system, &mesh, &road));
    CHECK(!se3d_road_get_height(a->system, road, 0.25, 0.25, at));
    CHECK_NEAR(at[0], 1.0, 0.0);
    se3d_tyre_def tyre = se3d_tyre_def_default();
    se3d_force force;
    tyre.wheel = ground_of(a);
    tyre.surface = road;
    tyre.radius = tyre.k = tyre.mu = tyre.slip_stiffness = tyre.cornering_stiffness = 1.0;
    tyre.road = ground_of(a); /* another body than that of the surface */
    INVALID(se3d_force_create_tyre(a->system, &tyre, &force));
    tyre.road = (se3d_body){0, 0};
    tyre.envelope_length = -1.0;
    INVALID(se3d_force_create_tyre(a->system, &tyre, &force));
    tyre.envelope_length = 0.0;
    tyre.envelope_width = (double)NAN;
    INVALID(se3d_force_create_tyre(a->system, &tyre, &force));
    tyre.envelope_width = 0.1;
    CHECK(!se3d_force_create_tyre(a->system, &tyre, &force));
    CHECK(se3d_road_destroy(a->system, road) == SE3D_ERR_IN_USE);
    CHECK_CONTAINS(se3d_system_get_error(a->system), "used by 1 tyres");
    check_redefinition(a, road, grid, &mesh, &lying);
    CHECK(!se3d_force_destroy(a->system, force));
    CHECK(!se3d_road_destroy(a->system, road));
    tyre.surface = road;
    CHECK(se3d_force_create_tyre(a->system, &tyre, &force) == SE3D_ERR_STALE_HANDLE);
    return SE3D_OK;
}

#endif
