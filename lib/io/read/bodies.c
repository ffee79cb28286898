/* SPDX-License-Identifier: BSD-3-Clause */
/* `bodies`: poses, velocities, mass, markers, shapes. */
#include "io/read/bodies.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/base/rotation.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/guess.h"
#include "io/document/keys.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/bars.h"
#include "io/read/entries.h"
#include "io/read/inertia.h"
#include "io/read/objects.h"
#include "io/read/sections.h"
#include "io/read/shapes.h"

static const char *const spins[] = {"removed", "kept", NULL};

/* clang-format off */
static const se3di_key body_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "unique among the bodies"},
    {"when", SE3DI_KIND_CONDITION, .text = "it is there only if this holds"},
    {"fixed", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_body_def, fixed), .standard = "false",
     .text = "immovable, like the ground; needs no mass"},
    {"held", SE3DI_KIND_BOOL, .standard = "false",
     .text = "the assembly analysis keeps its pose and velocity and moves the others"},
    {"mass", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .text = "[kg]"},
    {"inertia", SE3DI_KIND_INERTIA,
     .text = "about the centre of mass, body frame [kg m^2]: [xx, yy, zz], [xx, yy, zz, xy, "
         "yz, xz] or three rows; xy is the entry of the matrix"},
    {"density", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     .text = "of its shapes, or of a bar or plate [kg/m^3], if there is no mass"},
    {"position", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_body_def, position),
     .standard = "[0, 0, 0]", .text = "centre of mass, ground frame [m]"},
    {"orientation", SE3DI_KIND_ORIENTATION, SE3DI_INTO(se3d_body_def, orientation),
     .standard = "that of the ground", .text = "body -> ground"},
    {"velocity", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_body_def, velocity),
     .standard = "[0, 0, 0]", .text = "of the centre of mass, ground frame [m/s]"},
    {"angular_velocity", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_body_def, angular_velocity),
     .standard = "[0, 0, 0]", .text = "body frame [rad/s]"},
    {"shapes", SE3DI_KIND_LIST, .object = "shape",
     .text = "for drawing and contact, and for mass if none is given"},
    {"markers", SE3DI_KIND_LIST, .object = "marker", .text = "points with names"},
    {"from", SE3DI_KIND_VECTOR,
     .text = "where a bar begins, ground frame [m], see [bars](#bars-and-plates)"},
    {"to", SE3DI_KIND_VECTOR, SE3DI_INTO(se3di_bar, to), .text = "where a bar ends [m]"},
    {"from_2", SE3DI_KIND_VECTOR,
     .text = "where a second bar with the same end begins: both are an arm [m]"},
    {"plate", SE3DI_KIND_VECTORS,
     .text = "in place of a bar: 3 to 64 corners of a flat convex plate, in the order around it, "
         "ground frame [m]"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_bar, radius),
     .text = "of a round bar, outside [m]"},
    {"width", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_bar, width),
     .text = "of a flat bar, along `across` [m]"},
    {"thickness", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_bar, thickness),
     .text = "of a flat bar, perpendicular to its width; of a plate, half on each side [m]"},
    {"wall", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3di_bar, wall), .standard = "solid",
     .text = "of a tube, round or flat [m]"},
    {"across", SE3DI_KIND_DIRECTION, SE3DI_INTO(se3di_bar, across), .standard = "horizontal",
     .text = "of a flat bar: where its width points, ground frame"},
    {"material", SE3DI_KIND_MATERIAL,
     .text = "of a bar or plate: gives its density, and if there is contact it touches"},
    {"contact", SE3DI_KIND_BOOL, .standard = "true",
     .text = "of a bar or plate: false: nothing touches it, though it has a material"},
    {"body_from", SE3DI_KIND_BODY, .text = "body at the beginning of a bar: they get a joint"},
    {"body_to", SE3DI_KIND_BODY, .text = "body at the end of a bar: they get a ball joint"},
    {"spin", SE3DI_KIND_WORD, .words = spins, .standard = "removed",
     .text = "of a bar with `body_from`: whether it may turn about itself"},
    {.key = NULL}};
const se3di_object se3di_object_body = {
    "body",
    "A body. The ground is the body ground: it may be listed to give it markers and shapes.",
    body_keys, NULL,
    NULL};
/* clang-format on */

/* clang-format off */
static const se3di_key marker_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "unique among the markers of the body"},
    {"position", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_marker_def, position),
     .standard = "[0, 0, 0]", .text = "body frame [m]"},
    {"at", SE3DI_KIND_VECTOR,
     .text = "in place of position: at the given pose, ground frame [m]"},
    {"orientation", SE3DI_KIND_ORIENTATION, SE3DI_INTO(se3d_marker_def, orientation),
     .standard = "that of the body", .text = "marker -> body"},
    {.key = NULL}};
const se3di_object se3di_object_marker = {
    "marker",
    "A point of a body with axes.",
    marker_keys, NULL,
    NULL};
/* clang-format on */

/* Report a name that is unknown, with the one that was meant or with those there are. */
static bool fail_unknown_body(se3di_reader *reader, const se3di_node *node)
{
    const se3d_model *model = reader->model;
    se3di_guess guess = se3di_guess_begin(node->text);
    for (size_t k = 0; k < model->body_count; ++k) {
        se3di_guess_offer(&guess, model->bodies[k].name);
    }
    const char *meant = se3di_guess_get(&guess);
    se3di_reader_fail(reader, node, "no body is named `%.60s`, %s%s%s", node->text,
                      meant ? "did you mean `" : "must be `ground` or the name of a body",
                      meant ? meant : "", meant ? "`?" : "");
    return se3di_reader_propose(reader, meant);
}

bool se3di_read_key_body(se3di_reader *reader, const se3di_node *map, const char *key,
                         const se3di_body_entry **entry)
{
    const se3di_node *node = se3di_node_get(map, key);
    const char *name = NULL;
    size_t index = 0;
    if (!node) {
        return se3di_reader_fail_key(reader, map, key,
                                     "is missing, must be `ground` or the name of a body");
    }
    if (!se3di_read_reference(reader, node, &name)) {
        return false;
    }
    if (strcmp(name, "ground") != 0 &&
        !se3di_reader_find(reader, &reader->model->body_names, name, &index)) {
        return fail_unknown_body(reader, node);
    }
    *entry = &reader->model->bodies[index];
    return true;
}

bool se3di_read_bodies_ij(se3di_reader *reader, const se3di_node *node, const char *what,
                          const se3di_body_entry *bodies[2])
{
    if (!se3di_read_key_body(reader, node, "body_i", &bodies[0]) ||
        !se3di_read_key_body(reader, node, "body_j", &bodies[1])) {
        return false;
    }
    if (bodies[0] == bodies[1]) {
        return se3di_reader_fail_key(reader, node, "body_j",
                                     "is the same body as body_i, %s needs two different bodies",
                                     what);
    }
    return true;
}

bool se3di_read_key_point(se3di_reader *reader, const se3di_node *map, const char *key,
                          const se3di_body_entry *body, double point[3])
{
    const se3di_node *node = se3di_node_get(map, key);
    size_t index = 0;
    if (!node || node->kind != SE3DI_NODE_SCALAR) {
        return !node || (se3di_read_vector(reader, node, 3, point) &&
                         se3di_place_on_body(reader, node, body, point));
    }
    const bool is_marker = se3di_ionames_find(&body->markers, node->text, &index);
    const bool is_name =
        se3di_text_is_identifier(node->text) && !se3di_scope_find(reader->scope, node->text);
    if (!is_marker && !is_name) {
        return se3di_read_vector(reader, node, 3, point) &&
               se3di_place_on_body(reader, node, body, point);
    }
    if (!is_marker) {
        return se3di_reader_fail(reader, node,
                                 "`%.60s` is not a marker of `%.60s`, must be a list of 3 numbers "
                                 "or the name of a marker of that body",
                                 node->text, body->name);
    }
    memcpy(point, reader->model->markers[index].position, 3 * sizeof *point);
    return true;
}

bool se3di_ground_to_body(se3di_reader *reader, se3d_body body, const double ground[3],
                          double local[3])
{
    const se3d_system *system = reader->system;
    double r[3];
    double p[4];
    if (SE3D_FAILED(se3d_body_get_position(system, body, r)) ||
        SE3D_FAILED(se3d_body_get_orientation(system, body, p))) {
        return se3di_reader_fail_memory(reader);
    }
    const double d[3] = {ground[0] - r[0], ground[1] - r[1], ground[2] - r[2]};
    se3di_rotation_apply_inverse(p, d, local);
    return true;
}

bool se3di_ground_to_body_direction(se3di_reader *reader, se3d_body body, const double ground[3],
                                    double local[3])
{
    double r[3];
    if (SE3D_FAILED(se3d_body_get_position(reader->system, body, r))) {
        return se3di_reader_fail_memory(reader);
    }
    const double end[3] = {r[0] + ground[0], r[1] + ground[1], r[2] + ground[2]};
    return se3di_ground_to_body(reader, body, end, local);
}

bool se3di_check_frame(se3di_reader *reader, const se3di_node *node, const se3di_body_entry *body)
{
    return body == &reader->model->bodies[0] || body->part == reader->part ||
           !se3di_component_is_mirrored(reader->part) ||
           se3di_reader_fail(reader, node,
                             "is said in the frame of `%.60s`, which is no body of this part: "
                             "a part that is mirrored must say it in the ground frame",
                             body->name);
}

/* Vectors that are said in the frame of a body: of one of the part it turns with it, on the ground
 * it is put where the part is. */
static bool place_on_body(se3di_reader *reader, const se3di_node *node,
                          const se3di_body_entry *body,
                          void (*on_ground)(const se3di_placement *, double[3]),
                          void (*on_body)(const se3di_placement *, double[3]), double v[3])
{
    const se3di_placement *place = &reader->part->place;
    if (body == &reader->model->bodies[0]) {
        on_ground(place, v);
    } else if (body->part == reader->part) {
        on_body(place, v);
    } else if (!se3di_check_frame(reader, node, body)) {
        return false;
    }
    return true;
}

bool se3di_place_on_body(se3di_reader *reader, const se3di_node *node, const se3di_body_entry *body,
                         double point[3])
{
    return place_on_body(reader, node, body, se3di_place_point, se3di_flip_vector, point);
}

bool se3di_read_key_body_direction(se3di_reader *reader, const se3di_node *map, const char *key,
                                   const se3di_body_entry *body, bool is_axial, double v[3])
{
    const se3di_node *node = se3di_node_get(map, key);
    return !node ||
           (se3di_read_key_direction(reader, map, key, v) &&
            place_on_body(reader, node, body, is_axial ? se3di_place_axial : se3di_place_vector,
                          is_axial ? se3di_flip_axial : se3di_flip_vector, v));
}

bool se3di_read_key_ground_point(se3di_reader *reader, const se3di_node *map, const char *key,
                                 double point[3])
{
    if (!se3di_read_key_vector(reader, map, key, point)) {
        return false;
    }
    if (se3di_node_get(map, key)) {
        se3di_place_point(&reader->part->place, point);
    }
    return true;
}

bool se3di_read_key_ground_direction(se3di_reader *reader, const se3di_node *map, const char *key,
                                     bool is_axial, double v[3])
{
    if (!se3di_read_key_direction(reader, map, key, v)) {
        return false;
    }
    if (se3di_node_get(map, key)) {
        (is_axial ? se3di_place_axial : se3di_place_vector)(&reader->part->place, v);
    }
    return true;
}

bool se3di_read_key_place(se3di_reader *reader, const se3di_node *map, const char *key,
                          const char *at, const se3di_body_entry *body, double point[3])
{
    double ground[3];
    if (!se3di_node_get(map, at)) {
        return se3di_read_key_point(reader, map, key, body, point);
    }
    if (se3di_node_get(map, key)) {
        return se3di_reader_fail_key(reader, map, at,
                                     "cannot be combined with %s: give the point in the ground "
                                     "frame or in that of the body",
                                     key);
    }
    return se3di_read_key_ground_point(reader, map, at, ground) &&
           se3di_ground_to_body(reader, body->body, ground, point);
}

/* Without a mass: one that does not count, where nothing that is asked for depends on masses. */
static bool do_without_mass(se3di_reader *reader, const se3di_node *node, const char *has,
                            se3d_body_def *def)
{
    const bool optional =
        reader->options->mass_optional || reader->is_geometric || node->incomplete;
    const bool any = se3di_node_get(node, "inertia") != NULL;
    if (!optional) {
        return se3di_reader_fail_key(reader, node, "mass",
                                     "is missing, must be finite and > 0 [kg] unless the body is "
                                     "fixed or %s a density",
                                     has);
    }
    def->mass = se3di_node_get(node, "mass") ? def->mass : 1.0;
    for (int k = 0; !any && k < 3; ++k) {
        def->inertia[k] = 1.0;
    }
    return true;
}

static bool read_bar_mass(se3di_reader *reader, const se3di_node *node, const se3di_bar *bar,
                          se3d_body_def *def)
{
    const se3di_node *material = se3di_node_get(node, "material");
    double density = 0.0;
    double inertia[6];
    const double volume = se3di_bar_weigh(bar, def->position, inertia);
    if ((material && !se3di_read_material_density(reader, material, &density)) ||
        !se3di_read_key(reader, node, &se3di_object_body, NULL, "density", &density)) {
        return false;
    }
    if (!se3di_node_get(node, "mass")) {
        def->mass = density * volume;
    }
    for (int k = 0; k < 6; ++k) {
        def->inertia[k] = def->mass * inertia[k];
    }
    return def->fixed || def->mass > 0.0 ||
           do_without_mass(reader, node, "it or its material has", def);
}

static bool read_mass(se3di_reader *reader, const se3di_node *node, const se3di_bar *bar,
                      se3d_body_def *def)
{
    const se3di_node *mass = se3di_node_get(node, "mass");
    const se3di_node *inertia = se3di_node_get(node, "inertia");
    if (!se3di_read_key(reader, node, &se3di_object_body, NULL, "mass", &def->mass)) {
        return false;
    }
    if (se3di_is_bar(node)) {
        return read_bar_mass(reader, node, bar, def);
    }
    if (inertia && !se3di_read_inertia(reader, inertia, def->inertia)) {
        return false;
    }
    if (def->fixed || (mass && inertia)) {
        return true;
    }
    if (mass && !reader->options->mass_optional && !reader->is_geometric && !node->incomplete) {
        return se3di_reader_fail_key(reader, node, "inertia",
                                     "is missing, must be given with the mass [kg m^2]");
    }
    if (!mass && !inertia) {
        if (se3di_node_get(node, "shapes") && !se3di_read_shape_mass(reader, node, def)) {
            return false;
        }
        if (def->mass > 0.0) {
            return true;
        }
    }
    return do_without_mass(reader, node, "its shapes have", def);
}

static bool read_markers(se3di_reader *reader, const se3di_node *body, size_t entry)
{
    se3d_model *model = reader->model;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, body, "markers", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        se3d_marker_def def = se3d_marker_def_default();
        se3di_marker_entry marker = {.body = entry};
        const se3di_node *name = NULL;
        if (!se3di_read_keys(reader, node, &se3di_object_marker)) {
            return false;
        }
        name = se3di_node_get(node, "name");
        if (!name) {
            return se3di_reader_fail_key(reader, node, "name", "is missing");
        }
        if (!se3di_read_name(reader, name, &marker.name) ||
            !se3di_read_fields(reader, node, &se3di_object_marker, NULL, "se3d_marker_def", &def)) {
            return false;
        }
        se3di_body_entry *owner = &model->bodies[entry];
        if (se3di_node_get(node, "at")
                ? !se3di_read_key_place(reader, node, "position", "at", owner, def.position)
                : !se3di_place_on_body(reader, node, owner, def.position)) {
            return false;
        }
        (entry == 0 ? se3di_place_orientation : se3di_flip_orientation)(&reader->part->place,
                                                                        def.orientation);
        size_t known = 0;
        const bool is_known = se3di_ionames_find(&owner->markers, marker.name, &known);
        if (is_known && !reader->again) {
            return se3di_reader_fail(reader, name, "`%.60s` is the name of two markers",
                                     marker.name);
        }
        def.name = marker.name;
        def.body = owner->body;
        memcpy(marker.position, def.position, sizeof marker.position);
        const se3d_status status = se3d_marker_create(model->system, &def, &marker.marker);
        if (status < 0) {
            return se3di_reader_fail_system(reader, node, status);
        }
        if (is_known) {
            memcpy(model->markers[known].position, marker.position, sizeof marker.position);
            continue;
        }
        se3di_marker_entry *grown =
            se3di_iopool_grow(&model->pool, model->markers, model->marker_count,
                              &model->marker_capacity, sizeof *grown);
        if (!grown ||
            !se3di_ionames_add(&owner->markers, &model->pool, marker.name, model->marker_count)) {
            return se3di_reader_fail_memory(reader);
        }
        model->markers = grown;
        model->markers[model->marker_count++] = marker;
    }
    return true;
}

static bool add_body(se3di_reader *reader, const char *name, const se3di_node *node, se3d_body body)
{
    se3d_model *model = reader->model;
    se3di_body_entry *grown = se3di_iopool_grow(&model->pool, model->bodies, model->body_count,
                                                &model->body_capacity, sizeof *grown);
    if (!grown || !se3di_ionames_add(&model->body_names, &model->pool, name, model->body_count)) {
        return se3di_reader_fail_memory(reader);
    }
    model->bodies = grown;
    const se3di_body_entry entry = {.name = name, .node = node, .part = reader->part, .body = body};
    model->bodies[model->body_count++] = entry;
    return true;
}

/* `ground` may be listed to give it markers and shapes. */
static bool read_ground(se3di_reader *reader, const se3di_node *node)
{
    if (reader->model->bodies[0].node && reader->model->bodies[0].part == reader->part) {
        return se3di_reader_fail(reader, node, "`ground` is listed twice");
    }
    reader->model->bodies[0].node = node;
    reader->model->bodies[0].part = reader->part;
    for (const se3di_node *child = node->first; child; child = child->next) {
        if (!se3di_keys_contain(" name markers shapes ", child->key)) {
            return se3di_reader_fail(reader, child,
                                     "the ground can only have markers and shapes, it does not "
                                     "move");
        }
    }
    return read_markers(reader, node, 0) && se3di_read_shapes(reader, node, 0);
}

static bool read_body_name(se3di_reader *reader, const se3di_node *node, const char **name)
{
    static const char words[] = " energy work violation contacts particles steps iterations time ";
    const se3di_node *child = se3di_node_get(node, "name");
    if (!child) {
        return se3di_reader_fail_key(reader, node, "name", "is missing, every body needs one");
    }
    if (child->text && strcmp(child->text, "ground") == 0) {
        *name = child->text;
        return true;
    }
    if (!se3di_read_part_name(reader, child, name)) {
        return false;
    }
    if (se3di_keys_contain(words, *name)) {
        return se3di_reader_fail(reader, child, "the name `%s` is taken by a channel", *name);
    }
    if (strcmp(*name, "ground") == 0) {
        return se3di_reader_fail(reader, child, "the name with its prefix is that of the ground");
    }
    if (!reader->again && se3di_ionames_find(&reader->model->body_names, *name, NULL)) {
        return se3di_reader_fail(reader, child, "`%.60s` is the name of two bodies", *name);
    }
    return true;
}

static void place_body(const se3di_reader *reader, se3d_body_def *def)
{
    const se3di_placement *place = &reader->part->place;
    se3di_place_point(place, def->position);
    se3di_place_orientation(place, def->orientation);
    se3di_place_vector(place, def->velocity);
    se3di_flip_axial(place, def->angular_velocity);
    se3di_flip_inertia(place, def->inertia);
}

static bool read_body(se3di_reader *reader, const se3di_node *node)
{
    se3d_body_def def = se3d_body_def_default();
    se3d_body body;
    const char *name = NULL;
    if (!se3di_read_keys(reader, node, &se3di_object_body) ||
        !read_body_name(reader, node, &name)) {
        return false;
    }
    if (strcmp(name, "ground") == 0) {
        return read_ground(reader, node);
    }
    int32_t is_held = 0;
    se3di_bar bar;
    if (!se3di_read_key(reader, node, &se3di_object_body, NULL, "held", &is_held) ||
        !se3di_read_fields(reader, node, &se3di_object_body, NULL, "se3d_body_def", &def) ||
        !se3di_read_bar(reader, node, &bar) || !read_mass(reader, node, &bar, &def)) {
        return false;
    }
    place_body(reader, &def);
    def.name = name;
    se3d_status status = se3d_body_create(reader->system, &def, &body);
    if (status >= 0 && is_held) {
        status = se3d_body_set_held(reader->system, body, is_held);
    }
    if (status < 0) {
        return se3di_reader_fail_system(reader, node, status);
    }
    size_t entry = reader->model->body_count;
    if (reader->again) {
        return se3di_ionames_find(&reader->model->body_names, name, &entry) &&
               read_markers(reader, node, entry);
    }
    return add_body(reader, name, node, body) && read_markers(reader, node, entry) &&
           (!se3di_is_bar(node) || se3di_add_bar_shapes(reader, node, &bar, entry)) &&
           se3di_read_shapes(reader, node, entry);
}

bool se3di_read_bodies(se3di_reader *reader, const se3di_node *root)
{
    se3d_body ground;
    const se3d_status status = se3d_system_get_ground(reader->system, &ground);
    return status >= 0 &&
           (reader->model->body_count > 0 || add_body(reader, "ground", NULL, ground)) &&
           se3di_read_each(reader, root, "bodies", read_body);
}
