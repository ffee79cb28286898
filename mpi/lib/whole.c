/* SPDX-License-Identifier: BSD-3-Clause */
/* From a set that all processes have whole to one that is spread over them, and back. What lists
 * there were does not come back: the next run makes new ones, with the history of all contacts. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "particles/audit.h"
#include "particles/clump.h"
#include "particles/contacts.h"
#include "particles/grid.h"
#include "particles/list.h"
#include "particles/memory.h"
#include "particles/passage.h"
#include "team.h"

/* A particle with the forces on it. */
typedef struct loaded {
    mover mover;
    se3di_load load;
} loaded;

/* All of one kind from all processes: particles, pairs and walls that touch, the same on meshes and
 * their triangles, clumps, ends of bonds, bonds, those that are gone, and what contacts do to each
 * of the particles, if that is audited. */
enum { PARTICLES, PAIRS, WALLS, TOUCHES, FACES, CLUMPS, ENDS, TIES, GONE, AUDITS, KINDS };

static const size_t sizes[KINDS] = {sizeof(loaded),          sizeof(history),  sizeof(history),
                                    sizeof(se3di_mesh_pair), sizeof(uint32_t), sizeof(se3di_clump),
                                    sizeof(se3di_bond_end),  sizeof(tie),      sizeof(parting),
                                    sizeof(se3di_audit_load)};

typedef struct head {
    uint64_t count[KINDS];
} head;

typedef struct whole {
    uint64_t count[KINDS];
    void *of[KINDS];
} whole;

static const char *refusal(const se3di_particles *set)
{
    return set->cell.count > 0              ? "cannot be in a cell that strains"
           : set->law == SE3DI_LAW_CALLBACK ? "cannot have a law of contact of the user's own"
                                            : NULL;
}

/* Weights by the pairs that a particle is in the blocks of. */
static boxes_point *weigh(const se3di_particles *set)
{
    boxes_point *points = calloc(set->count + 1, sizeof *points);
    for (size_t k = 0; points && k < set->count; ++k) {
        memcpy(points[k].x, set->particles[k].x, sizeof points[k].x);
        points[k].number = set->spins[k].id;
        points[k].weight = 1.0;
    }
    for (uint32_t b = 0; points && set->list_valid && b < set->block_count; ++b) {
        for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
            const uint32_t i = set->blocks[b].i[lane];
            if (i < set->count) {
                points[i].weight += 9.0 / SE3DI_PARTICLE_LANES;
            }
        }
    }
    return points;
}

static void divide(se3di_particles *set)
{
    team *t = team_of(set);
    boxes_box all;
    boxes_point *points = weigh(set);
    if (!points) {
        team_fail(t, "particles", "memory is missing");
    }
    for (int a = 0; a < 3; ++a) {
        const int periodic = set->boundary[a] == SE3DI_BOUNDARY_PERIODIC;
        all.lower[a] = periodic ? set->lower[a] : -HUGE_VAL;
        all.upper[a] = periodic ? set->upper[a] : HUGE_VAL;
        t->boxes.period[a] = periodic ? set->upper[a] - set->lower[a] : 0.0;
    }
    boxes_divide(&t->boxes, &all, points, set->count);
    free(points);
}

/* Sums of what walls get are of multiples of 2^-12, 2^-36 and 2^-60 of about the weight of the
 * heaviest particle. */
static void choose_steps(se3di_particles *set)
{
    team *t = team_of(set);
    double mass = 0.0;
    int exponent = 0;
    for (size_t k = 0; k < set->count; ++k) {
        mass = fmax(mass, se3di_particles_mass(set, k));
    }
    (void)frexp(10.0 * mass, &exponent);
    for (int n = 0; n < SE3DI_EXACT_PARTS; ++n) {
        t->share.steps[n] = ldexp(1.5, 52 + exponent - 12 - 24 * n);
    }
    team_reserve(t, &t->share.sums, &t->sum_capacity,
                 6 * SE3DI_EXACT_PARTS * SE3DI_PARTICLE_SLABS_MAX * (set->wall_count + 1),
                 sizeof *t->share.sums);
    memset(t->share.sums, 0, t->sum_capacity * sizeof *t->share.sums);
    team_reserve(t, &t->share.powers, &t->power_capacity,
                 set->audits ? SE3DI_PARTICLE_SLABS_MAX : 0, sizeof *t->share.powers);
}

/* What sinks have taken before the run. */
static void keep_counts(se3di_particles *set)
{
    team *t = team_of(set);
    t->lost = set->lost;
    memcpy(t->lost_of, set->lost_of, sizeof t->lost_of);
    team_reserve(t, &t->removed, &t->removed_capacity, set->sink_count, sizeof *t->removed);
    for (size_t k = 0; k < set->sink_count; ++k) {
        t->removed[k] = set->sinks[k].count;
    }
}

/* The sum of what all have seen since. */
static void add_up(team *t, uint64_t *count, uint64_t before)
{
    uint64_t more = *count - before;
    team_add_counts(t, &more, 1);
    *count = before + more;
}

static void sum_counts(se3di_particles *set)
{
    team *t = team_of(set);
    const uint64_t lost = set->lost;
    add_up(t, &set->lost, t->lost);
    if (set->lost == lost && lost == t->lost) {
        return; /* none anywhere */
    }
    for (size_t k = 0; k < SE3D_PARTICLES_TAGS; ++k) {
        add_up(t, &set->lost_of[k], t->lost_of[k]);
    }
    for (size_t k = 0; k < set->sink_count; ++k) {
        add_up(t, &set->sinks[k].count, t->removed[k]);
    }
}

/* The forces of the last step belong to the particles, whoever has them; and `parts` of them, of an
 * audited set. */
typedef struct saved {
    se3di_load *loads; /* [id]; NULL: they are to be computed */
    se3di_audit_load *parts;
} saved;

static saved save_loads(const se3di_particles *set)
{
    team *t = team_of(set);
    saved s = {NULL, NULL};
    size_t none = 0, no_parts = 0;
    if (set->list_valid && set->force_valid) {
        team_reserve(t, &s.loads, &none, set->id_count + 1, sizeof *s.loads);
        team_reserve(t, &s.parts, &no_parts, set->audits ? set->id_count + 1 : 0, sizeof *s.parts);
        for (size_t k = 0; k < set->count; ++k) {
            s.loads[set->spins[k].id] = set->loads[k];
            if (set->audits) {
                s.parts[set->spins[k].id] = set->audit[k];
            }
        }
    }
    return s;
}

static void restore_loads(se3di_particles *set, const saved *s)
{
    for (size_t k = 0; s->loads && k < set->count; ++k) {
        if (!se3di_share_is_ghost(set, k)) {
            set->loads[k] = s->loads[se3di_share_number(set, k)];
            if (set->audits) {
                set->audit[k] = s->parts[se3di_share_number(set, k)];
            }
        }
    }
}

static void forget_loads(saved *s)
{
    free(s->loads);
    free(s->parts);
}

static void number_all(se3di_particles *set)
{
    team *t = team_of(set);
    t->share.ids = set->id_count;
    team_reserve(t, &t->number, &t->number_capacity, t->share.ids + 1, sizeof *t->number);
    for (size_t id = 0; id < t->share.ids; ++id) {
        t->number[id] = (uint32_t)id;
    }
    t->share.number = t->number;
    t->share.owned = SE3DI_NO_INDEX;
    t->share.owned_clumps = (uint32_t)set->clump_count;
    team_forget_arrivals(t);
    t->share.total = set->count;
}

se3d_status team_spread(se3di_particles *set, const char **why)
{
    team *t = team_of(set);
    *why = refusal(set);
    if (*why) {
        return SE3D_ERR_UNSUPPORTED;
    }
    t->begun = MPI_Wtime();
    divide(set);
    choose_steps(set);
    number_all(set);
    team_begin_bonds(set);
    saved loads = save_loads(set);
    const int32_t valid = loads.loads != NULL;
    t->from_whole = t->share.is_spread = 1;
    const se3d_status status = se3di_particles_rebuild(set);
    t->from_whole = 0;
    if (status == SE3D_ERR_NO_MEMORY) {
        team_fail(t, "particles", "memory is missing");
    }
    keep_counts(set);
    if (status < 0) {
        forget_loads(&loads);
        team_gather(set);
        return status;
    }
    restore_loads(set, &loads);
    forget_loads(&loads);
    set->force_valid = valid;
    return SE3D_OK;
}

/* Whether a lane of a block of pairs may be listed: it touches, or nearly. */
static int is_near(const se3di_particles *set, const se3di_particle *i, const se3di_particle *j)
{
    double sum = 0.0;
    for (int a = 0; a < 3; ++a) {
        const double length = set->upper[a] - set->lower[a];
        double d = fabs(i->x[a] - j->x[a]);
        if (set->boundary[a] == SE3DI_BOUNDARY_PERIODIC) {
            d = fmin(d, fabs(d - length));
        }
        sum += d * d;
    }
    const double reach = (i->radius + j->radius) * (1.0 + 1e-9);
    return sum < reach * reach;
}

static history lane_history(const se3di_particles *set, uint32_t b, int lane)
{
    const se3di_particle_block *block = &set->blocks[b];
    history h = {.xi = {block->xi[0][lane], block->xi[1][lane], block->xi[2][lane]}};
    for (int a = 0; set->rolls && a < 4; ++a) {
        h.rho[a] = set->rolls[b].rho[a][lane];
    }
    return h;
}

/* Pairs that belong to an own particle; of walls all that may touch. */
static void pack_block(const se3di_particles *set, const se3di_slab *slab, uint32_t b, bytes *pairs,
                       bytes *walls)
{
    const team *t = team_of(set);
    const se3di_particle_block *block = &set->blocks[b];
    for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
        const uint32_t i = block->i[lane], j = block->j[lane];
        if (i >= set->count || se3di_share_is_ghost(set, i)) {
            continue;
        }
        history h = lane_history(set, b, lane);
        h.i = se3di_share_number(set, i);
        if (b >= slab->wall_begin) {
            h.j = SE3DI_CARRY_WALL | block->j[0];
            bytes_put(t, walls, &h, sizeof h);
        } else if (is_near(set, &set->particles[i], &set->particles[j])) {
            h.j = se3di_share_number(set, j);
            bytes_put(t, pairs, &h, sizeof h);
        }
    }
}

static void pack_touch(const se3di_particles *set, se3di_mesh_pair pair, bytes *touches,
                       bytes *faces)
{
    const team *t = team_of(set);
    const uint32_t *own = set->faces + pair.face_begin;
    pair.i = se3di_share_number(set, pair.i);
    pair.face_begin = (uint32_t)(faces->count / sizeof *own);
    bytes_put(t, touches, &pair, sizeof pair);
    bytes_put(t, faces, own, pair.face_count * sizeof *own);
}

/* All that this process has to tell. */
static void pack(const se3di_particles *set, bytes *out)
{
    const team *t = team_of(set);
    bytes part[KINDS] = {{NULL, 0, 0}};
    head h;
    for (size_t k = 0; k < set->count; ++k) {
        if (!se3di_share_is_ghost(set, k)) {
            loaded p = {{se3di_share_number(set, k), 0, set->particles[k], set->spins[k]},
                        {{0.0}, {0.0}}};
            if (set->list_valid) {
                p.load = set->loads[k];
            }
            p.mover.spin.id = p.mover.number;
            bytes_put(t, &part[PARTICLES], &p, sizeof p);
            if (set->audits) {
                bytes_put(t, &part[AUDITS], &set->audit[k], sizeof set->audit[k]);
            }
        }
    }
    for (uint32_t s = 0; set->list_valid && s < set->slab_count; ++s) {
        const se3di_slab *slab = &set->slabs[s];
        for (uint32_t b = slab->pair_begin; b < slab->wall_end; ++b) {
            pack_block(set, slab, b, &part[PAIRS], &part[WALLS]);
        }
        for (uint32_t k = slab->mesh_begin; k < slab->mesh_end; ++k) {
            pack_touch(set, set->mesh_pairs[k], &part[TOUCHES], &part[FACES]);
        }
    }
    for (size_t k = 0; k < se3di_share_clumps(set); ++k) {
        se3di_clump clump = set->clumps[k];
        clump.first = se3di_share_number(set, set->index_of[clump.first]);
        bytes_put(t, &part[CLUMPS], &clump, sizeof clump);
    }
    team_pack_ends(set, &part[ENDS]);
    team_pack_ties(set, &part[TIES]);
    bytes_put(t, &part[GONE], t->gone, set->bonds_gone * sizeof *t->gone);
    for (int k = 0; k < KINDS; ++k) {
        h.count[k] = part[k].count / sizes[k];
    }
    bytes_put(t, out, &h, sizeof h);
    for (int k = 0; k < KINDS; ++k) {
        bytes_put(t, out, part[k].data, part[k].count);
        free(part[k].data);
    }
}

static void *make(const team *t, size_t count, size_t size)
{
    void *data = calloc(count + 1, size);
    if (!data) {
        team_fail(t, "particles", "memory is missing");
    }
    return data;
}

static head head_of(const team *t, int q)
{
    head h;
    memcpy(&h, t->came.data + t->from[q], sizeof h);
    return h;
}

/* The next `count` elements of what came from one process. */
static const unsigned char *take(const unsigned char *at, void *to, uint64_t count, size_t size)
{
    if (count > 0) {
        memcpy(to, at, count * size);
    }
    return at + count * size;
}

static whole unpack(const team *t)
{
    whole w = {.count = {0}};
    uint64_t sum[KINDS] = {0};
    for (int q = 0; q < t->size; ++q) {
        const head h = head_of(t, q);
        for (int k = 0; k < KINDS; ++k) {
            sum[k] += h.count[k];
        }
    }
    for (int k = 0; k < KINDS; ++k) {
        w.of[k] = make(t, sum[k], sizes[k]);
    }
    for (int q = 0; q < t->size; ++q) {
        const head h = head_of(t, q);
        const unsigned char *at = t->came.data + t->from[q] + sizeof h;
        se3di_mesh_pair *touches = (se3di_mesh_pair *)w.of[TOUCHES] + w.count[TOUCHES];
        const uint32_t faces = (uint32_t)w.count[FACES];
        for (int k = 0; k < KINDS; ++k) {
            at = take(at, (char *)w.of[k] + w.count[k] * sizes[k], h.count[k], sizes[k]);
            w.count[k] += h.count[k];
        }
        for (uint64_t k = 0; k < h.count[TOUCHES]; ++k) {
            touches[k].face_begin += faces;
        }
    }
    return w;
}

static void drop(whole *w)
{
    for (int k = 0; k < KINDS; ++k) {
        free(w->of[k]);
    }
}

/* Particles by their numbers; index_of[] finds them. */
static void fill_particles(se3di_particles *set, const whole *w)
{
    team *t = team_of(set);
    const size_t count = w->count[PARTICLES];
    const loaded *particles = w->of[PARTICLES];
    set->list_valid = 0;
    set->count = set->id_count = set->carry_count = set->mesh_old_count = 0;
    set->clump_count = set->bond_count = set->bond_end_count = 0;
    if (se3di_particles_reserve(set, count) < 0 ||
        se3di_particles_grow(set, &set->index_of, &set->index_capacity, t->share.ids) < 0) {
        team_fail(t, "particles", "memory is missing");
    }
    if (t->share.ids > 0) {
        memset(set->index_of, 0xff, t->share.ids * sizeof *set->index_of); /* SE3DI_NO_INDEX */
    }
    for (size_t k = 0; k < count; ++k) {
        set->index_of[particles[k].mover.number] = (uint32_t)k;
    }
    for (size_t id = 0; id < t->share.ids; ++id) {
        const uint32_t from = set->index_of[id];
        if (from != SE3DI_NO_INDEX) {
            const size_t k = set->count++;
            set->particles[k] = particles[from].mover.particle;
            set->spins[k] = particles[from].mover.spin;
            set->loads[k] = particles[from].load;
            if (w->count[AUDITS] > 0) {
                set->audit[k] = ((const se3di_audit_load *)w->of[AUDITS])[from];
            }
            set->index_of[id] = (uint32_t)k;
        }
    }
    set->id_count = t->share.ids;
}

static int compare_clumps(const void *a, const void *b)
{
    const se3di_clump *c = a, *d = b;
    return c->first < d->first ? -1 : c->first > d->first;
}

/* In the order in which they were made, which is that of their first spheres. */
static void fill_clumps(se3di_particles *set, const whole *w)
{
    const size_t count = w->count[CLUMPS];
    if (set->template_count == 0) {
        return;
    }
    if (se3di_clumps_reserve(set, set->id_count, count) < 0) {
        team_fail(team_of(set), "particles", "memory is missing");
    }
    qsort(w->of[CLUMPS], count, sizeof *set->clumps, compare_clumps);
    if (count > 0) {
        memcpy(set->clumps, w->of[CLUMPS], count * sizeof *set->clumps);
    }
    set->clump_count = count;
    team_index_clumps(set);
}

static int compare_histories(const void *a, const void *b)
{
    const history *h = a, *g = b;
    if (h->i != g->i) {
        return h->i < g->i ? -1 : 1;
    }
    return h->j < g->j ? -1 : h->j > g->j;
}

static int compare_walls(const void *a, const void *b)
{
    const history *h = a, *g = b;
    if (h->j != g->j) {
        return h->j < g->j ? -1 : 1;
    }
    return h->i < g->i ? -1 : h->i > g->i;
}

static int compare_touches(const void *a, const void *b)
{
    const se3di_mesh_pair *h = a, *g = b;
    if (h->wall != g->wall) {
        return h->wall < g->wall ? -1 : 1;
    }
    return h->i < g->i ? -1 : h->i > g->i;
}

static void reserve_blocks(se3di_particles *set, size_t count)
{
    const se3d_allocator *a = &set->allocator;
    se3d_status status =
        se3di_aligned_reserve(a, &set->block_memory, (count + 1) * sizeof *set->blocks, 0);
    set->blocks = set->block_memory.data;
    if (status >= 0 && (set->rolling || set->rolls)) {
        status = se3di_aligned_reserve(a, &set->roll_memory, (count + 1) * sizeof *set->rolls, 0);
        set->rolls = set->roll_memory.data;
    }
    if (status < 0) {
        team_fail(team_of(set), "particles", "memory is missing");
    }
}

static void open_block(se3di_particles *set)
{
    const uint32_t b = set->block_count++;
    memset(&set->blocks[b], 0, sizeof set->blocks[b]);
    if (set->rolls) {
        memset(&set->rolls[b], 0, sizeof set->rolls[b]);
    }
    for (int k = 0; k < SE3DI_PARTICLE_LANES; ++k) {
        set->blocks[b].i[k] = set->blocks[b].j[k] = (uint32_t)set->capacity;
    }
}

static void fill_lane(se3di_particles *set, const history *h, int lane)
{
    const uint32_t b = set->block_count - 1;
    se3di_particle_block *block = &set->blocks[b];
    block->i[lane] = set->index_of[h->i];
    if (h->j >= SE3DI_CARRY_WALL) {
        block->j[0] = h->j & ~SE3DI_CARRY_WALL;
    } else {
        block->j[lane] = set->index_of[h->j];
    }
    for (int a = 0; a < 3; ++a) {
        block->xi[a][lane] = h->xi[a];
    }
    for (int a = 0; set->rolls && a < 4; ++a) {
        set->rolls[b].rho[a][lane] = h->rho[a];
    }
}

/* One slab holds all. */
static void fill_blocks(se3di_particles *set, const whole *w, se3di_slab *slab)
{
    const history *pairs = w->of[PAIRS], *walls = w->of[WALLS];
    int lane = SE3DI_PARTICLE_LANES;
    reserve_blocks(set, w->count[PAIRS] / SE3DI_PARTICLE_LANES + w->count[WALLS] + 2);
    set->block_count = 0;
    for (uint64_t k = 0; k < w->count[PAIRS]; ++k) {
        if (lane == SE3DI_PARTICLE_LANES) {
            open_block(set);
            lane = 0;
        }
        fill_lane(set, &pairs[k], lane++);
    }
    slab->pair_end = slab->wall_begin = set->block_count;
    for (uint64_t k = 0; k < w->count[WALLS]; ++k) {
        if (k == 0 || lane == SE3DI_PARTICLE_LANES || walls[k].j != walls[k - 1].j) {
            open_block(set);
            lane = 0;
        }
        fill_lane(set, &walls[k], lane++);
    }
    slab->wall_end = set->block_count;
}

static void fill_touches(se3di_particles *set, const whole *w, se3di_slab *slab)
{
    const se3di_mesh_pair *touches = w->of[TOUCHES];
    void *memory = set->mesh_pairs;
    se3d_status status = se3di_array_reserve(&set->allocator, &memory, &set->mesh_capacity,
                                             w->count[TOUCHES], sizeof *set->mesh_pairs);
    set->mesh_pairs = memory;
    if (status >= 0) {
        memory = set->mesh_old; /* they change places */
        status = se3di_array_reserve(&set->allocator, &memory, &set->mesh_old_capacity,
                                     w->count[TOUCHES], sizeof *set->mesh_old);
        set->mesh_old = memory;
    }
    if (status < 0 ||
        se3di_particles_grow(set, &set->faces, &set->face_capacity, w->count[FACES]) < 0) {
        team_fail(team_of(set), "particles", "memory is missing");
    }
    set->face_count = w->count[FACES];
    set->mesh_count = w->count[TOUCHES];
    if (w->count[FACES] > 0) {
        memcpy(set->faces, w->of[FACES], w->count[FACES] * sizeof *set->faces);
    }
    for (size_t k = 0; k < set->mesh_count; ++k) {
        set->mesh_pairs[k] = touches[k];
        set->mesh_pairs[k].i = set->index_of[touches[k].i];
    }
    slab->mesh_end = (uint32_t)set->mesh_count;
}

/* Lists that hold nothing but what touches, and must be made anew before the next forces. */
static void fill_lists(se3di_particles *set, whole *w)
{
    qsort(w->of[PAIRS], w->count[PAIRS], sizes[PAIRS], compare_histories);
    qsort(w->of[WALLS], w->count[WALLS], sizes[WALLS], compare_walls);
    qsort(w->of[TOUCHES], w->count[TOUCHES], sizes[TOUCHES], compare_touches);
    se3di_slab *slab = &set->slabs[0];
    memset(slab, 0, sizeof *slab);
    slab->end = (uint32_t)set->count;
    set->slab_count = 1;
    set->list_count = set->near_count = 0;
    memset(set->first, 0, (set->count + 1) * sizeof *set->first);
    fill_blocks(set, w, slab);
    fill_touches(set, w, slab);
    for (size_t k = 0; k < set->count; ++k) {
        memcpy(set->origin + 3 * k, set->particles[k].x, sizeof set->particles[k].x);
        se3di_particles_reach(set)[k] = se3di_particles_wear(set)[k] = 0.0;
    }
    set->worn = 1.0;
    set->list_valid = 1;
}

void team_gather(se3di_particles *set)
{
    team *t = team_of(set);
    bytes own = {NULL, 0, 0};
    const int32_t forced = set->force_valid, listed = set->list_valid;
    t->stats.owned = t->share.owned;
    t->stats.ghosts = set->count - t->share.owned;
    pack(set, &own);
    sum_counts(set);
    se3di_flows_unite(set);
    if (set->audits) {
        se3di_audit_unite(set);
    }
    team_collect(t, &own);
    free(own.data);
    whole w = unpack(t);
    t->share.is_spread = 0;
    fill_particles(set, &w);
    fill_clumps(set, &w);
    team_fill_bonds(set, &(all_bonds){.ends = w.of[ENDS],
                                      .ties = w.of[TIES],
                                      .gone = w.of[GONE],
                                      .end_count = w.count[ENDS],
                                      .tie_count = w.count[TIES],
                                      .gone_count = w.count[GONE]});
    if (listed && set->count > 0) {
        size_t touching = 0;
        fill_lists(set, &w);
        (void)se3di_particles_contacts(set, 0, NULL, sizeof(se3d_particles_contact), &touching,
                                       NULL);
        set->touching = touching;
    }
    set->force_valid = forced;
    drop(&w);
    t->stats.elapsed += MPI_Wtime() - t->begun;
}
