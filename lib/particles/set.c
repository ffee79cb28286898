/* SPDX-License-Identifier: BSD-3-Clause */
/* Life time and editing of particle sets; nothing here moves a particle. */
#include "particles/bond.h"
#include "particles/clump.h"
#include "particles/kept.h"
#include "particles/list.h"
#include "particles/memory.h"
#include "particles/servo.h"
#include "particles/share.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

const se3di_kernels *se3di_particle_kernels_choose(int32_t portable)
{
    const se3di_kernels *best = portable ? NULL : se3di_particle_kernels_avx512();
    if (!best && !portable) {
        best = se3di_particle_kernels_avx2();
    }
    return best ? best : se3di_particle_kernels_portable();
}

void se3di_particles_init(se3di_particles *set, const se3d_allocator *allocator)
{
    memset(set, 0, sizeof *set);
    set->allocator = *allocator;
    set->threads = 1;
    set->skin_ratio = 0.1;
    set->overlap_limit = 0.2;
    set->group = 1;
    set->mask = UINT32_MAX;
    set->kernels = se3di_particle_kernels_portable();
}

void se3di_particles_destroy(se3di_particles *set)
{
    const se3d_allocator *a = &set->allocator;
    if (set->share) {
        set->share->forget(set);
    }
    se3di_particles_forget(set);
    se3di_text_free(a, set->name);
    se3di_free(a, set->stuffs, set->stuff_capacity, sizeof *set->stuffs);
    se3di_free(a, set->pairs, set->pair_capacity, sizeof *set->pairs);
    se3di_free(a, set->walls, set->wall_capacity, sizeof *set->walls);
    se3di_aligned_free(a, &set->particle_memory);
    se3di_aligned_free(a, &set->spin_memory);
    se3di_aligned_free(a, &set->load_memory);
    se3di_aligned_free(a, &set->block_memory);
    se3di_aligned_free(a, &set->roll_memory);
    se3di_free(a, set->origin, SE3DI_ORIGIN_SIZE * set->capacity, sizeof(double));
    se3di_free(a, set->order, set->capacity, sizeof *set->order);
    se3di_free(a, set->key, set->capacity, sizeof *set->key);
    se3di_free(a, set->index_of, set->index_capacity, sizeof *set->index_of);
    se3di_free(a, set->templates, set->template_capacity, sizeof *set->templates);
    se3di_free(a, set->balls, set->ball_capacity, sizeof *set->balls);
    se3di_free(a, set->clumps, set->clump_capacity, sizeof *set->clumps);
    se3di_free(a, set->clump_of, set->clump_of_capacity, sizeof *set->clump_of);
    se3di_free(a, set->cells, set->cell_capacity, sizeof *set->cells);
    se3di_free(a, set->first, set->first_capacity, sizeof *set->first);
    se3di_free(a, set->list, set->list_capacity, sizeof *set->list);
    se3di_free(a, set->near_walls, set->near_capacity, sizeof *set->near_walls);
    se3di_free(a, set->faces, set->face_capacity, sizeof *set->faces);
    se3di_free(a, set->carry_roll, set->carry_roll_capacity, sizeof(double));
    se3di_free(a, set->carry_next, set->carry_next_capacity, sizeof *set->carry_next);
    se3di_free(a, set->mesh_pairs, set->mesh_capacity, sizeof *set->mesh_pairs);
    se3di_free(a, set->mesh_old, set->mesh_old_capacity, sizeof *set->mesh_old);
    se3di_free(a, set->wall_sums, set->wall_sum_capacity, sizeof(double));
    for (size_t k = 0; k < set->source_count; ++k) {
        se3di_free(a, set->sources[k].table, 2 * set->sources[k].radii.count, sizeof(double));
    }
    se3di_free(a, set->sources, set->source_capacity, sizeof *set->sources);
    se3di_free(a, set->sinks, set->sink_capacity, sizeof *set->sinks);
    se3di_free(a, set->flows, set->flow_capacity, sizeof *set->flows);
    se3di_free(a, set->audit, set->audit_capacity, sizeof *set->audit);
    se3di_free(a, set->servos, set->servo_capacity, sizeof *set->servos);
    se3di_free(a, set->bonds, set->bond_capacity, sizeof *set->bonds);
    se3di_free(a, set->bond_ends, set->bond_end_capacity, sizeof *set->bond_ends);
    se3di_free(a, set->bond_groups, set->bond_group_capacity, sizeof *set->bond_groups);
    se3di_free(a, set->bond_places, set->bond_place_capacity, sizeof *set->bond_places);
    se3di_free(a, set->bond_end_of, set->bond_end_of_capacity, sizeof *set->bond_end_of);
    se3d_allocator allocator = set->allocator;
    memset(set, 0, sizeof *set);
    set->allocator = allocator;
}

static size_t block_bytes(const se3di_particles *set)
{
    return set->block_count * sizeof *set->blocks;
}

static size_t roll_bytes(const se3di_particles *set)
{
    return set->roll_memory.bytes > 0 ? set->block_count * sizeof *set->rolls : 0;
}

size_t se3di_particles_memory(const se3di_particles *set)
{
    return set->particle_memory.bytes + set->spin_memory.bytes + set->load_memory.bytes +
           set->block_memory.bytes + set->roll_memory.bytes +
           set->capacity * (SE3DI_ORIGIN_SIZE * sizeof(double) + 2 * sizeof(uint32_t)) +
           sizeof(uint32_t) * (set->index_capacity + set->cell_capacity + set->first_capacity +
                               set->list_capacity + set->face_capacity + set->carry_next_capacity) +
           set->near_capacity * sizeof *set->near_walls +
           sizeof(double) * (set->carry_roll_capacity + set->wall_sum_capacity) +
           (set->mesh_capacity + set->mesh_old_capacity) * sizeof *set->mesh_pairs +
           set->template_capacity * sizeof *set->templates +
           set->ball_capacity * sizeof *set->balls + set->clump_capacity * sizeof *set->clumps +
           set->clump_of_capacity * sizeof *set->clump_of +
           set->wall_capacity * sizeof *set->walls + set->source_capacity * sizeof *set->sources +
           set->sink_capacity * sizeof *set->sinks + set->flow_capacity * sizeof *set->flows +
           set->servo_capacity * sizeof *set->servos + set->audit_capacity * sizeof *set->audit +
           set->bond_capacity * sizeof *set->bonds +
           set->bond_end_capacity * sizeof *set->bond_ends +
           set->bond_group_capacity * sizeof *set->bond_groups +
           sizeof(uint32_t) * (set->bond_place_capacity + set->bond_end_of_capacity) +
           se3di_particles_kept_memory(set) + sizeof *set;
}

/* An array of exactly `count` elements of which `keep` stay in *to; on failure *to is NULL. */
static se3d_status resize(const se3d_allocator *a, void **to, const void *old, size_t keep,
                          size_t count, size_t size)
{
    *to = NULL;
    if (count == 0) {
        return SE3D_OK;
    }
    *to = se3di_alloc(a, count, size);
    if (!*to) {
        return SE3D_ERR_NO_MEMORY;
    }
    if (keep > 0) {
        memcpy(*to, old, keep * size);
    }
    return SE3D_OK;
}

static void set_dummy(se3di_particles *set)
{
    set->particles[set->capacity] = (se3di_particle){.inverse_mass = 1.0};
}

static se3d_status reserve_records(se3di_particles *set, size_t count)
{
    const se3d_allocator *a = &set->allocator;
    size_t n = set->count;
    se3d_status status = se3di_aligned_reserve(
        a, &set->particle_memory, (count + 1) * sizeof(se3di_particle), n * sizeof(se3di_particle));
    set->particles = set->particle_memory.data;
    SE3DI_TRY(status);
    status = se3di_aligned_reserve(a, &set->spin_memory, (count + 1) * sizeof(se3di_spin),
                                   n * sizeof(se3di_spin));
    set->spins = set->spin_memory.data;
    SE3DI_TRY(status);
    status = se3di_aligned_reserve(a, &set->load_memory, (count + 1) * sizeof(se3di_load),
                                   set->carry_count * sizeof *set->carry);
    set->loads = set->load_memory.data;
    set->carry = set->load_memory.data;
    return status;
}

static se3d_status reserve_arrays(se3di_particles *set, size_t count)
{
    const se3d_allocator *a = &set->allocator;
    void *origin = NULL;
    void *order = NULL;
    void *key = NULL;
    int failed = resize(a, &origin, NULL, 0, SE3DI_ORIGIN_SIZE * count, sizeof(double)) < 0 ||
                 resize(a, &order, NULL, 0, count, sizeof(uint32_t)) < 0 ||
                 resize(a, &key, NULL, 0, count, sizeof(uint32_t)) < 0 ||
                 reserve_records(set, count) < 0;
    if (failed) {
        se3di_free(a, origin, SE3DI_ORIGIN_SIZE * count, sizeof(double));
        se3di_free(a, order, count, sizeof(uint32_t));
        se3di_free(a, key, count, sizeof(uint32_t));
        return SE3D_ERR_NO_MEMORY;
    }
    se3di_free(a, set->origin, SE3DI_ORIGIN_SIZE * set->capacity, sizeof(double));
    se3di_free(a, set->order, set->capacity, sizeof(uint32_t));
    se3di_free(a, set->key, set->capacity, sizeof(uint32_t));
    set->origin = origin;
    set->order = order;
    set->key = key;
    set->capacity = count;
    memset(se3di_particles_wear(set), 0, count * sizeof(double)); /* motion reads it at once */
    set_dummy(set);
    return SE3D_OK;
}

/* For as many particles and the partner of unused lanes. */
static se3d_status reserve_audit(se3di_particles *set, size_t count)
{
    const size_t old = set->audit_capacity;
    if (!set->audits || count < old) {
        return SE3D_OK;
    }
    void *memory = set->audit;
    const se3d_status status = se3di_array_reserve(&set->allocator, &memory, &set->audit_capacity,
                                                   count + 1, sizeof *set->audit);
    set->audit = memory;
    SE3DI_TRY(status);
    memset(set->audit + old, 0, (set->audit_capacity - old) * sizeof *set->audit);
    return SE3D_OK;
}

se3d_status se3di_particles_reserve(se3di_particles *set, size_t count)
{
    if (count >= SE3DI_CARRY_WALL) {
        return SE3D_ERR_NO_MEMORY;
    }
    size_t fresh = count > set->count ? count - set->count : 0;
    size_t ids = set->id_count + fresh;
    if (ids > set->index_capacity) {
        void *index_of;
        SE3DI_TRY(resize(&set->allocator, &index_of, set->index_of, set->id_count, ids,
                         sizeof *set->index_of));
        se3di_free(&set->allocator, set->index_of, set->index_capacity, sizeof *set->index_of);
        set->index_of = index_of;
        set->index_capacity = ids;
    }
    SE3DI_TRY(se3di_clumps_reserve(set, ids, 0));
    SE3DI_TRY(reserve_audit(set, count > set->capacity ? count : set->capacity));
    SE3DI_TRY(se3di_particles_collect(set));
    SE3DI_TRY(se3di_particles_grow(set, &set->first, &set->first_capacity, count + 1));
    return count <= set->capacity ? SE3D_OK : reserve_arrays(set, count);
}

double se3di_particles_weigh(const se3di_particles *set, uint32_t material, double radius)
{
    const double pi = 3.1415926535897932384626433832795;
    return set->stuffs[material].material.density * (4.0 / 3.0 * pi * radius * radius * radius);
}

double se3di_particles_mass(const se3di_particles *set, size_t k)
{
    const se3di_particle *particle = &set->particles[k];
    return se3di_particle_is_fixed(particle)
               ? se3di_particles_weigh(set, set->spins[k].material, particle->radius)
               : 1.0 / particle->inverse_mass;
}

void se3di_particles_fix(se3di_particles *set, uint32_t id, int fixed)
{
    const size_t k = set->index_of[id];
    se3di_particle *particle = &set->particles[k];
    if (fixed) {
        particle->inverse_mass = 0.0;
        set->fixed = 1;
        set->uniform = 0;
    } else if (se3di_particle_is_fixed(particle)) {
        particle->inverse_mass = 1.0 / se3di_particles_mass(set, k);
    }
    set->force_valid = 0;
}

uint32_t se3di_particles_append(se3di_particles *set, uint32_t material, double radius,
                                const double x[3], const double v[3], const double w[3])
{
    static const double rest[3] = {0.0, 0.0, 0.0};
    const double mass = se3di_particles_weigh(set, material, radius);
    size_t k = set->count++;
    uint32_t id = (uint32_t)set->id_count++;
    set->particles[k] = (se3di_particle){.radius = radius, .inverse_mass = 1.0 / mass};
    memcpy(set->particles[k].x, x, sizeof set->particles[k].x);
    memcpy(set->particles[k].v, v ? v : rest, sizeof set->particles[k].v);
    set->spins[k] = (se3di_spin){.material = (uint16_t)material, .id = id};
    memcpy(set->spins[k].w, w ? w : rest, sizeof set->spins[k].w);
    set->index_of[id] = (uint32_t)k;
    const int first = id == 0 && !(se3di_share_is_spread(set) && set->share->ids > 0);
    for (int a = 0; a < 3; ++a) {
        set->home_low[a] = first ? x[a] : fmin(set->home_low[a], x[a]);
        set->home_high[a] = first ? x[a] : fmax(set->home_high[a], x[a]);
    }
    set->force_valid = 0;
    return id;
}

void se3di_particles_filter(se3di_particles *set, const unsigned char *keep)
{
    size_t to = 0;
    for (size_t k = 0; k < set->count; ++k) {
        if (!keep[k]) {
            set->index_of[set->spins[k].id] = SE3DI_NO_INDEX;
            set->order[k] = SE3DI_NO_INDEX;
            continue;
        }
        set->order[k] = (uint32_t)to;
        set->particles[to] = set->particles[k];
        set->spins[to] = set->spins[k];
        set->index_of[set->spins[to].id] = (uint32_t)to;
        ++to;
    }
    set->count = to;
    se3di_clumps_filter(set);
    se3di_bonds_filter(set);
    se3di_particles_remap(set, set->order);
    if (set->count == 0 && !se3di_share_is_spread(set)) {
        se3di_servos_rest(set);
        se3di_walls_rest(set);
    }
}

/* Copies of all arrays, so that the copy continues with the same bits. */
static se3d_status copy_arrays(const se3di_particles *from, se3di_particles *to)
{
    const struct {
        void *to;
        const void *from;
        size_t count, size;
    } parts[] = {
        {&to->origin, from->origin, SE3DI_ORIGIN_SIZE * from->capacity, sizeof(double)},
        {&to->order, from->order, from->capacity, sizeof(uint32_t)},
        {&to->key, from->key, from->capacity, sizeof(uint32_t)},
        {&to->index_of, from->index_of, from->index_capacity, sizeof(uint32_t)},
        {&to->templates, from->templates, from->template_capacity, sizeof(se3di_clump_template)},
        {&to->balls, from->balls, from->ball_capacity, sizeof(se3di_clump_ball)},
        {&to->clumps, from->clumps, from->clump_capacity, sizeof(se3di_clump)},
        {&to->clump_of, from->clump_of, from->clump_of_capacity, sizeof(uint32_t)},
        {&to->cells, from->cells, from->cell_capacity, sizeof(uint32_t)},
        {&to->first, from->first, from->first_capacity, sizeof(uint32_t)},
        {&to->list, from->list, from->list_capacity, sizeof(uint32_t)},
        {&to->near_walls, from->near_walls, from->near_capacity, sizeof(se3di_near_wall)},
        {&to->faces, from->faces, from->face_capacity, sizeof(uint32_t)},
        {&to->carry_next, from->carry_next, from->carry_next_capacity, sizeof(uint32_t)},
        {&to->carry_roll, from->carry_roll, from->carry_roll_capacity, sizeof(double)},
        {&to->wall_sums, from->wall_sums, from->wall_sum_capacity, sizeof(double)},
        {&to->stuffs, from->stuffs, from->stuff_capacity, sizeof(se3di_stuff)},
        {&to->mesh_pairs, from->mesh_pairs, from->mesh_capacity, sizeof(se3di_mesh_pair)},
        {&to->mesh_old, from->mesh_old, from->mesh_old_capacity, sizeof(se3di_mesh_pair)},
        {&to->pairs, from->pairs, from->pair_capacity, sizeof(se3di_pair)},
        {&to->walls, from->walls, from->wall_capacity, sizeof(se3di_wall)},
        {&to->sources, from->sources, from->source_capacity, sizeof(se3di_source)},
        {&to->sinks, from->sinks, from->sink_capacity, sizeof(se3di_sink)},
        {&to->flows, from->flows, from->flow_capacity, sizeof(se3di_flow)},
        {&to->audit, from->audit, from->audit_capacity, sizeof(se3di_audit_load)},
        {&to->servos, from->servos, from->servo_capacity, sizeof(se3di_servo)},
        {&to->bonds, from->bonds, from->bond_capacity, sizeof(se3di_bond)},
        {&to->bond_ends, from->bond_ends, from->bond_end_capacity, sizeof(se3di_bond_end)},
        {&to->bond_groups, from->bond_groups, from->bond_group_capacity, sizeof(se3di_bond_group)},
        {&to->bond_places, from->bond_places, from->bond_place_capacity, sizeof(uint32_t)},
        {&to->bond_end_of, from->bond_end_of, from->bond_end_of_capacity, sizeof(uint32_t)},
    };
    se3d_status status = SE3D_OK;
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; ++k) {
        void *memory;
        se3d_status here = resize(&from->allocator, &memory, parts[k].from, parts[k].count,
                                  parts[k].count, parts[k].size);
        memcpy(parts[k].to, &memory, sizeof memory); /* every pointer is written, NULL included */
        status = here < 0 ? here : status;
    }
    return status;
}

/* The tables of the sources, which are copies that still point to those of the others. */
static se3d_status copy_tables(se3di_particles *to)
{
    se3d_status status = SE3D_OK;
    for (size_t k = 0; to->sources && k < to->source_count; ++k) {
        se3di_source *source = &to->sources[k];
        size_t size = 2 * source->radii.count;
        void *memory;
        se3d_status here =
            resize(&to->allocator, &memory, source->table, size, size, sizeof(double));
        source->table = memory;
        source->radii.radii = memory;
        source->radii.weights = memory ? source->table + source->radii.count : NULL;
        source->radii.count = memory ? source->radii.count : 0;
        status = here < 0 ? here : status;
    }
    to->source_count = to->sources ? to->source_count : 0;
    return status;
}

static se3d_status copy_aligned(const se3di_particles *from, se3di_particles *to)
{
    const struct {
        const se3di_aligned *from;
        se3di_aligned *to;
        size_t used;
    } parts[] = {
        {&from->particle_memory, &to->particle_memory, from->count * sizeof *from->particles},
        {&from->spin_memory, &to->spin_memory, from->count * sizeof *from->spins},
        {&from->load_memory, &to->load_memory,
         from->list_valid ? from->count * sizeof *from->loads
                          : from->carry_count * sizeof *from->carry},
        {&from->block_memory, &to->block_memory, block_bytes(from)},
        {&from->roll_memory, &to->roll_memory, roll_bytes(from)},
    };
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; ++k) {
        SE3DI_TRY(se3di_aligned_reserve(&from->allocator, parts[k].to, parts[k].from->bytes, 0));
        if (parts[k].used > 0) {
            memcpy(parts[k].to->data, parts[k].from->data, parts[k].used);
        }
    }
    to->particles = to->particle_memory.data;
    to->spins = to->spin_memory.data;
    to->loads = to->load_memory.data;
    to->carry = to->load_memory.data;
    to->blocks = to->block_memory.data;
    to->rolls = to->roll_memory.data;
    if (to->particles) {
        set_dummy(to);
    }
    return SE3D_OK;
}

se3d_status se3di_particles_clone(const se3di_particles *set, se3di_particles *copy)
{
    const se3di_aligned none = {NULL, NULL, 0};
    *copy = *set;
    copy->next = NULL;
    copy->name = NULL;
    copy->kept = NULL;
    copy->share = NULL;
    copy->particle_memory = copy->spin_memory = copy->load_memory = none;
    copy->block_memory = copy->roll_memory = none;
    copy->particles = NULL;
    copy->spins = NULL;
    copy->loads = NULL;
    copy->carry = NULL;
    se3d_status status = copy_arrays(set, copy);
    se3d_status tables = copy_tables(copy);
    status = status < 0 ? status : tables;
    if (status == SE3D_OK) {
        status = copy_aligned(set, copy);
    }
    if (status < 0) {
        se3di_particles_destroy(copy);
    }
    return status;
}

void se3di_particles_replace(se3di_particles *set, const se3di_particles *other)
{
    struct se3di_particles *next = set->next;
    char *name = set->name;
    struct se3di_share *share = set->share;
    set->name = NULL;
    set->share = NULL;
    se3di_particles_destroy(set);
    *set = *other;
    set->next = next;
    set->name = name;
    set->share = share;
}

se3d_status se3di_particles_remove(se3di_particles *set, size_t count, const uint32_t *ids)
{
    const size_t size = set->count;
    unsigned char *keep = se3di_alloc(&set->allocator, size, 1);
    if (!keep || se3di_particles_collect(set) < 0) {
        se3di_free(&set->allocator, keep, size, 1);
        return SE3D_ERR_NO_MEMORY;
    }
    memset(keep, 1, size);
    for (size_t k = 0; k < count; ++k) {
        uint32_t id, end;
        for (se3di_clump_range(set, ids[k], &id, &end); id < end; ++id) {
            keep[set->index_of[id]] = 0;
        }
    }
    se3di_particles_filter(set, keep);
    se3di_free(&set->allocator, keep, size, 1);
    set->force_valid = 0;
    return SE3D_OK;
}
