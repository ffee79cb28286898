/* SPDX-License-Identifier: BSD-3-Clause */
/* `particles`. */
#include <math.h>
#include <string.h>

#include "io/grains.h"
#include "io/reader.h"

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
    se3d_particles_def def = se3d_particles_def_default();
    double threads = 1.0;
    if (contact && (!se3di_read_key_count(reader, contact, "threads", 1024.0, &threads) ||
                    !se3di_read_key_number(reader, contact, "skin", SE3DI_POSITIVE, &def.skin) ||
                    !read_boundaries(reader, contact, &def))) {
        return false;
    }
    def.threads = (int32_t)threads;
    def.name = "particles";
    const se3d_status status =
        se3d_particles_create(reader->model->system, &def, &reader->model->grains->set);
    return status < 0
               ? se3di_reader_fail_system(reader, contact ? contact : reader->model->root, status)
               : true;
}

/* {table: [[radius, frequency], ...]} */
static bool read_radius_table(se3di_reader *reader, const se3di_node *radius, se3d_fill_def *def)
{
    const se3di_node *table = se3di_node_get(radius, "table");
    if (!se3di_read_keys(reader, radius, SE3DI_OBJECT_RADIUS)) {
        return false;
    }
    if (!table || table->kind != SE3DI_NODE_LIST || table->count == 0) {
        return se3di_reader_fail(
            reader, table ? table : radius,
            "must be {table: [[radius, frequency], ...]} with one pair or more");
    }
    double *numbers = se3di_iopool_array(&reader->model->pool, 2 * table->count, sizeof *numbers);
    if (!numbers) {
        return se3di_reader_fail_memory(reader);
    }
    size_t k = 0;
    for (const se3di_node *pair = table->first; pair; pair = pair->next, ++k) {
        double values[2];
        if (!se3di_read_vector(reader, pair, 2, values)) {
            return false;
        }
        numbers[k] = values[0];
        numbers[table->count + k] = values[1];
    }
    def->radii = numbers;
    def->weights = numbers + table->count;
    def->radius_count = table->count;
    return true;
}

/* The part of the box from `lower` to `upper` that is filled. */
static bool read_region(se3di_reader *reader, const se3di_node *node, se3d_fill_def *def)
{
    static const char *const regions[] = {"box", "cylinder", "sphere", NULL};
    static const char *const axes[] = {"x", "y", "z", NULL};
    const se3di_node *region = se3di_node_get(node, "region");
    const se3di_node *axis = se3di_node_get(node, "axis");
    size_t kind = 0;
    size_t along = 2;
    if ((region && !se3di_read_word(reader, region, regions, &kind)) ||
        (axis && !se3di_read_word(reader, axis, axes, &along))) {
        return false;
    }
    if (axis && kind != SE3D_REGION_CYLINDER) {
        return se3di_reader_fail(reader, axis, "is of `region: cylinder` only");
    }
    def->region = (int32_t)kind;
    def->axis = (int32_t)along;
    return true;
}

/* One radius, [smallest, largest], or a table. */
static bool read_radius(se3di_reader *reader, const se3di_node *node, se3d_fill_def *def)
{
    const se3di_node *radius = se3di_node_get(node, "radius");
    double range[2];
    if (!radius) {
        return se3di_reader_fail_key(reader, node, "radius",
                                     "is missing, must be a number, [smallest, largest] or {table: "
                                     "[[radius, frequency], ...]} [m]");
    }
    if (radius->kind == SE3DI_NODE_MAP) {
        return read_radius_table(reader, radius, def);
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
        !se3di_read_key_material(reader, node, "material", &def.material) ||
        !se3di_read_key_count(reader, node, "count", 1e8, &count) ||
        !read_radius(reader, node, &def) || !read_region(reader, node, &def) ||
        !se3di_read_key_vector(reader, node, "lower", def.lower) ||
        !se3di_read_key_vector(reader, node, "upper", def.upper) ||
        !se3di_read_key_vector(reader, node, "velocity", def.velocity) ||
        !se3di_read_key_number(reader, node, "spacing", SE3DI_POSITIVE, &def.spacing) ||
        !se3di_read_key_number(reader, node, "jitter", SE3DI_NOT_NEGATIVE, &def.jitter) ||
        !se3di_read_key_count(reader, node, "seed", 9007199254740992.0, &seed)) {
        return false;
    }
    def.count = (size_t)count;
    def.seed = (uint64_t)seed;
    const se3d_status status = word == 0 ? se3d_particles_fill_lattice(set, &def, NULL)
                                         : se3d_particles_fill_random(set, &def);
    return status < 0 ? se3di_reader_fail_system(reader, node, status) : true;
}

/* Particles push bodies in `verlet` only; in kinematics the motion of the bodies is given. */
static bool check_analyses(se3di_reader *reader)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; k < model->analysis_count; ++k) {
        const se3di_analysis_entry *entry = &model->analyses[k];
        const se3di_node *node = entry->node ? entry->node : model->root;
        const char *type = entry->analysis.type;
        int32_t method = entry->solver.method;
        if (strcmp(type, "dynamics") != 0 && strcmp(type, "kinematics") != 0 &&
            model->moving_shapes) {
            return se3di_reader_fail_key(reader, node, "type",
                                         "is `%s`, must be dynamics or kinematics where particles "
                                         "touch bodies that move",
                                         type);
        }
        if (strcmp(type, "dynamics") == 0 && method != SE3D_METHOD_AUTO &&
            method != SE3D_METHOD_VERLET) {
            return se3di_reader_fail_key(reader, node, "method",
                                         "must be verlet (or auto, which picks it) where there are "
                                         "particles");
        }
    }
    return true;
}

bool se3di_read_particles(se3di_reader *reader, const se3di_node *root)
{
    se3d_model *model = reader->model;
    const se3di_node *contact = se3di_node_get(root, "contact");
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "particles", &list)) {
        return false;
    }
    if (!list) {
        return true;
    }
    model->grains = se3di_iopool_alloc(&model->pool, sizeof *model->grains);
    if (!model->grains) {
        return se3di_reader_fail_memory(reader);
    }
    model->grains->moving_walls = model->moving_shapes;
    if (!create_set(reader, contact)) {
        return false;
    }
    for (const se3di_node *node = list->first; node; node = node->next) {
        if (!read_fill(reader, node)) {
            return false;
        }
    }
    return check_analyses(reader);
}
