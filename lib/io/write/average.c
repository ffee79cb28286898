/* SPDX-License-Identifier: BSD-3-Clause */
/* With <> for the mean over n times, of each cell:
 *
 *     rho = <rho_k>,   u = <rho_k u_k>/rho,   kinetic stress = <K_k + rho_k u_k u_k> - rho u u
 *
 * so momentum and its flux are averaged, and what fluctuates about the mean over all times counts
 * for stress and temperature. Of a triangle all is <>, in the frame of its body.
 *                                                                       docs/theory/averages.md */
#include "io/write/average.h"

#include <math.h>
#include <string.h>

#include "io/base/pool.h"
#include "io/model/model.h"
#include "io/model/tagged.h"

static const int rows[6] = {0, 1, 2, 0, 1, 0}, columns[6] = {0, 1, 2, 1, 2, 2};

/* How many numbers there are of a wall. */
static void count_triangles(se3di_average_sum *a, const se3di_output_entry *entry)
{
    a->wall = entry->wall;
    (void)se3d_particles_get_wall_map(a->model->particles->set, a->wall, 0, NULL, &a->cells);
    a->width = SE3D_WALL_VALUES;
    a->cells /= a->width;
}

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
    a->time = -HUGE_VAL;
    if (grid) {
        a->width = SE3D_FIELD_VALUES;
        a->cells = (size_t)grid->cells[0] * (size_t)grid->cells[1] * (size_t)grid->cells[2];
    } else {
        count_triangles(a, entry);
    }
    a->values = se3di_iopool_array(pool, a->cells, a->width * sizeof *a->values);
    a->sums = se3di_iopool_array(pool, a->cells, a->width * sizeof *a->sums);
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

/* The numbers of now. */
static se3d_status read_values(se3di_average_sum *a)
{
    const se3d_particles *set = a->model->particles->set;
    size_t count = a->cells * a->width;
    if (!a->grid) {
        return se3d_particles_get_wall_map(set, a->wall, count, a->values, &count);
    }
    const se3d_status status = se3d_particles_get_fields(set, a->grid, count, a->values);
    for (size_t k = 0; k < a->cells && status >= 0; ++k) {
        convert(a->values + k * a->width, 1.0);
    }
    return status;
}

se3d_status se3di_average_add(se3di_average_sum *average, double time)
{
    if (time <= average->time) { /* the end of an analysis is the beginning of the next one */
        return SE3D_OK;
    }
    const se3d_status status = read_values(average);
    if (status < 0) {
        return status;
    }
    const size_t count = average->cells * average->width;
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
    se3di_code_numbers(coder, average->sums, average->cells * average->width);
}

/* Of a cell: its middle, then SE3D_FIELD_VALUES. */
static const char *const cell_columns[] = {"x",
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
/* Of a triangle: SE3D_WALL_VALUES. */
static const char *const triangle_columns[] = {
    "x", "y", "z", "area", "pressure", "shear.x", "shear.y", "shear.z", "sliding"};
enum {
    CELL_COLUMNS = sizeof cell_columns / sizeof *cell_columns,
    TRIANGLE_COLUMNS = sizeof triangle_columns / sizeof *triangle_columns
};

size_t se3di_average_count_columns(const se3di_average_sum *average)
{
    return average->grid ? CELL_COLUMNS : TRIANGLE_COLUMNS;
}

const char *se3di_average_get_column(const se3di_average_sum *average, size_t k)
{
    return average->grid ? cell_columns[k] : triangle_columns[k];
}

void se3di_average_get_means(const se3di_average_sum *average, size_t cell, double *values)
{
    for (size_t k = 0; k < average->width; ++k) {
        values[k] = average->sums[cell * average->width + k] / (double)average->rows;
    }
    if (!average->grid) {
        return;
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

/* The middle of a cell. */
static void get_middle(const se3d_field_grid *grid, size_t cell, se3di_csv_cell cells[3])
{
    for (int a = 0; a < 3; ++a) {
        const size_t n = (size_t)grid->cells[a];
        const double part = ((double)(cell % n) + 0.5) / (double)n;
        cells[a].number = grid->lower[a] + part * (grid->upper[a] - grid->lower[a]);
        cell /= n;
    }
}

void se3di_average_write(se3di_average_sum *average, se3di_csv *csv)
{
    const size_t count = se3di_average_count_columns(average), first = count - average->width;
    for (size_t cell = 0; cell < average->cells && average->rows > 0; ++cell) {
        se3di_csv_cell cells[CELL_COLUMNS] = {{NULL, 0.0}};
        double values[SE3D_FIELD_VALUES];
        if (average->grid) {
            get_middle(average->grid, cell, cells);
        }
        se3di_average_get_means(average, cell, values);
        for (size_t k = 0; k < average->width; ++k) {
            cells[first + k].number = values[k];
        }
        se3di_csv_put_cells(csv, cells, count);
    }
}
