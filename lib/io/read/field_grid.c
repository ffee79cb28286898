/* SPDX-License-Identifier: BSD-3-Clause */
/* `fields` of an output. */
#include "io/read/field_grid.h"

#include <math.h>

#include "io/base/pool.h"
#include "io/document/document.h"
#include "io/document/fields.h"
#include "io/document/keys.h"
#include "io/document/value.h"
#include "io/model/model.h"
#include "io/read/objects.h"
#include "io/read/particle_names.h"

#define CELLS_MOST 1e7

/* clang-format off */
static const se3di_key field_keys[] = {
    {"lower", SE3DI_KIND_VECTOR, .required = true, SE3DI_INTO(se3d_field_grid, lower),
     .text = "corner of the grid [m]"},
    {"upper", SE3DI_KIND_VECTOR, .required = true, SE3DI_INTO(se3d_field_grid, upper),
     .text = "corner of the grid [m]"},
    {"cells", SE3DI_KIND_VECTOR, .required = true,
     .text = "their numbers along x, y and z, at most 1e7 together"},
    {"width", SE3DI_KIND_NUMBER, SE3DI_POSITIVE, .required = true,
     SE3DI_INTO(se3d_field_grid, width),
     .text = "radius in which a particle counts [m]; one or two diameters show a continuum"},
    {"set", SE3DI_KIND_TEXT, .standard = "all particles",
     .text = "a name of `particles`: only those"},
    {.key = NULL}};
const se3di_object se3di_object_fields = {
    "fields",
    "A grid with density, velocity, temperature and stress of the particles in its cells.",
    field_keys, NULL,
    NULL};
/* clang-format on */

static bool read_cells(se3di_reader *reader, const se3di_node *node, se3d_field_grid *grid)
{
    double cells[3] = {1.0, 1.0, 1.0};
    if (!se3di_read_key(reader, node, &se3di_object_fields, NULL, "cells", cells)) {
        return false;
    }
    double all = 1.0;
    for (int a = 0; a < 3; ++a) {
        all *= cells[a];
        if (!(cells[a] >= 1.0 && cells[a] <= CELLS_MOST && floor(cells[a]) >= cells[a])) {
            return se3di_reader_fail_key(reader, node, "cells",
                                         "has %g, must be three whole numbers >= 1", cells[a]);
        }
        grid->cells[a] = (int32_t)cells[a];
    }
    return all <= CELLS_MOST ||
           se3di_reader_fail_key(reader, node, "cells", "makes %.3g cells, must be at most %g", all,
                                 CELLS_MOST);
}

static bool check_corners(se3di_reader *reader, const se3di_node *node, const se3d_field_grid *grid)
{
    for (int a = 0; a < 3; ++a) {
        if (!(grid->upper[a] > grid->lower[a])) {
            return se3di_reader_fail_key(reader, node, "upper",
                                         "is %g along %c, must be greater than `lower`, %g",
                                         grid->upper[a], "xyz"[a], grid -> lower[a]);
        }
    }
    return true;
}

bool se3di_read_field_grid(se3di_reader *reader, const se3di_node *output,
                           const se3d_field_grid **out)
{
    static const char *const needed[] = {"lower", "upper", "cells", "width"};
    const se3di_node *node = se3di_node_get(output, "fields");
    *out = NULL;
    if (!node) {
        return true;
    }
    if (!reader->model->particles) {
        return se3di_reader_fail(reader, node, "needs `particles`, which the model does not have");
    }
    if (!se3di_read_keys(reader, node, &se3di_object_fields)) {
        return false;
    }
    for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k) {
        if (!se3di_node_get(node, needed[k])) {
            return se3di_reader_fail_key(reader, node, needed[k],
                                         "is missing, fields need lower, upper, cells and width");
        }
    }
    se3d_field_grid *grid = se3di_iopool_alloc(&reader->model->pool, sizeof *grid);
    if (!grid) {
        return se3di_reader_fail_memory(reader);
    }
    *grid = se3d_field_grid_default();
    *out = grid;
    return se3di_read_fields(reader, node, &se3di_object_fields, NULL, "se3d_field_grid", grid) &&
           read_cells(reader, node, grid) && check_corners(reader, node, grid) &&
           se3di_read_key_set(reader, node, "set", &grid->tag);
}
