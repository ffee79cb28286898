/* SPDX-License-Identifier: BSD-3-Clause */
/* Snapshots of particles, in ascending order of the ids. */
#include "io/write/particle_list.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/model/model.h"
#include "io/model/tagged.h"
#include "io/write/csv.h"
#include "se3d/clump.h"

enum {
    ID = 1,
    MATERIAL = 12, /* columns: numbers before it */
    SET,
    FORCE,
    CLUMP,
    COLUMNS
};

const char *se3di_tagged_get_column(size_t k)
{
    static const char *const names[COLUMNS] = {"time",     "id",  "radius", "x",    "y",  "z",
                                               "vx",       "vy",  "vz",     "wx",   "wy", "wz",
                                               "material", "set", "force",  "clump"};
    return names[k];
}

se3di_table_columns se3di_tagged_get_kinds(void)
{
    const se3di_table_columns kinds = {1u << MATERIAL | 1u << SET, 1u << ID | 1u << CLUMP};
    return kinds;
}

size_t se3di_tagged_count_columns(const se3d_model *model)
{
    return model->particles->clump_count > 0 ? COLUMNS : CLUMP;
}

static const char *name_of(const se3d_model *model, se3d_material material)
{
    const se3di_node *list = se3di_node_get(model->root, "materials");
    size_t k = 0;
    for (const se3di_node *node = list ? list->first : NULL; node; node = node->next, ++k) {
        if (model->materials[k].index1 == material.index1 &&
            model->materials[k].generation == material.generation) {
            return se3di_node_get(node, "name")->text;
        }
    }
    return "";
}

/* Numbers of all particles, [n], [3 n], [3 n], [3 n], [3 n] in turn. */
static se3d_status read_set(const se3d_particles *set, size_t n, double *numbers, uint32_t *ids,
                            se3di_particle_rows *out, se3d_material *materials)
{
    se3d_status status = se3d_particles_get_ids(set, n, ids);
    if (status >= 0) {
        status = se3d_particles_get_radii(set, n, numbers);
    }
    if (status >= 0) {
        status = se3d_particles_get_all(set, n, numbers + n, numbers + 4 * n, numbers + 7 * n);
    }
    if (status >= 0) {
        status = se3d_particles_get_forces(set, n, numbers + 10 * n, NULL);
    }
    if (status >= 0) {
        status = se3d_particles_get_tags(set, n, out->tags);
    }
    return status < 0 ? status : se3d_particles_get_materials(set, n, materials);
}

se3d_status se3di_tagged_get_rows(const se3d_model *model, se3di_iopool *pool,
                                  se3di_particle_rows *out)
{
    enum { WIDTH = SE3DI_PARTICLE_COLUMNS };
    const se3d_particles *set = model->particles->set;
    const size_t n = se3d_particles_count(set);
    uint32_t *ids = se3di_iopool_array(pool, n + 1, sizeof *ids);
    uint32_t *clumps = se3di_iopool_array(pool, n + 1, sizeof *clumps);
    double *numbers = se3di_iopool_array(pool, 13 * n + 1, sizeof *numbers);
    se3d_material *materials = se3di_iopool_array(pool, n + 1, sizeof *materials);
    double time = 0.0;
    out->count = 0;
    out->rows = se3di_iopool_array(pool, WIDTH * n + 1, sizeof *out->rows);
    out->tags = se3di_iopool_array(pool, n + 1, sizeof *out->tags);
    out->materials = se3di_iopool_array(pool, n + 1, sizeof *out->materials);
    if (!ids || !clumps || !numbers || !materials || !out->rows || !out->tags || !out->materials) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_status status = se3d_particles_get_time(set, &time);
    if (status >= 0) {
        status = read_set(set, n, numbers, ids, out, materials);
    }
    if (status >= 0) {
        status = se3d_particles_get_clump_of(set, n, clumps);
    }
    for (size_t k = 0; k < n && status >= 0; ++k) {
        double *row = out->rows + WIDTH * k;
        row[0] = time;
        row[1] = (double)ids[k];
        row[2] = numbers[k];
        for (size_t v = 0; v < 3; ++v) {
            memcpy(row + 3 + 3 * v, numbers + n + 3 * (v * n + k), 3 * sizeof *row);
        }
        const double *f = numbers + 10 * n + 3 * k;
        row[12] = sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]);
        row[13] = clumps[k] == UINT32_MAX ? -1.0 : (double)clumps[k];
        out->materials[k] = name_of(model, materials[k]);
    }
    out->count = status < 0 ? 0 : n;
    return status;
}

se3d_status se3di_tagged_write(const se3d_model *model, se3di_iopool *pool, int32_t set,
                               struct se3di_csv *csv)
{
    se3di_particle_rows particles;
    se3di_csv_cell cells[COLUMNS] = {{NULL, 0.0}};
    const se3d_status status = se3di_tagged_get_rows(model, pool, &particles);
    for (size_t k = 0; k < particles.count; ++k) {
        if (set >= 0 && particles.tags[k] != (uint32_t)set) {
            continue;
        }
        const double *row = particles.rows + SE3DI_PARTICLE_COLUMNS * k;
        for (size_t c = 0; c < MATERIAL; ++c) {
            cells[c].number = row[c];
        }
        const char *name = model->particles->sets[particles.tags[k]];
        cells[MATERIAL].text = particles.materials[k];
        cells[SET].text = name ? name : "";
        cells[FORCE].number = row[12];
        cells[CLUMP].number = row[13];
        se3di_csv_put_cells(csv, cells, se3di_tagged_count_columns(model));
    }
    return status;
}
