/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids on a floor of triangles in one plane, open or the top of a slab: what touches is what
 * touches the plane, whatever the frames are. At its border nothing touches beyond it, and a wall
 * that stands on it touches, too. */
#include "contact/narrow/narrow.h"
#include "contact/shape/mesh.h"
#include "support/poses.h"

#define SIDE   9   /* corners along each side */
#define HALF   2.0 /* m */
#define POINTS (SIDE * SIDE)
#define CELLS  ((SIDE - 1) * (SIDE - 1))
#define FACES  (4 * CELLS + 8 * (SIDE - 1))

enum { OPEN, WALLED, SLAB, FLOORS };
enum { SOLIDS = 5 };
static const int kinds[SOLIDS] = {SE3DI_SHAPE_BOX, SE3DI_SHAPE_HULL, SE3DI_SHAPE_CYLINDER,
                                  SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_ELLIPSOID};

typedef struct builder {
    double points[3 * 2 * POINTS];
    uint32_t faces[3 * FACES], point_count, face_count;
} builder;

static void add_faces(builder *b, uint32_t first, uint32_t second, uint32_t third, uint32_t fourth)
{
    const uint32_t two[6] = {first, second, third, first, third, fourth};
    memcpy(b->faces + 3 * b->face_count, two, sizeof two);
    b->face_count += 2;
}

/* Corners at z, inner ones anywhere; triangles that are counter-clockwise from above, or below. */
static void add_sheet(builder *b, double z, int is_top)
{
    const uint32_t from = b->point_count;
    uint64_t seed = 7;
    for (uint32_t k = 0; k < POINTS; ++k) {
        const uint32_t at[2] = {k % SIDE, k / SIDE};
        const int is_inner = at[0] % (SIDE - 1) > 0 && at[1] % (SIDE - 1) > 0;
        double *x = b->points + 3 * (size_t)b->point_count++;
        for (int c = 0; c < 2; ++c) {
            x[c] = HALF * (2.0 * at[c] / (SIDE - 1.0) - 1.0);
            x[c] += is_inner ? 0.1 * check_random(&seed) : 0.0;
        }
        x[2] = z;
        if (at[0] + 1 < SIDE && at[1] + 1 < SIDE) {
            const uint32_t a = from + k, c = a + SIDE;
            add_faces(b, a, is_top ? a + 1 : c, c + 1, is_top ? c : a + 1);
        }
    }
}

/* Corner k of those around a sheet, counter-clockwise from above. */
static uint32_t around(uint32_t k)
{
    const uint32_t last = SIDE - 1, part = k % last;
    return k / last == 0   ? part
           : k / last == 1 ? last + part * SIDE
           : k / last == 2 ? last * SIDE + last - part
                           : (last - part) * SIDE;
}

static void build(int kind, se3di_shape *s)
{
    static builder b;
    const se3d_allocator standard = se3di_alloc_default();
    b.point_count = b.face_count = 0;
    add_sheet(&b, 0.0, 1);
    if (kind == SLAB) { /* with a dent in its back: no hull */
        add_sheet(&b, -1.0, 0);
        b.points[3 * (POINTS + POINTS / 2) + 2] = -0.8;
        for (uint32_t k = 0; k < 4 * (SIDE - 1); ++k) {
            const uint32_t a = around(k), c = around((k + 1) % (4 * (SIDE - 1)));
            add_faces(&b, a, a + POINTS, c + POINTS, c);
        }
    } else if (kind == WALLED) { /* at x = HALF, looking at the floor */
        for (uint32_t k = 0; k < SIDE; ++k) {
            double *x = b.points + 3 * (size_t)b.point_count++;
            memcpy(x, b.points + 3 * (size_t)(k * SIDE + SIDE - 1), 3 * sizeof *x);
            x[2] = 1.0;
        }
        for (uint32_t k = 0; k + 1 < SIDE; ++k) {
            const uint32_t a = k * SIDE + SIDE - 1, top = POINTS + k;
            add_faces(&b, a, a + SIDE, top + 1, top);
        }
    }
    *s = (se3di_shape){.kind = SE3DI_SHAPE_MESH};
    CHECK(!se3di_mesh_build(&standard, b.points, b.point_count, b.faces, b.face_count, s));
    s->bound = se3di_shape_bound(s);
    CHECK(s->closed == (kind == SLAB));
}

static void release(se3di_shape *s)
{
    const se3d_allocator standard = se3di_alloc_default();
    se3di_shape_release(&standard, s);
}

/* The solid lies about flat, or any way, on the floor around a place, by a few digits of depth. */
static void lay(const se3di_shape *solid, const se3di_shape_pose *floor, const double place[2],
                uint64_t *seed, se3di_shape_pose *at)
{
    double down[3], lowest[3];
    const double depth = poses_size(solid) * pow(10.0, poses_between(seed, -7.0, -1.3));
    const se3di_solid it = {solid, at};
    poses_turn(seed, at);
    if (check_random(seed) > 0.0) {
        poses_lean(seed, floor, at);
    }
    memset(at->x, 0, sizeof at->x);
    for (int k = 0; k < 3; ++k) {
        down[k] = -floor->R[3 * k + 2];
    }
    se3di_core_support(&it, down, lowest);
    const double z = se3di_dot(lowest, down) + se3di_core_radius(solid) - depth;
    for (int k = 0; k < 3; ++k) {
        at->x[k] =
            floor->x[k] - z * down[k] + floor->R[3 * k] * place[0] + floor->R[3 * k + 1] * place[1];
    }
}

static int find_nearest(const se3di_manifold *m, const double x[3], double *distance)
{
    int nearest = 0;
    *distance = HUGE_VAL;
    for (uint32_t k = 0; k < m->count; ++k) {
        double d[3];
        se3di_sub(m->points[k].point, x, d);
        if (se3di_norm(d) < *distance) {
            *distance = se3di_norm(d);
            nearest = (int)k;
        }
    }
    return nearest;
}

/* The places, normals, overlaps and bends are those of the plane. */
static void compare(const se3di_manifold *own, const se3di_manifold *plane)
{
    CHECK(own->count == plane->count);
    for (uint32_t k = 0; k < plane->count && own->count > 0; ++k) {
        const se3di_contact_point *p = &plane->points[k];
        double distance, turn[3];
        const se3di_contact_point *q = &own->points[find_nearest(own, p->point, &distance)];
        se3di_sub(p->normal, q->normal, turn);
        CHECK(distance < 1e-7 && se3di_norm(turn) < 1e-12);
        CHECK_NEAR(q->overlap, p->overlap, 1e-12);
        CHECK_NEAR(q->bend_i.r[0], p->bend_i.r[0], 1e-9 * fabs(p->bend_i.r[0]));
        CHECK(fabs(q->share - p->share) <= 0.0);
    }
}

static void solids_touch_floors_as_planes(void)
{
    static const se3di_shape half_space = {.kind = SE3DI_SHAPE_PLANE};
    for (int kind = 0; kind < FLOORS * SOLIDS; ++kind) {
        se3di_shape floor;
        uint64_t seed = 3;
        int touching = 0;
        build(kind / SOLIDS, &floor);
        const int count = poses_count(400);
        for (int k = 0; k < count; ++k) {
            poses_solid solid;
            se3di_shape_pose of, at;
            se3di_manifold own, plane;
            double place[2];
            poses_random_solid(kinds[kind % SOLIDS], &seed, &solid);
            poses_turn(&seed, &of);
            const double inner = HALF - 1.01 * se3di_shape_bound(&solid.shape);
            for (int c = 0; c < 3; ++c) {
                of.x[c] = check_random(&seed);
                place[c % 2] = 0.5 * inner * check_random(&seed);
            }
            lay(&solid.shape, &of, place, &seed, &at);
            se3di_narrow_find(&solid.shape, &at, &floor, &of, &own);
            se3di_narrow_find(&solid.shape, &at, &half_space, &of, &plane);
            compare(&own, &plane);
            touching += own.count > 0;
        }
        CHECK(touching == count);
        release(&floor);
    }
}

/* Move a solid along the floor's x until it is beyond a place of that axis by a length. */
static void push(const se3di_shape *solid, const se3di_shape_pose *floor, double x, double beyond,
                 se3di_shape_pose *at)
{
    const se3di_solid it = {solid, at};
    double axis[3], far[3];
    for (int k = 0; k < 3; ++k) {
        axis[k] = floor->R[3 * k];
    }
    se3di_core_support(&it, axis, far);
    se3di_sub(far, floor->x, far);
    const double move = x + beyond - se3di_dot(far, axis) - se3di_core_radius(solid);
    se3di_add_scaled(move, axis, at->x);
}

/* How many push back along x; no point is beyond the border by more than what is in the wall. */
static int count_walls(const se3di_manifold *m, const se3di_shape_pose *floor, double deep)
{
    int walls = 0;
    for (uint32_t k = 0; k < m->count; ++k) {
        double d[3], local[3], normal[3];
        se3di_sub(m->points[k].point, floor->x, d);
        se3di_mul_transposed(floor->R, d, local);
        se3di_mul_transposed(floor->R, m->points[k].normal, normal);
        CHECK(local[0] < HALF + deep + 1e-6);
        walls += normal[0] > 0.99;
    }
    return walls;
}

/* Beyond the border by a part, where the floor carries most still; or pressed to a wall, beyond
 * which the tip of a hull may be below the floor only. */
static void borders_and_walls_are_where_they_are(void)
{
    for (int kind = 0; kind < 2 * SOLIDS; ++kind) {
        const int is_walled = kind / SOLIDS;
        se3di_shape floor;
        uint64_t seed = 5;
        int touching = 0;
        const int count = poses_count(200);
        build(is_walled ? WALLED : OPEN, &floor);
        for (int k = 0; k < count; ++k) {
            poses_solid solid;
            se3di_shape_pose of, at;
            se3di_manifold m;
            const double place[2] = {0.0, check_random(&seed)};
            poses_random_solid(kinds[kind % SOLIDS], &seed, &solid);
            poses_turn(&seed, &of);
            memset(of.x, 0, sizeof of.x);
            lay(&solid.shape, &of, place, &seed, &at);
            const double size = poses_size(&solid.shape);
            const double deep = is_walled ? 1e-3 * size : 0.0;
            push(&solid.shape, &of, HALF, is_walled ? deep : 0.3 * size, &at);
            se3di_narrow_find(&solid.shape, &at, &floor, &of, &m);
            const int walls = count_walls(&m, &of, deep);
            touching += m.count > 0;
            CHECK(walls > 0 || !is_walled || solid.shape.kind == SE3DI_SHAPE_HULL);
        }
        CHECK(touching > 0.75 * count);
        release(&floor);
    }
}

int main(void)
{
    RUN(solids_touch_floors_as_planes);
    RUN(borders_and_walls_are_where_they_are);
    return check_finish();
}
