/* SPDX-License-Identifier: BSD-3-Clause */
/* Overlap and normal of solids on meshes with hollows. What a solid overlaps falls into pieces:
 * triangles that hang together and are each behind the planes of the others. As little as it
 * overlaps here, the mesh is there what is behind these planes, a convex solid, and the overlap is
 * that of support/separation.h. Each piece has a contact with its overlap and normal, to 1e-9, and
 * none is deeper than its piece. */
#include "contact/narrow/internal.h"
#include "contact/shape/hull.h"
#include "contact/shape/mesh.h"
#include "support/overlaps.h"

#define SAME   1e-9
#define AROUND 3.0 /* m: half the block that the planes of a piece are cut from */
#define MOST   24  /* triangles in all pieces */

enum { SOLIDS = 5 };
static const int kinds[SOLIDS] = {SE3DI_SHAPE_BOX, SE3DI_SHAPE_HULL, SE3DI_SHAPE_CYLINDER,
                                  SE3DI_SHAPE_CAPSULE, SE3DI_SHAPE_SPHERE};
static const char *const names[SOLIDS] = {"box", "hull", "cylinder", "capsule", "sphere"};

typedef struct face {
    size_t triangle;
    double n[3], level, corner[3][3]; /* mesh frame; towards the solid */
    int piece;
} face;

typedef struct pieces {
    int faces, count;
    face face[MOST];
} pieces;

static void face_make(const pose_pair *p, size_t triangle, int is_above, face *f)
{
    double u[3], v[3];
    f->triangle = triangle;
    f->piece = -1;
    for (size_t c = 0; c < 3; ++c) {
        se3di_copy(p->mesh->points + 3 * (size_t)p->mesh->faces[3 * triangle + c], f->corner[c]);
    }
    se3di_sub(f->corner[1], f->corner[0], u);
    se3di_sub(f->corner[2], f->corner[0], v);
    se3di_cross(u, v, f->n);
    se3di_scale(1.0 / se3di_norm(f->n), f->n, f->n);
    if (p->mesh->shape.closed < 0 || (p->mesh->shape.closed == 0 && !is_above)) {
        se3di_scale(-1.0, f->n, f->n);
    }
    f->level = se3di_dot(f->corner[0], f->n);
}

static int is_behind(const face *f, const face *g)
{
    for (int c = 0; c < 3; ++c) {
        if (se3di_dot(g->corner[c], f->n) > f->level + 1e-9) {
            return 0;
        }
    }
    return 1;
}

static int are_convex(const face *f, const face *g)
{
    return is_behind(f, g) && is_behind(g, f);
}

static int hang_together(const surface *s, const face *f, const face *g)
{
    for (size_t k = 0; k < 9; ++k) {
        if (s->faces[3 * f->triangle + k / 3] == s->faces[3 * g->triangle + k % 3]) {
            return 1;
        }
    }
    return 0;
}

static void spread(const surface *s, pieces *all, int from)
{
    for (int k = 0; k < all->faces; ++k) {
        if (all->face[k].piece < 0 && hang_together(s, &all->face[from], &all->face[k]) &&
            are_convex(&all->face[from], &all->face[k])) {
            all->face[k].piece = all->face[from].piece;
            spread(s, all, k);
        }
    }
}

/* Whether the triangles that the solid overlaps fall into pieces; those that only touch it by a
 * hair, centres behind the surface and solids near a border are left out. */
static int divide(const pose_pair *p, pieces *all)
{
    double inner[3], d[3], x[3];
    all->faces = all->count = 0;
    poses_inner(p->solid, &p->at, x);
    se3di_sub(x, p->of.x, d);
    se3di_mul_transposed(p->of.R, d, inner);
    const double far = fmax(fabs(p->body.x[0]), fabs(p->body.x[1])) + p->solid->bound;
    if (surface_holds(p->mesh, inner) || (p->mesh->shape.closed == 0 && far > 1.0)) {
        return 0;
    }
    const int is_above = inner[2] > surface_height(p->mesh->which, inner[0], inner[1]);
    for (size_t k = first_met(p, 1e-6, 0); k < p->mesh->face_count; k = first_met(p, 1e-6, k + 1)) {
        if (all->faces == MOST || first_met(p, -1e-6, k) != k) {
            return 0;
        }
        face_make(p, k, is_above, &all->face[all->faces++]);
    }
    for (int k = 0; k < all->faces; ++k) {
        if (all->face[k].piece < 0) {
            all->face[k].piece = all->count++;
            spread(p->mesh, all, k);
        }
    }
    for (int a = 0; a < all->faces; ++a) {
        for (int b = 0; b < a; ++b) {
            const int one = all->face[a].piece == all->face[b].piece;
            if (one != are_convex(&all->face[a], &all->face[b])) {
                return 0; /* a saddle, or two bumps side by side */
            }
        }
    }
    return all->faces > 0;
}

/* What is behind the planes of a piece, within a block: all places where three of them meet. */
static int solid_behind(const pieces *all, int piece, se3di_shape *hull)
{
    const se3d_allocator allocator = se3di_alloc_default();
    double n[MOST + 6][3], level[MOST + 6], points[3 * 256];
    int planes = 0;
    size_t count = 0;
    for (int k = 0; k < 6; ++k, ++planes) {
        memset(n[planes], 0, sizeof n[planes]);
        n[planes][k / 2] = k % 2 ? -1.0 : 1.0;
        level[planes] = AROUND + 0.1 * k;
    }
    for (int k = 0; k < all->faces; ++k) {
        int is_new = all->face[k].piece == piece;
        for (int c = 6; c < planes; ++c) {
            is_new = is_new && !(se3di_dot(n[c], all->face[k].n) > 1.0 - 1e-12);
        }
        if (is_new) {
            se3di_copy(all->face[k].n, n[planes]);
            level[planes++] = all->face[k].level;
        }
    }
    for (int a = 0; a < planes; ++a) {
        for (int b = 0; b < a; ++b) {
            for (int c = 0; c < b; ++c) {
                double x[3] = {0.0, 0.0, 0.0}, bc[3], ca[3], ab[3];
                se3di_cross(n[b], n[c], bc);
                se3di_cross(n[c], n[a], ca);
                se3di_cross(n[a], n[b], ab);
                const double det = se3di_dot(n[a], bc);
                if (!(fabs(det) > 1e-6) || count == 256) {
                    continue;
                }
                se3di_add_scaled(level[a] / det, bc, x);
                se3di_add_scaled(level[b] / det, ca, x);
                se3di_add_scaled(level[c] / det, ab, x);
                int inside = 1;
                for (int k = 0; k < planes; ++k) {
                    inside = inside && se3di_dot(n[k], x) < level[k] + 1e-10;
                }
                for (size_t k = 0; k < count && inside; ++k) {
                    double d[3];
                    se3di_sub(points + 3 * k, x, d);
                    inside = se3di_norm(d) > 1e-8;
                }
                if (inside) {
                    se3di_copy(x, points + 3 * count++);
                }
            }
        }
    }
    memset(hull, 0, sizeof *hull);
    hull->kind = SE3DI_SHAPE_HULL;
    const int built = se3di_hull_build(&allocator, points, count, hull) >= 0;
    hull->bound = built ? se3di_shape_bound(hull) : 0.0;
    return built;
}

typedef struct tally {
    int counted, several, less, wrong, deeper;
} tally;

static void show(const pose_pair *p, const pieces *all, double wanted, const double n[3],
                 const se3di_manifold *m)
{
    if (!poses_are_many()) {
        return;
    }
    double local[3];
    se3di_mul_transposed(p->of.R, n, local);
    printf("%s, kind %d, %d faces in %d pieces: %.12g along %.9g %.9g %.9g\n", p->mesh->name,
           p->solid->kind, all->faces, all->count, wanted, local[0], local[1], local[2]);
    for (uint32_t k = 0; k < m->count; ++k) {
        se3di_mul_transposed(p->of.R, m->points[k].normal, local);
        printf("    %x: %.12g along %.9g %.9g %.9g\n", m->points[k].feature, m->points[k].overlap,
               local[0], local[1], local[2]);
    }
}

/* Faces of several pieces within 3 degrees are one to the narrow phase. */
static int is_alone(const pieces *all, int piece, const double n[3])
{
    for (int k = 0; k < all->faces; ++k) {
        if (all->face[k].piece != piece && -se3di_dot(all->face[k].n, n) > 0.998) {
            return 0;
        }
    }
    return 1;
}

/* Whether the solid is off the mesh when it is moved as a contact says, though that is less than
 * the piece takes: by a face behind whose plane it is, beyond its end. */
static int comes_off(const pose_pair *p, const se3di_contact_point *c)
{
    pose_pair moved = *p;
    se3di_add_scaled(-(c->overlap + 1e-7), c->normal, moved.at.x);
    bring(&moved);
    return first_met(&moved, 0.0, 0) == p->mesh->face_count;
}

/* Whether the solid is farthest behind a piece at a place of it, not beyond a hollow. */
static int is_over(const pose_pair *p, const pieces *all, int piece, const double n[3],
                   double wanted)
{
    double low[3], local[3], up[3];
    se3di_mul_transposed(p->of.R, n, local);
    if (!is_alone(all, piece, local)) {
        return 0;
    }
    poly solid;
    poly_of(p->solid, &p->at, &solid);
    poly_reach(&solid, n, low);
    se3di_add_scaled(solid.radius - wanted, n, low);
    se3di_sub(low, p->of.x, up);
    se3di_mul_transposed(p->of.R, up, local);
    for (int k = 0; k < all->faces; ++k) {
        const face *f = &all->face[k];
        const double *const corner[3] = {f->corner[0], f->corner[1], f->corner[2]};
        double at[3];
        if (f->piece == piece && se3di_triangle_nearest(corner, local, at, NULL) < 1e-18) {
            return 1;
        }
    }
    return 0;
}

/* What the normals at both ends of what a round side has on an edge may be off: they are across the
 * edge or the axis, where these are nearly parallel. */
static double turn_on_edges(const pose_pair *p, const double n[3])
{
    double axis[3];
    se3di_solid_axis(&(se3di_solid){p->solid, &p->at}, 2, axis);
    return p->solid->kind == SE3DI_SHAPE_CYLINDER && fabs(se3di_dot(axis, n)) < 1e-2 ? 1e-4 : 0.0;
}

/* One contact is that of the piece; those along its normals, between its faces, are no deeper. */
static void check_piece(const pose_pair *p, const pieces *all, int piece, const se3di_manifold *m,
                        tally *t)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_shape hull;
    double n[3], turn[3];
    if (!solid_behind(all, piece, &hull)) {
        return;
    }
    const double wanted = separation_of(p->solid, &p->at, &hull, &p->of, n);
    se3di_shape_release(&allocator, &hull);
    if (!(wanted > 1e-6 && wanted < 0.3 * poses_size(p->solid)) ||
        (all->count > 1 && !is_over(p, all, piece, n, wanted))) {
        return;
    }
    const double slack = turn_on_edges(p, n);
    int found = 0, deeper = 0, less = 0;
    for (uint32_t k = 0; k < m->count; ++k) {
        se3di_sub(m->points[k].normal, n, turn);
        found |= se3di_norm(turn) < SAME + slack && fabs(m->points[k].overlap - wanted) < SAME;
        less |= m->points[k].overlap < wanted - SAME && comes_off(p, &m->points[k]);
        deeper |= all->count == 1 && m->points[k].overlap > wanted + SAME;
    }
    found |= separation_shared(p->solid, m) > wanted - SAME;
    ++t->counted;
    t->several += all->count > 1;
    t->less += !found && less;
    t->wrong += !found && !less;
    t->deeper += deeper;
    if ((!found && !less) || deeper) {
        show(p, all, wanted, n, m);
    }
}

static void check_pose(pose_pair *p, tally *t)
{
    pieces all;
    se3di_manifold m;
    bring(p);
    if (!divide(p, &all)) {
        return;
    }
    se3di_narrow_find(p->solid, &p->at, &p->mesh->shape, &p->of, &m);
    for (int k = 0; k < all.count; ++k) {
        check_piece(p, &all, k, &m, t);
    }
}

static void check_solid(int kind, const surface *s, int poses, tally *t)
{
    uint64_t seed = 90 + (uint64_t)kind;
    memset(t, 0, sizeof *t);
    for (int k = 0; k < poses; ++k) {
        double way[3] = {0.0, 0.0, -1.0}, local[3], turned[3];
        poses_solid solid;
        pose_pair p = {.solid = &solid.shape, .mesh = s};
        poses_random_solid(kind, &seed, &solid);
        poses_turn(&seed, &p.of);
        poses_turn(&seed, &p.at);
        if (check_random(&seed) > 0.7) {
            poses_lean(&seed, &p.of, &p.at);
        }
        for (int c = 0; c < 3; ++c) {
            local[c] = 0.6 * check_random(&seed);
            way[c] += s->shape.closed ? 2.0 * check_random(&seed) : 0.3 * check_random(&seed);
        }
        poly_place(&p.of, local, p.at.x);
        se3di_mul(p.of.R, way, turned);
        se3di_scale(1.0 / se3di_norm(turned), turned, way);
        se3di_add_scaled(-1.8, way, p.at.x);
        approach(&p, way, poses_between(&seed, 0.001, 0.1) * poses_size(p.solid));
        check_pose(&p, t);
    }
}

static void each_piece_of_a_mesh_is_as_deep_as_what_is_behind_its_planes(void)
{
    static surface s;
    for (int which = 0; which < SURFACES; ++which) {
        surface_make(which, &s);
        for (int kind = 0; kind < SOLIDS; ++kind) {
            const int poses = poses_count(200);
            tally t;
            check_solid(kinds[kind], &s, poses, &t);
            if (poses_are_many()) {
                printf("%s on %s: %d counted, %d of several, %d less, %d wrong, %d deeper\n",
                       names[kind], s.name, t.counted, t.several, t.less, t.wrong, t.deeper);
            }
            CHECK(t.wrong == 0);
            CHECK(t.deeper == 0);
            CHECK(t.less * 50 <= t.counted);
            CHECK(t.counted > poses / 4);
        }
        surface_release(&s);
    }
}

int main(void)
{
    RUN(each_piece_of_a_mesh_is_as_deep_as_what_is_behind_its_planes);
    return check_finish();
}
