/* SPDX-License-Identifier: BSD-3-Clause */
/* The parts that bodies are drawn with. */
#include "io/write/drawing.h"

#include <math.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/model/model.h"
#include "io/read/shape_kinds.h"
#include "io/write/unit_mesh.h"

static const double palette[][3] = {{0.20, 0.47, 0.72}, {0.85, 0.37, 0.27}, {0.25, 0.60, 0.42},
                                    {0.90, 0.62, 0.20}, {0.52, 0.38, 0.70}, {0.20, 0.62, 0.68},
                                    {0.60, 0.44, 0.32}};

se3d_status se3di_drawing_get_poses(const se3d_model *model, double *pose)
{
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < model->body_count && status >= 0; ++k, pose += SE3DI_POSE) {
        const se3d_body body = model->bodies[k].body;
        status = se3d_body_get_position(model->system, body, pose);
        if (status >= 0) {
            status = se3d_body_get_orientation(model->system, body, pose + 3);
        }
    }
    return status;
}

void se3di_drawing_to_ground(const double pose[SE3DI_POSE], const double local[3], double ground[3])
{
    double A[9];
    const double s[3] = {local[0], local[1], local[2]}; /* ground may be local */
    se3di_rotation_to_matrix(pose + 3, A);
    for (int i = 0; i < 3; ++i) {
        ground[i] = pose[i] + A[3 * i] * s[0] + A[3 * i + 1] * s[1] + A[3 * i + 2] * s[2];
    }
}

/* The index of a body's entry. */
static size_t find_body(const se3d_model *model, se3d_body body)
{
    for (size_t k = 0; k < model->body_count; ++k) {
        if (model->bodies[k].body.index1 == body.index1) {
            return k;
        }
    }
    return 0;
}

static void widen(const double at[3], double low[3], double high[3])
{
    for (int i = 0; i < 3; ++i) {
        low[i] = fmin(low[i], at[i]);
        high[i] = fmax(high[i], at[i]);
    }
}

typedef struct box {
    double low[3];
    double high[3];
} box;

/* The box around a shape's own box, in the ground frame. */
static void widen_shape(const se3di_shape_entry *entry, const double *pose, box *b)
{
    const se3d_model_shape *s = &entry->shape;
    const se3di_shape_row *row = se3di_shape_row_of(s);
    double half[3] = {0.0, 0.0, 0.0};
    double turned[SE3DI_POSE];
    memcpy(turned, s->position, 3 * sizeof *turned);
    memcpy(turned + 3, s->orientation, 4 * sizeof *turned);
    if (!row->enclose && !entry->mesh) {
        return;
    }
    if (row->enclose) {
        row->enclose(s, half);
    }
    for (int k = 0; k < 8; ++k) {
        double at[3];
        double corner[3];
        for (int i = 0; i < 3; ++i) {
            const double low = entry->mesh ? entry->mesh->low[i] : -half[i];
            corner[i] = !(k & 1 << i) ? low : entry->mesh ? entry->mesh->high[i] : half[i];
        }
        se3di_drawing_to_ground(turned, corner, at);
        se3di_drawing_to_ground(pose, at, at);
        widen(at, b->low, b->high);
    }
}

/* The box around all at one time. */
static void widen_all(const se3d_model *model, const double *poses, box *b)
{
    double at[3];
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        if (entry->drawn > 0) {
            const size_t i = find_body(model, entry->body_i);
            const size_t j = find_body(model, entry->body_j);
            se3di_drawing_to_ground(poses + SE3DI_POSE * i, entry->point_i, at);
            widen(at, b->low, b->high);
            se3di_drawing_to_ground(poses + SE3DI_POSE * j, entry->point_j, at);
            widen(at, b->low, b->high);
        }
    }
    for (size_t k = 0; k < model->body_count; ++k) {
        widen(poses + SE3DI_POSE * k, b->low, b->high);
    }
    for (size_t k = 0; k < model->shape_count; ++k) {
        const size_t body = find_body(model, model->shapes[k].shape.body);
        widen_shape(&model->shapes[k], poses + SE3DI_POSE * body, b);
    }
}

/* Half the diagonal of the box around all points. */
double se3di_drawing_measure(const se3d_model *model, const se3di_poses *poses, double *floor)
{
    box b = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    double sum = 0.0;
    for (size_t s = 0; s < poses->count; s += 1 + poses->count / 64) {
        widen_all(model, poses->values + s * poses->bodies * SE3DI_POSE, &b);
    }
    for (int i = 0; i < 3; ++i) {
        sum += (b.high[i] - b.low[i]) * (b.high[i] - b.low[i]);
    }
    const double extent = 0.5 * sqrt(sum);
    *floor = b.low[2] - 0.1 * extent;
    return extent > 1e-9 ? extent : 1.0;
}

static se3di_part make_part(const char *name, se3di_unit unit, const double color[3])
{
    const se3di_part part = {.name = name,
                             .unit = unit,
                             .orientation = {1.0, 0.0, 0.0, 0.0},
                             .scale = {1.0, 1.0, 1.0},
                             .color = {color[0], color[1], color[2], 1.0}};
    return part;
}

static void stretch(se3di_part *part, double a, double b, double c)
{
    part->scale[0] = a;
    part->scale[1] = b;
    part->scale[2] = c;
}

/* A turn from z to `v`. @return |v|. */
static double turn_to(const double v[3], double p[4])
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

/* Turn and stretch a part along z from `a` to `b`. */
static void span(se3di_part *part, const double a[3], const double b[3], double radius)
{
    double v[3];
    for (int i = 0; i < 3; ++i) {
        v[i] = b[i] - a[i];
        part->position[i] = 0.5 * (a[i] + b[i]);
    }
    stretch(part, radius, radius, turn_to(v, part->orientation));
}

typedef struct lister {
    const se3d_model *model;
    se3di_iopool *pool;
    se3di_parts *parts;
    double extent;
    const double *usual; /* colour of the body */
    bool failed;
} lister;

static void add(lister *l, const se3di_part *part)
{
    se3di_parts *parts = l->parts;
    se3di_part *grown =
        se3di_iopool_grow(l->pool, parts->list, parts->count, &parts->capacity, sizeof *grown);
    if (!grown) {
        l->failed = true;
        return;
    }
    parts->list = grown;
    parts->list[parts->count++] = *part;
}

static void add_looks(lister *l, const se3d_model_shape *s, se3di_part part)
{
    static const se3di_unit units[] = {[SE3DI_LOOK_BOX] = SE3DI_UNIT_BOX,
                                       [SE3DI_LOOK_SPHERE] = SE3DI_UNIT_SPHERE,
                                       [SE3DI_LOOK_CYLINDER] = SE3DI_UNIT_CYLINDER};
    se3di_look looks[SE3DI_LOOKS];
    double A[9];
    const int count = se3di_shape_row_of(s)->draw(s, l->extent, looks);
    se3di_rotation_to_matrix(s->orientation, A);
    for (int k = 0; k < count; ++k) {
        const se3di_look *look = &looks[k];
        part.unit = units[look->unit];
        stretch(&part, look->scale[0], look->scale[1], look->scale[2]);
        part.color[3] = look->opacity;
        for (int i = 0; i < 3 && fabs(look->z) > 0.0; ++i) {
            part.position[i] = s->position[i] + look->z * A[3 * i + 2];
        }
        add(l, &part);
    }
}

static void add_shape(lister *l, const se3di_shape_entry *entry)
{
    const se3d_model_shape *s = &entry->shape;
    se3di_part part = make_part("shape", SE3DI_UNIT_BOX, s->color[0] < 0.0 ? l->usual : s->color);
    memcpy(part.position, s->position, sizeof part.position);
    memcpy(part.orientation, s->orientation, sizeof part.orientation);
    if (entry->mesh) {
        part.mesh = entry->mesh;
        add(l, &part);
    } else {
        add_looks(l, s, part);
    }
}

/* Joints at body `k`: as body j they carry the joint's name and axis; without shapes the body is
 * drawn as bars from its origin to its joints. */
static void add_joints(lister *l, size_t k, bool bare)
{
    static const double origin[3] = {0.0, 0.0, 0.0};
    static const double pin_color[3] = {0.35, 0.37, 0.40};
    const se3d_model *model = l->model;
    const double r = 0.02 * l->extent;
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        const bool is_j = entry->drawn > 0 && find_body(model, entry->body_j) == k;
        const bool is_i = entry->drawn > 0 && find_body(model, entry->body_i) == k;
        if (!is_i && !is_j) {
            continue;
        }
        const double *point = is_j ? entry->point_j : entry->point_i;
        se3di_part bar = make_part("link", SE3DI_UNIT_CYLINDER, l->usual);
        span(&bar, origin, point, 0.8 * r);
        if (bare && bar.scale[2] > 1e-9 * l->extent) {
            add(l, &bar);
        }
        if (is_j && entry->drawn < 3) {
            const bool axis = entry->drawn == 2;
            se3di_part pin =
                make_part(entry->name, axis ? SE3DI_UNIT_CYLINDER : SE3DI_UNIT_SPHERE, pin_color);
            memcpy(pin.position, point, sizeof pin.position);
            stretch(&pin, r, r, axis ? 6.0 * r : r);
            if (axis) {
                turn_to(entry->axis_j, pin.orientation);
            }
            add(l, &pin);
        }
    }
}

bool se3di_drawing_list(const se3d_model *model, size_t k, double extent, se3di_iopool *pool,
                        se3di_parts *parts)
{
    lister l = {model, pool, parts, extent, palette[(k + 6) % 7], false};
    bool bare = k > 0;
    for (size_t s = 0; s < model->shape_count; ++s) {
        if (find_body(model, model->shapes[s].shape.body) == k) {
            add_shape(&l, &model->shapes[s]);
            bare = false;
        }
    }
    add_joints(&l, k, bare);
    if (bare) {
        const double r = 0.04 * extent;
        se3di_part ball = make_part("center", SE3DI_UNIT_SPHERE, l.usual);
        stretch(&ball, r, r, r);
        add(&l, &ball);
    }
    return !l.failed;
}

se3di_part se3di_drawing_get_spring(const se3d_model *model, const se3di_element_entry *spring,
                                    double extent, const double *poses)
{
    static const double color[3] = {0.75, 0.55, 0.10};
    const size_t i = find_body(model, spring->body_i);
    const size_t j = find_body(model, spring->body_j);
    se3di_part part = make_part(spring->name, SE3DI_UNIT_SPRING, color);
    double a[3];
    double b[3];
    se3di_drawing_to_ground(poses + SE3DI_POSE * i, spring->point_i, a);
    se3di_drawing_to_ground(poses + SE3DI_POSE * j, spring->point_j, b);
    span(&part, a, b, 0.05 * extent);
    return part;
}
