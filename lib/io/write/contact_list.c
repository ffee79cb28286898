/* SPDX-License-Identifier: BSD-3-Clause */
#include "io/write/contact_list.h"

#include <string.h>

#include "io/model/tagged.h"

static const char *shape_name(const se3d_model *model, se3d_shape shape)
{
    const char *name = "";
    se3d_body body;
    if (se3d_shape_get_name(model->system, shape, &name) < 0 || name[0] != '\0') {
        return name ? name : "";
    }
    if (se3d_shape_get_body(model->system, shape, &body) < 0 ||
        se3d_body_get_name(model->system, body, &name) < 0) {
        return "";
    }
    return name;
}

/* `force`: on b, `normal`: from a to b. */
static void put_row(se3di_contact_rows *out, double time, const double point[3],
                    const double normal[3], double overlap, const double force[3])
{
    double *row = out->rows + SE3DI_CONTACT_NUMBERS * out->count++;
    row[0] = time;
    row[7] = overlap;
    row[8] = 0.0;
    for (size_t k = 0; k < 3; ++k) {
        row[1 + k] = point[k];
        row[4 + k] = normal[k];
        row[8] += force[k] * normal[k];
    }
    for (size_t k = 0; k < 3; ++k) {
        row[9 + k] = force[k] - row[8] * normal[k];
    }
}

static se3d_status add_particles(const se3d_model *model, const se3di_particle_contacts *particles,
                                 se3di_contact_rows *out)
{
    double time = 0.0;
    const se3d_particles_contact *list = particles->list;
    const size_t count = particles->count;
    const se3d_status status = se3d_particles_get_time(model->particles->set, &time);
    for (size_t k = 0; k < count && status >= 0; ++k) {
        const se3d_particles_contact *c = &list[k];
        const bool wall = c->shape.index1 != 0;
        const double normal[3] = {-c->normal[0], -c->normal[1], -c->normal[2]};
        const double force[3] = {-c->force[0], -c->force[1], -c->force[2]};
        out->kinds[out->count] = wall ? "wall" : "particles";
        out->id_a[out->count] = (double)c->i;
        out->id_b[out->count] = (double)c->j;
        out->b[out->count] = wall ? shape_name(model, c->shape) : NULL;
        put_row(out, time, c->point, normal, c->overlap, force);
    }
    return status;
}

static se3d_status add_bodies(const se3d_model *model, se3di_iopool *pool, size_t count,
                              se3di_contact_rows *out)
{
    double time = 0.0;
    se3d_contact *list = se3di_iopool_array(pool, count + 1, sizeof *list);
    if (!list) {
        return SE3D_ERR_NO_MEMORY;
    }
    se3d_status status = se3d_system_get_time(model->system, &time);
    if (status >= 0) {
        status = se3d_system_get_contacts(model->system, count, list);
    }
    for (size_t k = 0; k < count && status >= 0; ++k) {
        out->kinds[out->count] = "bodies";
        out->a[out->count] = shape_name(model, list[k].shape_i);
        out->b[out->count] = shape_name(model, list[k].shape_j);
        put_row(out, time, list[k].point, list[k].normal, list[k].overlap, list[k].force);
    }
    return status;
}

se3d_status se3di_contacts_get_rows(const se3d_model *model, se3di_sample *sample,
                                    se3di_iopool *pool, se3di_contact_rows *out)
{
    const size_t bodies = se3d_system_count_contacts(model->system);
    se3di_particle_contacts particles = {NULL, 0};
    memset(out, 0, sizeof *out);
    if (model->particles) {
        const se3d_status found =
            se3di_sample_list_contacts(sample, model->particles->set, &particles);
        if (found < 0) {
            return found;
        }
    }
    const size_t room = bodies + particles.count + 1;
    out->rows = se3di_iopool_array(pool, room, SE3DI_CONTACT_NUMBERS * sizeof *out->rows);
    out->kinds = se3di_iopool_array(pool, room, sizeof *out->kinds);
    out->a = se3di_iopool_array(pool, room, sizeof *out->a);
    out->b = se3di_iopool_array(pool, room, sizeof *out->b);
    out->id_a = se3di_iopool_array(pool, room, sizeof *out->id_a);
    out->id_b = se3di_iopool_array(pool, room, sizeof *out->id_b);
    if (!out->rows || !out->kinds || !out->a || !out->b || !out->id_a || !out->id_b) {
        return SE3D_ERR_NO_MEMORY;
    }
    const se3d_status status = bodies > 0 ? add_bodies(model, pool, bodies, out) : SE3D_OK;
    return status < 0 || particles.count == 0 ? status : add_particles(model, &particles, out);
}

se3di_table_columns se3di_contacts_get_kinds(void)
{
    const se3di_table_columns kinds = {1u << 1 | 1u << 2 | 1u << 3, 0};
    return kinds;
}

const char *se3di_contacts_get_column(size_t k)
{
    static const char *const names[SE3DI_CONTACT_COLUMNS] = {
        "time", "kind", "a",       "b",  "x",   "y",   "z",  "nx",
        "ny",   "nz",   "overlap", "fn", "ftx", "fty", "ftz"};
    return names[k];
}

se3d_status se3di_contacts_write(const se3d_model *model, se3di_sample *sample, se3di_iopool *pool,
                                 se3di_csv *csv)
{
    se3di_contact_rows list;
    const se3d_status status = se3di_contacts_get_rows(model, sample, pool, &list);
    for (size_t k = 0; k < list.count && status >= 0; ++k) {
        const double *row = list.rows + SE3DI_CONTACT_NUMBERS * k;
        se3di_csv_cell cells[SE3DI_CONTACT_COLUMNS] = {{NULL, row[0]},
                                                       {list.kinds[k], 0.0},
                                                       {list.a[k], list.id_a[k]},
                                                       {list.b[k], list.id_b[k]}};
        for (size_t c = 4; c < SE3DI_CONTACT_COLUMNS; ++c) {
            cells[c].number = row[c - 3];
        }
        se3di_csv_put_cells(csv, cells, SE3DI_CONTACT_COLUMNS);
    }
    return status;
}
