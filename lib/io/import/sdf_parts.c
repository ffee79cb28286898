/* SPDX-License-Identifier: BSD-3-Clause */
/* SDF: masses and shapes of links. */
#include <math.h>
#include <string.h>

#include "io/import/mesh.h"
#include "io/import/sdf.h"

bool se3di_sdf_inertial(se3di_machine *m, const se3di_xml *node, se3di_mass *mass)
{
    static const char *const keys[6] = {"ixx", "iyy", "izz", "ixy", "iyz", "ixz"};
    static const int place[6] = {0, 4, 8, 1, 5, 2};
    const se3di_xml *inertial = se3di_xml_child(node, "inertial");
    const se3di_xml *inertia = se3di_xml_child(inertial, "inertia");
    const char *automatic = inertial ? se3di_xml_get(inertial, "auto") : NULL;
    se3di_mass own = {.mass = 1.0, .J = {1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
    se3di_frame frame;
    if (!inertial) {
        se3di_machine_note_of(m, SE3D_IMPORT_NOTE, node->line,
                              "the link `%.80s` says no mass: it has SDF's 1 kg and 1 kg m^2",
                              se3di_xml_get(node, "name"));
        *mass = own;
        return true;
    }
    if (automatic && (strcmp(automatic, "true") == 0 || strcmp(automatic, "1") == 0)) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, inertial->line,
                              "the mass of `%.80s` from its collisions (auto)",
                              se3di_xml_get(node, "name"));
    }
    if (!se3di_sdf_pose(m, inertial, &frame) || !se3di_sdf_number(m, inertial, "mass", &own.mass)) {
        return false;
    }
    if (!(own.mass >= 0.0)) {
        return se3di_machine_fail(m, inertial->line, inertial->column,
                                  "the mass of `%.80s` is %g kg, must not be negative",
                                  se3di_xml_get(node, "name"), own.mass);
    }
    for (int k = 0; inertia && k < 6; ++k) {
        if (!se3di_sdf_number(m, inertia, keys[k], &own.J[place[k]])) {
            return false;
        }
        own.J[3 * (place[k] % 3) + place[k] / 3] = own.J[place[k]];
    }
    if (se3di_xml_child(inertial, "fluid_added_mass")) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, inertial->line, "the added mass of the fluid");
    }
    *mass = se3di_mass_of(&frame, &own);
    return true;
}

static bool read_color(se3di_machine *m, const se3di_xml *visual, double color[3])
{
    const se3di_xml *material = se3di_xml_child(visual, "material");
    const se3di_xml *diffuse = se3di_xml_child(material, "diffuse");
    double rgba[4] = {1.0, 1.0, 1.0, 1.0};
    color[0] = -1.0;
    color[1] = color[2] = 0.0;
    if (!diffuse) {
        return true;
    }
    if (!se3di_xml_text_numbers(m, diffuse, rgba, 4)) {
        return false;
    }
    for (int k = 0; k < 3; ++k) {
        color[k] = fmin(fmax(rgba[k], 0.0), 1.0);
    }
    return true;
}

static bool read_vector(se3di_machine *m, const se3di_xml *node, const char *child, double v[3])
{
    const se3di_xml *found = se3di_xml_child(node, child);
    return !found || se3di_xml_text_numbers(m, found, v, 3);
}

static bool read_plane(se3di_machine *m, const se3di_xml *node, se3di_machine_shape *shape,
                       bool *good)
{
    double normal[3] = {0.0, 0.0, 1.0};
    se3di_frame turn = se3di_frame_identity();
    shape->type = "plane";
    if (!read_vector(m, node, "normal", normal)) {
        return false;
    }
    *good = se3di_turn_along(normal, turn.A);
    shape->frame = se3di_frame_of(&shape->frame, &turn);
    return true;
}

static bool read_round(se3di_machine *m, const se3di_xml *node, se3di_machine_shape *shape,
                       bool *good)
{
    const bool is_sphere = se3di_xml_is(node, "sphere");
    shape->type = is_sphere ? "sphere" : se3di_xml_is(node, "capsule") ? "capsule" : "cylinder";
    if (!se3di_sdf_number(m, node, "radius", &shape->radius) ||
        (!is_sphere && !se3di_sdf_number(m, node, "length", &shape->length))) {
        return false;
    }
    *good = shape->radius > 0.0 && (is_sphere || shape->length > 0.0);
    return true;
}

static bool read_ellipsoid(se3di_machine *m, const se3di_xml *node, se3di_machine_shape *shape,
                           bool *good)
{
    shape->type = "ellipsoid";
    if (!read_vector(m, node, "radii", shape->size)) {
        return false;
    }
    *good = shape->size[0] > 0.0 && shape->size[1] > 0.0 && shape->size[2] > 0.0;
    return true;
}

static bool read_mesh(se3di_machine *m, const se3di_xml *node, se3di_machine_shape *shape,
                      bool *good)
{
    double scale[3] = {1.0, 1.0, 1.0};
    const char *uri = se3di_sdf_text(m, node, "uri");
    const char *folder = se3di_path_folder(m, m->file);
    if (!folder || m->status < 0 || !read_vector(m, node, "scale", scale)) {
        return false;
    }
    if (!uri || !*uri) {
        return se3di_machine_fail(m, node->line, node->column, "the <mesh> has no <uri>");
    }
    if (se3di_xml_child(node, "submesh")) {
        se3di_machine_note_of(m, SE3D_IMPORT_LOST, node->line,
                              "the <submesh> of `%.80s`: all of the mesh is drawn", uri);
    }
    *good = se3di_mesh_take(m, node->line, folder, uri, scale, shape);
    return m->status >= 0;
}

/* *good: it can be drawn; else the reason is noted. */
static bool read_shape(se3di_machine *m, const se3di_xml *node, se3di_machine_shape *shape,
                       bool *good)
{
    static const struct {
        const char *name;
        bool (*read)(se3di_machine *m, const se3di_xml *node, se3di_machine_shape *shape,
                     bool *good);
    } rounds[] = {{"sphere", read_round},
                  {"cylinder", read_round},
                  {"capsule", read_round},
                  {"ellipsoid", read_ellipsoid},
                  {"plane", read_plane}};
    *good = false;
    if (se3di_xml_is(node, "empty")) {
        return true;
    }
    if (se3di_xml_is(node, "mesh")) {
        return read_mesh(m, node, shape, good);
    }
    bool known = se3di_xml_is(node, "box");
    if (known) {
        shape->type = "box";
        if (!read_vector(m, node, "size", shape->size)) {
            return false;
        }
        *good = shape->size[0] > 0.0 && shape->size[1] > 0.0 && shape->size[2] > 0.0;
    }
    for (size_t k = 0; k < sizeof rounds / sizeof *rounds; ++k) {
        if (se3di_xml_is(node, rounds[k].name)) {
            known = true;
            if (!rounds[k].read(m, node, shape, good)) {
                return false;
            }
        }
    }
    if (!*good) {
        se3di_machine_note_of(
            m, SE3D_IMPORT_LOST, node->line,
            known ? "the <%.40s> has a size that is not > 0" : "the geometry <%.40s>", node->name);
    }
    return true;
}

/* What a surface says, with its line. */
static void note_surface(se3di_machine *m, const se3di_xml *surface, const char *collision)
{
    static const struct {
        const char *path[4];
        const char *what;
    } values[] = {{{"friction", "ode", "mu", NULL}, "friction"},
                  {{"friction", "bullet", "friction", NULL}, "friction"},
                  {{"bounce", "restitution_coefficient", NULL, NULL}, "restitution"},
                  {{"contact", "ode", "kp", NULL}, "stiffness"},
                  {{"contact", "bullet", "kp", NULL}, "stiffness"}};
    for (size_t k = 0; k < sizeof values / sizeof *values; ++k) {
        const se3di_xml *at = surface;
        for (int step = 0; at && step < 4 && values[k].path[step]; ++step) {
            at = se3di_xml_child(at, values[k].path[step]);
        }
        if (at) {
            se3di_machine_note_of(m, SE3D_IMPORT_NOTE, at->line,
                                  "the collision `%.80s` has a %s of %.40s: shapes touch only if "
                                  "they get such a `material` and the model `contact`",
                                  collision, values[k].what, at->text);
        }
    }
}

/* Contact is not carried; which collisions touch only some others is told by their names. */
static void note_bitmasks(se3di_machine *m, const se3di_xml *node)
{
    for (const se3di_xml *at = se3di_xml_child(node, "collision"); at; at = se3di_xml_again(at)) {
        const se3di_xml *surface = se3di_xml_child(at, "surface");
        const se3di_xml *bits =
            se3di_xml_child(se3di_xml_child(surface, "contact"), "collide_bitmask");
        const char *name = se3di_xml_get(at, "name");
        note_surface(m, surface, name ? name : "");
        if (bits) {
            se3di_machine_note_of(m, SE3D_IMPORT_NOTE, bits->line,
                                  "the collision `%.80s` touches what shares a bit of its "
                                  "collide_bitmask %.40s, as shapes do by `group` and `mask`",
                                  name ? name : "", bits->text);
        }
    }
}

bool se3di_sdf_shapes(se3di_links *links, size_t link, const se3di_xml *node)
{
    se3di_machine *m = links->m;
    note_bitmasks(m, node);
    const char *which = se3di_xml_child(node, "visual") ? "visual" : "collision";
    for (const se3di_xml *at = se3di_xml_child(node, which); at; at = se3di_xml_again(at)) {
        const se3di_xml *geometry = se3di_xml_child(at, "geometry");
        se3di_machine_shape read = {.scale = 1.0};
        if (!se3di_sdf_pose(m, at, &read.frame) || !read_color(m, at, read.color) ||
            !se3di_links_read_shape(links, link, geometry, read_shape, &read)) {
            return false;
        }
    }
    return true;
}
