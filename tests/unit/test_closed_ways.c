/* SPDX-License-Identifier: BSD-3-Clause */
/* Springs on the overlaps of a solid that moves and turns over a surface of triangles do no work on
 * a way that ends where it began: what they hold is a matter of the pose alone. */
#include "base/error.h"
#include "check.h"
#include "contact/narrow/narrow.h"
#include "contact/shape/mesh.h"
#include "contact/shape/shape.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "support/poses.h"

#include <math.h>
#include <string.h>

#define PI      3.14159265358979323846
#define ROWS    41
#define SPACING 0.1
#define STEPS   2000
#define DEEP    0.002

/* How a solid moves: out of a pose and back, by half-turns of a sine and a cosine. */
typedef struct closed_way {
    double x[3], e[4];
    double by[6][2]; /* along the axes, and about the solid's */
} closed_way;

typedef struct pressed {
    double force[3], moment[3], held;
    uint32_t count;
} pressed;

static void place(const closed_way *way, double part, se3di_shape_pose *at)
{
    const double s = sin(2.0 * PI * part), c = 0.5 * cos(2.0 * PI * part) - 0.5;
    double turn[3], e[4];
    *at = (se3di_shape_pose){.moves = 0};
    for (int a = 0; a < 3; ++a) {
        at->x[a] = way->x[a] + way->by[a][0] * s + way->by[a][1] * c;
        turn[a] = way->by[3 + a][0] * s + way->by[3 + a][1] * c;
    }
    se3di_quat_rotate(way->e, turn, e);
    se3di_quat_to_matrix(e, at->R);
    se3di_copy(at->x, at->c);
}

static pressed press(const se3di_shape *ground, const se3di_shape *solid,
                     const se3di_shape_pose *at)
{
    const se3di_shape_pose level = {.R = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    se3di_manifold manifold = {0};
    pressed all = {.held = 0.0};
    se3di_narrow_find(ground, &level, solid, at, &manifold);
    all.count = manifold.count;
    for (uint32_t k = 0; k < manifold.count; ++k) {
        const se3di_contact_point *p = &manifold.points[k];
        double arm[3], moment[3];
        se3di_add_scaled(p->overlap, p->normal, all.force);
        se3di_sub(p->point, at->x, arm);
        se3di_cross(arm, p->normal, moment);
        se3di_add_scaled(p->overlap, moment, all.moment);
        all.held = fmax(all.held, 0.5 * p->overlap * p->overlap);
    }
    return all;
}

/* The turn from one pose to the next, which is small. */
static void turn_between(const double from[9], const double to[9], double turn[3])
{
    double back[9], by[9];
    for (int k = 0; k < 9; ++k) {
        back[k] = from[k % 3 * 3 + k / 3];
    }
    se3di_mat_mul(to, back, by);
    turn[0] = 0.5 * (by[7] - by[5]);
    turn[1] = 0.5 * (by[2] - by[6]);
    turn[2] = 0.5 * (by[3] - by[1]);
}

/* The work on a way over the most that a spring held on it. */
static double lost(const se3di_shape *ground, const se3di_shape *solid, const closed_way *way)
{
    se3di_shape_pose before, here;
    place(way, 0.0, &before);
    pressed last = press(ground, solid, &before);
    double work = 0.0, held = last.held;
    for (int n = 1; n <= STEPS; ++n) {
        double by[3], turn[3];
        place(way, n / (double)STEPS, &here);
        const pressed now = press(ground, solid, &here);
        se3di_sub(here.x, before.x, by);
        turn_between(before.R, here.R, turn);
        work += 0.5 * (se3di_dot(now.force, by) + se3di_dot(last.force, by));
        work += 0.5 * (se3di_dot(now.moment, turn) + se3di_dot(last.moment, turn));
        held = fmax(held, now.held);
        last = now;
        before = here;
    }
    return held > 0.0 ? fabs(work) / held : 0.0;
}

/* Hills of 5 cm over 1 m, in cells of 10 cm. */
static void build_hills(se3di_shape *ground)
{
    static double heights[ROWS * ROWS];
    const se3d_allocator allocator = se3di_alloc_default();
    se3d_shape_def def = se3d_shape_def_default();
    se3di_error error = {0};
    for (int k = 0; k < ROWS * ROWS; ++k) {
        const double x = SPACING * (k % ROWS - ROWS / 2), y = SPACING * (k / ROWS - ROWS / 2);
        heights[k] = 0.05 * sin(3.0 * x) * cos(2.0 * y);
    }
    def.heights = heights;
    def.row_count = def.column_count = ROWS;
    def.spacing[0] = def.spacing[1] = SPACING;
    *ground = (se3di_shape){.kind = SE3DI_SHAPE_HEIGHTFIELD};
    CHECK(se3di_shape_define(&def, &allocator, ground, &error) == SE3D_OK);
}

/* A bowl, all of whose edges are in hollows that turn by more than 3 degrees. */
static void build_bowl(se3di_shape *ground)
{
    enum { CELLS = 24, ROW = CELLS + 1 };
    static double points[3 * ROW * ROW];
    static uint32_t faces[6 * CELLS * CELLS];
    const se3d_allocator allocator = se3di_alloc_default();
    for (uint32_t k = 0; k < ROW * ROW; ++k) {
        double *p = points + 3 * (size_t)k;
        p[0] = -2.0 + 4.0 / CELLS * (k % ROW);
        p[1] = -2.0 + 4.0 / CELLS * (k / ROW);
        p[2] = 0.2 * (p[0] * p[0] + p[1] * p[1]);
    }
    for (uint32_t k = 0; k < CELLS * CELLS; ++k) {
        const uint32_t a = k / CELLS * ROW + k % CELLS;
        const uint32_t two[6] = {a, a + 1, a + ROW + 1, a, a + ROW + 1, a + ROW};
        memcpy(faces + 6 * (size_t)k, two, sizeof two);
    }
    *ground = (se3di_shape){.kind = SE3DI_SHAPE_MESH};
    CHECK(se3di_mesh_build(&allocator, points, ROW * ROW, faces, 2 * CELLS * CELLS, ground) ==
          SE3D_OK);
    ground->bound = se3di_shape_bound(ground);
}

/* Upright or at random, as deep as DEEP at its first place. */
static void random_way(const se3di_shape *ground, const se3di_shape *solid, uint64_t *seed,
                       closed_way *way)
{
    double low = -0.5, high = 0.6;
    for (int k = 0; k < 4; ++k) {
        way->e[k] = check_random(seed) + (k == 0 ? 1.0 : 0.0);
    }
    se3di_quat_normalize(way->e, way->e);
    for (int a = 0; a < 6; ++a) {
        const double most = a < 2 ? 0.03 : a < 3 ? DEEP : 0.05;
        way->by[a][0] = most * check_random(seed);
        way->by[a][1] = most * check_random(seed);
    }
    way->x[0] = 0.3 * check_random(seed);
    way->x[1] = 0.3 * check_random(seed);
    for (int k = 0; k < 40; ++k) {
        se3di_shape_pose at;
        way->x[2] = 0.5 * (low + high);
        place(way, 0.0, &at);
        if (press(ground, solid, &at).count > 0) {
            low = way->x[2];
        } else {
            high = way->x[2];
        }
    }
    way->x[2] = low - 0.5 * DEEP * (1.0 + check_random(seed));
}

/* Of solids of a kind all but a few lose no more than that. */
static void holds(void (*build)(se3di_shape *), int kind, int count, double most, int few)
{
    const se3d_allocator allocator = se3di_alloc_default();
    uint64_t seed = 41;
    se3di_shape ground;
    int more = 0;
    build(&ground);
    for (int k = 0; k < count; ++k) {
        poses_solid solid;
        closed_way way;
        poses_random_solid(kind, &seed, &solid);
        random_way(&ground, &solid.shape, &seed, &way);
        more += lost(&ground, &solid.shape, &way) > most;
    }
    CHECK(more <= few);
    se3di_shape_release(&allocator, &ground);
}

static void corners_hold_what_they_take(void)
{
    const int count = poses_count(8);
    holds(build_bowl, SE3DI_SHAPE_BOX, count, 0.01, 0);
    holds(build_bowl, SE3DI_SHAPE_HULL, count, 0.01, 0);
}

/* Of edges that lie across hills, with no corner down, triangles tell; these come and go. */
static void hills_hold_what_they_take(void)
{
    const int count = poses_count(8), few = (count + 11) / 12;
    holds(build_hills, SE3DI_SHAPE_BOX, count, 0.01, few);
    holds(build_hills, SE3DI_SHAPE_HULL, count, 0.01, few);
    holds(build_hills, SE3DI_SHAPE_CYLINDER, count, 0.02, few);
    holds(build_hills, SE3DI_SHAPE_ELLIPSOID, count, 0.02, few);
    holds(build_hills, SE3DI_SHAPE_SPHERE, count, 1e-3, 0);
    holds(build_hills, SE3DI_SHAPE_CAPSULE, count, 0.01, few);
}

int main(void)
{
    RUN(corners_hold_what_they_take);
    RUN(hills_hold_what_they_take);
    return check_finish();
}
