/* SPDX-License-Identifier: BSD-3-Clause */
/* Roads as a model file: each by its definition, in the frame of its body. */
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/model/model.h"
#include "io/write/save.h"

/* Whether a definition has the numbers that were read, not others that calls gave since. */
static bool is_as_read(const se3di_element_entry *entry, const se3d_road_def *def)
{
    const se3di_mesh *mesh = entry->surface;
    if (def->heights && entry->heights) {
        return def->row_count == entry->row_count && def->column_count == entry->column_count &&
               memcmp(def->heights, entry->heights,
                      def->row_count * def->column_count * sizeof *def->heights) == 0;
    }
    return def->triangles && mesh && def->vertex_count == mesh->point_count &&
           def->triangle_count == mesh->triangle_count &&
           memcmp(def->vertices, mesh->points, 3 * def->vertex_count * sizeof *mesh->points) == 0 &&
           memcmp(def->triangles, mesh->triangles,
                  3 * def->triangle_count * sizeof *mesh->triangles) == 0;
}

/* The entry of a model whose file has the points of a road, as they are; NULL: there is none. */
static const se3di_element_entry *find_file(const se3di_save *s, se3d_road road,
                                            const se3d_road_def *def)
{
    for (size_t k = 0; s->model && k < s->model->element_count; ++k) {
        const se3di_element_entry *entry = &s->model->elements[k];
        if (entry->kind == SE3DI_ELEMENT_ROAD && entry->road.index1 == road.index1 &&
            entry->road.generation == road.generation) {
            const se3di_node *file = se3di_node_get(entry->node, "file");
            return file && file->text && !se3di_placement_is_reflected(&entry->part->place) &&
                           is_as_read(entry, def)
                       ? entry
                       : NULL;
        }
    }
    return NULL;
}

static void save_height(se3di_save *s, const se3d_road_def *def)
{
    static const char *const variables[] = {"t", "x", "y", NULL};
    se3di_save_word(s, "type", "height");
    se3di_save_function(s, "height", def->height, variables);
}

static void put_file(se3di_save *s, const se3di_element_entry *entry)
{
    const char *file = se3di_node_get(entry->node, "file")->text;
    se3di_save_text(s, "file", se3di_save_get_file(s, entry->part, file));
}

static void save_grid(se3di_save *s, const se3d_road_def *def, const se3di_element_entry *entry)
{
    se3di_save_word(s, "type", "heightfield");
    se3di_save_spacing(s, def->spacing);
    if (entry && se3di_save_is_in_metres(entry->part)) {
        put_file(s, entry);
    } else {
        se3di_save_heights(s, def->heights, 1, def->row_count, def->column_count);
    }
}

static void save_mesh(se3di_save *s, const se3di_element_entry *entry, const char *name)
{
    if (!entry) {
        se3di_save_refuse(s, "road %.100s is a mesh that no file has", name);
        return;
    }
    se3di_save_word(s, "type", "mesh");
    put_file(s, entry);
    se3di_save_number_but(s, "scale", entry->surface->scale, 1.0);
}

static void save_road(se3di_save *s, se3d_road road, const char *name)
{
    se3d_road_def def = se3d_road_def_default();
    (void)se3d_road_get_def(s->system, road, &def);
    const se3di_element_entry *entry = find_file(s, road, &def);
    se3di_save_text(s, "name", name);
    if (def.height.index1 != 0) {
        save_height(s, &def);
    } else if (def.heights) {
        save_grid(s, &def, entry);
    } else if (def.triangles) {
        save_mesh(s, entry, name);
    } else {
        se3di_save_word(s, "type", "plane");
    }
    se3di_save_body(s, "body", def.body);
    se3di_save_vector(s, "point", def.point, 3);
    se3di_save_word(s, "frame", "body");
    se3di_save_vector(s, "normal", def.normal, 3);
    se3di_save_vector(s, "forward", def.forward, 3);
}

void se3di_save_roads(se3di_save *s)
{
    se3di_save_begin_section(s, "roads");
    for (size_t k = 0; k < se3d_system_count_roads(s->system); ++k) {
        se3d_road road;
        (void)se3d_system_get_road(s->system, k, &road);
        const char **name = &s->roads.names[road.index1];
        const se3di_save_entry entry = se3di_save_open(s);
        save_road(s, road, *name);
        se3di_save_name_problem(s, "road", *name);
        if (!se3di_save_close(s, &entry)) {
            *name = NULL;
        }
    }
}
