/* SPDX-License-Identifier: BSD-3-Clause */
/* What holds spheres together. A clump is moved by the process that has its centre of mass: all of
 * its spheres are there, and whoever gets a copy of one gets all. A bond is everywhere where one of
 * its ends is; as all begin with equal numbers, they find equal forces and break it in the same
 * step. What breaks is written down by all, and counted once, in one order, at the end of the run.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "math/quaternion.h"
#include "math/vec3.h"
#include "particles/bond.h"
#include "particles/clump.h"
#include "particles/memory.h"
#include "particles/wall.h"
#include "team.h"

static void must(const se3di_particles *set, int good, const char *why)
{
    if (!good) {
        team_fail(team_of(set), "particles", why);
    }
}

uint32_t team_count_spheres(const se3di_particles *set, const se3di_clump *clump)
{
    return set->templates[clump->template_index].count;
}

void team_append_clump(se3di_particles *set, const se3di_clump *clump)
{
    must(set, se3di_clumps_reserve(set, set->id_count, 1) >= 0, "memory is missing");
    set->clumps[set->clump_count] = *clump;
    set->clumps[set->clump_count++].first = (uint32_t)set->count;
}

void team_index_clumps(se3di_particles *set)
{
    if (set->template_count > 0) {
        must(set, se3di_clumps_index(set), "a clump lacks spheres");
    }
}

/* --- bonds on their way --- */

/* A bond says its ends by their numbers in the whole, and where spheres are by theirs. */
static tie tie_of(const se3di_particles *set, const se3di_bond *bond)
{
    tie t = {.bond = *bond, .sphere = {SE3DI_NO_INDEX, SE3DI_NO_INDEX}};
    for (int n = 0; n < 2; ++n) {
        const se3di_bond_end *end = &set->bond_ends[bond->end[n]];
        t.bond.end[n] = end->number;
        if (end->id == SE3DI_NO_INDEX) {
            t.wall = *end;
        } else {
            t.sphere[n] = se3di_share_number(set, set->index_of[end->id]);
        }
    }
    return t;
}

void team_pack_ties(const se3di_particles *set, bytes *out)
{
    const team *t = team_of(set);
    for (size_t k = 0; k < set->bond_count; ++k) {
        const se3di_bond_end *first = &set->bond_ends[set->bonds[k].end[0]];
        if (!se3di_share_is_ghost(set, set->index_of[first->id])) {
            const tie own = tie_of(set, &set->bonds[k]);
            bytes_put(t, out, &own, sizeof own);
        }
    }
}

void team_pack_ends(const se3di_particles *set, bytes *out)
{
    const team *t = team_of(set);
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        se3di_bond_end end = set->bond_ends[k];
        if (end.id != SE3DI_NO_INDEX && !se3di_share_is_ghost(set, set->index_of[end.id])) {
            end.id = se3di_share_number(set, set->index_of[end.id]);
            bytes_put(t, out, &end, sizeof end);
        }
    }
}

/* To the new owners of the own ends; a sphere that goes takes its bonds with it. */
void team_send_bonds(se3di_particles *set, team_owner owner_of, bytes *ends, bytes *ties)
{
    team *t = team_of(set);
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        se3di_bond_end end = set->bond_ends[k];
        const uint32_t index = end.id == SE3DI_NO_INDEX ? 0 : set->index_of[end.id];
        const int owner = end.id == SE3DI_NO_INDEX ? -1 : owner_of(set, index);
        if (team_is_sent(t, owner)) {
            end.id = se3di_share_number(set, index);
            bytes_put(t, &ends[owner], &end, sizeof end);
        }
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        se3di_bond *bond = &set->bonds[k];
        int to[2] = {-1, -1}, gone = 0;
        for (int n = 0; n < 2; ++n) {
            const uint32_t id = set->bond_ends[bond->end[n]].id;
            const uint32_t index = id == SE3DI_NO_INDEX ? 0 : set->index_of[id];
            if (id != SE3DI_NO_INDEX && !se3di_share_is_ghost(set, index)) {
                to[n] = owner_of(set, index);
                gone = gone || to[n] < 0;
            }
        }
        if (gone) {
            bond->fate = SE3DI_BOND_LOST;
            team_part(set, bond);
            continue;
        }
        const tie own = tie_of(set, bond);
        for (int n = 0; n < 2; ++n) {
            if (team_is_sent(t, to[n]) && !(n == 1 && to[1] == to[0])) {
                bytes_put(t, &ties[to[n]], &own, sizeof own);
            }
        }
    }
}

/* Ends of spheres, `ids` as they are here; what bonds they have comes later. */
void team_append_ends(se3di_particles *set, const se3di_bond_end *ends, size_t count)
{
    must(set, se3di_bonds_reserve(set, count + 1) >= 0, "memory is missing");
    if (count > 0) {
        memcpy(set->bond_ends + set->bond_end_count, ends, count * sizeof *ends);
    }
    set->bond_end_count += count;
}

static int compare_ties(const void *a, const void *b)
{
    const tie *s = a, *t = b;
    return s->bond.number < t->bond.number ? -1 : s->bond.number > t->bond.number;
}

/* The end of a bond here; SE3DI_NO_INDEX: its sphere has gone. */
static uint32_t place_end(se3di_particles *set, const tie *from, int n)
{
    const team *t = team_of(set);
    if (from->sphere[n] == SE3DI_NO_INDEX) {
        set->bond_ends[set->bond_end_count] = from->wall;
        return (uint32_t)set->bond_end_count++;
    }
    const uint32_t id = team_find(t, from->sphere[n]);
    return id == SE3DI_NO_INDEX ? SE3DI_NO_INDEX : set->bond_end_of[id];
}

/* The bonds that have come, in the order of the whole, when all spheres are here. */
void team_restore_bonds(se3di_particles *set)
{
    team *t = team_of(set);
    qsort(t->ties, t->tie_count, sizeof *t->ties, compare_ties);
    must(set, se3di_bonds_reserve(set, t->tie_count + 1) >= 0, "memory is missing");
    for (size_t k = 0; k < set->bond_end_of_capacity; ++k) {
        set->bond_end_of[k] = SE3DI_NO_INDEX;
    }
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        se3di_bond_end *end = &set->bond_ends[k];
        end->id = team_find(t, end->id);
        set->bond_end_of[end->id] = (uint32_t)k;
    }
    for (size_t k = 0; k < t->tie_count; ++k) {
        const tie *from = &t->ties[k];
        if (k > 0 && from[-1].bond.number == from->bond.number) {
            continue;
        }
        se3di_bond *bond = &set->bonds[set->bond_count];
        *bond = from->bond;
        for (int n = 0; n < 2; ++n) {
            bond->end[n] = place_end(set, from, n);
        }
        if (bond->end[0] == SE3DI_NO_INDEX || bond->end[1] == SE3DI_NO_INDEX) {
            bond->fate = SE3DI_BOND_LOST;
            team_part(set, bond);
        } else {
            ++set->bond_count;
        }
    }
    must(set, se3di_bonds_index(set), "a bond lacks its ends");
}

/* --- what goes --- */

void team_part(se3di_particles *set, const se3di_bond *bond)
{
    team *t = team_of(set);
    team_reserve(t, &t->gone, &t->gone_capacity, set->bonds_gone + 1, sizeof *t->gone);
    t->gone[set->bonds_gone++] = (parting){.step = set->steps, .bond = *bond};
}

static int compare_partings(const void *a, const void *b)
{
    const parting *p = a, *q = b;
    if (p->step != q->step) {
        return p->step < q->step ? -1 : 1;
    }
    return p->bond.number < q->bond.number ? -1 : p->bond.number > q->bond.number;
}

static void count_gone(se3di_particles *set, parting *gone, size_t count)
{
    qsort(gone, count, sizeof *gone, compare_partings);
    for (size_t k = 0; k < count; ++k) {
        if (k == 0 || gone[k - 1].bond.number != gone[k].bond.number) {
            se3di_bonds_count(set, &gone[k].bond);
        }
    }
    set->bonds_gone = 0;
}

/* --- from the whole and back --- */

/* How long they are. */
static void measure_bonds(se3di_particles *set)
{
    for (size_t k = 0; k < set->bond_count; ++k) {
        se3di_bond *bond = &set->bonds[k];
        double d[3], v[3] = {0.0, 0.0, 0.0};
        uint32_t index[2] = {0, 0};
        for (int n = 0; n < 2; ++n) {
            const uint32_t id = set->bond_ends[bond->end[n]].id;
            index[n] = id == SE3DI_NO_INDEX ? index[0] : set->index_of[id];
        }
        se3di_sub(set->particles[index[0]].x, set->particles[index[1]].x, d);
        se3di_particles_nearest(set, d, v);
        bond->span = se3di_norm(d);
    }
}

void team_begin_bonds(se3di_particles *set)
{
    team *t = team_of(set);
    for (size_t k = 0; k < set->bond_count; ++k) {
        set->bonds[k].number = (uint32_t)k;
    }
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        set->bond_ends[k].number = (uint32_t)k;
    }
    t->end_count = set->bond_end_count;
    team_reserve(t, &t->ends, &t->end_capacity, t->end_count, sizeof *t->ends);
    if (t->end_count > 0) {
        memcpy(t->ends, set->bond_ends, t->end_count * sizeof *t->ends);
    }
    set->bonds_gone = 0;
    measure_bonds(set);
}

/* The ends that there were when the run began, but for those of spheres that are gone, with the
 * turns that they have now. */
static void fill_ends(se3di_particles *set, const all_bonds *all)
{
    team *t = team_of(set);
    for (size_t k = 0; k < all->end_count; ++k) {
        t->ends[all->ends[k].number] = all->ends[k];
    }
    for (size_t k = 0; k < t->end_count; ++k) { /* `number` tells the new places */
        se3di_bond_end *end = &t->ends[k];
        const int stays = end->id == SE3DI_NO_INDEX || set->index_of[end->id] != SE3DI_NO_INDEX;
        end->number = stays ? (uint32_t)set->bond_end_count : SE3DI_NO_INDEX;
        if (stays) {
            set->bond_ends[set->bond_end_count++] = *end;
        }
    }
}

void team_fill_bonds(se3di_particles *set, const all_bonds *all)
{
    const team *t = team_of(set);
    if (t->end_count == 0) {
        return;
    }
    must(set, se3di_bonds_reserve(set, t->end_count + all->tie_count) >= 0, "memory is missing");
    fill_ends(set, all);
    qsort(all->ties, all->tie_count, sizeof *all->ties, compare_ties);
    for (size_t k = 0; k < all->tie_count; ++k) {
        se3di_bond *bond = &set->bonds[set->bond_count++];
        *bond = all->ties[k].bond;
        for (int n = 0; n < 2; ++n) {
            bond->end[n] = t->ends[bond->end[n]].number;
        }
    }
    count_gone(set, all->gone, all->gone_count);
    must(set, se3di_bonds_index(set), "a bond lacks its ends");
}

/* --- how far they reach --- */

void team_reach(const se3di_particles *set, double *reach, double *beyond)
{
    const team *t = team_of(set);
    double most[2] = {0.0, 0.0}; /* a clump about its centre; a bond */
    for (size_t k = 0; k < set->clump_count; ++k) {
        const se3di_clump *clump = &set->clumps[k];
        most[0] = fmax(most[0], clump->scale * set->templates[clump->template_index].bound);
    }
    for (size_t k = 0; k < t->tie_count; ++k) {
        most[1] =
            fmax(most[1], t->ties[k].sphere[1] == SE3DI_NO_INDEX ? 0.0 : t->ties[k].bond.span);
    }
    if (set->template_count > 0 || t->end_count > 0) {
        team_largest(set, 2, most);
    }
    if (most[1] > 0.0) { /* both ends have drifted once since */
        *reach = fmax(*reach, (most[1] + 2.0 * set->pace) * (1.0 + 1e-9));
    }
    *reach += most[0] * (1.0 + 1e-9);
    *beyond = most[0] * (1.0 + 1e-9);
}
