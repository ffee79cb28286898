/* SPDX-License-Identifier: BSD-3-Clause */
/* A bed of particles that is continued from bytes, in another program and on another number of
 * threads, is the same to the last bit: what moves, what springs hold, what sources have drawn, and
 * the bytes of what it has become. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "support/particle_worlds.h"

typedef struct bytes {
    unsigned char *data;
    size_t size;
} bytes;

static bytes write_state(se3d_system *system)
{
    bytes b = {NULL, 0};
    se3d_snapshot *snapshot = NULL;
    CHECK(!se3d_snapshot_create(system, &snapshot));
    CHECK(!se3d_snapshot_write(snapshot, NULL, 0, &b.size));
    b.data = malloc(b.size);
    CHECK(b.data && !se3d_snapshot_write(snapshot, b.data, b.size, &b.size));
    se3d_snapshot_destroy(snapshot);
    return b;
}

static int read_state(se3d_system *system, const bytes *b)
{
    se3d_snapshot *snapshot = NULL;
    const se3d_status status = se3d_snapshot_read(system, b->data, b->size, &snapshot);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
    }
    const int good = status >= 0 && !se3d_snapshot_restore(snapshot, system);
    se3d_snapshot_destroy(snapshot);
    return good;
}

static int are_same(const bytes *a, const bytes *b)
{
    return a->size == b->size && memcmp(a->data, b->data, a->size) == 0;
}

static se3d_solver *solver_of(se3d_system *system, int32_t method)
{
    se3d_solver_def def = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.method = method;
    CHECK(!se3d_solver_create(system, &def, &solver));
    return solver;
}

static void run(se3d_system *system, int32_t method, double time)
{
    se3d_solver *solver = solver_of(system, method);
    const se3d_status status = se3d_solver_run(solver, time);
    CHECK(status >= 0);
    if (status < 0) {
        fprintf(stderr, "%s\n", se3d_system_get_error(system));
    }
    se3d_solver_destroy(solver);
}

/* How a world is continued elsewhere. */
typedef struct course {
    int kind;
    int32_t method, threads;
    int used; /* the other program has used its model for something else before */
    double from, time;
} course;

static bytes continue_elsewhere(const course *c, const bytes *begun)
{
    se3d_system *system = particle_world(c->kind, c->threads);
    if (c->used) {
        run(system, c->method, 0.01);
    }
    CHECK(read_state(system, begun));
    const bytes again = write_state(system);
    CHECK(are_same(begun, &again));
    free(again.data);
    run(system, c->method, c->time);
    const bytes end = write_state(system);
    se3d_system_destroy(system);
    return end;
}

static void check_course(const course *c)
{
    se3d_system *system = particle_world(c->kind, 1);
    if (c->from > 0.0) {
        run(system, c->method, c->from);
    }
    const bytes begun = write_state(system);
    run(system, c->method, c->time);
    const bytes end = write_state(system), there = continue_elsewhere(c, &begun);
    CHECK(are_same(&there, &end));
    if (!are_same(&there, &end)) {
        fprintf(stderr, "%s from %g s, method %d, %d threads\n", particle_world_names[c->kind],
                c->from, (int)c->method, (int)c->threads);
    }
    se3d_system_destroy(system);
    free(there.data);
    free(begun.data);
    free(end.data);
}

static void another_program_continues_with_the_same_bits(void)
{
    static const double times[] = {0.0, 0.0137, 0.07};
    for (int kind = 0; kind < PARTICLES_WORLDS; ++kind) {
        for (size_t k = 0; k < sizeof times / sizeof *times; ++k) {
            const double t = times[k];
            check_course(&(course){kind, SE3D_METHOD_VERLET, 1, (int)k % 2, t, t + 0.02});
        }
    }
}

/* Few steps: a processor that is shared makes threads wait for each other. */
static void on_another_number_of_threads_too(void)
{
    for (int kind = 0; kind < PARTICLES_WORLDS; ++kind) {
        check_course(&(course){kind, SE3D_METHOD_VERLET, 2, 0, 0.05, 0.0505});
    }
}

static void continue_after_edit(int change)
{
    se3d_system *system = particle_world(PARTICLES_MESH, 1),
                *other = particle_world(PARTICLES_MESH, 1);
    run(system, SE3D_METHOD_VERLET, 0.05);
    for (int k = 0; k < 2; ++k) {
        se3d_system *to = k == 0 ? system : other;
        se3d_shape_def def = se3d_shape_def_default();
        se3d_particles *set;
        se3d_shape shape;
        def.material = particle_material(to, 0.2, 0.0);
        def.position[2] = -1.0;
        CHECK(change != 0 || !se3d_shape_create_plane(to, &def, &shape));
        CHECK(!se3d_system_get_particles(to, 0, &set));
        const double at[3] = {0.0, 0.0, 0.5}, radius = 0.01;
        CHECK(change != 1 || k == 1 ||
              !se3d_particles_add(set, def.material, 1, at, &radius, NULL, NULL, NULL));
    }
    const bytes begun = write_state(system);
    CHECK(read_state(other, &begun));
    run(system, SE3D_METHOD_VERLET, 0.08);
    run(other, SE3D_METHOD_VERLET, 0.08);
    const bytes a = write_state(system), b = write_state(other);
    CHECK(are_same(&a, &b));
    se3d_system_destroy(system);
    se3d_system_destroy(other);
    free(begun.data);
    free(a.data);
    free(b.data);
}

/* A wall, or a particle of a new material, that no step has seen yet. */
static void edits_that_no_step_has_seen_are_taken_along(void)
{
    continue_after_edit(0);
    continue_after_edit(1);
}

/* A material is in use as long as particles are made of it, also if these come and go with
 * snapshots. */
static void a_restored_set_uses_its_materials(void)
{
    se3d_system *system = particle_world(PARTICLES_HEAP, 1);
    se3d_particles *set;
    const double at[3] = {0.0, 0.0, 0.5}, radius = 0.01;
    const bytes before = write_state(system);
    const se3d_material gold = particle_material(system, 0.0, 0.0);
    CHECK(!se3d_system_get_particles(system, 0, &set));
    CHECK(!se3d_particles_add(set, gold, 1, at, &radius, NULL, NULL, NULL));
    CHECK(se3d_material_destroy(system, gold) == SE3D_ERR_IN_USE);
    const bytes after = write_state(system);
    CHECK(read_state(system, &before));
    CHECK(read_state(system, &after));
    CHECK(se3d_material_destroy(system, gold) == SE3D_ERR_IN_USE);
    CHECK(read_state(system, &before));
    CHECK(!se3d_material_destroy(system, gold));
    CHECK(!read_state(system, &after));
    se3d_system_destroy(system);
    free(before.data);
    free(after.data);
}

int main(void)
{
    RUN(another_program_continues_with_the_same_bits);
    RUN(on_another_number_of_threads_too);
    RUN(edits_that_no_step_has_seen_are_taken_along);
    RUN(a_restored_set_uses_its_materials);
    return check_finish();
}
