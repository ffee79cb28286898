/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles during a run. In dynamics the solver moves them with the bodies; in
 * kinematics they follow the bodies, whose motion is given. */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "io/csv.h"
#include "io/grains.h"

se3d_status se3di_grains_advance(const se3d_model *model, const se3d_solver_def *def,
                                 se3d_solver *solver, double time)
{
    const se3di_grains *grains = model->grains;
    if (def->analysis == SE3D_ANALYSIS_DYNAMICS) {
        return se3d_solver_run(solver, time);
    }
    double now = 0.0;
    double step = 0.0;
    se3d_status status = se3d_particles_get_time(grains->set, &now);
    if (status >= 0) {
        status = se3d_particles_get_step(grains->set, &step);
    }
    const double whole =
        grains->moving_walls && step > 0.0 ? fmax(1.0, ceil((time - now) / step - 1e-9)) : 1.0;
    se3d_status last = SE3D_OK;
    for (double k = 1.0; k <= whole && status >= 0; k += 1.0) {
        const double target = k < whole ? now + (time - now) * (k / whole) : time;
        last = se3d_solver_run(solver, target);
        status = last;
        double reached = target; /* less where an event has stopped the bodies */
        if (status >= 0) {
            status = se3d_system_get_time(model->system, &reached);
        }
        if (status >= 0 && reached > now) {
            status = se3d_particles_run(grains->set, reached);
        }
        if (last == SE3D_INFO_EVENT) {
            break;
        }
    }
    return status < 0 ? status : last;
}

const char *se3di_grains_get_column(size_t k)
{
    static const char *const names[SE3DI_GRAIN_COLUMNS + 1] = {
        "time", "id", "radius", "x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz", "material"};
    return names[k];
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

/* Numbers of all particles, [n], [n], [3 n] ... in turn. */
static se3d_status read_set(const se3d_particles *set, size_t n, double *numbers, uint32_t *ids,
                            se3di_grain_rows *out, se3d_material *materials)
{
    se3d_status status = se3d_particles_get_ids(set, n, ids);
    if (status >= 0) {
        status = se3d_particles_get_radii(set, n, numbers);
    }
    if (status >= 0) {
        status = se3d_particles_get_all(set, n, numbers + n, numbers + 4 * n, numbers + 7 * n);
    }
    if (status >= 0) {
        status = se3d_particles_get_tags(set, n, out->tags);
    }
    return status < 0 ? status : se3d_particles_get_materials(set, n, materials);
}

se3d_status se3di_grains_get_rows(const se3d_model *model, se3di_iopool *pool,
                                  se3di_grain_rows *out)
{
    enum { WIDTH = SE3DI_GRAIN_COLUMNS };
    const se3d_particles *set = model->grains->set;
    const size_t n = se3d_particles_count(set);
    uint32_t *ids = se3di_iopool_array(pool, n + 1, sizeof *ids);
    double *numbers = se3di_iopool_array(pool, 10 * n + 1, sizeof *numbers);
    se3d_material *materials = se3di_iopool_array(pool, n + 1, sizeof *materials);
    double time = 0.0;
    out->count = 0;
    out->rows = se3di_iopool_array(pool, WIDTH * n + 1, sizeof *out->rows);
    out->tags = se3di_iopool_array(pool, n + 1, sizeof *out->tags);
    out->materials = se3di_iopool_array(pool, n + 1, sizeof *out->materials);
    if (!ids || !numbers || !materials || !out->rows || !out->tags || !out->materials) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_status status = se3d_particles_get_time(set, &time);
    if (status >= 0) {
        status = read_set(set, n, numbers, ids, out, materials);
    }
    for (size_t k = 0; k < n && status >= 0; ++k) {
        double *row = out->rows + WIDTH * k;
        row[0] = time;
        row[1] = (double)ids[k];
        row[2] = numbers[k];
        for (size_t v = 0; v < 3; ++v) {
            memcpy(row + 3 + 3 * v, numbers + n + 3 * (v * n + k), 3 * sizeof *row);
        }
        out->materials[k] = name_of(model, materials[k]);
    }
    out->count = status < 0 ? 0 : n;
    return status;
}

se3d_status se3di_grains_write(const se3d_model *model, se3di_iopool *pool, int32_t set,
                               struct se3di_csv *csv)
{
    se3di_grain_rows grains;
    se3di_csv_cell cells[SE3DI_GRAIN_COLUMNS + 1] = {{NULL, 0.0}};
    const se3d_status status = se3di_grains_get_rows(model, pool, &grains);
    for (size_t k = 0; k < grains.count; ++k) {
        if (set >= 0 && grains.tags[k] != (uint32_t)set) {
            continue;
        }
        for (size_t c = 0; c < SE3DI_GRAIN_COLUMNS; ++c) {
            cells[c].number = grains.rows[SE3DI_GRAIN_COLUMNS * k + c];
        }
        cells[SE3DI_GRAIN_COLUMNS].text = grains.materials[k];
        se3di_csv_put_cells(csv, cells, SE3DI_GRAIN_COLUMNS + 1);
    }
    return status;
}

static size_t find_name(const char *const *names, size_t count, const char *name)
{
    for (size_t k = 0; k < count; ++k) {
        if (names[k] && strcmp(names[k], name) == 0) {
            return k;
        }
    }
    return SIZE_MAX;
}

size_t se3di_grains_find_set(const se3di_grains *grains, const char *name)
{
    return grains ? find_name(grains->sets, grains->set_count, name) : SIZE_MAX;
}

size_t se3di_grains_find_sink(const se3di_grains *grains, const char *name)
{
    return grains ? find_name(grains->sinks, grains->sink_count, name) : SIZE_MAX;
}

/* What the sources of a set have done. */
static se3d_status sum_sources(const se3di_channel *c, double *value)
{
    for (uint32_t k = 0; k < c->grains->source_count; ++k) {
        se3d_particles_source_stats stats;
        if (c->grains->source_tags[k] != c->index) {
            continue;
        }
        const se3d_status status = se3d_particles_get_source_stats(c->particles, k, &stats);
        if (status < 0) {
            return status;
        }
        *value += c->quantity == SE3DI_SET_INSERTED   ? (double)stats.inserted
                  : c->quantity == SE3DI_SET_DEFERRED ? (double)stats.deferred
                                                      : stats.waiting;
    }
    return SE3D_OK;
}

se3d_status se3di_grains_eval(const se3di_channel *c, double *value)
{
    se3d_particles_tally tally;
    uint64_t count = 0;
    se3d_status status;
    *value = 0.0;
    if (c->quantity == SE3DI_SINK_COUNT) {
        status = se3d_particles_get_sink_count(c->particles, c->index, &count);
        *value = (double)count;
        return status;
    }
    if (c->quantity == SE3DI_SET_INSERTED || c->quantity == SE3DI_SET_DEFERRED ||
        c->quantity == SE3DI_SET_WAITING) {
        return sum_sources(c, value);
    }
    status = se3d_particles_get_tally(c->particles, c->index, &tally);
    if (status >= 0) {
        *value = c->quantity == SE3DI_SET_COUNT  ? (double)tally.count
                 : c->quantity == SE3DI_SET_LOST ? (double)tally.lost
                 : c->quantity == SE3DI_SET_LEFT ? (double)(tally.lost + tally.outside)
                 : c->quantity == SE3DI_SET_MASS ? tally.mass
                                                 : tally.energy;
    }
    return status;
}

/* Of one name. */
static se3d_status sum_up(const se3di_grains *grains, uint32_t tag, se3d_run_particles *sum)
{
    se3d_particles_tally tally;
    se3d_status status = se3d_particles_get_tally(grains->set, tag, &tally);
    *sum = (se3d_run_particles){.name = tag > 0 ? grains->sets[tag] : "particles"};
    if (status >= 0) {
        sum->count = tally.count;
        sum->left = tally.lost + tally.outside;
    }
    for (uint32_t k = 0; k < grains->source_count && status >= 0; ++k) {
        se3d_particles_source_stats stats;
        if (grains->source_tags[k] == tag) {
            status = se3d_particles_get_source_stats(grains->set, k, &stats);
            sum->inserted += status >= 0 ? stats.inserted : 0;
            sum->deferred += status >= 0 ? stats.deferred : 0;
        }
    }
    return status;
}

se3d_status se3di_grains_sum_up(const se3di_grains *grains, se3di_iopool *pool,
                                se3d_run_particles **out, size_t *count)
{
    se3d_run_particles *sums = se3di_iopool_array(pool, grains->set_count, sizeof *sums);
    se3d_status status = sums ? SE3D_OK : SE3D_ERR_NO_MEMORY;
    *count = 0;
    for (uint32_t tag = 0; tag < grains->set_count && status >= 0; ++tag) {
        se3d_run_particles *sum = &sums[*count];
        status = sum_up(grains, tag, sum);
        *count += sum->count + sum->left + sum->inserted > 0 ? 1 : 0;
    }
    *out = sums;
    return status;
}
