/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps of particles: lists that hold what touches, forces, velocity Verlet, and what may fail.
 *                                                                      docs/theory/particles.md */

#include "particles/step.h"

#include "base/hash.h"
#include "contact/bodies/encounter.h"
#include "math/larger.h"
#include "math/vec3.h"
#include "particles/bond.h"
#include "particles/cell.h"
#include "particles/flow.h"
#include "particles/grid.h"
#include "particles/list.h"
#include "particles/passage.h"
#include "particles/piece.h"
#include "particles/reach.h"
#include "particles/servo.h"
#include "particles/share.h"
#include "particles/sweep.h"
#include "particles/sync.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

/* A force at the end of a free rod moves that as if its mass were a quarter. */
#define BODY_END 4.0

void se3di_particles_move_walls(se3di_particles *set, const se3di_frame *frames)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        se3di_wall_place(set, wall, &frames[wall->shape.body]);
    }
}

void se3di_particles_free_walls(se3di_particles *set, const se3di_model *model)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        wall->inverse_mass = 0.0;
        if (model && wall->loose) {
            const se3di_body *body = &model->bodies[wall->shape.body];
            const se3di_frame *frame = &model->frames[wall->shape.body];
            wall->inverse_mass = 1.0 / body->mass;
            for (int a = 0; a < 3; ++a) { /* symmetric: rows are columns */
                const double axis[3] = {a == 0, a == 1, a == 2};
                se3di_encounter_turn_by(body, frame, axis, wall->turn + 3 * a);
            }
        }
    }
}

/* Lists that hold every pair that touches. */
static se3d_status update_lists(se3di_particles *set)
{
    const int same = set->list_valid && !set->bonds_changed;
    const int blocks_hold = same && se3di_particles_blocks_hold(set);
    const int list_holds = same && (blocks_hold || se3di_particles_list_holds(set));
    if (list_holds && se3di_share_is_spread(set)) {
        set->share->renew(set);
    }
    if (blocks_hold) {
        return SE3D_OK;
    }
    return list_holds ? se3di_particles_refresh(set) : se3di_particles_rebuild(set);
}

/* Of particle i with particle j, or with a wall. */
static void note_overlap(se3di_particles *set, uint32_t i, uint32_t j, uint32_t wall, double amount)
{
    if (amount > set->failed_amount) {
        set->failed_amount = amount;
        set->failed = se3di_share_number(set, i);
        set->failed_wall = wall;
        set->failed_with = wall == SE3DI_NO_INDEX ? se3di_share_number(set, j) : 0;
    }
}

/* The place where it was a drift of length `back` ago. */
static void place_before(const se3di_particle *g, double back, double x[3])
{
    se3di_copy(g->x, x);
    se3di_add_scaled(-back, g->v, x);
}

static double pair_overlap(const se3di_particles *set, const se3di_particle *i,
                           const se3di_particle *j, double back)
{
    double d[3], at[3];
    place_before(i, back, d);
    place_before(j, back, at);
    se3di_sub(d, at, d);
    se3di_particles_wrap(set, d);
    return (i->radius + j->radius - se3di_norm(d)) / fmin(i->radius, j->radius);
}

static double wall_overlap(const se3di_particles *set, uint32_t wall, const se3di_particle *i,
                           double back)
{
    double at[3], x[3];
    place_before(i, back, x);
    se3di_particles_image(set, &set->walls[wall], x, i->radius, at);
    return 1.0 - se3di_wall_distance(&set->walls[wall], at) / i->radius;
}

/* Which particle overlapped most when the last forces were evaluated, a drift of length `back` ago:
 * for the message of a failure. */
static void find_overlap(se3di_particles *set, double back, int placed)
{
    set->failed_placed = placed;
    set->failed_amount = -1.0;
    set->failed_time = set->time;
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        const se3di_slab *slab = &set->slabs[s];
        for (uint32_t b = slab->pair_begin; b < slab->wall_end; ++b) {
            const se3di_particle_block *block = &set->blocks[b];
            for (int k = 0; k < SE3DI_PARTICLE_LANES && block->i[k] < set->count; ++k) {
                const se3di_particle *i = &set->particles[block->i[k]];
                if (b >= slab->wall_begin) {
                    note_overlap(set, block->i[k], 0, block->j[0],
                                 wall_overlap(set, block->j[0], i, back));
                } else {
                    note_overlap(set, block->i[k], block->j[k], SE3DI_NO_INDEX,
                                 pair_overlap(set, i, &set->particles[block->j[k]], back));
                }
            }
        }
        for (uint32_t k = slab->mesh_begin; k < slab->mesh_end; ++k) {
            const se3di_mesh_pair *pair = &set->mesh_pairs[k];
            note_overlap(set, pair->i, 0, pair->wall,
                         wall_overlap(set, pair->wall, &set->particles[pair->i], back));
        }
    }
}

static se3d_status find_not_finite(se3di_particles *set)
{
    for (size_t k = 0; k < set->count; ++k) {
        const se3di_particle *g = &set->particles[k];
        double sum = g->x[0] + g->x[1] + g->x[2] + g->v[0] + g->v[1] + g->v[2];
        if (!isfinite(sum)) {
            set->failed = se3di_share_number(set, k);
            set->failed_amount = 0.0;
            return SE3D_ERR_NOT_FINITE;
        }
    }
    return SE3D_OK;
}

int se3di_particles_is_idle(const se3di_particles *set)
{
    return se3di_share_total(set) == 0 && set->source_count == 0;
}

int se3di_particles_is_complete(const se3di_particles *set, se3d_status status)
{
    return status == SE3D_ERR_STEP_SIZE || status == SE3D_ERR_CALLBACK ||
           (status == SE3D_ERR_NO_MEMORY && set->force_valid);
}

/* The parts are added up slab by slab and over all processes, and rounded at last. */
static void sum_exactly(se3di_particles *set)
{
    const size_t size = 6 * SE3DI_EXACT_PARTS * set->wall_count;
    double *sums = set->share->sums;
    for (size_t s = 1; s < set->slab_count; ++s) {
        for (size_t k = 0; k < size; ++k) {
            sums[k] += sums[size * s + k];
        }
    }
    set->share->add(set, size, sums);
    for (size_t w = 0; w < set->wall_count; ++w) {
        se3di_wall *wall = &set->walls[w];
        for (size_t a = 0; a < 6; ++a) {
            const double *part = sums + SE3DI_EXACT_PARTS * (6 * w + a);
            *(a < 3 ? &wall->force[a] : &wall->torque[a - 3]) = part[0] + (part[1] + part[2]);
        }
    }
}

static void sum_walls(se3di_particles *set)
{
    size_t walls = set->wall_count;
    if (se3di_share_is_spread(set)) {
        se3di_bonds_push_walls(set);
        sum_exactly(set);
        return;
    }
    for (size_t w = 0; w < walls; ++w) {
        double sum[6] = {0.0};
        for (size_t s = 0; s < set->slab_count; ++s) {
            for (int a = 0; a < 6; ++a) {
                sum[a] += set->wall_sums[6 * (walls * s + w) + (size_t)a];
            }
        }
        memcpy(set->walls[w].force, sum, 3 * sizeof(double));
        memcpy(set->walls[w].torque, sum + 3, 3 * sizeof(double));
    }
    se3di_bonds_push_walls(set);
}

/* In any process. */
static int has_clumps(const se3di_particles *set)
{
    return set->clump_count > 0 || (se3di_share_is_spread(set) && set->template_count > 0);
}

/* Of all particles, if they have one and it is known. */
static uint32_t material_of_all(const se3di_particles *set)
{
    if (set->stuff_count == 1) {
        return 0;
    }
    if (set->uniform && set->count > 0) {
        return set->spins[0].material;
    }
    return set->single > 0 ? set->single - 1 : SE3DI_NO_INDEX;
}

static se3di_force_task prepare(se3di_particles *set, double h, const se3di_strain *strain)
{
    se3di_force_task task = {
        .particles = set->particles,
        .spins = set->spins,
        .loads = set->loads,
        .blocks = set->blocks,
        .rolls = set->rolling ? set->rolls : NULL,
        .pairs = set->pairs,
        .walls = set->walls,
        .materials = (uint32_t)set->stuff_count,
        .material = material_of_all(set),
        .law = (int32_t)set->law,
        .uniform = set->uniform,
        .cohesive = set->cohesive,
        .rated = set->rated,
        .h = h,
        .limit = set->overlap_limit,
        .unused = (uint32_t)set->capacity,
        .stuffs = set->stuffs,
        .callback = set->callback,
        .ctx = set->ctx,
        .clumped = has_clumps(set) ? set : NULL,
        .strain = se3di_domain_strains(set) ? strain : NULL,
    };
    if (set->audits) {
        memset(set->audit, 0, (set->capacity + 1) * sizeof *set->audit);
        task.audit = set->audit;
    }
    if (se3di_share_is_spread(set)) {
        task.in_turn = 1;
        task.exact = set->share->sums;
        task.exact_steps = set->share->steps;
        task.exact_power = set->audits ? set->share->powers[0] : NULL;
    }
    for (int a = 0; a < 3; ++a) {
        if (set->boundary[a] == SE3DI_BOUNDARY_PERIODIC) {
            task.periodic = 1;
            task.length[a] = set->upper[a] - set->lower[a];
            task.rate[a] = 1.0 / task.length[a];
        }
    }
    return task;
}

/* Forces with lists that hold everything, and then the motion; without its drift if memory is
 * missing. STEP_SIZE: an overlap is too large, but all is done. */
static se3d_status evaluate(se3di_particles *set, double h, se3di_particle_motion *motion)
{
    if (!isfinite(set->worn)) {
        SE3DI_TRY(se3di_share_agree(set, find_not_finite(set)));
    }
    set->starved = 0;
    if (h > 0.0 && set->source_count > 0 && se3di_sources_feed(set, h) < 0) {
        set->starved = 1; /* what could not be inserted waits */
    }
    const se3d_status listed = update_lists(set);
    if (se3di_share_is_spread(set) && (listed == SE3D_ERR_NO_MEMORY || set->starved)) {
        set->share->give_up(set, "memory is missing");
    }
    SE3DI_TRY(listed);
    if (set->starved && motion->drift != 0.0) {
        *motion = (se3di_particle_motion){1, h, 0.0};
    }
    set->touching = 0;
    set->law_failure = (se3di_law_failure){0, 0, 0, 0};
    set->force_valid = 1;
    if (se3di_share_total(set) == 0) {
        se3di_servos_rest(set);
        se3di_walls_rest(set);
        return set->starved ? SE3D_ERR_NO_MEMORY : SE3D_OK;
    }
    const se3di_strain strain = se3di_domain_images(set);
    se3di_force_task task = prepare(set, h, &strain);
    se3di_particles_sweep(set, &task, motion);
    sum_walls(set);
    se3di_bonds_finish(set);
    if (motion->drift != 0.0) {
        se3di_servos_drift(set, motion->drift);
    }
    double most[2] = {0.0, set->bonds_changed}; /* the largest excess, and whether a bond broke */
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        most[0] = se3di_larger(most[0], set->slabs[s].overlap);
        set->touching += set->slabs[s].touching;
        if (set->slabs[s].failure.happened && !set->law_failure.happened) {
            set->law_failure = set->slabs[s].failure;
        }
    }
    se3di_share_largest(set, 2, most);
    set->bonds_changed = most[1] > 0.0;
    if (set->law_failure.happened) {
        return SE3D_ERR_CALLBACK;
    }
    if (most[0] > 0.0) {
        return SE3D_ERR_STEP_SIZE;
    }
    return set->starved ? SE3D_ERR_NO_MEMORY : SE3D_OK;
}

se3d_status se3di_particles_forces(se3di_particles *set, double h)
{
    se3di_particle_motion none = {0, 0.0, 0.0};
    se3d_status status = evaluate(set, h, &none);
    if (status == SE3D_ERR_STEP_SIZE) {
        find_overlap(set, 0.0, !(h > 0.0));
        status = se3di_share_agree(set, status);
    }
    return status;
}

/* Over the pairs of a material with all that are in use. */
static double pair_steps(const se3di_model *model, size_t a, double radius, double mass,
                         double reduced_mass)
{
    double step = HUGE_VAL;
    size_t n = model->material_slots.count;
    for (size_t b = 0; b < n; ++b) {
        if (model->materials[b].users > 0) {
            step =
                fmin(step, se3di_pair_step(&model->materials[a], &model->overrides[a * n + b],
                                           &model->pairs[a * n + b], radius, mass, reduced_mass));
        }
    }
    return step;
}

static int are_fixed(const se3di_particles *set)
{
    size_t k = 0;
    while (k < set->count && se3di_particle_is_fixed(&set->particles[k])) {
        ++k;
    }
    return k == set->count;
}

double se3di_particles_safe_step(const se3di_particles *set, const se3di_model *model)
{
    const double body = se3di_particles_lightest_body(set, model);
    const int all = set->source_count == 0 && are_fixed(set);
    double step = HUGE_VAL;
    for (size_t s = 0; s < set->stuff_count; ++s) {
        double lightest = HUGE_VAL;
        double smallest = HUGE_VAL;
        const se3di_stuff *stuff = &set->stuffs[s];
        for (size_t k = 0; stuff->held && k < set->count; ++k) {
            if (set->spins[k].material == s &&
                (all || !se3di_particle_is_fixed(&set->particles[k]))) {
                lightest = fmin(lightest, se3di_particles_mass(set, k));
                smallest = fmin(smallest, set->particles[k].radius);
            }
        }
        for (size_t k = 0; stuff->held && k < set->source_count; ++k) {
            if (set->sources[k].material == s && !set->sources[k].stopped) {
                const se3di_piece least = {.clump = set->sources[k].clump,
                                           .material = set->sources[k].material,
                                           .radius = set->sources[k].radii.smallest};
                smallest = fmin(smallest, se3di_piece_smallest(set, &least));
                lightest = fmin(lightest, se3di_piece_lightest(set, &least));
            }
        }
        if (smallest < HUGE_VAL) {
            uint32_t a = se3di_slots_find(&model->material_slots, stuff->handle.index1,
                                          stuff->handle.generation);
            /* the other one may be as light: half of the mass; or a lighter body, hit at its end */
            double reduced = BODY_END * lightest > body ? 1.0 / (1.0 / lightest + BODY_END / body)
                                                        : 0.5 * lightest;
            step = fmin(step, pair_steps(model, a, smallest, lightest, reduced));
        }
    }
    return step;
}

se3d_status se3di_particles_prepare(se3di_particles *set)
{
    if (set->force_valid) {
        return SE3D_OK;
    }
    if (set->list_valid) {
        memset(set->load_memory.data, 0, set->count * sizeof(se3di_load));
    }
    return se3di_particles_forces(set, 0.0);
}

se3d_status se3di_particles_advance(se3di_particles *set, double h, size_t steps,
                                    const se3di_frame *frames)
{
    if (frames) {
        se3di_particles_move_walls(set, frames);
    }
    SE3DI_TRY(se3di_particles_prepare(set));
    if (steps > 0) {
        se3di_particles_move(set, 1, h);
    }
    se3d_status failure = SE3D_OK;
    while (steps > 0) {
        --steps;
        set->time += h;
        ++set->steps;
        se3di_flows_tick(set);
        int on = steps > 0 && failure == SE3D_OK;
        se3di_particle_motion motion = {on ? 2 : 1, h, on ? h : 0.0};
        se3d_status status = evaluate(set, h, &motion);
        if (status < 0 && !se3di_particles_is_complete(set, status)) {
            return status;
        }
        if (status < 0 && failure == SE3D_OK) {
            failure = status;
            if (status == SE3D_ERR_STEP_SIZE) {
                find_overlap(set, motion.drift, 0);
                failure = se3di_share_agree(set, status);
            }
            steps = motion.drift != 0.0 ? 1 : 0; /* the step that has begun */
        }
    }
    return failure < 0 ? failure : se3di_share_agree(set, find_not_finite(set));
}

uint64_t se3di_particles_hash(const se3di_particles *set)
{
    uint64_t hash = se3di_hash_numbers(SE3DI_HASH_START, &set->time, 1);
    for (size_t id = 0; id < set->id_count; ++id) {
        uint32_t k = set->index_of[id];
        if (k != SE3DI_NO_INDEX) {
            const se3di_particle *p = &set->particles[k];
            hash = se3di_hash_numbers(hash, p->x, 3);
            hash = se3di_hash_numbers(hash, &p->radius, 1);
            hash = se3di_hash_numbers(hash, p->v, 3);
            hash = se3di_hash_numbers(hash, &p->inverse_mass, 1);
            hash = se3di_hash_numbers(hash, set->spins[k].w, 3);
        }
    }
    for (size_t k = 0; k < set->bond_end_count; ++k) {
        hash = se3di_hash_numbers(hash, set->bond_ends[k].q, 4);
    }
    for (size_t k = 0; k < set->bond_count; ++k) {
        hash = se3di_hash_numbers(hash, &set->bonds[k].dissipated, 1);
    }
    if (set->audits) {
        hash = se3di_hash_numbers(hash, set->audit_work, SE3DI_AUDIT_KINDS);
        hash = se3di_hash_numbers(hash, &set->wall_work, 1);
    }
    for (size_t k = 0; k < set->servo_count; ++k) {
        hash = se3di_hash_numbers(hash, &set->servos[k].place, 1);
        hash = se3di_hash_numbers(hash, &set->servos[k].work, 1);
    }
    for (size_t k = 0; k < set->clump_count; ++k) {
        hash = se3di_hash_numbers(hash, set->clumps[k].q, 4);
        hash = se3di_hash_numbers(hash, set->clumps[k].spin, 3);
    }
    if (se3di_domain_strains(set)) {
        const double cell[] = {set->cell.offset, set->cell.work};
        hash = se3di_hash_numbers(hash, set->lower, 3);
        hash = se3di_hash_numbers(hash, set->upper, 3);
        hash = se3di_hash_numbers(hash, cell, 2);
    }
    return hash;
}
