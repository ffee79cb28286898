/* SPDX-License-Identifier: BSD-3-Clause */
/* `wheels`: places on uprights that measure a suspension. */
#include <math.h>
#include <string.h>

#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/guess.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/model/model.h"
#include "io/read/bodies.h"
#include "io/read/elements.h"
#include "io/read/entries.h"
#include "io/read/objects.h"
#include "io/read/sections.h"
#include "math/vec3.h"

static const char *const frames[] = {"ground", "body", NULL};

/* clang-format off */
static const se3di_key wheel_keys[] = {
    {"name", SE3DI_KIND_NAME, .standard = "wheel1, wheel2, ...",
     .text = "unique among joints, drivers, constraints, forces and wheels"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"body", SE3DI_KIND_BODY, .required = true, .text = "that carries it: the upright"},
    {"chassis", SE3DI_KIND_BODY, .required = true,
     .text = "to which it moves; the given poses count as zero travel"},
    {"point", SE3DI_KIND_POINT, .text = "wheel centre, frame of the body [m]"},
    {"at", SE3DI_KIND_VECTOR,
     .text = "in place of point: at the given pose, ground frame [m]"},
    {"axis", SE3DI_KIND_DIRECTION, .standard = "[0, 1, 0]",
     .text = "spin axis out of the vehicle, to the left on a left wheel, ground frame"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_wheel_def, radius),
     .required = true, .text = "from the centre to the road [m]"},
    {"width", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE, SE3DI_INTO(se3d_wheel_def, width),
     .standard = "0", .text = "of the tread [m]"},
    {"frame", SE3DI_KIND_WORD, .words = frames, .standard = "ground",
     .text = "of axis, forward, up, lower and upper; body: that of the body, forward and up that "
         "of the chassis"},
    {"forward", SE3DI_KIND_DIRECTION, .standard = "[1, 0, 0]",
     .text = "of the vehicle, ground frame"},
    {"up", SE3DI_KIND_DIRECTION, .standard = "[0, 0, 1]",
     .text = "of the vehicle, and normal of the road, ground frame"},
    {"lower", SE3DI_KIND_VECTOR,
     .text = "a point of the steer axis at the given pose, ground frame [m]; without lower and "
         "upper it is found from the motion"},
    {"upper", SE3DI_KIND_VECTOR, .text = "another one [m]"},
    {"travel", SE3DI_KIND_TEXT, .standard = "what holds the body to the ground by one equation",
     .text = "the constraint or driver that lifts the wheel, which derivatives by travel let go"},
    {"steering", SE3DI_KIND_TEXT,
     .text = "the constraint or driver that steers, which the search of a steer axis lets go"},
    {"spring", SE3DI_KIND_TEXT, .text = "a tsda, for the motion ratio"},
    {"opposite", SE3DI_KIND_TEXT, .standard = "the one across the vehicle",
     .text = "the other wheel of the axle"},
    {"wheelbase", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_wheel_def, wheelbase),
     .text = "for ackermann_error and the anti-features [m]"},
    {"cg_height", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_wheel_def, cg_height),
     .text = "of the vehicle's mass above the road, for the anti-features [m]"},
    {"brake_share", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_wheel_def, brake_share), .standard = "0",
     .text = "of the braking force at this axle, 0 to 1"},
    {"drive_share", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_wheel_def, drive_share), .standard = "0",
     .text = "of the driving force at this axle, 0 to 1"},
    {.key = NULL}};
const se3di_object se3di_object_wheel = {
    "wheel",
    "A wheel, which measures its suspension.",
    wheel_keys, NULL,
    NULL};
/* clang-format on */

/* The element whose name stands under `key`, of one of the kinds in a mask; NULL: nothing does. */
static bool read_key_element(se3di_reader *reader, const se3di_node *map, const char *key,
                             unsigned kinds, const se3di_element_entry **found)
{
    const se3d_model *model = reader->model;
    const se3di_node *node = se3di_node_get(map, key);
    const char *name = NULL;
    size_t index = 0;
    *found = NULL;
    if (!node) {
        return true;
    }
    if (!se3di_read_reference(reader, node, &name)) {
        return false;
    }
    if (se3di_reader_find(reader, &model->element_names, name, &index) &&
        (kinds >> model->elements[index].kind & 1U) != 0) {
        *found = &model->elements[index];
        return true;
    }
    se3di_guess guess = se3di_guess_begin(name);
    for (size_t k = 0; k < model->element_count; ++k) {
        if ((kinds >> model->elements[k].kind & 1U) != 0) {
            se3di_guess_offer(&guess, model->elements[k].name);
        }
    }
    const char *meant = se3di_guess_get(&guess);
    se3di_reader_fail(reader, node, "nothing that can be the %s is named `%.60s`%s%s%s", key, name,
                      meant ? ", did you mean `" : "", meant ? meant : "", meant ? "`?" : "");
    return se3di_reader_propose(reader, meant);
}

static bool read_relations(se3di_reader *reader, const se3di_node *node, se3d_wheel_def *def)
{
    const unsigned constraints =
        1U << SE3DI_ELEMENT_JOINT | 1U << SE3DI_ELEMENT_CONSTRAINT | 1U << SE3DI_ELEMENT_DRIVER;
    const se3di_element_entry *travel = NULL, *steering = NULL, *spring = NULL, *opposite = NULL;
    if (!read_key_element(reader, node, "travel", constraints, &travel) ||
        !read_key_element(reader, node, "steering", constraints, &steering) ||
        !read_key_element(reader, node, "spring", 1U << SE3DI_ELEMENT_FORCE, &spring) ||
        !read_key_element(reader, node, "opposite", 1U << SE3DI_ELEMENT_WHEEL, &opposite)) {
        return false;
    }
    def->travel = travel ? travel->constraint : def->travel;
    def->steering = steering ? steering->constraint : def->steering;
    def->spring = spring ? spring->force : def->spring;
    def->opposite = opposite ? opposite->wheel : def->opposite;
    return true;
}

static bool read_point_on_body(se3di_reader *reader, const se3di_node *node, const char *key,
                               const se3di_body_entry *body, bool is_local, double point[3])
{
    double ground[3];
    if (is_local) {
        return se3di_read_key_point(reader, node, key, body, point);
    }
    return se3di_read_key_ground_point(reader, node, key, ground) &&
           se3di_ground_to_body(reader, body->body, ground, point);
}

/* Whether directions and points are said in the frames of the bodies. */
static bool read_frame(se3di_reader *reader, const se3di_node *node, bool *is_local)
{
    int32_t frame = 0;
    const bool good = se3di_read_key(reader, node, &se3di_object_wheel, NULL, "frame", &frame);
    *is_local = frame != 0;
    return good;
}

/* The two points of the steer axis, or neither. */
static bool read_steer_axis(se3di_reader *reader, const se3di_node *node,
                            const se3di_body_entry *body, se3d_wheel_def *def)
{
    const bool lower = se3di_node_get(node, "lower") != NULL;
    bool is_local = false;
    if (lower != (se3di_node_get(node, "upper") != NULL)) {
        return se3di_reader_fail_key(reader, node, lower ? "upper" : "lower",
                                     "is missing, the steer axis has two points");
    }
    return read_frame(reader, node, &is_local) &&
           (!lower ||
            (read_point_on_body(reader, node, "lower", body, is_local, def->steer_lower) &&
             read_point_on_body(reader, node, "upper", body, is_local, def->steer_upper)));
}

/* What is needed to pair wheels, ground frame. */
typedef struct wheel_seat {
    double at[3], axis[3], forward[3], up[3];
} wheel_seat;

/* Whether a wheel is across the vehicle: at the same place along it, and its axis points the other
 * way. */
static bool is_across(const se3di_element_entry *entry, const wheel_seat *seat,
                      const se3d_wheel_def *def)
{
    const double apart[3] = {entry->point_j[0] - seat->at[0], entry->point_j[1] - seat->at[1],
                             entry->point_j[2] - seat->at[2]};
    const double near = 1e-6 * (sqrt(se3di_dot(apart, apart)) + def->radius);
    return entry->kind == SE3DI_ELEMENT_WHEEL && entry->body_i.index1 == def->chassis.index1 &&
           se3di_dot(entry->axis_j, seat->axis) < 0.0 &&
           fabs(se3di_dot(apart, seat->forward)) <=
               near * sqrt(se3di_dot(seat->forward, seat->forward)) &&
           fabs(se3di_dot(apart, seat->up)) <= near * sqrt(se3di_dot(seat->up, seat->up));
}

/* A wheel read before `last` that is across and has no opposite one yet. */
static void find_opposite(const se3di_reader *reader, const se3di_element_entry *last,
                          const wheel_seat *seat, se3d_wheel_def *def)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; &model->elements[k] < last && def->opposite.index1 == 0; ++k) {
        const se3di_element_entry *entry = &model->elements[k];
        if (is_across(entry, seat, def) && !entry->is_paired) {
            def->opposite = entry->wheel;
        }
    }
}

/* Both wheels of an axle know it. */
static void mark_pair(se3di_reader *reader, const se3d_wheel_def *def, se3di_element_entry *entry)
{
    for (size_t k = 0; k < reader->model->element_count && def->opposite.index1 != 0; ++k) {
        se3di_element_entry *other = &reader->model->elements[k];
        if (other->kind == SE3DI_ELEMENT_WHEEL && other->wheel.index1 == def->opposite.index1) {
            other->is_paired = entry->is_paired = true;
        }
    }
}

/* Its directions in the ground frame. */
static bool turn_seat(se3di_reader *reader, const se3di_body_entry *const bodies[2],
                      const se3d_wheel_def *def, wheel_seat *seat)
{
    double p[4], A[2][9];
    for (int k = 0; k < 2; ++k) {
        if (SE3D_FAILED(se3d_body_get_orientation(reader->system, bodies[k]->body, p))) {
            return se3di_reader_fail_memory(reader);
        }
        se3di_rotation_to_matrix(p, A[k]);
    }
    se3di_mul(A[0], def->axis, seat->axis);
    se3di_mul(A[1], def->forward, seat->forward);
    se3di_mul(A[1], def->up, seat->up);
    return true;
}

static bool read_seat(se3di_reader *reader, const se3di_node *node,
                      const se3di_body_entry *const bodies[2], wheel_seat *seat,
                      se3d_wheel_def *def)
{
    if (!se3di_node_get(node, "point") && !se3di_node_get(node, "at")) {
        return se3di_reader_fail_key(reader, node, "at",
                                     "is missing, or point: where the wheel centre is");
    }
    bool is_local = false;
    if (!se3di_read_key_place(reader, node, "point", "at", bodies[0], def->center) ||
        !read_frame(reader, node, &is_local)) {
        return false;
    }
    if (is_local) {
        return !SE3D_FAILED(
                   se3d_body_get_point(reader->system, bodies[0]->body, def->center, seat->at)) &&
               se3di_read_key_body_direction(reader, node, "axis", bodies[0], false, def->axis) &&
               se3di_read_key_body_direction(reader, node, "forward", bodies[1], false,
                                             def->forward) &&
               se3di_read_key_body_direction(reader, node, "up", bodies[1], false, def->up) &&
               turn_seat(reader, bodies, def, seat);
    }
    if (!se3di_read_key_ground_direction(reader, node, "axis", false, seat->axis) ||
        !se3di_read_key_ground_direction(reader, node, "forward", false, seat->forward) ||
        !se3di_read_key_ground_direction(reader, node, "up", false, seat->up)) {
        return false;
    }
    return !SE3D_FAILED(
               se3d_body_get_point(reader->system, bodies[0]->body, def->center, seat->at)) &&
           se3di_ground_to_body_direction(reader, bodies[0]->body, seat->axis, def->axis) &&
           se3di_ground_to_body_direction(reader, bodies[1]->body, seat->forward, def->forward) &&
           se3di_ground_to_body_direction(reader, bodies[1]->body, seat->up, def->up);
}

static bool read_wheel(se3di_reader *reader, const se3di_node *node)
{
    const se3di_body_entry *bodies[2] = {NULL, NULL};
    se3di_element_entry *entry = NULL;
    se3d_wheel_def def = se3d_wheel_def_default();
    wheel_seat seat = {.axis = {0.0, 1.0, 0.0}, .forward = {1.0, 0.0, 0.0}, .up = {0.0, 0.0, 1.0}};
    if (!se3di_read_keys(reader, node, &se3di_object_wheel) ||
        !se3di_read_element(reader, node, SE3DI_ELEMENT_WHEEL, &entry) ||
        !se3di_read_key_body(reader, node, "body", &bodies[0]) ||
        !se3di_read_key_body(reader, node, "chassis", &bodies[1])) {
        return false;
    }
    if (!se3di_node_get(node, "radius")) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "is missing, must be the wheel's radius [m] > 0");
    }
    def.name = entry->name;
    def.body = bodies[0]->body;
    def.chassis = bodies[1]->body;
    if (!read_seat(reader, node, bodies, &seat, &def) ||
        !read_steer_axis(reader, node, bodies[0], &def) ||
        !se3di_read_fields(reader, node, &se3di_object_wheel, NULL, "se3d_wheel_def", &def) ||
        !read_relations(reader, node, &def)) {
        return false;
    }
    find_opposite(reader, entry, &seat, &def);
    entry->body_i = def.chassis;
    entry->body_j = def.body;
    memcpy(entry->point_j, seat.at, sizeof entry->point_j);
    memcpy(entry->axis_j, seat.axis, sizeof entry->axis_j);
    const se3d_status status = se3d_wheel_create(reader->system, &def, &entry->wheel);
    if (status < 0) {
        return se3di_reader_fail_system(reader, node, status);
    }
    mark_pair(reader, &def, entry);
    return true;
}

bool se3di_read_wheels(se3di_reader *reader, const se3di_node *root)
{
    return se3di_read_each(reader, root, "wheels", read_wheel);
}
