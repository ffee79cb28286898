/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes with edges that bulge and edges in hollows, open and closed, for tests of the narrow
 * phase.
 */
#ifndef SE3D_TESTS_SURFACES_H
#define SE3D_TESTS_SURFACES_H

#include "base/alloc.h"
#include "check.h"
#include "contact/shape/mesh.h"
#include "contact/shape/shape.h"
#include "math/vec3.h"

enum {
    SURFACE_ROOF,
    SURFACE_VALLEY,
    SURFACE_BUMPS,
    SURFACE_DOME,
    SURFACE_BLOCK,
    SURFACE_ANGLE,
    SURFACE_DENT,
    SURFACE_STAR,
    SURFACES
};
#define SURFACE_GRID  9
#define SURFACE_FACES (2 * (SURFACE_GRID - 1) * (SURFACE_GRID - 1))

typedef struct surface {
    const char *name;
    int which;
    double points[3 * SURFACE_GRID * SURFACE_GRID];
    uint32_t faces[3 * SURFACE_FACES];
    double middle[SURFACE_FACES][3], bound[SURFACE_FACES]; /* a ball about each face */
    size_t point_count, face_count;
    se3di_shape shape;
} surface;

static inline double surface_height(int which, double x, double y)
{
    return which == SURFACE_ROOF     ? 0.4 * (1.0 - fabs(x))
           : which == SURFACE_VALLEY ? 0.4 * fabs(x)
           : which == SURFACE_BUMPS  ? 0.3 * sin(5.0 * x) * sin(4.4 * y)
                                     : -0.3 * (x * x + y * y);
}

/* 2 x 2 m, two triangles a cell. */
static inline void surface_field(int which, surface *s)
{
    const uint32_t cells = which < SURFACE_BUMPS ? 2 : SURFACE_GRID - 1, row = cells + 1;
    s->point_count = (size_t)row * row;
    for (uint32_t k = 0; k < row * row; ++k) {
        double *p = s->points + 3 * (size_t)k;
        p[0] = -1.0 + 2.0 / cells * (k % row);
        p[1] = -1.0 + 2.0 / cells * (k / row);
        p[2] = surface_height(which, p[0], p[1]);
    }
    s->face_count = 0;
    for (uint32_t k = 0; k < cells * cells; ++k) {
        const uint32_t a = k / cells * row + k % cells;
        const uint32_t two[6] = {a, a + 1, a + row, a + 1, a + row + 1, a + row};
        memcpy(s->faces + 3 * s->face_count, two, sizeof two);
        s->face_count += 2;
    }
}

/* 1 m long, with the corners of `profile` counter-clockwise in x and z, seen from the first. */
static inline void surface_prism(uint32_t n, const double (*profile)[2], surface *s)
{
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

/* A block whose top has a pyramid in it, or on it. */
static inline void surface_pyramid(double top, surface *s)
{
    static const uint32_t faces[] = {0, 2, 1, 0, 3, 2, 0, 1, 5, 0, 5, 4, 1, 2, 6, 1, 6, 5, 2, 3, 7,
                                     2, 7, 6, 3, 0, 4, 3, 4, 7, 4, 5, 8, 5, 6, 8, 6, 7, 8, 7, 4, 8};
    for (int k = 0; k < 8; ++k) {
        s->points[3 * k] = (k % 4 == 1 || k % 4 == 2) ? 0.5 : -0.5;
        s->points[3 * k + 1] = k % 4 > 1 ? 0.5 : -0.5;
        s->points[3 * k + 2] = k > 3 ? 0.2 : -0.5;
    }
    s->points[24] = 0.05;
    s->points[25] = -0.04;
    s->points[26] = top;
    s->point_count = 9;
    s->face_count = sizeof faces / sizeof *faces / 3;
    memcpy(s->faces, faces, sizeof faces);
}

/* An octahedron with a pyramid on each face: hollows between spikes. */
static inline void surface_star(surface *s)
{
    s->point_count = 6;
    s->face_count = 0;
    for (int k = 0; k < 6; ++k) {
        for (int c = 0; c < 3; ++c) {
            s->points[3 * k + c] = c == k / 2 ? (k % 2 ? -0.35 : 0.35) : 0.0;
        }
    }
    for (uint32_t k = 0; k < 8; ++k) {
        const uint32_t flip = (k ^ k >> 1 ^ k >> 2) & 1u;
        const uint32_t corner[3] = {k & 1u, 2 + (flip ? k >> 2 & 1u : k >> 1 & 1u) + (flip ? 2 : 0),
                                    2 + (flip ? k >> 1 & 1u : k >> 2 & 1u) + (flip ? 0 : 2)};
        const uint32_t tip = (uint32_t)s->point_count++;
        for (int c = 0; c < 3; ++c) {
            s->points[3 * tip + (uint32_t)c] = (k >> c & 1u) ? -0.4 : 0.4;
        }
        for (uint32_t c = 0; c < 3; ++c) {
            const uint32_t face[3] = {corner[c], corner[(c + 1) % 3], tip};
            memcpy(s->faces + 3 * s->face_count++, face, sizeof face);
        }
    }
}

static inline void surface_measure(surface *s)
{
    for (size_t k = 0; k < s->face_count; ++k) {
        memset(s->middle[k], 0, sizeof s->middle[k]);
        s->bound[k] = 0.0;
        for (size_t c = 0; c < 6; ++c) {
            const double *x = s->points + 3 * (size_t)s->faces[3 * k + c % 3];
            double d[3];
            if (c < 3) {
                se3di_add_scaled(1.0 / 3.0, x, s->middle[k]);
            } else {
                se3di_sub(x, s->middle[k], d);
                s->bound[k] = fmax(s->bound[k], se3di_norm(d));
            }
        }
    }
}

static inline void surface_make(int which, surface *s)
{
    static const char *const names[SURFACES] = {"roof",  "valley", "bumps", "dome",
                                                "block", "angle",  "dent",  "star"};
    static const double square[4][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
    static const double angle[6][2] = {{-0.5, -0.5}, {0.5, -0.5}, {0.5, -0.1},
                                       {-0.1, -0.1}, {-0.1, 0.5}, {-0.5, 0.5}};
    const se3d_allocator allocator = se3di_alloc_default();
    s->name = names[which];
    s->which = which;
    if (which < SURFACE_BLOCK) {
        surface_field(which, s);
    } else if (which < SURFACE_DENT) {
        surface_prism(which == SURFACE_BLOCK ? 4 : 6, which == SURFACE_BLOCK ? square : angle, s);
    } else if (which == SURFACE_DENT) {
        surface_pyramid(-0.25, s);
    } else {
        surface_star(s);
    }
    memset(&s->shape, 0, sizeof s->shape);
    s->shape.kind = SE3DI_SHAPE_MESH;
    CHECK(!se3di_mesh_build(&allocator, s->points, s->point_count, s->faces, s->face_count,
                            &s->shape));
    s->shape.bound = se3di_shape_bound(&s->shape);
    CHECK((s->shape.closed != 0) == (which >= SURFACE_BLOCK));
    surface_measure(s);
}

static inline void surface_release(surface *s)
{
    const se3d_allocator allocator = se3di_alloc_default();
    se3di_shape_release(&allocator, &s->shape);
}

/* Whether a closed one holds a place, by the angle that it is seen under. */
static inline int surface_holds(const surface *s, const double x[3])
{
    double sum = 0.0;
    for (size_t k = 0; k < s->face_count && s->shape.closed; ++k) {
        double r[3][3], size[3], c[3];
        for (size_t v = 0; v < 3; ++v) {
            se3di_sub(s->points + 3 * (size_t)s->faces[3 * k + v], x, r[v]);
            size[v] = se3di_norm(r[v]);
        }
        se3di_cross(r[1], r[2], c);
        sum += 2.0 * atan2(se3di_dot(r[0], c),
                           size[0] * size[1] * size[2] + se3di_dot(r[0], r[1]) * size[2] +
                               se3di_dot(r[1], r[2]) * size[0] + se3di_dot(r[2], r[0]) * size[1]);
    }
    return fabs(sum) > 6.283185307179586;
}

#endif
