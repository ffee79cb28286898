/* SPDX-License-Identifier: BSD-3-Clause */
/* Walls as particles see them: how far they are, and which particles may touch them before the list
 * is built anew. */
#include "particles/wall.h"

#include "base/floats.h"
#include "contact/shape/mesh.h"
#include "math/vec3.h"
#include "particles/bond.h"
#include "particles/cell.h"
#include "particles/memory.h"
#include "particles/share.h"

#include <math.h>
#include <string.h>

#define PARCEL   8    /* particles that are compared with a wall together */
#define PARCELS  256  /* of a slab; if it has more particles, parcels are larger */
#define ROUNDING 1e-9 /* of a distance */

void se3di_walls_rest(se3di_particles *set)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        memset(set->walls[k].force, 0, sizeof set->walls[k].force);
        memset(set->walls[k].torque, 0, sizeof set->walls[k].torque);
    }
}

void se3di_wall_local(const se3di_wall *wall, const double x[3], double local[3])
{
    double d[3];
    se3di_sub(x, wall->pose.x, d);
    se3di_mul_transposed(wall->pose.R, d, local);
}

/* The foot on the side of a funnel of a point at `rho` from the axis and z: its radius and z. */
static void funnel_foot(const se3di_shape *s, double rho, double z, double foot[2])
{
    const double side = s->top_radius - s->radius, length = 2.0 * s->half_length;
    const double along = (rho - s->radius) * side + (z + s->half_length) * length;
    const double part = fmax(0.0, fmin(1.0, along / (side * side + length * length)));
    foot[0] = s->radius + part * side;
    foot[1] = part * length - s->half_length;
}

/* Signed from the axis, on the other side of which the far wall is. */
static double funnel_rho(const se3di_wall *wall, const double local[3])
{
    const double rho = sqrt(local[0] * local[0] + local[1] * local[1]);
    return wall->far ? -rho : rho;
}

static double funnel_distance(const se3di_wall *wall, const double local[3])
{
    const double rho = funnel_rho(wall, local);
    double foot[2];
    funnel_foot(&wall->shape, rho, local[2], foot);
    const double d[2] = {rho - foot[0], local[2] - foot[1]};
    return sqrt(d[0] * d[0] + d[1] * d[1]);
}

/* As funnel_distance() of force_walls.inc. */
static double funnel_nearest(const se3di_wall *wall, const double local[3], double n[3])
{
    const double rho = funnel_rho(wall, local);
    double foot[2], beside[2];
    funnel_foot(&wall->shape, rho, local[2], foot);
    const double z = local[2] - foot[1];
    const double distance = sqrt((rho - foot[0]) * (rho - foot[0]) + z * z);
    const double u = distance > 0.0 ? (rho - foot[0]) / distance : -1.0;
    n[0] = fabs(rho) > 0.0 ? u * (local[0] / rho) : wall->far ? -u : u;
    n[1] = fabs(rho) > 0.0 ? u * (local[1] / rho) : 0.0;
    n[2] = distance > 0.0 ? z / distance : 0.0;
    if (wall->far) {
        funnel_foot(&wall->shape, -rho, local[2], beside);
        return -rho < beside[0] && foot[0] > 0.0 ? distance : SE3DI_WALL_NOWHERE;
    }
    return distance;
}

double se3di_wall_nearest(const se3di_wall *wall, const double x[3], double point[3],
                          double normal[3])
{
    double local[3], at[3], n[3], distance;
    se3di_wall_local(wall, x, local);
    if (se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_TURNED)) {
        distance = funnel_nearest(wall, local, n);
    } else {
        se3di_shape_nearest(&wall->shape, local, at, n, &distance);
    }
    se3di_mul(wall->pose.R, n, normal);
    se3di_copy(x, point);
    se3di_add_scaled(-distance, normal, point);
    return distance;
}

double se3di_wall_distance(const se3di_wall *wall, const double x[3])
{
    double local[3], point[3], normal[3], distance;
    se3di_wall_local(wall, x, local);
    if (se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_TURNED)) {
        return funnel_distance(wall, local);
    }
    se3di_shape_nearest(&wall->shape, local, point, normal, &distance);
    return distance;
}

/* Cheaper than the distance, and never more. */
static double least_distance(const se3di_wall *wall, const double x[3])
{
    double d[3];
    if (se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_HALF_SPACE)) {
        return -HUGE_VAL;
    }
    se3di_sub(x, wall->pose.x, d);
    return se3di_norm(d) - wall->shape.bound;
}

static int is_within(const se3di_wall *wall, const double x[3], double reach)
{
    return least_distance(wall, x) < reach && se3di_wall_distance(wall, x) < reach;
}

void se3di_wall_image(const se3di_wall *wall, const double length[3], double reach, double x[3])
{
    static const double shifts[3] = {0.0, 1.0, -1.0};
    int counts[3];
    for (int a = 0; a < 3; ++a) {
        counts[a] =
            length[a] > 0.0 && !se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_HALF_SPACE) ? 3 : 1;
    }
    const int images = counts[0] * counts[1] * counts[2];
    for (int k = 0; images > 1 && k < images; ++k) {
        const int of[3] = {k % counts[0], k / counts[0] % counts[1], k / counts[0] / counts[1]};
        double there[3];
        for (int a = 0; a < 3; ++a) {
            there[a] = x[a] + shifts[of[a]] * length[a];
        }
        if (is_within(wall, there, reach)) {
            se3di_copy(there, x);
            return;
        }
    }
}

void se3di_particles_wrap(const se3di_particles *set, double d[3])
{
    if (set->cell.count > 0) { /* across the gradient first: that shifts them along the flow */
        const int g = set->cell.gradient;
        const double length = set->upper[g] - set->lower[g], across = se3di_nearest(d[g] / length);
        d[g] -= length * across;
        d[set->cell.flow] -= set->cell.offset * across;
    }
    for (int a = 0; a < 3; ++a) {
        if (set->boundary[a] == SE3DI_BOUNDARY_PERIODIC) {
            const double length = set->upper[a] - set->lower[a];
            if (fabs(d[a]) > 0.49 * length) { /* most pairs are nearer, and stay as they are */
                d[a] -= length * se3di_nearest(d[a] / length);
            }
        }
    }
}

void se3di_particles_nearest(const se3di_particles *set, double d[3], double v[3])
{
    double way[3];
    se3di_copy(d, way);
    se3di_particles_wrap(set, d);
    if (se3di_domain_strains(set)) { /* the image moves with its side of the cell */
        double jump[3];
        se3di_sub(d, way, way);
        se3di_domain_map_eval(&set->cell, &set->cell.field, way, jump);
        se3di_add(v, jump, v);
    }
}

void se3di_particles_come_home(const se3di_particles *set, double x[3])
{
    if (set->cell.count > 0) {
        const int g = set->cell.gradient;
        const double length = set->upper[g] - set->lower[g];
        const double across = floor((x[g] - set->lower[g]) / length);
        x[set->cell.flow] -= set->cell.offset * across;
        x[g] -= length * across;
    }
    for (int a = 0; a < 3; ++a) {
        const double length = set->upper[a] - set->lower[a];
        if (set->boundary[a] == SE3DI_BOUNDARY_PERIODIC) {
            x[a] -= length * floor((x[a] - set->lower[a]) / length);
        }
    }
}

static int is_periodic(const se3di_particles *set)
{
    return set->boundary[0] == SE3DI_BOUNDARY_PERIODIC ||
           set->boundary[1] == SE3DI_BOUNDARY_PERIODIC ||
           set->boundary[2] == SE3DI_BOUNDARY_PERIODIC;
}

/* Whether no image of a wall is within reach, by the sphere around it. */
static int is_far(const se3di_particles *set, const se3di_wall *wall, const double x[3],
                  double reach)
{
    double d[3];
    se3di_sub(x, wall->pose.x, d);
    se3di_particles_wrap(set, d);
    return !se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_HALF_SPACE) &&
           se3di_norm(d) >= (reach + wall->shape.bound) * (1.0 + ROUNDING);
}

void se3di_particles_image(const se3di_particles *set, const se3di_wall *wall, const double x[3],
                           double reach, double out[3])
{
    se3di_copy(x, out);
    if (!is_periodic(set) || is_far(set, wall, x, reach)) {
        return;
    }
    double length[3];
    for (int a = 0; a < 3; ++a) {
        const int periodic = set->boundary[a] == SE3DI_BOUNDARY_PERIODIC;
        length[a] = periodic ? set->upper[a] - set->lower[a] : 0.0;
    }
    se3di_wall_image(wall, length, reach, out);
}

/* Triangles of a mesh within reach, appended to the set's faces. */
typedef struct face_list {
    se3di_particles *set;
    se3d_status status;
} face_list;

static void add_face(void *ctx, uint32_t triangle)
{
    face_list *faces = ctx;
    se3di_particles *set = faces->set;
    if (faces->status == SE3D_OK) {
        faces->status =
            se3di_particles_grow(set, &set->faces, &set->face_capacity, set->face_count + 1);
    }
    if (faces->status == SE3D_OK) {
        set->faces[set->face_count++] = triangle;
    }
}

static se3d_status list_faces(se3di_particles *set, const se3di_wall *wall, const double x[3],
                              double reach)
{
    face_list faces = {set, SE3D_OK};
    double local[3];
    se3di_wall_local(wall, x, local);
    se3di_mesh_visit(&wall->shape, local, reach, add_face, &faces);
    return faces.status;
}

/* One particle and one wall. */
static se3d_status list_wall(se3di_particles *set, uint32_t i, uint32_t w)
{
    const se3di_particle *g = &set->particles[i];
    const se3di_wall *wall = &set->walls[w];
    const double reach = g->radius + se3di_particles_reach(set)[i] + wall->reach;
    const size_t face_begin = set->face_count;
    double x[3];
    if (se3di_particle_is_fixed(g) && !(wall->inverse_mass > 0.0)) {
        return SE3D_OK; /* nothing gives way */
    }
    se3di_particles_image(set, wall, g->x, reach, x);
    if (least_distance(wall, x) >= reach ||
        (set->bond_count > 0 && se3di_bonds_part_wall(set, i, w))) {
        return SE3D_OK;
    }
    if (se3di_wall_is_mesh(wall)) {
        SE3DI_TRY(list_faces(set, wall, x, reach));
        if (set->face_count == face_begin) {
            return SE3D_OK;
        }
    } else if (se3di_wall_distance(wall, x) >= reach) {
        return SE3D_OK;
    }
    void *memory = set->near_walls;
    const se3d_status status = se3di_array_reserve(&set->allocator, &memory, &set->near_capacity,
                                                   set->near_count + 1, sizeof *set->near_walls);
    set->near_walls = memory;
    SE3DI_TRY(status);
    set->near_walls[set->near_count++] =
        (se3di_near_wall){i, w, (uint32_t)face_begin, (uint32_t)(set->face_count - face_begin)};
    return SE3D_OK;
}

/* The box of the centres of particles of one slab that follow each other: which of them are far
 * from a wall is known for many at a time. */
typedef struct parcel {
    double middle[3], half[3];
    double radius; /* the largest, with its reach */
} parcel;

static parcel enclose(const se3di_particles *set, uint32_t begin, uint32_t end)
{
    parcel box = {.radius = 0.0};
    double low[3], high[3];
    se3di_copy(set->particles[begin].x, low);
    se3di_copy(low, high);
    for (uint32_t i = begin; i < end; ++i) {
        const se3di_particle *g = &set->particles[i];
        for (int a = 0; a < 3; ++a) {
            low[a] = g->x[a] < low[a] ? g->x[a] : low[a];
            high[a] = g->x[a] > high[a] ? g->x[a] : high[a];
        }
        const double radius = g->radius + se3di_particles_reach(set)[i];
        box.radius = radius > box.radius ? radius : box.radius;
    }
    for (int a = 0; a < 3; ++a) {
        box.middle[a] = 0.5 * (low[a] + high[a]);
        box.half[a] = 0.5 * (high[a] - low[a]);
    }
    return box;
}

/* Whether no particle of the parcel is nearer to the wall than the reaches, by its box; or, but for
 * planes, by the sphere around that. If the wall has images, the nearest sphere around one counts.
 */
static int is_clear(const se3di_particles *set, const se3di_wall *wall, int images,
                    const parcel *box)
{
    double extent = se3di_norm(box->half);
    if (images) {
        return is_far(set, wall, box->middle, extent + box->radius + wall->reach);
    }
    if (se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_HALF_SPACE)) {
        const double *R = wall->pose.R;
        extent = fabs(R[2]) * box->half[0] + fabs(R[5]) * box->half[1] + fabs(R[8]) * box->half[2];
    }
    const double reach = (extent + box->radius + wall->reach) * (1.0 + ROUNDING);
    if (least_distance(wall, box->middle) >= reach) {
        return 1;
    }
    if (!se3di_wall_is_mesh(wall)) {
        return se3di_wall_distance(wall, box->middle) >= reach;
    }
    double local[3];
    se3di_wall_local(wall, box->middle, local);
    return se3di_mesh_is_clear(&wall->shape, local, reach);
}

static se3d_status list_slab(se3di_particles *set, const se3di_slab *slab)
{
    parcel parcels[PARCELS];
    const uint32_t count = slab->end - slab->begin;
    const uint32_t size = count > PARCELS * PARCEL ? (count + PARCELS - 1) / PARCELS : PARCEL;
    for (uint32_t p = 0; p * size < count; ++p) {
        const uint32_t begin = slab->begin + p * size;
        parcels[p] = enclose(set, begin, begin + size < slab->end ? begin + size : slab->end);
    }
    const int periodic = is_periodic(set);
    for (uint32_t w = 0; w < set->wall_count; ++w) {
        const se3di_wall *wall = &set->walls[w];
        const int images = periodic && !se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_HALF_SPACE);
        for (uint32_t p = 0; p * size < count; ++p) {
            if (is_clear(set, wall, images, &parcels[p])) {
                continue;
            }
            for (uint32_t i = p * size; i < (p + 1) * size && i < count; ++i) {
                if (se3di_share_is_ghost(set, slab->begin + i)) {
                    continue; /* its owner sees to it */
                }
                SE3DI_TRY(list_wall(set, slab->begin + i, w));
            }
        }
    }
    return SE3D_OK;
}

se3d_status se3di_particles_list_walls(se3di_particles *set)
{
    set->near_count = set->face_count = 0;
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        se3di_slab *slab = &set->slabs[s];
        slab->near_begin = (uint32_t)set->near_count;
        SE3DI_TRY(list_slab(set, slab));
        slab->near_end = (uint32_t)set->near_count;
    }
    return SE3D_OK;
}
