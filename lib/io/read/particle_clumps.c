/* SPDX-License-Identifier: BSD-3-Clause */
/* The frame of a clump is that of three of its spheres: the first one, the farthest from it, and
 * the one farthest from the line through both. If all are on a line, a turn about that cannot be
 * seen, and one is taken. */
#include "io/read/particle_clumps.h"

#include <math.h>
#include <string.h>

#include "io/base/rotation.h"
#include "math/vec3.h"

#define SAME 1e-6 /* of the size of a clump: by how much spheres may be elsewhere */
#define LINE 1e-7 /* of it: what is nearer to a line is on it */

/* Which spheres of a template make its frame; 0: they are all in one place, or on a line. */
typedef struct frame {
    size_t second, third;
} frame;

static frame choose(const se3d_clump_def *def, double size)
{
    frame f = {0, 0};
    double far = LINE * size, beside = LINE * size, axis[3];
    for (size_t k = 1; k < def->count; ++k) {
        double d[3];
        se3di_sub(def->r + 3 * k, def->r, d);
        if (se3di_norm(d) > far) {
            far = se3di_norm(d);
            f.second = k;
            memcpy(axis, d, sizeof axis);
        }
    }
    for (size_t k = 1; f.second > 0 && k < def->count; ++k) {
        double d[3], across[3];
        se3di_sub(def->r + 3 * k, def->r, d);
        se3di_cross(axis, d, across);
        const double distance = se3di_norm(across) / far;
        if (distance > beside) {
            beside = distance;
            f.third = k;
        }
    }
    return f;
}

/* Its axes as columns, from places of the spheres. */
static void make_axes(const frame *f, const double *r, double A[9])
{
    double u[3] = {1.0, 0.0, 0.0}, v[3], n[3];
    if (f->second > 0) {
        se3di_sub(r + 3 * f->second, r, u);
        (void)se3di_unit(u, u);
    }
    se3di_perpendicular(u, v);
    if (f->third > 0) {
        se3di_sub(r + 3 * f->third, r, v);
    }
    se3di_cross(u, v, n);
    (void)se3di_unit(n, n);
    se3di_cross(n, u, v);
    for (int a = 0; a < 3; ++a) {
        A[3 * a] = u[a];
        A[3 * a + 1] = v[a];
        A[3 * a + 2] = n[a];
    }
}

static void multiply_transposed(const double A[9], const double B[9], double C[9])
{
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
            C[3 * i + j] = se3di_dot(A + 3 * i, B + 3 * j);
        }
    }
}

/* The place of a point of the template; `at` is where its first sphere is. */
static void carry(const double A[9], double scale, const double *first, const double *point,
                  const double at[3], double out[3])
{
    double d[3], turned[3];
    se3di_sub(point, first, d);
    se3di_mul(A, d, turned);
    se3di_copy(at, out);
    se3di_add_scaled(scale, turned, out);
}

static bool lies(const se3di_clump_entry *entry, const double *r, const double *radius,
                 se3di_clump_pose *pose)
{
    const se3d_clump_def *def = &entry->def;
    const double scale = radius[0] / def->radius[0], slack = SAME * scale * entry->info.radius;
    const frame f = choose(def, entry->info.radius);
    double of[9], here[9], A[9];
    make_axes(&f, def->r, of);
    make_axes(&f, r, here);
    multiply_transposed(here, of, A);
    for (size_t k = 0; k < def->count; ++k) {
        double place[3], off[3];
        carry(A, scale, def->r, def->r + 3 * k, r, place);
        se3di_sub(place, r + 3 * k, off);
        if (!(se3di_norm(off) <= slack && fabs(scale * def->radius[k] - radius[k]) <= slack)) {
            return false;
        }
    }
    pose->scale = fabs(scale - 1.0) < 1e-12 ? 1.0 : scale;
    se3di_rotation_from_matrix(A, pose->e);
    carry(A, scale, def->r, entry->info.centre, r, pose->r);
    return true;
}

/* All images beside that of the first sphere. */
static void unwrap(const se3di_clump_rows *rows, const double period[3])
{
    double *r = rows->r;
    for (size_t k = 3; k < 3 * rows->count; ++k) {
        const double length = period[k % 3];
        if (length > 0.0) {
            r[k] -= length * floor((r[k] - r[k % 3]) / length + 0.5);
        }
    }
}

bool se3di_clump_recognise(const se3di_tagged *particles, const se3di_clump_rows *rows,
                           se3di_clump_pose *pose)
{
    unwrap(rows, particles->period);
    for (size_t k = 0; k < particles->clump_count; ++k) {
        const se3di_clump_entry *entry = &particles->clump_entries[k];
        if (entry->def.count == rows->count && lies(entry, rows->r, rows->radius, pose)) {
            double arm[3], turned[3];
            se3di_sub(pose->r, rows->r, arm);
            se3di_cross(rows->w, arm, turned);
            pose->entry = k;
            se3di_add(rows->v, turned, pose->v);
            se3di_copy(rows->w, pose->w);
            return true;
        }
    }
    return false;
}

se3d_status se3di_clump_add(const se3di_tagged *particles, se3d_material material,
                            const se3di_clump_pose *pose)
{
    const uint32_t index = (uint32_t)pose->entry;
    if (!(pose->scale < 1.0 || pose->scale > 1.0)) {
        return se3d_particles_add_clumps(particles->set, index, material, 1, pose->r, pose->e,
                                         pose->v, pose->w);
    }
    se3d_fill_def def = se3d_fill_def_default();
    size_t added = 0;
    def.clump = index + 1;
    def.material = material;
    def.radius_min = def.radius_max =
        pose->scale * particles->clump_entries[pose->entry].info.radius;
    def.count = 1;
    for (int a = 0; a < 3; ++a) {
        def.lower[a] = pose->r[a] - 1.01 * def.radius_max;
        def.upper[a] = pose->r[a] + 1.01 * def.radius_max;
    }
    const se3d_status status = se3d_particles_fill_lattice(particles->set, &def, &added);
    return status < 0 ? status : added == 1 ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}
