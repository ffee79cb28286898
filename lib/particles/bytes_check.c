/* SPDX-License-Identifier: BSD-3-Clause */
/* Numbers of a set that was read: indices that name what is there, sizes that a particle can have,
 * and pairs that are of the slabs that they are evaluated with, so that no two threads write to one
 * particle. What no run would write, but does no harm, passes. */
#include "particles/bytes.h"

#include "particles/bond.h"
#include "particles/clump.h"
#include "particles/wall.h"

#include <math.h>

#define ROUNDING 1e-12 /* of a radius that is drawn */

static int are_finite(const double *values, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        if (!isfinite(values[k])) {
            return 0;
        }
    }
    return 1;
}

/* Its square is finite, and so is one over it. */
static int is_size(double x)
{
    return x > 1e-100 && x < 1e100;
}

static int is_mobility(const se3di_particles *set, double inverse_mass)
{
    return is_size(inverse_mass) || (inverse_mass == 0.0 && set->fixed && !set->uniform);
}

static int is_surface(const se3di_particles *set, uint32_t wall)
{
    return se3di_wall_is_mesh(&set->walls[wall]);
}

static int is_stuff(const se3di_particles *set, uint32_t material)
{
    return material < set->stuff_count && set->stuffs[material].held;
}

static int are_numbers(const se3di_particles *set)
{
    const double record[] = {set->time,    set->skin, set->gravity[0], set->gravity[1],
                             set->stretch, set->pace, set->gravity[2], set->drift};
    return are_finite(record, sizeof record / sizeof *record) && are_finite(set->low, 3) &&
           are_finite(set->high, 3) && are_finite(set->home_low, 3) &&
           are_finite(set->home_high, 3) && set->skin >= 0.0 && set->stretch >= 0.0 &&
           set->pace >= 0.0 && set->drift >= 0.0;
}

static int are_flows(const se3di_particles *set)
{
    int good = 1;
    for (size_t k = 0; k < set->flow_count; ++k) {
        const se3di_flow *flow = &set->flows[k];
        good = good && isfinite(flow->begun) && isfinite(flow->total.mass);
    }
    return good;
}

static int are_servos(const se3di_particles *set)
{
    int good = 1;
    for (size_t k = 0; k < set->servo_count; ++k) {
        const se3di_servo *s = &set->servos[k];
        const double numbers[] = {s->load, s->place, s->speed, s->work, s->half};
        good = good && are_finite(numbers, sizeof numbers / sizeof *numbers);
    }
    return good;
}

static int is_audit(const se3di_particles *set)
{
    int good = are_finite(set->audit_work, SE3DI_AUDIT_KINDS) && isfinite(set->wall_work) &&
               are_finite(set->audit_power, SE3DI_AUDIT_KINDS + 1);
    for (size_t k = 0; set->audits && set->list_valid && k < set->count; ++k) {
        const se3di_audit_load *a = &set->audit[k];
        good = good && are_finite(a->damping, 3) && are_finite(a->slide, 3) &&
               are_finite(a->turn, 3) && are_finite(a->roll, 3) && are_finite(a->twist, 3);
    }
    return good;
}

static int is_map(const se3di_domain_map *map)
{
    return are_finite(map->along, 3) && isfinite(map->shear);
}

static int is_cell(const se3di_particles *set)
{
    const se3di_domain *cell = &set->cell;
    const double numbers[] = {cell->offset, cell->shear, cell->strained, cell->work,
                              cell->touching};
    int good =
        cell->count == 0 || (are_finite(numbers, sizeof numbers / sizeof *numbers) &&
                             is_map(&cell->rates) && is_map(&cell->field) && is_map(&cell->since) &&
                             are_finite(cell->virial, 9) && are_finite(cell->kinetic, 6) &&
                             (cell->stage < cell->count || cell->stage == SE3D_CELL_STAGES));
    for (int a = 0; a < 3 && cell->count > 0; ++a) {
        good = good && isfinite(set->lower[a]) && isfinite(set->upper[a]) &&
               set->upper[a] > set->lower[a];
    }
    return good;
}

static int are_particles(const se3di_particles *set)
{
    size_t alive = 0;
    for (size_t k = 0; k < set->count; ++k) {
        const se3di_particle *p = &set->particles[k];
        const se3di_spin *spin = &set->spins[k];
        if (!are_finite(p->x, 3) || !are_finite(p->v, 3) || !are_finite(spin->w, 3) ||
            !is_size(p->radius) || !is_mobility(set, p->inverse_mass) ||
            !is_stuff(set, spin->material) || spin->id >= set->id_count ||
            set->index_of[spin->id] != k) {
            return 0;
        }
    }
    for (size_t id = 0; id < set->id_count; ++id) {
        alive += set->index_of[id] != SE3DI_NO_INDEX;
    }
    return alive == set->count; /* each by the one that has this number */
}

static int are_sources(const se3di_particles *set)
{
    for (size_t k = 0; k < set->source_count; ++k) {
        const se3di_source *s = &set->sources[k];
        const double numbers[] = {s->rate, s->owed, s->mass};
        const int drawn = s->next >= s->radii.smallest * (1.0 - ROUNDING) &&
                          s->next <= s->radii.largest * (1.0 + ROUNDING);
        if (!are_finite(numbers, 3) || isnan(s->due) || s->rate < 0.0 ||
            !(drawn || s->next == 0.0) || !is_stuff(set, s->material)) {
            return 0;
        }
    }
    return 1;
}

static int are_walls(const se3di_particles *set)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        const se3di_wall *w = &set->walls[k];
        const double sizes[] = {w->reach, w->near_reach, w->pace, w->inverse_mass};
        if (!are_finite(w->pose.x, 3) || !are_finite(w->pose.R, 9) || !are_finite(w->old_x, 3) ||
            !are_finite(w->old_R, 9) || !are_finite(w->near_x, 3) || !are_finite(w->near_R, 9) ||
            !are_finite(w->turn, 9) || !are_finite(sizes, 4) || !are_finite(w->home, 3) ||
            !are_finite(w->home_v, 3) || !are_finite(w->slide, 3)) {
            return 0;
        }
    }
    return 1;
}

/* Ranges of slabs follow each other from 0 to `count`. */
typedef struct range_end {
    uint32_t at;
    int follows;
} range_end;

static void follow(range_end *end, uint32_t from, uint32_t to)
{
    end->follows = end->follows && from == end->at && to >= from;
    end->at = to;
}

static int are_slabs(const se3di_particles *set)
{
    range_end particles = {0, 1}, blocks = {0, 1}, near = {0, 1}, meshes = {0, 1};
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        const se3di_slab *slab = &set->slabs[s];
        follow(&particles, slab->begin, slab->end);
        follow(&blocks, slab->pair_begin, slab->pair_end);
        follow(&blocks, slab->wall_begin, slab->wall_end);
        follow(&near, slab->near_begin, slab->near_end);
        follow(&meshes, slab->mesh_begin, slab->mesh_end);
    }
    return particles.follows && blocks.follows && near.follows && meshes.follows &&
           particles.at == set->count && blocks.at == set->block_count &&
           near.at == set->near_count && meshes.at == set->mesh_count;
}

static int is_in(const se3di_slab *slab, uint32_t i)
{
    return i >= slab->begin && i < slab->end;
}

/* A partner is of the same slab or of the next one; of the first one after the last only if slabs
 * that are next to each other are never both even. */
static int is_partner(const se3di_particles *set, uint32_t s, uint32_t j)
{
    const uint32_t next = s + 1 < set->slab_count ? s + 1 : 0;
    const int has_next = next > 0 || set->slab_count % 2 == 0;
    return is_in(&set->slabs[s], j) || (has_next && is_in(&set->slabs[next], j));
}

/* The neighbours of the particles of slab s. */
static int is_list(const se3di_particles *set, uint32_t s)
{
    for (uint32_t i = set->slabs[s].begin; i < set->slabs[s].end; ++i) {
        if (set->first[i] > set->first[i + 1] || set->first[i + 1] > set->list_count) {
            return 0;
        }
        for (uint32_t k = set->first[i]; k < set->first[i + 1]; ++k) {
            const uint32_t j = set->list[k] & ~SE3DI_LIST_ACTIVE;
            if (j == i || !is_partner(set, s, j)) {
                return 0;
            }
        }
    }
    return 1;
}

/* The triangles of a mesh; others have none. */
static int are_faces(const se3di_particles *set, uint32_t wall, uint32_t begin, uint32_t count)
{
    if (begin > set->face_count || count > set->face_count - begin) {
        return 0;
    }
    for (uint32_t k = begin; k < begin + count; ++k) {
        if (!is_surface(set, wall) || set->faces[k] >= set->walls[wall].shape.triangle_count) {
            return 0;
        }
    }
    return 1;
}

static int is_near_list(const se3di_particles *set, const se3di_slab *slab)
{
    for (uint32_t k = slab->near_begin; k < slab->near_end; ++k) {
        const se3di_near_wall *near = &set->near_walls[k];
        if (!is_in(slab, near->i & ~SE3DI_LIST_ACTIVE) || near->wall >= set->wall_count ||
            !are_faces(set, near->wall, near->face_begin, near->face_count)) {
            return 0;
        }
    }
    for (uint32_t k = slab->mesh_begin; k < slab->mesh_end; ++k) {
        const se3di_mesh_pair *pair = &set->mesh_pairs[k];
        if (!is_in(slab, pair->i) || pair->wall >= set->wall_count ||
            !is_surface(set, pair->wall) ||
            !are_faces(set, pair->wall, pair->face_begin, pair->face_count)) {
            return 0;
        }
    }
    return 1;
}

static int are_lanes(const se3di_particles *set, uint32_t s, uint32_t b)
{
    const uint32_t unused = (uint32_t)set->capacity;
    const se3di_particle_block *block = &set->blocks[b];
    const int wall = b >= set->slabs[s].wall_begin;
    if (wall && (block->j[0] >= set->wall_count || is_surface(set, block->j[0]))) {
        return 0;
    }
    for (int k = 0; k < SE3DI_PARTICLE_LANES; ++k) {
        const uint32_t i = block->i[k], j = block->j[k];
        const int empty = i == unused;
        const int alone = wall && k == 0 ? 1 : j == unused;
        if ((!empty && !is_in(&set->slabs[s], i)) || ((empty || wall) && !alone) ||
            (!empty && !wall && (i == j || !is_partner(set, s, j)))) {
            return 0;
        }
    }
    return 1;
}

static int are_blocks(const se3di_particles *set, uint32_t s)
{
    for (uint32_t b = set->slabs[s].pair_begin; b < set->slabs[s].wall_end; ++b) {
        if (!are_lanes(set, s, b)) {
            return 0;
        }
    }
    return set->block_count == 0 || !set->rolling || set->rolls;
}

static int are_lists(const se3di_particles *set)
{
    if (!are_slabs(set) || set->first[0] != 0 || set->first[set->count] != set->list_count) {
        return 0;
    }
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        if (!is_list(set, s) || !is_near_list(set, &set->slabs[s]) || !are_blocks(set, s)) {
            return 0;
        }
    }
    return are_finite(set->origin, 3 * set->count) &&
           are_finite(set->origin + 3 * set->capacity, set->count) &&
           are_finite(set->origin + 4 * set->capacity, set->count);
}

/* History that waits for lists. */
static int is_history(const se3di_particles *set)
{
    for (size_t k = 0; k < set->carry_count; ++k) {
        const se3di_carry *carry = &set->carry[k];
        const uint32_t wall = carry->j - SE3DI_CARRY_WALL;
        const int is_wall = carry->j >= SE3DI_CARRY_WALL;
        if (carry->i >= set->count ||
            (is_wall ? wall >= set->wall_count : carry->j >= set->count)) {
            return 0;
        }
    }
    for (size_t k = 0; k < set->mesh_old_count; ++k) {
        if (set->mesh_old[k].i >= set->count || set->mesh_old[k].wall >= set->wall_count) {
            return 0;
        }
    }
    return 1;
}

static int is_clump(const se3di_particles *set, const se3di_clump *clump)
{
    double square = 0.0;
    for (int k = 0; k < 4; ++k) {
        square += clump->q[k] * clump->q[k];
    }
    return are_finite(clump->x, 3) && are_finite(clump->v, 3) && are_finite(clump->spin, 3) &&
           fabs(square - 1.0) < 1e-6 && clump->scale > 0.0 && isfinite(clump->scale) &&
           clump->factor > 0.0 && isfinite(clump->factor) &&
           clump->template_index < set->template_count;
}

static int are_clumps(se3di_particles *set)
{
    for (size_t k = 0; k < set->clump_count; ++k) {
        if (!is_clump(set, &set->clumps[k])) {
            return 0;
        }
    }
    return se3di_clumps_index(set);
}

static int is_bond(const se3di_particles *set, const se3di_bond *bond)
{
    const double sizes[] = {bond->length, bond->radius, bond->energy, bond->dissipated};
    return are_finite(sizes, 4) && bond->length > 0.0 && bond->radius > 0.0 &&
           are_finite(bond->stiffness, 4) && are_finite(bond->damping, 4) &&
           are_finite(bond->axis[0], 6) && are_finite(bond->turn, 4) &&
           are_finite(bond->stress, 2) && are_finite(bond->force, 3) && are_finite(bond->drag, 3) &&
           are_finite(bond->torque[0], 6) && are_finite(bond->brake[0], 6) &&
           bond->group < set->bond_group_count && bond->end[0] < set->bond_end_count &&
           bond->end[1] < set->bond_end_count && bond->end[0] != bond->end[1] &&
           set->bond_ends[bond->end[0]].id != SE3DI_NO_INDEX;
}

static int are_bonds(se3di_particles *set)
{
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        const se3di_bond_end *end = &set->bond_ends[k];
        double square = 0.0;
        for (int a = 0; a < 4; ++a) {
            square += end->q[a] * end->q[a];
        }
        if (!are_finite(end->point, 3) || !(fabs(square - 1.0) < 1e-6)) {
            return 0;
        }
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        if (!is_bond(set, &set->bonds[k])) {
            return 0;
        }
    }
    return se3di_bonds_index(set);
}

int se3di_particles_are_sound(se3di_particles *set)
{
    return are_numbers(set) && are_particles(set) && are_clumps(set) && are_bonds(set) &&
           are_sources(set) && are_flows(set) && are_servos(set) && is_audit(set) && is_cell(set) &&
           are_walls(set) && (set->list_valid ? are_lists(set) : is_history(set));
}
