/* SPDX-License-Identifier: BSD-3-Clause */
/* Contacts as they are: each is evaluated by itself, on copies, with springs that stay. */
#include "particles/contacts.h"

#include "base/sized.h"

#include "math/vec3.h"
#include "particles/cell.h"
#include "particles/grid.h"
#include "particles/mesh.h"
#include "particles/wall.h"

#include <math.h>
#include <string.h>

/* Two particles and the partner of unused lanes, with all that a kernel reads and writes. */
typedef struct couple {
    _Alignas(64) se3di_particle particles[3];
    _Alignas(64) se3di_load loads[3];
    _Alignas(64) se3di_particle_block block;
    _Alignas(64) se3di_spin spins[3];
    se3di_roll roll;
    double sums[6];
    se3di_wall wall;
} couple;

static void copy_lane(const se3di_particles *set, const se3di_particle_block *block,
                      const se3di_roll *roll, int lane, couple *c)
{
    memset(c, 0, sizeof *c);
    for (int k = 0; k < SE3DI_PARTICLE_LANES; ++k) {
        c->block.i[k] = c->block.j[k] = 2;
    }
    c->particles[2].inverse_mass = 1.0;
    c->block.i[0] = 0;
    c->particles[0] = set->particles[block->i[lane]];
    c->spins[0] = set->spins[block->i[lane]];
    for (int a = 0; a < 3; ++a) {
        c->block.xi[a][0] = block->xi[a][lane];
    }
    for (int a = 0; roll && a < 4; ++a) {
        c->roll.rho[a][0] = roll->rho[a][lane];
    }
}

static se3di_force_task task_of(const se3di_particles *set, couple *c)
{
    return (se3di_force_task){
        .particles = c->particles,
        .spins = c->spins,
        .loads = c->loads,
        .blocks = &c->block,
        .rolls = set->rolling ? &c->roll : NULL,
        .pairs = set->pairs,
        .walls = &c->wall,
        .materials = (uint32_t)set->stuff_count,
        .material = SE3DI_NO_INDEX,
        .end = 1,
        .law = (int32_t)set->law,
        .limit = 1e30,
        .cohesive = set->cohesive,
        .rated = set->rated,
        .wall_sums = c->sums,
        .stuffs = set->stuffs,
        .callback = set->callback,
        .ctx = set->ctx,
        .clumped = set->clump_count > 0 ? set : NULL,
    };
}

static const se3di_kernels *kernels_of(const se3di_particles *set)
{
    return set->law == SE3DI_LAW_CALLBACK ? se3di_particle_kernels_callback()
                                          : se3di_particle_kernels_portable();
}

static const se3di_roll *roll_of(const se3di_particles *set, uint32_t b)
{
    return set->rolls ? &set->rolls[b] : NULL;
}

/* The contact of a lane; returns 0 if the two do not touch. */
static int pair_contact(const se3di_particles *set, uint32_t b, int lane,
                        se3d_particles_contact *out)
{
    const se3di_particle_block *block = &set->blocks[b];
    const se3di_particle *first = &set->particles[block->i[lane]];
    const se3di_particle *second = &set->particles[block->j[lane]];
    double d[3], v[3] = {0.0, 0.0, 0.0};
    se3di_sub(first->x, second->x, d);
    se3di_particles_nearest(set, d, v);
    double distance = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    double overlap = first->radius + second->radius - distance;
    if (!(overlap > 0.0 && distance > 0.0)) {
        return 0;
    }
    couple c; /* of many that are near each other few touch: only these are copied */
    copy_lane(set, block, roll_of(set, b), lane, &c);
    c.block.j[0] = 1;
    c.particles[1] = *second;
    c.spins[1] = set->spins[block->j[lane]];
    se3di_sub(c.particles[1].v, v, c.particles[1].v);
    double arm = c.particles[0].radius - 0.5 * overlap;
    for (int a = 0; a < 3; ++a) {
        c.particles[1].x[a] = c.particles[0].x[a] - d[a];
        out->normal[a] = d[a] / distance;
        out->point[a] = c.particles[0].x[a] - d[a] * (arm / distance);
    }
    out->overlap = overlap;
    se3di_force_task task = task_of(set, &c);
    kernels_of(set)->pairs(&task);
    out->i = c.spins[0].id;
    out->j = c.spins[1].id;
    out->shape = (se3d_shape){0, 0};
    memcpy(out->force, c.loads[0].force, sizeof out->force);
    return 1;
}

/* Distance and normal are those of the shape, or of the lane in `given`. */
static int wall_contact(const se3di_particles *set, couple *c, const se3di_given *given, int lane,
                        se3d_particles_contact *out)
{
    double x[3], normal[3];
    se3di_particles_image(set, &c->wall, c->particles[0].x, c->particles[0].radius, x);
    se3di_copy(x, c->particles[0].x); /* the copy touches where it is */
    double distance = se3di_wall_nearest(&c->wall, x, out->point, normal);
    se3di_given here = {.distance = {distance}};
    for (int a = 0; a < 3; ++a) {
        here.normal[a][0] = given ? given->normal[a][lane] : normal[a];
    }
    if (given) {
        here.distance[0] = given->distance[lane];
        for (int a = 0; a < 3; ++a) {
            out->point[a] = x[a] - here.distance[0] * here.normal[a][0];
        }
    }
    if (!(here.distance[0] < c->particles[0].radius)) {
        return 0;
    }
    for (int a = 0; a < 3; ++a) {
        out->normal[a] = here.normal[a][0];
    }
    out->overlap = c->particles[0].radius - here.distance[0];
    c->block.j[0] = 0;
    se3di_force_task task = task_of(set, c);
    task.given = &here;
    kernels_of(set)->walls(&task);
    out->i = c->spins[0].id;
    out->j = 0;
    out->shape = (se3d_shape){c->wall.handle.index1, c->wall.handle.generation};
    memcpy(out->force, c->loads[0].force, sizeof out->force);
    return 1;
}

typedef struct contact_list {
    unsigned char *contacts; /* of `size` bytes each; NULL: only counted */
    size_t size, capacity, count;
    double force_max;
    void (*visit)(void *ctx, const se3d_particles_contact *contact); /* NULL: nobody does */
    void *ctx;
} contact_list;

static void append(contact_list *list, int touches, const se3d_particles_contact *contact)
{
    if (touches && list->contacts && list->count < list->capacity) {
        (void)se3di_sized_give(list->contacts + list->count * list->size, list->size, contact,
                               sizeof *contact);
    }
    if (touches && list->visit) {
        list->visit(list->ctx, contact);
    }
    list->force_max = touches ? fmax(list->force_max, se3di_norm(contact->force)) : list->force_max;
    list->count += (size_t)touches;
}

static void list_blocks(const se3di_particles *set, const se3di_slab *slab, contact_list *list)
{
    for (uint32_t b = slab->pair_begin; b < slab->wall_end; ++b) {
        const se3di_particle_block *block = &set->blocks[b];
        for (int lane = 0; lane < SE3DI_PARTICLE_LANES; ++lane) {
            se3d_particles_contact contact;
            if (block->i[lane] >= set->count) {
                continue;
            }
            if (b < slab->wall_begin) {
                append(list, pair_contact(set, b, lane, &contact), &contact);
            } else {
                couple c;
                copy_lane(set, block, roll_of(set, b), lane, &c);
                c.wall = set->walls[block->j[0]];
                append(list, wall_contact(set, &c, NULL, lane, &contact), &contact);
            }
        }
    }
}

static void list_meshes(const se3di_particles *set, const se3di_slab *slab, contact_list *list)
{
    for (uint32_t k = slab->mesh_begin; k < slab->mesh_end; ++k) {
        se3di_mesh_batch batch;
        se3di_mesh_batch_begin(set, set->mesh_pairs[k].wall, &batch);
        (void)se3di_mesh_batch_add(set, &set->mesh_pairs[k], &batch);
        for (int lane = 0; lane < (int)batch.count; ++lane) {
            couple c;
            se3d_particles_contact contact;
            copy_lane(set, &batch.block, &batch.roll, lane, &c);
            c.wall = set->walls[set->mesh_pairs[k].wall];
            append(list, wall_contact(set, &c, &batch.given, lane, &contact), &contact);
        }
    }
}

static void list_all(const se3di_particles *set, contact_list *list)
{
    for (uint32_t s = 0; set && set->list_valid && s < set->slab_count; ++s) {
        list_blocks(set, &set->slabs[s], list);
        list_meshes(set, &set->slabs[s], list);
    }
}

void se3di_particles_visit_contacts(const se3di_particles *set,
                                    void (*visit)(void *ctx, const se3d_particles_contact *contact),
                                    void *ctx)
{
    contact_list list = {.visit = visit, .ctx = ctx};
    list_all(set, &list);
}

se3d_status se3di_particles_contacts(const se3di_particles *set, size_t capacity, void *contacts,
                                     size_t size, size_t *count, double *force_max)
{
    contact_list list = {.contacts = contacts, .size = size, .capacity = capacity};
    list_all(set, &list);
    *count = list.count;
    if (force_max) {
        *force_max = fmax(*force_max, list.force_max);
    }
    return SE3D_OK;
}
