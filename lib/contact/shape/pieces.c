/* SPDX-License-Identifier: BSD-3-Clause */
/* A closed mesh is cut along the planes of its own faces until every part is convex.
 *
 * Faces that have all others behind them bound the part; if only such are left it is convex.
 * Otherwise the plane that cuts the fewest of the others divides the part: faces that it cuts are
 * cut, those in it are done. What is in front of the last face is outside, what is behind it
 * inside. The parts' volumes must add up to that of the mesh.
 *
 * A part ends where it was cut, although the body goes on there, and a contact near that place
 * would find a way out into its neighbour. So each part then grows over every cut that it can do
 * without: where no face is within the larger one. An L becomes two bars that share its corner. */
#include "contact/shape/pieces.h"

#include "contact/shape/cell.h"
#include "contact/shape/hull.h"
#include "contact/shape/shape.h"
#include "contact/shape/triangles.h"
#include "math/vec3.h"

#include <math.h>
#include <string.h>

#define TRIANGLES_MOST 400
#define FACES_MOST     4000 /* that are there at once, cut ones too */
#define CORNERS        12   /* of a face that was cut again and again */
#define SLACK          1e-9 /* of the size: a point is in a plane */
#define VOLUME         1e-8 /* of the cube of the size: by which volumes may differ */

typedef struct face {
    uint32_t plane, count;
    double x[CORNERS][3];
} face;

typedef struct cutter {
    const se3d_allocator *allocator;
    const se3di_shape *mesh;
    double middle[3], size, slack;
    se3di_plane *planes; /* of the triangles, outward */
    se3di_plane *path;   /* around the present part */
    int *is_cut;         /* [path]: a cut, not a face that has all behind it */
    size_t path_count, path_capacity, cut_capacity;
    se3di_cell cell[2];
    double volume;
    se3di_shape pieces[SE3DI_PIECES_MOST];
    size_t count, faces;
} cutter;

/* There is no memory, or (INVALID_ARGUMENT) it is given up. */
static se3d_status divide(cutter *c, face *list, size_t count);

static double height(const se3di_plane *plane, const double x[3])
{
    return se3di_dot(plane->n, x) - plane->d;
}

/* Bits: 1 some of it is in front, 2 some of it is behind. */
static int side_of(const cutter *c, const se3di_plane *plane, const face *f)
{
    int side = 0;
    for (uint32_t k = 0; k < f->count; ++k) {
        const double h = height(plane, f->x[k]);
        side |= h > c->slack ? 1 : h < -c->slack ? 2 : 0;
    }
    return side;
}

static se3d_status push(cutter *c, const se3di_plane *plane, int is_cut)
{
    void *path = c->path, *cuts = c->is_cut;
    se3d_status status = se3di_array_reserve(c->allocator, &path, &c->path_capacity,
                                             c->path_count + 1, sizeof *c->path);
    c->path = path;
    if (status >= 0) {
        status = se3di_array_reserve(c->allocator, &cuts, &c->cut_capacity, c->path_count + 1,
                                     sizeof *c->is_cut);
        c->is_cut = cuts;
    }
    SE3DI_TRY(status);
    c->path[c->path_count] = *plane;
    c->is_cut[c->path_count++] = is_cut;
    return SE3D_OK;
}

static int is_on_path(const cutter *c, size_t begin, const face *f)
{
    for (size_t k = begin; k < c->path_count; ++k) {
        if (side_of(c, &c->path[k], f) == 0) {
            return 1;
        }
    }
    return 0;
}

/* Put the planes that have all behind them on the path; the faces in them are done. */
static se3d_status peel(cutter *c, face *list, size_t *count)
{
    const size_t begin = c->path_count;
    size_t kept = 0;
    for (size_t k = 0; k < *count; ++k) {
        const se3di_plane *plane = &c->planes[list[k].plane];
        int bounds = !is_on_path(c, begin, &list[k]);
        for (size_t other = 0; other < *count && bounds; ++other) {
            bounds = (side_of(c, plane, &list[other]) & 1) == 0;
        }
        if (bounds) {
            SE3DI_TRY(push(c, plane, 0));
        }
    }
    for (size_t k = 0; k < *count; ++k) {
        if (!is_on_path(c, begin, &list[k])) {
            list[kept++] = list[k];
        }
    }
    *count = kept;
    return SE3D_OK;
}

/* The plane that cuts the fewest; of those the one with the most even halves. */
static const se3di_plane *choose(const cutter *c, const face *list, size_t count)
{
    const se3di_plane *best = NULL;
    size_t least = 0;
    for (size_t k = 0; k < count; ++k) {
        const se3di_plane *plane = &c->planes[list[k].plane];
        size_t front = 0, back = 0, both = 0;
        for (size_t other = 0; other < count; ++other) {
            const int side = side_of(c, plane, &list[other]);
            front += side == 1;
            back += side == 2;
            both += side == 3;
        }
        const size_t cost = 2 * count * both + (front > back ? front - back : back - front);
        if (!best || cost < least) {
            best = plane;
            least = cost;
        }
    }
    return best;
}

/* The part of a face that is behind a plane; returns 0 if it has too many corners. */
static int cut_face(const cutter *c, const face *from, const se3di_plane *plane, face *to)
{
    to->plane = from->plane;
    to->count = 0;
    for (uint32_t k = 0; k < from->count; ++k) {
        const double *a = from->x[k], *b = from->x[(k + 1) % from->count];
        const double before = height(plane, a), after = height(plane, b);
        if (to->count + 2 > CORNERS) {
            return 0;
        }
        if (before <= c->slack) {
            se3di_copy(a, to->x[to->count++]);
        }
        if ((before > c->slack && after < -c->slack) || (before < -c->slack && after > c->slack)) {
            double d[3];
            se3di_sub(b, a, d);
            se3di_copy(a, to->x[to->count]);
            se3di_add_scaled(before / (before - after), d, to->x[to->count++]);
        }
    }
    return 1;
}

static se3di_plane reverse(const se3di_plane *plane)
{
    return (se3di_plane){{-plane->n[0], -plane->n[1], -plane->n[2]}, -plane->d};
}

/* What is behind the plane of the faces, into `to`. */
static se3d_status select_faces(const cutter *c, const face *list, size_t count,
                                const se3di_plane *plane, face *to, size_t *kept)
{
    *kept = 0;
    for (size_t k = 0; k < count; ++k) {
        const int side = side_of(c, plane, &list[k]);
        if (side == 2) {
            to[(*kept)++] = list[k];
        } else if (side == 3 && !cut_face(c, &list[k], plane, &to[(*kept)++])) {
            return SE3D_ERR_INVALID_ARGUMENT;
        }
    }
    return SE3D_OK;
}

/* The corners of what is behind the planes of the path but `without`, in cell[0]. */
static se3d_status build_cell(cutter *c, size_t without)
{
    SE3DI_TRY(se3di_cell_begin(c->allocator, c->middle, 2.0 * c->size, &c->cell[0]));
    for (size_t k = 0; k < c->path_count; ++k) {
        if (k != without) {
            SE3DI_TRY(
                se3di_cell_cut(c->allocator, &c->cell[0], &c->path[k], c->slack, &c->cell[1]));
            const se3di_cell cell = c->cell[0];
            c->cell[0] = c->cell[1];
            c->cell[1] = cell;
        }
    }
    return SE3D_OK;
}

/* Whether a triangle of the mesh is within the planes of the path but `without`. */
static int is_entered(const cutter *c, size_t without)
{
    const se3di_shape *s = c->mesh;
    for (uint32_t t = 0; t < s->triangle_count; ++t) {
        face part = {.plane = t, .count = 3};
        for (size_t k = 0; k < 3; ++k) {
            se3di_copy(s->vertices + 3 * (size_t)s->triangles[3 * t + k], part.x[k]);
        }
        int within = 1;
        for (size_t k = 0; k < c->path_count && within; ++k) {
            face rest;
            const int side = k == without ? 2 : side_of(c, &c->path[k], &part);
            within = (side & 2) != 0;
            if (side == 3) {
                if (!cut_face(c, &part, &c->path[k], &rest)) {
                    return 1;
                }
                part = rest;
            }
        }
        if (within) {
            return 1;
        }
    }
    return 0;
}

static void grow(cutter *c)
{
    for (size_t k = 0; k < c->path_count;) {
        if (!c->is_cut[k] || is_entered(c, k)) {
            ++k;
            continue;
        }
        --c->path_count;
        memmove(&c->path[k], &c->path[k + 1], (c->path_count - k) * sizeof *c->path);
        memmove(&c->is_cut[k], &c->is_cut[k + 1], (c->path_count - k) * sizeof *c->is_cut);
    }
}

static double volume_of(const se3di_shape *s, const double middle[3])
{
    double sum = 0.0;
    for (size_t k = 0; k < s->triangle_count; ++k) {
        double x[3][3], n[3];
        for (size_t corner = 0; corner < 3; ++corner) {
            se3di_sub(s->vertices + 3 * (size_t)s->triangles[3 * k + corner], middle, x[corner]);
        }
        se3di_cross(x[0], x[1], n);
        sum += se3di_dot(n, x[2]) / 6.0;
    }
    return sum;
}

/* Corners of a cell that are corners of the mesh but for rounding are those. */
static void snap(const cutter *c, double *corners, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        for (size_t v = 0; v < c->mesh->vertex_count; ++v) {
            double d[3];
            se3di_sub(c->mesh->vertices + 3 * v, corners + 3 * k, d);
            if (se3di_norm(d) <= c->slack) {
                se3di_copy(c->mesh->vertices + 3 * v, corners + 3 * k);
                break;
            }
        }
    }
}

/* The hull of cell[0]: NULL vertices if it has no volume. */
static se3d_status make_hull(cutter *c, se3di_shape *piece)
{
    *piece = (se3di_shape){.kind = SE3DI_SHAPE_HULL, .material = -1};
    snap(c, c->cell[0].corners, c->cell[0].corner_count);
    if (c->cell[0].corner_count < 4) {
        return SE3D_OK;
    }
    const se3d_status status =
        se3di_hull_build(c->allocator, c->cell[0].corners, c->cell[0].corner_count, piece);
    return status == SE3D_ERR_INVALID_ARGUMENT ? SE3D_OK : status;
}

/* Its origin in the middle of its corners. */
static void center(se3di_shape *piece)
{
    double middle[3] = {0.0, 0.0, 0.0};
    for (size_t k = 0; k < piece->vertex_count; ++k) {
        se3di_add_scaled(1.0 / (double)piece->vertex_count, piece->vertices + 3 * k, middle);
    }
    for (size_t k = 0; k < piece->vertex_count; ++k) {
        se3di_sub(piece->vertices + 3 * k, middle, piece->vertices + 3 * k);
    }
    for (int a = 0; a < 3; ++a) {
        piece->x[a] = middle[a];
        piece->A[4 * a] = 1.0;
    }
    se3di_hull_set_planes(piece);
    piece->bound = se3di_shape_bound(piece);
}

/* Whether all of a is within b. */
static int is_part_of(const cutter *c, const se3di_shape *a, const se3di_shape *b)
{
    for (size_t k = 0; k < b->triangle_count; ++k) {
        const double *corner[3];
        double u[3], n[3];
        se3di_triangle_corners(b, k, corner);
        se3di_triangle_span(corner, n);
        for (size_t i = 0; i < a->vertex_count; ++i) {
            for (int axis = 0; axis < 3; ++axis) {
                u[axis] =
                    a->x[axis] + a->vertices[3 * i + (size_t)axis] - b->x[axis] - corner[0][axis];
            }
            if (se3di_dot(u, n) > c->slack * se3di_norm(n)) {
                return 0;
            }
        }
    }
    return 1;
}

/* Parts that have grown may hold each other. */
static void keep(cutter *c, se3di_shape *piece)
{
    size_t kept = 0;
    for (size_t k = 0; k < c->count; ++k) {
        if (is_part_of(c, piece, &c->pieces[k])) {
            se3di_shape_release(c->allocator, piece);
            return; /* it holds none of the others then: they would be part of that one */
        }
    }
    for (size_t k = 0; k < c->count; ++k) {
        if (is_part_of(c, &c->pieces[k], piece)) {
            se3di_shape_release(c->allocator, &c->pieces[k]);
        } else {
            c->pieces[kept++] = c->pieces[k];
        }
    }
    c->pieces[kept++] = *piece;
    c->count = kept;
}

/* All around the part is on the path. */
static se3d_status add_piece(cutter *c)
{
    se3di_shape piece;
    SE3DI_TRY(build_cell(c, SIZE_MAX));
    SE3DI_TRY(make_hull(c, &piece));
    const double volume = piece.vertices ? volume_of(&piece, c->middle) : 0.0;
    se3di_shape_release(c->allocator, &piece);
    c->volume += volume;
    if (volume < VOLUME * c->size * c->size * c->size) {
        return SE3D_OK;
    }
    if (c->count == SE3DI_PIECES_MOST) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    grow(c);
    SE3DI_TRY(build_cell(c, SIZE_MAX));
    SE3DI_TRY(make_hull(c, &piece));
    if (piece.vertices) {
        center(&piece);
        keep(c, &piece);
    }
    return SE3D_OK;
}

/* One side of a cut, as a part with a path of its own. */
static se3d_status divide_side(cutter *c, const face *list, size_t count, const se3di_plane *plane,
                               int is_back)
{
    const size_t kept_path = c->path_count;
    size_t kept = 0;
    if (c->faces + count > FACES_MOST) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    face *part = se3di_alloc(c->allocator, count, sizeof *part);
    if (!part) {
        return SE3D_ERR_NO_MEMORY;
    }
    c->faces += count;
    se3d_status status = select_faces(c, list, count, plane, part, &kept);
    if (status >= 0) {
        status = push(c, plane, 1);
    }
    if (status >= 0 && (kept > 0 || is_back)) {
        status = divide(c, part, kept);
    }
    c->path_count = kept_path;
    c->faces -= count;
    se3di_free(c->allocator, part, count, sizeof *part);
    return status;
}

/* Growing takes planes of the path away: the whole of it is put back. */
static se3d_status add_whole(cutter *c)
{
    const size_t count = c->path_count;
    se3di_plane *planes = se3di_alloc(c->allocator, count, sizeof *planes);
    int *cuts = se3di_alloc(c->allocator, count, sizeof *cuts);
    se3d_status status = planes && cuts ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    if (status >= 0) {
        memcpy(planes, c->path, count * sizeof *planes);
        memcpy(cuts, c->is_cut, count * sizeof *cuts);
        status = add_piece(c);
        memcpy(c->path, planes, count * sizeof *planes);
        memcpy(c->is_cut, cuts, count * sizeof *cuts);
        c->path_count = count;
    }
    se3di_free(c->allocator, planes, count, sizeof *planes);
    se3di_free(c->allocator, cuts, count, sizeof *cuts);
    return status;
}

/* Recursion: no deeper than there are faces. */
static se3d_status divide(cutter *c, face *list, size_t count)
{
    SE3DI_TRY(peel(c, list, &count));
    if (count == 0) {
        return add_whole(c);
    }
    const se3di_plane plane = *choose(c, list, count), back = reverse(&plane);
    SE3DI_TRY(divide_side(c, list, count, &plane, 1));
    return divide_side(c, list, count, &back, 0);
}

static void measure(cutter *c)
{
    const se3di_shape *s = c->mesh;
    double low[3], high[3];
    se3di_copy(s->vertices, low);
    se3di_copy(s->vertices, high);
    for (size_t k = 0; k < 3 * s->vertex_count; ++k) {
        low[k % 3] = fmin(low[k % 3], s->vertices[k]);
        high[k % 3] = fmax(high[k % 3], s->vertices[k]);
    }
    for (int a = 0; a < 3; ++a) {
        c->middle[a] = 0.5 * (low[a] + high[a]);
        c->size = fmax(c->size, 0.5 * (high[a] - low[a]));
    }
    c->slack = SLACK * c->size;
}

/* The triangles as faces, counter-clockwise seen from outside. */
static void read_faces(cutter *c, face *list)
{
    const se3di_shape *s = c->mesh;
    for (uint32_t t = 0; t < s->triangle_count; ++t) {
        double u[3], v[3];
        face *f = &list[t];
        se3di_plane *plane = &c->planes[t];
        f->plane = t;
        f->count = 3;
        for (size_t k = 0; k < 3; ++k) {
            se3di_copy(s->vertices + 3 * (size_t)s->triangles[3 * t + k], f->x[k]);
        }
        se3di_sub(f->x[1], f->x[0], u);
        se3di_sub(f->x[2], f->x[0], v);
        se3di_cross(u, v, plane->n);
        se3di_scale((double)s->closed / se3di_norm(plane->n), plane->n, plane->n);
        plane->d = se3di_dot(plane->n, f->x[0]);
    }
}

static se3d_status cut_up(cutter *c)
{
    const se3di_shape *s = c->mesh;
    const size_t count = s->triangle_count;
    face *list = se3di_alloc(c->allocator, count, sizeof *list);
    c->planes = se3di_alloc(c->allocator, count, sizeof *c->planes);
    se3d_status status = list && c->planes ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    if (status >= 0) {
        read_faces(c, list);
        c->faces = count;
        status = divide(c, list, count);
    }
    if (status >= 0 && !(fabs(c->volume - s->closed * volume_of(s, c->middle)) <
                         VOLUME * c->size * c->size * c->size)) {
        status = SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_free(c->allocator, list, count, sizeof *list);
    se3di_free(c->allocator, c->planes, count, sizeof *c->planes);
    se3di_free(c->allocator, c->path, c->path_capacity, sizeof *c->path);
    se3di_free(c->allocator, c->is_cut, c->cut_capacity, sizeof *c->is_cut);
    se3di_cell_destroy(c->allocator, &c->cell[0]);
    se3di_cell_destroy(c->allocator, &c->cell[1]);
    return status;
}

se3d_status se3di_pieces_build(const se3d_allocator *allocator, se3di_shape *mesh)
{
    mesh->pieces = NULL;
    mesh->piece_count = 0;
    if (mesh->closed == 0 || mesh->convex || mesh->triangle_count > TRIANGLES_MOST) {
        return SE3D_OK;
    }
    cutter *c = se3di_alloc(allocator, 1, sizeof *c); /* large */
    if (!c) {
        return SE3D_ERR_NO_MEMORY;
    }
    c->allocator = allocator;
    c->mesh = mesh;
    measure(c);
    se3d_status status = cut_up(c);
    if (status >= 0 && c->count > 0) {
        mesh->pieces = se3di_alloc(allocator, c->count, sizeof *mesh->pieces);
        status = mesh->pieces ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    }
    if (mesh->pieces) {
        memcpy(mesh->pieces, c->pieces, c->count * sizeof *mesh->pieces);
        mesh->piece_count = c->count;
    }
    for (size_t k = 0; k < c->count && !mesh->pieces; ++k) {
        se3di_shape_release(allocator, &c->pieces[k]);
    }
    se3di_free(allocator, c, 1, sizeof *c);
    return status == SE3D_ERR_INVALID_ARGUMENT ? SE3D_OK : status;
}
