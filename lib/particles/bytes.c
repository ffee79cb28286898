/* SPDX-License-Identifier: BSD-3-Clause */
/* Order is part of the state: particles, lists and blocks are written as they lie in memory, so
 * that every sum has its order. Scratch is left out, and what follows from the model: coefficients
 * of pairs, shapes of walls. Materials and shapes are known by their slots, which are the same in
 * every program that makes the same model. */
#include "particles/bytes.h"

#include "particles/bond.h"
#include "particles/chain.h"
#include "particles/clump.h"
#include "particles/list.h"
#include "particles/memory.h"
#include "particles/sync.h"

#include "math/quaternion.h"

#include <string.h>

/* Lengths of the arrays. */
typedef struct lengths {
    size_t stuffs, walls, particles, ids, slabs;
    size_t list, near, faces, blocks, mesh, mesh_old, carry;
    size_t templates, clumps, bonds, bond_ends, bond_groups;
    int32_t has_rolls; /* beside the blocks */
} lengths;

static lengths measure(const se3di_particles *set)
{
    const int valid = set->list_valid;
    return (lengths){.stuffs = set->stuff_count,
                     .walls = set->wall_count,
                     .particles = set->count,
                     .ids = set->id_count,
                     .slabs = valid ? set->slab_count : 0,
                     .list = valid ? set->list_count : 0,
                     .near = valid ? set->near_count : 0,
                     .faces = valid ? set->face_count : 0,
                     .blocks = valid ? set->block_count : 0,
                     .mesh = valid ? set->mesh_count : 0,
                     .mesh_old = valid ? 0 : set->mesh_old_count,
                     .carry = valid ? 0 : set->carry_count,
                     .templates = set->template_count,
                     .clumps = set->clump_count,
                     .bonds = set->bond_count,
                     .bond_ends = set->bond_end_count,
                     .bond_groups = set->bond_group_count,
                     .has_rolls = valid && set->block_count > 0 && set->rolls};
}

static void code_lengths(se3di_coder *c, lengths *n)
{
    se3di_code_count(c, &n->stuffs, 1.0);
    se3di_code_count(c, &n->walls, 50.0);
    se3di_code_count(c, &n->particles, 13.0);
    se3di_code_count(c, &n->ids, 0.5);
    se3di_code_count(c, &n->slabs, 8.0);
    se3di_code_count(c, &n->list, 0.5);
    se3di_code_count(c, &n->near, 2.0);
    se3di_code_count(c, &n->faces, 0.5);
    se3di_code_count(c, &n->blocks, 32.0);
    se3di_code_count(c, &n->mesh, 5.0);
    se3di_code_count(c, &n->mesh_old, 5.0);
    se3di_code_count(c, &n->carry, 4.0);
    se3di_code_flag(c, &n->has_rolls);
    se3di_code_count(c, &n->templates, 0.0);
    se3di_code_count(c, &n->clumps, 17.0);
    se3di_code_count(c, &n->bonds, 50.0);
    se3di_code_count(c, &n->bond_ends, 8.0);
    se3di_code_count(c, &n->bond_groups, 6.0);
}

static void code_record(se3di_coder *c, se3di_particles *set)
{
    uint64_t *const words[] = {&set->steps_near, &set->steps, &set->rebuilds,
                               &set->refreshes,  &set->lost,  &set->touching};
    se3di_code_flag(c, &set->list_valid);
    se3di_code_flag(c, &set->force_valid);
    se3di_code_flag(c, &set->uniform);
    se3di_code_flag(c, &set->fixed);
    se3di_code_flag(c, &set->carry_rolling);
    se3di_code_numbers(c, &set->time, 1);
    se3di_code_numbers(c, set->gravity, 3);
    se3di_code_numbers(c, &set->skin, 1);
    se3di_code_numbers(c, &set->stretch, 1);
    se3di_code_numbers(c, set->low, 3);
    se3di_code_numbers(c, set->high, 3);
    se3di_code_numbers(c, &set->pace, 1);
    se3di_code_numbers(c, &set->drift, 1);
    se3di_code_numbers(c, &set->worn, 1);
    se3di_code_numbers(c, set->home_low, 3);
    se3di_code_numbers(c, set->home_high, 3);
    for (size_t k = 0; k < sizeof words / sizeof *words; ++k) {
        se3di_code_word(c, words[k]);
    }
    for (size_t k = 0; k < SE3D_PARTICLES_TAGS; ++k) {
        se3di_code_word(c, &set->lost_of[k]);
    }
}

/* What sources and sinks have done; what they are to do is told by their definitions. */
static void code_flow(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->source_count; ++k) {
        se3di_source *source = &set->sources[k];
        se3di_code_uint32(c, &source->material);
        se3di_code_flag(c, &source->stopped);
        se3di_code_flag(c, &source->waiting);
        se3di_code_numbers(c, &source->rate, 1);
        se3di_code_numbers(c, &source->owed, 1);
        se3di_code_numbers(c, &source->next, 1);
        se3di_code_numbers(c, &source->due, 1);
        se3di_code_numbers(c, &source->mass, 1);
        se3di_code_word(c, &source->seed);
        se3di_code_word(c, &source->inserted);
        se3di_code_word(c, &source->deferred);
    }
    for (size_t k = 0; k < set->sink_count; ++k) {
        se3di_code_flag(c, &set->sinks[k].stopped);
        se3di_code_word(c, &set->sinks[k].count);
    }
}

static void code_sum(se3di_coder *c, se3di_flow_sum *sum)
{
    se3di_code_word(c, &sum->forward);
    se3di_code_word(c, &sum->backward);
    se3di_code_numbers(c, &sum->mass, 1);
    se3di_code_numbers(c, sum->momentum, 3);
}

/* What has passed through the flows. */
static void code_passed(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->flow_count; ++k) {
        se3di_flow *flow = &set->flows[k];
        se3di_code_flag(c, &flow->has_rates);
        se3di_code_numbers(c, &flow->begun, 1);
        code_sum(c, &flow->before);
        code_sum(c, &flow->total);
        se3di_code_numbers(c, &flow->rates.count, 1);
        se3di_code_numbers(c, &flow->rates.mass, 1);
        se3di_code_numbers(c, flow->rates.momentum, 3);
    }
}

/* What contacts have taken of the energy. */
static void code_audit(se3di_coder *c, se3di_particles *set)
{
    if (set->audits) {
        se3di_code_numbers(c, set->audit_work, SE3DI_AUDIT_KINDS);
        se3di_code_numbers(c, &set->wall_work, 1);
        se3di_code_numbers(c, set->audit_power, SE3DI_AUDIT_KINDS + 1);
    }
}

/* What servo walls have done. */
static void code_servos(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->servo_count; ++k) {
        se3di_servo *servo = &set->servos[k];
        se3di_code_numbers(c, &servo->load, 1);
        se3di_code_numbers(c, &servo->place, 1);
        se3di_code_numbers(c, &servo->speed, 1);
        se3di_code_numbers(c, &servo->work, 1);
        se3di_code_numbers(c, &servo->half, 1);
    }
}

static void code_map(se3di_coder *c, se3di_domain_map *map)
{
    se3di_code_numbers(c, map->along, 3);
    se3di_code_numbers(c, &map->shear, 1);
}

/* What a cell has done. */
static void code_cell(se3di_coder *c, se3di_particles *set)
{
    se3di_domain *cell = &set->cell;
    if (cell->count == 0) {
        return;
    }
    se3di_code_numbers(c, set->lower, 3);
    se3di_code_numbers(c, set->upper, 3);
    se3di_code_word(c, &cell->stage);
    se3di_code_numbers(c, &cell->offset, 1);
    se3di_code_numbers(c, &cell->shear, 1);
    code_map(c, &cell->rates);
    code_map(c, &cell->field);
    code_map(c, &cell->since);
    se3di_code_numbers(c, &cell->strained, 1);
    se3di_code_numbers(c, cell->virial, 9);
    se3di_code_numbers(c, &cell->touching, 1);
    se3di_code_numbers(c, cell->kinetic, 6);
    se3di_code_numbers(c, &cell->work, 1);
}

static void code_wall(se3di_coder *c, se3di_wall *wall)
{
    se3di_code_uint32(c, &wall->handle.index1);
    se3di_code_numbers(c, wall->pose.x, 3);
    se3di_code_numbers(c, wall->pose.R, 9);
    se3di_code_numbers(c, wall->pose.v, 3);
    se3di_code_numbers(c, wall->pose.w, 3);
    se3di_code_numbers(c, wall->pose.c, 3);
    se3di_code_numbers(c, &wall->inverse_mass, 1);
    se3di_code_numbers(c, wall->turn, 9);
    se3di_code_numbers(c, wall->old_x, 3);
    se3di_code_numbers(c, wall->old_R, 9);
    se3di_code_numbers(c, wall->near_x, 3);
    se3di_code_numbers(c, wall->near_R, 9);
    se3di_code_numbers(c, &wall->reach, 1);
    se3di_code_numbers(c, &wall->near_reach, 1);
    se3di_code_numbers(c, &wall->pace, 1);
    se3di_code_numbers(c, wall->force, 3);
    se3di_code_numbers(c, wall->torque, 3);
    if (wall->servo > 0) {
        se3di_code_numbers(c, wall->home, 3);
        se3di_code_numbers(c, wall->home_v, 3);
        se3di_code_numbers(c, wall->slide, 3);
    }
}

static void code_particles(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->count; ++k) {
        se3di_particle *particle = &set->particles[k];
        se3di_spin *spin = &set->spins[k];
        uint32_t kind[3] = {spin->material, spin->tag, spin->id};
        se3di_code_numbers(c, particle->x, 3);
        se3di_code_numbers(c, &particle->radius, 1);
        se3di_code_numbers(c, particle->v, 3);
        se3di_code_numbers(c, &particle->inverse_mass, 1);
        se3di_code_numbers(c, spin->w, 3);
        se3di_code_indices(c, kind, 3);
        if (c->in) {
            c->failed |= kind[0] > UINT16_MAX || kind[1] >= SE3D_PARTICLES_TAGS;
            spin->material = (uint16_t)kind[0];
            spin->tag = (uint16_t)kind[1];
            spin->id = kind[2];
        }
    }
}

static void code_clumps(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->clump_count; ++k) {
        se3di_clump *clump = &set->clumps[k];
        uint32_t names[2] = {clump->first, clump->template_index};
        se3di_code_numbers(c, clump->x, 3);
        se3di_code_numbers(c, clump->q, 4);
        se3di_code_numbers(c, clump->v, 3);
        se3di_code_numbers(c, clump->spin, 3);
        se3di_code_numbers(c, &clump->scale, 1);
        se3di_code_numbers(c, &clump->factor, 1);
        se3di_code_uint32(c, &names[0]);
        se3di_code_uint32(c, &names[1]);
        if (c->in) {
            clump->first = names[0];
            clump->template_index = names[1];
            se3di_quat_to_matrix(clump->q, clump->A);
        }
    }
}

/* What became of groups of bonds; what they are like is told by their definitions. */
static void code_bond_groups(se3di_coder *c, se3di_particles *set)
{
    se3di_code_flag(c, &set->bonds_changed);
    for (size_t k = 0; k < set->bond_group_count; ++k) {
        se3di_bond_group *group = &set->bond_groups[k];
        se3di_code_word(c, &group->made);
        se3di_code_word(c, &group->torn);
        se3di_code_word(c, &group->sheared);
        se3di_code_word(c, &group->lost);
        se3di_code_numbers(c, &group->dissipated, 1);
        se3di_code_numbers(c, &group->released, 1);
    }
}

static void code_bond_ends(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        se3di_bond_end *end = &set->bond_ends[k];
        uint32_t names[2] = {end->id, end->wall};
        se3di_code_indices(c, names, 2);
        se3di_code_numbers(c, end->point, 3);
        se3di_code_numbers(c, end->q, 4);
        if (c->in) {
            const int wall = names[0] == SE3DI_NO_INDEX && names[1] < set->wall_count;
            end->id = names[0];
            end->wall = names[1];
            end->shape = wall ? set->walls[names[1]].handle : (se3di_handle){0, 0};
        }
    }
}

static void code_bonds(se3di_coder *c, se3di_particles *set)
{
    code_bond_ends(c, set);
    for (size_t k = 0; k < set->bond_count; ++k) {
        se3di_bond *bond = &set->bonds[k];
        se3di_code_indices(c, bond->end, 2);
        se3di_code_uint32(c, &bond->group);
        se3di_code_numbers(c, &bond->length, 1);
        se3di_code_numbers(c, &bond->radius, 1);
        se3di_code_numbers(c, bond->stiffness, 4);
        se3di_code_numbers(c, bond->damping, 4);
        se3di_code_numbers(c, bond->axis[0], 3);
        se3di_code_numbers(c, bond->axis[1], 3);
        se3di_code_numbers(c, bond->turn, 4);
        se3di_code_numbers(c, bond->place, 3);
        se3di_code_numbers(c, bond->force, 3);
        se3di_code_numbers(c, bond->drag, 3);
        for (int n = 0; n < 2; ++n) {
            se3di_code_numbers(c, bond->torque[n], 3);
            se3di_code_numbers(c, bond->brake[n], 3);
        }
        se3di_code_numbers(c, bond->stress, 2);
        se3di_code_numbers(c, &bond->energy, 1);
        se3di_code_numbers(c, &bond->dissipated, 1);
        bond->fate = SE3DI_BOND_HOLDS;
    }
}

/* Forces, and how far each may move. */
static void code_loads(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->count; ++k) {
        se3di_code_numbers(c, set->loads[k].force, 3);
        se3di_code_numbers(c, set->loads[k].torque, 3);
        se3di_code_numbers(c, set->origin + 3 * k, 3);
        se3di_code_numbers(c, se3di_particles_reach(set) + k, 1);
        se3di_code_numbers(c, se3di_particles_wear(set) + k, 1);
        if (set->audits) {
            se3di_code_numbers(c, set->audit[k].damping, 3);
            se3di_code_numbers(c, set->audit[k].slide, 3);
            se3di_code_numbers(c, set->audit[k].turn, 3);
            se3di_code_numbers(c, set->audit[k].roll, 3);
            se3di_code_numbers(c, set->audit[k].twist, 3);
        }
    }
}

static void code_slab(se3di_coder *c, se3di_slab *slab)
{
    uint32_t *const ends[] = {
        &slab->begin,    &slab->end,        &slab->pair_begin, &slab->pair_end,   &slab->wall_begin,
        &slab->wall_end, &slab->near_begin, &slab->near_end,   &slab->mesh_begin, &slab->mesh_end};
    for (size_t k = 0; k < sizeof ends / sizeof *ends; ++k) {
        se3di_code_uint32(c, ends[k]);
    }
}

/* Unused lanes name a place that depends on the memory, and so are written as none. */
static void code_lanes(se3di_coder *c, const se3di_particles *set, uint32_t *lanes, int wall)
{
    uint32_t names[SE3DI_PARTICLE_LANES];
    for (int k = 0; k < SE3DI_PARTICLE_LANES; ++k) {
        const int named = (wall && k == 0) || lanes[k] != set->capacity;
        names[k] = named ? lanes[k] : SE3DI_NO_INDEX;
    }
    se3di_code_indices(c, names, SE3DI_PARTICLE_LANES);
    for (int k = 0; c->in && k < SE3DI_PARTICLE_LANES; ++k) {
        lanes[k] = names[k] == SE3DI_NO_INDEX ? (uint32_t)set->capacity : names[k];
    }
}

static void code_blocks(se3di_coder *c, se3di_particles *set, const lengths *n)
{
    uint32_t s = 0;
    for (uint32_t b = 0; b < n->blocks; ++b) {
        while (s + 1 < n->slabs && b >= set->slabs[s].wall_end) {
            ++s;
        }
        se3di_particle_block *block = &set->blocks[b];
        code_lanes(c, set, block->i, 0);
        code_lanes(c, set, block->j, n->slabs > 0 && b >= set->slabs[s].wall_begin);
        for (int a = 0; a < 3; ++a) {
            se3di_code_numbers(c, block->xi[a], SE3DI_PARTICLE_LANES);
        }
        for (int a = 0; n->has_rolls && a < 4; ++a) {
            se3di_code_numbers(c, set->rolls[b].rho[a], SE3DI_PARTICLE_LANES);
        }
    }
}

static void code_mesh_pairs(se3di_coder *c, se3di_mesh_pair *pairs, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        se3di_mesh_pair *pair = &pairs[k];
        se3di_code_uint32(c, &pair->i);
        se3di_code_uint32(c, &pair->wall);
        se3di_code_uint32(c, &pair->count);
        se3di_code_uint32(c, &pair->face_begin);
        se3di_code_uint32(c, &pair->face_count);
        if (pair->count > SE3DI_PARTICLE_FACES) {
            c->failed = 1;
            pair->count = 0;
        }
        for (uint32_t t = 0; t < pair->count; ++t) {
            se3di_code_numbers(c, pair->touches[t].normal, 3);
            se3di_code_numbers(c, pair->touches[t].xi, 3);
            se3di_code_numbers(c, pair->touches[t].rho, 4);
        }
    }
}

static void code_carry(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->carry_count; ++k) {
        se3di_code_uint32(c, &set->carry[k].i);
        se3di_code_uint32(c, &set->carry[k].j);
        se3di_code_numbers(c, set->carry[k].xi, 3);
        if (set->carry_rolling) {
            se3di_code_numbers(c, set->carry_roll + 4 * k, 4);
        }
    }
}

static void code_lists(se3di_coder *c, se3di_particles *set, const lengths *n)
{
    for (size_t k = 0; k < n->slabs; ++k) {
        code_slab(c, &set->slabs[k]);
    }
    uint32_t none = 0; /* before the first particle comes there is no memory for it */
    se3di_code_indices(c, set->count > 0 ? set->first : &none, set->count + 1);
    se3di_code_indices(c, set->list, n->list);
    for (size_t k = 0; k < n->near; ++k) {
        uint32_t row[4] = {set->near_walls[k].i, set->near_walls[k].wall,
                           set->near_walls[k].face_begin, set->near_walls[k].face_count};
        se3di_code_indices(c, row, 4);
        if (c->in) {
            set->near_walls[k] = (se3di_near_wall){row[0], row[1], row[2], row[3]};
        }
    }
    se3di_code_indices(c, set->faces, n->faces);
    code_loads(c, set);
    code_blocks(c, set, n);
    code_mesh_pairs(c, set->mesh_pairs, n->mesh);
}

/* All that lies in arrays. */
static void code_arrays(se3di_coder *c, se3di_particles *set, const lengths *n)
{
    code_particles(c, set);
    code_clumps(c, set);
    code_bonds(c, set);
    se3di_code_indices(c, set->index_of, n->ids);
    if (set->list_valid) {
        code_lists(c, set, n);
    } else {
        code_carry(c, set);
        code_mesh_pairs(c, set->mesh_old, n->mesh_old);
    }
}

static void code_stuffs(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->stuff_count; ++k) {
        se3di_code_uint32(c, &set->stuffs[k].handle.index1);
        se3di_code_flag(c, &set->stuffs[k].held);
    }
}

static void write_set(se3di_coder *c, const se3di_particles *set)
{
    se3di_particles same = *set; /* the arrays are only looked at */
    lengths n = measure(set);
    code_lengths(c, &n);
    code_stuffs(c, &same);
    code_record(c, &same);
    code_flow(c, &same);
    code_passed(c, &same);
    code_servos(c, &same);
    code_audit(c, &same);
    code_cell(c, &same);
    code_bond_groups(c, &same);
    for (size_t k = 0; k < n.walls; ++k) {
        code_wall(c, &same.walls[k]);
    }
    code_arrays(c, &same, &n);
}

void se3di_sets_write(se3di_coder *c, const se3di_particles *sets)
{
    for (const se3di_particles *set = sets; set; set = set->next) {
        write_set(c, set);
    }
}

/* ---- reading ---- */

static se3d_status reserve(const se3di_particles *set, void **data, size_t *capacity, size_t count,
                           size_t size)
{
    return se3di_array_reserve(&set->allocator, data, capacity, count, size);
}

/* A set that was just made: its settings, sources and sinks stay. */
static void empty(se3di_particles *set)
{
    set->count = set->id_count = set->list_count = set->near_count = set->face_count = 0;
    set->mesh_count = set->mesh_old_count = set->carry_count = set->stuff_count = 0;
    set->wall_count = set->clump_count = 0;
    set->bond_count = set->bond_end_count = 0;
    set->block_count = set->slab_count = 0;
    set->list_valid = set->force_valid = set->carry_rolling = 0;
    set->single = 0;
    set->topology_version = 0;
}

/* The materials of the particles; those of the walls get their places as they did before. */
static se3d_status read_stuffs(se3di_coder *c, const se3di_model *model, se3di_particles *set,
                               size_t count)
{
    const se3di_slots *slots = &model->material_slots;
    void *memory = set->stuffs;
    if (count > slots->slot_count) { /* each has one of its own */
        return SE3D_ERR_STATE;
    }
    const se3d_status status =
        reserve(set, &memory, &set->stuff_capacity, count, sizeof *set->stuffs);
    set->stuffs = memory;
    SE3DI_TRY(status);
    set->stuff_count = count;
    code_stuffs(c, set);
    for (size_t k = 0; k < count; ++k) {
        se3di_stuff *stuff = &set->stuffs[k];
        const uint32_t slot = stuff->handle.index1 - 1;
        const uint32_t dense = slot < slots->slot_count ? slots->slots[slot].dense : SE3DI_NO_INDEX;
        if (dense == SE3DI_NO_INDEX && (stuff->held || stuff->handle.index1 != 0)) {
            return SE3D_ERR_STATE;
        }
        stuff->handle =
            dense == SE3DI_NO_INDEX ? (se3di_handle){0, 0} : se3di_slots_handle(slots, dense);
    }
    return SE3D_OK;
}

static se3d_status read_walls(se3di_coder *c, se3di_particles *set)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        const se3di_handle handle = set->walls[k].handle;
        code_wall(c, &set->walls[k]);
        const int same = set->walls[k].handle.index1 == handle.index1;
        set->walls[k].handle = handle;
        if (!same) {
            return SE3D_ERR_STATE;
        }
    }
    return SE3D_OK;
}

static se3d_status reserve_mesh(const se3di_particles *set, se3di_mesh_pair **pairs,
                                size_t *capacity, size_t count)
{
    void *memory = *pairs;
    const se3d_status status = reserve(set, &memory, capacity, count, sizeof **pairs);
    *pairs = memory;
    return status;
}

static se3d_status reserve_lists(se3di_particles *set, const lengths *n)
{
    void *near = set->near_walls;
    const se3d_status status =
        reserve(set, &near, &set->near_capacity, n->near, sizeof *set->near_walls);
    set->near_walls = near;
    SE3DI_TRY(status);
    SE3DI_TRY(se3di_particles_grow(set, &set->list, &set->list_capacity, n->list));
    SE3DI_TRY(se3di_particles_grow(set, &set->faces, &set->face_capacity, n->faces));
    SE3DI_TRY(reserve_mesh(set, &set->mesh_pairs, &set->mesh_capacity, n->mesh));
    return reserve_mesh(set, &set->mesh_old, &set->mesh_old_capacity,
                        n->mesh > n->mesh_old ? n->mesh : n->mesh_old);
}

/* Lanes that nobody uses, and rolls that were not written, hold nothing. */
static se3d_status reserve_blocks(se3di_particles *set, const lengths *n)
{
    const size_t rolls = n->has_rolls || set->rolls ? n->blocks * sizeof *set->rolls : 0;
    const size_t blocks = n->blocks * sizeof *set->blocks;
    SE3DI_TRY(se3di_aligned_reserve(&set->allocator, &set->roll_memory, rolls, 0));
    set->rolls = set->roll_memory.data;
    SE3DI_TRY(se3di_aligned_reserve(&set->allocator, &set->block_memory, blocks, 0));
    set->blocks = set->block_memory.data;
    if (rolls > 0) {
        memset(set->rolls, 0, rolls);
    }
    if (n->particles > 0) {
        memset(set->load_memory.data, 0, set->load_memory.bytes);
    }
    return SE3D_OK;
}

/* Room for what is to come, whose lengths the set has then. */
static se3d_status make_room(se3di_particles *set, const lengths *n)
{
    SE3DI_TRY(se3di_particles_reserve(set, n->particles));
    SE3DI_TRY(se3di_particles_grow(set, &set->index_of, &set->index_capacity, n->ids));
    SE3DI_TRY(se3di_clumps_reserve(set, n->ids, n->clumps));
    SE3DI_TRY(reserve_lists(set, n));
    SE3DI_TRY(reserve_blocks(set, n));
    SE3DI_TRY(se3di_particles_reserve_carry(set, n->carry, set->carry_rolling));
    set->count = n->particles;
    set->id_count = n->ids;
    set->slab_count = (uint32_t)n->slabs;
    set->list_count = n->list;
    set->near_count = n->near;
    set->face_count = n->faces;
    set->block_count = (uint32_t)n->blocks;
    set->mesh_count = n->mesh;
    set->mesh_old_count = n->mesh_old;
    set->carry_count = n->carry;
    set->clump_count = n->clumps;
    SE3DI_TRY(se3di_bonds_reserve(set, n->bonds > n->bond_ends ? n->bonds : n->bond_ends));
    set->bond_count = n->bonds;
    set->bond_end_count = n->bond_ends;
    return SE3D_OK;
}

/* Lengths that go together. */
static int fit(const se3di_particles *set, const lengths *n)
{
    const int here = set->list_valid;
    return n->slabs <= SE3DI_PARTICLE_SLABS_MAX && n->particles <= n->ids &&
           n->clumps <= n->particles && (n->clumps == 0 || n->templates > 0) &&
           n->bonds < UINT32_MAX / 4 && n->bond_ends < UINT32_MAX / 4 &&
           n->ids < SE3DI_CARRY_WALL && n->list < UINT32_MAX && n->blocks < UINT32_MAX &&
           (here ? n->mesh_old + n->carry == 0
                 : n->slabs + n->list + n->near + n->faces + n->blocks + n->mesh == 0);
}

static se3d_status read_set(se3di_coder *c, const se3di_model *model, se3di_particles *set)
{
    lengths n = {0};
    empty(set);
    code_lengths(c, &n);
    SE3DI_TRY(read_stuffs(c, model, set, n.stuffs));
    SE3DI_TRY(se3di_particles_sync(set, model));
    if (set->wall_count != n.walls || set->template_count != n.templates ||
        set->bond_group_count != n.bond_groups) {
        return SE3D_ERR_STATE;
    }
    code_record(c, set);
    code_flow(c, set);
    code_passed(c, set);
    code_servos(c, set);
    code_audit(c, set);
    code_cell(c, set);
    code_bond_groups(c, set);
    SE3DI_TRY(read_walls(c, set));
    if (c->failed || !fit(set, &n)) {
        return SE3D_ERR_INVALID_ARGUMENT;
    }
    const int32_t valid = set->list_valid;
    set->list_valid = 0; /* there is nothing to collect yet */
    SE3DI_TRY(make_room(set, &n));
    set->list_valid = valid;
    code_arrays(c, set, &n);
    return !c->failed && se3di_particles_are_sound(set) ? SE3D_OK : SE3D_ERR_INVALID_ARGUMENT;
}

se3d_status se3di_sets_read(se3di_coder *c, const se3di_model *model, se3di_particles **sets)
{
    SE3DI_TRY(se3di_sets_save(model->sets, &model->allocator, sets));
    se3d_status status = SE3D_OK;
    for (se3di_particles *set = *sets; set && status >= 0; set = set->next) {
        status = read_set(c, model, set);
    }
    if (status < 0) {
        se3di_sets_forget(*sets, &model->allocator);
        *sets = NULL;
    }
    return status == SE3D_ERR_STATE && c->failed ? SE3D_ERR_INVALID_ARGUMENT : status;
}
