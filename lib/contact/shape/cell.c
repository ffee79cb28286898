/* SPDX-License-Identifier: BSD-3-Clause */
/* A cut takes of every face what is behind the plane; the points on the plane, in order about their
 * middle, are a new face. */
#include "contact/shape/cell.h"

#include "base/error.h"
#include "math/vec3.h"

#include <math.h>

void se3di_cell_destroy(const se3d_allocator *allocator, se3di_cell *cell)
{
    se3di_free(allocator, cell->corners, cell->corner_capacity, 3 * sizeof(double));
    se3di_free(allocator, cell->ends, cell->face_capacity, sizeof *cell->ends);
    *cell = (se3di_cell){.corners = NULL};
}

static se3d_status add_corner(const se3d_allocator *allocator, se3di_cell *cell, const double x[3])
{
    void *memory = cell->corners;
    const se3d_status status = se3di_array_reserve(allocator, &memory, &cell->corner_capacity,
                                                   cell->corner_count + 1, 3 * sizeof(double));
    cell->corners = memory;
    SE3DI_TRY(status);
    se3di_copy(x, cell->corners + 3 * cell->corner_count++);
    return SE3D_OK;
}

/* The corners from `begin` on are a face if there are three. */
static se3d_status end_face(const se3d_allocator *allocator, se3di_cell *cell, size_t begin)
{
    if (cell->corner_count < begin + 3) {
        cell->corner_count = begin;
        return SE3D_OK;
    }
    void *memory = cell->ends;
    const se3d_status status = se3di_array_reserve(allocator, &memory, &cell->face_capacity,
                                                   cell->face_count + 1, sizeof *cell->ends);
    cell->ends = memory;
    SE3DI_TRY(status);
    cell->ends[cell->face_count++] = (uint32_t)cell->corner_count;
    return SE3D_OK;
}

se3d_status se3di_cell_begin(const se3d_allocator *allocator, const double middle[3], double half,
                             se3di_cell *cell)
{
    static const double turn[4][2] = {{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}};
    cell->corner_count = cell->face_count = 0;
    for (int face = 0; face < 6; ++face) {
        const int a = face / 2, b = (a + 1) % 3, c = (a + 2) % 3;
        const size_t begin = cell->corner_count;
        for (int k = 0; k < 4; ++k) {
            double x[3];
            x[a] = middle[a] + (face % 2 ? half : -half);
            x[b] = middle[b] + turn[k][0] * half;
            x[c] = middle[c] + turn[k][1] * half;
            SE3DI_TRY(add_corner(allocator, cell, x));
        }
        SE3DI_TRY(end_face(allocator, cell, begin));
    }
    return SE3D_OK;
}

static double height(const se3di_plane *plane, const double x[3], double slack)
{
    const double h = se3di_dot(plane->n, x) - plane->d;
    return fabs(h) <= slack ? 0.0 : h;
}

typedef struct cut {
    const se3d_allocator *allocator;
    const se3di_plane *plane;
    double slack;
    se3di_cell *to, rim; /* `rim`: corners on the plane */
    int has_lid;         /* a face of the cell lies in the plane */
} cut;

/* One that is there already is not added. */
static se3d_status add_rim(cut *c, const double x[3])
{
    for (size_t k = 0; k < c->rim.corner_count; ++k) {
        double d[3];
        se3di_sub(c->rim.corners + 3 * k, x, d);
        if (se3di_norm(d) <= c->slack) {
            return SE3D_OK;
        }
    }
    return add_corner(c->allocator, &c->rim, x);
}

static se3d_status cut_face(cut *c, const double *corners, size_t count)
{
    const size_t begin = c->to->corner_count;
    int flat = 1;
    for (size_t k = 0; k < count; ++k) {
        const double *a = corners + 3 * k, *b = corners + 3 * ((k + 1) % count);
        const double before = height(c->plane, a, c->slack), after = height(c->plane, b, c->slack);
        const int on = !(fabs(before) > 0.0);
        flat = flat && on;
        if (!(before > 0.0)) {
            SE3DI_TRY(add_corner(c->allocator, c->to, a));
        }
        if (on) {
            SE3DI_TRY(add_rim(c, a));
        }
        if (before * after < 0.0) {
            double x[3], d[3];
            se3di_sub(b, a, d);
            se3di_copy(a, x);
            se3di_add_scaled(before / (before - after), d, x);
            SE3DI_TRY(add_corner(c->allocator, c->to, x));
            SE3DI_TRY(add_rim(c, x));
        }
    }
    c->has_lid = c->has_lid || flat;
    return end_face(c->allocator, c->to, begin);
}

/* Whether b comes after a about the middle, from the first corner on. */
static double angle_of(const double axes[2][3], const double middle[3], const double x[3])
{
    double d[3];
    se3di_sub(x, middle, d);
    const double u = se3di_dot(d, axes[0]), v = se3di_dot(d, axes[1]);
    const double size = fabs(u) + fabs(v); /* grows with the angle, without its functions */
    const double t = size > 0.0 ? u / size : 0.0;
    return v < 0.0 ? 3.0 + t : 1.0 - t;
}

static void sort_rim(cut *c)
{
    double axes[2][3], middle[3] = {0.0, 0.0, 0.0};
    double *x = c->rim.corners;
    const size_t count = c->rim.corner_count;
    se3di_perpendicular(c->plane->n, axes[0]);
    se3di_cross(c->plane->n, axes[0], axes[1]);
    for (size_t k = 0; k < count; ++k) {
        se3di_add_scaled(1.0 / (double)count, x + 3 * k, middle);
    }
    for (size_t k = 1; k < count; ++k) {
        double moved[3];
        size_t at = k;
        se3di_copy(x + 3 * k, moved);
        const double angle = angle_of((const double(*)[3])axes, middle, moved);
        for (; at > 0 && angle_of((const double(*)[3])axes, middle, x + 3 * (at - 1)) > angle;
             --at) {
            se3di_copy(x + 3 * (at - 1), x + 3 * at);
        }
        se3di_copy(moved, x + 3 * at);
    }
}

static se3d_status close_rim(cut *c)
{
    const size_t begin = c->to->corner_count;
    if (c->has_lid || c->rim.corner_count < 3) {
        return SE3D_OK;
    }
    sort_rim(c);
    for (size_t k = 0; k < c->rim.corner_count; ++k) {
        SE3DI_TRY(add_corner(c->allocator, c->to, c->rim.corners + 3 * k));
    }
    return end_face(c->allocator, c->to, begin);
}

se3d_status se3di_cell_cut(const se3d_allocator *allocator, const se3di_cell *from,
                           const se3di_plane *plane, double slack, se3di_cell *to)
{
    cut c = {.allocator = allocator, .plane = plane, .slack = slack, .to = to};
    se3d_status status = SE3D_OK;
    size_t begin = 0;
    to->corner_count = to->face_count = 0;
    for (size_t k = 0; k < from->face_count && status >= 0; ++k) {
        status = cut_face(&c, from->corners + 3 * begin, from->ends[k] - begin);
        begin = from->ends[k];
    }
    if (status >= 0) {
        status = close_rim(&c);
    }
    se3di_cell_destroy(allocator, &c.rim);
    return status;
}
