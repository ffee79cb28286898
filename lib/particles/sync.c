/* SPDX-License-Identifier: BSD-3-Clause */
/* What a set of particles takes from the model: materials and shapes. It keeps copies, and looks
 * again when the model was edited; the history of contacts goes along. */

#include "particles/sync.h"
#include "particles/bond.h"
#include "particles/list.h"
#include "particles/mesh.h"
#include "particles/servo.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

static int same(se3di_handle a, se3di_handle b)
{
    return a.index1 == b.index1 && a.generation == b.generation;
}

static se3d_status reserve(const se3di_particles *set, void **data, size_t *capacity, size_t needed,
                           size_t size)
{
    return se3di_array_reserve(&set->allocator, data, capacity, needed, size);
}

/* The index of a material in the set's table, where it gets a place if it has none. */
static se3d_status use(se3di_particles *set, const se3di_model *model, uint32_t material,
                       uint32_t *index)
{
    se3di_handle handle = se3di_slots_handle(&model->material_slots, material);
    size_t place = set->stuff_count;
    for (size_t k = set->stuff_count; k-- > 0;) {
        if (same(set->stuffs[k].handle, handle)) {
            *index = (uint32_t)k;
            return SE3D_OK;
        }
        place = set->stuffs[k].handle.index1 == 0 ? k : place;
    }
    size_t count = place + 1 > set->stuff_count ? place + 1 : set->stuff_count;
    void *memory = set->stuffs;
    se3d_status status = reserve(set, &memory, &set->stuff_capacity, count, sizeof *set->stuffs);
    set->stuffs = memory;
    SE3DI_TRY(status);
    set->stuffs[place] = (se3di_stuff){.material = model->materials[material], .handle = handle};
    set->stuff_count = count;
    *index = (uint32_t)place;
    return SE3D_OK;
}

/* One damping is there, the other is none. */
static se3di_pair of_particles(const se3di_pair *pair)
{
    se3di_pair out = *pair;
    if (pair->rn < 0.0) {
        out.rn = 0.0;
    } else {
        out.dn = out.dt = 0.0;
    }
    return out;
}

/* Copies of the model's materials and pairs. */
static se3d_status mix(se3di_particles *set, const se3di_model *model)
{
    size_t n = set->stuff_count;
    size_t m = model->material_slots.count;
    void *memory = set->pairs;
    se3d_status status = reserve(set, &memory, &set->pair_capacity, n * n, sizeof *set->pairs);
    set->pairs = memory;
    SE3DI_TRY(status);
    set->rolling = 0;
    set->cohesive = 0;
    set->rated = 0;
    int32_t law = -1;
    for (size_t k = 0; k < n * n; ++k) {
        se3di_handle a = set->stuffs[k / n].handle;
        se3di_handle b = set->stuffs[k % n].handle;
        uint32_t row = se3di_slots_find(&model->material_slots, a.index1, a.generation);
        uint32_t column = se3di_slots_find(&model->material_slots, b.index1, b.generation);
        if (row != SE3DI_NO_INDEX && column != SE3DI_NO_INDEX) {
            set->stuffs[k / n].material = model->materials[row];
            set->pairs[k] = of_particles(&model->pairs[row * m + column]);
            set->rolling |= set->pairs[k].rolling > 0.0 || set->pairs[k].torsion > 0.0;
            set->cohesive |= set->pairs[k].cohesion > 0.0 || set->pairs[k].pull_off > 0.0;
            set->rated |= set->pairs[k].rn > 0.0;
            const int32_t of_pair = se3di_pair_lanes(&set->pairs[k]);
            law = law < 0 || law == of_pair ? of_pair : (int32_t)SE3DI_LAW_MIXED;
        } else {
            set->pairs[k] = (se3di_pair){.kn = 0.0}; /* nobody is made of it any more */
        }
    }
    set->law = (se3di_contact_law)(law < 0 ? model->contact.law : law);
    return SE3D_OK;
}

static int touches(const se3di_particles *set, const se3di_shape *shape)
{
    return shape->material >= 0 && (shape->group & set->mask) != 0 &&
           (set->group & shape->mask) != 0;
}

/* History of walls follows them to their new places; that of walls which are gone is dropped. */
static void remap_walls(se3di_particles *set, const uint32_t *place)
{
    size_t kept = 0;
    for (size_t k = 0; k < set->carry_count; ++k) {
        se3di_carry entry = set->carry[k];
        if (entry.j >= SE3DI_CARRY_WALL) {
            uint32_t wall = place[entry.j - SE3DI_CARRY_WALL];
            if (wall == SE3DI_NO_INDEX) {
                continue;
            }
            entry.j = SE3DI_CARRY_WALL | wall;
        }
        set->carry[kept] = entry;
        if (set->carry_rolling) {
            memmove(set->carry_roll + 4 * kept, set->carry_roll + 4 * k, 4 * sizeof(double));
        }
        ++kept;
    }
    set->carry_count = kept;
    se3di_particles_mesh_remap(set, NULL, place);
}

static uint32_t find_wall(const se3di_particles *set, se3di_handle handle, int32_t far)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        if (same(set->walls[k].handle, handle) && set->walls[k].far == far) {
            return (uint32_t)k;
        }
    }
    return SE3DI_NO_INDEX;
}

/* Nothing but forces moves the body: no joint, no driver. */
static int is_loose(const se3di_model *model, uint32_t body)
{
    if (model->bodies[body].fixed || !(model->bodies[body].mass > 0.0)) {
        return 0;
    }
    for (size_t k = 0; k < model->constraint_slots.count; ++k) {
        const se3di_constraint *c = &model->constraints[k];
        for (uint32_t n = 0; n < c->body_count; ++n) {
            if (c->bodies[n] == body) {
                return 0;
            }
        }
    }
    return 1;
}

double se3di_particles_lightest_body(const se3di_particles *set, const se3di_model *model)
{
    double lightest = HUGE_VAL;
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        const se3di_shape *shape = &model->shapes[k];
        double mass = model->bodies[shape->body].mass;
        if (mass < lightest && touches(set, shape) && is_loose(model, shape->body)) {
            lightest = mass;
        }
    }
    return lightest;
}

/* The wall that shape k is (or the far one), with the forces of the old one. Returns the index of
 * that. */
static uint32_t fill_wall(const se3di_particles *set, const se3di_model *model, uint32_t k,
                          int32_t far, se3di_wall *wall)
{
    const se3di_shape *shape = &model->shapes[k];
    const se3di_handle handle = se3di_slots_handle(&model->shape_slots, k);
    const uint32_t old = find_wall(set, handle, far);
    *wall = old == SE3DI_NO_INDEX ? (se3di_wall){.handle = handle, .far = far} : set->walls[old];
    wall->shape = *shape;
    wall->body = se3di_slots_handle(&model->body_slots, shape->body);
    wall->loose = is_loose(model, shape->body);
    wall->servo = se3di_servos_find(set, handle);
    se3di_wall_place(set, wall, &model->frames[shape->body]);
    if (old == SE3DI_NO_INDEX) { /* at rest so far */
        memcpy(wall->near_x, wall->pose.x, sizeof wall->near_x);
        memcpy(wall->near_R, wall->pose.R, sizeof wall->near_R);
    }
    const se3di_handle material =
        se3di_slots_handle(&model->material_slots, (uint32_t)shape->material);
    for (size_t s = 0; s < set->stuff_count; ++s) {
        wall->material = same(set->stuffs[s].handle, material) ? (uint32_t)s : wall->material;
    }
    return old;
}

static size_t walls_of(const se3di_particles *set, const se3di_shape *shape)
{
    return touches(set, shape) ? se3di_wall_count_of(shape) : 0;
}

/* The new walls; place[old] is the new index. */
static size_t fill_walls(const se3di_particles *set, const se3di_model *model, se3di_wall *walls,
                         uint32_t *place)
{
    size_t count = 0;
    for (uint32_t k = 0; k < model->shape_slots.count; ++k) {
        const size_t sides = walls_of(set, &model->shapes[k]);
        for (size_t far = 0; far < sides; ++far) {
            const uint32_t old = fill_wall(set, model, k, (int32_t)far, &walls[count]);
            if (old != SE3DI_NO_INDEX) {
                place[old] = (uint32_t)count;
            }
            ++count;
        }
    }
    return count;
}

static se3d_status replace_walls(se3di_particles *set, const se3di_model *model)
{
    size_t room = 0;
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        room += walls_of(set, &model->shapes[k]);
    }
    const se3d_allocator *a = &set->allocator;
    size_t old = set->wall_count;
    se3di_wall *walls = se3di_alloc(a, room, sizeof *walls);
    uint32_t *place = se3di_alloc(a, old, sizeof *place);
    if (!walls || !place) {
        se3di_free(a, walls, room, sizeof *walls);
        se3di_free(a, place, old, sizeof *place);
        return SE3D_ERR_NO_MEMORY;
    }
    memset(place, 0xff, old * sizeof *place); /* SE3DI_NO_INDEX */
    size_t count = fill_walls(set, model, walls, place);
    remap_walls(set, place);
    se3di_free(a, place, old, sizeof *place);
    se3di_free(a, set->walls, set->wall_capacity, sizeof *set->walls);
    set->walls = walls;
    set->wall_count = count;
    set->wall_capacity = room;
    se3di_bonds_find_walls(set);
    return SE3D_OK;
}

void se3di_particles_adopt(se3di_particles *set, const se3di_model *model)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        uint32_t shape =
            se3di_slots_find(&model->shape_slots, wall->handle.index1, wall->handle.generation);
        if (shape == SE3DI_NO_INDEX) { /* destroyed since: the next step looks again */
            wall->shape = (se3di_shape){.material = -1};
        } else {
            wall->shape = model->shapes[shape];
        }
    }
}

/* The place where the kernels add up what the walls get. */
static se3d_status reserve_sums(se3di_particles *set)
{
    void *memory = set->wall_sums;
    se3d_status status = reserve(set, &memory, &set->wall_sum_capacity,
                                 6 * set->wall_count * SE3DI_PARTICLE_SLABS_MAX, sizeof(double));
    set->wall_sums = memory;
    return status;
}

static void take_law(se3di_particles *set, const se3di_model *model)
{
    set->callback = model->contact.callback;
    set->ctx = model->contact.ctx;
    set->overlap_limit = model->contact.overlap_limit;
    set->contact_version = model->contact_version;
    set->force_valid = 0;
}

/* How surfaces move on their bodies. */
static void take_surfaces(se3di_particles *set, const se3di_model *model)
{
    for (size_t k = 0; k < set->wall_count; ++k) {
        se3di_wall *wall = &set->walls[k];
        const uint32_t index =
            se3di_slots_find(&model->shape_slots, wall->handle.index1, wall->handle.generation);
        if (index != SE3DI_NO_INDEX) {
            const se3di_shape *shape = &model->shapes[index];
            memcpy(wall->shape.surface_velocity, shape->surface_velocity,
                   sizeof shape->surface_velocity);
            memcpy(wall->shape.surface_spin, shape->surface_spin, sizeof shape->surface_spin);
            se3di_wall_place(set, wall, &model->frames[shape->body]);
        }
    }
}

/* Materials and the law have changed, but not what touches. *whole: more has to be done. */
static se3d_status renew(se3di_particles *set, const se3di_model *model, int *whole)
{
    const int32_t rolling = set->rolling;
    SE3DI_TRY(mix(set, model));
    *whole = set->rolling != rolling; /* contacts have to remember more, or less */
    set->rolling = rolling;
    if (!*whole) {
        take_law(set, model);
        take_surfaces(set, model);
    }
    return SE3D_OK;
}

se3d_status se3di_particles_sync(se3di_particles *set, const se3di_model *model)
{
    if (set->topology_version == model->topology_version) {
        int whole = 0;
        if (set->contact_version != model->contact_version) {
            SE3DI_TRY(renew(set, model, &whole));
        }
        if (!whole) {
            return SE3D_OK;
        }
    }
    SE3DI_TRY(se3di_particles_collect(set)); /* rolling may begin */
    for (size_t k = 0; k < set->stuff_count; ++k) {
        se3di_stuff *stuff = &set->stuffs[k];
        if (!stuff->held) { /* only walls are made of it: see which still are */
            stuff->handle = (se3di_handle){0, 0};
        }
    }
    for (size_t k = 0; k < model->shape_slots.count; ++k) {
        uint32_t index;
        if (touches(set, &model->shapes[k])) {
            SE3DI_TRY(use(set, model, (uint32_t)model->shapes[k].material, &index));
        }
    }
    SE3DI_TRY(mix(set, model));
    SE3DI_TRY(replace_walls(set, model));
    SE3DI_TRY(reserve_sums(set));
    take_law(set, model);
    set->topology_version = model->topology_version;
    return SE3D_OK;
}

se3d_status se3di_particles_hold(se3di_particles *set, se3di_model *model, uint32_t material,
                                 uint32_t *index)
{
    SE3DI_TRY(use(set, model, material, index));
    if (!set->stuffs[*index].held) {
        set->stuffs[*index].held = 1;
        set->topology_version = 0; /* pairs are missing */
        ++model->materials[material].users;
    }
    return SE3D_OK;
}
