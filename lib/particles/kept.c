/* SPDX-License-Identifier: BSD-3-Clause */
/* The state of a set before a step that may fail after the particles have moved.
 *
 * All arrays lie one after the other in one block of memory, those that change only with the lists
 * first: they are copied if the lists have changed. The set's record is kept as it is; if it
 * comes back, the addresses and sizes of the arrays stay what they are now. */

#include "particles/kept.h"
#include "particles/share.h"

#include "particles/bond.h"

#include <stddef.h>
#include <string.h>

struct se3di_particles_kept {
    se3di_particles set;
    unsigned char *data;
    size_t capacity;
    int32_t filled;
    int32_t reserved;
};

typedef struct part {
    void *data;
    size_t bytes;
} part;

enum { PARTS_SLOW = 12, PARTS = 29 };

/* The arrays in use of a set: those that change with the lists, then the others. */
static void list_parts(const se3di_particles *set, part parts[PARTS])
{
    const size_t carry = set->list_valid ? 0 : set->carry_count;
    /* before the first particle comes there is no memory for them */
    const size_t listed = set->list_valid && set->count > 0 ? set->count + 1 : 0;
    const size_t rolls = set->rolls ? set->block_count * sizeof *set->rolls : 0;
    const size_t old = set->list_valid ? 0 : set->mesh_old_count;
    const part all[] = {
        {set->list, set->list_count * sizeof *set->list},
        {set->first, listed * sizeof *set->first},
        {set->near_walls, set->near_count * sizeof *set->near_walls},
        {set->faces, set->face_count * sizeof *set->faces},
        {set->origin, 3 * set->count * sizeof *set->origin},
        {se3di_particles_reach(set), set->count * sizeof *set->origin},
        {se3di_particles_wear(set), set->count * sizeof *set->origin},
        {set->index_of, set->id_count * sizeof *set->index_of},
        {set->clump_of, set->clump_of ? set->id_count * sizeof *set->clump_of : 0},
        {set->mesh_old, old * sizeof *set->mesh_old},
        {set->carry_next, carry * sizeof *set->carry_next},
        {set->carry_roll, set->carry_rolling ? 4 * carry * sizeof *set->carry_roll : 0},
        {set->clumps, set->clump_count * sizeof *set->clumps},
        {set->particles, set->count * sizeof *set->particles},
        {set->spins, set->count * sizeof *set->spins},
        {set->loads, listed * sizeof *set->loads},
        {set->carry, carry * sizeof *set->carry},
        {set->blocks, set->block_count * sizeof *set->blocks},
        {set->rolls, rolls},
        {set->mesh_pairs, set->mesh_count * sizeof *set->mesh_pairs},
        {set->walls, set->wall_count * sizeof *set->walls},
        {set->sources, set->source_count * sizeof *set->sources},
        {set->sinks, set->sink_count * sizeof *set->sinks},
        {set->flows, set->flow_count * sizeof *set->flows},
        {set->audit, set->audits ? set->count * sizeof *set->audit : 0},
        {set->servos, set->servo_count * sizeof *set->servos},
        {set->bonds, set->bond_count * sizeof *set->bonds},
        {set->bond_ends, set->bond_end_count * sizeof *set->bond_ends},
        {set->bond_groups, set->bond_group_count * sizeof *set->bond_groups},
    };
    _Static_assert(sizeof all == PARTS * sizeof *all, "all of them");
    memcpy(parts, all, sizeof all);
}

static size_t bytes_of(const part *parts, int count)
{
    size_t bytes = 0;
    for (int k = 0; k < count; ++k) {
        bytes += parts[k].bytes;
    }
    return bytes;
}

/* Copies between the parts of a set and the block. */
static void copy_parts(const part *parts, int count, unsigned char *data, int back)
{
    for (int k = 0; k < count; ++k) {
        if (parts[k].bytes > 0 && back) {
            memcpy(parts[k].data, data, parts[k].bytes);
        } else if (parts[k].bytes > 0) {
            memcpy(data, parts[k].data, parts[k].bytes);
        }
        data += parts[k].bytes;
    }
}

/* As much as the arrays can hold: what is in use changes from step to step. */
static size_t room_of(const se3di_particles *set)
{
    return sizeof(uint32_t) *
               (set->list_capacity + set->first_capacity + set->face_capacity +
                set->index_capacity + set->carry_next_capacity + set->clump_of_capacity) +
           sizeof(double) * (SE3DI_ORIGIN_SIZE * set->capacity + set->carry_roll_capacity) +
           set->clump_capacity * sizeof *set->clumps +
           set->near_capacity * sizeof *set->near_walls + set->particle_memory.bytes +
           set->spin_memory.bytes + set->load_memory.bytes + set->block_memory.bytes +
           set->roll_memory.bytes +
           (set->mesh_capacity + set->mesh_old_capacity) * sizeof *set->mesh_pairs +
           set->wall_capacity * sizeof *set->walls + set->source_capacity * sizeof *set->sources +
           set->sink_capacity * sizeof *set->sinks + set->flow_capacity * sizeof *set->flows +
           set->servo_capacity * sizeof *set->servos + set->audit_capacity * sizeof *set->audit +
           set->bond_capacity * sizeof *set->bonds +
           set->bond_end_capacity * sizeof *set->bond_ends +
           set->bond_group_capacity * sizeof *set->bond_groups;
}

static se3d_status reserve(se3di_particles *set)
{
    const size_t bytes = room_of(set);
    se3di_particles_kept *kept = set->kept;
    if (!kept) {
        kept = se3di_alloc(&set->allocator, 1, sizeof *kept);
        if (!kept) {
            return SE3D_ERR_NO_MEMORY;
        }
        memset(kept, 0, sizeof *kept);
        set->kept = kept;
    }
    if (bytes > kept->capacity) {
        void *data = se3di_alloc(&set->allocator, bytes, 1);
        if (!data) {
            return SE3D_ERR_NO_MEMORY;
        }
        se3di_free(&set->allocator, kept->data, kept->capacity, 1);
        kept->data = data;
        kept->capacity = bytes;
        kept->filled = 0;
    }
    return SE3D_OK;
}

se3d_status se3di_particles_keep(se3di_particles *set)
{
    part parts[PARTS];
    list_parts(set, parts);
    const size_t slow = bytes_of(parts, PARTS_SLOW);
    SE3DI_TRY(reserve(set));
    se3di_particles_kept *kept = set->kept;
    const int lists_stay = kept->filled && set->list_valid && kept->set.list_valid &&
                           kept->set.refreshes == set->refreshes;
    if (!lists_stay) {
        copy_parts(parts, PARTS_SLOW, kept->data, 0);
    }
    copy_parts(parts + PARTS_SLOW, PARTS - PARTS_SLOW, kept->data + slow, 0);
    kept->set = *set;
    kept->filled = 1;
    return SE3D_OK;
}

/* What a step may change of the record but for its numbers: arrays that have grown. */
#define MEMORY_LIST(X)                                                                             \
    X(next)                                                                                        \
    X(name)                                                                                        \
    X(kept)                                                                                        \
    X(capacity)                                                                                    \
    X(particle_memory)                                                                             \
    X(spin_memory)                                                                                 \
    X(load_memory)                                                                                 \
    X(block_memory)                                                                                \
    X(roll_memory)                                                                                 \
    X(particles)                                                                                   \
    X(spins)                                                                                       \
    X(loads)                                                                                       \
    X(carry)                                                                                       \
    X(blocks)                                                                                      \
    X(rolls)                                                                                       \
    X(origin)                                                                                      \
    X(order)                                                                                       \
    X(key)                                                                                         \
    X(index_of)                                                                                    \
    X(index_capacity)                                                                              \
    X(clumps)                                                                                      \
    X(clump_capacity)                                                                              \
    X(clump_of)                                                                                    \
    X(clump_of_capacity)                                                                           \
    X(cells)                                                                                       \
    X(cell_capacity)                                                                               \
    X(first)                                                                                       \
    X(first_capacity)                                                                              \
    X(list)                                                                                        \
    X(list_capacity)                                                                               \
    X(near_walls)                                                                                  \
    X(near_capacity)                                                                               \
    X(faces)                                                                                       \
    X(face_capacity)                                                                               \
    X(carry_roll)                                                                                  \
    X(carry_roll_capacity)                                                                         \
    X(carry_next)                                                                                  \
    X(carry_next_capacity)                                                                         \
    X(mesh_pairs)                                                                                  \
    X(mesh_capacity)                                                                               \
    X(mesh_old)                                                                                    \
    X(mesh_old_capacity)                                                                           \
    X(audit)                                                                                       \
    X(audit_capacity)                                                                              \
    X(wall_sums)                                                                                   \
    X(wall_sum_capacity)

void se3di_particles_come_back(se3di_particles *set)
{
    if (!set->kept || !set->kept->filled) {
        return;
    }
    if (se3di_share_is_spread(set) && set->kept->set.rebuilds != set->rebuilds) {
        set->share->give_up(set, "a step failed after particles had changed hands");
    }
    const se3di_particles now = *set;
    part parts[PARTS];
    *set = now.kept->set;
#define STAY(field) set->field = now.field;
    MEMORY_LIST(STAY)
#undef STAY
    list_parts(set, parts);
    copy_parts(parts, PARTS, set->kept->data, 1);
    (void)se3di_bonds_index(set);
    if (set->particles) {
        set->particles[set->capacity] = (se3di_particle){.inverse_mass = 1.0}; /* of unused lanes */
    }
    for (uint32_t b = 0; now.capacity != set->kept->set.capacity && b < set->block_count; ++b) {
        se3di_particle_block *block = &set->blocks[b];
        const uint32_t unused = (uint32_t)set->kept->set.capacity;
        for (int k = 0; k < SE3DI_PARTICLE_LANES; ++k) { /* they point behind the others */
            block->i[k] = block->i[k] == unused ? (uint32_t)set->capacity : block->i[k];
            block->j[k] = block->j[k] == unused ? (uint32_t)set->capacity : block->j[k];
        }
    }
}

void se3di_particles_forget(se3di_particles *set)
{
    if (set->kept) {
        se3di_free(&set->allocator, set->kept->data, set->kept->capacity, 1);
        se3di_free(&set->allocator, set->kept, 1, sizeof *set->kept);
        set->kept = NULL;
    }
}

size_t se3di_particles_kept_memory(const se3di_particles *set)
{
    return set->kept ? set->kept->capacity + sizeof *set->kept : 0;
}
