/* SPDX-License-Identifier: BSD-3-Clause */
/* `contact` and `particles`; the walls are planes and boxes of bodies that have
 * a `material`. */
#include <math.h>
#include <string.h>

#include "io/grains.h"
#include "io/reader.h"

/* The material under `key`, made where it is needed first. */
static bool read_material(se3di_reader *reader, const se3di_node *map, const char *key,
                          se3d_material *material)
{
    se3di_grains *grains = reader->model->grains;
    const se3di_node *node = se3di_node_get(map, key);
    const se3di_node *list = se3di_node_get(reader->model->root, "materials");
    const se3di_node *entry = list ? list->first : NULL;
    se3d_material_def def = se3d_material_def_default();
    const char *name = NULL;
    size_t k = 0;
    if (!node) {
        return se3di_reader_fail_key(reader, map, key, "is missing, must be one of `materials`");
    }
    if (!se3di_read_text(reader, node, &name)) {
        return false;
    }
    for (; entry && strcmp(se3di_node_get(entry, "name")->text, name) != 0; entry = entry->next) {
        ++k;
    }
    if (!entry) {
        return se3di_reader_fail(reader, node,
                                 "no material is named `%.60s`; list it under "
                                 "`materials`",
                                 name);
    }
    if (grains->materials[k].index1 == 0) {
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
                       {"poisson", &def.poisson}};
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
            if (!se3di_read_key_number(reader, entry, numbers[i].key, SE3DI_NOT_NEGATIVE,
                                       numbers[i].value)) {
                return false;
            }
        }
        const se3d_status status =
            se3d_material_create(reader->model->system, &def, &grains->materials[k]);
        if (status < 0) {
            return se3di_reader_fail_system(reader, entry, status);
        }
    }
    *material = grains->materials[k];
    return true;
}

static bool read_count(se3di_reader *reader, const se3di_node *map, const char *key, double largest,
                       double *value)
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

static bool read_boundaries(se3di_reader *reader, const se3di_node *map, se3d_particles_def *def)
{
    static const char *const words[] = {"open", "periodic", "sink", NULL};
    const se3di_node *list = se3di_node_get(map, "boundary");
    size_t k = 0;
    if (list && (list->kind != SE3DI_NODE_LIST || list->count != 3)) {
        return se3di_reader_fail(reader, list,
                                 "must be a list of 3 words, for x, y and z: open, "
                                 "periodic or sink");
    }
    for (const se3di_node *child = list ? list->first : NULL; child; child = child->next) {
        size_t word = 0;
        if (!se3di_read_word(reader, child, words, &word)) {
            return false;
        }
        def->boundary[k++] = (int32_t)word;
    }
    return se3di_read_key_vector(reader, map, "lower", def->lower) &&
           se3di_read_key_vector(reader, map, "upper", def->upper);
}

static bool create_set(se3di_reader *reader, const se3di_node *contact)
{
    static const char *const laws[] = {"hooke", "hertz_mindlin", NULL};
    se3d_system *system = reader->model->system;
    se3d_particles_def def = se3d_particles_def_default();
    se3d_contact_settings settings = se3d_contact_settings_default();
    double threads = 1.0;
    size_t law = 0;
    if (contact) {
        const se3di_node *word = se3di_node_get(contact, "law");
        if (!se3di_read_keys(reader, contact, SE3DI_OBJECT_CONTACT) ||
            (word && !se3di_read_word(reader, word, laws, &law)) ||
            !read_count(reader, contact, "threads", 1024.0, &threads) ||
            !se3di_read_key_number(reader, contact, "step", SE3DI_POSITIVE, &settings.step) ||
            !se3di_read_key_number(reader, contact, "skin", SE3DI_POSITIVE, &def.skin) ||
            !se3di_read_key_number(reader, contact, "overlap_limit", SE3DI_POSITIVE,
                                   &settings.overlap_limit) ||
            !read_boundaries(reader, contact, &def)) {
            return false;
        }
    }
    settings.law = (int32_t)law;
    def.threads = (int32_t)threads;
    se3d_status status = se3d_system_set_contact(system, &settings);
    if (status >= 0) {
        status = se3d_particles_create(system, &def, &reader->model->grains->set);
    }
    return status < 0
               ? se3di_reader_fail_system(reader, contact ? contact : reader->model->root, status)
               : true;
}

static bool add_wall(se3di_reader *reader, const se3di_node *node, const se3d_model_shape *shape)
{
    static se3d_status (*const create[])(se3d_system *, const se3d_shape_def *, se3d_shape *) = {
        se3d_shape_create_sphere, se3d_shape_create_box, se3d_shape_create_capsule,
        se3d_shape_create_cylinder, se3d_shape_create_plane};
    se3d_shape_def def = se3d_shape_def_default();
    se3d_shape made;
    int32_t fixed = 0;
    if (!read_material(reader, node, "material", &def.material)) {
        return false;
    }
    def.body = shape->body;
    def.radius = shape->radius;
    def.length = shape->length;
    memcpy(def.position, shape->position, sizeof def.position);
    memcpy(def.orientation, shape->orientation, sizeof def.orientation);
    memcpy(def.size, shape->size, sizeof def.size);
    se3d_status status = create[shape->type](reader->model->system, &def, &made);
    if (status >= 0) {
        status = se3d_body_get_fixed(reader->model->system, shape->body, &fixed);
    }
    reader->model->grains->moving_walls = reader->model->grains->moving_walls || !fixed;
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

/* Shapes were read in the order of the bodies. */
static bool add_walls(se3di_reader *reader, const se3di_node *root)
{
    const se3di_node *bodies = se3di_node_get(root, "bodies");
    size_t index = 0;
    for (const se3di_node *body = bodies ? bodies->first : NULL; body; body = body->next) {
        const se3di_node *shapes = se3di_node_get(body, "shapes");
        for (const se3di_node *node = shapes ? shapes->first : NULL; node; node = node->next) {
            const se3d_model_shape *shape = &reader->model->shapes[index++];
            if (se3di_node_get(node, "material") && !add_wall(reader, node, shape)) {
                return false;
            }
        }
    }
    return true;
}

static bool read_pairs(se3di_reader *reader, const se3di_node *contact)
{
    const se3di_node *list = NULL;
    if (!contact || !se3di_read_list(reader, contact, "pairs", &list)) {
        return !contact;
    }
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next) {
        se3d_material_pair_def def = se3d_material_pair_def_default();
        se3d_material a;
        se3d_material b;
        if (!se3di_read_keys(reader, node, SE3DI_OBJECT_PAIR) ||
            !read_material(reader, node, "material_1", &a) ||
            !read_material(reader, node, "material_2", &b) ||
            !se3di_read_key_number(reader, node, "friction", SE3DI_NOT_NEGATIVE, &def.friction) ||
            !se3di_read_key_number(reader, node, "restitution", SE3DI_POSITIVE, &def.restitution) ||
            !se3di_read_key_number(reader, node, "rolling_friction", SE3DI_NOT_NEGATIVE,
                                   &def.rolling_friction) ||
            !se3di_read_key_number(reader, node, "torsional_friction", SE3DI_NOT_NEGATIVE,
                                   &def.torsional_friction) ||
            !se3di_read_key_number(reader, node, "stiffness", SE3DI_POSITIVE, &def.stiffness)) {
            return false;
        }
        const se3d_status status = se3d_material_set_pair(reader->model->system, a, b, &def);
        if (status < 0) {
            return se3di_reader_fail_system(reader, node, status);
        }
    }
    return true;
}

/* One radius, or [smallest, largest]. */
static bool read_radius(se3di_reader *reader, const se3di_node *node, se3d_fill_def *def)
{
    const se3di_node *radius = se3di_node_get(node, "radius");
    double range[2];
    if (!radius) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "is missing, must be a number or [smallest, largest] [m]");
    }
    if (radius->kind != SE3DI_NODE_LIST) {
        if (!se3di_read_number(reader, radius, SE3DI_POSITIVE, &def->radius_min)) {
            return false;
        }
        def->radius_max = def->radius_min;
        return true;
    }
    if (!se3di_read_vector(reader, radius, 2, range)) {
        return false;
    }
    def->radius_min = range[0];
    def->radius_max = range[1];
    return true;
}

static bool read_fill(se3di_reader *reader, const se3di_node *node)
{
    static const char *const packings[] = {"lattice", "random", NULL};
    se3d_particles *set = reader->model->grains->set;
    const se3di_node *packing = se3di_node_get(node, "packing");
    se3d_fill_def def = se3d_fill_def_default();
    double count = 0.0;
    double seed = 0.0;
    size_t word = 0;
    if (!se3di_read_keys(reader, node, SE3DI_OBJECT_PARTICLES) ||
        (packing && !se3di_read_word(reader, packing, packings, &word)) ||
        !read_material(reader, node, "material", &def.material) ||
        !read_count(reader, node, "count", 1e8, &count) || !read_radius(reader, node, &def) ||
        !se3di_read_key_vector(reader, node, "lower", def.lower) ||
        !se3di_read_key_vector(reader, node, "upper", def.upper) ||
        !se3di_read_key_vector(reader, node, "velocity", def.velocity) ||
        !se3di_read_key_number(reader, node, "spacing", SE3DI_POSITIVE, &def.spacing) ||
        !se3di_read_key_number(reader, node, "jitter", SE3DI_NOT_NEGATIVE, &def.jitter) ||
        !read_count(reader, node, "seed", 9007199254740992.0, &seed)) {
        return false;
    }
    def.count = (size_t)count;
    def.seed = (uint64_t)seed;
    const se3d_status status = word == 0 ? se3d_particles_fill_lattice(set, &def, NULL)
                                         : se3d_particles_fill_random(set, &def);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

/* The particles feel the bodies, but not yet the bodies the particles. */
static bool check_analyses(se3di_reader *reader)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; k < model->analysis_count && model->grains->moving_walls; ++k) {
        const se3di_analysis_entry *entry = &model->analyses[k];
        if (strcmp(entry->analysis.type, "kinematics") != 0) {
            return se3di_reader_fail_key(reader, entry->node ? entry->node : model->root, "type",
                                         "is `%s`, must be kinematics where walls of particles "
                                         "move: the force of the particles does not go back to "
                                         "the bodies yet",
                                         entry->analysis.type);
        }
    }
    return true;
}

bool se3di_read_particles(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *contact = se3di_node_get(root, "contact");
    const se3di_node *materials = se3di_node_get(root, "materials");
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "particles", &list)) {
        return false;
    }
    if (!list) {
        return contact ? se3di_reader_fail(reader, contact,
                                           "needs `particles`: contact between bodies is not "
                                           "supported yet")
                       : true;
    }
    model->grains = se3di_iopool_alloc(&model->pool, sizeof *model->grains);
    if (model->grains) {
        model->grains->materials = se3di_iopool_array(
            &model->pool, materials ? materials->count : 1, sizeof *model->grains->materials);
    }
    if (!model->grains || !model->grains->materials) {
        return se3di_reader_fail_memory(reader);
    }
    if (!create_set(reader, contact) || !add_walls(reader, root) || !read_pairs(reader, contact)) {
        return false;
    }
    for (const se3di_node *node = list->first; node; node = node->next) {
        if (!read_fill(reader, node)) {
            return false;
        }
    }
    return check_analyses(reader);
}
