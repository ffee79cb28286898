/* SPDX-License-Identifier: BSD-3-Clause */
/* Shapes: creation and queries. */
#include "contact/shape/shape.h"

#include "contact/shape/hull.h"
#include "contact/shape/mesh.h"
#include "math/quaternion.h"
#include "math/vec3.h"
#include "system/particles.h"

#include <math.h>
#include <string.h>

#define HULL_VERTICES_MAX 10000

void se3d_shape_def_init(se3d_shape_def *def, size_t size)
{
    se3d_shape_def defaults = {
        .struct_size = size, .orientation = {1.0, 0.0, 0.0, 0.0}, .group = 1, .mask = UINT32_MAX};
    se3di_def_init(def, size, &defaults, sizeof defaults);
}

static se3d_status check_size(se3d_system *system, const char *what, double value)
{
    if (isfinite(value) && value > 0.0) {
        return SE3D_OK;
    }
    return SE3DI_FAIL_OF(system, what, SE3D_ERR_INVALID_ARGUMENT, " = %g m, must be finite and > 0",
                         value);
}

/* A frame whose third axis is the unit vector n: columns of A. */
static void frame_about(const double n[3], double A[9])
{
    double s[3], t[3];
    se3di_perpendicular(n, s);
    se3di_cross(n, s, t);
    for (int a = 0; a < 3; ++a) {
        A[3 * a] = s[a];
        A[3 * a + 1] = t[a];
        A[3 * a + 2] = n[a];
    }
}

/* What all kinds have: body, material, name, pose. */
static se3d_status read_common(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    double p[4];
    if (def->body.index1 != 0 || def->body.generation != 0) {
        SE3DI_TRY(se3di_find_body(system, "body", def->body, &shape->body));
    }
    shape->material = -1;
    if (def->material.index1 != 0 || def->material.generation != 0) {
        uint32_t material;
        SE3DI_TRY(se3di_find_material(system, "material", def->material, &material));
        shape->material = (int32_t)material;
    }
    SE3DI_TRY(se3di_check_new_name(system, &system->model.shape_slots, 0, "shape", def->name));
    SE3DI_TRY(se3di_check_finites(system, "position", def->position, 3));
    SE3DI_TRY(se3di_check_orientation(system, "orientation", def->orientation, p));
    memcpy(&shape->name, &def->name, sizeof shape->name); /* copied by the model */
    se3di_copy(def->position, shape->x);
    se3di_quat_to_matrix(p, shape->A);
    shape->group = def->group;
    shape->mask = def->mask;
    return SE3D_OK;
}

static se3d_status read_sphere(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    shape->radius = def->radius;
    return check_size(system, "radius", def->radius);
}

static se3d_status read_box(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    for (int a = 0; a < 3; ++a) {
        SE3DI_TRY(check_size(system, "size", def->size[a]));
        shape->half[a] = 0.5 * def->size[a];
    }
    return SE3D_OK;
}

static se3d_status read_capsule(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    SE3DI_TRY(se3di_check_range(system, "length", def->length, 0.0, HUGE_VAL));
    shape->half_length = 0.5 * def->length;
    return read_sphere(system, def, shape);
}

static se3d_status read_cylinder(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    SE3DI_TRY(check_size(system, "length", def->length));
    shape->half_length = 0.5 * def->length;
    return read_sphere(system, def, shape);
}

static se3d_status read_plane(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    const double none[3] = {0.0, 0.0, 0.0};
    if (memcmp(def->normal, none, sizeof none) != 0) {
        double normal[3];
        SE3DI_TRY(se3di_check_direction(system, "normal", def->normal, normal));
        frame_about(normal, shape->A);
    }
    return SE3D_OK;
}

static se3d_status read_vertices(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    SE3DI_TRY(se3di_check_pointer(system, "vertices", def->vertices));
    if (def->vertex_count < 3 || def->vertex_count > UINT32_MAX / 16) {
        return SE3DI_FAIL_OF(system, "vertex_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be at least 3 and at most %u", def->vertex_count,
                             UINT32_MAX / 16);
    }
    for (size_t k = 0; k < 3 * def->vertex_count; ++k) {
        if (!isfinite(def->vertices[k])) {
            return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                              "vertices[%zu] = %g m, must be finite", k, def->vertices[k]);
        }
    }
    memcpy(&shape->vertices, &def->vertices, sizeof shape->vertices); /* copied by the model */
    shape->vertex_count = def->vertex_count;
    return SE3D_OK;
}

/* The hull's corners and faces replace the given points; the arrays are the shape's own. */
static se3d_status read_hull(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    SE3DI_TRY(read_vertices(system, def, shape));
    if (def->vertex_count > HULL_VERTICES_MAX) {
        return SE3DI_FAIL_OF(system, "vertex_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu of a hull, must be at most %d", def->vertex_count,
                             HULL_VERTICES_MAX);
    }
    se3d_status status =
        se3di_hull_build(&system->model.allocator, def->vertices, def->vertex_count, shape);
    if (status == SE3D_ERR_INVALID_ARGUMENT) {
        return SE3DI_FAIL(system, status,
                          "the %zu vertices of the hull lie in one plane, must span a volume",
                          def->vertex_count);
    }
    return status < 0 ? SE3DI_FAIL(system, status, "no memory for a hull") : SE3D_OK;
}

static se3d_status read_mesh(se3d_system *system, const se3d_shape_def *def, se3di_shape *shape)
{
    SE3DI_TRY(read_vertices(system, def, shape));
    SE3DI_TRY(se3di_check_pointer(system, "triangles", def->triangles));
    if (def->triangle_count < 1 || def->triangle_count > UINT32_MAX / 16) {
        return SE3DI_FAIL_OF(system, "triangle_count", SE3D_ERR_INVALID_ARGUMENT,
                             " = %zu, must be at least 1 and at most %u", def->triangle_count,
                             UINT32_MAX / 16);
    }
    for (size_t k = 0; k < 3 * def->triangle_count; ++k) {
        if (def->triangles[k] >= def->vertex_count) {
            return SE3DI_FAIL(system, SE3D_ERR_INVALID_ARGUMENT,
                              "triangles[%zu] = %u, must be less than vertex_count = %zu", k,
                              def->triangles[k], def->vertex_count);
        }
    }
    se3d_status status =
        se3di_mesh_build(&system->model.allocator, def->vertices, def->vertex_count, def->triangles,
                         def->triangle_count, shape);
    if (status == SE3D_ERR_INVALID_ARGUMENT) {
        return SE3DI_FAIL(system, status, "none of the %zu triangles has an area",
                          def->triangle_count);
    }
    return status < 0 ? SE3DI_FAIL(system, status, "no memory for a mesh") : SE3D_OK;
}

typedef se3d_status (*shape_reader)(se3d_system *system, const se3d_shape_def *def,
                                    se3di_shape *shape);

static se3d_status create(se3d_system *system, const char *function, const se3d_shape_def *def,
                          se3di_shape_kind kind, shape_reader read, se3d_shape *out)
{
    if (out) {
        *out = (se3d_shape){0, 0};
    }
    SE3DI_TRY(se3di_enter(system, SE3DI_BUSY_FREE, function));
    SE3DI_TRY(se3di_check_pointer(system, "shape", out));
    se3d_shape_def full = se3d_shape_def_default();
    se3di_shape shape = {.kind = (int32_t)kind};
    SE3DI_TRY(se3di_check_def(system, "shape def", def, &full, sizeof full));
    SE3DI_TRY(read_common(system, &full, &shape));
    SE3DI_TRY(read(system, &full, &shape));
    shape.bound = se3di_shape_bound(&shape);
    se3di_handle handle;
    se3d_status status = se3di_model_add_shape(&system->model, &shape, &handle);
    if (kind == SE3DI_SHAPE_HULL || kind == SE3DI_SHAPE_MESH) {
        shape.name = NULL; /* the caller's */
        se3di_shape_release(&system->model.allocator, &shape);
    }
    if (status < 0) {
        return SE3DI_FAIL(system, SE3D_ERR_NO_MEMORY, "no memory for a shape");
    }
    *out = (se3d_shape){handle.index1, handle.generation};
    return SE3D_OK;
}

#define SHAPE_CREATE(kind, KIND)                                                                   \
    se3d_status se3d_shape_create_##kind(se3d_system *system, const se3d_shape_def *def,           \
                                         se3d_shape *shape)                                        \
    {                                                                                              \
        return create(system, __func__, def, SE3DI_SHAPE_##KIND, read_##kind, shape);              \
    }

SHAPE_CREATE(sphere, SPHERE)
SHAPE_CREATE(box, BOX)
SHAPE_CREATE(capsule, CAPSULE)
SHAPE_CREATE(cylinder, CYLINDER)
SHAPE_CREATE(plane, PLANE)
SHAPE_CREATE(hull, HULL)
SHAPE_CREATE(mesh, MESH)

se3d_status se3d_shape_destroy(se3d_system *system, se3d_shape shape)
{
    SE3DI_EDIT(system);
    uint32_t index = se3di_slots_find(&system->model.shape_slots, shape.index1, shape.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3DI_FAIL(system, SE3D_ERR_STALE_HANDLE, "shape %s",
                          shape.index1 == 0 ? "is the null handle"
                                            : "was destroyed or belongs to another system");
    }
    se3di_model_remove_shape(&system->model, index);
    return SE3D_OK;
}

static se3d_status find_reader(const se3d_system *system, se3d_shape shape, const void *out,
                               const se3di_shape **data)
{
    if (!system || !out) {
        return SE3D_ERR_NULL;
    }
    uint32_t index = se3di_slots_find(&system->model.shape_slots, shape.index1, shape.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    *data = &system->model.shapes[index];
    return SE3D_OK;
}

se3d_status se3d_shape_find(const se3d_system *system, const char *name, se3d_shape *shape)
{
    if (shape) {
        *shape = (se3d_shape){0, 0};
    }
    if (!system || !name || !shape) {
        return SE3D_ERR_NULL;
    }
    se3di_handle handle = {0, 0};
    SE3DI_TRY(se3di_find_named(&system->model.shape_slots, name, &handle));
    *shape = (se3d_shape){handle.index1, handle.generation};
    return SE3D_OK;
}

se3d_status se3d_shape_get_name(const se3d_system *system, se3d_shape shape, const char **name)
{
    if (name) {
        *name = NULL;
    }
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, name, &data));
    *name = data->name ? data->name : "";
    return SE3D_OK;
}

se3d_status se3d_shape_get_body(const se3d_system *system, se3d_shape shape, se3d_body *body)
{
    if (body) {
        *body = (se3d_body){0, 0};
    }
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, body, &data));
    return se3d_system_get_body(system, data->body, body);
}

/* Of the particles of all sets. */
static void add_particles(const se3d_system *system, se3d_shape shape, double force[3],
                          double torque[3])
{
    for (const se3di_particles *set = system->model.sets; set; set = set->next) {
        for (size_t k = 0; k < set->wall_count; ++k) {
            const se3di_wall *wall = &set->walls[k];
            if (wall->handle.index1 == shape.index1 &&
                wall->handle.generation == shape.generation) {
                se3di_add(force, wall->force, force);
                se3di_add(torque, wall->torque, torque);
            }
        }
    }
}

se3d_status se3d_shape_get_wrench(const se3d_system *system, se3d_shape shape, double force[3],
                                  double torque[3])
{
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, torque ? force : NULL, &data));
    se3di_copy(data->force, force);
    se3di_copy(data->torque, torque);
    add_particles(system, shape, force, torque);
    return SE3D_OK;
}

se3d_status se3d_body_get_contact_wrench(const se3d_system *system, se3d_body body, double force[3],
                                         double torque[3])
{
    if (!system || !force || !torque) {
        return SE3D_ERR_NULL;
    }
    const se3di_model *model = &system->model;
    uint32_t index = se3di_slots_find(&model->body_slots, body.index1, body.generation);
    if (index == SE3DI_NO_INDEX) {
        return SE3D_ERR_STALE_HANDLE;
    }
    memset(force, 0, 3 * sizeof *force);
    memset(torque, 0, 3 * sizeof *torque);
    for (uint32_t k = 0; k < model->shape_slots.count; ++k) {
        if (model->shapes[k].body == index) {
            se3di_handle handle = se3di_slots_handle(&model->shape_slots, k);
            se3di_add(force, model->shapes[k].force, force);
            se3di_add(torque, model->shapes[k].torque, torque);
            add_particles(system, (se3d_shape){handle.index1, handle.generation}, force, torque);
        }
    }
    return SE3D_OK;
}

se3d_status se3d_shape_get_nearest(const se3d_system *system, se3d_shape shape,
                                   const double position[3], double point[3], double normal[3],
                                   double *distance)
{
    const se3di_shape *data;
    SE3DI_TRY(find_reader(system, shape, position && point && normal ? distance : NULL, &data));
    if (!se3di_is_finite(position, 3)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    se3di_shape_pose pose;
    se3di_shape_place(data, &system->model.frames[data->body], &pose);
    double d[3], local[3], n[3], at[3];
    se3di_sub(position, pose.x, d);
    se3di_mul_transposed(pose.R, d, local);
    se3di_shape_nearest(data, local, at, n, distance);
    se3di_mul(pose.R, n, normal);
    se3di_mul(pose.R, at, point);
    se3di_add(pose.x, point, point);
    return SE3D_OK;
}
