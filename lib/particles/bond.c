/* SPDX-License-Identifier: BSD-3-Clause */
/* Which bonds there are. */
#include "particles/bond.h"

#include "math/quaternion.h"
#include "math/vec3.h"
#include "particles/clump.h"
#include "particles/share.h"

#include <string.h>

static se3d_status reserve(const se3di_particles *set, void **data, size_t *capacity, size_t needed,
                           size_t size)
{
    return se3di_array_reserve(&set->allocator, data, capacity, needed, size);
}

se3d_status se3di_bonds_reserve(se3di_particles *set, size_t count)
{
    void *bonds = set->bonds, *ends = set->bond_ends, *groups = set->bond_groups;
    void *places = set->bond_places, *end_of = set->bond_end_of;
    const size_t all = set->bond_count + count;
    se3d_status status = reserve(set, &bonds, &set->bond_capacity, all, sizeof *set->bonds);
    set->bonds = bonds;
    SE3DI_TRY(status);
    status = reserve(set, &ends, &set->bond_end_capacity, set->bond_end_count + 2 * count,
                     sizeof *set->bond_ends);
    set->bond_ends = ends;
    SE3DI_TRY(status);
    status = reserve(set, &groups, &set->bond_group_capacity, set->bond_group_count + 1,
                     sizeof *set->bond_groups);
    set->bond_groups = groups;
    SE3DI_TRY(status);
    status = reserve(set, &places, &set->bond_place_capacity, 2 * all, sizeof *set->bond_places);
    set->bond_places = places;
    SE3DI_TRY(status);
    const size_t known = set->bond_end_of_capacity;
    status =
        reserve(set, &end_of, &set->bond_end_of_capacity, set->id_count, sizeof *set->bond_end_of);
    set->bond_end_of = end_of;
    for (size_t id = known; status >= 0 && id < set->bond_end_of_capacity; ++id) {
        set->bond_end_of[id] = SE3DI_NO_INDEX;
    }
    return status;
}

/* The end of a sphere, a new one if it has none. */
static uint32_t end_of_sphere(se3di_particles *set, uint32_t id)
{
    if (set->bond_end_of[id] == SE3DI_NO_INDEX) {
        set->bond_end_of[id] = (uint32_t)set->bond_end_count;
        set->bond_ends[set->bond_end_count++] =
            (se3di_bond_end){.id = id, .wall = SE3DI_NO_INDEX, .q = {1.0, 0.0, 0.0, 0.0}};
    }
    return set->bond_end_of[id];
}

static uint32_t end_of_wall(se3di_particles *set, const se3di_bond_place *place)
{
    const se3di_wall *wall = &set->walls[place->wall];
    se3di_bond_end *end = &set->bond_ends[set->bond_end_count];
    *end = (se3di_bond_end){.id = SE3DI_NO_INDEX,
                            .wall = place->wall,
                            .shape = wall->handle,
                            .q = {1.0, 0.0, 0.0, 0.0}};
    double way[3];
    se3di_sub(place->x, wall->pose.x, way);
    se3di_mul_transposed(wall->pose.R, way, end->point);
    return (uint32_t)set->bond_end_count++;
}

void se3di_bonds_append(se3di_particles *set, const se3di_bond_place *place, const se3di_bond *like)
{
    se3di_bond *bond = &set->bonds[set->bond_count++];
    double q[2][4], back[2][4], axis[3];
    *bond = *like;
    bond->end[0] = end_of_sphere(set, place->first);
    bond->end[1] = place->second == SE3DI_NO_INDEX ? end_of_wall(set, place)
                                                   : end_of_sphere(set, place->second);
    bond->length = se3di_norm(place->way);
    se3di_scale(1.0 / bond->length, place->way, axis);
    for (int n = 0; n < 2; ++n) {
        se3di_bond_end_turn(set, &set->bond_ends[bond->end[n]], q[n]);
        se3di_quat_inverse(q[n], back[n]);
        se3di_quat_turn(back[n], axis, bond->axis[n]);
    }
    se3di_quat_mul(back[1], q[0], bond->turn);
    se3di_add(set->particles[set->index_of[place->first]].x, place->way, bond->place);
    ++set->bond_groups[bond->group].made;
}

void se3di_bond_end_turn(const se3di_particles *set, const se3di_bond_end *end, double q[4])
{
    if (end->id == SE3DI_NO_INDEX) {
        se3di_quat_from_matrix(set->walls[end->wall].pose.R, q);
        return;
    }
    const se3di_clump *clump = se3di_clump_find(set, set->index_of[end->id]);
    memcpy(q, clump ? clump->q : end->q, 4 * sizeof *q);
}

/* The counts of the ends become places. */
static void place_ends(se3di_particles *set)
{
    uint32_t begin = 0;
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        set->bond_ends[k].begin = begin;
        begin += set->bond_ends[k].count;
        set->bond_ends[k].count = 0;
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        for (uint32_t n = 0; n < 2; ++n) {
            se3di_bond_end *end = &set->bond_ends[set->bonds[k].end[n]];
            set->bond_places[end->begin + end->count++] = 2 * (uint32_t)k + n;
        }
    }
}

static int is_there(const se3di_particles *set, const se3di_bond_end *end)
{
    if (end->id == SE3DI_NO_INDEX) {
        return end->wall < set->wall_count;
    }
    return end->id < set->id_count && set->index_of[end->id] != SE3DI_NO_INDEX;
}

int se3di_bonds_index(se3di_particles *set)
{
    for (size_t id = 0; id < set->bond_end_of_capacity; ++id) {
        set->bond_end_of[id] = SE3DI_NO_INDEX;
    }
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        se3di_bond_end *end = &set->bond_ends[k];
        end->count = 0;
        if (!is_there(set, end) ||
            (end->id != SE3DI_NO_INDEX && (end->id >= set->bond_end_of_capacity ||
                                           set->bond_end_of[end->id] != SE3DI_NO_INDEX))) {
            return 0;
        }
        if (end->id != SE3DI_NO_INDEX) {
            set->bond_end_of[end->id] = (uint32_t)k;
        }
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        for (int n = 0; n < 2; ++n) {
            if (set->bonds[k].end[n] >= set->bond_end_count) {
                return 0;
            }
            ++set->bond_ends[set->bonds[k].end[n]].count;
        }
    }
    place_ends(set);
    return 1;
}

static void count_gone(se3di_particles *set, const se3di_bond *bond)
{
    if (se3di_share_is_spread(set)) {
        set->share->part(set, bond);
        return;
    }
    se3di_bonds_count(set, bond);
}

void se3di_bonds_count(se3di_particles *set, const se3di_bond *bond)
{
    se3di_bond_group *group = &set->bond_groups[bond->group];
    group->torn += bond->fate == SE3DI_BOND_TORN;
    group->sheared += bond->fate == SE3DI_BOND_SHEARED;
    group->lost += bond->fate == SE3DI_BOND_LOST;
    group->dissipated += bond->dissipated;
    group->released += bond->energy;
}

void se3di_bonds_keep(se3di_particles *set)
{
    size_t to = 0;
    for (size_t k = 0; k < set->bond_count; ++k) {
        if (set->bonds[k].fate == SE3DI_BOND_HOLDS) {
            set->bonds[to++] = set->bonds[k];
        } else {
            count_gone(set, &set->bonds[k]);
        }
    }
    set->bond_count = to;
    set->bonds_changed = 1;
}

/* Drop the bonds of ends that are gone, and those ends. */
static void drop_lost(se3di_particles *set)
{
    int any = 0;
    for (size_t k = 0; k < set->bond_count; ++k) {
        se3di_bond *bond = &set->bonds[k];
        for (int n = 0; n < 2; ++n) {
            if (!is_there(set, &set->bond_ends[bond->end[n]])) {
                bond->fate = SE3DI_BOND_LOST;
                any = 1;
            }
        }
    }
    if (any) {
        se3di_bonds_keep(set);
    }
    uint32_t to = 0;
    for (size_t k = 0; k < set->bond_end_count; ++k) { /* `begin` tells the new places */
        const int stays = is_there(set, &set->bond_ends[k]);
        set->bond_ends[k].begin = stays ? to++ : SE3DI_NO_INDEX;
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        for (int n = 0; n < 2; ++n) {
            set->bonds[k].end[n] = set->bond_ends[set->bonds[k].end[n]].begin;
        }
    }
    to = 0;
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        if (set->bond_ends[k].begin != SE3DI_NO_INDEX) {
            set->bond_ends[to++] = set->bond_ends[k];
        }
    }
    set->bond_end_count = to;
    (void)se3di_bonds_index(set);
}

void se3di_bonds_filter(se3di_particles *set)
{
    if (set->bond_end_count > 0) {
        drop_lost(set);
    }
}

void se3di_bonds_find_walls(se3di_particles *set)
{
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        se3di_bond_end *end = &set->bond_ends[k];
        if (end->id != SE3DI_NO_INDEX) {
            continue;
        }
        end->wall = SE3DI_NO_INDEX;
        for (size_t w = set->wall_count; w-- > 0;) {
            const se3di_handle here = set->walls[w].handle;
            const int same =
                here.index1 == end->shape.index1 && here.generation == end->shape.generation;
            end->wall = same ? (uint32_t)w : end->wall;
        }
    }
    se3di_bonds_filter(set);
}

/* The bond between the ends of two ids; NULL: none. */
static const se3di_bond *find(const se3di_particles *set, uint32_t i, uint32_t j)
{
    const size_t known = set->bond_end_of_capacity;
    const uint32_t a = i < known ? set->bond_end_of[i] : SE3DI_NO_INDEX;
    const uint32_t b = j < known ? set->bond_end_of[j] : SE3DI_NO_INDEX;
    if (a == SE3DI_NO_INDEX || b == SE3DI_NO_INDEX) {
        return NULL;
    }
    const se3di_bond_end *end = &set->bond_ends[a];
    for (uint32_t k = end->begin; k < end->begin + end->count; ++k) {
        const se3di_bond *bond = &set->bonds[set->bond_places[k] / 2];
        if (bond->end[1 - set->bond_places[k] % 2] == b) {
            return bond;
        }
    }
    return NULL;
}

int se3di_bonds_join(const se3di_particles *set, uint32_t i, uint32_t j)
{
    return find(set, i, j) != NULL;
}

int se3di_bonds_part(const se3di_particles *set, uint32_t i, uint32_t j)
{
    const se3di_bond *bond = find(set, set->spins[i].id, set->spins[j].id);
    return bond && !set->bond_groups[bond->group].touches;
}

int se3di_bonds_part_wall(const se3di_particles *set, uint32_t i, uint32_t wall)
{
    const uint32_t id = set->spins[i].id;
    const uint32_t own = id < set->bond_end_of_capacity ? set->bond_end_of[id] : SE3DI_NO_INDEX;
    for (uint32_t k = 0; own != SE3DI_NO_INDEX && k < set->bond_ends[own].count; ++k) {
        const uint32_t place = set->bond_places[set->bond_ends[own].begin + k];
        const se3di_bond *bond = &set->bonds[place / 2];
        const se3di_bond_end *other = &set->bond_ends[bond->end[1 - place % 2]];
        if (other->id == SE3DI_NO_INDEX && other->wall == wall &&
            !set->bond_groups[bond->group].touches) {
            return 1;
        }
    }
    return 0;
}
