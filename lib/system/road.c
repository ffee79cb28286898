/* SPDX-License-Identifier: BSD-3-Clause */
/* Public layer: roads. */
#include "se3d/road.h"

#include "force/road.h"
#include "math/vec3.h"
#include "system/system_internal.h"

#include <math.h>
#include <string.h>

#define LARGE    1e40
#define POSITIVE 1e-40
#define LINE_MAX 1000000   /* points of a grid along an axis */
#define GRID_MAX 100000000 /* all of them */

void se3d_road_def_init(se3d_road_def *def, size_t size)
{
    se3d_road_def defaults = {
        .struct_size = size, .normal = {0.0, 0.0, 1.0}, .forward = {1.0, 0.0, 0.0}};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_count(se3d_system *system, const char *what, size_t count, size_t least,
                               size_t most)
{
    if (count < least || count > most) {
        return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT, " = %zu, must be %zu to %zu",
                             count, least, most);
    }
    return SE3D_OK;
}

static se3d_status check_numbers(se3d_system *system, const char *what, const double *values,
                                 size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (!(fabs(values[k]) <= LARGE)) {
            return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] = %g, must be finite", k, values[k]);
        }
    }
    return SE3D_OK;
}

/* The definition outlives `road`, which borrows from it. */
static se3d_status take_grid(se3d_system *system, const se3d_road_def *def, se3di_road *road)
{
    SE3DI_TRY(check_count(system, "column_count", def->column_count, 2, LINE_MAX));
    SE3DI_TRY(check_count(system, "row_count", def->row_count, 2, LINE_MAX));
    if (def->row_count > GRID_MAX / def->column_count) { /* the product may be too large to form */
        return SE3DI_FAIL_OF(system, "heights", SE3D_ERR_INVALID_ARGUMENT,
                             " has %zu rows of %zu columns, must be at most %d heights",
                             def->row_count, def->column_count, GRID_MAX);
    }
    SE3DI_TRY(se3di_check_range(system, "spacing[0]", def->spacing[0], POSITIVE, LARGE));
    SE3DI_TRY(se3di_check_range(system, "spacing[1]", def->spacing[1], POSITIVE, LARGE));
    SE3DI_TRY(check_numbers(system, "heights", def->heights, def->row_count * def->column_count));
    road->kind = SE3DI_ROAD_GRID;
    memcpy(&road->heights, &def->heights, sizeof road->heights); /* copied by the model */
    road->columns = def->column_count;
    road->rows = def->row_count;
    memcpy(road->cell, def->spacing, sizeof road->cell);
    return SE3D_OK;
}

static se3d_status take_mesh(se3d_system *system, const se3d_road_def *def, se3di_road *road)
{
    SE3DI_TRY(se3di_check_pointer(system, "vertices", def->vertices));
    SE3DI_TRY(check_count(system, "vertex_count", def->vertex_count, 3, GRID_MAX));
    SE3DI_TRY(check_count(system, "triangle_count", def->triangle_count, 1, GRID_MAX));
    SE3DI_TRY(check_numbers(system, "vertices", def->vertices, 3 * def->vertex_count));
    for (size_t k = 0; k < 3 * def->triangle_count; ++k) {
        if (def->triangles[k] >= def->vertex_count) {
            return SE3DI_FAIL_OF(system, "triangles", SE3D_ERR_INVALID_ARGUMENT,
                                 "[%zu] = %u, must be below vertex_count = %zu", k,
                                 (unsigned)def->triangles[k], def->vertex_count);
        }
    }
    road->kind = SE3DI_ROAD_MESH;
    memcpy(&road->points, &def->vertices, sizeof road->points);
    memcpy(&road->triangles, &def->triangles, sizeof road->triangles);
    road->point_count = def->vertex_count;
    road->triangle_count = def->triangle_count;
    return SE3D_OK;
}

static se3d_status take_surface(se3d_system *system, const se3d_road_def *def, se3di_road *road)
{
    const int has_function = def->height.index1 != 0 || def->height.generation != 0;
    if (has_function + (def->heights != NULL) + (def->triangles != NULL) > 1) {
        return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                          "a road has at most one of height, heights and triangles");
    }
    road->function = -1;
    if (has_function) {
        road->kind = SE3DI_ROAD_FUNCTION;
        return se3di_find_function(system, "height", def->height, 3, &road->function);
    }
    if (def->heights) {
        return take_grid(system, def, road);
    }
    return def->triangles ? take_mesh(system, def, road) : SE3D_OK;
}

/* Tyres act on the body of the road that they are on. */
static se3d_status check_body(se3d_system *system, const se3d_road_def *def, uint32_t body)
{
    const uint32_t old =
        se3di_model_find_replaced(&system->model, &system->model.road_slots, 0, def->name);
    const se3di_road *road = old == SE3DI_NO_INDEX ? NULL : &system->model.roads[old];
    if (road && road->users > 0 && road->body != body) {
        return SE3DI_FAIL_OF(system, "body", SE3D_ERR_IN_USE,
                             " is another one than that of the road, which %u tyres are on; "
                             "destroy them first",
                             road->users);
    }
    return SE3D_OK;
}

se3d_status se3d_road_create(se3d_system *system, const se3d_road_def *def, se3d_road *road)
{
    SE3DI_CREATE(system, road);
    se3d_road_def full = se3d_road_def_default();
    se3di_road data = {.kind = SE3DI_ROAD_PLANE};
    se3di_handle handle = {0, 0};
    SE3DI_TRY(se3di_check_def(system, "road def", def, &full, sizeof full));
    SE3DI_TRY(se3di_check_new_name(system, &system->model.road_slots, 0, "road", full.name));
    SE3DI_TRY(se3di_find_body(system, "body", full.body, &data.body));
    SE3DI_TRY(check_body(system, &full, data.body));
    SE3DI_TRY(se3di_check_finites(system, "point", full.point, 3));
    SE3DI_TRY(se3di_check_axes(system, full.forward, "normal", full.normal, data.axes));
    SE3DI_TRY(take_surface(system, &full, &data));
    se3di_copy(full.point, data.point);
    memcpy(&data.name, &full.name, sizeof data.name); /* copied by the model */
    const se3d_status added = se3di_model_add_road(&system->model, &data, &handle);
    return se3di_give_created(system, added, "a road", handle, road);
}

se3d_status se3d_road_destroy(se3d_system *system, se3d_road road)
{
    SE3DI_EDIT(system);
    uint32_t index;
    SE3DI_TRY(se3di_find_road(system, "road", road, &index));
    const se3di_road *data = &system->model.roads[index];
    if (data->users > 0) {
        return SE3DI_FAIL(system, SE3D_ERR_IN_USE,
                          "road %s is used by %u tyres; destroy them first",
                          data->name ? data->name : "without a name", data->users);
    }
    se3di_model_remove_road(&system->model, index);
    return SE3D_OK;
}

se3d_status se3d_road_get_name(const se3d_system *system, se3d_road road, const char **name)
{
    uint32_t index;
    const se3d_status status =
        se3di_read_index(SE3DI_SLOTS(system, road), SE3DI_HANDLE(road), name, &index);
    return se3di_give_name(status, status < 0 ? NULL : system->model.roads[index].name, name);
}

se3d_status se3d_road_find(const se3d_system *system, const char *name, se3d_road *road)
{
    return se3di_read_named(SE3DI_SLOTS(system, road), name, road);
}

se3d_status se3d_road_get_height(const se3d_system *system, se3d_road road, double x, double y,
                                 double height[4])
{
    uint32_t index;
    se3di_road_height out;
    se3di_reading reading;
    SE3DI_TRY(se3di_read_index(SE3DI_SLOTS(system, road), SE3DI_HANDLE(road), height, &index));
    memset(height, 0, 4 * sizeof *height);
    if (!isfinite(x) || !isfinite(y)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const double at[3] = {system->model.time, x, y};
    SE3DI_TRY(se3di_read_begin(system, &reading));
    SE3DI_TRY(se3di_read_end(
        &reading, se3di_road_eval(&system->model, &system->model.roads[index], at, 0, &out)));
    height[0] = out.h;
    height[1] = out.x;
    height[2] = out.y;
    height[3] = out.t;
    return SE3D_OK;
}

size_t se3d_system_count_roads(const se3d_system *system)
{
    return system ? system->model.road_slots.count : 0;
}

se3d_status se3d_system_get_road(const se3d_system *system, size_t index, se3d_road *road)
{
    return se3di_read_handle(SE3DI_SLOTS(system, road), index, road);
}
