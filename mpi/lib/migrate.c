/* SPDX-License-Identifier: BSD-3-Clause */
/* When lists are made anew: particles go to whom the place belongs that they are at now, with the
 * history of their contacts, and everyone gets copies of what its own may touch. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "particles/clump.h"
#include "particles/list.h"
#include "particles/wall.h"
#include "team.h"

/* What a message to one process consists of: particles, clumps with theirs, ends of bonds, bonds,
 * the history of pairs, that of meshes. */
enum { MOVERS, CLUMPS, ENDS, TIES, HISTORIES, TOUCHES, KINDS };

typedef struct head {
    uint64_t count[KINDS];
} head;

/* Of what a process sees. */
typedef struct border_head {
    uint64_t movers, clumps, ends;
} border_head;

typedef struct parcels {
    bytes *of[KINDS]; /* [size] */
    uint64_t *clumps; /* [size] how many there are */
} parcels;

static void clear(team *t)
{
    for (int q = 0; q < t->size; ++q) {
        t->to[q].count = 0;
    }
}

static parcels make_parcels(const team *t)
{
    const size_t size = (size_t)t->size;
    parcels p = {.clumps = calloc(size, sizeof *p.clumps)};
    bytes *all = calloc(KINDS * size, sizeof *all);
    if (!all || !p.clumps) {
        team_fail(t, "particles", "memory is missing");
    }
    for (size_t k = 0; k < KINDS; ++k) {
        p.of[k] = all + k * size;
    }
    return p;
}

static void drop_parcels(const team *t, parcels *p)
{
    for (int q = 0; q < KINDS * t->size; ++q) {
        free(p->of[0][q].data);
    }
    free(p->of[0]);
    free(p->clumps);
}

/* Whose particle k is from now on; -1: it goes. */
static int owner_of(const se3di_particles *set, size_t k)
{
    const se3di_clump *clump = se3di_clump_find(set, k);
    const double *x = clump ? clump->x : set->particles[k].x;
    return set->order[k] ? boxes_find(&team_of(set)->boxes, x) : -1;
}

mover team_mover_of(const se3di_particles *set, size_t k)
{
    return (mover){se3di_share_number(set, k), 0, set->particles[k], set->spins[k]};
}

/* A clump and its spheres in their order. */
static void pack_clump(const se3di_particles *set, const se3di_clump *clump, bytes *out)
{
    const team *t = team_of(set);
    bytes_put(t, out, clump, sizeof *clump);
    for (uint32_t n = 0; n < team_count_spheres(set, clump); ++n) {
        const mover m = team_mover_of(set, set->index_of[clump->first + n]);
        bytes_put(t, out, &m, sizeof m);
    }
}

static void pack_clumps(const se3di_particles *set, parcels *p)
{
    team *t = team_of(set);
    const size_t count = se3di_share_clumps(set);
    for (size_t k = 0; k < count; ++k) {
        const se3di_clump *clump = &set->clumps[k];
        const int owner = owner_of(set, set->index_of[clump->first]);
        if (team_is_sent(t, owner)) {
            pack_clump(set, clump, &p->of[CLUMPS][owner]);
            ++p->clumps[owner];
            t->stats.moved += owner != t->rank ? team_count_spheres(set, clump) : 0;
        }
    }
}

static void pack_movers(const se3di_particles *set, parcels *p)
{
    team *t = team_of(set);
    for (size_t k = 0; k < set->count; ++k) {
        const int owner = owner_of(set, k);
        if (team_is_sent(t, owner) && !se3di_clump_find(set, k)) {
            const mover m = team_mover_of(set, k);
            bytes_put(t, &p->of[MOVERS][owner], &m, sizeof m);
            t->stats.moved += owner != t->rank;
        }
    }
}

/* The history of a pair goes to the new owners of both. */
static void pack_histories(const se3di_particles *set, parcels *p)
{
    const team *t = team_of(set);
    for (size_t k = 0; k < set->carry_count; ++k) {
        const se3di_carry *carry = &set->carry[k];
        const int is_pair = carry->j < SE3DI_CARRY_WALL;
        const int first = owner_of(set, carry->i);
        const int second = is_pair ? owner_of(set, carry->j) : -1;
        history h = history_of(set, carry, k);
        h.i = se3di_share_number(set, carry->i);
        h.j = is_pair ? se3di_share_number(set, carry->j) : carry->j;
        if (team_is_sent(t, first)) {
            bytes_put(t, &p->of[HISTORIES][first], &h, sizeof h);
        }
        if (second != first && team_is_sent(t, second)) {
            bytes_put(t, &p->of[HISTORIES][second], &h, sizeof h);
        }
    }
}

static void pack_touches(const se3di_particles *set, parcels *p)
{
    const team *t = team_of(set);
    for (size_t k = 0; k < set->mesh_old_count; ++k) {
        se3di_mesh_pair pair = set->mesh_old[k];
        const int owner = owner_of(set, pair.i);
        pair.i = se3di_share_number(set, pair.i);
        if (team_is_sent(t, owner)) {
            bytes_put(t, &p->of[TOUCHES][owner], &pair, sizeof pair);
        }
    }
}

static void join(team *t, const parcels *p)
{
    static const size_t sizes[KINDS] = {sizeof(mover),          1,
                                        sizeof(se3di_bond_end), sizeof(tie),
                                        sizeof(history),        sizeof(se3di_mesh_pair)};
    clear(t);
    for (int q = 0; q < t->size; ++q) {
        head h;
        size_t all = 0;
        for (int k = 0; k < KINDS; ++k) {
            h.count[k] = p->of[k][q].count / sizes[k];
            all += p->of[k][q].count;
        }
        h.count[CLUMPS] = p->clumps[q];
        if (all > 0) {
            bytes_put(t, &t->to[q], &h, sizeof h);
            for (int k = 0; k < KINDS; ++k) {
                bytes_put(t, &t->to[q], p->of[k][q].data, p->of[k][q].count);
            }
        }
    }
}

/* The next of what has come. */
static const unsigned char *take(const unsigned char *at, void *out, size_t size)
{
    if (size > 0) {
        memcpy(out, at, size);
    }
    return at + size;
}

/* Room for `count` particles in all; those that are there stay. */
static void reserve(se3di_particles *set, size_t count)
{
    team *t = team_of(set);
    if (se3di_particles_reserve(set, count) < 0) {
        team_fail(t, "particles", "memory is missing");
    }
    team_reserve(t, &t->number, &t->number_capacity, count + 1, sizeof *t->number);
    t->share.number = t->number;
}

void team_append(se3di_particles *set, const mover *m)
{
    team *t = team_of(set);
    const size_t k = set->count++;
    set->particles[k] = m->particle;
    set->spins[k] = m->spin;
    set->spins[k].id = (uint32_t)k;
    set->index_of[k] = (uint32_t)k;
    t->number[k] = m->number;
    set->id_count = set->count;
}

static void begin_empty(se3di_particles *set)
{
    set->count = set->id_count = 0;
    set->carry_count = 0;
    set->mesh_old_count = 0;
    set->clump_count = set->bond_count = set->bond_end_count = 0;
    team_of(set)->history_count = team_of(set)->touch_count = team_of(set)->tie_count = 0;
}

/* Free particles, and clumps with theirs. */
static const unsigned char *take_particles(se3di_particles *set, const unsigned char *at,
                                           uint64_t movers, uint64_t clumps)
{
    mover m;
    reserve(set, set->count + movers);
    for (uint64_t k = 0; k < movers; ++k) {
        at = take(at, &m, sizeof m);
        team_append(set, &m);
    }
    for (uint64_t k = 0; k < clumps; ++k) {
        se3di_clump clump;
        at = take(at, &clump, sizeof clump);
        const uint32_t spheres = team_count_spheres(set, &clump);
        reserve(set, set->count + spheres);
        team_append_clump(set, &clump);
        for (uint32_t n = 0; n < spheres; ++n) {
            at = take(at, &m, sizeof m);
            team_append(set, &m);
        }
    }
    return at;
}

/* Ends of bonds, which say their spheres by number. */
static const unsigned char *take_ends(se3di_particles *set, const unsigned char *at, uint64_t count)
{
    for (uint64_t k = 0; k < count; ++k) {
        se3di_bond_end end;
        at = take(at, &end, sizeof end);
        team_append_ends(set, &end, 1);
    }
    return at;
}

/* `count` more elements of an array of the team. */
static const unsigned char *take_more(const team *t, const unsigned char *at, void *array,
                                      size_t *held, size_t *capacity, uint64_t count, size_t size)
{
    unsigned char *data;
    team_reserve(t, array, capacity, *held + count, size);
    memcpy(&data, array, sizeof data);
    at = take(at, count > 0 ? data + *held * size : NULL, count * size);
    *held += count;
    return at;
}

static void unpack(se3di_particles *set)
{
    team *t = team_of(set);
    begin_empty(set);
    for (int q = 0; q < t->size; ++q) {
        const unsigned char *at = t->came.data + t->from[q];
        head h;
        if (t->from[q + 1] == t->from[q]) {
            continue;
        }
        at = take(at, &h, sizeof h);
        at = take_particles(set, at, h.count[MOVERS], h.count[CLUMPS]);
        at = take_ends(set, at, h.count[ENDS]);
        at = take_more(t, at, &t->ties, &t->tie_count, &t->tie_capacity, h.count[TIES],
                       sizeof *t->ties);
        at = take_more(t, at, &t->histories, &t->history_count, &t->history_capacity,
                       h.count[HISTORIES], sizeof *t->histories);
        (void)take_more(t, at, &t->touches, &t->touch_count, &t->touch_capacity, h.count[TOUCHES],
                        sizeof *t->touches);
    }
    reserve(set, set->count);
    team_index_clumps(set);
}

static void pack_arrivals(const team *t, parcels *p)
{
    const int own = t->rank;
    const size_t count = t->arrival_count * sizeof *t->arrivals;
    bytes_put(t, &p->of[MOVERS][own], t->arrivals, count);
    bytes_put(t, &p->of[CLUMPS][own], t->clump_arrivals.data, t->clump_arrivals.count);
    p->clumps[own] += t->clump_arrival_count;
}

void team_migrate(se3di_particles *set)
{
    team *t = team_of(set);
    parcels p = make_parcels(t);
    t->peer_count = 0;
    pack_movers(set, &p);
    pack_clumps(set, &p);
    pack_arrivals(t, &p);
    team_send_bonds(set, owner_of, p.of[ENDS], p.of[TIES]);
    team_forget_arrivals(t);
    pack_histories(set, &p);
    pack_touches(set, &p);
    join(t, &p);
    drop_parcels(t, &p);
    if (t->from_whole) {
        t->from[0] = 0;
        for (int q = 0; q < t->size; ++q) {
            t->from[q + 1] = t->from[q] + (q == t->rank ? t->to[q].count : 0);
        }
        t->came.count = 0;
        bytes_put(t, &t->came, t->to[t->rank].data, t->to[t->rank].count);
    } else {
        team_exchange(t);
        ++t->stats.migrations;
    }
    unpack(set);
    t->share.owned = (uint32_t)set->count;
    t->share.owned_clumps = (uint32_t)set->clump_count;
    uint64_t total = set->count;
    team_add_counts(t, &total, 1);
    t->share.total = total;
}

static void reserve_table(team *t, size_t count)
{
    size_t size = 64;
    while (size < 2 * count) {
        size *= 2;
    }
    if (size > t->table_size) {
        size_t none = 0;
        free(t->table);
        t->table = NULL;
        team_reserve(t, &t->table, &none, size, sizeof *t->table);
        t->table_size = size;
    }
    memset(t->table, 0xff, t->table_size * sizeof *t->table); /* SE3DI_NO_INDEX */
}

static size_t slot_of(const team *t, uint32_t number)
{
    return (number * 2654435761u) & (t->table_size - 1);
}

static void fill_table(const se3di_particles *set)
{
    team *t = team_of(set);
    reserve_table(t, set->count);
    for (size_t k = 0; k < set->count; ++k) {
        size_t slot = slot_of(t, t->number[k]);
        while (t->table[slot] != SE3DI_NO_INDEX) {
            slot = (slot + 1) & (t->table_size - 1);
        }
        t->table[slot] = (uint32_t)k;
    }
}

uint32_t team_find(const team *t, uint32_t number)
{
    size_t slot = slot_of(t, number);
    while (t->table[slot] != SE3DI_NO_INDEX && t->number[t->table[slot]] != number) {
        slot = (slot + 1) & (t->table_size - 1);
    }
    return t->table[slot];
}

static void restore_histories(se3di_particles *set)
{
    team *t = team_of(set);
    const int rolling = set->rolling || set->rolls;
    if (se3di_particles_reserve_carry(set, t->history_count, rolling) < 0) {
        team_fail(t, "particles", "memory is missing");
    }
    size_t count = 0;
    for (size_t k = 0; k < t->history_count; ++k) {
        const history *h = &t->histories[k];
        const uint32_t i = team_find(t, h->i);
        const uint32_t j = h->j < SE3DI_CARRY_WALL ? team_find(t, h->j) : h->j;
        if (i == SE3DI_NO_INDEX || j == SE3DI_NO_INDEX) {
            continue; /* it has gone away from the other one */
        }
        set->carry[count] = (se3di_carry){i, j, {h->xi[0], h->xi[1], h->xi[2]}};
        for (size_t a = 0; rolling && a < 4; ++a) {
            set->carry_roll[4 * count + a] = h->rho[a];
        }
        ++count;
    }
    set->carry_count = count;
    set->carry_rolling = rolling;
}

static void restore_touches(se3di_particles *set)
{
    team *t = team_of(set);
    void *memory = set->mesh_old;
    const se3d_status status = se3di_array_reserve(
        &set->allocator, &memory, &set->mesh_old_capacity, t->touch_count, sizeof *set->mesh_old);
    set->mesh_old = memory;
    if (status < 0) {
        team_fail(t, "particles", "memory is missing");
    }
    set->mesh_old_count = 0;
    for (size_t k = 0; k < t->touch_count; ++k) {
        se3di_mesh_pair pair = t->touches[k];
        pair.i = team_find(t, pair.i);
        if (pair.i != SE3DI_NO_INDEX) {
            set->mesh_old[set->mesh_old_count++] = pair;
        }
    }
}

/* --- ghosts --- */

static int is_seen(const se3di_particles *set, size_t k, int q, double reach)
{
    const double *x = set->particles[k].x;
    return boxes_distance2(&team_of(set)->boxes, x, x, q) <= reach * reach;
}

static void note(const team *t, uint32_t **list, size_t *capacity, size_t at, size_t what)
{
    team_reserve(t, list, capacity, at + 1, sizeof **list);
    (*list)[at] = (uint32_t)what;
}

/* That process q sees particle k, or a clump with its spheres, from now on. */
static void show_particle(team *t, peer *p, size_t k)
{
    note(t, &t->seen, &t->seen_capacity, p->sent + p->sent_count++, k);
}

static uint64_t pack_free(const se3di_particles *set, peer *p, double reach, bytes *out)
{
    team *t = team_of(set);
    const size_t before = p->sent_count;
    for (size_t k = 0; k < t->share.owned; ++k) {
        if (!se3di_clump_find(set, k) && is_seen(set, k, p->rank, reach)) {
            const mover m = team_mover_of(set, k);
            bytes_put(t, out, &m, sizeof m);
            show_particle(t, p, k);
        }
    }
    return p->sent_count - before;
}

/* All of a clump, if any of its spheres is near. */
static uint64_t pack_bound(const se3di_particles *set, peer *p, double reach, bytes *out)
{
    team *t = team_of(set);
    for (uint32_t k = 0; k < t->share.owned_clumps; ++k) {
        const se3di_clump *clump = &set->clumps[k];
        const uint32_t spheres = team_count_spheres(set, clump);
        int near = 0;
        for (uint32_t n = 0; n < spheres; ++n) {
            near = near || is_seen(set, clump->first + n, p->rank, reach);
        }
        if (near) {
            pack_clump(set, clump, out);
            note(t, &t->seen_clumps, &t->seen_clump_capacity,
                 p->sent_clumps.from + p->sent_clumps.count++, k);
            for (uint32_t n = 0; n < spheres; ++n) {
                show_particle(t, p, clump->first + n);
            }
        }
    }
    return p->sent_clumps.count;
}

/* The ends of bonds of all spheres that it sees. */
static uint64_t pack_ends(const se3di_particles *set, peer *p, bytes *out)
{
    team *t = team_of(set);
    for (size_t k = 0; t->end_count > 0 && k < p->sent_count; ++k) {
        const uint32_t sphere = t->seen[p->sent + k], own = t->end_of[sphere];
        if (own != SE3DI_NO_INDEX) {
            bytes_put(t, out, &set->bond_ends[own], sizeof *set->bond_ends);
            note(t, &t->seen_ends, &t->seen_end_capacity, p->sent_ends.from + p->sent_ends.count++,
                 own);
        }
    }
    return p->sent_ends.count;
}

/* Which end of a bond an own sphere has: by its id, where it still is. */
static void find_ends(const se3di_particles *set)
{
    team *t = team_of(set);
    team_reserve(t, &t->end_of, &t->end_of_capacity, set->count + 1, sizeof *t->end_of);
    memset(t->end_of, 0xff, set->count * sizeof *t->end_of); /* SE3DI_NO_INDEX */
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        t->end_of[team_find(t, set->bond_ends[k].id)] = (uint32_t)k;
    }
}

/* Copies of what process q may touch: within `reach` of its box, beyond which own spheres of others
 * may be as far as `beyond`. */
static void pack_border(const se3di_particles *set, int q, double reach, double beyond)
{
    team *t = team_of(set);
    const boxes_box *own = &t->boxes.box[t->rank];
    const double far = reach + beyond;
    if (q == t->rank || boxes_distance2(&t->boxes, own->lower, own->upper, q) > far * far) {
        return;
    }
    border_head h = {0, 0, 0};
    peer *p = &t->peers[t->peer_count];
    *p = (peer){.rank = q};
    if (t->peer_count > 0) {
        p->sent = p[-1].sent + p[-1].sent_count;
        p->sent_clumps.from = p[-1].sent_clumps.from + p[-1].sent_clumps.count;
        p->sent_ends.from = p[-1].sent_ends.from + p[-1].sent_ends.count;
    }
    bytes_put(t, &t->to[q], &h, sizeof h);
    h.movers = pack_free(set, p, reach, &t->to[q]);
    h.clumps = pack_bound(set, p, reach, &t->to[q]);
    h.ends = pack_ends(set, p, &t->to[q]);
    memcpy(t->to[q].data, &h, sizeof h);
    ++t->peer_count; /* near each other: also if there is nothing to send now */
}

static void unpack_border(se3di_particles *set)
{
    team *t = team_of(set);
    for (size_t n = 0; n < t->peer_count; ++n) {
        peer *p = &t->peers[n];
        border_head h = {0, 0, 0};
        const int came = t->from[p->rank + 1] > t->from[p->rank];
        const unsigned char *at = take(t->came.data + t->from[p->rank], &h, came ? sizeof h : 0);
        p->first = (uint32_t)set->count;
        p->clumps = (span){set->clump_count, h.clumps};
        p->ends = (span){set->bond_end_count, h.ends};
        at = take_particles(set, at, h.movers, h.clumps);
        p->count = (uint32_t)(set->count - p->first);
        (void)take_ends(set, at, h.ends);
    }
}

void team_border(se3di_particles *set, double reach)
{
    team *t = team_of(set);
    double beyond = 0.0;
    clear(t);
    t->peer_count = 0;
    team_reach(set, &reach, &beyond);
    if (t->end_count > 0) {
        fill_table(set);
        find_ends(set);
    }
    for (int q = 0; q < t->size; ++q) {
        pack_border(set, q, reach, beyond);
    }
    team_exchange(t);
    unpack_border(set);
    team_index_clumps(set);
    fill_table(set);
    if (t->end_count > 0) {
        team_restore_bonds(set);
    }
    restore_histories(set);
    restore_touches(set);
}
