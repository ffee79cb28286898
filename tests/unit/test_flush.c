/* SPDX-License-Identifier: BSD-3-Clause */
/* Flat on flat: a cylinder, a box and a second mesh on a frame with a hole. What they touch in is
 * known: no point looks to a side, however shallow the overlap and however short the way into
 * the hole, and the same points are there after the least move. */
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh.h"
#include "support/poses.h"
#include "support/prisms.h"

#define SCALE 0.01
#define HALF  0.01 /* m: half of its thickness; the face is at y = HALF */

static size_t piece_count; /* that it has */

static void make_frame(int in_pieces, se3di_shape *s)
{
    const se3d_allocator standard = se3di_alloc_default();
    const prism_mesh t = prism_make(&prisms[FRAME], SCALE, HALF, (const double[2]){0.02, 0.02}, 0);
    *s = (se3di_shape){.kind = SE3DI_SHAPE_MESH};
    CHECK(!se3di_mesh_build(&standard, t.points, t.point_count, t.faces, t.face_count, s));
    s->bound = se3di_shape_bound(s);
    CHECK(s->piece_count > 0);
    piece_count = s->piece_count;
    s->piece_count = in_pieces ? piece_count : 0;
}

static void release(se3di_shape *s)
{
    const se3d_allocator standard = se3di_alloc_default();
    s->piece_count = piece_count;
    se3di_shape_release(&standard, s);
}

/* Its axis along y but for an angle about x; its lower cap around (x, HALF - depth, z). */
static void stand(const se3di_shape *s, double angle, const double place[2], double depth,
                  se3di_shape_pose *at)
{
    const double turn = 0.5 * (1.5707963267948966 + angle);
    const double p[4] = {cos(turn), -sin(turn), 0.0, 0.0};
    double axis[3];
    memset(at, 0, sizeof *at);
    se3di_quat_to_matrix(p, at->R);
    for (int k = 0; k < 3; ++k) {
        axis[k] = at->R[3 * k + 2];
    }
    at->x[0] = place[0];
    at->x[1] = HALF - depth;
    at->x[2] = place[1];
    se3di_add_scaled(s->half_length, axis, at->x);
}

static void check_upright(const se3di_manifold *m, double most, double angle)
{
    for (uint32_t k = 0; k < m->count; ++k) {
        CHECK_NEAR(fabs(m->points[k].normal[1]), 1.0, angle * angle + 1e-12);
        CHECK(m->points[k].overlap > 0.0 && m->points[k].overlap < most * (1.0 + 1e-9) + 1e-15);
        for (uint32_t other = 0; other < k; ++other) {
            CHECK(m->points[k].feature != m->points[other].feature);
        }
    }
}

static int have_the_same(const se3di_manifold *a, const se3di_manifold *b)
{
    int same = a->count == b->count;
    for (uint32_t k = 0; k < a->count && same; ++k) {
        same = a->points[k].feature == b->points[k].feature;
    }
    return same;
}

/* Points of the rim, or corners, are over the frame; corners of the hole are below the solid. */
static void solids_over_a_hole_touch_in_their_corners_and_those_of_the_hole(void)
{
    const se3di_shape_pose of = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    const double half = 0.016;
    se3di_shape solids[2] = {
        {.kind = SE3DI_SHAPE_CYLINDER, .radius = half, .half_length = 0.01},
        {.kind = SE3DI_SHAPE_BOX, .half = {half, half, 0.01}, .half_length = 0.01}};
    for (int k = 0; k < 2 * 2 * 6 * 4; ++k) {
        const int step = k / 4 % 6, tilt = k / 24;
        const double depth = pow(10.0, -9.0 + step), angle = tilt * 0.3 * depth / half;
        const double place[2] = {1e-4 * tilt, -2e-4 * tilt};
        se3di_shape frame, *solid = &solids[k / 2 % 2];
        se3di_shape_pose at, moved;
        se3di_manifold m, again;
        solid->bound = se3di_shape_bound(solid);
        make_frame(k % 2, &frame);
        stand(solid, angle, place, depth, &at);
        se3di_narrow_find(solid, &at, &frame, &of, &m);
        CHECK(m.count == 8);
        check_upright(&m, depth + angle * half, angle);
        moved = at;
        moved.x[0] += 1e-9;
        se3di_narrow_find(solid, &moved, &frame, &of, &again);
        CHECK(have_the_same(&m, &again));
        at.x[1] += 1.1 * (depth + angle * half);
        se3di_narrow_find(solid, &at, &frame, &of, &m);
        CHECK(m.count == 0);
        release(&frame);
    }
}

/* Of a cap that is over the border by less than it is deep the way to the side counts. */
static void a_cap_at_a_border_comes_off_to_the_side(void)
{
    const se3di_shape_pose of = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    se3di_shape frame, cap = {.kind = SE3DI_SHAPE_CYLINDER, .radius = 0.004, .half_length = 0.01};
    const double over = 1e-6, place[2] = {0.02 + cap.radius - over, 0.0};
    cap.bound = se3di_shape_bound(&cap);
    for (int in_pieces = 0; in_pieces < 2; ++in_pieces) {
        se3di_shape_pose at;
        se3di_manifold m;
        make_frame(in_pieces, &frame);
        stand(&cap, 0.0, place, 2e-4, &at);
        se3di_narrow_find(&cap, &at, &frame, &of, &m);
        CHECK(m.count > 0);
        for (uint32_t k = 0; k < m.count; ++k) {
            CHECK(m.points[k].overlap < over * (1.0 + 1e-6));
        }
        release(&frame);
    }
}

/* ---- what else is as high as a side ---- */

enum { LOWER_RIDGE, LEVEL_RIDGE, TIP, BRIDGE, SLOW_RIDGE, SLOW_FLANK, BESIDES };

/* In the x-z plane: a part ends at a groove, beyond which there is a ridge; or at a flank. */
static const prism beside_part[] = {
    {"lower ridge",
     9,
     {{-1, -1},
      {1.4, -1},
      {1.4, -.5},
      {1.2, -.5},
      {1, -.002},
      {.8, -.5},
      {0, -.5},
      {0, 0},
      {-1, 0}},
     0,
     {{0}}},
    {"level ridge",
     9,
     {{-1, -1}, {1.4, -1}, {1.4, -.5}, {1.2, -.5}, {1, 0}, {.8, -.5}, {0, -.5}, {0, 0}, {-1, 0}},
     0,
     {{0}}},
    {"slow flank",
     8,
     {{-1, -1}, {0, -1}, {.5, -.9}, {1, -1}, {4, -1}, {4, -.02}, {0, 0}, {-1, 0}},
     0,
     {{0}}}};

/* A part for x < 0 and a roof beyond it, from whose ridge another part begins at x = 4. */
static const prism_mesh bridge = {
    .points = {-1, -.5, 0,  0,   -.5, 0,   0,  0,  0,  0,   .5, 0,   -1,  .5, 0,  4,
               0,  0,   -1, -.5, -1,  -1,  .5, -1, 0,  -.5, -1, 4,   -.5, -1, 0,  .5,
               -1, 4,   .5, -1,  5,   -.5, 0,  5,  .5, 0,   5,  -.5, -1,  5,  .5, -1},
    .faces = {0,  1,  2, 0,  2,  3,  0,  3,  4,  2,  1,  8,  3,  2,  10, 2, 8,  9,  2, 9,  5,
              10, 2,  5, 5,  11, 10, 8,  10, 11, 8,  11, 9,  6,  7,  10, 6, 10, 8,  6, 8,  1,
              6,  1,  0, 4,  3,  10, 4,  10, 7,  0,  4,  7,  0,  7,  6,  5, 12, 13, 9, 14, 12,
              9,  12, 5, 11, 5,  13, 11, 13, 15, 12, 14, 15, 12, 15, 13, 9, 11, 15, 9, 15, 14},
    .point_count = 16,
    .face_count = 28};

/* In three strips, so that triangles about the solid are not at the ends of its sides. */
static void cut_in_strips(const prism *p, prism_mesh *t)
{
    const uint32_t n = (uint32_t)p->corners, layers[4] = {0, 2 * n, 3 * n, n};
    t->face_count = 2 * (p->corners - 2); /* its ends */
    t->point_count = 4 * p->corners;
    for (uint32_t k = 0; k < 3 * n; ++k) {
        const uint32_t *l = layers + k / n, a = k % n, b = (a + 1) % n;
        const uint32_t side[6] = {l[0] + a, l[1] + a, l[0] + b, l[0] + b, l[1] + a, l[1] + b};
        memcpy(t->faces + 3 * t->face_count, side, sizeof side);
        t->face_count += 2;
    }
    for (uint32_t k = 0; k < 2 * n; ++k) {
        memcpy(t->points + 3 * (2 * n + k), t->points + 3 * k, 3 * sizeof *t->points);
        t->points[3 * (2 * n + k) + 1] *= 0.6;
    }
}

static void make_beside(int kind, se3di_shape *s)
{
    const se3d_allocator standard = se3di_alloc_default();
    const prism *p = &beside_part[kind == SLOW_FLANK ? 2 : kind > 0];
    const double half = kind == TIP ? 0.2 : 1.5;
    prism_mesh t = kind == BRIDGE || kind == SLOW_RIDGE
                       ? bridge
                       : prism_make(p, 1.0, half, (const double[2]){0.0, 0.0}, 0);
    if (kind == SLOW_RIDGE) {
        t.points[3 * 5 + 2] = t.points[3 * 12 + 2] = t.points[3 * 13 + 2] = -0.02;
    }
    if (kind == SLOW_FLANK) {
        cut_in_strips(p, &t);
    }
    if (kind == TIP) {
        t.points[3 * 4 + 2] = -0.3; /* the other end of the ridge */
    }
    *s = (se3di_shape){.kind = SE3DI_SHAPE_MESH};
    CHECK(!se3di_mesh_build(&standard, t.points, t.point_count, t.faces, t.face_count, s));
    CHECK(s->closed);
    s->bound = se3di_shape_bound(s);
    piece_count = s->piece_count;
}

/* A cap that leans by 0.009 is 0.0009 deep at the end of the part, and deeper in what is beyond. */
static void caps_touch_all_that_is_as_high_as_they_are(void)
{
    static const double depth[BESIDES] = {0.0079, 0.0099, 0.0099, 0.0108, 0.0053, 0.0053};
    const se3di_shape_pose of = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    const double lean = 0.009, p[4] = {cos(0.5 * lean), 0.0, sin(0.5 * lean), 0.0};
    se3di_shape cap = {.kind = SE3DI_SHAPE_CYLINDER, .radius = 0.8, .half_length = 0.4};
    cap.bound = se3di_shape_bound(&cap);
    for (int k = 0; k < 2 * BESIDES; ++k) {
        se3di_shape mesh;
        se3di_shape_pose at = {.x = {0.3, 0.0, -0.4 * lean}};
        se3di_manifold m;
        double deepest = 0.0;
        make_beside(k / 2, &mesh);
        mesh.piece_count = k % 2 ? piece_count : 0;
        se3di_quat_to_matrix(p, at.R);
        for (int r = 0; r < 3; ++r) {
            at.x[r] += cap.half_length * at.R[3 * r + 2];
        }
        se3di_narrow_find(&cap, &at, &mesh, &of, &m);
        for (uint32_t n = 0; n < m.count; ++n) {
            deepest = fmax(deepest, m.points[n].overlap);
        }
        if (k != 2 * SLOW_RIDGE) { /* that takes pieces */
            CHECK_NEAR(deepest, depth[k / 2], 0.02 * depth[k / 2]);
        }
        release(&mesh);
    }
}

/* A mesh with a part and a ridge, or tip, that is as high, lies upside down on a plate by
 * both. */
static void ridges_in_the_plane_of_a_part_touch_plates_too(void)
{
    static const prism grooved = {
        "grooved plate",
        7,
        {{-2, -1}, {2, -1}, {2, 0}, {1.8, 0}, {1.5, -.5}, {1.4, 0}, {-2, 0}},
        0,
        {{0}}};
    const se3d_allocator standard = se3di_alloc_default();
    const prism_mesh t = prism_make(&grooved, 1.0, 2.0, (const double[2]){0.0, 0.0}, 0);
    const se3di_shape_pose of = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    const se3di_shape_pose at = {.R = {-1, 0, 0, 0, 1, 0, 0, 0, -1}, .x = {0.0, 0.0, -1e-4}};
    se3di_shape plate = {.kind = SE3DI_SHAPE_MESH};
    CHECK(!se3di_mesh_build(&standard, t.points, t.point_count, t.faces, t.face_count, &plate));
    plate.bound = se3di_shape_bound(&plate);
    for (int kind = LEVEL_RIDGE; kind <= BRIDGE; ++kind) {
        const double at_x = kind == BRIDGE ? -2.0 : -1.0; /* where it ends, or the plate */
        se3di_shape mesh;
        se3di_manifold m;
        int at_ridge = 0, at_part = 0;
        make_beside(kind, &mesh);
        se3di_narrow_find(&mesh, &at, &plate, &of, &m);
        for (uint32_t n = 0; n < m.count; ++n) {
            at_ridge += fabs(m.points[n].point[0] - at_x) < 1e-3;
            at_part += m.points[n].point[0] > -1e-3;
            CHECK(m.points[n].overlap < 1e-4 * (1.0 + 1e-6));
        }
        CHECK(at_ridge >= 1 && at_part >= 3);
        release(&mesh);
    }
    se3di_shape_release(&standard, &plate);
}

/* A step may carry it in. The bars of the frame are 0.01 m wide. */
static void a_solid_within_the_body_is_pushed_out_by_the_way_its_pieces_tell(void)
{
    const se3di_shape_pose of = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    const double half = 0.002;
    se3di_shape frame,
        solids[2] = {{.kind = SE3DI_SHAPE_CYLINDER, .radius = half, .half_length = half},
                     {.kind = SE3DI_SHAPE_BOX, .half = {half, half, half}, .half_length = half}};
    make_frame(1, &frame);
    for (int k = 0; k < 2 * 5; ++k) {
        const double z = 0.0125 + 0.001 * (k / 2), way = fmin(z - 0.01, 0.02 - z) + half;
        double deepest = 0.0;
        se3di_shape *solid = &solids[k % 2];
        se3di_shape_pose at = of;
        se3di_manifold m;
        solid->bound = se3di_shape_bound(solid);
        at.x[2] = z;
        se3di_narrow_find(solid, &at, &frame, &of, &m);
        for (uint32_t n = 0; n < m.count; ++n) {
            deepest = fmax(deepest, m.points[n].overlap);
        }
        CHECK_NEAR(deepest, way, 1e-6 * way);
    }
    release(&frame);
}

/* On top of the other, moved along it and turned about the way up. */
static void lay(double x, double z, double angle, double depth, se3di_shape_pose *at)
{
    const double p[4] = {cos(0.5 * angle), 0.0, sin(0.5 * angle), 0.0};
    memset(at, 0, sizeof *at);
    se3di_quat_to_matrix(p, at->R);
    at->x[0] = x;
    at->x[1] = 2.0 * HALF - depth;
    at->x[2] = z;
}

typedef struct lying {
    double x, z, angle;
    uint32_t count;
} lying;

/* Equal frames on each other have eight corners; one that is moved along or turned has its corners
 * that are over the other, those of the other below it, and crossings of their sides. */
static void frames_on_each_other_touch_in_corners_and_crossings(void)
{
    static const lying rows[] = {{0.0, 0.0, 0.0, 8},      {1e-8, -1e-8, 0.0, 8},
                                 {0.005, 0.003, 0.0, 12}, {0.01, 0.0, 0.0, 12},
                                 {0.0, 0.0, 0.3, 16},     {0.028, 0.028, 0.0, 8}};
    const se3di_shape_pose of = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    se3di_shape frame;
    for (size_t k = 0; k < 2 * 2 * sizeof rows / sizeof *rows; ++k) {
        const lying *row = &rows[k / 4];
        const double depth = k / 2 % 2 ? 1e-4 : 1e-9;
        se3di_shape_pose at;
        se3di_manifold m, again;
        make_frame(k % 2, &frame);
        lay(row->x, row->z, row->angle, depth, &at);
        se3di_narrow_find(&frame, &at, &frame, &of, &m);
        CHECK(m.count == row->count);
        check_upright(&m, depth, 0.0);
        for (uint32_t n = 0; n < m.count; ++n) {
            CHECK_NEAR(m.points[n].point[1], HALF - 0.5 * depth, 1e-15);
        }
        at.x[0] += 1e-10;
        se3di_narrow_find(&frame, &at, &frame, &of, &again);
        CHECK(have_the_same(&m, &again));
        at.x[1] += 1.1 * depth;
        se3di_narrow_find(&frame, &at, &frame, &of, &m);
        CHECK(m.count == 0);
        release(&frame);
    }
}

/* A triangle in quarters, so many times, each with corners of its own. */
static void add_quarters(const double a[3], const double b[3], const double c[3], int times,
                         double **to)
{
    double ab[3], bc[3], ca[3];
    if (times == 0) {
        se3di_copy(a, *to);
        se3di_copy(b, *to + 3);
        se3di_copy(c, *to + 6);
        *to += 9;
        return;
    }
    for (int k = 0; k < 3; ++k) {
        ab[k] = 0.5 * (a[k] + b[k]);
        bc[k] = 0.5 * (b[k] + c[k]);
        ca[k] = 0.5 * (c[k] + a[k]);
    }
    add_quarters(a, ab, ca, times - 1, to);
    add_quarters(ab, b, bc, times - 1, to);
    add_quarters(ca, bc, c, times - 1, to);
    add_quarters(ab, bc, ca, times - 1, to);
}

/* As a file of STL has it: oblique and of single precision, each triangle in 256. */
static void make_fine(const prism_mesh *t, const double R[9], se3di_shape *s)
{
    const se3d_allocator standard = se3di_alloc_default();
    const size_t count = 3 * t->face_count * 256;
    double *points = malloc(3 * count * sizeof *points), *end = points;
    uint32_t *faces = malloc(count * sizeof *faces);
    CHECK(points && faces);
    for (size_t k = 0; k < t->face_count; ++k) {
        const uint32_t *f = t->faces + 3 * k;
        add_quarters(t->points + 3 * f[0], t->points + 3 * f[1], t->points + 3 * f[2], 4, &end);
    }
    for (size_t k = 0; k < count; ++k) {
        double x[3];
        se3di_mul(R, points + 3 * k, x);
        for (size_t r = 0; r < 3; ++r) {
            points[3 * k + r] = (double)(float)x[r];
        }
        faces[k] = (uint32_t)k;
    }
    *s = (se3di_shape){.kind = SE3DI_SHAPE_MESH};
    CHECK(!se3di_mesh_build(&standard, points, count, faces, count / 3, s));
    CHECK(s->closed);
    s->bound = se3di_shape_bound(s);
    piece_count = s->piece_count;
    free(points);
    free(faces);
}

static int is_on_plate(double x, double z)
{
    const double slack = 1e-5;
    int found = 0;
    for (size_t k = 0; k < prisms[L].pieces; ++k) {
        const double *b = prisms[L].boxes[k];
        found = found || (x > 0.02 * b[0] - slack && z > 0.02 * b[1] - slack &&
                          x < 0.02 * b[2] + slack && z < 0.02 * b[3] + slack);
    }
    return found;
}

/* All points are over both plates, and reach to the ends of what is. */
static void check_extent(const se3di_manifold *m, const double R[9], const double move[3])
{
    double low[3] = {1.0, 1.0, 1.0}, high[3] = {0.0, 0.0, 0.0};
    for (uint32_t n = 0; n < m->count; ++n) {
        double x[3];
        se3di_mul_transposed(R, m->points[n].point, x);
        CHECK(is_on_plate(x[0], x[2]) && is_on_plate(x[0] - move[0], x[2] - move[2]));
        for (int c = 0; c < 3; ++c) {
            low[c] = fmin(low[c], x[c]);
            high[c] = fmax(high[c], x[c]);
        }
    }
    for (int c = 0; c < 3; c += 2) {
        CHECK_NEAR(low[c], move[c], 1e-5);
        CHECK_NEAR(high[c], 0.02 * (c ? 3.0 : 2.0), 1e-5);
    }
}

/* Outlines are closed although triangles take their neighbours for in one plane or not each by its
 * own measure: what is over only one of the plates is no place of contact. */
static void rounded_plates_touch_only_where_both_are(void)
{
    const se3di_shape_pose of = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    const double move[3] = {0.004, 2.0 * HALF - 1e-6, 0.003};
    const prism_mesh t = prism_make(&prisms[L], 0.02, HALF, (const double[2]){0.0, 0.0}, 0);
    uint64_t seed = 3;
    int told = 0;
    for (int k = 0; k < 8; ++k) {
        se3di_shape plate;
        se3di_shape_pose turn, at = of;
        poses_turn(&seed, &turn);
        make_fine(&t, turn.R, &plate);
        se3di_mul(turn.R, move, at.x);
        const se3di_solid below = {&plate, &of}, above = {&plate, &at};
        se3di_manifold m = {.count = 0};
        if (se3di_narrow_outlines(&below, &above, &m)) { /* its planes are good enough */
            check_extent(&m, turn.R, move);
            ++told;
        }
        release(&plate);
    }
    CHECK(told >= 4);
}

/* Outlines are looked for in meshes of so many vertices: of larger ones nothing is worked out that
 * would take the product of triangles and vertices. */
static void what_is_outermost_is_asked_of_meshes_that_have_outlines(void)
{
    const se3d_allocator standard = se3di_alloc_default();
    const prism_mesh t = prism_make(&prisms[FRAME], SCALE, HALF, (const double[2]){0.02, 0.02}, 0);
    double *points = calloc(3 * (SE3DI_MESH_OUTLINE_MOST + 1), sizeof *points);
    CHECK(points);
    memcpy(points, t.points, 3 * t.point_count * sizeof *points);
    for (size_t more = 0; more < 2; ++more) {
        se3di_shape s = {.kind = SE3DI_SHAPE_MESH};
        uint32_t outermost = 0;
        CHECK(!se3di_mesh_build(&standard, points, SE3DI_MESH_OUTLINE_MOST + more, t.faces,
                                t.face_count, &s));
        for (uint32_t k = 0; k < s.triangle_count; ++k) {
            outermost += se3di_mesh_is_outermost(&s, k) != 0;
        }
        CHECK(outermost == (more ? s.triangle_count : s.triangle_count - 8)); /* not its hole */
        se3di_shape_release(&standard, &s);
    }
    free(points);
}

int main(void)
{
    RUN(solids_over_a_hole_touch_in_their_corners_and_those_of_the_hole);
    RUN(a_cap_at_a_border_comes_off_to_the_side);
    RUN(caps_touch_all_that_is_as_high_as_they_are);
    RUN(ridges_in_the_plane_of_a_part_touch_plates_too);
    RUN(a_solid_within_the_body_is_pushed_out_by_the_way_its_pieces_tell);
    RUN(frames_on_each_other_touch_in_corners_and_crossings);
    RUN(rounded_plates_touch_only_where_both_are);
    RUN(what_is_outermost_is_asked_of_meshes_that_have_outlines);
    return check_finish();
}
