/* SPDX-License-Identifier: BSD-3-Clause */
/* A mesh that is taken apart, created and cloned with every allocation failing in turn: it is made
 * whole or not at all, and nothing is lost. */
#include "check.h"
#include "se3d/se3d.h"
#include "support/counting.h"

/* An L, 1 thick. */
static const double points[36] = {0, 0, 0, 2, 0, 0, 2, 0, 1, 1, 0, 1, 1, 0, 3, 0, 0, 3,
                                  0, 1, 0, 2, 1, 0, 2, 1, 1, 1, 1, 1, 1, 1, 3, 0, 1, 3};
static const uint32_t faces[60] = {
    0, 1, 2, 0, 2, 3, 0, 3, 5, 3, 4, 5, 6, 8, 7, 6, 9, 8,  6, 11, 9, 9, 11, 10, 0, 6,  1, 1, 6,  7,
    1, 7, 2, 2, 7, 8, 2, 8, 3, 3, 8, 9, 3, 9, 4, 4, 9, 10, 4, 10, 5, 5, 10, 11, 5, 11, 0, 0, 11, 6};

static se3d_system *create(se3d_allocator *allocator, const double at[3], se3d_shape_def *def)
{
    se3d_system_def system_def = se3d_system_def_default();
    se3d_material_def stuff = se3d_material_def_default();
    se3d_body_def body_def = se3d_body_def_default();
    se3d_system *system = NULL;
    system_def.allocator = allocator;
    stuff.density = 1000.0;
    stuff.stiffness = 1e5;
    *def = se3d_shape_def_default();
    CHECK(se3d_system_create(&system_def, &system) == SE3D_OK);
    CHECK(se3d_material_create(system, &stuff, &def->material) == SE3D_OK);
    body_def.mass = 1.0;
    body_def.inertia[0] = body_def.inertia[1] = body_def.inertia[2] = 1.0;
    memcpy(body_def.position, at, sizeof body_def.position);
    CHECK(se3d_body_create(system, &body_def, &def->body) == SE3D_OK);
    def->vertices = points;
    def->vertex_count = 12;
    def->triangles = faces;
    def->triangle_count = 20;
    return system;
}

static void a_mesh_is_taken_apart_whole_or_not_at_all(void)
{
    const double at[3] = {0.0, 0.0, 2.5};
    for (int for_ever = 0; for_ever < 2; ++for_ever) {
        support_counting counting = {0};
        se3d_allocator allocator = support_counting_allocator(&counting);
        se3d_shape_def def;
        se3d_shape shape;
        se3d_system *system = create(&allocator, at, &def), *copy = NULL;
        se3d_status status = SE3D_ERR_NO_MEMORY;
        size_t tries = 0, shapes = 0;
        for (; status == SE3D_ERR_NO_MEMORY && tries < 2000; ++tries) {
            const size_t live = counting.live;
            counting.calls = 0;
            counting.fail_at = tries + 1;
            counting.for_ever = for_ever;
            status = se3d_shape_create_mesh(system, &def, &shape);
            CHECK(status < 0 ? shape.index1 == 0 : shape.index1 != 0);
            CHECK(status >= 0 || counting.live <= live + 2); /* room for more shapes may stay */
            shapes += status >= 0;
        }
        CHECK(status == SE3D_OK && tries > 50);
        CHECK(shapes == 1);
        status = SE3D_ERR_NO_MEMORY;
        for (tries = 0; status == SE3D_ERR_NO_MEMORY && tries < 2000; ++tries) {
            counting.calls = 0;
            counting.fail_at = tries + 1;
            status = se3d_system_clone(system, &copy);
            CHECK(status >= 0 || !copy);
        }
        CHECK(status == SE3D_OK);
        counting.fail_at = 0;
        /* the other mesh rests on the copy's: the pieces have come along */
        se3d_body ground;
        CHECK(se3d_system_get_ground(copy, &ground) == SE3D_OK);
        def.body = ground;
        def.position[0] = -0.5;
        CHECK(se3d_shape_create_mesh(copy, &def, &shape) == SE3D_OK);
        CHECK(se3d_system_count_passing_meshes(copy, NULL, NULL) == 0);
        se3d_system_destroy(copy);
        se3d_system_destroy(system);
        CHECK(counting.live == 0 && counting.wrong == 0);
    }
}

static void heights_are_taken_whole_or_not_at_all(void)
{
    const double heights[12] = {0.0, 0.1, 0.2, 0.1, 0.3, 0.1, 0.0, 0.2, 0.1, 0.2, 0.0, 0.1};
    support_counting counting = {0};
    se3d_allocator allocator = support_counting_allocator(&counting);
    const double at[3] = {0.0, 0.0, 2.5};
    se3d_shape_def def;
    se3d_shape shape;
    se3d_system *system = create(&allocator, at, &def);
    se3d_status status = SE3D_ERR_NO_MEMORY;
    size_t tries = 0;
    def.heights = heights;
    def.row_count = 3;
    def.column_count = 4;
    def.spacing[0] = def.spacing[1] = 0.5;
    for (; status == SE3D_ERR_NO_MEMORY && tries < 100; ++tries) {
        const size_t live = counting.live;
        counting.calls = 0;
        counting.fail_at = tries + 1;
        status = se3d_shape_create_heightfield(system, &def, &shape);
        CHECK(status < 0 ? shape.index1 == 0 : shape.index1 != 0);
        CHECK(status >= 0 || counting.live <= live + 2); /* room for more shapes may stay */
    }
    CHECK(status == SE3D_OK && tries > 5);
    se3d_system_destroy(system);
    CHECK(counting.live == 0 && counting.wrong == 0);
}

int main(void)
{
    RUN(heights_are_taken_whole_or_not_at_all);
    RUN(a_mesh_is_taken_apart_whole_or_not_at_all);
    return check_finish();
}
