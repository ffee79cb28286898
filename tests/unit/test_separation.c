/* SPDX-License-Identifier: BSD-3-Clause */
/* If shapes touch, against tests that are exact: no contact of what is apart, a contact of all
 * that overlaps. Two convex polyhedra overlap where none of their normals and products of edges
 * separates them; a solid and a triangle, where the least value on the triangle of the solid's
 * distance function, which is convex, is negative.
 *
 * POSES for each pair of solids, and of solid and mesh; -DPOSES=20000 tries more. */
#include "base/alloc.h"
#include "check.h"
#include "contact/mesh.h"
#include "contact/narrow_internal.h"
#include "math/quaternion.h"
#include "math/vec3.h"

#ifndef POSES
#define POSES 400
#endif
#define CLEAR 1e-7 /* m: less is neither apart nor overlapping */
#define MOST  64

/* A convex polyhedron: points, directions of its faces and edges, ground frame. */
typedef struct poly {
    int points, faces, edges;
    double point[MOST][3], face[MOST][3], edge[MOST][3];
} poly;

static const double tetra[12] = {0.25,  0.05,  -0.15, -0.2,  0.25, -0.1,
                                 -0.15, -0.25, -0.15, 0.025, 0.05, 0.3};
static const uint32_t tetra_faces[12] = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};

enum { SOLIDS = 5, MESHES = 6 };
static const int kinds[SOLIDS] = {SE3DI_SHAPE_BOX, SE3DI_SHAPE_HULL, SE3DI_SHAPE_CYLINDER,
                                  SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_SPHERE};

static se3di_shape solid_of(int kind)
{
    se3di_shape s = {.kind = kind, .radius = 0.15, .half_length = 0.2, .half = {0.25, 0.2, 0.15}};
    if (kind == SE3DI_SHAPE_HULL) {
        s.vertices = (double *)(uintptr_t)tetra;
        s.triangles = (uint32_t *)(uintptr_t)tetra_faces;
        s.vertex_count = s.triangle_count = 4;
    }
    s.bound = se3di_shape_bound(&s);
    return s;
}

static void random_turn(uint64_t *seed, se3di_shape_pose *pose)
{
    double q[4], p[4];
    memset(pose, 0, sizeof *pose);
    for (int k = 0; k < 4; ++k) {
        q[k] = check_random(seed);
    }
    se3di_quat_normalize(q, p);
    se3di_quat_to_matrix(p, pose->R);
}

static void place(const se3di_shape_pose *at, const double local[3], double out[3])
{
    se3di_mul(at->R, local, out);
    se3di_add(at->x, out, out);
}

static void direct(const se3di_shape_pose *at, const double a[3], const double b[3], double out[3])
{
    double d[3];
    se3di_sub(b, a, d);
    se3di_mul(at->R, d, out);
}

/* Of a box or hull. */
static void poly_of(const se3di_shape *s, const se3di_shape_pose *at, poly *p)
{
    p->points = p->faces = p->edges = 0;
    if (s->kind == SE3DI_SHAPE_BOX) {
        for (int k = 0; k < 8; ++k) {
            const double local[3] = {k & 1 ? s->half[0] : -s->half[0],
                                     k & 2 ? s->half[1] : -s->half[1],
                                     k & 4 ? s->half[2] : -s->half[2]};
            place(at, local, p->point[p->points++]);
        }
        for (int a = 0; a < 3; ++a) {
            for (int c = 0; c < 3; ++c) {
                p->face[a][c] = p->edge[a][c] = at->R[3 * c + a];
            }
        }
        p->faces = p->edges = 3;
        return;
    }
    for (size_t k = 0; k < s->vertex_count; ++k) {
        place(at, s->vertices + 3 * k, p->point[p->points++]);
    }
    for (size_t k = 0; k < s->triangle_count; ++k) {
        const uint32_t *t = s->triangles + 3 * k;
        double e[3][3];
        for (int c = 0; c < 3; ++c) {
            direct(at, s->vertices + 3 * (size_t)t[c], s->vertices + 3 * (size_t)t[(c + 1) % 3],
                   e[c]);
            if (t[c] < t[(c + 1) % 3]) {
                se3di_copy(e[c], p->edge[p->edges++]);
            }
        }
        se3di_cross(e[0], e[1], p->face[p->faces++]);
    }
}

static void poly_of_triangle(const double *const corner[3], const se3di_shape_pose *at, poly *p)
{
    double n[3];
    p->points = p->edges = 3;
    p->faces = 4;
    for (int k = 0; k < 3; ++k) {
        place(at, corner[k], p->point[k]);
        direct(at, corner[k], corner[(k + 1) % 3], p->edge[k]);
    }
    se3di_cross(p->edge[0], p->edge[1], n);
    se3di_copy(n, p->face[0]);
    for (int k = 0; k < 3; ++k) {
        se3di_cross(p->edge[k], n, p->face[k + 1]);
    }
}

static double reach(const poly *p, const double n[3])
{
    double most = -HUGE_VAL;
    for (int k = 0; k < p->points; ++k) {
        most = fmax(most, se3di_dot(p->point[k], n));
    }
    return most;
}

/* The least overlap along all axes, its direction from a to b, and the next one that is not the
 * same. */
typedef struct depth {
    double least, next, n[3];
} depth;

static void try_axis(const poly *a, const poly *b, const double axis[3], depth *d)
{
    double size = se3di_norm(axis);
    if (!(size > 1e-9)) {
        return;
    }
    for (int side = 0; side < 2; ++side) {
        double n[3], back[3];
        se3di_scale((side ? -1.0 : 1.0) / size, axis, n);
        se3di_scale(-1.0, n, back);
        double here = reach(a, n) + reach(b, back), turn[3];
        se3di_sub(n, d->n, turn);
        const int other = se3di_norm(turn) > 1e-9;
        if (here < d->least) {
            d->next = other ? d->least : d->next;
            d->least = here;
            se3di_copy(n, d->n);
        } else if (here < d->next && other) {
            d->next = here;
        }
    }
}

/* Of what is apart an axis that divides it is enough. */
static depth polys(const poly *a, const poly *b)
{
    depth d = {HUGE_VAL, HUGE_VAL, {0.0, 0.0, 0.0}};
    for (int k = 0; k < b->faces; ++k) {
        try_axis(a, b, b->face[k], &d);
    }
    for (int k = 0; k < a->faces; ++k) {
        try_axis(a, b, a->face[k], &d);
    }
    for (int k = 0; k < a->edges && !(d.least < -CLEAR); ++k) {
        for (int c = 0; c < b->edges; ++c) {
            double axis[3];
            se3di_cross(a->edge[k], b->edge[c], axis);
            try_axis(a, b, axis, &d);
        }
    }
    return d;
}

/* Of a point from a solid that is no hull: convex. */
static double distance_to(const se3di_shape *s, const se3di_shape_pose *at, const double x[3])
{
    double d[3], local[3], point[3], normal[3], distance;
    se3di_sub(x, at->x, d);
    se3di_mul_transposed(at->R, d, local);
    se3di_shape_nearest(s, local, point, normal, &distance);
    return distance;
}

static double on_line(const se3di_shape *s, const se3di_shape_pose *at, const double a[3],
                      const double b[3])
{
    const double golden = 0.61803398874989485;
    double low = 0.0, high = 1.0, f[2], t[2];
    for (int k = 0; k < 2; ++k) {
        double x[3];
        t[k] = k ? golden : 1.0 - golden;
        for (int c = 0; c < 3; ++c) {
            x[c] = a[c] + t[k] * (b[c] - a[c]);
        }
        f[k] = distance_to(s, at, x);
    }
    while (high - low > 1e-10) {
        int left = f[0] < f[1];
        double x[3];
        high = left ? t[1] : high;
        low = left ? low : t[0];
        f[left] = f[!left];
        t[left] = t[!left];
        t[!left] = left ? high - golden * (high - low) : low + golden * (high - low);
        for (int c = 0; c < 3; ++c) {
            x[c] = a[c] + t[!left] * (b[c] - a[c]);
        }
        f[!left] = distance_to(s, at, x);
    }
    return fmin(f[0], f[1]);
}

/* Lines through corner 0, by golden section, until one is seen to be inside. */
static double on_triangle(const se3di_shape *s, const se3di_shape_pose *at,
                          const double corner[3][3])
{
    const double golden = 0.61803398874989485;
    double low = 0.0, high = 1.0, least = HUGE_VAL;
    while (high - low > 1e-9 && !(least < -CLEAR)) {
        double f[2], t[2] = {high - golden * (high - low), low + golden * (high - low)};
        for (int k = 0; k < 2; ++k) {
            double x[3];
            for (int c = 0; c < 3; ++c) {
                x[c] = corner[1][c] + t[k] * (corner[2][c] - corner[1][c]);
            }
            f[k] = on_line(s, at, corner[0], x);
            least = fmin(least, f[k]);
        }
        high = f[0] < f[1] ? t[1] : high;
        low = f[0] < f[1] ? low : t[0];
    }
    return least;
}

/* ---- meshes ---- */

#define GRID 9

typedef struct surface {
    double points[3 * GRID * GRID];
    uint32_t faces[6 * (GRID - 1) * (GRID - 1)];
    size_t point_count, face_count;
    se3di_shape shape;
} surface;

static double height_of(int which, double x, double y)
{
    return which == 0   ? 0.4 * (1.0 - fabs(x))
           : which == 1 ? 0.4 * fabs(x)
           : which == 2 ? 0.3 * sin(5.0 * x) * sin(4.4 * y)
                        : -0.3 * (x * x + y * y);
}

/* A roof, a valley, bumps, a dome: 2 x 2 m, two triangles a cell. */
static void make_field(int which, surface *s)
{
    const uint32_t cells = which < 2 ? 2 : GRID - 1, row = cells + 1;
    s->point_count = (size_t)row * row;
    for (uint32_t k = 0; k < row * row; ++k) {
        double *p = s->points + 3 * k;
        p[0] = -1.0 + 2.0 / cells * (k % row);
        p[1] = -1.0 + 2.0 / cells * (k / row);
        p[2] = height_of(which, p[0], p[1]);
    }
    s->face_count = 0;
    for (uint32_t k = 0; k < cells * cells; ++k) {
        const uint32_t a = k / cells * row + k % cells;
        const uint32_t two[6] = {a, a + 1, a + row, a + 1, a + row + 1, a + row};
        memcpy(s->faces + 3 * s->face_count, two, sizeof two);
        s->face_count += 2;
    }
}

/* A block, or the profile of an L, with the corners of `profile` counter-clockwise in x and z. */
static void make_prism(int count, const double (*profile)[2], surface *s)
{
    const uint32_t n = (uint32_t)count;
    s->point_count = 2 * n;
    s->face_count = 0;
    for (uint32_t k = 0; k < 2 * n; ++k) {
        s->points[3 * k] = profile[k % n][0];
        s->points[3 * k + 1] = k < n ? -0.5 : 0.5;
        s->points[3 * k + 2] = profile[k % n][1];
    }
    for (uint32_t k = 0; k < n; ++k) {
        const uint32_t b = (k + 1) % n;
        const uint32_t side[6] = {k, k + n, b, b, k + n, b + n};
        memcpy(s->faces + 3 * s->face_count, side, sizeof side);
        s->face_count += 2;
    }
    for (uint32_t k = 1; k + 1 < n; ++k) {
        const uint32_t ends[6] = {0, k, k + 1, n, n + k + 1, n + k};
        memcpy(s->faces + 3 * s->face_count, ends, sizeof ends);
        s->face_count += 2;
    }
}

static const double square[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
static const double angle[6][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, -0.1},
                                   {-0.1, -0.1}, {-0.1, 0.5}, {-0.5, 0.5}};

static void make_mesh(int which, surface *s)
{
    if (which < 4) {
        make_field(which, s);
    } else {
        make_prism(which == 4 ? 4 : 6, which == 4 ? square : angle, s);
    }
    const se3d_allocator allocator = se3di_alloc_default();
    memset(&s->shape, 0, sizeof s->shape);
    s->shape.kind = SE3DI_SHAPE_MESH;
    CHECK(!se3di_mesh_build(&allocator, s->points, s->point_count, s->faces, s->face_count,
                            &s->shape));
    s->shape.bound = se3di_shape_bound(&s->shape);
    CHECK((s->shape.closed != 0) == (which > 3));
}

static int is_within(int which, const double x[3])
{
    int block = fabs(x[0]) < 0.5 && fabs(x[1]) < 0.5 && fabs(x[2]) < 0.5;
    return which < 4 ? 0 : which == 4 ? block : block && (x[0] < -0.1 || x[2] < -0.1);
}

typedef struct pose_pair {
    const se3di_shape *solid, *mesh;
    se3di_shape_pose at, of; /* of the solid, of the mesh */
} pose_pair;

/* How deep the solid and one of the triangles overlap at least, negative: apart. */
static double overlap_with(const pose_pair *p, const poly *solid, size_t triangle)
{
    const double *local[3];
    double at[3][3], near[3];
    poly flat;
    for (size_t k = 0; k < 3; ++k) {
        local[k] = p->mesh->vertices + 3 * (size_t)p->mesh->triangles[3 * triangle + k];
        place(&p->of, local[k], at[k]);
    }
    const double *const world[3] = {at[0], at[1], at[2]};
    const double square_of = se3di_triangle_nearest(world, p->at.x, near, NULL);
    if (square_of > p->solid->bound * p->solid->bound) {
        return p->solid->bound - sqrt(square_of);
    }
    if (p->solid->kind == SE3DI_SHAPE_BOX || p->solid->kind == SE3DI_SHAPE_HULL) {
        poly_of_triangle(local, &p->of, &flat);
        return polys(solid, &flat).least;
    }
    return -on_triangle(p->solid, &p->at, (const double(*)[3])at);
}

static double overlap(const pose_pair *p)
{
    double most = -HUGE_VAL;
    poly solid;
    if (p->solid->kind == SE3DI_SHAPE_BOX || p->solid->kind == SE3DI_SHAPE_HULL) {
        poly_of(p->solid, &p->at, &solid);
    }
    for (size_t k = 0; k < p->mesh->triangle_count; ++k) {
        most = fmax(most, overlap_with(p, &solid, k));
    }
    return most;
}

static uint32_t found(const pose_pair *p, se3di_manifold *m)
{
    se3di_narrow_find(p->solid, &p->at, p->mesh, &p->of, m);
    return m->count;
}

/* Moved along `way` to where it begins to overlap, and then by `deeper` on. */
static void approach(pose_pair *p, const double way[3], double deeper)
{
    double start[3], low = 0.0, high = 0.0;
    se3di_copy(p->at.x, start);
    while (high < 4.0) {
        se3di_copy(start, p->at.x);
        se3di_add_scaled(high, way, p->at.x);
        if (overlap(p) > 0.0) {
            break;
        }
        low = high;
        high += 0.1;
    }
    for (int k = 0; k < 14; ++k) {
        const double middle = 0.5 * (low + high);
        se3di_copy(start, p->at.x);
        se3di_add_scaled(middle, way, p->at.x);
        if (overlap(p) > 0.0) {
            high = middle;
        } else {
            low = middle;
        }
    }
    se3di_copy(start, p->at.x);
    se3di_add_scaled(high + deeper, way, p->at.x);
}

typedef struct tally {
    int clear, phantom, overlapping, missed;
    double deepest;
} tally;

static void count_pose(const pose_pair *p, int which, tally *t)
{
    se3di_manifold m;
    double local[3], d[3], truth = overlap(p);
    se3di_sub(p->at.x, p->of.x, d);
    se3di_mul_transposed(p->of.R, d, local);
    if (fabs(truth) < CLEAR || is_within(which, local)) {
        return;
    }
    found(p, &m);
    if (truth < 0.0) {
        ++t->clear;
        t->phantom += m.count > 0;
        for (uint32_t k = 0; k < m.count; ++k) {
            t->deepest = fmax(t->deepest, m.points[k].overlap);
        }
    } else if (truth < 0.03) {
        ++t->overlapping;
        t->missed += m.count == 0;
    }
}

/* At random beside the mesh; and, one in eight, from a random side on the way to it, just apart and
 * just overlapping. */
static void count_poses(const se3di_shape *solid, int which, int poses, tally *t)
{
    static surface s;
    uint64_t seed = 20 + (uint64_t)which;
    pose_pair p = {.solid = solid, .mesh = &s.shape};
    make_mesh(which, &s);
    memset(t, 0, sizeof *t);
    for (int k = 0; k < poses; ++k) {
        double way[3] = {0.0, 0.0, -1.0};
        random_turn(&seed, &p.at);
        random_turn(&seed, &p.of);
        for (int c = 0; c < 3; ++c) {
            p.at.x[c] = (c < 2 ? 0.9 : 0.6) * check_random(&seed);
            way[c] += which > 3 ? 2.0 * check_random(&seed) : 0.3 * check_random(&seed);
        }
        double local[3];
        se3di_copy(p.at.x, local);
        place(&p.of, local, p.at.x);
        count_pose(&p, which, t);
        if (k % 8 == 0) {
            double size = se3di_norm(way), back[3];
            se3di_mul(p.of.R, way, back);
            se3di_scale(1.0 / size, back, way);
            se3di_add_scaled(-1.8, way, p.at.x);
            approach(&p, way, -0.002);
            count_pose(&p, which, t);
            se3di_add_scaled(0.002 + 0.01 * (1.0 + check_random(&seed)), way, p.at.x);
            count_pose(&p, which, t);
        }
    }
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_shape_release(&allocator, &s.shape);
}

static void solids_touch_the_triangles_that_they_overlap_and_no_others(void)
{
    for (int kind = 0; kind < SOLIDS; ++kind) {
        const se3di_shape solid = solid_of(kinds[kind]);
        const int exact = kind < 2;
        for (int which = 0; which < MESHES; ++which) {
            tally t;
            count_poses(&solid, which, exact ? POSES : POSES / 4, &t);
            CHECK(t.phantom == 0);
            CHECK(t.missed == 0);
            CHECK(t.clear > POSES / 40 && t.overlapping > POSES / 40);
        }
    }
}

/* ---- depth and normal of convex pieces ---- */

#define SAME_DEPTH 1e-9
#define TELLS      1.25 /* times the least overlap: the next one, where the least one is meant */

/* The deepest point. */
static const se3di_contact_point *deepest(const se3di_manifold *m)
{
    const se3di_contact_point *best = &m->points[0];
    for (uint32_t k = 1; k < m->count; ++k) {
        best = m->points[k].overlap > best->overlap ? &m->points[k] : best;
    }
    return best;
}

/* From far away towards the other, up to an overlap of 1 to 20 mm along the least one. */
static depth meet(const se3di_shape *one, se3di_shape_pose *at, const poly *other, uint64_t *seed)
{
    poly p;
    double way[3], start[3], low = 0.0, high = 3.0;
    const double wanted = 0.001 + 0.0095 * (1.0 + check_random(seed));
    random_turn(seed, at);
    for (int c = 0; c < 3; ++c) {
        way[c] = check_random(seed);
        at->x[c] = 0.3 * check_random(seed);
    }
    se3di_scale(1.0 / se3di_norm(way), way, way);
    se3di_add_scaled(-3.0, way, at->x);
    se3di_copy(at->x, start);
    for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (low + high);
        se3di_copy(start, at->x);
        se3di_add_scaled(middle, way, at->x);
        poly_of(one, at, &p);
        if (polys(&p, other).least > wanted) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return polys(&p, other);
}

typedef struct accuracy {
    int counted, wrong;
    double depth, normal;
} accuracy;

static void compare(const se3di_manifold *m, const depth *truth, accuracy *a)
{
    double turn[3] = {1.0, 0.0, 0.0};
    double off = 1.0;
    if (!(truth->next > TELLS * truth->least && truth->least > 0.0)) {
        return;
    }
    if (m->count > 0) {
        const se3di_contact_point *p = deepest(m);
        se3di_sub(p->normal, truth->n, turn);
        off = fabs(p->overlap - truth->least);
    }
    ++a->counted;
    a->wrong += !(off < SAME_DEPTH && se3di_norm(turn) < SAME_DEPTH);
    a->depth = fmax(a->depth, off);
    a->normal = fmax(a->normal, se3di_norm(turn));
}

static void overlaps_of_polyhedra_are_the_least_ones(void)
{
    for (int pair = 0; pair < 6; ++pair) {
        uint64_t seed = 5;
        accuracy a = {0, 0, 0.0, 0.0};
        const se3di_shape one = solid_of(kinds[pair % 2]), two = solid_of(kinds[pair / 2 % 2]);
        static surface s;
        make_mesh(4, &s);
        const se3di_shape block = {.kind = SE3DI_SHAPE_BOX, .half = {0.5, 0.5, 0.5}};
        for (int k = 0; k < POSES / 2; ++k) {
            se3di_shape_pose at, of;
            se3di_manifold m;
            poly other;
            random_turn(&seed, &of);
            poly_of(pair < 4 ? &two : &block, &of, &other);
            depth truth = meet(&one, &at, &other, &seed);
            se3di_narrow_find(&one, &at, pair < 4 ? &two : &s.shape, &of, &m);
            compare(&m, &truth, &a);
        }
        CHECK(a.counted > POSES / 10);
        CHECK(a.wrong == 0);
        const se3d_allocator allocator = se3di_alloc_default();
        se3di_shape_release(&allocator, &s.shape);
    }
}

/* ---- certificates ---- */

/* How far two convex shapes overlap along n; negative: a plane perpendicular to it is between
 * them. */
static double overlap_along(const se3di_solid *i, const se3di_solid *j, const double n[3])
{
    double back[3], on_i[3], on_j[3];
    se3di_scale(-1.0, n, back);
    se3di_core_support(i, n, on_i);
    se3di_core_support(j, back, on_j);
    return se3di_dot(on_i, n) - se3di_dot(on_j, n) + se3di_core_radius(i->shape) +
           se3di_core_radius(j->shape);
}

/* A place within both, to its own depth: faces are cut off perpendicular to the one that they
 * touch. */
static int is_in_both(const se3di_solid *i, const se3di_solid *j, const se3di_contact_point *p)
{
    return distance_to(i->shape, i->at, p->point) < p->overlap + 1e-9 &&
           distance_to(j->shape, j->at, p->point) < p->overlap + 1e-9;
}

/* What does not touch is divided by a plane; a point of what does is in both. */
static void solids_are_divided_by_a_plane_or_share_their_points_of_contact(void)
{
    for (int pair = 0; pair < SOLIDS * SOLIDS; ++pair) {
        uint64_t seed = 31;
        const se3di_shape one = solid_of(kinds[pair % SOLIDS]),
                          two = solid_of(kinds[pair / SOLIDS]);
        int apart = 0, touching = 0, undivided = 0, phantom = 0;
        for (int k = 0; k < POSES; ++k) {
            se3di_shape_pose at, of;
            se3di_solid i = {&one, &at}, j = {&two, &of};
            se3di_manifold m;
            double n[3];
            random_turn(&seed, &at);
            random_turn(&seed, &of);
            for (int c = 0; c < 3; ++c) {
                at.x[c] = 0.45 * check_random(&seed);
            }
            se3di_narrow_find(&one, &at, &two, &of, &m);
            const double gap = se3di_narrow_gap(&one, &at, &two, &of, n);
            if (m.count == 0 && gap > CLEAR) {
                ++apart;
                undivided += !(overlap_along(&i, &j, n) < 0.0);
            } else if (m.count == 0) {
                undivided += !(gap > 0.0) && !(overlap_along(&i, &j, n) < CLEAR);
            }
            for (uint32_t c = 0; c < m.count; ++c) {
                phantom += !is_in_both(&i, &j, &m.points[c]);
            }
            touching += m.count > 0;
        }
        CHECK(undivided == 0);
        CHECK(phantom == 0);
        CHECK(apart > POSES / 20 && touching > POSES / 20);
    }
}

/* Spheres and capsules whose line is outside: the radius less the line's least distance, which is
 * convex along it. What lies along a face within a thousandth touches the face. */
static void overlaps_of_round_solids_are_those_of_their_lines(void)
{
    for (int pair = 0; pair < 2 * SOLIDS; ++pair) {
        uint64_t seed = 9;
        const se3di_shape one = solid_of(kinds[3 + pair / SOLIDS]),
                          two = solid_of(kinds[pair % SOLIDS]);
        const double half = one.kind == SE3DI_SHAPE_CAPSULE ? one.half_length : 0.0;
        int counted = 0;
        for (int k = 0; k < POSES; ++k) {
            se3di_shape_pose at, of;
            se3di_manifold m;
            double ends[2][3];
            random_turn(&seed, &at);
            random_turn(&seed, &of);
            for (int c = 0; c < 3; ++c) {
                at.x[c] = 0.5 * check_random(&seed);
                ends[0][c] = at.x[c] - half * at.R[3 * c + 2];
                ends[1][c] = at.x[c] + half * at.R[3 * c + 2];
            }
            const double apart = on_line(&two, &of, ends[0], ends[1]);
            if (apart < 1e-3) {
                continue;
            }
            se3di_narrow_find(&one, &at, &two, &of, &m);
            const double least = m.count > 0 ? deepest(&m)->overlap : 0.0;
            CHECK_NEAR(least, fmax(one.radius - apart, 0.0), 1e-7);
            ++counted;
        }
        CHECK(counted > POSES / 2);
    }
}

int main(void)
{
    RUN(solids_touch_the_triangles_that_they_overlap_and_no_others);
    RUN(overlaps_of_polyhedra_are_the_least_ones);
    RUN(solids_are_divided_by_a_plane_or_share_their_points_of_contact);
    RUN(overlaps_of_round_solids_are_those_of_their_lines);
    return check_finish();
}
