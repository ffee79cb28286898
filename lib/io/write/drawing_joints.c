/* SPDX-License-Identifier: BSD-3-Clause */
/* Joints drawn as what they are: pins in eyes, balls, blocks on rails, crosses; and what springs,
 * dampers and rods between two bodies are drawn with. All sizes are multiples of the radius of a
 * pin. */
#include <math.h>
#include <string.h>

#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/keys.h"
#include "io/read/pairs.h"
#include "io/write/drawing_part.h"

/* Of light: steel that is dark, and bright; a coil. */
static const double dark[3] = {0.09, 0.10, 0.12};
static const double bright[3] = {0.50, 0.52, 0.55};
static const double coil[3] = {0.60, 0.33, 0.02};

static const char *get_type(const se3di_element_entry *entry)
{
    const se3di_node *type = entry->node ? se3di_node_get(entry->node, "type") : NULL;
    return type && type->text ? type->text : "";
}

#define LOOK(name, needs, look) {#name, SE3DI_JOINT_##look},
se3di_joint_look se3di_joint_get_look(const se3di_element_entry *entry)
{
    static const struct {
        const char *type;
        se3di_joint_look look;
    } looks[] = {SE3DI_TURNING_LIST(LOOK) SE3DI_DISTANCE_LIST(LOOK) SE3DI_PERPENDICULAR_LIST(LOOK)};
    const char *type = entry->drawn == 1 || entry->drawn == 2 ? get_type(entry) : "";
    for (size_t k = 0; k < sizeof looks / sizeof *looks; ++k) {
        if (strcmp(type, looks[k].type) == 0) {
            return looks[k].look;
        }
    }
    return SE3DI_JOINT_NONE;
}

/* A joint seen from one of its bodies. */
typedef struct side {
    se3di_lister *l;
    const se3di_element_entry *entry;
    const double *point, *axis; /* in the frame of the body */
    bool is_j;
    double unit[3]; /* along the axis; z if there is none */
    double r;       /* radius of a pin */
} side;

static side make_side(se3di_lister *l, const se3di_element_entry *entry, bool is_j)
{
    side s = {l,
              entry,
              is_j ? entry->point_j : entry->point_i,
              is_j ? entry->axis_j : entry->axis_i,
              is_j,
              {0.0, 0.0, 1.0},
              l->sizes->radius};
    const double *a = s.axis;
    const double length = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int i = 0; i < 3 && length > 0.0; ++i) {
        s.unit[i] = a[i] / length;
    }
    return s;
}

static void add_part(const side *s, se3di_part *part)
{
    part->name = s->is_j ? s->entry->name : "joint";
    part->element1 = (size_t)(s->entry - s->l->model->elements) + 1;
    se3di_lister_add(s->l, part);
}

/* A part at the joint with its z along the axis. */
static void add_at(const side *s, se3di_unit_shape unit, const double color[3], double wide,
                   double high)
{
    se3di_part part = se3di_part_make("", unit, color);
    memcpy(part.position, s->point, sizeof part.position);
    se3di_part_turn(s->unit, part.orientation);
    se3di_part_stretch(&part, wide, wide, high);
    add_part(s, &part);
}

/* Something round along the axis, from and to these distances from the joint. */
static void add_along(const side *s, se3di_unit_shape unit, const double color[3], double radius,
                      double from, double to)
{
    double a[3];
    double b[3];
    se3di_part bar = se3di_part_make("", unit, color);
    for (int i = 0; i < 3; ++i) {
        a[i] = s->point[i] + from * s->unit[i];
        b[i] = s->point[i] + to * s->unit[i];
    }
    se3di_part_span(&bar, a, b, radius);
    add_part(s, &bar);
}

static void widen(double at, double range[2])
{
    range[0] = fmin(range[0], at);
    range[1] = fmax(range[1], at);
}

/* How far point j goes along the axis of body i. */
static void find_travel(const side *s, double range[2])
{
    const se3d_model *model = s->l->model;
    const se3di_poses *poses = s->l->poses;
    const size_t i = se3di_drawing_find_body(model, s->entry->body_i);
    const size_t j = se3di_drawing_find_body(model, s->entry->body_j);
    range[0] = -4.0 * s->r;
    range[1] = 4.0 * s->r;
    for (size_t k = 0; k < poses->count; k += 1 + poses->count / 256) {
        const double *at = poses->values + k * poses->bodies * SE3DI_POSE;
        double point[3];
        double local[3];
        double along = 0.0;
        se3di_drawing_to_ground(at + SE3DI_POSE * j, s->entry->point_j, point);
        for (int c = 0; c < 3; ++c) {
            point[c] -= at[SE3DI_POSE * i + (size_t)c];
        }
        se3di_rotation_apply_inverse(at + SE3DI_POSE * i + 3, point, local);
        for (int c = 0; c < 3; ++c) {
            along += (local[c] - s->point[c]) * s->unit[c];
        }
        widen(along - 4.0 * s->r, range);
        widen(along + 4.0 * s->r, range);
    }
}

/* Markers of the body that lie on the axis: the pin goes through them, as through the two eyes of
 * an arm. */
static void find_eyes(const side *s, double range[2])
{
    const se3d_model *model = s->l->model;
    for (size_t m = 0; m < model->marker_count; ++m) {
        double d[3];
        double along = 0.0;
        double off = 0.0;
        if (model->markers[m].body != s->l->body) {
            continue;
        }
        for (int i = 0; i < 3; ++i) {
            d[i] = model->markers[m].position[i] - s->point[i];
            along += d[i] * s->unit[i];
        }
        for (int i = 0; i < 3; ++i) {
            off = fmax(off, fabs(d[i] - along * s->unit[i]));
        }
        if (off <= 0.3 * s->r) {
            widen(along - 2.0 * s->r, range);
            widen(along + 2.0 * s->r, range);
        }
    }
}

/* The places where the axis leaves the shapes of the body: a pin is seen at their sides, unless
 * they are far. */
static void find_ends(const side *s, double range[2])
{
    const se3d_model *model = s->l->model;
    for (size_t k = 0; k < model->shape_count; ++k) {
        const se3di_shape_entry *entry = &model->shapes[k];
        double near[3];
        if (!se3di_drawing_is_body(model, s->l->body, entry->shape.body) ||
            se3di_shape_reach(entry, s->point, near) > 0.0) {
            continue;
        }
        for (int end = -1; end <= 1; end += 2) {
            double at[3];
            double out = 0.0;
            do {
                out += s->r;
                for (int i = 0; i < 3; ++i) {
                    at[i] = s->point[i] + end * out * s->unit[i];
                }
            } while (se3di_shape_reach(entry, at, near) <= 0.0 && out < 12.0 * s->r);
            if (out < 12.0 * s->r) {
                widen(end * (out + s->r), range);
            }
        }
    }
}

static void add_pin(const side *s, double radius)
{
    double range[2] = {-3.0 * s->r, 3.0 * s->r};
    find_eyes(s, range);
    find_ends(s, range);
    add_along(s, SE3DI_UNIT_CYLINDER, dark, radius, range[0], range[1]);
}

static void add_plate(const side *s)
{
    se3di_part plate = se3di_part_make("", SE3DI_UNIT_BOX, s->l->usual);
    memcpy(plate.position, s->point, sizeof plate.position);
    se3di_part_turn(s->unit, plate.orientation);
    se3di_part_stretch(&plate, 16.0 * s->r, 16.0 * s->r, 0.2 * s->r);
    plate.color[3] = 0.4;
    add_part(s, &plate);
}

/* What body j has of the joint. */
static void add_moving(const side *s, se3di_joint_look look)
{
    const double r = s->r;
    switch (look) {
    case SE3DI_JOINT_BLOCK:
        add_at(s, SE3DI_UNIT_BOX, dark, 2.6 * r, 2.6 * r);
        break;
    case SE3DI_JOINT_PIN:
        add_pin(s, r);
        break;
    case SE3DI_JOINT_SLIDER:
        add_at(s, SE3DI_UNIT_BOX, dark, 3.4 * r, 5.0 * r);
        break;
    case SE3DI_JOINT_SLEEVE:
    case SE3DI_JOINT_SCREW:
        add_at(s, SE3DI_UNIT_CYLINDER, dark, 1.7 * r, 5.0 * r);
        break;
    case SE3DI_JOINT_CROSS:
        add_pin(s, 0.8 * r);
        break;
    case SE3DI_JOINT_PLATE:
        add_at(s, SE3DI_UNIT_CYLINDER, dark, 3.0 * r, 1.2 * r);
        break;
    default: /* a ball */
        add_at(s, SE3DI_UNIT_SPHERE, dark, 1.6 * r, 1.6 * r);
        break;
    }
}

/* What body i has of it. */
static void add_still(const side *s, se3di_joint_look look)
{
    const double r = s->r;
    double range[2];
    switch (look) {
    case SE3DI_JOINT_PIN: /* an eye */
        add_at(s, SE3DI_UNIT_CYLINDER, s->l->usual, 1.7 * r, 2.4 * r);
        break;
    case SE3DI_JOINT_SLIDER:
    case SE3DI_JOINT_SLEEVE:
    case SE3DI_JOINT_ON_LINE:
        find_travel(s, range);
        add_along(s, SE3DI_UNIT_CYLINDER, bright, 0.8 * r, range[0], range[1]);
        break;
    case SE3DI_JOINT_SCREW:
        find_travel(s, range);
        add_along(s, SE3DI_UNIT_CYLINDER, bright, 0.7 * r, range[0], range[1]);
        add_along(s, SE3DI_UNIT_SPRING, bright, 0.9 * r, range[0], range[1]);
        break;
    case SE3DI_JOINT_CROSS:
        add_pin(s, 0.8 * r);
        break;
    case SE3DI_JOINT_PLATE:
    case SE3DI_JOINT_ON_PLANE:
        add_plate(s);
        break;
    default:
        break;
    }
}

/* A foot under a joint on the ground, unless a shape of the ground is there. */
static void add_foot(const side *s)
{
    static const double upright[3] = {0.0, 0.0, 1.0};
    const se3d_model *model = s->l->model;
    const double r = s->r;
    double near[3];
    for (size_t k = 0; k < model->shape_count; ++k) {
        if (se3di_drawing_is_body(model, 0, model->shapes[k].shape.body) &&
            se3di_shape_reach(&model->shapes[k], s->point, near) < 4.0 * r) {
            return;
        }
    }
    se3di_part cone = se3di_part_make("foot", SE3DI_UNIT_CONE, s->l->usual);
    se3di_part plate = se3di_part_make("foot", SE3DI_UNIT_BOX, s->l->usual);
    memcpy(cone.position, s->point, sizeof cone.position);
    memcpy(plate.position, s->point, sizeof plate.position);
    se3di_part_turn(upright, cone.orientation);
    cone.position[2] -= 2.0 * r;
    plate.position[2] -= 4.2 * r;
    se3di_part_stretch(&cone, 2.0 * r, 2.0 * r, 4.0 * r);
    se3di_part_stretch(&plate, 7.0 * r, 7.0 * r, 0.5 * r);
    se3di_lister_add(s->l, &cone);
    se3di_lister_add(s->l, &plate);
}

void se3di_lister_add_joints(se3di_lister *l)
{
    const se3d_model *model = l->model;
    for (size_t e = 0; e < model->element_count; ++e) {
        const se3di_element_entry *entry = &model->elements[e];
        const bool is_i = se3di_drawing_is_body(model, l->body, entry->body_i);
        const bool is_j = se3di_drawing_is_body(model, l->body, entry->body_j);
        if (!is_i && !is_j) {
            continue; /* the look is read from its text */
        }
        const se3di_joint_look look = se3di_joint_get_look(entry);
        if (look == SE3DI_JOINT_NONE && se3di_drawing_count_between(entry) == 0) {
            continue;
        }
        const side here = make_side(l, entry, is_j);
        if (is_j && look != SE3DI_JOINT_NONE) {
            add_moving(&here, look);
        }
        if (is_i && !is_j) {
            add_still(&here, look);
        }
        if ((is_i || is_j) && l->body == 0) {
            add_foot(&here);
        }
    }
}

/* Whether what the element does between its points is a spring's, a damper's, or a rod's. */
static bool is_spring(const se3di_element_entry *entry)
{
    return entry->drawn == 3 &&
           (se3di_node_get(entry->node, "k") || se3di_node_get(entry->node, "spring"));
}

static bool is_rod(const se3di_element_entry *entry)
{
    return entry->drawn != 3 && entry->drawn > 0 &&
           se3di_keys_contain(" distance revolute_spherical revolute_cylindrical ",
                              get_type(entry));
}

static bool is_damper(const se3di_element_entry *entry)
{
    return entry->drawn == 3 && (!is_spring(entry) || se3di_node_get(entry->node, "c") ||
                                 se3di_node_get(entry->node, "damper"));
}

size_t se3di_drawing_count_between(const se3di_element_entry *entry)
{
    return is_rod(entry) ? 1 : (size_t)is_spring(entry) + 2 * (size_t)is_damper(entry);
}

/* The coil comes first, then the tube of a damper and its rod. */
se3di_part se3di_drawing_get_between(const se3d_model *model, size_t element, size_t which,
                                     const se3di_sizes *sizes, const double *poses)
{
    const se3di_element_entry *entry = &model->elements[element];
    const size_t i = se3di_drawing_find_body(model, entry->body_i);
    const size_t j = se3di_drawing_find_body(model, entry->body_j);
    const bool rod = is_rod(entry);
    const size_t what = which + (is_spring(entry) ? 0 : 1); /* coil, tube, rod of a damper */
    const double *color = rod || what == 1 ? dark : what == 0 ? coil : bright;
    const double radius = (rod ? 0.7 : what == 0 ? 2.6 : what == 1 ? 1.3 : 0.6) * sizes->radius;
    const double from = !rod && what == 2 ? 0.5 : 0.0;
    const double to = !rod && what == 1 ? 0.55 : 1.0;
    se3di_part part =
        se3di_part_make(which == 0 ? entry->name : "damper",
                        !rod && what == 0 ? SE3DI_UNIT_SPRING : SE3DI_UNIT_CYLINDER, color);
    double a[3];
    double b[3];
    double p[3];
    double q[3];
    se3di_drawing_to_ground(poses + SE3DI_POSE * i, entry->point_i, a);
    se3di_drawing_to_ground(poses + SE3DI_POSE * j, entry->point_j, b);
    for (int c = 0; c < 3; ++c) {
        p[c] = a[c] + from * (b[c] - a[c]);
        q[c] = a[c] + to * (b[c] - a[c]);
    }
    se3di_part_span(&part, p, q, radius);
    part.element1 = element + 1;
    return part;
}
