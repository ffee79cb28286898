/* SPDX-License-Identifier: BSD-3-Clause */
/* Particles on meshes: a sphere may touch one mesh in several places. A pair of a particle and a
 * mesh carries the history of all of them; from step to step a place is known by its normal, which
 * turns little (a rolling sphere's in the mesh's frame, also over an edge). */
#include "particles/mesh.h"

#include "contact/shape/mesh.h"
#include "math/vec3.h"
#include "particles/sift.h"
#include "particles/wall.h"

#include <stddef.h>
#include <string.h>

#define SAME_PLACE 0.7 /* cosine of the angle by which a normal may turn in a step */

/* Without what lies behind its touches, which is most of it. */
static void copy_pair(const se3di_mesh_pair *from, se3di_mesh_pair *to)
{
    memcpy(to, from, offsetof(se3di_mesh_pair, touches) + from->count * sizeof *from->touches);
}

/* The touch of the pair with the nearest normal that is not taken; -1: none. */
static int match(const se3di_mesh_pair *pair, const double normal[3], unsigned taken)
{
    double best = SAME_PLACE;
    int found = -1;
    for (int k = 0; k < (int)pair->count; ++k) {
        double cosine = se3di_dot(pair->touches[k].normal, normal);
        if (!(taken >> k & 1u) && cosine > best) {
            best = cosine;
            found = k;
        }
    }
    return found;
}

void se3di_mesh_batch_begin(const se3di_particles *set, uint32_t wall, se3di_mesh_batch *batch)
{
    memset(&batch->block, 0, sizeof batch->block);
    memset(&batch->given, 0, sizeof batch->given);
    if (set->rolling) {
        memset(&batch->roll, 0, sizeof batch->roll);
    }
    batch->count = 0;
    for (int k = 0; k < SE3DI_PARTICLE_LANES; ++k) {
        batch->block.i[k] = batch->block.j[k] = (uint32_t)set->capacity;
        batch->given.distance[k] = 1e300;
    }
    batch->block.j[0] = wall;
}

static void locate(const se3di_particles *set, const se3di_mesh_pair *pair, double reach,
                   double local[3])
{
    const se3di_wall *wall = &set->walls[pair->wall];
    double x[3];
    se3di_particles_image(set, wall, set->particles[pair->i].x, reach, x);
    se3di_wall_local(wall, x, local);
}

/* A place where a sphere touches now. */
typedef struct place {
    double distance;
    double local[3], normal[3]; /* the normal in the frames of the mesh and of the ground */
} place;

/* Of triangles among which all are that the pair touches. */
static size_t find_places(const se3di_particles *set, const se3di_mesh_pair *pair,
                          const uint32_t *faces, size_t face_count, place *places)
{
    const se3di_wall *wall = &set->walls[pair->wall];
    const double radius = set->particles[pair->i].radius;
    se3di_touch touches[SE3DI_PARTICLE_FACES];
    double local[3];
    locate(set, pair, radius, local);
    const size_t count = se3di_mesh_contacts_among(&wall->shape, faces, face_count, local, radius,
                                                   SE3DI_PARTICLE_FACES, touches);
    for (size_t k = 0; k < count; ++k) {
        places[k].distance = touches[k].distance;
        se3di_copy(touches[k].normal, places[k].local);
        se3di_mul(wall->pose.R, touches[k].normal, places[k].normal);
    }
    return count;
}

/* Append them with the history; returns 0 if there is no room. */
static int add_places(const se3di_mesh_pair *pair, const place *places, size_t count,
                      se3di_mesh_batch *batch)
{
    if (batch->block.j[0] != pair->wall || batch->count + count > SE3DI_PARTICLE_LANES) {
        return 0;
    }
    unsigned taken = 0;
    for (size_t t = 0; t < count; ++t) {
        const uint32_t k = batch->count++;
        const int old = match(pair, places[t].local, taken);
        se3di_copy(places[t].local, batch->local[k]);
        batch->block.i[k] = pair->i;
        batch->given.distance[k] = places[t].distance;
        for (int a = 0; a < 3; ++a) {
            batch->given.normal[a][k] = places[t].normal[a];
            batch->block.xi[a][k] = old < 0 ? 0.0 : pair->touches[old].xi[a];
        }
        for (int a = 0; a < 4; ++a) {
            batch->roll.rho[a][k] = old < 0 ? 0.0 : pair->touches[old].rho[a];
        }
        taken |= old < 0 ? 0u : 1u << old;
    }
    return 1;
}

int se3di_mesh_batch_add(const se3di_particles *set, const se3di_mesh_pair *pair,
                         se3di_mesh_batch *batch)
{
    place places[SE3DI_PARTICLE_FACES];
    const size_t count =
        find_places(set, pair, set->faces + pair->face_begin, pair->face_count, places);
    return add_places(pair, places, count, batch);
}

/* What the kernel made of the history of the pairs [begin, end): their lanes follow each other. */
static void close_batch(const se3di_mesh_batch *batch, se3di_mesh_pair *begin, se3di_mesh_pair *end)
{
    uint32_t k = 0;
    for (se3di_mesh_pair *pair = begin; pair < end; ++pair) {
        for (pair->count = 0; k < batch->count && batch->block.i[k] == pair->i; ++k) {
            se3di_mesh_touch *touch = &pair->touches[pair->count++];
            se3di_copy(batch->local[k], touch->normal);
            for (int a = 0; a < 3; ++a) {
                touch->xi[a] = batch->block.xi[a][k];
            }
            for (int a = 0; a < 4; ++a) {
                touch->rho[a] = batch->roll.rho[a][k];
            }
        }
    }
}

/* The touches of the batch, which those of the pairs [begin, end) are, and then none. */
static void finish_batch(se3di_particles *set, se3di_mesh_batch *batch, se3di_mesh_pair *begin,
                         se3di_mesh_pair *end, se3di_force_task *task)
{
    if (batch->count > 0) {
        task->blocks = &batch->block;
        task->rolls = set->rolling ? &batch->roll : NULL; /* also if there are no blocks */
        task->given = &batch->given;
        se3di_particles_get_kernels(set)->walls(task);
    }
    close_batch(batch, begin, end);
}

/* Whether the triangles of a pair may be sifted with those of others: heightfields keep none, and
 * a few hundred fill more than one sieve. */
static int is_sifted(const se3di_particles *set, const se3di_mesh_pair *pair)
{
    return set->walls[pair->wall].shape.rows == 0 && pair->face_count <= SE3DI_SIFT_SIZE;
}

/* Sift the triangles of pairs from `first` on, all of one wall; returns the one after them. */
static se3di_mesh_pair *sift_pairs(const se3di_particles *set, se3di_mesh_pair *first,
                                   const se3di_mesh_pair *end, se3di_sift *sift)
{
    const se3di_wall *wall = &set->walls[first->wall];
    se3di_mesh_pair *pair = first;
    size_t count = 0;
    for (; pair < end && pair->wall == first->wall && is_sifted(set, pair) &&
           count + pair->face_count <= SE3DI_SIFT_SIZE;
         ++pair) {
        const se3di_particle *sphere = &set->particles[pair->i];
        double x[3];
        se3di_particles_image(set, wall, sphere->x, sphere->radius, x);
        for (uint32_t k = 0; k < pair->face_count; ++k, ++count) {
            for (int a = 0; a < 3; ++a) {
                sift->x[a][count] = x[a];
            }
            sift->radius[count] = sphere->radius;
            sift->triangle[count] = set->faces[pair->face_begin + k];
        }
    }
    for (size_t k = count; k % 8 > 0; ++k) { /* the last lanes: some triangle, far away */
        sift->x[0][k] = sift->x[1][k] = sift->x[2][k] = sift->radius[k] = 0.0;
        sift->triangle[k] = 0;
    }
    set->kernels->sift(wall, count, sift);
    return pair;
}

/* The touches of a pair whose triangles were sifted, from `at` on. */
static size_t take_places(const se3di_particles *set, const se3di_mesh_pair *pair,
                          const se3di_sift *sift, size_t at, place *places)
{
    uint32_t faces[SE3DI_SIFT_SIZE];
    size_t count = 0, last = at;
    for (size_t k = at; k < at + pair->face_count; ++k) {
        if (sift->left[k / 8] >> (k % 8) & 1) {
            faces[count++] = sift->triangle[k];
            last = k;
        }
    }
    if (count == 0) {
        return 0;
    }
    if (count > 1 || !(sift->inside[last / 8] >> (last % 8) & 1)) {
        return find_places(set, pair, faces, count, places);
    }
    places->distance = sift->distance[last];
    for (int a = 0; a < 3; ++a) {
        places->local[a] = sift->local[a][last];
        places->normal[a] = sift->normal[a][last];
    }
    return 1;
}

/* All pairs in turn; `first` is the one that the batch begins with. */
static void evaluate_pairs(se3di_particles *set, se3di_mesh_pair *begin, se3di_mesh_pair *end,
                           se3di_force_task *task)
{
    se3di_mesh_batch batch;
    se3di_sift sift;
    se3di_mesh_pair *first = begin, *sifted = begin;
    size_t at = 0;
    se3di_mesh_batch_begin(set, begin->wall, &batch);
    for (se3di_mesh_pair *pair = begin; pair < end; ++pair) {
        place places[SE3DI_PARTICLE_FACES];
        size_t count;
        if (pair == sifted && is_sifted(set, pair)) {
            sifted = sift_pairs(set, pair, end, &sift);
            at = 0;
        }
        if (pair < sifted) {
            count = take_places(set, pair, &sift, at, places);
            at += pair->face_count;
        } else {
            const uint32_t *faces = set->faces + pair->face_begin;
            count = find_places(set, pair, faces, pair->face_count, places);
            sifted = pair + 1;
        }
        if (!add_places(pair, places, count, &batch)) {
            finish_batch(set, &batch, first, pair, task);
            first = pair;
            se3di_mesh_batch_begin(set, pair->wall, &batch);
            (void)add_places(pair, places, count, &batch);
        }
    }
    finish_batch(set, &batch, first, end, task);
}

void se3di_particles_mesh_forces(se3di_particles *set, const se3di_slab *slab,
                                 se3di_force_task *task)
{
    if (slab->mesh_begin == slab->mesh_end) {
        return; /* there may be no pairs at all, and no memory of them */
    }
    se3di_force_task local = *task;
    local.begin = 0;
    local.end = 1;
    evaluate_pairs(set, set->mesh_pairs + slab->mesh_begin, set->mesh_pairs + slab->mesh_end,
                   &local);
    task->overlap = local.overlap;
    task->touching = local.touching;
    memcpy(task->power, local.power, sizeof task->power);
    task->failure = local.failure;
}

void se3di_particles_mesh_collect(se3di_particles *set)
{
    se3di_mesh_pair *pairs = set->mesh_pairs;
    size_t capacity = set->mesh_capacity;
    set->mesh_old_count = 0;
    for (size_t k = 0; k < set->mesh_count; ++k) {
        if (pairs[k].count > 0) {
            if (set->mesh_old_count < k) {
                copy_pair(&pairs[k], &pairs[set->mesh_old_count]);
            }
            ++set->mesh_old_count;
        }
    }
    set->mesh_pairs = set->mesh_old;
    set->mesh_capacity = set->mesh_old_capacity;
    set->mesh_count = 0;
    set->mesh_old = pairs;
    set->mesh_old_capacity = capacity;
}

void se3di_particles_mesh_remap(se3di_particles *set, const uint32_t *new_index,
                                const uint32_t *new_wall)
{
    size_t kept = 0;
    for (size_t k = 0; k < set->mesh_old_count; ++k) {
        se3di_mesh_pair *pair = &set->mesh_old[k];
        pair->i = new_index ? new_index[pair->i] : pair->i;
        pair->wall = new_wall ? new_wall[pair->wall] : pair->wall;
        if (pair->i != SE3DI_NO_INDEX && pair->wall != SE3DI_NO_INDEX) {
            if (kept < k) {
                copy_pair(pair, &set->mesh_old[kept]);
            }
            ++kept;
        }
    }
    set->mesh_old_count = kept;
}

/* Chains of the old pairs by particle, through key[]. */
static void chain(se3di_particles *set)
{
    for (size_t k = 0; k < set->count; ++k) {
        set->key[k] = SE3DI_NO_INDEX;
    }
    for (size_t k = set->mesh_old_count; k-- > 0;) {
        se3di_mesh_pair *pair = &set->mesh_old[k];
        pair->next = set->key[pair->i];
        set->key[pair->i] = (uint32_t)k;
    }
}

static se3d_status push(se3di_particles *set, const se3di_near_wall *near)
{
    const uint32_t i = near->i & ~SE3DI_LIST_ACTIVE;
    void *memory = set->mesh_pairs;
    se3d_status status = se3di_array_reserve(&set->allocator, &memory, &set->mesh_capacity,
                                             set->mesh_count + 1, sizeof *set->mesh_pairs);
    set->mesh_pairs = memory;
    SE3DI_TRY(status);
    uint32_t old = set->key[i];
    while (old != SE3DI_NO_INDEX && set->mesh_old[old].wall != near->wall) {
        old = set->mesh_old[old].next;
    }
    se3di_mesh_pair *pair = &set->mesh_pairs[set->mesh_count++];
    pair->count = 0;
    if (old != SE3DI_NO_INDEX) {
        copy_pair(&set->mesh_old[old], pair);
    }
    pair->i = i;
    pair->wall = near->wall;
    pair->next = SE3DI_NO_INDEX;
    pair->face_begin = near->face_begin;
    pair->face_count = near->face_count;
    return SE3D_OK;
}

static int is_active(const se3di_particles *set, const se3di_near_wall *near)
{
    const se3di_mesh_pair pair = {.i = near->i & ~SE3DI_LIST_ACTIVE, .wall = near->wall};
    const double reach = set->particles[pair.i].radius + se3di_particles_wear(set)[pair.i] +
                         set->walls[pair.wall].near_reach;
    double local[3];
    locate(set, &pair, reach, local);
    return se3di_mesh_is_near(&set->walls[pair.wall].shape, set->faces + near->face_begin,
                              near->face_count, local, reach);
}

se3d_status se3di_particles_mesh_activate(se3di_particles *set)
{
    set->mesh_count = 0;
    int any = 0;
    for (size_t k = 0; k < set->wall_count; ++k) {
        any = any || se3di_wall_is_mesh(&set->walls[k]);
    }
    if (any) {
        chain(set);
    }
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        se3di_slab *slab = &set->slabs[s];
        slab->mesh_begin = (uint32_t)set->mesh_count;
        for (uint32_t k = slab->near_begin; any && k < slab->near_end; ++k) {
            const se3di_near_wall *near = &set->near_walls[k];
            if (se3di_wall_is_mesh(&set->walls[near->wall]) && is_active(set, near)) {
                SE3DI_TRY(push(set, near));
            }
        }
        slab->mesh_end = (uint32_t)set->mesh_count;
    }
    void *memory = set->mesh_old; /* the next time they change places */
    se3d_status status = se3di_array_reserve(&set->allocator, &memory, &set->mesh_old_capacity,
                                             set->mesh_count, sizeof *set->mesh_old);
    set->mesh_old = memory;
    return status;
}
