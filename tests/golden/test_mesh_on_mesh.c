/* SPDX-License-Identifier: BSD-3-Clause */
/* Closed meshes with hollows on each other, most of too many triangles for convex pieces: a bolt in
 * a hole, a ball that its socket holds, what passes between them, a ring that lies on another. */
#include "support/scene.h"

#define FACETS   48
#define CORNERS  64
#define VERTICES (CORNERS * FACETS)

typedef struct ring {
    double r, z;
} ring;

/* The solid that a closed profile sweeps about z (counter-clockwise in r, z) in so many facets, as
 * a mesh that leans about x. */
static void turn_by(scene *s, se3d_body body, const ring *profile, uint32_t count, double lean,
                    uint32_t facets)
{
    static double vertices[3 * VERTICES];
    static uint32_t triangles[6 * VERTICES];
    uint32_t used = 0;
    for (uint32_t k = 0; k < count * facets; ++k) {
        const double angle = 2.0 * PI * (double)(k % facets) / facets;
        const ring *at = &profile[k / facets];
        vertices[3 * k] = at->r * cos(angle);
        vertices[3 * k + 1] = at->r * sin(angle);
        vertices[3 * k + 2] = at->z;
    }
    for (uint32_t k = 0; k < count * facets; ++k) {
        const uint32_t i = k / facets, j = (i + 1) % count, next = (k % facets + 1) % facets;
        const uint32_t a = k, b = j * facets + k % facets, c = j * facets + next;
        const uint32_t d = i * facets + next;
        const uint32_t both[6] = {a, c, b, a, d, c};
        for (uint32_t t = 0; t < 6; t += 3) { /* one at the axis has no area */
            memcpy(triangles + 3 * used++, both + t, 3 * sizeof *both);
        }
    }
    se3d_shape_def def = scene_shape(s, body);
    se3d_shape shape;
    def.orientation[0] = cos(0.5 * lean);
    def.orientation[1] = sin(0.5 * lean);
    def.vertices = vertices;
    def.vertex_count = count * facets;
    def.triangles = triangles;
    def.triangle_count = used;
    CHECK(se3d_shape_create_mesh(s->system, &def, &shape) == SE3D_OK);
}

static void turn(scene *s, se3d_body body, const ring *profile, uint32_t count, double lean)
{
    turn_by(s, body, profile, count, lean, FACETS);
}

static double contact_force(const scene *s, se3d_body body, double force[3])
{
    double torque[3];
    CHECK(se3d_body_get_contact_wrench(s->system, body, force, torque) == SE3D_OK);
    return force[2];
}

/* The head of the bolt lands on the plate, its shank stays in the hole and keeps it from sliding
 * off a plate that is tilted. */
static void a_bolt_sits_in_its_hole(void)
{
    static const ring bolt[] = {{0.0, -0.03}, {0.005, -0.03}, {0.005, 0.0},
                                {0.01, 0.0},  {0.01, 0.008},  {0.0, 0.008}};
    static const ring plate[] = {{0.0052, -0.01}, {0.03, -0.01}, {0.03, 0.0}, {0.0052, 0.0}};
    const double x[3] = {1.0, 0.0, 0.0}, start[3] = {1e-4, 0.0, 0.002};
    const double J[3] = {5e-6, 5e-6, 2e-6};
    for (int tilted = 0; tilted < 2; ++tilted) {
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.1, 0.2, 1e6);
        const double angle = tilted ? 0.3 : 0.0;
        double r[3], w[3], force[3];
        const se3d_body body = scene_body(&s, 0.04, J, start, scene_zero);
        turn(&s, scene_ground(&s), plate, 4, angle);
        turn(&s, body, bolt, 6, 0.0);
        scene_turn(&s, body, x, angle);
        scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, 1e-3, 0.0);
        if (scene_run(&s, 0.3)) {
            CHECK(se3d_body_get_position(s.system, body, r) == SE3D_OK);
            CHECK(se3d_body_get_angular_velocity(s.system, body, w) == SE3D_OK);
            CHECK_NEAR(contact_force(&s, body, force), 0.04 * G, 1e-3 * 0.04 * G);
            CHECK_NEAR(force[0], 0.0, 1e-3 * 0.04 * G);
            CHECK_NEAR(force[1], 0.0, 1e-3 * 0.04 * G);
            CHECK_NEAR(r[2] * cos(angle) - r[1] * sin(angle), 0.0, 2e-6); /* of the head */
            CHECK(hypot(r[0], r[1] * cos(angle) + r[2] * sin(angle)) < 2.1e-4);
            CHECK_NEAR(w[0] * w[0] + w[1] * w[1] + w[2] * w[2], 0.0, 1e-6);
        }
        scene_end(&s);
    }
}

/* Of a ball of 20 mm, in a cavity that goes on 40 degrees beyond its middle, upside down. */
static void a_socket_holds_its_ball(void)
{
    enum { BALL = 19, WALL = 22 };
    ring ball[BALL], socket[WALL + 3];
    const double J[3] = {5e-5, 5e-5, 5e-5};
    double r[3];
    for (int k = 0; k < BALL; ++k) {
        const double angle = PI * (k / (BALL - 1.0) - 0.5);
        ball[k] = (ring){k % (BALL - 1) ? 0.02 * cos(angle) : 0.0, 0.02 * sin(angle)};
    }
    for (int k = 0; k < WALL; ++k) { /* from its rim down to the axis */
        const double angle = PI * (40.0 - 130.0 * k / (WALL - 1.0)) / 180.0;
        socket[3 + k] = (ring){k < WALL - 1 ? 0.0201 * cos(angle) : 0.0, 0.0201 * sin(angle)};
    }
    socket[0] = (ring){0.0, -0.03};
    socket[1] = (ring){0.03, -0.03};
    socket[2] = (ring){0.03, socket[3].z};
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.1, 0.2, 1e6);
    const se3d_body body = scene_body(&s, 0.25, J, scene_zero, scene_zero);
    turn(&s, scene_ground(&s), socket, WALL + 3, PI);
    turn(&s, body, ball, BALL, 0.0);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, 1e-3, 0.0);
    if (scene_run(&s, 0.1)) {
        CHECK(se3d_body_get_position(s.system, body, r) == SE3D_OK);
        CHECK(r[2] < 0.0 && sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2]) < 3e-4);
        CHECK(se3d_system_count_contacts(s.system) > 0);
    }
    scene_end(&s);
}

/* A ring lies on a sheet, beyond whose border one of its corners is by 0.03 mm, less than the depth
 * to which is looked; then by more. There is nothing to push that corner aside. */
static void nothing_touches_beyond_the_border_of_a_sheet(void)
{
    static const ring plate[] = {{0.01, 0.0}, {0.03, 0.0}, {0.03, 0.01}, {0.01, 0.01}};
    const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
    const double J[3] = {1e-5, 1e-5, 2e-5};
    for (int k = 0; k < 3; ++k) {
        const double border = 0.03 - 0.00003 * k, start[3] = {0.0, 0.0, 1e-5};
        const double corners[12] = {-1.0,   -1.0, 0.0, border, -1.0, 0.0,
                                    border, 1.0,  0.0, -1.0,   1.0,  0.0};
        double r[3], v[3], force[3];
        scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.1, 0.2, 1e6);
        const se3d_body body = scene_body(&s, 0.04, J, start, scene_zero);
        scene_mesh_on(&s, scene_ground(&s), corners, 4, faces, 2);
        turn(&s, body, plate, 4, 0.0);
        scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, 1e-3, 0.0);
        if (scene_run(&s, 0.1)) {
            CHECK(se3d_body_get_position(s.system, body, r) == SE3D_OK);
            CHECK(se3d_body_get_velocity(s.system, body, v) == SE3D_OK);
            CHECK_NEAR(contact_force(&s, body, force), 0.04 * G, 1e-3 * 0.04 * G);
            CHECK_NEAR(hypot(r[0], r[1]), 0.0, 1e-6);
            CHECK_NEAR(hypot(v[0], v[1]), 0.0, 1e-6);
        }
        scene_end(&s);
    }
}

/* A ring of 12 facets lies on its like, edge on edge: each piece of the one comes off several of
 * the other in ways that hardly differ, and of 24 corners 16 are points of contact, always the
 * same. */
static void a_ring_comes_to_rest_on_its_like(void)
{
    enum { STEPS = 20 };
    static const ring profile[] = {{0.0109, -0.01}, {0.02, -0.01}, {0.02, 0.01}, {0.0109, 0.01}};
    const double start[3] = {0.0, 0.0, 0.02 - 1e-6}, J[3] = {0.02, 0.02, 0.01}, mass = 50.0;
    const double spin[3] = {1e-5, 0.0, 0.0};
    double v[3], w[3], force[3];
    scene s = scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.2, 0.2, 1e7);
    const se3d_body body = scene_body(&s, mass, J, start, scene_zero);
    CHECK(se3d_body_set_angular_velocity(s.system, body, spin) == SE3D_OK);
    turn_by(&s, scene_ground(&s), profile, 4, 0.0, 12);
    turn_by(&s, body, profile, 4, 0.0, 12);
    scene_solve(&s, SE3D_METHOD_CONVEX, SE3D_FORMULATION_ROMEGA, 1e-3, 0.0);
    if (scene_run(&s, 0.2)) {
        const size_t count = se3d_system_count_contacts(s.system);
        se3d_snapshot *snapshot = NULL;
        CHECK(se3d_snapshot_create(s.system, &snapshot) == SE3D_OK);
        for (int k = 1; k <= STEPS && scene_run(&s, 0.2 + 1e-3 * k); ++k) {
            CHECK(se3d_system_count_contacts(s.system) == count);
            CHECK_NEAR(contact_force(&s, body, force), mass * G, 1e-6 * mass * G);
            CHECK(se3d_body_get_velocity(s.system, body, v) == SE3D_OK);
            CHECK(se3d_body_get_angular_velocity(s.system, body, w) == SE3D_OK);
            CHECK_NEAR(v[2], 0.0, 1e-9);
            CHECK_NEAR(hypot(w[0], w[1]), 0.0, 1e-7);
        }
        const uint64_t hash = se3d_system_hash(s.system);
        CHECK(se3d_snapshot_restore(snapshot, s.system) == SE3D_OK);
        CHECK(se3d_system_hash(s.system) != hash);
        for (int k = 1; k <= STEPS; ++k) {
            CHECK(scene_run(&s, 0.2 + 1e-3 * k));
        }
        CHECK(se3d_system_hash(s.system) == hash);
        se3d_snapshot_destroy(snapshot);
    }
    scene_end(&s);
}

int main(void)
{
    RUN(a_bolt_sits_in_its_hole);
    RUN(a_socket_holds_its_ball);
    RUN(nothing_touches_beyond_the_border_of_a_sheet);
    RUN(a_ring_comes_to_rest_on_its_like);
    return check_finish();
}
