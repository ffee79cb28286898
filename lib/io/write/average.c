/* SPDX-License-Identifier: BSD-3-Clause */
/* With <> for the mean over n times, of each cell:
 *
 *     rho = <rho_k>,   u = <rho_k u_k>/rho,   kinetic stress = <K_k + rho_k u_k u_k> - rho u u
 *
 * so momentum and its flux are averaged, and what fluctuates about the mean over all times counts
 * for stress and temperature.                                          docs/theory/averages.md */
#include "io/write/average.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/model/model.h"
#include "io/model/tagged.h"

static const int rows[6] = {0, 1, 2, 0, 1, 0}, columns[6] = {0, 1, 2, 1, 2, 2};

se3di_average_sum *se3di_average_create(se3d_model *model, se3di_iopool *pool,
                                        const se3di_output_entry *entry)
{
    const se3d_field_grid *grid = entry->grid;
    se3di_average_sum *a = se3di_iopool_alloc(pool, sizeof *a);
    if (!a) {
        return NULL;
    }
    a->model = model;
    a->grid = grid;
    a->cells = (size_t)grid->cells[0] * (size_t)grid->cells[1] * (size_t)grid->cells[2];
    a->time = -HUGE_VAL;
    a->values = se3di_iopool_array(pool, a->cells, SE3D_FIELD_VALUES * sizeof *a->values);
    a->sums = se3di_iopool_array(pool, a->cells, SE3D_FIELD_VALUES * sizeof *a->sums);
    return a->values && a->sums ? a : NULL;
}

/* Momentum and its flux from the means of a cell (sign 1), or the means from them (-1). */
static void convert(double *values, double sign)
{
    const double rho = values[SE3D_FIELD_DENSITY];
    double *u = values + SE3D_FIELD_VELOCITY, *flux = values + SE3D_FIELD_KINETIC_STRESS;
    for (int k = 0; k < 3 && sign < 0.0 && rho > 0.0; ++k) {
        u[k] /= rho;
    }
    for (int k = 0; k < 6; ++k) {
        flux[k] += sign * rho * u[rows[k]] * u[columns[k]];
    }
    for (int k = 0; k < 3 && sign > 0.0; ++k) {
        u[k] *= rho;
    }
}

se3d_status se3di_average_add(se3di_average_sum *average, double time)
{
    if (time <= average->time) { /* the end of an analysis is the beginning of the next one */
        return SE3D_OK;
    }
    const size_t count = average->cells * SE3D_FIELD_VALUES;
    const se3d_status status = se3d_particles_get_fields(average->model->particles->set,
                                                         average->grid, count, average->values);
    if (status < 0) {
        return status;
    }
    for (size_t k = 0; k < average->cells; ++k) {
        convert(average->values + k * SE3D_FIELD_VALUES, 1.0);
    }
    for (size_t k = 0; k < count; ++k) {
        average->sums[k] += average->values[k];
    }
    average->time = time;
    ++average->rows;
    return SE3D_OK;
}

void se3di_average_pack(se3di_average_sum *average, se3di_coder *coder)
{
    size_t cells = average->cells;
    se3di_code_size(coder, &cells);
    coder->failed = coder->failed || cells != average->cells;
    se3di_code_numbers(coder, &average->time, 1);
    se3di_code_word(coder, &average->rows);
    se3di_code_numbers(coder, average->sums, average->cells * SE3D_FIELD_VALUES);
}

const char *se3di_average_get_column(size_t k)
{
    static const char *const names[SE3DI_AVERAGE_COLUMNS] = {"x",
                                                             "y",
                                                             "z",
                                                             "density",
                                                             "solid_fraction",
                                                             "velocity.x",
                                                             "velocity.y",
                                                             "velocity.z",
                                                             "temperature",
                                                             "kinetic_stress.xx",
                                                             "kinetic_stress.yy",
                                                             "kinetic_stress.zz",
                                                             "kinetic_stress.xy",
                                                             "kinetic_stress.yz",
                                                             "kinetic_stress.xz",
                                                             "contact_stress.xx",
                                                             "contact_stress.yy",
                                                             "contact_stress.zz",
                                                             "contact_stress.xy",
                                                             "contact_stress.yz",
                                                             "contact_stress.xz"};
    return names[k];
}

/* The means of a cell from its sums. */
static void take_means(const se3di_average_sum *average, size_t cell, double *values)
{
    for (size_t k = 0; k < SE3D_FIELD_VALUES; ++k) {
        values[k] = average->sums[cell * SE3D_FIELD_VALUES + k] / (double)average->rows;
    }
    convert(values, -1.0);
    double *kinetic = values + SE3D_FIELD_KINETIC_STRESS;
    for (int k = 0; k < 3; ++k) {
        kinetic[k] = fmax(kinetic[k], 0.0); /* rounding */
    }
    const double rho = values[SE3D_FIELD_DENSITY];
    values[SE3D_FIELD_TEMPERATURE] =
        rho > 0.0 ? (kinetic[0] + kinetic[1] + kinetic[2]) / (3.0 * rho) : 0.0;
}

void se3di_average_write(se3di_average_sum *average, se3di_csv *csv)
{
    const se3d_field_grid *grid = average->grid;
    for (size_t cell = 0; cell < average->cells && average->rows > 0; ++cell) {
        se3di_csv_cell cells[SE3DI_AVERAGE_COLUMNS] = {{NULL, 0.0}};
        double values[SE3D_FIELD_VALUES];
        size_t index = cell;
        for (int a = 0; a < 3; ++a) {
            const size_t n = (size_t)grid->cells[a];
            const double part = ((double)(index % n) + 0.5) / (double)n;
            cells[a].number = grid->lower[a] + part * (grid->upper[a] - grid->lower[a]);
            index /= n;
        }
        take_means(average, cell, values);
        for (size_t k = 0; k < SE3D_FIELD_VALUES; ++k) {
            cells[3 + k].number = values[k];
        }
        se3di_csv_put_cells(csv, cells, SE3DI_AVERAGE_COLUMNS);
    }
}
