/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/read/clumps.h"

#include <stdint.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/read/entries.h"
#include "io/read/inertia.h"
#include "io/read/objects.h"
#include "io/read/particle_clumps.h"
#include "se3d/clump.h"

/* clang-format off */
static const se3di_key clump_keys[] = {
    {"name", SE3DI_KIND_NAME, .required = true, .text = "unique among the clumps"},
    {"spheres", SE3DI_KIND_LIST, .required = true, .object = "sphere",
     .text = "which may overlap; what overlaps counts once"},
    {"mass", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, SE3DI_INTO(se3d_clump_def, mass),
     .standard = "by the density", .text = "[kg]"},
    {"centre", SE3DI_KIND_VECTOR, SE3DI_INTO(se3d_clump_def, centre),
     .standard = "[0, 0, 0]", .text = "with mass: where it is, frame of the clump [m]"},
    {"inertia", SE3DI_KIND_INERTIA,
     .text = "with mass: about the centre of mass, axes of the clump [kg m^2]"},
    {.key = NULL}};
const se3di_object se3di_object_clump = {
    "clump",
    "A particle of several spheres that are held together.",
    clump_keys, NULL,
    NULL};

static const se3di_key sphere_keys[] = {
    {"position", SE3DI_KIND_VECTOR, .required = true, .text = "centre, frame of the clump [m]"},
    {"radius", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .required = true, .text = "[m]"},
    {.key = NULL}};
const se3di_object se3di_object_sphere = {
    "sphere",
    "A sphere of a clump.",
    sphere_keys, NULL,
    NULL};
/* clang-format on */

static bool read_spheres(se3di_reader *reader, const se3di_node *node, se3d_clump_def *def)
{
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, node, "spheres", &list)) {
        return false;
    }
    if (!list || list->count == 0) {
        return se3di_reader_fail_key(
            reader, node, "spheres",
            "is missing, must be a list of {position: [x, y, z], radius: r}");
    }
    double *numbers = se3di_iopool_array(&reader->model->pool, 4 * list->count, sizeof *numbers);
    if (!numbers) {
        return se3di_reader_fail_memory(reader);
    }
    def->r = numbers;
    def->radius = numbers + 3 * list->count;
    for (const se3di_node *child = list->first; child; child = child->next, ++def->count) {
        double *r = numbers + 3 * def->count, *radius = numbers + 3 * list->count + def->count;
        if (!se3di_read_keys(reader, child, &se3di_object_sphere)) {
            return false;
        }
        if (!se3di_node_get(child, "position") || !se3di_node_get(child, "radius")) {
            return se3di_reader_fail(reader, child, "must have `position` and `radius`");
        }
        if (!se3di_read_key_vector(reader, child, "position", r) ||
            !se3di_read_key_number(reader, child, "radius", SE3DI_POSITIVE, radius)) {
            return false;
        }
    }
    return true;
}

static bool read_mass(se3di_reader *reader, const se3di_node *node, se3d_clump_def *def)
{
    static const char *const needed[] = {"centre", "inertia", NULL};
    const se3di_node *inertia = se3di_node_get(node, "inertia");
    if (!se3di_read_fields(reader, node, &se3di_object_clump, NULL, "se3d_clump_def", def)) {
        return false;
    }
    for (size_t k = 0; !se3di_node_get(node, "mass") && needed[k]; ++k) {
        if (se3di_node_get(node, needed[k])) {
            return se3di_reader_fail_key(reader, node, needed[k], "needs `mass` beside it");
        }
    }
    if (se3di_node_get(node, "mass") && !inertia) {
        return se3di_reader_fail_key(reader, node, "inertia",
                                     "is missing beside `mass` (without both, the density of the "
                                     "material counts)");
    }
    return !inertia || se3di_read_inertia(reader, inertia, def->inertia);
}

static bool read_clump(se3di_reader *reader, const se3di_node *node)
{
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *child = se3di_node_get(node, "name");
    se3d_clump_def def = se3d_clump_def_default();
    const char *name = NULL;
    if (!se3di_read_keys(reader, node, &se3di_object_clump)) {
        return false;
    }
    if (!child) {
        return se3di_reader_fail_key(reader, node, "name", "is missing");
    }
    if (!se3di_read_name(reader, child, &name)) {
        return false;
    }
    if (se3di_tagged_find(particles, SE3DI_TAGGED_CLUMP, name) != SIZE_MAX) {
        return se3di_reader_fail(reader, child, "`%.60s` is taken, must differ from other clumps",
                                 name);
    }
    if (!read_spheres(reader, node, &def) || !read_mass(reader, node, &def)) {
        return false;
    }
    se3di_clump_entry *entry = &particles->clump_entries[particles->clump_count];
    uint32_t index = 0;
    se3d_status status = se3d_particles_add_clump_template(particles->set, &def, &index);
    if (status >= 0) {
        entry->def = def;
        status = se3d_particles_get_clump_template(particles->set, index, &entry->info);
    }
    if (status < 0) {
        return se3di_reader_fail_system(reader, node, status);
    }
    particles->clumps[particles->clump_count++] = name;
    return true;
}

bool se3di_read_clumps(se3di_reader *reader, const se3di_node *root)
{
    se3di_tagged *particles = reader->model->particles;
    const se3di_node *list = NULL;
    if (!se3di_read_list(reader, root, "clumps", &list)) {
        return false;
    }
    particles->clumps = se3di_read_room(reader, list, sizeof *particles->clumps);
    particles->clump_entries = se3di_iopool_array(&reader->model->pool, list ? list->count : 1,
                                                  sizeof *particles->clump_entries);
    if (!particles->clumps || !particles->clump_entries) {
        return se3di_reader_fail_memory(reader);
    }
    return se3di_read_entries(reader, list, read_clump);
}

bool se3di_read_key_clump(se3di_reader *reader, const se3di_node *map, uint32_t *clump)
{
    const se3di_node *node = se3di_node_get(map, "clump");
    const char *name = NULL;
    *clump = 0;
    if (!node) {
        return true;
    }
    if (!se3di_read_text(reader, node, &name)) {
        return false;
    }
    const size_t k = se3di_tagged_find(reader->model->particles, SE3DI_TAGGED_CLUMP, name);
    if (k == SIZE_MAX) {
        return se3di_reader_fail(reader, node, "no clump is named `%.60s`; list it under `clumps`",
                                 name);
    }
    *clump = (uint32_t)k + 1;
    return true;
}
