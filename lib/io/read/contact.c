/* SPDX-License-Identifier: BSD-3-Clause */
/* `contact`: the law, the materials, and the shapes that touch. A model with `contact` or
 * `particles` has contacts: of all shapes with a `material`, but those with `contact: false`. */
#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/reader.h"
#include "io/document/value.h"
#include "io/model/mesh.h"
#include "io/model/model.h"
#include "io/read/materials.h"
#include "io/read/sections.h"

bool se3di_read_key_count(se3di_reader *reader, const se3di_node *map, const char *key,
                          double largest, double *value)
{
    if (!se3di_read_key_number(reader, map, key, SE3DI_NOT_NEGATIVE, value)) {
        return false;
    }
    if (*value > largest || floor(*value) < *value) {
        return se3di_reader_fail_key(reader, map, key, "is %g, must be a whole number from 0 to %g",
                                     *value, largest);
    }
    return true;
}

static bool create_material(se3di_reader *reader, const se3di_node *entry, se3d_material *material)
{
    se3d_material_def def = se3d_material_def_default();
    const struct {
        const char *key;
        double *value;
    } numbers[] = {{"density", &def.density},
                   {"friction", &def.friction},
                   {"restitution", &def.restitution},
                   {"rolling_friction", &def.rolling_friction},
                   {"torsional_friction", &def.torsional_friction},
                   {"stiffness", &def.stiffness},
                   {"tangential_ratio", &def.tangential_ratio},
                   {"young", &def.young},
                   {"poisson", &def.poisson},
                   {"cohesion", &def.cohesion},
                   {"adhesion", &def.adhesion}};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
        if (!se3di_read_key_number(reader, entry, numbers[i].key, SE3DI_ANY, numbers[i].value)) {
            return false;
        }
    }
    const se3d_status status = se3d_material_create(reader->system, &def, material);
    return status < 0 ? se3di_reader_fail_system(reader, entry, status) : true;
}

bool se3di_reader_find_material(se3di_reader *reader, const char *name, se3d_material *material)
{
    se3d_material *materials = reader->model->materials;
    const se3di_node *list = se3di_node_get(reader->model->root, "materials");
    const se3di_node *entry = list ? list->first : NULL;
    size_t k = 0;
    for (; entry && strcmp(se3di_node_get(entry, "name")->text, name) != 0; entry = entry->next) {
        ++k;
    }
    if (!entry || (materials[k].index1 == 0 && !create_material(reader, entry, &materials[k]))) {
        return false;
    }
    *material = materials[k];
    return true;
}

bool se3di_read_key_material(se3di_reader *reader, const se3di_node *map, const char *key,
                             se3d_material *material)
{
    const se3di_node *node = se3di_node_get(map, key);
    const char *name = NULL;
    if (!node) {
        return se3di_reader_fail_key(reader, map, key, "is missing, must be one of `materials`");
    }
    if (!se3di_read_text(reader, node, &name)) {
        return false;
    }
    if (se3di_reader_find_material(reader, name, material)) {
        return true;
    }
    return reader->status < 0
               ? false
               : se3di_reader_fail(reader, node,
                                   "no material is named `%.60s`; list it under `materials`", name);
}

static bool read_settings(se3di_reader *reader, const se3di_node *contact)
{
    static const char *const laws[] = {"hooke", "hertz_mindlin", NULL};
    se3d_contact_settings settings = se3d_contact_settings_default();
    const se3di_node *word = se3di_node_get(contact, "law");
    size_t law = 0;
    if (!se3di_read_keys(reader, contact, SE3DI_OBJECT_CONTACT) ||
        (word && !se3di_read_word(reader, word, laws, &law)) ||
        !se3di_read_key_number(reader, contact, "step", SE3DI_POSITIVE, &settings.step) ||
        !se3di_read_key_number(reader, contact, "overlap_limit", SE3DI_POSITIVE,
                               &settings.overlap_limit)) {
        return false;
    }
    settings.law = (int32_t)law;
    const se3d_status status = se3d_system_set_contact(reader->system, &settings);
    return status < 0 ? se3di_reader_fail_system(reader, contact, status) : true;
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
        if (!se3di_read_keys(reader, node, SE3DI_OBJECT_PAIR) ||
            !se3di_read_key_material(reader, node, "material_1", &a) ||
            !se3di_read_key_material(reader, node, "material_2", &b) ||
            !se3di_read_key_number(reader, node, "friction", SE3DI_NOT_NEGATIVE, &def.friction) ||
            !se3di_read_key_restitution(reader, node, &def.restitution) ||
            !se3di_read_key_number(reader, node, "rolling_friction", SE3DI_NOT_NEGATIVE,
                                   &def.rolling_friction) ||
            !se3di_read_key_number(reader, node, "torsional_friction", SE3DI_NOT_NEGATIVE,
                                   &def.torsional_friction) ||
            !se3di_read_key_number(reader, node, "stiffness", SE3DI_POSITIVE, &def.stiffness) ||
            !se3di_read_key_number(reader, node, "cohesion", SE3DI_NOT_NEGATIVE, &def.cohesion) ||
            !se3di_read_key_number(reader, node, "adhesion", SE3DI_NOT_NEGATIVE, &def.adhesion)) {
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
    const se3di_node *name = se3di_node_get(node, "name");
    const double most = 4294967295.0;
    double group = 1.0;
    double mask = most;
    if ((name && !se3di_read_name(reader, name, &def->name)) ||
        !se3di_read_key_material(reader, node, "material", &def->material) ||
        !se3di_read_key_count(reader, node, "group", most, &group) ||
        !se3di_read_key_count(reader, node, "mask", most, &mask)) {
        return false;
    }
    def->group = (uint32_t)group;
    def->mask = (uint32_t)mask;
    return true;
}

static bool create_shape(se3di_reader *reader, const se3di_node *node,
                         const se3di_shape_entry *entry)
{
    const se3d_model_shape *shape = &entry->shape;
    const se3di_mesh *mesh = entry->mesh;
    static se3d_status (*const create[])(se3d_system *, const se3d_shape_def *, se3d_shape *) = {
        se3d_shape_create_sphere,   se3d_shape_create_box,   se3d_shape_create_capsule,
        se3d_shape_create_cylinder, se3d_shape_create_plane, se3d_shape_create_mesh};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape made;
    int32_t fixed = 0;
    if (!read_shape_keys(reader, node, &def)) {
        return false;
    }
    def.body = shape->body;
    def.radius = shape->radius;
    def.length = shape->length;
    memcpy(def.position, shape->position, sizeof def.position);
    memcpy(def.orientation, shape->orientation, sizeof def.orientation);
    memcpy(def.size, shape->size, sizeof def.size);
    if (mesh) {
        def.vertices = mesh->points;
        def.vertex_count = mesh->point_count;
        def.triangles = mesh->triangles;
        def.triangle_count = mesh->triangle_count;
    }
    se3d_status status =
        (entry->convex ? se3d_shape_create_hull : create[shape->type])(reader->system, &def, &made);
    if (status >= 0) {
        status = se3d_body_get_fixed(reader->system, shape->body, &fixed);
    }
    reader->model->moving_shapes = reader->model->moving_shapes || !fixed;
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

/* Shapes were read in the order of the bodies. */
static bool create_shapes(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *bodies = se3di_node_get(root, "bodies");
    size_t index = 0;
    for (const se3di_node *body = bodies ? bodies->first : NULL; body; body = body->next) {
        const se3di_node *shapes = se3di_node_get(body, "shapes");
        for (const se3di_node *node = shapes ? shapes->first : NULL; node; node = node->next) {
            const se3di_shape_entry *entry = &reader->model->shapes[index++];
            const se3di_node *word = se3di_node_get(node, "contact");
            int32_t wanted = 1;
            if (word && !se3di_read_bool(reader, word, &wanted)) {
                return false;
            }
            if (wanted && se3di_node_get(node, "material") && !create_shape(reader, node, entry)) {
                return false;
            }
        }
    }
    return true;
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
    return (!contact || read_settings(reader, contact)) && create_shapes(reader, root) &&
           (!contact || read_pairs(reader, contact));
}
