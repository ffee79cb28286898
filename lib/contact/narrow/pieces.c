/* SPDX-License-Identifier: BSD-3-Clause */
/* Two meshes: the convex pieces of one on the surface of the other. What a piece finds that leads
 * into another piece of the same mesh is no way out, and the other finds a better one there; places
 * that several find count once.                                    docs/theory/body-contact.md */
#include "contact/narrow/internal.h"
#include "contact/narrow/mesh.h"
#include "contact/shape/mesh.h"
#include "contact/shape/triangles.h"
#include "math/larger.h"
#include "math/vec3.h"

#include <math.h>

#define BEYOND      1e-6  /* of the size: past the place where the way ends */
#define SHARP       100.0 /* slacks by which their planes are off the sharpest corner */
#define PIECE_SHIFT 26    /* of features: the low bits are triangles and corners */

static void place(const se3di_solid *mesh, const se3di_shape *piece, se3di_shape_pose *at)
{
    *at = *mesh->at;
    se3di_solid_to_ground(mesh, piece->x, at->x);
}

/* From the square of a distance from its origin, */
static int is_far(const se3di_shape *piece, double square, double slack)
{
    const double far = piece->bound + SHARP * slack;
    return square > far * far;
}

/* and from the height over one of its faces. */
static int is_over(double height, double slack)
{
    return !(height < 0.0) && !(height < slack);
}

void se3di_piece_look(const se3di_shape *piece, const double x[3], se3di_piece_view *view)
{
    double d[3];
    se3di_sub(x, piece->x, d);
    view->square = se3di_dot(d, d);
    view->height = -HUGE_VAL;
    for (size_t k = 0; k < piece->triangle_count; ++k) {
        double n[3];
        const double offset = se3di_face_plane(piece, k, n), over = se3di_dot(d, n) - offset;
        view->height = se3di_raised(view->height, over);
    }
}

int se3di_piece_is_at(const se3di_shape *piece, const se3di_piece_view *view, double slack)
{
    return !is_far(piece, view->square, slack) && !is_over(view->height, slack);
}

int se3di_piece_holds(const se3di_shape *piece, const double x[3], double slack)
{
    double d[3];
    se3di_sub(x, piece->x, d);
    if (is_far(piece, se3di_dot(d, d), slack)) {
        return 0;
    }
    for (size_t k = 0; k < piece->triangle_count; ++k) {
        double n[3];
        const double offset = se3di_face_plane(piece, k, n), over = se3di_dot(d, n) - offset;
        if (is_over(over, slack)) {
            return 0;
        }
    }
    return 1;
}

/* The other one leaves piece k where another begins, or slides along the surface of that. */
static int stays_within(const se3di_solid *i, size_t k, const se3di_contact_point *p)
{
    const double beyond = BEYOND * i->shape->bound;
    double x[3], local[3];
    se3di_copy(p->point, x);
    se3di_add_scaled(p->overlap + beyond, p->normal, x);
    se3di_solid_to_local(i, x, local);
    for (size_t other = 0; other < i->shape->piece_count; ++other) {
        if (other != k && se3di_piece_holds(&i->shape->pieces[other], local, 0.1 * beyond)) {
            return 1;
        }
    }
    return 0;
}

int se3di_contact_points_have(const se3di_contact_point *points, uint32_t count,
                              const se3di_contact_point *p, double slack)
{
    for (uint32_t k = 0; k < count; ++k) {
        const se3di_contact_point *other = &points[k];
        double d[3];
        se3di_sub(other->point, p->point, d);
        if (se3di_norm(d) < slack && se3di_dot(other->normal, p->normal) > SE3DI_MESH_COPLANAR) {
            return 1;
        }
    }
    return 0;
}

/* What piece k finds. */
static void find_piece(const se3di_solid *i, size_t k, const se3di_solid *mesh,
                       const se3di_mesh_filter *filter, se3di_manifold *manifold)
{
    const se3di_shape *piece = &i->shape->pieces[k];
    se3di_shape_pose at;
    double local[3];
    uint32_t kept = 0;
    place(i, piece, &at);
    se3di_solid_to_local(mesh, at.x, local);
    if (se3di_mesh_is_clear(mesh->shape, local, piece->bound)) {
        return;
    }
    const se3di_solid solid = {piece, &at};
    if (mesh->shape->piece_count > 0) {
        se3di_mesh_find(&solid, mesh, filter, manifold);
    } else {
        se3di_narrow_mesh(&solid, mesh, manifold);
    }
    for (uint32_t n = 0; n < manifold->count; ++n) {
        if (!stays_within(i, k, &manifold->points[n])) {
            manifold->points[kept] = manifold->points[n];
            manifold->points[kept++].feature += (uint32_t)k << PIECE_SHIFT;
        }
    }
    manifold->count = kept;
}

/* The one with the fewer pieces is taken apart. */
static int is_second(const se3di_solid *i, const se3di_solid *j)
{
    const size_t a = i->shape->piece_count, b = j->shape->piece_count;
    return b > 0 && (a == 0 || b < a);
}

static void find_pieces(const se3di_solid *cut, const se3di_solid *whole, se3di_manifold *manifold)
{
    const double slack = SE3DI_MESH_SAME * cut->shape->bound;
    for (size_t k = 0; k < cut->shape->piece_count; ++k) {
        se3di_manifold own = {.count = 0};
        find_piece(cut, k, whole, NULL, &own);
        for (uint32_t n = 0; n < own.count; ++n) {
            const se3di_contact_point *p = &own.points[n];
            if (!se3di_contact_points_have(manifold->points, manifold->count, p, slack)) {
                *se3di_manifold_add(manifold, p->point, p->normal, p->overlap, p->feature) = *p;
            }
        }
    }
}

void se3di_narrow_meshes(const se3di_solid *i, const se3di_solid *j, se3di_manifold *manifold)
{
    const int turned = is_second(i, j);
    const se3di_solid *cut = turned ? j : i, *whole = turned ? i : j;
    if (se3di_narrow_outlines(i, j, manifold)) {
        return;
    }
    if (cut->shape->piece_count == 0 ||
        (whole->shape->piece_count == 0 && whole->shape->closed != 0)) {
        se3di_narrow_surfaces(i, j, manifold);
        return;
    }
    if (whole->shape->piece_count > 0) {
        (void)se3di_narrow_judge(cut, whole, manifold, find_piece);
    } else {
        find_pieces(cut, whole, manifold);
    }
    se3di_manifold_separate(manifold, cut->at->R);
    if (turned) {
        se3di_manifold_mirror(manifold);
    }
}

double se3di_narrow_meshes_gap(const se3di_solid *i, const se3di_solid *j, double normal[3])
{
    const int turned = is_second(i, j);
    const se3di_solid *cut = turned ? j : i, *whole = turned ? i : j;
    double gap = cut->shape->piece_count > 0 ? HUGE_VAL : 0.0;
    if (!(gap > 0.0)) { /* of the ball about it */
        double local[3], point[3];
        se3di_solid_to_local(whole, cut->at->x, local);
        (void)se3di_mesh_nearest(whole->shape, local, point, &gap);
        gap -= cut->shape->bound;
    }
    for (size_t k = 0; k < cut->shape->piece_count; ++k) {
        se3di_shape_pose at;
        double local[3], point[3], distance;
        place(cut, &cut->shape->pieces[k], &at);
        se3di_solid_to_local(whole, at.x, local);
        (void)se3di_mesh_nearest(whole->shape, local, point, &distance);
        gap = fmin(gap, distance - cut->shape->pieces[k].bound);
    }
    se3di_scale(0.0, normal, normal); /* not known */
    return gap;
}
