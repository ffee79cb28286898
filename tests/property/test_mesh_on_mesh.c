/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes on meshes: closed ones are made up of convex pieces, rest as the same scene of boxes does,
 * and keep momentum and energy. */
#include "contact/shape/mesh.h"
#include "math/quaternion.h"
#include "support/scene.h"

#define MOST 16

/* A profile in the x-z plane, counter-clockwise seen from -y, and boxes that make it up; it is as
 * thick as it says along y, from -half to half. */
typedef struct prism {
    const char *name;
    size_t corners;
    double at[MOST][2];
    size_t pieces;
    double boxes[4][4]; /* low x, low z, high x, high z */
} prism;

static const prism prisms[] = {
    {"L", 6, {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}, 2, {{0, 0, 2, 1}, {0, 0, 1, 3}}},
    {"T",
     8,
     {{1, 0}, {2, 0}, {2, 2}, {3, 2}, {3, 3}, {0, 3}, {0, 2}, {1, 2}},
     2,
     {{1, 0, 2, 3}, {0, 2, 3, 3}}},
    {"U",
     8,
     {{0, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {1, 1}, {1, 2}, {0, 2}},
     3,
     {{0, 0, 3, 1}, {0, 0, 1, 2}, {2, 0, 3, 2}}},
    {"cross",
     12,
     {{1, 0},
      {2, 0},
      {2, 1},
      {3, 1},
      {3, 2},
      {2, 2},
      {2, 3},
      {1, 3},
      {1, 2},
      {0, 2},
      {0, 1},
      {1, 1}},
     2,
     {{1, 0, 2, 3}, {0, 1, 3, 2}}},
    {"block", 4, {{0, 0}, {3, 0}, {3, 1}, {0, 1}}, 0, {{0, 0, 3, 1}}}};
enum { L, T, U, CROSS, BLOCK, PRISMS };

typedef struct triangles {
    double points[6 * MOST];
    uint32_t faces[12 * MOST];
    size_t point_count, face_count;
} triangles;

static double cross_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/* Ears of the profile, cut off one after the other. */
static void fill_ends(const prism *p, triangles *t)
{
    uint32_t left[MOST];
    size_t count = p->corners;
    for (uint32_t k = 0; k < count; ++k) {
        left[k] = k;
    }
    while (count > 2) {
        for (size_t k = 0; k < count; ++k) {
            const uint32_t a = left[(k + count - 1) % count], b = left[k],
                           c = left[(k + 1) % count];
            int is_ear = cross_of(p->at[a], p->at[b], p->at[c]) > 0.0;
            for (size_t o = 0; o < count && is_ear; ++o) {
                const double *x = p->at[left[o]];
                is_ear = left[o] == a || left[o] == b || left[o] == c ||
                         cross_of(p->at[a], p->at[b], x) < 0.0 ||
                         cross_of(p->at[b], p->at[c], x) < 0.0 ||
                         cross_of(p->at[c], p->at[a], x) < 0.0;
            }
            if (is_ear) {
                const uint32_t n = (uint32_t)p->corners;
                const uint32_t ends[6] = {a, b, c, c + n, b + n, a + n};
                memcpy(t->faces + 3 * t->face_count, ends, sizeof ends);
                t->face_count += 2;
                memmove(&left[k], &left[k + 1], (count - k - 1) * sizeof *left);
                --count;
                break;
            }
        }
    }
}

/* Scaled, about its reference corner moved to -`shift`. `turned`: clockwise seen from outside. */
static triangles make(const prism *p, double scale, double half, const double shift[2], int turned)
{
    triangles t = {.point_count = 2 * p->corners};
    const uint32_t n = (uint32_t)p->corners;
    for (uint32_t k = 0; k < 2 * n; ++k) {
        t.points[3 * k] = scale * p->at[k % n][0] - shift[0];
        t.points[3 * k + 1] = k < n ? -half : half;
        t.points[3 * k + 2] = scale * p->at[k % n][1] - shift[1];
    }
    fill_ends(p, &t);
    for (uint32_t k = 0; k < n; ++k) {
        const uint32_t b = (k + 1) % n;
        const uint32_t sides[6] = {k, k + n, b, b, k + n, b + n};
        memcpy(t.faces + 3 * t.face_count, sides, sizeof sides);
        t.face_count += 2;
    }
    for (size_t k = 0; k < t.face_count && turned; ++k) {
        const uint32_t a = t.faces[3 * k];
        t.faces[3 * k] = t.faces[3 * k + 1];
        t.faces[3 * k + 1] = a;
    }
    return t;
}

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
    for (size_t k = 0; k < 4; ++k) {
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
        const triangles t = make(p, 0.1, 0.05, (const double[2]){0.0, 0.0}, k >= PRISMS);
        const se3d_allocator standard = se3di_alloc_default();
        se3di_shape s = {.kind = SE3DI_SHAPE_MESH};
        uint64_t seed = 17;
        CHECK(se3di_mesh_build(&standard, t.points, t.point_count, t.faces, t.face_count, &s) ==
              SE3D_OK);
        CHECK(s.closed != 0);
        CHECK_NEAR((double)s.piece_count, (double)p->pieces, 0.0);
        for (int n = 0; n < 3000 && s.piece_count > 0; ++n) {
            const double x[3] = {0.15 + 0.2 * check_random(&seed), 0.0495 * check_random(&seed),
                                 0.15 + 0.2 * check_random(&seed)};
            int within = 0;
            for (size_t piece = 0; piece < s.piece_count; ++piece) {
                within = within || is_within_hull(&s.pieces[piece], x, 0.0);
            }
            CHECK(within == is_within_boxes(p, 0.1, x));
        }
        se3di_shape_release(&standard, &s);
    }
}

/* With a hole: four bars. */
static void a_frame_has_four_pieces(void)
{
    /* the frame: an outer and an inner square, joined at the ends */
    triangles t = {.point_count = 16};
    for (uint32_t k = 0; k < 16; ++k) {
        const uint32_t corner = k % 4;
        const double half = k % 8 < 4 ? 0.2 : 0.1;
        t.points[3 * k] = corner == 0 || corner == 3 ? -half : half;
        t.points[3 * k + 1] = k < 8 ? -0.05 : 0.05;
        t.points[3 * k + 2] = corner < 2 ? -half : half;
    }
    for (uint32_t k = 0; k < 4; ++k) {
        const uint32_t n = (k + 1) % 4;
        const uint32_t quads[4][4] = {{k, n, n + 4, k + 4},
                                      {k + 12, n + 12, n + 8, k + 8},
                                      {k + 8, n + 8, n, k},
                                      {k + 4, n + 4, n + 12, k + 12}};
        for (size_t q = 0; q < 4; ++q) {
            const uint32_t *v = quads[q];
            const uint32_t two[6] = {v[0], v[1], v[2], v[0], v[2], v[3]};
            memcpy(t.faces + 3 * t.face_count, two, sizeof two);
            t.face_count += 2;
        }
    }
    const se3d_allocator standard = se3di_alloc_default();
    se3di_shape s = {.kind = SE3DI_SHAPE_MESH};
    uint64_t seed = 5;
    CHECK(se3di_mesh_build(&standard, t.points, t.point_count, t.faces, t.face_count, &s) ==
          SE3D_OK);
    CHECK(s.closed != 0);
    CHECK_NEAR((double)s.piece_count, 4.0, 0.0);
    for (int n = 0; n < 3000; ++n) {
        const double x[3] = {0.22 * check_random(&seed), 0.0495 * check_random(&seed),
                             0.22 * check_random(&seed)};
        const double most = fmax(fabs(x[0]), fabs(x[2]));
        int within = 0;
        for (size_t piece = 0; piece < s.piece_count; ++piece) {
            within = within || is_within_hull(&s.pieces[piece], x, 0.0);
        }
        CHECK(within == (most > 0.1 && most < 0.2));
    }
    se3di_shape_release(&standard, &s);
}

/* A body of a prism, as a mesh or as boxes, its origin above the middle of its foot. */
static void put_on(scene *w, se3d_body body, const prism *p, double half, double middle, int boxes)
{
    const double scale = 0.1;
    if (!boxes) {
        const triangles t = make(p, scale, half, (const double[2]){middle, 0.0}, 0);
        scene_mesh_on(w, body, t.points, t.point_count, t.faces, t.face_count);
        return;
    }
    for (size_t k = 0; k < 4 && p->boxes[k][2] > 0.0; ++k) {
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
    RUN(a_frame_has_four_pieces);
    RUN(prisms_rest_on_prisms_as_boxes_do);
    RUN(momentum_of_meshes_that_collide_is_kept);
    RUN(energy_of_a_falling_mesh_is_accounted_for);
    return check_finish();
}
