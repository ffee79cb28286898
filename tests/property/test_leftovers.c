/* SPDX-License-Identifier: BSD-3-Clause */
/* Steps, runs and queries depend on nothing that happens to lie about: neither on what the stack
 * held before, nor on what memory from the allocator holds. Every method, both formulations, with
 * what they remember: friction, stops, contacts. Under valgrind the same program shows the place.
 */
#include "check.h"
#include "se3d/se3d.h"
#include "support/ball_on_floor.h"

#include <stdlib.h>

#define STACK 100000 /* bytes; the deepest call of a step uses less */

typedef struct scene {
    se3d_system *system;
    se3d_body block, ball;
    se3d_force rub;
    unsigned char filling; /* of new memory and of the stack */
} scene;

static void *filled_alloc(void *ctx, size_t size)
{
    const scene *s = ctx;
    void *memory = malloc(size ? size : 1);
    return memory ? memset(memory, s->filling, size) : NULL;
}

static void *filled_realloc(void *ctx, void *memory, size_t old_size, size_t new_size)
{
    const scene *s = ctx;
    char *grown = realloc(memory, new_size ? new_size : 1);
    if (grown && new_size > old_size) {
        memset(grown + old_size, s->filling, new_size - old_size);
    }
    return grown;
}

static void filled_free(void *ctx, void *memory, size_t size)
{
    (void)ctx, (void)size;
    free(memory);
}

#if defined(__GNUC__)
__attribute__((noinline))
#endif
static void
fill_stack(unsigned char filling)
{
    volatile unsigned char left[STACK];
    for (size_t k = 0; k < sizeof left; ++k) {
        left[k] = filling;
    }
}

static void add_slide(scene *s)
{
    se3d_body_def body = se3d_body_def_default();
    se3d_joint_def joint = se3d_joint_def_default();
    se3d_friction_def rub = se3d_friction_def_default();
    se3d_stop_def stop = se3d_stop_def_default();
    CHECK(!se3d_system_get_ground(s->system, &joint.body_i));
    body.mass = 2.0;
    body.inertia[0] = body.inertia[1] = body.inertia[2] = 0.01;
    body.velocity[0] = 0.3;
    CHECK(!se3d_body_create(s->system, &body, &s->block));
    joint.body_j = s->block;
    joint.axis_i[0] = joint.axis_j[0] = 1.0;
    joint.axis_i[2] = joint.axis_j[2] = 0.0;
    joint.ref_i[0] = joint.ref_j[0] = 0.0;
    joint.ref_i[2] = joint.ref_j[2] = 1.0;
    CHECK(!se3d_joint_create_prismatic(s->system, &joint, &rub.joint));
    rub.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    rub.mu = 0.3;
    CHECK(!se3d_force_create_friction(s->system, &rub, &s->rub));
    stop.joint = rub.joint;
    stop.coordinate = SE3D_JOINT_COORDINATE_DISPLACEMENT;
    stop.upper = 0.003;
    stop.k = 1e4;
    stop.restitution = 0.5;
    se3d_force made;
    CHECK(!se3d_force_create_stop(s->system, &stop, &made));
}

static void add_ball(scene *s)
{
    const double v[3] = {0.1, 0.0, -0.2};
    s->ball = add_ball_of(s->system, add_floor_of(s->system, 1000.0, 1e4, -1.0), 0.004, -0.8995, v);
}

static void query(const scene *s)
{
    se3d_energy energy;
    se3d_work work;
    double violation[3], x[6];
    CHECK(!se3d_system_get_energy(s->system, &energy) && isfinite(energy.total));
    CHECK(!se3d_system_get_work(s->system, &work) && isfinite(work.dissipated));
    CHECK(!se3d_system_get_violation(s->system, violation) && isfinite(violation[2]));
    CHECK(!se3d_force_get_wrench(s->system, s->rub, 1, x) && isfinite(x[0] + x[5]));
    CHECK(!se3d_system_get_contact_force_max(s->system, x) && isfinite(x[0]));
}

/* Steps, a run, and a step again, of what lies about `filling`. @return what is left of it */
static uint64_t hash_of(int32_t method, int32_t formulation, unsigned char filling)
{
    scene s = {.filling = filling};
    const se3d_allocator allocator = {filled_alloc, filled_realloc, filled_free, &s};
    se3d_system_def def = se3d_system_def_default();
    se3d_solver_def settings = se3d_solver_def_default();
    se3d_solver *solver = NULL;
    def.allocator = &allocator;
    CHECK(!se3d_system_create(&def, &s.system));
    add_slide(&s);
    add_ball(&s);
    settings.method = method;
    settings.formulation = formulation;
    settings.step = 2e-4;
    CHECK(!se3d_solver_create(s.system, &settings, &solver));
    for (int k = 0; k < 20; ++k) {
        fill_stack(filling);
        const se3d_status status =
            k == 10 ? se3d_solver_run(solver, 0.01) : se3d_solver_step(solver, 2e-4);
        if (status != SE3D_OK) {
            fprintf(stderr, "method %d, call %d: %s\n", (int)method, k,
                    se3d_system_get_error(s.system));
            CHECK(0);
        }
        query(&s);
    }
    const uint64_t hash = se3d_system_hash(s.system);
    se3d_solver_destroy(solver);
    se3d_system_destroy(s.system);
    return hash;
}

static void nothing_depends_on_what_lies_about(void)
{
    for (int32_t method = SE3D_METHOD_AUTO; method <= SE3D_METHOD_RK4; ++method) {
        for (int32_t formulation = 0; formulation < 3; ++formulation) {
            const uint64_t hash = hash_of(method, formulation, 0);
            CHECK(hash_of(method, formulation, 0xFF) == hash); /* doubles: not a number */
            CHECK(hash_of(method, formulation, 0x7E) == hash); /* huge */
        }
    }
}

int main(void)
{
    RUN(nothing_depends_on_what_lies_about);
    return check_finish();
}
