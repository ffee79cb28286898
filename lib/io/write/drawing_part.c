/* SPDX-License-Identifier: BSD-3-Clause */
/* Parts: how they are made, turned and put on the list of a body. */
#include "io/write/drawing_part.h"

#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/read/shape_kinds.h"

void se3di_drawing_turn(const double origin[3], const double A[9], const double local[3],
                        double ground[3])
{
    const double s[3] = {local[0], local[1], local[2]}; /* ground may be local */
    for (int i = 0; i < 3; ++i) {
        ground[i] = origin[i] + A[3 * i] * s[0] + A[3 * i + 1] * s[1] + A[3 * i + 2] * s[2];
    }
}

void se3di_drawing_to_ground(const double pose[SE3DI_POSE], const double local[3], double ground[3])
{
    double A[9];
    se3di_rotation_to_matrix(pose + 3, A);
    se3di_drawing_turn(pose, A, local, ground);
}

size_t se3di_drawing_find_body(const se3d_model *model, se3d_body body)
{
    const size_t usual = body.index1 - (size_t)1; /* they were made in this order */
    if (usual < model->body_count && model->bodies[usual].body.index1 == body.index1) {
        return usual;
    }
    for (size_t k = 0; k < model->body_count; ++k) {
        if (model->bodies[k].body.index1 == body.index1) {
            return k;
        }
    }
    return 0;
}

bool se3di_drawing_is_body(const se3d_model *model, size_t k, se3d_body body)
{
    return model->bodies[k].body.index1 == body.index1;
}

se3di_part se3di_part_make(const char *name, se3di_unit_shape unit, const double color[3])
{
    const se3di_part part = {.name = name,
                             .unit = unit,
                             .orientation = {1.0, 0.0, 0.0, 0.0},
                             .scale = {1.0, 1.0, 1.0},
                             .color = {color[0], color[1], color[2], 1.0}};
    return part;
}

void se3di_part_stretch(se3di_part *part, double a, double b, double c)
{
    part->scale[0] = a;
    part->scale[1] = b;
    part->scale[2] = c;
}

double se3di_part_turn(const double v[3], double p[4])
{
    const double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const double axis[3] = {-v[1], v[0], 0.0};
    const double side = sqrt(v[0] * v[0] + v[1] * v[1]);
    const double identity[4] = {v[2] < 0.0 ? 0.0 : 1.0, v[2] < 0.0 ? 1.0 : 0.0, 0.0, 0.0};
    if (side <= 1e-12 * length || !(length > 0.0)) {
        memcpy(p, identity, sizeof identity);
    } else {
        se3di_rotation_from_axis(axis, io_atan2(side, v[2]), p);
    }
    return length;
}

void se3di_part_span(se3di_part *part, const double a[3], const double b[3], double radius)
{
    double v[3];
    for (int i = 0; i < 3; ++i) {
        v[i] = b[i] - a[i];
        part->position[i] = 0.5 * (a[i] + b[i]);
    }
    se3di_part_stretch(part, radius, radius, se3di_part_turn(v, part->orientation));
}

void se3di_lister_add(se3di_lister *l, const se3di_part *part)
{
    se3di_parts *parts = l->parts;
    se3di_part *grown =
        se3di_iopool_grow(l->pool, parts->list, parts->count, &parts->capacity, sizeof *grown);
    if (!grown) {
        l->failed = true;
        return;
    }
    parts->list = grown;
    parts->list[parts->count] = *part;
    if (part->unit == SE3DI_UNIT_SPHERE && part->scale[0] < 3.0 * l->sizes->radius) {
        parts->list[parts->count].unit = SE3DI_UNIT_BALL;
    }
    ++parts->count;
}

/* The box in which a bar may end within a shape, in the shape's frame: on the axis of what is
 * round. @return false: the shape has no ends. */
static bool get_core(const se3di_shape_entry *entry, double low[3], double high[3], double *round)
{
    const se3d_model_shape *s = &entry->shape;
    const se3di_shape_row *row = se3di_shape_row_of(s);
    double half[3] = {0.0, 0.0, 0.0};
    *round = 0.0;
    if (!row->enclose && !entry->mesh) {
        return false;
    }
    if (row->enclose) {
        row->enclose(s, half);
    }
    for (int i = 0; i < 3; ++i) {
        low[i] = entry->mesh ? entry->mesh->low[i] : -half[i];
        high[i] = entry->mesh ? entry->mesh->high[i] : half[i];
    }
    if (s->type == SE3D_SHAPE_ELLIPSOID) { /* the largest box in it */
        for (int i = 0; i < 3; ++i) {
            low[i] *= sqrt(1.0 / 3.0);
            high[i] *= sqrt(1.0 / 3.0);
        }
    } else if (s->type != SE3D_SHAPE_BOX && !entry->mesh) {
        *round = s->radius;
        for (int i = 0; i < 3; ++i) {
            const double inner = i < 2 || s->type == SE3D_SHAPE_SPHERE ? 0.0 : 0.5 * s->length;
            low[i] = -inner;
            high[i] = inner;
        }
    }
    return true;
}

double se3di_shape_reach(const se3di_shape_entry *entry, const double at[3], double near[3])
{
    const se3d_model_shape *s = &entry->shape;
    double pose[SE3DI_POSE];
    double low[3];
    double high[3];
    double d[3];
    double local[3];
    double round = 0.0;
    double square = 0.0;
    memcpy(near, at, 3 * sizeof *near);
    if (!get_core(entry, low, high, &round)) {
        return HUGE_VAL;
    }
    for (int i = 0; i < 3; ++i) {
        d[i] = at[i] - s->position[i];
    }
    se3di_rotation_apply_inverse(s->orientation, d, local);
    for (int i = 0; i < 3; ++i) {
        const double nearest = fmin(high[i], fmax(low[i], local[i]));
        square += (local[i] - nearest) * (local[i] - nearest);
        local[i] = 0.5 * (low[i] + high[i]) + 0.9 * (nearest - 0.5 * (low[i] + high[i]));
    }
    memcpy(pose, s->position, 3 * sizeof *pose);
    memcpy(pose + 3, s->orientation, 4 * sizeof *pose);
    se3di_drawing_to_ground(pose, local, near);
    return fmax(0.0, sqrt(square) - round);
}
