/* SPDX-License-Identifier: BSD-3-Clause */
/* What touches or is jointed, directly or by others, is an island: each is solved by itself, with
 * its own search along lines and its own end. Bodies that nothing touches or holds move as loads
 * say. A machine, that is what joints and elements join, drifts if nothing touches any of it. */
#include "integrator/convex.h"

#include "base/sort.h"
#include "primitive/user.h"

#include <string.h>

static se3d_status reserve_all(se3di_convex *c, const se3di_assembly *assembly)
{
    const size_t bodies = assembly->body_count, contacts = c->contact_count;
    const struct {
        void *place;
        size_t *capacity, count, size;
    } arrays[] = {{&c->islands, &c->island_capacity, bodies + 1, sizeof *c->islands},
                  {&c->place, &c->place_capacity, bodies + 1, sizeof *c->place},
                  {&c->body_at, &c->body_at_capacity, bodies + 1, sizeof *c->body_at},
                  {&c->root, &c->root_capacity, bodies + 1, sizeof *c->root},
                  {&c->number, &c->number_capacity, bodies + 1, sizeof *c->number},
                  {&c->order, &c->order_capacity, contacts + 1, sizeof *c->order},
                  {&c->stirred, &c->stirred_capacity, bodies + 1, sizeof *c->stirred},
                  {&c->pairs, &c->pair_capacity, contacts + assembly->armature_pair_count + 1,
                   2 * sizeof *c->pairs},
                  {&c->mobility, &c->mobility_capacity, 10 * bodies + 1, sizeof *c->mobility},
                  {&c->own, &c->own_capacity, 36 * bodies + 1, sizeof *c->own},
                  {&c->spin, &c->spin_capacity, 6 * bodies + 1, sizeof *c->spin}};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k) {
        SE3DI_TRY(se3di_array_reserve_at(&assembly->model->allocator, arrays[k].place,
                                         arrays[k].capacity, arrays[k].count, arrays[k].size));
    }
    return SE3D_OK;
}

static int32_t find_root(se3di_convex *c, int32_t body)
{
    while (c->root[body] != body) {
        c->root[body] = c->root[c->root[body]];
        body = c->root[body];
    }
    return body;
}

/* Any of its bodies that is free. */
static int32_t body_of(const se3di_convex_contact *contact)
{
    return contact->free[0] >= 0 ? contact->free[0] : contact->free[1];
}

static void join_two(se3di_convex *c, int32_t one, int32_t other)
{
    const int32_t i = find_root(c, one), j = find_root(c, other);
    c->root[i < j ? j : i] = i < j ? i : j;
}

/* What constraints hold takes part. */
static void join_constraints(se3di_convex *c, const se3di_assembly *assembly)
{
    for (uint32_t j = 0; j < assembly->constraint_count; ++j) {
        const int32_t first = se3di_convex_joined(assembly, j);
        if (first < 0 || c->asleep[first]) {
            continue;
        }
        for (int32_t e = assembly->joint_begin[j]; e < assembly->joint_begin[j + 1]; ++e) {
            join_two(c, first, assembly->joint_body[e]);
            c->number[assembly->joint_body[e]] = 0;
        }
    }
}

static void begin_joining(se3di_convex *c, const se3di_assembly *assembly)
{
    const int32_t bodies = (int32_t)assembly->body_count;
    for (int32_t k = 0; k < bodies; ++k) {
        c->root[k] = k;
        c->number[k] = c->touched[k] ? 0 : -1;
    }
    join_constraints(c, assembly);
}

/* What acts on one machine may be a function of any other one's state. */
static int joins_all(const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    int joins = assembly->user_count > 0 || model->state_count > 0;
    for (size_t k = 0; k < model->function_slots.count && !joins; ++k) {
        joins = model->functions[k].signal_count > 0;
    }
    for (size_t k = 0; k < model->force_slots.count && !joins; ++k) {
        joins = model->forces[k].type == SE3DI_FORCE_CALLBACK;
    }
    return joins;
}

static void join_elements(se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    const uint32_t joined = joins_all(assembly) ? assembly->body_count : 0;
    int32_t linked = -1;
    for (size_t k = 0; k < model->force_slots.count; ++k) {
        const int32_t i = assembly->free_index[model->forces[k].body_i];
        const int32_t j = assembly->free_index[model->forces[k].body_j];
        if (i >= 0 && j >= 0) {
            join_two(c, i, j);
        }
    }
    for (uint32_t k = 0; k < joined; ++k) {
        if (c->linked[k]) {
            linked = linked < 0 ? (int32_t)k : linked;
            join_two(c, linked, (int32_t)k);
        }
    }
}

/* Bodies that touch do not drift. */
static void mark_touching(const se3di_convex *c, const se3di_assembly *assembly)
{
    const se3di_model *model = assembly->model;
    for (size_t k = 0; k < model->contacts.count; ++k) {
        const se3di_body_contact *r = &model->contacts.list[k];
        for (int side = 0; side < 2; ++side) {
            const uint32_t shape = side ? r->shape_j : r->shape_i;
            const int32_t free = assembly->free_index[model->shapes[shape].body];
            if (free >= 0) {
                c->drifts[free] = 0;
            }
        }
    }
}

/* Nor does what they are joined to. */
static void spread_touching(se3di_convex *c, const se3di_assembly *assembly)
{
    const int32_t bodies = (int32_t)assembly->body_count;
    begin_joining(c, assembly);
    join_elements(c, assembly);
    for (int32_t k = 0; k < bodies; ++k) {
        c->drifts[find_root(c, k)] &= c->drifts[k];
    }
    for (int32_t k = 0; k < bodies; ++k) {
        c->drifts[k] = !c->asleep[k] && c->drifts[find_root(c, k)];
    }
}

se3d_status se3di_convex_find_drifting(se3di_convex *c, const se3di_assembly *assembly,
                                       se3di_error *error)
{
    const se3di_model *model = assembly->model;
    const uint32_t bodies = assembly->body_count;
    if (reserve_all(c, assembly) < 0) {
        return se3di_error_set(error, SE3D_ERR_NO_MEMORY, "t = %g s: no memory for a step",
                               model->time);
    }
    memset(c->drifts, 1, bodies);
    mark_touching(c, assembly);
    se3di_convex_mark_stops(c, assembly);
    if (c->asleep_count > 0 || memchr(c->drifts, 0, bodies)) {
        spread_touching(c, assembly);
    }
    c->drifting = 0;
    for (uint32_t k = 0; k < bodies; ++k) {
        c->drifting += c->drifts[k];
    }
    return SE3D_OK;
}

/* The first body of each island becomes its root. */
static void join(se3di_convex *c, const se3di_assembly *assembly)
{
    const int32_t bodies = (int32_t)assembly->body_count;
    begin_joining(c, assembly);
    for (size_t k = 0; k < c->contact_count; ++k) {
        const se3di_convex_contact *contact = &c->contacts[k];
        if (contact->free[0] >= 0 && contact->free[1] >= 0) {
            join_two(c, contact->free[0], contact->free[1]);
        }
    }
    for (int32_t k = 0; k < bodies; ++k) {
        c->root[k] = find_root(c, k);
    }
}

static se3di_convex_island *island_of(const se3di_convex *c, const se3di_convex_contact *contact)
{
    return &c->islands[c->number[body_of(contact)]];
}

/* Islands, in the order of their first bodies, with the counts of what is in them. */
static void count_islands(se3di_convex *c, const se3di_assembly *assembly)
{
    c->island_count = 0;
    for (size_t k = 0; k < assembly->body_count; ++k) {
        if (!se3di_convex_takes_part(c, k)) {
            continue;
        }
        if ((size_t)c->root[k] == k) {
            c->number[k] = (int32_t)c->island_count;
            c->islands[c->island_count++] = (se3di_convex_island){.body = 0};
        }
        c->number[k] = c->number[c->root[k]];
        ++c->islands[c->number[k]].body_end;
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        ++island_of(c, &c->contacts[k])->contact_end;
    }
}

/* Counts become beginnings. Returns the count of all bodies. */
static size_t lay_out(se3di_convex *c)
{
    size_t body = 0, contact = 0;
    for (size_t k = 0; k < c->island_count; ++k) {
        se3di_convex_island *island = &c->islands[k];
        const size_t bodies = island->body_end, contacts = island->contact_end;
        island->body = island->body_end = body;
        island->contact = island->contact_end = contact;
        body += bodies;
        contact += contacts;
    }
    return body;
}

/* Fill the islands; others come last. */
static void fill(se3di_convex *c, const se3di_assembly *assembly)
{
    size_t last = lay_out(c);
    for (size_t k = 0; k < assembly->body_count; ++k) {
        c->place[k] = se3di_convex_takes_part(c, k) ? (int32_t)c->islands[c->number[k]].body_end++
                                                    : (int32_t)last++;
        c->body_at[c->place[k]] = (int32_t)k;
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        c->order[island_of(c, &c->contacts[k])->contact_end++] = (int32_t)k;
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        for (int side = 0; side < 2; ++side) {
            int32_t *free = &c->contacts[k].free[side];
            *free = *free >= 0 ? c->place[*free] : -1;
        }
    }
}

static int compare_pairs(const int32_t *a, const int32_t *b)
{
    const int first = (a[0] > b[0]) - (a[0] < b[0]);
    return first ? first : (a[1] > b[1]) - (a[1] < b[1]);
}

static int32_t find_pair(const se3di_convex *c, const int32_t pair[2])
{
    size_t low = 0, high = c->pair_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (compare_pairs(c->pairs + 2 * middle, pair) < 0) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return (int32_t)low;
}

/* Returns 0 if one of its bodies is fixed. */
static int get_pair(const se3di_convex_contact *contact, int32_t pair[2])
{
    const int turned = contact->free[0] > contact->free[1];
    pair[0] = contact->free[turned];
    pair[1] = contact->free[!turned];
    return pair[0] >= 0;
}

/* The places of two bodies that an armature couples; 0: they are not solved for. */
static int get_tie(const se3di_convex *c, const se3di_assembly *assembly, uint32_t tie,
                   int32_t pair[2])
{
    const int32_t *free = assembly->armature_pair + 2 * (size_t)tie;
    pair[0] = c->place[free[0]]; /* bodies of an island stay in their order */
    pair[1] = c->place[free[1]];
    return se3di_convex_takes_part(c, (size_t)free[0]);
}

int32_t se3di_convex_find_tie(const se3di_convex *c, const se3di_assembly *assembly, uint32_t tie)
{
    int32_t pair[2];
    return get_tie(c, assembly, tie, pair) ? find_pair(c, pair) : -1;
}

/* The couplings of bodies by contacts and armatures, in the order of places. */
static void list_pairs(se3di_convex *c, const se3di_assembly *assembly)
{
    size_t count = 0;
    int32_t pair[2];
    for (size_t k = 0; k < c->contact_count; ++k) {
        if (get_pair(&c->contacts[k], pair) &&
            (count == 0 || compare_pairs(pair, c->pairs + 2 * count - 2) != 0)) {
            memcpy(c->pairs + 2 * count++, pair, sizeof pair);
        }
    }
    for (uint32_t k = 0; k < assembly->armature_pair_count; ++k) {
        count += (size_t)get_tie(c, assembly, k, c->pairs + 2 * count);
    }
    se3di_sort_tuples(c->pairs, count, 2);
    c->pair_count = 0;
    for (size_t k = 0; k < count; ++k) {
        if (c->pair_count == 0 ||
            compare_pairs(c->pairs + 2 * k, c->pairs + 2 * (c->pair_count - 1)) != 0) {
            memmove(c->pairs + 2 * c->pair_count++, c->pairs + 2 * k, 2 * sizeof *c->pairs);
        }
    }
    for (size_t k = 0; k < c->contact_count; ++k) {
        if (get_pair(&c->contacts[k], pair)) {
            c->contacts[k].coupling = find_pair(c, pair);
        }
    }
}

static void share_pairs(se3di_convex *c)
{
    size_t pair = 0;
    for (size_t k = 0; k < c->island_count; ++k) {
        se3di_convex_island *island = &c->islands[k];
        island->pair = pair;
        while (pair < c->pair_count && (size_t)c->pairs[2 * pair] < island->body_end) {
            ++pair;
        }
        island->pair_end = pair;
    }
}

se3d_status se3di_convex_group(se3di_convex *c, const se3di_assembly *assembly)
{
    SE3DI_TRY(reserve_all(c, assembly));
    join(c, assembly);
    count_islands(c, assembly);
    fill(c, assembly);
    list_pairs(c, assembly);
    share_pairs(c);
    return se3di_convex_share_rows(c, assembly);
}
