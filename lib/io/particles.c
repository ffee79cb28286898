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
    const se3d_status status =
        se3d_particles_create(reader->model->system, &def, &reader->model->grains->set);
    return status < 0
               ? se3di_reader_fail_system(reader, contact ? contact : reader->model->root, status)
               : true;
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
        !se3di_read_key_material(reader, node, "material", &def.material) ||
        !se3di_read_key_count(reader, node, "count", 1e8, &count) ||
        !read_radius(reader, node, &def) ||
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

/* The particles feel the bodies, but not yet the bodies the particles. */
static bool check_analyses(se3di_reader *reader)
{
    const se3d_model *model = reader->model;
    for (size_t k = 0; k < model->analysis_count && model->moving_shapes; ++k) {
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
