/* SPDX-License-Identifier: BSD-3-Clause */
/* The parts that bodies are drawn with. */
#include "io/write/drawing.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/base/elementary.h"
#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/model/model.h"
#include "io/read/shape_kinds.h"
#include "io/write/drawing_part.h"
#include "io/write/unit_mesh.h"

/* Colours that people with colour blindness can tell apart, also in print: M. Okabe and K. Ito,
 * Color Universal Design, 2008. Values in sRGB. */
static const double palette[][3] = {{0.00, 0.45, 0.70}, {0.84, 0.37, 0.00}, {0.00, 0.62, 0.45},
                                    {0.90, 0.62, 0.00}, {0.80, 0.47, 0.65}, {0.34, 0.71, 0.91},
                                    {0.94, 0.89, 0.26}};
static const double ground_color[3] = {0.55, 0.58, 0.62};

se3d_status se3di_drawing_get_poses(const se3d_model *model, double *pose)
{
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < model->body_count && status >= 0; ++k, pose += SE3DI_POSE) {
        se3d_body_motion motion;
        status = se3d_body_get_motion(model->system, model->bodies[k].body, &motion);
        if (status >= 0) {
            memcpy(pose, motion.r, sizeof motion.r);
            memcpy(pose + 3, motion.p, sizeof motion.p);
        }
    }
    return status;
}

static void widen(const double at[3], double low[3], double high[3])
{
    for (int i = 0; i < 3; ++i) {
        low[i] = at[i] < low[i] ? at[i] : low[i];
        high[i] = at[i] > high[i] ? at[i] : high[i];
    }
}

typedef struct box {
    double low[3];
    double high[3];
} box;

/* The corners of a shape's own box, in the frame of its body; returns whether it has one. */
static bool find_corners(const se3di_shape_entry *entry, double corners[8][3])
{
    const se3d_model_shape *s = &entry->shape;
    const se3di_shape_row *row = se3di_shape_row_of(s);
    double half[3] = {0.0, 0.0, 0.0};
    double on_body[9];
    if (!row->enclose && !entry->mesh) {
        return false;
    }
    if (row->enclose) {
        row->enclose(s, half);
    }
    se3di_rotation_to_matrix(s->orientation, on_body);
    for (int k = 0; k < 8; ++k) {
        double corner[3];
        for (int i = 0; i < 3; ++i) {
            const double low = entry->mesh ? entry->mesh->low[i] : -half[i];
            corner[i] = !(k & 1 << i) ? low : entry->mesh ? entry->mesh->high[i] : half[i];
        }
        se3di_drawing_turn(s->position, on_body, corner, corners[k]);
    }
    return true;
}

/* Of the samples of a motion every so many are measured. */
static size_t stride_of(const se3di_poses *poses)
{
    return 1 + poses->count / 64;
}

/* The box around a shape's own box at these times, in the ground frame. */
static void widen_shape(const se3d_model *model, const se3di_shape_entry *entry,
                        const se3di_poses *poses, box *b)
{
    const size_t body = se3di_drawing_find_body(model, entry->shape.body);
    double corners[8][3];
    if (!find_corners(entry, corners)) {
        return;
    }
    for (size_t s = 0; s < poses->count; s += stride_of(poses)) {
        const double *pose = poses->values + (s * poses->bodies + body) * SE3DI_POSE;
        double on_ground[9], at[3];
        se3di_rotation_to_matrix(pose + 3, on_ground);
        for (int k = 0; k < 8; ++k) {
            se3di_drawing_turn(pose, on_ground, corners[k], at);
            widen(at, b->low, b->high);
        }
    }
}

/* The box around all but shapes at one time. */
static void widen_all(const se3d_model *model, const double *poses, box *b)
{
    double at[3];
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        if (entry->drawn > 0) {
            const size_t i = se3di_drawing_find_body(model, entry->body_i);
            const size_t j = se3di_drawing_find_body(model, entry->body_j);
            se3di_drawing_to_ground(poses + SE3DI_POSE * i, entry->point_i, at);
            widen(at, b->low, b->high);
            se3di_drawing_to_ground(poses + SE3DI_POSE * j, entry->point_j, at);
            widen(at, b->low, b->high);
        }
    }
    for (size_t k = 0; k < model->body_count; ++k) {
        widen(poses + SE3DI_POSE * k, b->low, b->high);
    }
}

static int compare_numbers(const void *a, const void *b)
{
    const double x = *(const double *)a;
    const double y = *(const double *)b;
    return (x > y) - (x < y);
}

enum { PLACES_MOST = 200 };

/* The radius of a pin: a fraction of the usual distance of joints at the first sample. */
static double choose_radius(const se3d_model *model, const double *poses, double extent)
{
    double places[PLACES_MOST][3];
    double next[PLACES_MOST];
    size_t n = 0;
    size_t found = 0;
    for (size_t e = 0; e < model->element_count && n < PLACES_MOST; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        if (entry->drawn > 0) {
            const size_t j = se3di_drawing_find_body(model, entry->body_j);
            se3di_drawing_to_ground(poses + SE3DI_POSE * j, entry->point_j, places[n++]);
        }
    }
    for (size_t a = 0; a < n; ++a) {
        double least = HUGE_VAL;
        for (size_t b = 0; b < n; ++b) {
            const double *p = places[a];
            const double *q = places[b];
            const double d = sqrt((p[0] - q[0]) * (p[0] - q[0]) + (p[1] - q[1]) * (p[1] - q[1]) +
                                  (p[2] - q[2]) * (p[2] - q[2]));
            least = d > 1e-6 * extent && d < least ? d : least;
        }
        next[found] = least;
        found += least < HUGE_VAL;
    }
    if (found == 0) {
        return 0.02 * extent;
    }
    qsort(next, found, sizeof *next, compare_numbers);
    return fmin(0.02 * extent, fmax(0.006 * extent, 0.12 * next[found / 2]));
}

/* Whether a joint or spring holds it to the ground. */
static bool is_grounded(const se3d_model *model)
{
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        if (entry->drawn > 0 && (se3di_drawing_is_body(model, 0, entry->body_i) ||
                                 se3di_drawing_is_body(model, 0, entry->body_j))) {
            return true;
        }
    }
    return false;
}

/* Half of the diagonal. */
static double get_extent(const box *b)
{
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
        sum += (b->high[i] - b->low[i]) * (b->high[i] - b->low[i]);
    }
    return 0.5 * sqrt(sum);
}

void se3di_drawing_measure(const se3d_model *model, const se3di_poses *poses, se3di_sizes *sizes)
{
    box b = {{0.0, 0.0, 0.0}, {0.0, 0.0, 0.0}};
    double own = 0.0; /* the largest at one time */
    const bool is_vehicle = model->body_count > 2 && !is_grounded(model);
    for (size_t k = 0; k < model->shape_count; ++k) {
        widen_shape(model, &model->shapes[k], poses, &b);
    }
    for (size_t s = 0; s < poses->count; s += stride_of(poses)) {
        box now = {{HUGE_VAL, HUGE_VAL, HUGE_VAL}, {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
        const double *at = poses->values + s * poses->bodies * SE3DI_POSE;
        widen_all(model, at, &b);
        for (size_t k = 1; k < model->body_count; ++k) {
            widen(at + SE3DI_POSE * k, now.low, now.high);
        }
        own = is_vehicle ? fmax(own, get_extent(&now)) : own;
    }
    const double extent = get_extent(&b);
    sizes->floor = b.low[2] - 0.1 * extent;
    sizes->extent = extent > 1e-9 ? extent : 1.0;
    /* The joints of a vehicle do not grow with the distance that it travels. */
    const double near = own > 1e-9 ? fmin(sizes->extent, 2.5 * own) : sizes->extent;
    sizes->radius = choose_radius(model, poses->values, near);
}

/* From sRGB (IEC 61966-2-1) to the linear colours of glTF. */
static double to_light(double c)
{
    return c <= 0.04045 ? c / 12.92 : io_pow((c + 0.055) / 1.055, 2.4);
}

static void add_looks(se3di_lister *l, const se3d_model_shape *s, se3di_part part)
{
    static const se3di_unit_shape units[] = {[SE3DI_LOOK_BOX] = SE3DI_UNIT_BOX,
                                             [SE3DI_LOOK_SPHERE] = SE3DI_UNIT_SPHERE,
                                             [SE3DI_LOOK_CYLINDER] = SE3DI_UNIT_CYLINDER};
    se3di_look looks[SE3DI_LOOKS];
    double A[9];
    const double opacity = part.color[3];
    const int count = se3di_shape_row_of(s)->draw(s, l->sizes->extent, looks);
    se3di_rotation_to_matrix(s->orientation, A);
    for (int k = 0; k < count; ++k) {
        const se3di_look *look = &looks[k];
        part.unit = units[look->unit];
        se3di_part_stretch(&part, look->scale[0], look->scale[1], look->scale[2]);
        part.color[3] = opacity * look->opacity;
        for (int i = 0; i < 3 && fabs(look->z) > 0.0; ++i) {
            part.position[i] = s->position[i] + look->z * A[3 * i + 2];
        }
        se3di_lister_add(l, &part);
    }
}

void se3di_lister_add_shape(se3di_lister *l, const se3di_shape_entry *entry)
{
    const se3d_model_shape *s = &entry->shape;
    double color[3];
    for (int i = 0; i < 3; ++i) { /* a plane is large: it has no colour of a body */
        const double usual = s->type == SE3D_SHAPE_PLANE ? to_light(ground_color[i]) : l->usual[i];
        color[i] = s->color[0] < 0.0 ? usual : to_light(s->color[i]);
    }
    se3di_part part = se3di_part_make("shape", SE3DI_UNIT_BOX, color);
    memcpy(part.position, s->position, sizeof part.position);
    memcpy(part.orientation, s->orientation, sizeof part.orientation);
    part.style = entry->style;
    part.color[3] = entry->opacity * (entry->style == SE3DI_STYLE_GLASS ? 0.3 : 1.0);
    if (entry->mesh) {
        part.mesh = entry->mesh;
        se3di_lister_add(l, &part);
    } else {
        add_looks(l, s, part);
    }
}

bool se3di_drawing_list(const se3d_model *model, size_t k, const se3di_sizes *sizes,
                        const se3di_poses *poses, se3di_iopool *pool, se3di_parts *parts)
{
    se3di_lister l = {model, pool, parts, sizes, poses, k, {0.0, 0.0, 0.0}, false, false};
    bool bare = k > 0;
    int32_t fixed = k == 0;
    if (k > 0) {
        (void)se3d_body_get_fixed(model->system, model->bodies[k].body, &fixed);
    }
    const double *color = fixed ? ground_color : palette[(k - 1) % 7];
    for (int i = 0; i < 3; ++i) {
        l.usual[i] = to_light(color[i]);
    }
    for (size_t s = 0; s < model->shape_count; ++s) {
        if (se3di_drawing_is_body(model, k, model->shapes[s].shape.body)) {
            se3di_lister_add_shape(&l, &model->shapes[s]);
            bare = false;
        }
    }
    se3di_lister_add_joints(&l);
    se3di_lister_add_gears(&l);
    se3di_lister_add_roads(&l);
    if (k > 0) {
        se3di_lister_add_links(&l, bare);
    }
    return !l.failed;
}
