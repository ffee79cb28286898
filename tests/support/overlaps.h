/* SPDX-License-Identifier: BSD-3-Clause */
/* Which triangles of a mesh a solid overlaps, exactly. A box or hull and a triangle overlap if no
 * normal or product of edges divides them; a capsule or sphere, where the line or point is nearer
 * than the radius; a cylinder, where what of the triangle is between the planes of its caps comes
 * nearer to the axis than its radius; an ellipsoid, where the triangle comes into the ball that it
 * is in lengths of its semi-axes. Each is asked with the solid larger or smaller by a
 * margin. */
#ifndef SE3D_TESTS_OVERLAPS_H
#define SE3D_TESTS_OVERLAPS_H

#include "support/poses.h"
#include "support/separation.h"
#include "support/surfaces.h"

typedef struct pose_pair {
    const se3di_shape *solid;
    const surface *mesh;
    se3di_shape_pose at, of; /* of the solid, of the mesh */
    poly body;               /* the solid, mesh frame */
} pose_pair;

/* What of a polygon is on the inner side of n . x <= level; `corner` has room for one more. */
static inline int cut_polygon(double corner[8][3], int count, const double n[3], double level)
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
static inline double axis_apart(const poly *c, double corner[8][3], int count)
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

static inline int cylinder_meets(const poly *c, const double corner[3][3], double margin)
{
    double cut[8][3], back[3];
    memcpy(cut, corner, 3 * sizeof *corner);
    se3di_scale(-1.0, c->z, back);
    const double middle = se3di_dot(c->x, c->z);
    int count = cut_polygon(cut, 3, c->z, middle + c->half + margin);
    count = cut_polygon(cut, count, back, c->half + margin - middle);
    return count > 0 && axis_apart(c, cut, count) < c->rim + margin;
}

static inline int ellipsoid_meets(const poly *e, const double corner[3][3], double margin)
{
    static const double centre[2][3] = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    double scaled[3][3], d[3], on[3], at[3];
    for (int k = 0; k < 3; ++k) {
        se3di_sub(corner[k], e->x, d);
        se3di_mul_transposed(e->axes, d, scaled[k]);
        for (int a = 0; a < 3; ++a) {
            scaled[k][a] /= e->semi[a] + margin;
        }
    }
    return segment_triangle(centre, (const double(*)[3])scaled, on, at) < 1.0;
}

/* The solid, larger by a margin, and a triangle. */
static inline int meets(const poly *solid, const double corner[3][3], double margin)
{
    poly flat;
    double on[3], at[3];
    if (solid->is_cylinder) {
        return cylinder_meets(solid, corner, margin);
    }
    if (solid->is_ellipsoid) {
        return ellipsoid_meets(solid, corner, margin);
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
static inline void bring(pose_pair *p)
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
static inline size_t first_met(const pose_pair *p, double margin, size_t from)
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

static inline int overlaps(const pose_pair *p, double margin)
{
    return first_met(p, margin, 0) < p->mesh->face_count;
}

/* Moved along `way` to where it begins to overlap, and then by `deeper` on. */
static inline void approach(pose_pair *p, const double way[3], double deeper)
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

#endif
