/* SPDX-License-Identifier: BSD-3-Clause */
/* `contact`: the law, the materials, and the shapes that touch. A model with `contact` or
 * `particles` has contacts: of all shapes with a `material`, but those with `contact: false`. */
#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/mesh.h"
#include "io/model/model.h"
#include "io/read/include.h"
#include "io/read/materials.h"
#include "io/read/objects.h"
#include "io/read/sections.h"
#include "io/read/shape_kinds.h"

static const char *const laws[] = {
    [SE3D_CONTACT_LAW_HOOKE] = "hooke", [SE3D_CONTACT_LAW_HERTZ_MINDLIN] = "hertz_mindlin", NULL};
static const char *const boundaries[] = {[SE3D_DOMAIN_BOUNDARY_OPEN] = "open",
                                         [SE3D_DOMAIN_BOUNDARY_PERIODIC] = "periodic",
                                         [SE3D_DOMAIN_BOUNDARY_SINK] = "sink",
                                         NULL};

/* clang-format off */
static const se3di_key contact_keys[] = {
    {"law", SE3DI_KIND_WORD, SE3DI_INTO(se3d_contact_settings, law), .words = laws,
     .standard = "hooke", .text = "the force law"},
    {"step", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_contact_settings, step),
     .standard = "from the stiffness", .text = "[s]"},
    {"threads", SE3DI_KIND_COUNT, .most = 1024.0, .standard = "1",
     .text = "results do not depend on it"},
    {"skin", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_particles_def, skin),
     .standard = "0.1", .text = "of the neighbour list, over the mean diameter"},
    {"overlap_limit", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_contact_settings, overlap_limit), .standard = "0.2",
     .text = "over the smaller radius"},
    {"boundary", SE3DI_KIND_BOUNDARY, .words = boundaries, .standard = "open",
     .text = "of the domain along x, y, z: periodic (a period is 4.04 of the largest radii at "
         "least), sink: particles beyond it are removed and counted"},
    {"lower", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_particles_def, lower),
     .text = "corner of the domain [m]"},
    {"upper", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_particles_def, upper),
     .text = "corner of the domain [m]"},
    {"audit", SE3DI_KIND_BOOL, SE3DI_INTO(se3d_particles_def, audit), .standard = "false",
     .text = "add up what particles dissipate, by kinds: the channels `dissipation`; slower"},
    {"pairs", SE3DI_KIND_LIST, .object = "pair",
     .text = "what holds between two materials in place of the mixing rules"},
    {.key = NULL}};
const se3di_object se3di_object_contact = {
    "contact",
    "How shapes and particles touch.",
    contact_keys, NULL,
    NULL};
/* clang-format on */

/* clang-format off */
static const se3di_key pair_keys[] = {
    {"material_1", SE3DI_KIND_MATERIAL, .required = true, .text = ""},
    {"material_2", SE3DI_KIND_MATERIAL, .required = true, .text = ""},
    {"law", SE3DI_KIND_WORD, SE3DI_INTO(se3d_material_pair_def, law), .words = laws,
     .standard = "that of contact", .text = "the force law of these two"},
    {"friction", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, friction), .text = "coefficient of sliding"},
    {"restitution", SE3DI_KIND_NUMBER, SE3DI_RESTITUTION,
     SE3DI_INTO(se3d_material_pair_def, restitution), .text = "coefficient of restitution"},
    {"rolling_friction", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, rolling_friction), .text = "as of a material"},
    {"torsional_friction", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, torsional_friction), .text = "as of a material"},
    {"stiffness", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_material_pair_def, stiffness),
     .text = "hooke [N/m]"},
    {"cohesion", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, cohesion), .text = "[J/m^3]"},
    {"adhesion", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, adhesion), .text = "[J/m^2]"},
    {"damping_ratio", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, damping_ratio),
     .text = "in place of restitution, as of a material"},
    {"damping_rate", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, damping_rate),
     .text = "of particles, as of a material"},
    {"tangential_ratio", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, tangential_ratio),
     .text = "tangential over normal stiffness, at most 10"},
    {"tangential_stiffness", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, tangential_stiffness),
     .text = "in place of tangential_ratio, as of a material [N/m]"},
    {"rolling_stiffness", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, rolling_stiffness),
     .text = "in place of rolling_ratio, as of a material [N/m]"},
    {"tangential_damping", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, tangential_damping),
     .text = "over that along the normal, at most 10"},
    {"rolling_ratio", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, rolling_ratio),
     .text = "as of a material, at most 100"},
    {"rolling_damping", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, rolling_damping),
     .text = "as of a material, at most 10"},
    {"young", SE3DI_KIND_NUMBER, SE3DI_POSITIVE,
     SE3DI_INTO(se3d_material_pair_def, young),
     .text = "hertz_mindlin, as if both were of it [Pa]"},
    {"poisson", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_pair_def, poisson),
     .text = "hertz_mindlin, as if both had it, 0 to 0.5"},
    {.key = NULL}};
const se3di_object se3di_object_pair = {
    "pair",
    "Two materials, each pair once; without a key the mixing rules hold.",
    pair_keys, NULL,
    NULL};
/* clang-format on */

static bool read_settings(se3di_reader *reader, const se3di_node *contact)
{
    se3d_contact_settings settings = se3d_contact_settings_default();
    if (!se3di_read_keys(reader, contact, &se3di_object_contact) ||
        !se3di_read_fields(reader, contact, &se3di_object_contact, NULL, "se3d_contact_settings",
                           &settings)) {
        return false;
    }
    return se3di_reader_check(reader, contact, se3d_system_set_contact(reader->system, &settings));
}

static const char *text_of(const se3di_node *map, const char *key)
{
    return se3di_node_get(map, key)->text;
}

/* Two materials of one pair before `node` are these. */
static bool is_first_of_pair(se3di_reader *reader, const se3di_node *list, const se3di_node *node)
{
    const char *a = text_of(node, "material_1"), *b = text_of(node, "material_2");
    for (const se3di_node *old = list->first; old != node; old = old->next) {
        const char *c = text_of(old, "material_1"), *d = text_of(old, "material_2");
        if ((strcmp(a, c) == 0 && strcmp(b, d) == 0) || (strcmp(a, d) == 0 && strcmp(b, c) == 0)) {
            return se3di_reader_fail(
                reader, node, "is a second pair of `%.60s` and `%.60s`, must be the only one", a,
                b);
        }
    }
    return true;
}

static bool read_pairs(se3di_reader *reader, const se3di_node *contact)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, contact, "pairs", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        se3d_material_pair_def def = se3d_material_pair_def_default();
        se3d_material a;
        se3d_material b;
        if (!se3di_read_keys(reader, node, &se3di_object_pair) ||
            !se3di_read_key_material(reader, node, "material_1", &a) ||
            !se3di_read_key_material(reader, node, "material_2", &b) ||
            !se3di_read_fields(reader, node, &se3di_object_pair, NULL, "se3d_material_pair_def",
                               &def)) {
            return false;
        }
        if (!is_first_of_pair(reader, list, node)) {
            return false;
        }
        const se3d_status status = se3d_material_set_pair(reader->system, a, b, &def);
        if (status < 0) {
            return se3di_reader_fail_system(reader, node, status);
        }
    }
    return true;
}

static bool read_shape_keys(se3di_reader *reader, const se3di_node *node, se3d_shape_def *def)
{
    const se3di_object *shape = &se3di_object_shape;
    double group = 1.0;
    double mask = 4294967295.0;
    if (!se3di_read_key(reader, node, shape, NULL, "name", (void *)&def->name) ||
        !se3di_read_key_material(reader, node, "material", &def->material) ||
        !se3di_read_key(reader, node, shape, NULL, "surface_velocity", def->surface_velocity) ||
        !se3di_read_key(reader, node, shape, NULL, "surface_spin", def->surface_spin) ||
        !se3di_read_key(reader, node, shape, NULL, "group", &group) ||
        !se3di_read_key(reader, node, shape, NULL, "mask", &mask)) {
        return false;
    }
    def->group = (uint32_t)group;
    def->mask = (uint32_t)mask;
    return true;
}

static void place_surface(const se3di_reader *reader, const se3d_model_shape *shape,
                          se3d_shape_def *def)
{
    const se3di_placement *place = &reader->part->place;
    const bool on_ground = shape->body.index1 == reader->model->bodies[0].body.index1;
    (on_ground ? se3di_place_vector : se3di_flip_vector)(place, def->surface_velocity);
    (on_ground ? se3di_place_axial : se3di_flip_axial)(place, def->surface_spin);
}

static bool create_shape(se3di_reader *reader, const se3di_node *node, se3di_shape_entry *entry)
{
    const se3d_model_shape *shape = &entry->shape;
    const se3di_mesh *mesh = entry->mesh;
    se3d_shape_def def = se3d_shape_def_default();
    int32_t fixed = 0;
    if (!read_shape_keys(reader, node, &def)) {
        return false;
    }
    place_surface(reader, shape, &def);
    def.body = shape->body;
    def.radius = shape->radius;
    def.length = shape->length;
    def.bottom_radius = shape->bottom_radius;
    def.top_radius = shape->top_radius;
    memcpy(def.position, shape->position, sizeof def.position);
    memcpy(def.orientation, shape->orientation, sizeof def.orientation);
    memcpy(def.size, shape->size, sizeof def.size);
    memcpy(def.semi_axes, shape->semi_axes, sizeof def.semi_axes);
    if (mesh) {
        def.vertices = mesh->points;
        def.vertex_count = mesh->point_count;
        def.triangles = mesh->triangles;
        def.triangle_count = mesh->triangle_count;
        def.heights = mesh->heights;
        def.row_count = mesh->row_count;
        def.column_count = mesh->column_count;
        memcpy(def.spacing, mesh->spacing, sizeof def.spacing);
    }
    const int mirrored = mesh && mesh->of && !mesh->heights; /* cells are cut the other way */
    se3d_status status =
        (entry->convex ? se3d_shape_create_hull
         : mirrored    ? se3d_shape_create_mesh
                       : se3di_shape_row_of(shape)->create)(reader->system, &def, &entry->made);
    if (status >= 0) {
        status = se3d_body_get_fixed(reader->system, shape->body, &fixed);
    }
    reader->model->moving_shapes = reader->model->moving_shapes || !fixed;
    return se3di_reader_check(reader, node, status);
}

/* Each in the part that has it. */
static bool create_shapes(se3di_reader *reader)
{
    const se3di_component *main = reader->part;
    bool good = true;
    for (size_t k = 0; good && k < reader->model->shape_count; ++k) {
        se3di_shape_entry *entry = &reader->model->shapes[k];
        int32_t wanted = 1;
        se3di_reader_enter(reader, entry->part);
        good = se3di_read_key(reader, entry->node, &se3di_object_shape, NULL, "contact", &wanted) &&
               (!wanted || !se3di_node_get(entry->node, "material") ||
                create_shape(reader, entry->node, entry));
    }
    if (good) { /* else the report is about the part that it stands in */
        se3di_reader_enter(reader, main);
    }
    return good;
}

bool se3di_read_contact(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *contact = se3di_node_get(root, "contact");
    const se3di_node *materials = se3di_node_get(root, "materials");
    if (!contact && !se3di_node_get(root, "particles") && !se3di_node_get(root, "sinks")) {
        return true;
    }
    model->materials = se3di_iopool_array(&model->pool, materials ? materials->count : 1,
                                          sizeof *model->materials);
    if (!model->materials) {
        return se3di_reader_fail_memory(reader);
    }
    return (!contact || read_settings(reader, contact)) && create_shapes(reader) &&
           (!contact || read_pairs(reader, contact));
}
