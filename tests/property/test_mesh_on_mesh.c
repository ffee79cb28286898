/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes on meshes and on solids: closed ones are made up of convex pieces, rest as the same scene
 * of boxes does, and keep momentum and energy. */
#include "contact/shape/mesh.h"
#include "math/quaternion.h"
#include "support/prisms.h"
#include "support/scene.h"

static int is_within_hull(const se3di_shape *s, const double x[3], double slack)
{
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const double *a = s->vertices + 3 * (size_t)s->triangles[3 * k];
        const double *b = s->vertices + 3 * (size_t)s->triangles[3 * k + 1];
        const double *c = s->vertices + 3 * (size_t)s->triangles[3 * k + 2];
        double u[3], v[3], n[3], size = 0.0, h = 0.0;
        for (int i = 0; i < 3; ++i) {
            u[i] = b[i] - a[i];
            v[i] = c[i] - a[i];
        }
        for (int i = 0; i < 3; ++i) {
            n[i] = u[(i + 1) % 3] * v[(i + 2) % 3] - u[(i + 2) % 3] * v[(i + 1) % 3];
            size += n[i] * n[i];
            h += n[i] * (x[i] - s->x[i] - a[i]);
        }
        if (h > slack * sqrt(size)) {
            return 0;
        }
    }
    return 1;
}

static int is_within_boxes(const prism *p, double scale, const double x[3])
{
    int within = 0;
    for (size_t k = 0; k < PRISM_BOXES; ++k) {
        const double *b = p->boxes[k];
        within = within || (x[0] > scale * b[0] && x[0] < scale * b[2] && x[2] > scale * b[1] &&
                            x[2] < scale * b[3]);
    }
    return within;
}

static void pieces_cover_the_mesh_and_nothing_else(void)
{
    for (size_t k = 0; k < 2 * PRISMS; ++k) {
        const prism *p = &prisms[k % PRISMS];
        const prism_mesh t = prism_make(p, 0.1, 0.05, (const double[2]){0.0, 0.0}, k >= PRISMS);
        const se3d_allocator standard = se3di_alloc_default();
        se3di_shape s = {.kind = SE3DI_SHAPE_MESH};
        uint64_t seed = 17;
        CHECK(se3di_mesh_build(&standard, t.points, t.point_count, t.faces, t.face_count, &s) ==
              SE3D_OK);
        CHECK(s.closed != 0);
        CHECK_NEAR((double)s.piece_count, (double)p->pieces, 0.0);
        for (int n = 0; n < 3000 && s.piece_count > 0; ++n) {
            const double x[3] = {0.2 + 0.25 * check_random(&seed), 0.0495 * check_random(&seed),
                                 0.2 + 0.25 * check_random(&seed)};
            int within = 0;
            for (size_t piece = 0; piece < s.piece_count; ++piece) {
                within = within || is_within_hull(&s.pieces[piece], x, 0.0);
            }
            CHECK(within == is_within_boxes(p, 0.1, x));
        }
        se3di_shape_release(&standard, &s);
    }
}

/* A body of a prism, as a mesh or as boxes, its origin above the middle of its foot. */
static void put_on(scene *w, se3d_body body, const prism *p, double half, double middle, int boxes)
{
    const double scale = 0.1;
    if (!boxes) {
        const prism_mesh t = prism_make(p, scale, half, (const double[2]){middle, 0.0}, 0);
        scene_mesh_on(w, body, t.points, t.point_count, t.faces, t.face_count);
        return;
    }
    for (size_t k = 0; k < PRISM_BOXES && p->boxes[k][2] > 0.0; ++k) {
        const double *b = p->boxes[k];
        const double size[3] = {scale * (b[2] - b[0]), 2.0 * half, scale * (b[3] - b[1])};
        const double at[3] = {0.5 * scale * (b[0] + b[2]) - middle, 0.0,
                              0.5 * scale * (b[1] + b[3])};
        scene_box_on(w, body, size, at);
    }
}

static scene begin(double restitution)
{
    return scene_begin(SE3D_CONTACT_LAW_HOOKE, 0.3, restitution, 1e5);
}

static const double inertia[3] = {0.02, 0.02, 0.02};

/* Each point carries its share of the weight by one spring. */
static void prisms_rest_on_prisms_as_boxes_do(void)
{
    static const struct {
        int top, bottom;
        double middle; /* of the foot, from the left */
        double height; /* of the place that it stands on */
    } cases[] = {{BLOCK, BLOCK, 0.15, 0.1}, {L, T, 0.1, 0.3},      {U, T, 0.15, 0.3},
                 {T, BLOCK, 0.15, 0.1},     {CROSS, T, 0.15, 0.3}, {BLOCK, U, 0.15, 0.2},
                 {L, BLOCK, 0.1, 0.1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
        for (int boxes = 0; boxes < 2; ++boxes) {
            scene w = begin(0.2);
            const double depth = 2.0 * G / 1e5 / 8.0;
            const double r[3] = {0.0, 0.0, cases[k].height - depth};
            double at[3], force[3], torque[3];
            se3d_body body = scene_body(&w, 2.0, inertia, r, scene_zero);
            put_on(&w, scene_ground(&w), &prisms[cases[k].bottom], 0.2, 0.15, boxes);
            put_on(&w, body, &prisms[cases[k].top], 0.05, cases[k].middle, boxes);
            scene_solve(&w, SE3D_METHOD_VERLET, SE3D_FORMULATION_ROMEGA, 2e-4, 0.0);
            scene_run(&w, 0.05);
            const double points = (double)se3d_system_count_contacts(w.system);
            CHECK(points >= 4.0);
            CHECK(se3d_system_count_passing_meshes(w.system, NULL, NULL) == 0);
            CHECK(se3d_body_get_position(w.system, body, at) == SE3D_OK);
            CHECK(se3d_body_get_contact_wrench(w.system, body, force, torque) == SE3D_OK);
            CHECK_NEAR(force[2], 2.0 * G, 1e-4 * G);
            CHECK_NEAR(force[0], 0.0, 1e-4 * G);
            CHECK_NEAR(at[0], 0.0, 1e-8);
            if (!boxes) {
                CHECK_NEAR(cases[k].height - at[2], 2.0 * G / (1e5 * points), 5e-9);
            }
            scene_end(&w);
        }
    }
}

/* A plate with hollows lies on a solid of the ground, whose top is at z = 0. */
static se3d_body lay(scene *w, const prism *p, int kind, const double place[2])
{
    const double r[3] = {place[0], place[1], 0.05 - 1e-5};
    se3d_body body = scene_body(w, 2.0, inertia, r, scene_zero);
    prism_mesh t = prism_make(p, 0.1, 0.05, (const double[2]){0.15, 0.15}, 0);
    double corners[36];
    se3d_shape_def def = scene_shape(w, scene_ground(w));
    se3d_shape shape;
    for (size_t k = 0; k < t.point_count; ++k) {
        const double y = t.points[3 * k + 1];
        t.points[3 * k + 1] = -t.points[3 * k + 2];
        t.points[3 * k + 2] = y;
    }
    scene_mesh_on(w, body, t.points, t.point_count, t.faces, t.face_count);
    for (int k = 0; k < 12; ++k) {
        corners[3 * k] = 0.2 * cos(PI / 3.0 * (k % 6));
        corners[3 * k + 1] = 0.2 * sin(PI / 3.0 * (k % 6));
        corners[3 * k + 2] = k < 6 ? 0.0 : -0.2;
    }
    def.size[0] = def.size[1] = 0.3;
    def.size[2] = def.length = 0.2;
    def.radius = 0.16;
    def.position[2] = kind < 2 ? -0.1 : 0.0;
    def.vertices = corners;
    def.vertex_count = 12;
    CHECK((kind == 0   ? se3d_shape_create_box(w->system, &def, &shape)
           : kind == 1 ? se3d_shape_create_cylinder(w->system, &def, &shape)
                       : se3d_shape_create_hull(w->system, &def, &shape)) == SE3D_OK);
    return body;
}

/* With the corner of a hollow over the solid's top, with sides flush with its sides, and between.
 * No contact looks sideways, and steps are not held up by contacts that come and go. */
static void plates_with_hollows_lie_on_solids(void)
{
    static const double places[3][2] = {{-0.04, -0.045}, {0.05, 0.0}, {0.013, -0.021}};
    for (int k = 0; k < BLOCK * 9; k += 5) {
        const double tilt = k % 2 ? 2e-4 : 0.0, axis[3] = {0.6, 0.8, 0.0};
        scene w = begin(0.5);
        se3d_energy before, after;
        se3d_solver_stats stats;
        se3d_body body = lay(&w, &prisms[k / 9], k / 3 % 3, places[k % 3]);
        scene_turn(&w, body, axis, tilt);
        scene_solve(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-6);
        CHECK(se3d_system_get_energy(w.system, &before) == SE3D_OK);
        scene_run(&w, 3e-3);
        CHECK(se3d_system_get_energy(w.system, &after) == SE3D_OK);
        CHECK(se3d_solver_get_stats(w.solver, &stats) == SE3D_OK);
        CHECK_NEAR(after.total + after.dissipated, before.total + before.dissipated, 1e-9);
        CHECK(after.total < before.total + 1e-9);
        CHECK(stats.steps < 400);
        se3d_contact contacts[16];
        const size_t count = se3d_system_count_contacts(w.system);
        CHECK(count > 0 && count <= 16);
        CHECK(se3d_system_get_contacts(w.system, count, contacts) == SE3D_OK);
        for (size_t c = 0; c < count; ++c) {
            CHECK(fabs(contacts[c].normal[2]) > 0.999);
        }
        scene_end(&w);
    }
}

static void add_momentum(const scene *w, se3d_body body, double mass, double now[6])
{
    double r[3], v[3], omega[3], p[4], A[9], L_body[3];
    CHECK(se3d_body_get_position(w->system, body, r) == SE3D_OK);
    CHECK(se3d_body_get_velocity(w->system, body, v) == SE3D_OK);
    CHECK(se3d_body_get_angular_velocity(w->system, body, omega) == SE3D_OK);
    CHECK(se3d_body_get_orientation(w->system, body, p) == SE3D_OK);
    se3di_quat_to_matrix(p, A);
    for (int c = 0; c < 3; ++c) {
        L_body[c] = inertia[c] * omega[c];
    }
    for (int c = 0; c < 3; ++c) {
        const int i = (c + 1) % 3, j = (c + 2) % 3;
        now[c] += mass * v[c];
        now[3 + c] += mass * (r[i] * v[j] - r[j] * v[i]) + A[3 * c] * L_body[0] +
                      A[3 * c + 1] * L_body[1] + A[3 * c + 2] * L_body[2];
    }
}

/* An L that spins flies into a U in free space. */
static void momentum_of_meshes_that_collide_is_kept(void)
{
    scene w = begin(0.7);
    const double r[2][3] = {{0.0, 0.0, 0.0}, {0.35, 0.02, 0.03}}, v[3] = {-2.0, 0.1, 0.0};
    const double spin[3] = {1.0, -2.0, 0.5}, mass[2] = {3.0, 1.0};
    double first[6] = {0.0}, after[3];
    se3d_body bodies[2];
    CHECK(se3d_system_set_gravity(w.system, scene_zero) == SE3D_OK);
    for (int k = 0; k < 2; ++k) {
        bodies[k] = scene_body(&w, mass[k], inertia, r[k], k ? v : scene_zero);
        put_on(&w, bodies[k], &prisms[k ? L : U], 0.05, k ? 0.1 : 0.15, 0);
    }
    CHECK(se3d_body_set_angular_velocity(w.system, bodies[1], spin) == SE3D_OK);
    scene_solve(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-6);
    for (int step = 0; step < 3; ++step) {
        double now[6] = {0.0};
        scene_run(&w, 0.06 * step);
        for (int k = 0; k < 2; ++k) {
            add_momentum(&w, bodies[k], mass[k], now);
        }
        for (int c = 0; c < 6; ++c) {
            first[c] = step == 0 ? now[c] : first[c];
            CHECK_NEAR(now[c], first[c], 1e-9);
        }
    }
    CHECK(se3d_body_get_velocity(w.system, bodies[0], after) == SE3D_OK);
    CHECK(after[0] < -0.1); /* they did meet */
    scene_end(&w);
}

/* A cross falls on its corner onto a T and tumbles; what is lost is accounted for. */
static void energy_of_a_falling_mesh_is_accounted_for(void)
{
    scene w = begin(0.4);
    const double r[3] = {0.0, 0.0, 0.34}, axis[3] = {0.6, 0.8, 0.0};
    se3d_energy before, after;
    se3d_body body = scene_body(&w, 2.0, inertia, r, scene_zero);
    put_on(&w, scene_ground(&w), &prisms[T], 0.2, 0.15, 0);
    put_on(&w, body, &prisms[CROSS], 0.05, 0.15, 0);
    scene_turn(&w, body, axis, 0.3);
    scene_solve(&w, SE3D_METHOD_DOP853, SE3D_FORMULATION_ROMEGA, 0.0, 1e-5);
    CHECK(se3d_system_get_energy(w.system, &before) == SE3D_OK);
    scene_run(&w, 0.12);
    CHECK(se3d_system_get_energy(w.system, &after) == SE3D_OK);
    CHECK_NEAR(after.total + after.dissipated, before.total, 1e-3 * before.total);
    CHECK(after.dissipated > 0.02);
    scene_end(&w);
}

int main(void)
{
    RUN(pieces_cover_the_mesh_and_nothing_else);
    RUN(prisms_rest_on_prisms_as_boxes_do);
    RUN(plates_with_hollows_lie_on_solids);
    RUN(momentum_of_meshes_that_collide_is_kept);
    RUN(energy_of_a_falling_mesh_is_accounted_for);
    return check_finish();
}
