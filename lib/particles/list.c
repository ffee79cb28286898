/* SPDX-License-Identifier: BSD-3-Clause */
/* From the neighbour list to the blocks of active pairs, with the history of their springs.
 *
 * History waits in `carry` while lists change: entries {i, j, xi}, chained by i through key[] (the
 * first) and carry_next[]. They lie in the memory of the loads, which hold nothing while there are
 * no valid lists. If memory fails they stay there, and nothing is lost. */
#include "particles/list.h"

#include "particles/memory.h"
#include "particles/mesh.h"
#include "particles/reach.h"
#include "particles/slabs.h"
#include "particles/wall.h"

#include <string.h>

/* Of small reaches, if memory is missing; less is nothing. */
#define SCALE_LEAST 1e-3

static int lane_moved(const se3di_particles *set, uint32_t b, int lane)
{
    const se3di_particle_block *block = &set->blocks[b];
    int moved = block->xi[0][lane] != 0.0 || block->xi[1][lane] != 0.0 || block->xi[2][lane] != 0.0;
    for (int a = 0; set->rolls && !moved && a < 4; ++a) {
        moved = set->rolls[b].rho[a][lane] != 0.0;
    }
    return moved && block->i[lane] != set->capacity;
}

/* What waits there stays. */
se3d_status se3di_particles_reserve_carry(se3di_particles *set, size_t count, int rolling)
{
    const se3d_allocator *a = &set->allocator;
    size_t grown = count + count / 32 + 16;
    size_t waiting = set->carry_count;
    if (rolling && 4 * count > set->carry_roll_capacity) {
        double *rolls = se3di_alloc(a, 4 * grown, sizeof *rolls);
        if (!rolls) {
            return SE3D_ERR_NO_MEMORY;
        }
        if (waiting > 0 && set->carry_rolling) {
            memcpy(rolls, set->carry_roll, 4 * waiting * sizeof *rolls);
        }
        se3di_free(a, set->carry_roll, set->carry_roll_capacity, sizeof *rolls);
        set->carry_roll = rolls;
        set->carry_roll_capacity = 4 * grown;
    }
    SE3DI_TRY(se3di_particles_grow(set, &set->carry_next, &set->carry_next_capacity, count));
    if (count * sizeof(se3di_carry) > set->load_memory.bytes) {
        SE3DI_TRY(se3di_aligned_reserve(a, &set->load_memory, grown * sizeof(se3di_carry),
                                        waiting * sizeof(se3di_carry))); /* the loads go */
        set->loads = set->load_memory.data;
    }
    set->carry = set->load_memory.data;
    return SE3D_OK;
}

static void collect_lane(se3di_particles *set, size_t k, uint32_t b, int lane, int wall)
{
    const se3di_particle_block *block = &set->blocks[b];
    uint32_t j = wall ? SE3DI_CARRY_WALL | block->j[0] : block->j[lane];
    set->carry[k] = (se3di_carry){
        block->i[lane], j, {block->xi[0][lane], block->xi[1][lane], block->xi[2][lane]}};
    for (int a = 0; set->rolls && a < 4; ++a) {
        set->carry_roll[4 * k + (size_t)a] = set->rolls[b].rho[a][lane];
    }
}

static void count_slab(se3di_particles *set, uint32_t s)
{
    se3di_slab *slab = &set->slabs[s];
    slab->moved = 0;
    for (uint32_t b = slab->pair_begin; b < slab->wall_end; ++b) {
        for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
            slab->moved += (size_t)lane_moved(set, b, lane);
        }
    }
}

/* slab->moved: where its entries begin, afterwards where they end. */
static void collect_slab(se3di_particles *set, uint32_t s)
{
    se3di_slab *slab = &set->slabs[s];
    for (uint32_t b = slab->pair_begin; b < slab->wall_end; ++b) {
        for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
            if (lane_moved(set, b, lane)) {
                collect_lane(set, slab->moved++, b, lane, b >= slab->wall_begin);
            }
        }
    }
}

se3d_status se3di_particles_collect(se3di_particles *set)
{
    if (!set->list_valid) {
        return SE3D_OK;
    }
    se3di_particles_each_slab(set, count_slab);
    size_t count = 0;
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        size_t here = set->slabs[s].moved;
        set->slabs[s].moved = count;
        count += here;
    }
    SE3DI_TRY(se3di_particles_reserve_carry(set, count, set->rolls != NULL));
    set->carry_count = count;
    set->carry_rolling = set->rolls != NULL;
    se3di_particles_each_slab(set, collect_slab);
    se3di_particles_mesh_collect(set);
    set->list_valid = 0;
    set->block_count = 0;
    return SE3D_OK;
}

void se3di_particles_remap(se3di_particles *set, const uint32_t *new_index)
{
    size_t kept = 0;
    for (size_t k = 0; k < set->carry_count; ++k) {
        se3di_carry entry = set->carry[k];
        entry.i = new_index[entry.i];
        entry.j = entry.j >= SE3DI_CARRY_WALL ? entry.j : new_index[entry.j];
        if (entry.i == SE3DI_NO_INDEX || entry.j == SE3DI_NO_INDEX) {
            continue;
        }
        set->carry[kept] = entry;
        if (set->carry_rolling) {
            memmove(set->carry_roll + 4 * kept, set->carry_roll + 4 * k, 4 * sizeof(double));
        }
        ++kept;
    }
    set->carry_count = kept;
    se3di_particles_mesh_remap(set, new_index, NULL);
}

/* Chains by the particle that will own the pair: either of the two may, so both are searched. */
static void chain(se3di_particles *set)
{
    for (size_t k = 0; k < set->count; ++k) {
        set->key[k] = SE3DI_NO_INDEX;
    }
    for (size_t k = set->carry_count; k-- > 0;) {
        uint32_t i = set->carry[k].i;
        set->carry_next[k] = set->key[i];
        set->key[i] = (uint32_t)k;
    }
}

static uint32_t find(const se3di_particles *set, uint32_t i, uint32_t j)
{
    uint32_t k = set->key[i];
    while (k != SE3DI_NO_INDEX && set->carry[k].j != j) {
        k = set->carry_next[k];
    }
    return k;
}

static se3d_status reserve_blocks(se3di_particles *set, size_t count)
{
    const se3d_allocator *a = &set->allocator;
    size_t grown = count + count / 32 + 16;
    size_t first = set->list_count / 12 + set->count / 16; /* most contacts are still to come */
    grown = grown < first ? first : grown;
    if ((set->rolling || set->rolls) && count * sizeof(se3di_roll) > set->roll_memory.bytes) {
        SE3DI_TRY(se3di_aligned_reserve(a, &set->roll_memory, grown * sizeof(se3di_roll), 0));
        set->rolls = set->roll_memory.data;
    }
    if (count * sizeof(se3di_particle_block) > set->block_memory.bytes) {
        SE3DI_TRY(
            se3di_aligned_reserve(a, &set->block_memory, grown * sizeof(se3di_particle_block), 0));
        set->blocks = set->block_memory.data;
    }
    return SE3D_OK;
}

/* The place of the next pair of a slab. */
typedef struct cursor {
    uint32_t next; /* block */
    int lane;      /* of the block before `next` */
} cursor;

static void open_block(se3di_particles *set, cursor *at)
{
    se3di_particle_block *block = &set->blocks[at->next];
    memset(block, 0, sizeof *block);
    for (int k = 0; k < SE3DI_PARTICLE_LANES; ++k) {
        block->i[k] = block->j[k] = (uint32_t)set->capacity;
    }
    if (set->rolls) {
        memset(&set->rolls[at->next], 0, sizeof(se3di_roll));
    }
    ++at->next;
    at->lane = 0;
}

/* Add a pair with its history. */
static void push(se3di_particles *set, uint32_t i, uint32_t j, cursor *where)
{
    if (where->lane == SE3DI_PARTICLE_LANES) {
        open_block(set, where);
    }
    se3di_particle_block *block = &set->blocks[where->next - 1];
    int at = where->lane++;
    block->i[at] = i;
    if (j < SE3DI_CARRY_WALL) {
        block->j[at] = j;
    }
    double sign = 1.0;
    uint32_t k = find(set, i, j);
    if (k == SE3DI_NO_INDEX && j < SE3DI_CARRY_WALL) {
        k = find(set, j, i);
        sign = -1.0;
    }
    if (k == SE3DI_NO_INDEX) {
        return;
    }
    for (int a = 0; a < 3; ++a) {
        block->xi[a][at] = sign * set->carry[k].xi[a];
    }
    for (size_t a = 0; set->rolling && set->carry_rolling && a < 4; ++a) {
        /* the twist is about the normal, which turns with the order of the two */
        set->rolls[where->next - 1].rho[a][at] =
            (a < 3 ? sign : 1.0) * set->carry_roll[4 * (size_t)k + a];
    }
}

static uint32_t blocks_of(size_t pairs)
{
    return (uint32_t)((pairs + SE3DI_PARTICLE_LANES - 1) / SE3DI_PARTICLE_LANES);
}

/* Returns how many blocks the pairs of a slab need, and adds how many there are. */
static uint32_t mark_pairs(se3di_particles *set, const se3di_slab *slab, size_t *pairs)
{
    const double *near = se3di_particles_wear(set);
    int periodic = 0;
    size_t count = 0;
    for (int a = 0; a < 3; ++a) {
        periodic |= set->boundary[a] == SE3DI_BOUNDARY_PERIODIC;
    }
    for (uint32_t i = slab->begin; i < slab->end; ++i) {
        const se3di_particle *gi = &set->particles[i];
        for (uint32_t k = set->first[i]; k < set->first[i + 1]; ++k) {
            uint32_t j = set->list[k] & ~SE3DI_LIST_ACTIVE;
            const se3di_particle *gj = &set->particles[j];
            double d[3] = {gi->x[0] - gj->x[0], gi->x[1] - gj->x[1], gi->x[2] - gj->x[2]};
            if (periodic) {
                se3di_particles_wrap(set, d);
            }
            double reach = gi->radius + gj->radius + near[i] + near[j];
            int active = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach;
            set->list[k] = active ? j | SE3DI_LIST_ACTIVE : j;
            count += (size_t)active;
        }
    }
    *pairs += count;
    return blocks_of(count);
}

static int is_near_wall(const se3di_particles *set, const se3di_wall *wall, uint32_t i)
{
    const double reach = set->particles[i].radius + se3di_particles_wear(set)[i] + wall->near_reach;
    double x[3];
    se3di_particles_image(set, wall, set->particles[i].x, reach, x);
    return se3di_wall_distance(wall, x) < reach;
}

/* The same for walls: one wall per block. */
static uint32_t mark_walls(se3di_particles *set, const se3di_slab *slab, size_t *pairs)
{
    uint32_t blocks = 0;
    size_t count = 0;
    uint32_t last = SE3DI_NO_INDEX;
    for (uint32_t k = slab->near_begin; k < slab->near_end; ++k) {
        se3di_near_wall *entry = &set->near_walls[k];
        uint32_t i = entry->i & ~SE3DI_LIST_ACTIVE;
        const se3di_wall *wall = &set->walls[entry->wall];
        /* meshes have pairs of their own */
        int active = !se3di_wall_is_mesh(wall) && is_near_wall(set, wall, i);
        entry->i = active ? i | SE3DI_LIST_ACTIVE : i;
        if (entry->wall != last) {
            blocks += blocks_of(count);
            count = 0;
            last = entry->wall;
        }
        count += (size_t)active;
        *pairs += (size_t)active;
    }
    return blocks + blocks_of(count);
}

/* Leaves the numbers of blocks in pair_end and wall_end, of pairs in moved. */
static void mark_slab(se3di_particles *set, uint32_t s)
{
    se3di_slab *slab = &set->slabs[s];
    slab->moved = 0;
    slab->pair_end = mark_pairs(set, slab, &slab->moved);
    slab->wall_end = mark_walls(set, slab, &slab->moved);
}

static void fill_slab(se3di_particles *set, uint32_t s)
{
    const se3di_slab *slab = &set->slabs[s];
    cursor at = {slab->pair_begin, SE3DI_PARTICLE_LANES};
    for (uint32_t i = slab->begin; i < slab->end; ++i) {
        for (uint32_t k = set->first[i]; k < set->first[i + 1]; ++k) {
            if (set->list[k] & SE3DI_LIST_ACTIVE) {
                push(set, i, set->list[k] & ~SE3DI_LIST_ACTIVE, &at);
            }
        }
    }
    uint32_t last = SE3DI_NO_INDEX;
    for (uint32_t k = slab->near_begin; k < slab->near_end; ++k) {
        uint32_t i = set->near_walls[k].i;
        uint32_t w = set->near_walls[k].wall;
        if (i & SE3DI_LIST_ACTIVE) {
            at.lane = w == last ? at.lane : SE3DI_PARTICLE_LANES;
            last = w;
            push(set, i & ~SE3DI_LIST_ACTIVE, SE3DI_CARRY_WALL | w, &at);
            set->blocks[at.next - 1].j[0] = w;
        }
    }
}

/* Numbers of blocks become places. */
static size_t place_slabs(se3di_particles *set, size_t *pairs)
{
    size_t count = 0;
    *pairs = 0;
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        se3di_slab *slab = &set->slabs[s];
        slab->pair_begin = (uint32_t)count;
        count += slab->pair_end;
        slab->pair_end = slab->wall_begin = (uint32_t)count;
        count += slab->wall_end;
        slab->wall_end = (uint32_t)count;
        *pairs += slab->moved;
    }
    return count;
}

/* Mark the active pairs, reserve blocks for them and what it takes to collect their history, so
 * that this cannot fail; fewer if memory is missing. */
static se3d_status choose_active(se3di_particles *set)
{
    for (double scale = 1.0;; scale = scale > SCALE_LEAST ? 0.5 * scale : 0.0) {
        se3di_particles_set_wear(set, scale);
        se3di_particles_each_slab(set, mark_slab);
        size_t pairs;
        size_t count = place_slabs(set, &pairs);
        se3d_status status = reserve_blocks(set, count);
        if (status == SE3D_OK) {
            status = se3di_particles_reserve_carry(set, pairs + set->count / 2, set->rolls != NULL);
        }
        if (status == SE3D_OK) {
            status = se3di_particles_mesh_activate(set);
        }
        set->block_count = status == SE3D_OK ? (uint32_t)count : 0;
        if (status == SE3D_OK || !(scale > 0.0)) {
            return status;
        }
        set->starved = 1;
    }
}

se3d_status se3di_particles_activate(se3di_particles *set)
{
    SE3DI_TRY(choose_active(set));
    chain(set);
    se3di_particles_each_slab(set, fill_slab);
    set->mesh_old_count = 0;
    se3di_particles_begin_wear(set);
    set->carry_count = 0;
    set->list_valid = 1;
    if (set->count > 0) {
        memset(set->load_memory.data, 0, (set->count + 1) * sizeof *set->loads);
    }
    ++set->refreshes;
    return SE3D_OK;
}

se3d_status se3di_particles_refresh(se3di_particles *set)
{
    SE3DI_TRY(se3di_particles_collect(set));
    return se3di_particles_activate(set);
}
