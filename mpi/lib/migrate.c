/* SPDX-License-Identifier: BSD-3-Clause */
/* When lists are made anew: particles go to whom the place belongs that they are at now, with the
 * history of their contacts, and everyone gets copies of what its own may touch. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "particles/list.h"
#include "particles/wall.h"
#include "team.h"

/* What a message to one process consists of. */
typedef struct head {
    uint64_t movers, histories, touches;
} head;

typedef struct parcels {
    bytes *movers, *histories, *touches; /* [size] */
} parcels;

static void clear(team *t)
{
    for (int q = 0; q < t->size; ++q) {
        t->to[q].count = 0;
    }
}

static parcels make_parcels(const team *t)
{
    bytes *all = calloc(3 * (size_t)t->size, sizeof *all);
    if (!all) {
        team_fail(t, "particles", "memory is missing");
    }
    return (parcels){all, all + t->size, all + 2 * t->size};
}

static void drop_parcels(const team *t, parcels *p)
{
    for (int q = 0; q < 3 * t->size; ++q) {
        free(p->movers[q].data);
    }
    free(p->movers);
}

/* Whose particle k is from now on; -1: it goes. */
static int owner_of(const se3di_particles *set, size_t k)
{
    return set->order[k] ? boxes_find(&team_of(set)->boxes, set->particles[k].x) : -1;
}

/* If everyone has everything only what stays here is looked at. */
static int is_sent(const team *t, int owner)
{
    return owner >= 0 && (!t->from_whole || owner == t->rank);
}

static mover mover_of(const se3di_particles *set, size_t k)
{
    return (mover){se3di_share_number(set, k), 0, set->particles[k], set->spins[k]};
}

static void pack_movers(const se3di_particles *set, parcels *p)
{
    team *t = team_of(set);
    for (size_t k = 0; k < set->count; ++k) {
        const int owner = owner_of(set, k);
        if (is_sent(t, owner)) {
            const mover m = mover_of(set, k);
            bytes_put(t, &p->movers[owner], &m, sizeof m);
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
        if (is_sent(t, first)) {
            bytes_put(t, &p->histories[first], &h, sizeof h);
        }
        if (second != first && is_sent(t, second)) {
            bytes_put(t, &p->histories[second], &h, sizeof h);
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
        if (is_sent(t, owner)) {
            bytes_put(t, &p->touches[owner], &pair, sizeof pair);
        }
    }
}

static void join(team *t, const parcels *p)
{
    clear(t);
    for (int q = 0; q < t->size; ++q) {
        const head h = {p->movers[q].count / sizeof(mover), p->histories[q].count / sizeof(history),
                        p->touches[q].count / sizeof(se3di_mesh_pair)};
        if (h.movers + h.histories + h.touches > 0) {
            bytes_put(t, &t->to[q], &h, sizeof h);
            bytes_put(t, &t->to[q], p->movers[q].data, p->movers[q].count);
            bytes_put(t, &t->to[q], p->histories[q].data, p->histories[q].count);
            bytes_put(t, &t->to[q], p->touches[q].data, p->touches[q].count);
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

static void append(se3di_particles *set, const mover *m)
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
}

static void unpack(se3di_particles *set)
{
    team *t = team_of(set);
    begin_empty(set);
    t->history_count = t->touch_count = 0;
    for (int q = 0; q < t->size; ++q) {
        const unsigned char *at = t->came.data + t->from[q];
        head h = {0, 0, 0};
        if (t->from[q + 1] == t->from[q]) {
            continue;
        }
        at = take(at, &h, sizeof h);
        reserve(set, set->count + h.movers);
        for (uint64_t k = 0; k < h.movers; ++k) {
            mover m;
            at = take(at, &m, sizeof m);
            append(set, &m);
        }
        team_reserve(t, &t->histories, &t->history_capacity, t->history_count + h.histories,
                     sizeof *t->histories);
        at = take(at, t->histories + t->history_count, h.histories * sizeof(history));
        t->history_count += h.histories;
        team_reserve(t, &t->touches, &t->touch_capacity, t->touch_count + h.touches,
                     sizeof *t->touches);
        (void)take(at, t->touches + t->touch_count, h.touches * sizeof(se3di_mesh_pair));
        t->touch_count += h.touches;
    }
    reserve(set, set->count);
}

void team_insert(se3di_particles *set)
{
    team *t = team_of(set);
    const size_t k = set->count - 1;
    mover m = {(uint32_t)t->share.ids++, 0, set->particles[k], set->spins[k]};
    set->count = set->id_count = k;
    se3di_particles_come_home(set, m.particle.x);
    team_reserve(t, &t->share.fresh, &t->fresh_capacity, t->share.fresh_count + 1,
                 sizeof *t->share.fresh);
    double *fresh = t->share.fresh[t->share.fresh_count++];
    memcpy(fresh, m.particle.x, sizeof m.particle.x);
    fresh[3] = m.particle.radius;
    if (boxes_find(&t->boxes, m.particle.x) == t->rank) {
        team_reserve(t, &t->arrivals, &t->arrival_capacity, t->arrival_count + 1,
                     sizeof *t->arrivals);
        t->arrivals[t->arrival_count++] = m;
    }
}

static void pack_arrivals(team *t, parcels *p)
{
    bytes_put(t, &p->movers[t->rank], t->arrivals, t->arrival_count * sizeof *t->arrivals);
    t->arrival_count = t->share.fresh_count = 0;
}

void team_migrate(se3di_particles *set)
{
    team *t = team_of(set);
    parcels p = make_parcels(t);
    t->peer_count = 0;
    pack_movers(set, &p);
    pack_arrivals(t, &p);
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

/* The particle of a number, which still lies where its id says; SE3DI_NO_INDEX: not here. */
static uint32_t find(const team *t, uint32_t number)
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
        const uint32_t i = find(t, h->i);
        const uint32_t j = h->j < SE3DI_CARRY_WALL ? find(t, h->j) : h->j;
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
        pair.i = find(t, pair.i);
        if (pair.i != SE3DI_NO_INDEX) {
            set->mesh_old[set->mesh_old_count++] = pair;
        }
    }
}

/* Copies of the own particles that are within `reach` of what process q has. */
static void pack_border(const se3di_particles *set, int q, double reach)
{
    team *t = team_of(set);
    const boxes_box *own = &t->boxes.box[t->rank];
    if (q == t->rank || boxes_distance2(&t->boxes, own->lower, own->upper, q) > reach * reach) {
        return;
    }
    peer *p = &t->peers[t->peer_count];
    *p = (peer){.rank = q, .sent = t->peer_count > 0 ? p[-1].sent + p[-1].sent_count : 0};
    for (size_t k = 0; k < t->share.owned; ++k) {
        const double *x = set->particles[k].x;
        if (boxes_distance2(&t->boxes, x, x, q) <= reach * reach) {
            const mover m = mover_of(set, k);
            bytes_put(t, &t->to[q], &m, sizeof m);
            team_reserve(t, &t->seen, &t->seen_capacity, p->sent + p->sent_count + 1,
                         sizeof *t->seen);
            t->seen[p->sent + p->sent_count++] = (uint32_t)k;
        }
    }
    ++t->peer_count; /* near each other: also if there is nothing to send now */
}

static void unpack_border(se3di_particles *set)
{
    team *t = team_of(set);
    for (size_t n = 0; n < t->peer_count; ++n) {
        peer *p = &t->peers[n];
        const unsigned char *at = t->came.data + t->from[p->rank];
        p->first = (uint32_t)set->count;
        p->count = (uint32_t)((t->from[p->rank + 1] - t->from[p->rank]) / sizeof(mover));
        reserve(set, set->count + p->count);
        for (uint32_t k = 0; k < p->count; ++k) {
            mover m;
            at = take(at, &m, sizeof m);
            append(set, &m);
        }
    }
}

void team_border(se3di_particles *set, double reach)
{
    team *t = team_of(set);
    clear(t);
    t->peer_count = 0;
    for (int q = 0; q < t->size; ++q) {
        pack_border(set, q, reach);
    }
    team_exchange(t);
    unpack_border(set);
    fill_table(set);
    restore_histories(set);
    restore_touches(set);
}
