/* SPDX-License-Identifier: BSD-3-Clause */
/* What rolls and slides on triangles in a plane moves as on the plane, by as many steps: the points
 * in which it touches wander over its surface there, too. */
#include "support/scene.h"

#define COLUMNS 13
#define ROWS    7
#define POINTS  (COLUMNS * ROWS)
#define FACES   (2 * (COLUMNS - 1) * (ROWS - 1))

enum { PLANE, MESH, HEIGHTS, SUPPORTS };
enum { SIDE, ELLIPSOID, CAP, BOX, DISC, CAPSULE, SOLIDS };

/* 2.4 x 1.2 m, with inner points anywhere. */
static void add_mesh(scene *s)
{
    static double points[3 * POINTS];
    static uint32_t faces[3 * FACES];
    uint64_t seed = 4;
    size_t count = 0;
    for (uint32_t k = 0; k < POINTS; ++k) {
        const uint32_t row = k / COLUMNS, column = k % COLUMNS;
        const int is_inner = row > 0 && row < ROWS - 1 && column > 0 && column < COLUMNS - 1;
        const double off = is_inner ? 0.06 : 0.0;
        points[3 * k] = 0.2 * column - 0.6 + off * check_random(&seed);
        points[3 * k + 1] = 0.2 * row - 0.6 + off * check_random(&seed);
        points[3 * k + 2] = 0.0;
    }
    for (uint32_t row = 0; row + 1 < ROWS; ++row) {
        for (uint32_t column = 0; column + 1 < COLUMNS; ++column) {
            const uint32_t a = row * COLUMNS + column, b = a + COLUMNS;
            const uint32_t two[6] = {a, a + 1, b + 1, a, b + 1, b};
            memcpy(faces + count, two, sizeof two);
            count += 6;
        }
    }
    scene_mesh_on(s, scene_ground(s), points, POINTS, faces, FACES);
}

static void add_support(scene *s, int kind)
{
    static const double level[POINTS] = {0.0};
    se3d_shape_def def = scene_shape(s, scene_ground(s));
    se3d_shape shape;
    switch (kind) {
    case PLANE:
        (void)scene_floor(s, 0.0);
        break;
    case MESH:
        add_mesh(s);
        break;
    default:
        def.heights = level;
        def.column_count = COLUMNS;
        def.row_count = ROWS;
        def.spacing[0] = def.spacing[1] = 0.2;
        def.position[0] = 0.6;
        CHECK(se3d_shape_create_heightfield(s->system, &def, &shape) == SE3D_OK);
        break;
    }
}

/* 5 cm high around its middle, that of a disc 1 cm. */
static void add_solid(scene *s, se3d_body body, int solid)
{
    const double x[3] = {1.0, 0.0, 0.0}, quarter = 0.5 * 3.14159265358979324;
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    def.radius = 0.05;
    def.length = solid == CAP ? 0.1 : 0.2;
    switch (solid) {
    case ELLIPSOID:
        def.semi_axes[0] = 0.08;
        def.semi_axes[1] = 0.06;
        def.semi_axes[2] = 0.05;
        CHECK(se3d_shape_create_ellipsoid(s->system, &def, &shape) == SE3D_OK);
        break;
    case BOX:
        def.size[0] = def.size[2] = 0.1;
        def.size[1] = 0.12;
        CHECK(se3d_shape_create_box(s->system, &def, &shape) == SE3D_OK);
        break;
    case CAPSULE:
        CHECK(se3d_shape_create_capsule(s->system, &def, &shape) == SE3D_OK);
        scene_turn(s, body, x, quarter);
        break;
    case DISC:
        def.radius = 0.1;
        def.length = 0.02;
        CHECK(se3d_shape_create_cylinder(s->system, &def, &shape) == SE3D_OK);
        break;
    default:
        CHECK(se3d_shape_create_cylinder(s->system, &def, &shape) == SE3D_OK);
        if (solid == SIDE) {
            scene_turn(s, body, x, quarter);
        }
        break;
    }
}

/* Thrown along x: position and steps after 0.3 s. */
static double throw(int solid, int support, double place[3])
{
    const double r[3] = {0.0, 0.01, solid == DISC ? 0.01 : 0.05}, v[3] = {1.2, 0.1, 0.0};
    const double J[3] = {0.002, 0.003, 0.003};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, 0.2, 1e5);
    se3d_solver_stats stats = {0};
    add_support(&s, support);
    const se3d_body body = scene_body(&s, 1.0, J, r, v);
    add_solid(&s, body, solid);
    scene_solve(&s, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-6);
    CHECK(scene_run(&s, 0.3));
    CHECK(!se3d_solver_get_stats(s.solver, &stats));
    CHECK(!se3d_body_get_position(s.system, body, place));
    scene_end(&s);
    return (double)stats.steps;
}

static void rolling_on_flat_meshes_is_rolling_on_the_plane(void)
{
    for (int solid = 0; solid < SOLIDS; ++solid) {
        double plane[3], place[3];
        const double steps = throw(solid, PLANE, plane);
        CHECK(plane[0] > 0.15);
        for (int support = MESH; support < SUPPORTS; ++support) {
            const double own = throw(solid, support, place);
            CHECK(fabs(own - steps) < 0.05 * steps);
            for (int k = 0; k < 3; ++k) {
                CHECK_NEAR(place[k], plane[k], 1e-8);
            }
        }
    }
}

int main(void)
{
    RUN(rolling_on_flat_meshes_is_rolling_on_the_plane);
    return check_finish();
}
