/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids beside meshes, against tests that are exact: no contact of what is apart, a contact of all
 * that overlaps. A box or hull and a triangle overlap if no normal or product of edges divides
 * them; a capsule or sphere, where the line or point is nearer than the radius; a cylinder, where
 * what of the triangle is between the planes of its caps comes nearer to the axis than its radius.
 * Each is asked with the solid larger and smaller by a margin, so that no pose is ambiguous. */
#include "contact/narrow/internal.h"
#include "contact/shape/mesh.h"
#include "support/poses.h"
#include "support/separation.h"
#include "support/surfaces.h"

#define CLEAR 1e-7 /* m: less is neither apart nor overlapping */

enum { SOLIDS = 5 };
static const int kinds[SOLIDS] = {SE3DI_SHAPE_BOX, SE3DI_SHAPE_HULL, SE3DI_SHAPE_CYLINDER,
                                  SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_SPHERE};
static const char *const names[SOLIDS] = {"box", "hull", "cylinder", "capsule", "sphere"};

typedef struct pose_pair {
    const se3di_shape *solid;
    const surface *mesh;
    se3di_shape_pose at, of; /* of the solid, of the mesh */
    poly body;               /* the solid, mesh frame */
} pose_pair;

/* What of a polygon is on the inner side of n . x <= level; `corner` has room for one more. */
static int cut_polygon(double corner[8][3], int count, const double n[3], double level)
{
    double kept[8][3];
    int to = 0;
    for (int k = 0; k < count; ++k) {
        const double *a = corner[k], *b = corner[(k + 1) % count];
        const double high_a = se3di_dot(n, a) - level, high_b = se3di_dot(n, b) - level;
        if (high_a <= 0.0) {
            se3di_copy(a, kept[to++]);
        }
        if ((high_a <= 0.0) != (high_b <= 0.0)) {
            double d[3];
            se3di_sub(b, a, d);
            se3di_copy(a, kept[to]);
            se3di_add_scaled(high_a / (high_a - high_b), d, kept[to++]);
        }
    }
    memcpy(corner, kept, sizeof kept);
    return to;
}

/* The distance of the projection of a polygon from the axis; 0 if the axis goes through it. */
static double axis_apart(const poly *c, double corner[8][3], int count)
{
    double least = HUGE_VAL;
    int left = 0, right = 0;
    for (int k = 0; k < count; ++k) {
        double a[3], d[3], turn[3];
        se3di_sub(corner[k], c->x, a);
        se3di_add_scaled(-se3di_dot(a, c->z), c->z, a);
        se3di_sub(corner[(k + 1) % count], corner[k], d);
        se3di_add_scaled(-se3di_dot(d, c->z), c->z, d);
        const double square = se3di_dot(d, d);
        const double t = square > 0.0 ? fmin(1.0, fmax(0.0, -se3di_dot(a, d) / square)) : 0.0;
        se3di_cross(a, d, turn);
        left += se3di_dot(turn, c->z) > 0.0;
        right += se3di_dot(turn, c->z) < 0.0;
        se3di_add_scaled(t, d, a);
        least = fmin(least, se3di_norm(a));
    }
    return (left == 0) != (right == 0) ? 0.0 : least;
}

static int cylinder_meets(const poly *c, const double corner[3][3], double margin)
{
    double cut[8][3], back[3];
    memcpy(cut, corner, 3 * sizeof *corner);
    se3di_scale(-1.0, c->z, back);
    const double middle = se3di_dot(c->x, c->z);
    int count = cut_polygon(cut, 3, c->z, middle + c->half + margin);
    count = cut_polygon(cut, count, back, c->half + margin - middle);
    return count > 0 && axis_apart(c, cut, count) < c->rim + margin;
}

/* The solid, larger by a margin, and a triangle. */
static int meets(const poly *solid, const double corner[3][3], double margin)
{
    poly flat;
    double on[3], at[3];
    if (solid->is_cylinder) {
        return cylinder_meets(solid, corner, margin);
    }
    if (solid->points < 3) {
        double line[2][3];
        se3di_copy(solid->point[0], line[0]);
        se3di_copy(solid->point[solid->points - 1], line[1]);
        return segment_triangle((const double(*)[3])line, corner, on, at) < solid->radius + margin;
    }
    poly_of_triangle(corner, &flat);
    return depth_of_cores(solid, &flat, margin).least > -margin;
}

/* Place the solid in the mesh's frame. */
static void bring(pose_pair *p)
{
    se3di_shape_pose local;
    double d[3];
    memset(&local, 0, sizeof local);
    se3di_sub(p->at.x, p->of.x, d);
    se3di_mul_transposed(p->of.R, d, local.x);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) {
            for (int k = 0; k < 3; ++k) {
                local.R[3 * r + c] += p->of.R[3 * k + r] * p->at.R[3 * k + c];
            }
        }
    }
    poly_of(p->solid, &local, &p->body);
    se3di_copy(local.x, p->body.x);
}

/* The first triangle from `from` on that it meets, or the count of triangles. */
static size_t first_met(const pose_pair *p, double margin, size_t from)
{
    for (size_t k = from; k < p->mesh->face_count; ++k) {
        double d[3], corner[3][3];
        se3di_sub(p->body.x, p->mesh->middle[k], d);
        if (se3di_norm(d) > p->solid->bound + p->mesh->bound[k] + margin) {
            continue;
        }
        for (size_t c = 0; c < 3; ++c) {
            se3di_copy(p->mesh->points + 3 * (size_t)p->mesh->faces[3 * k + c], corner[c]);
        }
        if (meets(&p->body, (const double(*)[3])corner, margin)) {
            return k;
        }
    }
    return p->mesh->face_count;
}

static int overlaps(const pose_pair *p, double margin)
{
    return first_met(p, margin, 0) < p->mesh->face_count;
}

/* Moved along `way` to where it begins to overlap, and then by `deeper` on. */
static void approach(pose_pair *p, const double way[3], double deeper)
{
    double start[3], low = 0.0, high = 0.0;
    se3di_copy(p->at.x, start);
    while (high < 4.0) {
        se3di_copy(start, p->at.x);
        se3di_add_scaled(high, way, p->at.x);
        bring(p);
        if (overlaps(p, 0.0)) {
            break;
        }
        low = high;
        high += 0.06;
    }
    for (int k = 0; k < 11; ++k) {
        const double middle = 0.5 * (low + high);
        se3di_copy(start, p->at.x);
        se3di_add_scaled(middle, way, p->at.x);
        bring(p);
        if (overlaps(p, 0.0)) {
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

static void show(const pose_pair *p, const char *what, const se3di_manifold *m)
{
    if (!poses_are_many()) {
        return;
    }
    printf("%s, %s: kind %d, half %.17g %.17g %.17g radius %.17g length %.17g\n  at %.17g %.17g "
           "%.17g in the mesh's frame, %u points",
           p->mesh->name, what, p->solid->kind, p->solid->half[0], p->solid->half[1],
           p->solid->half[2], p->solid->radius, p->solid->half_length, p->body.x[0], p->body.x[1],
           p->body.x[2], m->count);
    for (uint32_t k = 0; k < m->count; ++k) {
        printf(" %.3g (%x)", m->points[k].overlap, m->points[k].feature);
    }
    printf("\n");
}

static void count_pose(pose_pair *p, tally *t)
{
    se3di_manifold m;
    double inner[3], d[3], x[3];
    bring(p);
    poses_inner(p->solid, &p->at, x);
    se3di_sub(x, p->of.x, d);
    se3di_mul_transposed(p->of.R, d, inner);
    if (surface_holds(p->mesh, inner)) {
        return;
    }
    const double shallow = -0.2 * poses_size(p->solid);
    const int far = overlaps(p, CLEAR), near = far && overlaps(p, -CLEAR);
    if (far != near || (near && overlaps(p, shallow))) {
        return;
    }
    se3di_narrow_find(p->solid, &p->at, &p->mesh->shape, &p->of, &m);
    if (!near) {
        ++t->clear;
        t->phantom += m.count > 0;
        for (uint32_t k = 0; k < m.count; ++k) {
            t->deepest = fmax(t->deepest, m.points[k].overlap);
        }
    } else {
        ++t->overlapping;
        t->missed += m.count == 0;
    }
    if ((m.count > 0) != near) {
        show(p, near ? "missed" : "phantom", &m);
    }
}

/* At random beside the mesh; and, one in four, from a random side on the way to it, just apart and
 * just overlapping. */
static void count_poses(int kind, const surface *s, int poses, tally *t)
{
    uint64_t seed = 20 + (uint64_t)kind;
    memset(t, 0, sizeof *t);
    for (int k = 0; k < poses; ++k) {
        double way[3] = {0.0, 0.0, -1.0}, local[3];
        poses_solid solid;
        pose_pair p = {.solid = &solid.shape, .mesh = s};
        poses_random_solid(kind, &seed, &solid);
        poses_turn(&seed, &p.of);
        poses_turn(&seed, &p.at);
        if (check_random(&seed) > 0.7) {
            poses_lean(&seed, &p.of, &p.at);
        }
        for (int c = 0; c < 3; ++c) {
            local[c] = (c < 2 ? 0.9 : 0.6) * check_random(&seed);
            way[c] += s->shape.closed ? 2.0 * check_random(&seed) : 0.3 * check_random(&seed);
        }
        poly_place(&p.of, local, p.at.x);
        count_pose(&p, t);
        if (k % 4 == 0) {
            const double size = se3di_norm(way);
            double turned[3];
            se3di_mul(p.of.R, way, turned);
            se3di_scale(1.0 / size, turned, way);
            se3di_add_scaled(-1.8, way, p.at.x);
            approach(&p, way, -0.002);
            count_pose(&p, t);
            const double deeper = poses_between(&seed, 0.0, 0.2) * poses_size(p.solid);
            se3di_add_scaled(0.002 + deeper, way, p.at.x);
            count_pose(&p, t);
        }
    }
}

static void solids_touch_the_triangles_that_they_overlap_and_no_others(void)
{
    static surface s;
    for (int which = 0; which < SURFACES; ++which) {
        surface_make(which, &s);
        for (int kind = 0; kind < SOLIDS; ++kind) {
            const int poses = poses_count(1000);
            tally t;
            count_poses(kinds[kind], &s, poses, &t);
            if (poses_are_many()) {
                printf("%s on %s: %d clear, %d phantom, up to %.2g m; %d overlapping, %d missed\n",
                       names[kind], s.name, t.clear, t.phantom, t.deepest, t.overlapping, t.missed);
            }
            CHECK(t.phantom == 0);
            CHECK(t.missed == 0);
            CHECK(t.clear > poses / 40 && t.overlapping > poses / 40);
        }
        surface_release(&s);
    }
}

int main(void)
{
    RUN(solids_touch_the_triangles_that_they_overlap_and_no_others);
    return check_finish();
}
