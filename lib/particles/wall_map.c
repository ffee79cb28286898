/* SPDX-License-Identifier: BSD-3-Clause */
/* A funnel is parted by rings and sectors that are about square; all other surfaces are triangles.
 *
 * Of a patch of area A, with forces F on it at points where normals are n and particles move by
 * the tangential velocity u over it:
 *
 *     pressure = - sum F.n /A,     shear = sum (F - n F.n)/A,     sliding = sum max(-F.n, 0) |u| /A
 *
 *                                                                       docs/theory/averages.md */
#include "particles/wall_map.h"

#include "contact/shape/mesh.h"
#include "math/elementary.h"
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

/* --- patches: corners, middles and areas, frame of the shape --- */

#define PI         3.1415926535897932384626433832795
#define SECTORS    24
#define RINGS_MOST 240

static int is_turned(const se3di_shape *shape)
{
    return se3di_shape_is(shape, SE3DI_SHAPE_IS_TURNED);
}

/* Rings of a funnel: as high as sectors are wide in the mean. */
static size_t count_rings(const se3di_shape *s)
{
    const double width = PI * (s->radius + s->top_radius) / SECTORS;
    const double rings = se3di_hypot(s->top_radius - s->radius, 2.0 * s->half_length) / width;
    return rings < 1.0 ? 1 : rings > RINGS_MOST ? RINGS_MOST : (size_t)(rings + 0.5);
}

size_t se3di_wall_map_count(const se3di_shape *shape)
{
    if (!se3di_shape_is(shape, SE3DI_SHAPE_IS_SURFACE)) {
        return 0;
    }
    return is_turned(shape) ? SECTORS * count_rings(shape) : shape->triangle_count;
}

/* The point of a funnel at a part of its length and of a turn. */
static void funnel_point(const se3di_shape *s, double part, double turn, double point[3])
{
    const double radius = s->radius + part * (s->top_radius - s->radius);
    point[0] = radius * se3di_cos(2.0 * PI * turn);
    point[1] = radius * se3di_sin(2.0 * PI * turn);
    point[2] = (2.0 * part - 1.0) * s->half_length;
}

static double place_on_funnel(const se3di_shape *s, size_t patch, double middle[3])
{
    const double rings = (double)count_rings(s);
    const size_t ring = patch / SECTORS, sector = patch % SECTORS;
    const double part = ((double)ring + 0.5) / rings;
    const double side = se3di_hypot(s->top_radius - s->radius, 2.0 * s->half_length);
    funnel_point(s, part, ((double)sector + 0.5) / SECTORS, middle);
    return 2.0 * PI / SECTORS * (s->radius + part * (s->top_radius - s->radius)) * side / rings;
}

static double place_on_triangle(const se3di_shape *shape, size_t triangle, double middle[3])
{
    const uint32_t *corner = shape->triangles + 3 * triangle;
    double one[3], two[3], normal[3];
    middle[0] = middle[1] = middle[2] = 0.0;
    for (int k = 0; k < 3; ++k) {
        se3di_add_scaled(1.0 / 3.0, shape->vertices + 3 * (size_t)corner[k], middle);
    }
    se3di_sub(shape->vertices + 3 * (size_t)corner[1], shape->vertices + 3 * (size_t)corner[0],
              one);
    se3di_sub(shape->vertices + 3 * (size_t)corner[2], shape->vertices + 3 * (size_t)corner[0],
              two);
    se3di_cross(one, two, normal);
    return 0.5 * se3di_norm(normal);
}

static void to_body(const se3di_shape *shape, const double local[3], double out[3])
{
    se3di_mul(shape->A, local, out);
    se3di_add(shape->x, out, out);
}

/* Middle and area, frame of the body. */
static void place(const se3di_shape *shape, size_t patch, double *values)
{
    double middle[3];
    values[SE3D_WALL_AREA] = is_turned(shape) ? place_on_funnel(shape, patch, middle)
                                              : place_on_triangle(shape, patch, middle);
    to_body(shape, middle, values + SE3D_WALL_PLACE);
}

void se3di_wall_map_get_corners(const se3di_shape *shape, size_t patch, double *corners)
{
    static const int up[4] = {0, 0, 1, 1}, on[4] = {0, 1, 1, 0};
    const double rings = is_turned(shape) ? (double)count_rings(shape) : 1.0;
    for (int k = 0; k < 4; ++k) {
        double local[3];
        if (is_turned(shape)) {
            const size_t ring = patch / SECTORS + (size_t)up[k];
            const size_t sector = (patch + (size_t)on[k]) % SECTORS;
            funnel_point(shape, (double)ring / rings, (double)sector / SECTORS, local);
        } else {
            const uint32_t corner = shape->triangles[3 * patch + (k < 2 ? (size_t)k : 2)];
            se3di_copy(shape->vertices + 3 * (size_t)corner, local);
        }
        to_body(shape, local, corners + 3 * k);
    }
}

/* The patch that a point of the surface is on. */
static size_t find_patch(const se3di_shape *shape, const double local[3])
{
    double point[3], distance;
    if (!is_turned(shape)) {
        return se3di_mesh_nearest(shape, local, point, &distance);
    }
    const size_t rings = count_rings(shape);
    const double part = 0.5 * (local[2] / shape->half_length + 1.0) * (double)rings;
    const double turn = se3di_atan2(local[1], local[0]) / (2.0 * PI);
    const double sector = (turn < 0.0 ? turn + 1.0 : turn) * SECTORS;
    const size_t ring = part > 0.0 ? (size_t)part : 0, side = (size_t)sector;
    return SECTORS * (ring < rings ? ring : rings - 1) + (side < SECTORS ? side : SECTORS - 1);
}

/* --- contacts --- */

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
    double local[3], lever[3], shear[3];
    if (!is_wall(wall, (se3di_handle){contact->shape.index1, contact->shape.generation})) {
        return;
    }
    se3di_wall_local(wall, contact->point, local);
    const size_t patch = find_patch(&wall->shape, local);
    if (patch >= m->capacity) {
        return;
    }
    double *values = m->values + patch * SE3D_WALL_VALUES;
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
                         const se3di_shape *shape, size_t capacity, double *values)
{
    const size_t all = se3di_wall_map_count(shape);
    mapping m = {set, wall, capacity < all ? capacity : all, values};
    for (size_t k = 0; k < m.capacity; ++k) {
        memset(values + k * SE3D_WALL_VALUES, 0, SE3D_WALL_VALUES * sizeof *values);
        place(shape, k, values + k * SE3D_WALL_VALUES);
    }
    if (wall && m.capacity > 0) {
        se3di_particles_visit_contacts(set, add_contact, &m);
    }
}
