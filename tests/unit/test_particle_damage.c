/* SPDX-License-Identifier: BSD-3-Clause */
/* Every number and index of a set of particles that is checked when it is read: one is made wrong
 * in a snapshot, which is then written with a right checksum. It is refused with a message, and the
 * model goes on. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "particles/bond.h"
#include "particles/wall.h"
#include "support/particle_worlds.h"
#include "system/snapshot.h"

typedef struct world {
    se3d_system *system;
    se3d_snapshot *snapshot;
    se3di_particles *set;
    unsigned char *bytes;
    size_t room;
} world;

/* `time` < 0: not run. */
static void open_world(world *w, int kind, double time, int adds)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    w->system = particle_world(kind, 1);
    def.method = SE3D_METHOD_VERLET;
    CHECK(!se3d_solver_create(w->system, &def, &solver));
    CHECK(se3d_solver_run(solver, time) >= 0);
    if (adds) { /* what particles remember waits for new lists */
        static const double place[3] = {0.0, 0.0, 5.0}, rest[3] = {0.0, 0.0, 0.0}, radius = 0.01;
        se3d_particles *set = NULL;
        se3d_material material;
        CHECK(!se3d_system_get_particles(w->system, 0, &set));
        CHECK(!se3d_system_get_material(w->system, 1, &material));
        CHECK(!se3d_particles_add(set, material, 1, place, &radius, rest, rest, NULL));
    }
    CHECK(!se3d_snapshot_create(w->system, &w->snapshot));
    CHECK(!se3d_snapshot_write(w->snapshot, NULL, 0, &w->room));
    w->bytes = malloc(w->room);
    w->set = w->snapshot->sets;
    CHECK(w->bytes && w->set);
    se3d_solver_destroy(solver);
}

static void close_world(world *w)
{
    se3d_snapshot_destroy(w->snapshot);
    se3d_system_destroy(w->system);
    free(w->bytes);
}

static se3d_status read_back(world *w)
{
    se3d_snapshot *read = NULL;
    size_t size = w->room;
    CHECK(!se3d_snapshot_write(w->snapshot, w->bytes, w->room, &size) && size == w->room);
    const se3d_status status = se3d_snapshot_read(w->system, w->bytes, size, &read);
    CHECK((read != NULL) == (status >= 0));
    se3d_snapshot_destroy(read);
    return status;
}

/* With `size` bytes at `at` as `wrong` has them. */
static int is_refused(world *w, void *at, const void *wrong, size_t size)
{
    const uint64_t before = se3d_system_hash(w->system);
    unsigned char kept[16];
    memcpy(kept, at, size);
    memcpy(at, wrong, size);
    const se3d_status status = read_back(w);
    memcpy(at, kept, size);
    return status == SE3D_ERR_INVALID_ARGUMENT && se3d_system_hash(w->system) == before &&
           strstr(se3d_system_get_error(w->system), "malformed");
}

#define REFUSED_NUMBER(w, at, value) CHECK(is_refused(w, at, &(double){value}, sizeof(double)))
#define REFUSED_INDEX(w, at, value)  CHECK(is_refused(w, at, &(uint32_t){value}, sizeof(uint32_t)))

static void must_be_finite(world *w, double *numbers, size_t count)
{
    for (size_t k = 0; k < count; ++k) {
        REFUSED_NUMBER(w, &numbers[k], (k & 1) ? (double)INFINITY : (double)NAN);
    }
}

static void must_be_positive(world *w, double *number)
{
    must_be_finite(w, number, 1);
    REFUSED_NUMBER(w, number, -1.0);
    REFUSED_NUMBER(w, number, 0.0);
}

static void records_that_are_no_numbers_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_HEAP, 0.02, 0);
    se3di_particles *set = w.set;
    double *const sizes[] = {&set->skin, &set->stretch, &set->pace, &set->drift};
    CHECK(read_back(&w) >= 0);
    for (size_t k = 0; k < 4; ++k) {
        must_be_finite(&w, sizes[k], 1);
        REFUSED_NUMBER(&w, sizes[k], -1.0);
    }
    must_be_finite(&w, &set->time, 1);
    must_be_finite(&w, set->gravity, 3);
    must_be_finite(&w, set->low, 3);
    must_be_finite(&w, set->high, 3);
    must_be_finite(&w, set->home_low, 3);
    must_be_finite(&w, set->home_high, 3);
    CHECK(set->servo_count > 0);
    for (size_t k = 0; k < set->servo_count; ++k) {
        se3di_servo *s = &set->servos[k];
        double *const numbers[] = {&s->load, &s->place, &s->speed, &s->work, &s->half};
        for (size_t i = 0; i < 5; ++i) {
            must_be_finite(&w, numbers[i], 1);
        }
    }
    must_be_finite(&w, set->audit_work, SE3DI_AUDIT_KINDS);
    must_be_finite(&w, &set->wall_work, 1);
    must_be_finite(&w, set->audit_power, SE3DI_AUDIT_KINDS + 1);
    se3di_audit_load *a = &set->audit[set->count / 2];
    must_be_finite(&w, a->damping, 3);
    must_be_finite(&w, a->slide, 3);
    must_be_finite(&w, a->turn, 3);
    must_be_finite(&w, a->roll, 3);
    must_be_finite(&w, a->twist, 3);
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void particles_that_cannot_be_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_HEAP, 0.02, 0);
    se3di_particle *p = &w.set->particles[3];
    se3di_spin *spin = &w.set->spins[3];
    uint16_t none = (uint16_t)w.set->stuff_count, unheld = 0;
    must_be_finite(&w, p->x, 3);
    must_be_finite(&w, p->v, 3);
    must_be_finite(&w, spin->w, 3);
    must_be_positive(&w, &p->radius);
    must_be_positive(&w, &p->inverse_mass);
    REFUSED_NUMBER(&w, &p->radius, 1e200);
    REFUSED_INDEX(&w, &spin->id, (uint32_t)w.set->id_count);
    REFUSED_INDEX(&w, &spin->id, w.set->spins[4].id);
    REFUSED_INDEX(&w, &w.set->index_of[spin->id], 4);
    CHECK(is_refused(&w, &spin->material, &none, sizeof none));
    while (w.set->stuffs[unheld].held) {
        ++unheld;
    }
    CHECK(unheld < w.set->stuff_count); /* that of the walls */
    CHECK(is_refused(&w, &spin->material, &unheld, sizeof unheld));
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void walls_that_are_nowhere_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_HEAP, 0.02, 0);
    for (size_t k = 0; k < w.set->wall_count; ++k) {
        se3di_wall *wall = &w.set->walls[k];
        must_be_finite(&w, wall->pose.x, 3);
        must_be_finite(&w, wall->pose.R, 9);
        must_be_finite(&w, wall->old_x, 3);
        must_be_finite(&w, wall->old_R, 9);
        must_be_finite(&w, wall->near_x, 3);
        must_be_finite(&w, wall->near_R, 9);
        must_be_finite(&w, wall->turn, 9);
        must_be_finite(&w, &wall->reach, 1);
        must_be_finite(&w, &wall->near_reach, 1);
        must_be_finite(&w, &wall->pace, 1);
        must_be_finite(&w, &wall->inverse_mass, 1);
        if (wall->servo > 0) {
            must_be_finite(&w, wall->home, 3);
            must_be_finite(&w, wall->home_v, 3);
            must_be_finite(&w, wall->slide, 3);
        }
    }
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void sources_and_flows_are_checked(void)
{
    world w;
    open_world(&w, PARTICLES_MESH, 0.1, 0);
    CHECK(w.set->source_count == 1 && w.set->flow_count == 2);
    se3di_source *s = &w.set->sources[0];
    must_be_finite(&w, &s->rate, 1);
    REFUSED_NUMBER(&w, &s->rate, -1.0);
    must_be_finite(&w, &s->owed, 1);
    must_be_finite(&w, &s->mass, 1);
    REFUSED_NUMBER(&w, &s->due, (double)NAN);
    REFUSED_NUMBER(&w, &s->next, 0.5 * s->radii.smallest);
    REFUSED_NUMBER(&w, &s->next, 2.0 * s->radii.largest);
    REFUSED_INDEX(&w, &s->material, 1000);
    for (size_t k = 0; k < w.set->flow_count; ++k) {
        must_be_finite(&w, &w.set->flows[k].begun, 1);
        must_be_finite(&w, &w.set->flows[k].total.mass, 1);
    }
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void maps_must_be_finite(world *w, se3di_domain_map *map)
{
    must_be_finite(w, map->along, 3);
    must_be_finite(w, &map->shear, 1);
}

static void cells_that_are_no_boxes_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_CELL, 0.02, 0);
    se3di_domain *cell = &w.set->cell;
    uint64_t stage = cell->count;
    CHECK(cell->count > 0);
    must_be_finite(&w, &cell->offset, 1);
    must_be_finite(&w, &cell->shear, 1);
    must_be_finite(&w, &cell->strained, 1);
    must_be_finite(&w, &cell->work, 1);
    maps_must_be_finite(&w, &cell->rates);
    maps_must_be_finite(&w, &cell->field);
    maps_must_be_finite(&w, &cell->since);
    must_be_finite(&w, cell->virial, 9);
    must_be_finite(&w, cell->kinetic, 6);
    CHECK(is_refused(&w, &cell->stage, &stage, sizeof stage));
    for (int a = 0; a < 3; ++a) {
        must_be_finite(&w, &w.set->lower[a], 1);
        must_be_finite(&w, &w.set->upper[a], 1);
        REFUSED_NUMBER(&w, &w.set->upper[a], w.set->lower[a]);
    }
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

/* Slabs whose ranges do not follow each other, neighbours that are not there. */
static void lists_that_name_what_is_not_there_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_HEAP, 0.06, 0);
    se3di_particles *set = w.set;
    CHECK(set->list_valid && set->list_count > 0 && set->near_count > 0 && set->slab_count > 1);
    for (uint32_t s = 0; s < set->slab_count; ++s) {
        se3di_slab *slab = &set->slabs[s];
        uint32_t *const ends[] = {&slab->begin,      &slab->end,        &slab->pair_begin,
                                  &slab->pair_end,   &slab->wall_begin, &slab->wall_end,
                                  &slab->near_begin, &slab->near_end,   &slab->mesh_begin,
                                  &slab->mesh_end};
        for (size_t k = 0; k < sizeof ends / sizeof *ends; ++k) {
            REFUSED_INDEX(&w, ends[k], *ends[k] + 1);
        }
    }
    REFUSED_INDEX(&w, &set->first[0], 1);
    REFUSED_INDEX(&w, &set->first[set->count], (uint32_t)set->list_count - 1);
    REFUSED_INDEX(&w, &set->first[set->count / 2], (uint32_t)set->list_count + 1);
    REFUSED_INDEX(&w, &set->first[1], (uint32_t)set->list_count + 1);
    uint32_t i = 0;
    while (set->first[i + 1] == set->first[i]) {
        ++i;
    }
    REFUSED_INDEX(&w, &set->list[set->first[i]], i);
    REFUSED_INDEX(&w, &set->list[set->first[i]], (uint32_t)set->count);
    se3di_near_wall *near = &set->near_walls[0];
    REFUSED_INDEX(&w, &near->i, (uint32_t)set->count);
    REFUSED_INDEX(&w, &near->wall, (uint32_t)set->wall_count);
    REFUSED_INDEX(&w, &near->face_begin, (uint32_t)set->face_count + 1);
    REFUSED_INDEX(&w, &near->face_count, (uint32_t)set->face_count + 1);
    must_be_finite(&w, set->origin, 3);
    must_be_finite(&w, set->origin + 3 * set->capacity, 1);
    must_be_finite(&w, set->origin + 4 * set->capacity, 1);
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void blocks_that_two_threads_would_share_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_HEAP, 0.06, 0);
    const se3di_slab *first = NULL, *walls = NULL;
    for (uint32_t s = 0; s < w.set->slab_count; ++s) {
        const se3di_slab *slab = &w.set->slabs[s];
        first = !first && slab->pair_end > slab->pair_begin ? slab : first;
        walls = !walls && slab->wall_end > slab->wall_begin ? slab : walls;
    }
    CHECK(first && walls);
    if (first && walls) {
        se3di_particle_block *b = &w.set->blocks[first->pair_begin];
        se3di_particle_block *wall = &w.set->blocks[walls->wall_begin];
        REFUSED_INDEX(&w, &b->i[0], (uint32_t)w.set->count);
        REFUSED_INDEX(&w, &b->j[0], (uint32_t)w.set->count);
        REFUSED_INDEX(&w, &b->i[0], (uint32_t)w.set->capacity); /* a lane that is half empty */
        REFUSED_INDEX(&w, &b->j[0], b->i[0]);
        REFUSED_INDEX(&w, &wall->j[0], (uint32_t)w.set->wall_count);
        REFUSED_INDEX(&w, &wall->j[1], 0);
        REFUSED_INDEX(&w, &wall->i[0], (uint32_t)w.set->capacity + 1);
    }
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void triangles_that_no_mesh_has_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_MESH, 0.1, 0);
    se3di_particles *set = w.set;
    CHECK(set->list_valid && set->mesh_count > 0 && set->face_count > 0 && set->wall_count == 1);
    se3di_mesh_pair *pair = &set->mesh_pairs[0];
    for (size_t k = 0; k < set->face_count; k += 1 + set->face_count / 20) {
        REFUSED_INDEX(&w, &set->faces[k], (uint32_t)set->walls[0].shape.triangle_count);
    }
    REFUSED_INDEX(&w, &pair->i, (uint32_t)set->count);
    REFUSED_INDEX(&w, &pair->wall, (uint32_t)set->wall_count);
    REFUSED_INDEX(&w, &pair->face_begin, (uint32_t)set->face_count + 1);
    REFUSED_INDEX(&w, &pair->face_count, (uint32_t)set->face_count + 1);
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void history_of_what_is_not_there_is_refused(void)
{
    world w;
    open_world(&w, PARTICLES_HEAP, 0.06, 1);
    se3di_particles *set = w.set;
    CHECK(!set->list_valid && set->carry_count > 0);
    size_t wall = 0, pair = 0;
    for (size_t k = 0; k < set->carry_count; ++k) {
        *(set->carry[k].j >= SE3DI_CARRY_WALL ? &wall : &pair) = k;
    }
    CHECK(set->carry[wall].j >= SE3DI_CARRY_WALL && set->carry[pair].j < SE3DI_CARRY_WALL);
    REFUSED_INDEX(&w, &set->carry[pair].i, (uint32_t)set->count);
    REFUSED_INDEX(&w, &set->carry[pair].j, (uint32_t)set->count);
    REFUSED_INDEX(&w, &set->carry[wall].j, SE3DI_CARRY_WALL + (uint32_t)set->wall_count);
    CHECK(read_back(&w) >= 0);
    close_world(&w);
    open_world(&w, PARTICLES_MESH, 0.1, 1);
    CHECK(!w.set->list_valid && w.set->mesh_old_count > 0);
    REFUSED_INDEX(&w, &w.set->mesh_old[0].i, (uint32_t)w.set->count);
    REFUSED_INDEX(&w, &w.set->mesh_old[0].wall, (uint32_t)w.set->wall_count);
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void clumps_without_their_spheres_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_CLUMPS, 0.02, 0);
    se3di_clump *clump = &w.set->clumps[1];
    CHECK(w.set->clump_count > 2);
    must_be_finite(&w, clump->x, 3);
    must_be_finite(&w, clump->v, 3);
    must_be_finite(&w, clump->spin, 3);
    must_be_finite(&w, clump->q, 4);
    REFUSED_NUMBER(&w, &clump->q[0], clump->q[0] + 2.5); /* no unit quaternion */
    must_be_positive(&w, &clump->scale);
    must_be_positive(&w, &clump->factor);
    REFUSED_NUMBER(&w, &clump->scale, (double)INFINITY);
    REFUSED_NUMBER(&w, &clump->factor, (double)INFINITY);
    REFUSED_INDEX(&w, &clump->template_index, (uint32_t)w.set->template_count);
    REFUSED_INDEX(&w, &clump->first, (uint32_t)w.set->id_count);
    REFUSED_INDEX(&w, &clump->first, (uint32_t)w.set->id_count - 1);
    REFUSED_INDEX(&w, &clump->first, w.set->clumps[0].first);
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

static void bonds_without_ends_are_refused(void)
{
    world w;
    open_world(&w, PARTICLES_BONDS, 0.002, 0);
    se3di_bond *bond = &w.set->bonds[1];
    uint32_t wall = 0;
    CHECK(w.set->bond_count > 2);
    must_be_positive(&w, &bond->length);
    must_be_positive(&w, &bond->radius);
    must_be_finite(&w, &bond->energy, 1);
    must_be_finite(&w, &bond->dissipated, 1);
    must_be_finite(&w, bond->stiffness, 4);
    must_be_finite(&w, bond->damping, 4);
    must_be_finite(&w, bond->axis[0], 6);
    must_be_finite(&w, bond->turn, 4);
    must_be_finite(&w, bond->stress, 2);
    must_be_finite(&w, bond->force, 3);
    must_be_finite(&w, bond->drag, 3);
    must_be_finite(&w, bond->torque[0], 6);
    must_be_finite(&w, bond->brake[0], 6);
    REFUSED_INDEX(&w, &bond->group, (uint32_t)w.set->bond_group_count);
    REFUSED_INDEX(&w, &bond->end[0], (uint32_t)w.set->bond_end_count);
    REFUSED_INDEX(&w, &bond->end[1], (uint32_t)w.set->bond_end_count);
    REFUSED_INDEX(&w, &bond->end[0], bond->end[1]);
    while (wall < w.set->bond_end_count && w.set->bond_ends[wall].id != SE3DI_NO_INDEX) {
        ++wall;
    }
    CHECK(wall < w.set->bond_end_count);
    REFUSED_INDEX(&w, &bond->end[0], wall); /* the first one is a sphere */
    se3di_bond_end *end = &w.set->bond_ends[bond->end[0]];
    must_be_finite(&w, end->point, 3);
    must_be_finite(&w, end->q, 4);
    REFUSED_NUMBER(&w, &end->q[1], 3.0);
    REFUSED_INDEX(&w, &end->id, (uint32_t)w.set->id_count);
    REFUSED_INDEX(&w, &end->id, w.set->bond_ends[bond->end[1]].id);
    REFUSED_INDEX(&w, &w.set->bond_ends[wall].wall, (uint32_t)w.set->wall_count);
    CHECK(read_back(&w) >= 0);
    close_world(&w);
}

int main(void)
{
    RUN(records_that_are_no_numbers_are_refused);
    RUN(particles_that_cannot_be_are_refused);
    RUN(walls_that_are_nowhere_are_refused);
    RUN(sources_and_flows_are_checked);
    RUN(cells_that_are_no_boxes_are_refused);
    RUN(lists_that_name_what_is_not_there_are_refused);
    RUN(blocks_that_two_threads_would_share_are_refused);
    RUN(triangles_that_no_mesh_has_are_refused);
    RUN(history_of_what_is_not_there_is_refused);
    RUN(clumps_without_their_spheres_are_refused);
    RUN(bonds_without_ends_are_refused);
    return check_finish();
}
