/* SPDX-License-Identifier: BSD-3-Clause */
/* Bodies on surfaces of triangles: flat ones are planes, whatever the triangles; edges, corners and
 * bowls carry what they should. */
#include "support/scene.h"

#define GRID 13

enum { SPHERE, BOX, CAPSULE, CYLINDER, HULL, KINDS };

static scene begin(double friction, double restitution)
{
    return scene_begin(SE3D_CONTACT_LAW_HOOKE, friction, restitution, 1e5);
}

static void run(scene *s, int32_t method, double step, double t)
{
    if (!s->solver) {
        scene_solve(s, method, SE3D_FORMULATION_ROMEGA, step, 0.0);
    }
    scene_run(s, t);
}

/* A floor from -1.2 to 1.2 in z = 0 of uneven triangles, both ways round; or the plane. */
static void floor_on(scene *s, int triangles)
{
    static double points[3 * GRID * GRID];
    static uint32_t faces[6 * (GRID - 1) * (GRID - 1)];
    for (int k = 0; k < GRID * GRID; ++k) {
        points[3 * k] = 0.2 * (k % GRID - 6) + 0.05 * sin(7.0 * k);
        points[3 * k + 1] = 0.2 * (k / GRID - 6) + 0.05 * cos(5.0 * k);
    }
    for (uint32_t k = 0; k < (GRID - 1) * (GRID - 1); ++k) {
        uint32_t a = k / (GRID - 1) * GRID + k % (GRID - 1);
        const uint32_t quad[2][6] = {{a, a + 1, a + GRID, a + 1, a + GRID + 1, a + GRID},
                                     {a, a + 1, a + GRID + 1, a, a + GRID + 1, a + GRID}};
        memcpy(faces + 6 * k, quad[k % 2], sizeof quad[0]);
    }
    if (triangles) {
        scene_mesh_on(s, scene_ground(s), points, GRID * GRID, faces, 2 * (GRID - 1) * (GRID - 1));
    } else {
        scene_floor(s, 0.0);
    }
}

static se3d_body solid(scene *s, int kind, const double r[3], const double v[3])
{
    static const double corners[24] = {-0.1, -0.1, -0.1, 0.1,  -0.1,  -0.1, -0.1,  0.1,
                                       -0.1, 0.1,  0.1,  -0.1, -0.05, 0.0,  0.1,   0.05,
                                       0.0,  0.1,  0.0,  0.05, 0.1,   0.0,  -0.05, 0.1};
    const double J[3] = {0.01, 0.01, 0.01}, about_x[3] = {1.0, 0.0, 0.0};
    se3d_body body = scene_body(s, 2.0, J, r, v);
    se3d_shape_def shape_def = scene_shape(s, body);
    se3d_shape shape;
    if (kind == CAPSULE) {
        scene_turn(s, body, about_x, 0.5 * PI);
    }
    shape_def.radius = 0.1;
    shape_def.length = 0.2;
    shape_def.size[0] = shape_def.size[1] = shape_def.size[2] = 0.2;
    shape_def.vertices = corners;
    shape_def.vertex_count = 8;
    CHECK((kind == SPHERE     ? se3d_shape_create_sphere(s->system, &shape_def, &shape)
           : kind == BOX      ? se3d_shape_create_box(s->system, &shape_def, &shape)
           : kind == CAPSULE  ? se3d_shape_create_capsule(s->system, &shape_def, &shape)
           : kind == CYLINDER ? se3d_shape_create_cylinder(s->system, &shape_def, &shape)
                              : se3d_shape_create_hull(s->system, &shape_def, &shape)) == SE3D_OK);
    return body;
}

static void bodies_slide_over_triangles_as_over_a_plane(void)
{
    static const int32_t methods[2] = {SE3D_METHOD_VERLET, SE3D_METHOD_GENERALIZED_ALPHA};
    for (int k = 0; k < 2 * KINDS; ++k) {
        double end_r[2][3], end_p[2][4];
        for (int triangles = 0; triangles < 2; ++triangles) {
            scene s = begin(0.2, 0.3);
            const double r[3] = {-0.8, -0.5, 0.1 - 2e-5}, v[3] = {1.5, 1.1, 0.0};
            floor_on(&s, triangles);
            se3d_body body = solid(&s, k % KINDS, r, v);
            run(&s, methods[k / KINDS], k / KINDS ? 1e-3 : 0.0, 0.3);
            CHECK(se3d_body_get_position(s.system, body, end_r[triangles]) == SE3D_OK);
            CHECK(se3d_body_get_orientation(s.system, body, end_p[triangles]) == SE3D_OK);
            scene_end(&s);
        }
        CHECK(end_r[0][0] > -0.6); /* over several edges */
        for (int a = 0; a < 4; ++a) {
            CHECK_NEAR(end_p[1][a], end_p[0][a], 1e-10);
            CHECK(a == 3 || fabs(end_r[1][a] - end_r[0][a]) < 1e-10);
        }
    }
}

static const double block[24] = {-0.5, -0.5, -0.5, 0.5, -0.5, -0.5, -0.5, 0.5, -0.5, 0.5, 0.5, -0.5,
                                 -0.5, -0.5, 0.5,  0.5, -0.5, 0.5,  -0.5, 0.5, 0.5,  0.5, 0.5, 0.5};
static const uint32_t sides[36] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                   2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

/* A block of triangles with its top at z = 0. */
static void pillar(scene *s, double width, double x)
{
    double points[24];
    for (int k = 0; k < 24; ++k) {
        points[k] = width * (block[k] - (k % 3 == 2 ? 0.5 : 0.0)) + (k % 3 ? 0.0 : x);
    }
    scene_mesh_on(s, scene_ground(s), points, 8, sides, 12);
}

/* On a smaller block, which has its corners under the box's face; over the edge of a larger one. */
static void a_box_rests_on_a_block_of_triangles(void)
{
    static const double widths[3] = {0.12, 0.6, 0.15}, places[3] = {0.0, -0.24, 0.03};
    for (int k = 0; k < 3; ++k) {
        scene s = begin(0.5, 0.3);
        const double r[3] = {0.0, 0.0, 0.1};
        double force[3], torque[3], at[3];
        pillar(&s, widths[k], places[k]);
        se3d_body body = solid(&s, BOX, r, scene_zero);
        run(&s, SE3D_METHOD_GENERALIZED_ALPHA, 1e-3, 2.0);
        CHECK(se3d_body_get_position(s.system, body, at) == SE3D_OK);
        CHECK(se3d_body_get_contact_wrench(s.system, body, force, torque) == SE3D_OK);
        CHECK(se3d_system_count_contacts(s.system) == 4);
        CHECK_NEAR(force[2], 2.0 * G, 1e-4);
        CHECK_NEAR(torque[1], 0.0, 1e-4);
        CHECK_NEAR(at[0], 0.0, 1e-3);
        CHECK(at[2] < 0.1 && at[2] > 0.0995);
        scene_end(&s);
    }
}

/* In a corner of three faces a box that is pushed into it touches all three. */
static void a_box_rests_in_a_corner_of_three_faces(void)
{
    const double points[21] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1};
    const uint32_t faces[18] = {0, 1, 2, 0, 2, 3, 0, 1, 5, 0, 5, 4, 0, 3, 6, 0, 6, 4};
    scene s = begin(0.0, 0.2);
    const double r[3] = {0.101, 0.102, 0.103}, g[3] = {-3.0, -4.0, -5.0};
    double force[3], torque[3], at[3];
    CHECK(se3d_system_set_gravity(s.system, g) == SE3D_OK);
    scene_mesh_on(&s, scene_ground(&s), points, 7, faces, 6);
    se3d_body body = solid(&s, BOX, r, scene_zero);
    run(&s, SE3D_METHOD_RADAU, 0.0, 2.0);
    CHECK(se3d_body_get_contact_wrench(s.system, body, force, torque) == SE3D_OK);
    CHECK(se3d_body_get_position(s.system, body, at) == SE3D_OK);
    CHECK(se3d_system_count_contacts(s.system) == 12);
    for (int a = 0; a < 3; ++a) {
        CHECK_NEAR(force[a], -2.0 * g[a], 1e-3); /* a gap of 1e-9 of the box */
        CHECK_NEAR(0.1 - at[a], -2.0 * g[a] / 4e5, 1e-7);
    }
    scene_end(&s);
}

/* A ball lies in a valley between two faces that look nearly the same way, and in a pit of four:
 * what the contacts do is its weight. */
static void a_ball_rests_on_faces_that_look_one_way(void)
{
    static const double points[] = {-1, -1, 0.3, 1, -1, 0.3, 1, 1, 0.3, -1, 1, 0.3, 0, 0, 0};
    static const uint32_t pit[] = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4};
    for (int skew = 0; skew < 2; ++skew) {
        scene s = begin(0.4, 0.2);
        const double r[3] = {0.0, 0.0, 0.1045}, g[3] = {0.6 * skew, -0.4 * skew, -G};
        double force[3], torque[3], v[3];
        CHECK(se3d_system_set_gravity(s.system, g) == SE3D_OK);
        scene_mesh_on(&s, scene_ground(&s), points, 5, pit, 4);
        se3d_body ball = scene_ball(&s, 0.1, 2.0, r, scene_zero);
        run(&s, SE3D_METHOD_CONVEX, 2e-3, 3.0);
        CHECK(se3d_system_count_contacts(s.system) == 4);
        CHECK(se3d_body_get_contact_wrench(s.system, ball, force, torque) == SE3D_OK);
        CHECK(se3d_body_get_velocity(s.system, ball, v) == SE3D_OK);
        for (int a = 0; a < 3; ++a) {
            CHECK_NEAR(force[a], -2.0 * g[a], 1e-5);
            CHECK_NEAR(v[a], 0.0, 1e-7);
        }
        scene_end(&s);
    }
}

/* A body that is a mesh stands on a plane on its four lowest corners. */
static void a_mesh_stands_on_a_plane(void)
{
    scene s = begin(0.5, 0.3);
    const double J[3] = {0.01, 0.01, 0.01}, r[3] = {0.0, 0.0, 0.15};
    double points[24], force[3], torque[3], at[3];
    for (int k = 0; k < 24; ++k) {
        points[k] = 0.2 * block[k];
    }
    se3d_body body = scene_body(&s, 2.0, J, r, scene_zero);
    scene_mesh_on(&s, body, points, 8, sides, 12);
    floor_on(&s, 0);
    run(&s, SE3D_METHOD_DOP853, 0.0, 2.0);
    CHECK(se3d_body_get_position(s.system, body, at) == SE3D_OK);
    CHECK(se3d_body_get_contact_wrench(s.system, body, force, torque) == SE3D_OK);
    CHECK(se3d_system_count_contacts(s.system) == 4);
    CHECK_NEAR(force[2], 2.0 * G, 1e-3);
    CHECK_NEAR(at[2], 0.1 - 2.0 * G / 4e5, 1e-6);
    scene_end(&s);
}

#define RIM 24

/* A cone of triangles whose rim is in a plane touches it all around. */
static void a_round_mesh_stands_on_its_whole_rim(void)
{
    scene s = begin(0.5, 0.3);
    const double J[3] = {0.01, 0.01, 0.01}, r[3] = {0.0, 0.0, 0.049};
    double points[3 * (RIM + 2)] = {0.0, 0.0, 0.05, 0.0, 0.0, -0.05};
    uint32_t faces[6 * RIM];
    se3d_contact contacts[16];
    for (uint32_t k = 0; k < RIM; ++k) {
        const double turn = 2.0 * PI * k / RIM;
        const uint32_t here = 2 + k, next = 2 + (k + 1) % RIM;
        const uint32_t two[6] = {0, here, next, 1, next, here};
        points[3 * here] = 0.2 * cos(turn);
        points[3 * here + 1] = 0.2 * sin(turn);
        points[3 * here + 2] = -0.05;
        memcpy(faces + 6 * k, two, sizeof two);
    }
    scene_mesh_on(&s, scene_body(&s, 2.0, J, r, scene_zero), points, RIM + 2, faces, 2 * RIM);
    floor_on(&s, 0);
    run(&s, SE3D_METHOD_DOP853, 0.0, 0.0);
    const size_t count = se3d_system_count_contacts(s.system);
    CHECK(count >= 8 && count <= 16);
    CHECK(se3d_system_get_contacts(s.system, count, contacts) == SE3D_OK);
    for (double turn = 0.0; turn < 2.0 * PI && count <= 16; turn += 0.1) {
        double most = 0.0;
        for (size_t k = 0; k < count; ++k) {
            const double *at = contacts[k].point;
            most = fmax(most, at[0] * cos(turn) + at[1] * sin(turn));
        }
        CHECK(most > 0.2 * cos(0.3 * PI / 2.0)); /* no gap of more than 54 degrees */
    }
    scene_end(&s);
}

#define RINGS 24
#define TURNS 48

/* In a bowl a ball without friction swings as a pendulum of the length R - r. */
static void a_ball_swings_in_a_bowl(void)
{
    static double points[3 * RINGS * TURNS];
    static uint32_t faces[6 * (RINGS - 1) * TURNS];
    const double R = 1.0;
    for (int k = 0; k < RINGS * TURNS; ++k) {
        double polar = 0.004 + 0.8 * (k / TURNS) / (RINGS - 1),
               turn = 2.0 * PI * (k % TURNS) / TURNS;
        points[3 * k] = R * sin(polar) * cos(turn);
        points[3 * k + 1] = R * sin(polar) * sin(turn);
        points[3 * k + 2] = -R * cos(polar);
    }
    for (uint32_t k = 0; k < (RINGS - 1) * TURNS; ++k) {
        uint32_t b = k / TURNS * TURNS + (k + 1) % TURNS;
        const uint32_t quad[6] = {k, b, k + TURNS, b, b + TURNS, k + TURNS};
        memcpy(faces + 6 * k, quad, sizeof quad);
    }
    scene s = begin(0.0, 0.1);
    const double angle = 0.3, r[3] = {0.9 * sin(angle), 0.0, -0.9 * cos(angle)};
    scene_mesh_on(&s, scene_ground(&s), points, RINGS * TURNS, faces, 2 * (RINGS - 1) * TURNS);
    se3d_body body = solid(&s, SPHERE, r, scene_zero);
    double period = 2.0 * PI * sqrt(0.9 / G) * (1.0 + angle * angle / 16.0), at[3];
    run(&s, SE3D_METHOD_VERLET, 0.0, 0.5 * period);
    CHECK(se3d_body_get_position(s.system, body, at) == SE3D_OK);
    CHECK_NEAR(at[0], -r[0], 0.02); /* facets */
    CHECK_NEAR(at[1], 0.0, 0.02);
    CHECK_NEAR(sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]), 0.9, 0.005);
    scene_end(&s);
}

int main(void)
{
    RUN(bodies_slide_over_triangles_as_over_a_plane);
    RUN(a_box_rests_on_a_block_of_triangles);
    RUN(a_box_rests_in_a_corner_of_three_faces);
    RUN(a_ball_rests_on_faces_that_look_one_way);
    RUN(a_mesh_stands_on_a_plane);
    RUN(a_round_mesh_stands_on_its_whole_rim);
    RUN(a_ball_swings_in_a_bowl);
    return check_finish();
}
