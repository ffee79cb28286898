/* SPDX-License-Identifier: BSD-3-Clause */
/* What contacts turn to heat, by kinds: normal damping, sliding, rolling, torsion. Of each kind,
 *
 *     dissipated = - sum over kicks of force . velocity h - stored
 *
 * with the mean of the velocities before and after a kick: so it is what leaves the kinetic energy,
 * to rounding, whatever the step is; and springs that are shortened or lost have given heat. Only
 * the springs along the normal, which are left out, close to the order of the step.
 *                                                                       docs/theory/averages.md */
#include "particles/audit.h"

#include "math/vec3.h"
#include "particles/mesh.h"
#include "particles/share.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

/* What fixed particles give in a kick. */
static void add_fixed(se3di_particles *set, double span)
{
    double work = 0.0;
    for (size_t k = 0; k < set->count; ++k) {
        const se3di_load *load = &set->loads[k];
        if (se3di_particle_is_fixed(&set->particles[k]) && !se3di_share_is_ghost(set, k)) {
            const double own = -span * (se3di_dot(load->force, set->particles[k].v) +
                                        se3di_dot(load->torque, set->spins[k].w));
            if (se3di_share_is_spread(set)) {
                se3di_exact_add(&set->audit_seen[SE3DI_AUDIT_KINDS], own);
            } else {
                work += own;
            }
        }
    }
    set->wall_work += work;
    se3di_exact_carry(&set->audit_seen[SE3DI_AUDIT_KINDS]);
}

void se3di_audit_mark(se3di_particles *set, double span)
{
    for (size_t k = 0; k < set->count; ++k) {
        se3di_copy(set->particles[k].v, set->audit[k].v);
        se3di_copy(set->spins[k].w, set->audit[k].w);
    }
    if (set->fixed) {
        add_fixed(set, span);
    }
}

void se3di_audit_add(se3di_particles *set, double span)
{
    double power[SE3DI_AUDIT_KINDS] = {0.0};
    const int spread = se3di_share_is_spread(set);
    for (size_t k = 0; k < set->count; ++k) {
        const se3di_audit_load *a = &set->audit[k];
        double v[3], w[3];
        if (se3di_share_is_ghost(set, k)) {
            continue;
        }
        for (int c = 0; c < 3; ++c) {
            v[c] = 0.5 * (a->v[c] + set->particles[k].v[c]);
            w[c] = 0.5 * (a->w[c] + set->spins[k].w[c]);
        }
        const double own[SE3DI_AUDIT_KINDS] = {se3di_dot(a->damping, v),
                                               se3di_dot(a->slide, v) + se3di_dot(a->turn, w),
                                               se3di_dot(a->roll, w), se3di_dot(a->twist, w)};
        for (int c = 0; c < SE3DI_AUDIT_KINDS; ++c) {
            if (spread) {
                se3di_exact_add(&set->audit_seen[c], -span * own[c]);
            } else {
                power[c] += own[c];
            }
        }
    }
    for (int k = 0; k < SE3DI_AUDIT_KINDS; ++k) {
        set->audit_work[k] += span * (set->audit_power[k] - power[k]);
        se3di_exact_carry(&set->audit_seen[k]);
    }
    set->wall_work += span * set->audit_power[SE3DI_AUDIT_KINDS];
}

void se3di_audit_unite(se3di_particles *set)
{
    se3di_share_add_exactly(set, SE3DI_AUDIT_KINDS + 1, set->audit_seen);
    for (int k = 0; k < SE3DI_AUDIT_KINDS; ++k) {
        set->audit_work[k] += se3di_exact_get(&set->audit_seen[k]);
    }
    set->wall_work += se3di_exact_get(&set->audit_seen[SE3DI_AUDIT_KINDS]);
    memset(set->audit_seen, 0, sizeof set->audit_seen);
}

/* Of a contact with this overlap, and the displacements of its springs. */
static void add_contact(const se3di_pair *pair, double radius, double overlap, const double xi[3],
                        const double rho[4], double *elastic)
{
    const int hertz = se3di_pair_is_hertz(pair);
    const double s = hertz ? sqrt(radius * overlap) : 1.0;
    const double kn = s * pair->kn, kt = se3di_pair_kt(pair, s), kr = se3di_pair_kr(pair, s);
    const double pull = sqrt(radius * pair->pull_off * kn * overlap) * overlap;
    elastic[0] += (hertz ? 0.4 : 0.5) * kn * overlap * overlap -
                  0.5 * radius * pair->cohesion * overlap * overlap -
                  (hertz ? 8.0 / 7.0 : 4.0 / 3.0) * pull;
    elastic[1] += 0.5 * kt * se3di_dot(xi, xi);
    if (rho) {
        elastic[2] += 0.5 * kr * se3di_dot(rho, rho);
        elastic[3] += 0.5 * kr * rho[3] * rho[3];
    }
}

static const se3di_pair *pair_of(const se3di_particles *set, uint32_t i, uint32_t material)
{
    return &set->pairs[set->spins[i].material * set->stuff_count + material];
}

/* Lane `lane` of a block of pairs. */
static void add_pair(const se3di_particles *set, const se3di_particle_block *block, int lane,
                     const double xi[3], const double *rho, double *elastic)
{
    const uint32_t i = block->i[lane], j = block->j[lane];
    const se3di_particle *a = &set->particles[i], *b = &set->particles[j];
    double d[3];
    se3di_sub(a->x, b->x, d);
    se3di_particles_wrap(set, d);
    const double reach = a->radius + b->radius, overlap = reach - se3di_norm(d);
    if (overlap > 0.0) {
        add_contact(pair_of(set, i, set->spins[j].material), a->radius * b->radius / reach, overlap,
                    xi, rho, elastic);
    }
}

/* With a wall at this distance. */
static void add_wall(const se3di_particles *set, const se3di_wall *wall, uint32_t i,
                     double distance, const double xi[3], const double *rho, double *elastic)
{
    const double radius = set->particles[i].radius, other = wall->shape.radius;
    const int ball = se3di_shape_is(&wall->shape, SE3DI_SHAPE_IS_BALL);
    if (distance < radius) {
        add_contact(pair_of(set, i, wall->material),
                    ball ? radius * other / (radius + other) : radius, radius - distance, xi, rho,
                    elastic);
    }
}

static void add_lane(const se3di_particles *set, const se3di_slab *slab, uint32_t b, int lane,
                     double *elastic)
{
    const se3di_particle_block *block = &set->blocks[b];
    const uint32_t i = block->i[lane];
    double xi[3], rho[4] = {0.0};
    for (int a = 0; a < 3; ++a) {
        xi[a] = block->xi[a][lane];
    }
    for (int a = 0; set->rolling && set->rolls && a < 4; ++a) {
        rho[a] = set->rolls[b].rho[a][lane];
    }
    if (b < slab->wall_begin) {
        add_pair(set, block, lane, xi, rho, elastic);
        return;
    }
    const se3di_wall *wall = &set->walls[block->j[0]];
    double x[3], point[3], normal[3];
    se3di_particles_image(set, wall, set->particles[i].x, set->particles[i].radius, x);
    add_wall(set, wall, i, se3di_wall_nearest(wall, x, point, normal), xi, rho, elastic);
}

static void add_meshes(const se3di_particles *set, const se3di_slab *slab, double *elastic)
{
    for (uint32_t k = slab->mesh_begin; k < slab->mesh_end; ++k) {
        const se3di_mesh_pair *pair = &set->mesh_pairs[k];
        se3di_mesh_batch batch;
        se3di_mesh_batch_begin(set, pair->wall, &batch);
        (void)se3di_mesh_batch_add(set, pair, &batch);
        for (uint32_t lane = 0; lane < batch.count; ++lane) {
            double xi[3], rho[4] = {0.0};
            for (int a = 0; a < 3; ++a) {
                xi[a] = batch.block.xi[a][lane];
            }
            for (int a = 0; set->rolling && a < 4; ++a) {
                rho[a] = batch.roll.rho[a][lane];
            }
            add_wall(set, &set->walls[pair->wall], pair->i, batch.given.distance[lane], xi, rho,
                     elastic);
        }
    }
}

void se3di_audit_elastic(const se3di_particles *set, double elastic[SE3DI_AUDIT_KINDS])
{
    memset(elastic, 0, SE3DI_AUDIT_KINDS * sizeof *elastic);
    for (uint32_t s = 0; set->list_valid && s < set->slab_count; ++s) {
        const se3di_slab *slab = &set->slabs[s];
        for (uint32_t b = slab->pair_begin; b < slab->wall_end; ++b) {
            for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
                if (set->blocks[b].i[lane] < set->count) {
                    add_lane(set, slab, b, lane, elastic);
                }
            }
        }
        add_meshes(set, slab, elastic);
    }
}
