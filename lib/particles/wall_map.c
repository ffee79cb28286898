/* SPDX-License-Identifier: BSD-3-Clause */
/* Of a triangle of area A, with forces F on it at points where normals are n and particles move by
 * the tangential velocity u over it:
 *
 *     pressure = - sum F.n /A,     shear = sum (F - n F.n)/A,     sliding = sum max(-F.n, 0) |u| /A
 *
 *                                                                       docs/theory/averages.md */
#include "particles/wall_map.h"

#include "contact/shape/mesh.h"
#include "math/vec3.h"
#include "particles/contacts.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

typedef struct mapping {
    const se3di_particles *set;
    const se3di_wall *wall;
    size_t capacity;
    double *values;
} mapping;

static int is_wall(const se3di_wall *wall, se3di_handle shape)
{
    return wall->handle.index1 == shape.index1 && wall->handle.generation == shape.generation;
}

const se3di_wall *se3di_wall_map_find(const se3di_particles *set, se3di_handle shape)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        if (is_wall(&set->walls[k], shape)) {
            return &set->walls[k];
        }
    }
    return NULL;
}

/* Middle and area, frame of the body. */
static void place(const se3di_shape *shape, size_t triangle, double *values)
{
    const uint32_t *corner = shape->triangles + 3 * triangle;
    double middle[3] = {0.0, 0.0, 0.0}, one[3], two[3], normal[3];
    for (int k = 0; k < 3; ++k) {
        se3di_add_scaled(1.0 / 3.0, shape->vertices + 3 * (size_t)corner[k], middle);
    }
    se3di_mul(shape->A, middle, values + SE3D_WALL_PLACE);
    se3di_add(shape->x, values + SE3D_WALL_PLACE, values + SE3D_WALL_PLACE);
    se3di_sub(shape->vertices + 3 * (size_t)corner[1], shape->vertices + 3 * (size_t)corner[0],
              one);
    se3di_sub(shape->vertices + 3 * (size_t)corner[2], shape->vertices + 3 * (size_t)corner[0],
              two);
    se3di_cross(one, two, normal);
    values[SE3D_WALL_AREA] = 0.5 * se3di_norm(normal);
}

/* How fast a particle slips over the wall at a point, `lever` from its centre. */
static double slip_speed(const mapping *m, const se3d_particles_contact *contact,
                         const double lever[3])
{
    const se3di_shape_pose *pose = &m->wall->pose;
    const size_t k = m->set->index_of[contact->i];
    double side[3], turned[3], spin[3], v[3];
    se3di_cross(m->set->spins[k].w, lever, turned);
    se3di_add(m->set->particles[k].v, turned, v);
    se3di_sub(contact->point, pose->c, side);
    se3di_add(pose->w, pose->spin, spin); /* as its surface moves on the body */
    se3di_cross(spin, side, turned);
    for (int a = 0; a < 3; ++a) {
        v[a] -= pose->v[a] + pose->u[a] + turned[a];
    }
    se3di_add_scaled(-se3di_dot(v, contact->normal), contact->normal, v);
    return se3di_norm(v);
}

static void add_contact(void *ctx, const se3d_particles_contact *contact)
{
    const mapping *m = ctx;
    const se3di_wall *wall = m->wall;
    double local[3], point[3], lever[3], shear[3], distance;
    if (!is_wall(wall, (se3di_handle){contact->shape.index1, contact->shape.generation})) {
        return;
    }
    se3di_wall_local(wall, contact->point, local);
    const size_t triangle = se3di_mesh_nearest(&wall->shape, local, point, &distance);
    if (triangle >= m->capacity) {
        return;
    }
    double *values = m->values + triangle * SE3D_WALL_VALUES;
    const double area = values[SE3D_WALL_AREA];
    const double normal = se3di_dot(contact->force, contact->normal);
    const double radius = m->set->particles[m->set->index_of[contact->i]].radius;
    se3di_scale(contact->overlap - radius, contact->normal, lever);
    for (int a = 0; a < 3; ++a) {
        shear[a] = (normal * contact->normal[a] - contact->force[a]) / area;
    }
    values[SE3D_WALL_PRESSURE] += normal / area;
    values[SE3D_WALL_SLIDING] += fmax(normal, 0.0) * slip_speed(m, contact, lever) / area;
    se3di_mul_transposed(wall->pose.R, shear, local);
    se3di_mul(wall->shape.A, local, shear);
    se3di_add(values + SE3D_WALL_SHEAR, shear, values + SE3D_WALL_SHEAR);
}

void se3di_wall_map_fill(const se3di_particles *set, const se3di_wall *wall,
                         const se3di_shape *mesh, size_t capacity, double *values)
{
    const size_t all = mesh->triangle_count;
    mapping m = {set, wall, capacity < all ? capacity : all, values};
    for (size_t k = 0; k < m.capacity; ++k) {
        memset(values + k * SE3D_WALL_VALUES, 0, SE3D_WALL_VALUES * sizeof *values);
        place(mesh, k, values + k * SE3D_WALL_VALUES);
    }
    if (wall && m.capacity > 0) {
        se3di_particles_visit_contacts(set, add_contact, &m);
    }
}
