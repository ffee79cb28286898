/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts as they are: each is evaluated by itself, on copies, with springs that stay. */
#include "contact/particle_set.h"

#include <math.h>
#include <string.h>

/* Two particles and the partner of unused lanes, with all that a kernel reads and writes. */
typedef struct couple {
    _Alignas(64) se3di_grain grains[3];
    _Alignas(64) se3di_load loads[3];
    _Alignas(64) se3di_block block;
    _Alignas(64) se3di_spin spins[3];
    se3di_roll roll;
    double sums[6];
    se3di_wall wall;
} couple;

static void copy_lane(const se3di_particles *set, uint32_t b, int lane, couple *c)
{
    const se3di_block *block = &set->blocks[b];
    memset(c, 0, sizeof *c);
    for (int k = 0; k < SE3DI_GRAIN_LANES; ++k) {
        c->block.i[k] = c->block.j[k] = 2;
    }
    c->grains[2].inverse_mass = 1.0;
    c->block.i[0] = 0;
    c->grains[0] = set->grains[block->i[lane]];
    c->spins[0] = set->spins[block->i[lane]];
    for (int a = 0; a < 3; ++a) {
        c->block.xi[a][0] = block->xi[a][lane];
    }
    for (int a = 0; set->rolls && a < 4; ++a) {
        c->roll.rho[a][0] = set->rolls[b].rho[a][lane];
    }
}

static se3di_force_task task_of(const se3di_particles *set, couple *c)
{
    return (se3di_force_task){
        .grains = c->grains,
        .spins = c->spins,
        .loads = c->loads,
        .blocks = &c->block,
        .rolls = set->rolling && set->rolls ? &c->roll : NULL,
        .pairs = set->pairs,
        .walls = &c->wall,
        .materials = (uint32_t)set->stuff_count,
        .end = 1,
        .law = (int32_t)set->law,
        .limit = 1e30,
        .cohesive = set->cohesive,
        .wall_sums = c->sums,
    };
}

/* The contact of a lane; returns 0 where the two do not touch. */
static int pair_contact(const se3di_particles *set, uint32_t b, int lane,
                        se3d_particles_contact *out)
{
    couple c;
    copy_lane(set, b, lane, &c);
    c.block.j[0] = 1;
    c.grains[1] = set->grains[set->blocks[b].j[lane]];
    c.spins[1] = set->spins[set->blocks[b].j[lane]];
    double d[3];
    for (int a = 0; a < 3; ++a) {
        d[a] = c.grains[0].x[a] - c.grains[1].x[a];
    }
    se3di_particles_wrap(set, d);
    double distance = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    double overlap = c.grains[0].radius + c.grains[1].radius - distance;
    if (!(overlap > 0.0 && distance > 0.0)) {
        return 0;
    }
    double arm = c.grains[0].radius - 0.5 * overlap;
    for (int a = 0; a < 3; ++a) {
        c.grains[1].x[a] = c.grains[0].x[a] - d[a];
        out->point[a] = c.grains[0].x[a] - d[a] * (arm / distance);
    }
    se3di_force_task task = task_of(set, &c);
    se3di_particle_kernels_portable()->pairs(&task);
    out->i = c.spins[0].id;
    out->j = c.spins[1].id;
    out->shape = (se3d_shape){0, 0};
    memcpy(out->force, c.loads[0].force, sizeof out->force);
    return 1;
}

static int wall_contact(const se3di_particles *set, uint32_t b, int lane,
                        se3d_particles_contact *out)
{
    couple c;
    copy_lane(set, b, lane, &c);
    uint32_t index = set->blocks[b].j[0];
    c.wall = set->walls[index];
    c.block.j[0] = 0;
    if (!(se3di_wall_distance(&c.wall, c.grains[0].x) < c.grains[0].radius)) {
        return 0;
    }
    se3di_force_task task = task_of(set, &c);
    se3di_particle_kernels_portable()->walls(&task);
    out->i = c.spins[0].id;
    out->j = 0;
    out->shape = (se3d_shape){c.wall.handle.index1, c.wall.handle.generation};
    memcpy(out->force, c.loads[0].force, sizeof out->force);
    double normal[3];
    (void)se3di_wall_nearest(&c.wall, c.grains[0].x, out->point, normal);
    return 1;
}

se3d_status se3di_particles_contacts(const se3di_particles *set, size_t capacity,
                                     se3d_particles_contact *contacts, size_t *count)
{
    *count = 0;
    if (!set || !set->list_valid) {
        return SE3D_OK;
    }
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        const se3di_slab *slab = &set->slabs[s];
        for (uint32_t b = slab->pair_begin; b < slab->wall_end; ++b) {
            for (int lane = 0; lane < SE3DI_GRAIN_LANES; ++lane) {
                se3d_particles_contact contact;
                if (set->blocks[b].i[lane] >= set->count) {
                    continue;
                }
                int touches = b < slab->wall_begin ? pair_contact(set, b, lane, &contact)
                                                   : wall_contact(set, b, lane, &contact);
                if (touches && contacts && *count < capacity) {
                    contacts[*count] = contact;
                }
                *count += (size_t)touches;
            }
        }
    }
    return SE3D_OK;
}
