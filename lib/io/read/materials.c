/* SPDX-License-Identifier: BSD-3-Clause */
/* `materials`: their list, and those that are needed. */
#include "io/read/materials.h"

#include <string.h>

#include "io/document/fields.h"
#include "io/document/value.h"
#include "io/read/objects.h"
#include "io/read/sections.h"

/* clang-format off */
static const se3di_key material_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "unique among the materials"},
    {"density", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, density), .text = "[kg/m^3]"},
    {"friction", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, friction), .standard = "0.5",
     .text = "coefficient of sliding"},
    {"restitution", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, restitution),
     .standard = "0.5", .text = "over the speed of approach, the same at any speed, 0.01 to 1"},
    {"damping_ratio", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, damping_ratio),
     .text = "in place of restitution: damping along the normal over the critical one"},
    {"damping_rate", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, damping_rate),
     .text = "of particles, in place of restitution: damping along the normal over the reduced "
             "mass [1/s]; hertz_mindlin: over the radius of contact, too [1/(m s)]"},
    {"rolling_friction", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, rolling_friction),
     .standard = "0", .text = "resisting moment over radius times normal force"},
    {"torsional_friction", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, torsional_friction),
     .standard = "0", .text = "the same about the normal"},
    {"stiffness", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, stiffness),
     .text = "hooke [N/m] > 0"},
    {"rolling_ratio", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, rolling_ratio), .standard = "1",
     .text = "stiffness of rolling and torsion over that of `tangential_ratio`, at most 100"},
    {"rolling_damping", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, rolling_damping), .standard = "1.2",
     .text = "over the root of mass and stiffness of rolling, at most 10"},
    {"tangential_ratio", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, tangential_ratio),
     .standard = "2/7; hertz_mindlin: Mindlin's",
     .text = "tangential over normal stiffness, at most 10"},
    {"tangential_stiffness", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, tangential_stiffness),
     .text = "in place of tangential_ratio, also of hertz_mindlin the same at any overlap [N/m]"},
    {"rolling_stiffness", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, rolling_stiffness),
     .text = "in place of rolling_ratio, also of hertz_mindlin the same at any overlap [N/m]"},
    {"tangential_damping", SE3DI_KIND_NUMBER, SE3DI_NOT_NEGATIVE,
     SE3DI_INTO(se3d_material_def, tangential_damping), .standard = "of the law",
     .text = "over that along the normal, at most 10"},
    {"young", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, young),
     .text = "hertz_mindlin [Pa] > 0"},
    {"poisson", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, poisson), .standard = "0.3",
     .text = "hertz_mindlin, 0 to 0.5"},
    {"cohesion", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, cohesion), .standard = "0",
     .text = "attraction per area of contact [J/m^3]"},
    {"adhesion", SE3DI_KIND_NUMBER, SE3DI_INTO(se3d_material_def, adhesion), .standard = "0",
     .text = "work of adhesion [J/m^2], pull-off force 3/2 pi R* adhesion"},
    {.key = NULL}};
const se3di_object se3di_object_material = {
    "material",
    "What bodies and particles are made of.",
    material_keys, NULL,
    NULL};
/* clang-format on */

/* What has no default: the defaults of the library are no materials. */
static bool check_given(se3di_reader *reader, const se3di_node *entry)
{
    se3d_contact_settings contact = {.struct_size = sizeof contact};
    if (!se3di_node_get(entry, "density")) {
        return se3di_reader_fail_key(reader, entry, "density",
                                     "is missing, must be > 0 (kg/m^3) of a material that a shape "
                                     "or particles have, also where bodies have a mass");
    }
    if (!se3di_reader_check(reader, entry, se3d_system_get_contact(reader->system, &contact))) {
        return false;
    }
    const bool is_hooke = contact.law == SE3D_CONTACT_LAW_HOOKE;
    const char *key = is_hooke ? "stiffness" : "young";
    return se3di_node_get(entry, key) ||
           se3di_reader_fail_key(reader, entry, key, "is missing, must be > 0 (%s) with `law: %s`",
                                 is_hooke ? "N/m" : "Pa", is_hooke ? "hooke" : "hertz_mindlin");
}

/* What was given as none: 0 of a definition is what the law has. */
static void choose(const se3di_node *entry, const char *key, double *value)
{
    if (se3di_node_get(entry, key) && !(*value > 0.0)) {
        *value = -1.0;
    }
}

/* Choices beside what the law has. */
static bool read_choices(se3di_reader *reader, const se3di_node *entry, se3d_material_def *def)
{
    se3d_contact_settings contact = {.struct_size = sizeof contact};
    if (!se3di_reader_check(reader, entry, se3d_system_get_contact(reader->system, &contact))) {
        return false;
    }
    if (contact.law == SE3D_CONTACT_LAW_HERTZ_MINDLIN &&
        se3di_node_get(entry, "tangential_ratio")) {
        def->tangential_ratio_hertz = def->tangential_ratio;
        def->tangential_ratio = se3d_material_def_default().tangential_ratio;
        choose(entry, "tangential_ratio", &def->tangential_ratio_hertz);
    }
    choose(entry, "damping_ratio", &def->damping_ratio);
    choose(entry, "damping_rate", &def->damping_rate);
    choose(entry, "tangential_damping", &def->tangential_damping);
    choose(entry, "rolling_ratio", &def->rolling_ratio);
    choose(entry, "rolling_damping", &def->rolling_damping);
    choose(entry, "tangential_stiffness", &def->tangential_stiffness);
    if (se3di_node_get(entry, "tangential_stiffness") &&
        se3di_node_get(entry, "tangential_ratio")) {
        return se3di_reader_fail_key(reader, entry, "tangential_stiffness",
                                     "stands beside `tangential_ratio`: one follows from the "
                                     "other");
    }
    choose(entry, "rolling_stiffness", &def->rolling_stiffness);
    if (se3di_node_get(entry, "rolling_stiffness") && se3di_node_get(entry, "rolling_ratio")) {
        return se3di_reader_fail_key(reader, entry, "rolling_stiffness",
                                     "stands beside `rolling_ratio`: one follows from the other");
    }
    return !(se3di_node_get(entry, "damping_ratio") && se3di_node_get(entry, "restitution")) ||
           se3di_reader_fail_key(reader, entry, "damping_ratio",
                                 "stands beside `restitution`: one follows from the other");
}

static bool create_material(se3di_reader *reader, const se3di_node *entry, se3d_material *material)
{
    se3d_material_def def = se3d_material_def_default();
    if (!se3di_read_fields(reader, entry, &se3di_object_material, NULL, "se3d_material_def",
                           &def) ||
        !check_given(reader, entry) || !read_choices(reader, entry, &def)) {
        return false;
    }
    def.name = se3di_node_get(entry, "name")->text;
    return se3di_reader_check(reader, entry, se3d_material_create(reader->system, &def, material));
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

bool se3di_read_materials(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *list = NULL;
    const char *name = NULL;
    double density = 0.0;
    if (!se3di_read_list(reader, root, "materials", &list)) {
        return false;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        if (!se3di_read_keys(reader, node, &se3di_object_material) ||
            !se3di_read_key_number(reader, node, "density", SE3DI_POSITIVE, &density)) {
            return false;
        }
        const se3di_node *child = se3di_node_get(node, "name");
        if (!child) {
            return se3di_reader_fail_key(reader, node, "name", "is missing");
        }
        if (!se3di_read_name(reader, child, &name)) {
            return false;
        }
        for (const se3di_node *old = list->first; old != node; old = old->next) {
            if (strcmp(se3di_node_get(old, "name")->text, name) == 0) {
                return se3di_reader_fail(
                    reader, child, "`%.60s` is taken, must differ from other materials", name);
            }
        }
    }
    return true;
}
